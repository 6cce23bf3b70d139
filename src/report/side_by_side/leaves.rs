//! Differences of two JSON documents, leaf by leaf. Leaves are found by their path, written as in messages about a study:
//! `parameters[2].lower`. What is null counts as not there; empty lists and objects have no leaves.
//!
//! Deliberately not here: what a leaf means, and finding entries of lists that have moved.

use crate::report::short;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};
use std::collections::{HashMap, HashSet};

/// Rows of content that are listed.
const MOST_ROWS: usize = 200;
/// Keys that are not content, wherever they stand: they tell where and how fast a report was made.
const ORIGIN: [&str; 5] = ["timing", "seconds", "provenance", "assumptions", "hash"];
/// Keys that are not content at the top of a report.
const WORDS: [&str; 3] = ["schema_version", "title", "question"];

/// A leaf that differs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeafDifference {
    /// Where it stands.
    pub path: String,
    /// In A; none if A does not have it.
    pub a: Option<Value>,
    /// In B; none if B does not have it.
    pub b: Option<Value>,
    /// Of two numbers B less A, relative to the larger of both sizes: at most 2.
    pub relative: Option<f64>,
}

/// Leaves of two documents.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeafComparison {
    /// Those that differ, or the first of them.
    pub rows: Vec<LeafDifference>,
    /// How many differ.
    pub differing: usize,
    /// How many are equal.
    pub equal: usize,
}

impl LeafDifference {
    /// Both values as text, numbers with four digits, or with all of them where those would read the same; none for a value
    /// that is not there.
    pub fn words(&self) -> [Option<String>; 2] {
        let told = |number: fn(&Number) -> String| {
            [&self.a, &self.b].map(|value| value.as_ref().map(|value| text(value, number)))
        };
        let brief = told(|n| n.as_f64().map_or_else(|| n.to_string(), short));
        if brief[0] == brief[1] { told(Number::to_string) } else { brief }
    }

    /// Its rank among differences: words that differ, then numbers by their relative difference, then what only one side has.
    fn rank(&self) -> f64 {
        match (self.relative, &self.a, &self.b) {
            (Some(relative), ..) => relative.abs(),
            (None, Some(_), Some(_)) => f64::INFINITY,
            _ => -1.0,
        }
    }
}

impl LeafComparison {
    /// How many differ and how many are equal, and how many of them are not listed.
    pub fn counted(&self) -> String {
        let differ = match self.differing {
            0 => "No value differs".to_owned(),
            1 => "One value differs".to_owned(),
            n => format!("{n} values differ"),
        };
        let equal = match self.equal {
            1 => "1 is equal".to_owned(),
            n => format!("{n} are equal"),
        };
        let left = match self.differing.saturating_sub(self.rows.len()) {
            0 => String::new(),
            n => format!("; {n} of those that differ are not listed"),
        };
        format!("{differ}, {equal}{left}")
    }
}

fn text(value: &Value, number: fn(&Number) -> String) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(n) => number(n),
        other => other.to_string(),
    }
}

/// All leaves of two studies that differ, in the order of A.
pub fn inputs(a: &Value, b: &Value) -> LeafComparison {
    compared(a, b, &|_, _| true)
}

/// Leaves of the content of two reports, the largest relative differences first.
pub fn content(a: &Value, b: &Value) -> LeafComparison {
    let counts = |path: &str, key: &str| {
        let origin = ORIGIN.contains(&key) || key.ends_with("_hash");
        !(origin || path.is_empty() && WORDS.contains(&key))
    };
    let mut found = compared(a, b, &counts);
    found.rows.sort_by(|x, y| y.rank().total_cmp(&x.rank()));
    found.rows.truncate(MOST_ROWS);
    found
}

/// Whether a key counts, given the path of the object it stands in.
type Counts<'c> = &'c dyn Fn(&str, &str) -> bool;

fn compared(a: &Value, b: &Value, counts: Counts) -> LeafComparison {
    let (mut of_a, mut of_b) = (Vec::new(), Vec::new());
    flatten(String::new(), a, counts, &mut of_a);
    flatten(String::new(), b, counts, &mut of_b);
    let by_path: HashMap<&str, &Value> = of_b.iter().map(|(path, value)| (path.as_str(), *value)).collect();
    let known: HashSet<&str> = of_a.iter().map(|(path, _)| path.as_str()).collect();
    let mut found = LeafComparison { rows: Vec::new(), differing: 0, equal: 0 };
    for (path, x) in &of_a {
        match by_path.get(path.as_str()).copied() {
            Some(y) if equal(x, y) => found.equal += 1,
            y => found.rows.push(difference(path, Some(*x), y)),
        }
    }
    let added = of_b.iter().filter(|(path, _)| !known.contains(path.as_str()));
    found.rows.extend(added.map(|(path, y)| difference(path, None, Some(*y))));
    found.differing = found.rows.len();
    found
}

/// Leaves with their paths.
fn flatten<'v>(path: String, value: &'v Value, counts: Counts, leaves: &mut Vec<(String, &'v Value)>) {
    match value {
        Value::Null => {}
        Value::Object(map) => {
            for (key, value) in map.iter().filter(|(key, _)| counts(&path, key)) {
                flatten(joined(&path, key), value, counts, leaves);
            }
        }
        Value::Array(list) => {
            for (k, value) in list.iter().enumerate() {
                flatten(format!("{path}[{k}]"), value, counts, leaves);
            }
        }
        _ => leaves.push((path, value)),
    }
}

/// A path and a key; keys that are no bare keys of TOML stand in quotes.
fn joined(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_owned() } else { format!("{key:?}") };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// 1 and 1.0 are the same number.
fn equal(x: &Value, y: &Value) -> bool {
    x == y || (x.is_f64() != y.is_f64() && x.is_number() && y.is_number() && x.as_f64() == y.as_f64())
}

fn difference(path: &str, a: Option<&Value>, b: Option<&Value>) -> LeafDifference {
    let numbers = a.and_then(Value::as_f64).zip(b.and_then(Value::as_f64));
    let relative = numbers.map(|(a, b)| (b - a) / a.abs().max(b.abs()).max(f64::MIN_POSITIVE));
    LeafDifference { path: path.to_owned(), a: a.cloned(), b: b.cloned(), relative }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn leaves_are_found_by_their_paths() {
        let a = json!({
            "oil": { "grade": "SAE 40" }, "list": [{ "name": "x", "lower": 1 }, { "lower": 2.5 }],
            "none": null, "odd key": 1,
        });
        let b = json!({
            "oil": { "grade": "SAE 30", "extra": true }, "list": [{ "name": "x", "lower": 1.0 }],
            "odd key": 2,
        });
        let found = inputs(&a, &b);
        let paths: Vec<&str> = found.rows.iter().map(|r| r.path.as_str()).collect();
        assert_eq!(paths, ["oil.grade", "list[1].lower", "\"odd key\"", "oil.extra"]);
        assert_eq!((found.differing, found.equal), (4, 2));
        assert_eq!(found.rows[1].words(), [Some("2.5".to_owned()), None]);
        assert_eq!(found.rows[2].relative, Some(0.5));
        assert_eq!(inputs(&a, &a).differing, 0);
    }

    #[test]
    fn content_leaves_out_where_it_is_from_and_lists_the_largest_first() {
        let of = |x: f64, word: &str| {
            json!({
                "title": word, "study_hash": word, "timing": { "seconds": x }, "status": word,
                "rows": [x, 1.0 + 0.1 * x, 7],
            })
        };
        let found = content(&of(1.0, "one"), &of(2.0, "two"));
        let paths: Vec<&str> = found.rows.iter().map(|r| r.path.as_str()).collect();
        assert_eq!(paths, ["status", "rows[0]", "rows[1]"]);
        assert_eq!(found.counted(), "3 values differ, 1 is equal");
        let long = |shift: f64| json!((0..500).map(|k| f64::from(k) + shift).collect::<Vec<f64>>());
        let found = content(&long(0.0), &long(1e-7));
        assert_eq!((found.rows.len(), found.differing), (200, 500));
        assert_eq!(found.rows[1].words(), ["1.0".to_owned(), "1.0000001".to_owned()].map(Some));
        assert!(found.counted().contains("300 of those that differ are not listed"));
    }
}

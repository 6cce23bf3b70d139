//! Mistakes of a study file: all of them, each with its place and what to do.

use super::Given;
use super::place::find;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use std::ops::Range;
use thiserror::Error;

/// One mistake.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fault {
    /// Key it belongs to, like `parameters[2].lower`.
    pub path: String,
    /// What is wrong and what would be right.
    pub message: String,
    /// Line in the file, counted from 1.
    pub line: Option<usize>,
    /// Bytes in the file.
    #[serde(skip)]
    pub span: Option<Range<usize>>,
}

/// Everything that is wrong with a study.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the study has {} mistake{}", .faults.len(), if .faults.len() == 1 { "" } else { "s" })]
pub struct StudyErrors {
    /// The mistakes in the order of the file.
    pub faults: Vec<Fault>,
    /// The text they were found in.
    pub text: String,
}

/// Collects mistakes while a file is checked.
pub(super) struct Faults {
    list: Vec<(String, String)>,
    raw: Value,
}

impl Faults {
    /// No mistakes yet in a document.
    pub fn of(raw: Value) -> Self {
        Self { list: Vec::new(), raw }
    }

    /// What stands in the document at a path.
    pub fn raw(&self, path: &str) -> Option<&Value> {
        find(&self.raw, path)
    }

    /// Notes a mistake.
    pub fn add(&mut self, path: &str, message: impl Into<String>) {
        self.list.push((path.to_owned(), message.into()));
    }

    /// The mistakes noted.
    pub fn into_list(self) -> Vec<(String, String)> {
        self.list
    }

    /// How many mistakes were noted so far.
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// Whether anything is wrong.
    pub fn any(&self) -> bool {
        !self.list.is_empty()
    }

    /// A key that must be there.
    pub fn need<T: Clone>(&mut self, given: &Given<T>, path: &str) -> Option<T> {
        if given.is_absent() {
            self.add(path, "is missing");
        }
        self.get(given, path)
    }

    /// A key that may be there.
    pub fn get<T: Clone>(&mut self, given: &Given<T>, path: &str) -> Option<T> {
        if let Given::Wrong { found, problem } = given {
            self.add(path, format!("found {found}: {problem}"));
        }
        given.value().cloned()
    }

    /// A key with a default, which is written into the file.
    pub fn or<T: Clone>(&mut self, given: &mut Given<T>, path: &str, default: T) -> T {
        if given.is_absent() {
            *given = Given::Value(default.clone());
        }
        self.get(given, path).unwrap_or(default)
    }

    /// A section that may be left out because every key has a default or is reported on its own.
    pub fn section<'a, T: Clone + Default>(
        &mut self,
        given: &'a mut Given<T>,
        path: &str,
    ) -> Option<&'a mut T> {
        if given.is_absent() {
            *given = Given::Value(T::default());
        }
        self.get(given, path)?;
        match given {
            Given::Value(v) => Some(v),
            _ => None,
        }
    }

    /// A key that has no meaning here.
    pub fn unused<T>(&mut self, given: &Given<T>, path: &str, why: &str) {
        if !given.is_absent() {
            self.add(path, format!("is not used: {why}; remove it"));
        }
    }

    /// Keys that do not exist, with the most similar one that does.
    pub fn unknown<T: JsonSchema>(&mut self, unknown: &super::given::Unknown, path: &str) {
        if unknown.is_empty() {
            return;
        }
        let schema = schemars::schema_for!(T).to_value();
        let known: Vec<&str> = schema["properties"]
            .as_object()
            .map(|p| p.keys().map(String::as_str).collect())
            .unwrap_or_default();
        for key in unknown.keys() {
            let near = known.iter().copied().max_by(|a, b| similarity(key, a).total_cmp(&similarity(key, b)));
            let hint = match near.filter(|n| similarity(key, n) > 0.6) {
                Some(near) => format!("did you mean '{near}'?"),
                None => format!("known keys: {}", known.join(", ")),
            };
            self.add(&join(path, key), format!("is not a key of this section; {hint}"));
        }
    }

    /// A number that must lie in a range; also notes numbers that are not finite.
    pub fn range(&mut self, value: Option<f64>, path: &str, ok: impl Fn(f64) -> bool, words: &str) {
        if let Some(v) = value.filter(|v| !v.is_finite() || !ok(*v)) {
            let found = match self.raw(path) {
                Some(Value::String(text)) => text.clone(),
                _ => crate::report::short(v),
            };
            self.add(path, format!("must be {words}, found {found}"));
        }
    }
}

/// Notes every key of the list that is given although it is not among the used ones.
macro_rules! refuse_others {
    ($faults:expr, $file:expr, $path:expr, $why:expr, $used:expr, [$($key:ident),* $(,)?]) => {{
        let used: &[&str] = &$used;
        $(if !used.contains(&stringify!($key)) {
            $faults.unused(&$file.$key, &$crate::study::faults::join($path, stringify!($key)), $why);
        })*
    }};
}
pub(super) use refuse_others;

/// Path of a key below another.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// Share of common letter pairs (Dice).
fn similarity(a: &str, b: &str) -> f64 {
    let pairs = |s: &str| s.chars().zip(s.chars().skip(1)).collect::<Vec<_>>();
    let (pa, mut pb) = (pairs(a), pairs(b));
    let total = pa.len() + pb.len();
    let common =
        pa.iter().filter(|p| pb.iter().position(|q| q == *p).map(|i| pb.swap_remove(i)).is_some()).count();
    if total == 0 { 0.0 } else { 2.0 * common as f64 / total as f64 }
}

/// Line of a byte position, counted from 1.
pub(super) fn line_of(text: &str, at: usize) -> usize {
    text.as_bytes().iter().take(at).filter(|b| **b == b'\n').count() + 1
}

/// Removes nulls, which stand for absent keys.
pub(super) fn without_nulls(value: Value) -> Value {
    match value {
        Value::Object(map) => {
            map.into_iter().filter(|(_, v)| !v.is_null()).map(|(k, v)| (k, without_nulls(v))).collect()
        }
        Value::Array(list) => list.into_iter().map(without_nulls).collect(),
        other => other,
    }
}

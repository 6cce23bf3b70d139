//! `stribeck compare`: two reports side by side, as tables, as JSON, as a page.
//!
//! Deliberately not here: what is compared with what, which is the report's own knowledge.

use super::EXIT_STUDY;
use super::commands::{Stop, put};
use super::tables::{maybe, table, word};
use crate::report::{
    ColumnPair, DesignPair, LeafComparison, LimitPair, LimitSide, NumberPair, ReportHead, Side, SideBySide,
    TablePair, short, side_by_side, side_by_side_files, write_folder,
};
use clap::Args;
use std::path::{Path, PathBuf};

/// Characters of a value that are printed.
const WIDEST: usize = 60;
/// Inputs that are printed; page and JSON have them all.
const MOST_INPUTS: usize = 200;

#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// First report: a report.json, or a folder that holds one.
    a: PathBuf,
    /// Second report, of the same kind.
    b: PathBuf,
    /// Write compare.html and compare.json into a folder.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Print the comparison as JSON instead of tables.
    #[arg(long)]
    json: bool,
}

/// The files of one report.
struct Found {
    label: String,
    text: String,
    orbit_csv: Option<String>,
}

impl Found {
    fn read(path: &Path) -> Result<Self, Stop> {
        let file = if path.is_dir() { path.join("report.json") } else { path.to_owned() };
        let text = std::fs::read_to_string(&file).map_err(|e| Stop::File(file.clone(), e))?;
        let orbit_csv = std::fs::read_to_string(file.with_file_name("orbit.csv")).ok();
        Ok(Self { label: path.display().to_string(), text, orbit_csv })
    }

    fn side(self) -> Result<Side, String> {
        let Self { label, text, orbit_csv } = self;
        match serde_json::from_str(&text) {
            Ok(report) => Ok(Side { label, report, orbit_csv }),
            Err(e) => Err(format!("{label}: no JSON: {e}. Give the report.json of a 'stribeck run'")),
        }
    }
}

pub(super) fn compare(a: &CompareArguments) -> Result<u8, Stop> {
    let (first, second) = (Found::read(&a.a)?, Found::read(&a.b)?);
    match compared(first, second) {
        Ok((found, sides)) => told(a, &found, &sides),
        Err(why) => {
            eprintln!("error: {why}");
            Ok(EXIT_STUDY)
        }
    }
}

fn compared(a: Found, b: Found) -> Result<(SideBySide, [Side; 2]), String> {
    let sides = [a.side()?, b.side()?];
    let found = side_by_side(&sides[0], &sides[1])?;
    Ok((found, sides))
}

fn told(a: &CompareArguments, found: &SideBySide, [first, second]: &[Side; 2]) -> Result<u8, Stop> {
    if let Some(folder) = &a.out {
        let failed = |e| Stop::File(folder.clone(), e);
        let files = side_by_side_files(found, first, second).map_err(failed)?;
        write_folder(&files, folder).map_err(failed)?;
    }
    if a.json {
        put(&(serde_json::to_string_pretty(found).unwrap_or_default() + "\n"));
    } else {
        put(&summary(found));
        if let Some(folder) = &a.out {
            put(&format!("page: {}\n", folder.join("compare.html").display()));
        }
    }
    Ok(0)
}

/// Everything as text, the answer first.
fn summary(found: &SideBySide) -> String {
    let head = |name: &str, r: &ReportHead| format!("{name}: {} ({})\n", r.title, r.label);
    let mut text = head("A", &found.a) + &head("B", &found.b) + "\n";
    for line in found.answer.iter().chain(&found.notes) {
        text += &format!("{line}\n");
    }
    text += "\n";
    if let Some(pair) = &found.design {
        text += &designs(pair);
    }
    for t in &found.tables {
        text += &columns(t);
    }
    if let Some(content) = &found.content {
        text += &leaves("content", content, usize::MAX);
    }
    text + &inputs(found)
}

fn designs(pair: &DesignPair) -> String {
    let mut outcome = table(&["", "A", "B"]);
    for t in &pair.outcome {
        let value = |v: &Option<String>| v.as_deref().map_or_else(|| "-".to_owned(), cut);
        outcome.add_row([t.name.clone(), value(&t.a), value(&t.b)]);
    }
    let mut text = format!("{outcome}\n\n");
    text += &numbers("objective", &pair.objective);
    text += &numbers("parameter", &pair.parameters);
    text += &limits(&pair.limits);
    for c in &pair.cycles {
        text += &numbers(&c.name(), &c.numbers);
    }
    for c in &pair.running_in {
        text += &numbers(&format!("running-in of {}", c.name()), &c.numbers);
    }
    text + &numbers("work", &pair.work)
}

/// A table of numbers; nothing if there are none.
fn numbers(head: &str, pairs: &[NumberPair]) -> String {
    if pairs.is_empty() {
        return String::new();
    }
    let mut rows = table(&[head, "A", "B", "B - A", "%", "unit"]);
    for n in pairs {
        let unit = if n.unit == "1" { "" } else { n.unit.as_str() };
        rows.add_row([
            n.name.clone(),
            maybe(n.a),
            maybe(n.b),
            maybe(n.difference),
            n.difference_percent.map(short).unwrap_or_default(),
            unit.to_owned(),
        ]);
    }
    format!("{rows}\n\n")
}

fn limits(pairs: &[LimitPair]) -> String {
    if pairs.is_empty() {
        return String::new();
    }
    let mut rows = table(&[
        "limit", "of", "unit", "limit A", "limit B", "value A", "value B", "B - A", "state A", "state B",
        "price A", "price B",
    ]);
    for l in pairs {
        let of = [l.bearing.as_str(), l.operating_point.as_str()];
        let of: Vec<&str> = of.into_iter().filter(|w| !w.is_empty()).collect();
        let number =
            |side: &Option<LimitSide>, of: fn(&LimitSide) -> Option<f64>| maybe(side.as_ref().and_then(of));
        let limit = |side: &Option<LimitSide>| match number(side, |s| Some(s.limit)).as_str() {
            "-" => "-".to_owned(),
            text => format!("{} {text}", l.sense),
        };
        let state = |side: &Option<LimitSide>| side.map_or_else(|| "-".to_owned(), |s| word(s.state));
        rows.add_row([
            l.quantity.clone(),
            of.join(", "),
            l.unit.clone(),
            limit(&l.a),
            limit(&l.b),
            number(&l.a, |s| s.value),
            number(&l.b, |s| s.value),
            maybe(l.difference),
            state(&l.a),
            state(&l.b),
            number(&l.a, |s| s.price_w_per_unit),
            number(&l.b, |s| s.price_w_per_unit),
        ]);
    }
    format!("{rows}\n\n")
}

/// The columns of a table that differ, one under another.
fn columns(t: &TablePair) -> String {
    let (same, differ): (Vec<&ColumnPair>, Vec<&ColumnPair>) = t.columns.iter().partition(|c| c.equal());
    let mut text = format!("{}\n", t.name);
    for c in differ {
        let label = c.label();
        let mut rows = table(&[&t.label(), &format!("{label}: A"), "B", "B - A"]);
        for (n, at) in t.at.iter().enumerate() {
            let value = |column: &[Option<f64>]| maybe(column.get(n).copied().flatten());
            rows.add_row([maybe(*at), value(&c.a), value(&c.b), value(&c.difference)]);
        }
        text += &format!("{rows}\n\n");
    }
    if !same.is_empty() {
        let names: Vec<String> = same.iter().map(|c| c.title.clone()).collect();
        text += &format!("the same in both: {}\n\n", names.join(", "));
    }
    text
}

/// Leaves that differ; nothing if there are none.
fn leaves(head: &str, found: &LeafComparison, most: usize) -> String {
    if found.rows.is_empty() {
        return String::new();
    }
    let mut rows = table(&[head, "A", "B", "relative difference [%]"]);
    for leaf in found.rows.iter().take(most) {
        let [a, b] = leaf.words().map(|v| v.map_or_else(|| "-".to_owned(), |v| cut(&v)));
        let relative = leaf.relative.map(|r| short(100.0 * r)).unwrap_or_default();
        rows.add_row([leaf.path.clone(), a, b, relative]);
    }
    format!("{rows}\n\n")
}

/// Inputs that differ, and where the reports are from.
fn inputs(found: &SideBySide) -> String {
    let mut text = leaves("inputs that differ", &found.inputs, MOST_INPUTS);
    if found.inputs.differing == 0 {
        text += "inputs: the studies, with every default written out, are the same\n";
    }
    let left = found.inputs.rows.len().saturating_sub(MOST_INPUTS);
    if left > 0 {
        text += &format!("{left} more inputs differ; --json and --out tell all of them\n");
    }
    for (name, r) in [("A", &found.a), ("B", &found.b)] {
        let known = |v: &Option<String>| v.clone().unwrap_or_else(|| "-".to_owned());
        text += &format!("{name}: version {}, study {}\n", known(&r.version), known(&r.study_hash));
    }
    text
}

/// The beginning of a long text.
fn cut(text: &str) -> String {
    if text.chars().count() <= WIDEST {
        return text.to_owned();
    }
    text.chars().take(WIDEST - 3).chain("...".chars()).collect()
}

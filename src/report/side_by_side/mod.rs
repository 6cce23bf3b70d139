//! Two reports side by side: what they answer differently, and which inputs differ. Content of `compare.json`, and its page.
//!
//! Designs are compared by what they are about, reports of other kinds leaf by leaf. A difference is always B less A. Deliberately
//! not here: reading files, and any judgement of what a difference is due to.

mod answer;
mod data;
mod design;
mod figures;
mod leaves;
mod page;
mod tables;

pub use data::{
    CasePair, DesignPair, LimitPair, LimitSide, LimitState, NumberPair, ReportHead, SIDE_BY_SIDE_FORMAT,
    Side, SideBySide, TextPair,
};
pub use leaves::{LeafComparison, LeafDifference};
pub use page::{side_by_side_files, side_by_side_html};
pub use tables::{ColumnPair, TablePair};

use super::{CHARACTERISTIC_FORMAT, COMPARISON_FORMAT, EXPERIMENTS_FORMAT, REPORT_FORMAT, Report};
use serde::Deserialize;
use serde_json::Value;

/// Formats that can be compared, and what they are reports of.
const KINDS: [(&str, &str); 4] = [
    (REPORT_FORMAT, "a design"),
    (CHARACTERISTIC_FORMAT, "a characteristic"),
    (COMPARISON_FORMAT, "a comparison of gradient engines"),
    (EXPERIMENTS_FORMAT, "experiments"),
];

/// Entries of two lists by key, in the order of A, with those that only B has at the end.
type Pairs<'x, T> = Vec<(Option<&'x T>, Option<&'x T>)>;

fn paired<'x, T, K: PartialEq>(a: &'x [T], b: &'x [T], key: impl Fn(&'x T) -> K) -> Pairs<'x, T> {
    let mut free: Vec<Option<&T>> = b.iter().map(Some).collect();
    let mut pairs: Pairs<'x, T> = Vec::new();
    for x in a {
        let partner = free.iter_mut().find(|y| y.is_some_and(|y| key(y) == key(x)));
        pairs.push((Some(x), partner.and_then(Option::take)));
    }
    pairs.extend(free.into_iter().flatten().map(|y| (None, Some(y))));
    pairs
}

/// The format of a report, if it can be compared, and what such reports are of.
fn kind(name: &str, side: &Side) -> Result<(&'static str, &'static str), String> {
    let version = side.report.get("schema_version").and_then(Value::as_str);
    KINDS.into_iter().find(|(format, _)| Some(*format) == version).ok_or_else(|| {
        let found = version.map_or_else(
            || "it names no schema_version".to_owned(),
            |v| format!("its schema_version is {v:?}"),
        );
        format!(
            "{name} ({}) is no report that can be compared: {found}; known are {}. Give the report.json of a \
             'stribeck run', or the folder that holds it",
            side.label,
            KINDS.map(|(format, _)| format).join(", ")
        )
    })
}

/// The format of both reports.
fn common_format(a: &Side, b: &Side) -> Result<&'static str, String> {
    let ((of_a, what_a), (of_b, what_b)) = (kind("A", a)?, kind("B", b)?);
    if of_a == of_b {
        return Ok(of_a);
    }
    Err(format!(
        "reports of different kinds cannot be compared: A ({}) is of {what_a} ({of_a}), B ({}) is of {what_b} ({of_b}). \
         Give two reports of the same kind",
        a.label, b.label
    ))
}

fn head(side: &Side) -> ReportHead {
    let text = |at: &str| side.report.pointer(at).and_then(Value::as_str).map(str::to_owned);
    ReportHead {
        label: side.label.clone(),
        title: text("/title").unwrap_or_default(),
        status: text("/outcome/status").or_else(|| text("/status")),
        version: text("/provenance/version"),
        study_hash: text("/study_hash"),
        coarse: side.report.pointer("/provenance/coarse").and_then(Value::as_bool).unwrap_or(false),
    }
}

/// Two reports side by side; in words, why they cannot be compared.
pub fn side_by_side(a: &Side, b: &Side) -> Result<SideBySide, String> {
    let format = common_format(a, b)?;
    let study = |side: &Side| side.report.pointer("/provenance/study").cloned().unwrap_or_default();
    let mut found = SideBySide {
        schema_version: SIDE_BY_SIDE_FORMAT.to_owned(),
        format: format.to_owned(),
        a: head(a),
        b: head(b),
        answer: Vec::new(),
        notes: Vec::new(),
        design: None,
        tables: Vec::new(),
        content: None,
        inputs: leaves::inputs(&study(a), &study(b)),
    };
    if format == REPORT_FORMAT {
        match (Report::deserialize(&a.report), Report::deserialize(&b.report)) {
            (Ok(x), Ok(y)) => {
                let pair = design::designs(&x, &y);
                found.answer = answer::of_designs(&x, &y, &pair);
                found.notes = answer::notes(&x, &y);
                found.design = Some(pair);
            }
            (x, y) => {
                let unread = [("A", x.err()), ("B", y.err())];
                let told = unread.into_iter().filter_map(|(name, e)| Some(answer::unread(name, &e?)));
                found.notes.extend(told);
            }
        }
    }
    if found.design.is_none() {
        let content = leaves::content(&a.report, &b.report);
        found.answer = answer::of_leaves(&content);
        found.content = Some(content);
    }
    if format == CHARACTERISTIC_FORMAT {
        found.tables = tables::tables(&a.report, &b.report);
    }
    let origins = answer::origins(&found);
    found.notes.extend(origins);
    Ok(found)
}

//! `stribeck run --dry-run`: what a run would do, and what it would take.

use super::progress::span;
use super::tables::table;
use crate::report::short;
use crate::run::FolderStore;
use crate::study::{Estimate, Study, estimate};
use serde_json::json;
use std::path::Path;

/// Estimates of studies with their names and folders.
pub(super) fn told(studies: &[(&str, &Path, &Study)], as_json: bool) -> String {
    let all: Vec<(&str, Estimate)> = studies
        .iter()
        .map(|(name, folder, study)| (*name, estimate(study, &FolderStore(folder.to_path_buf()))))
        .collect();
    if as_json {
        let list: Vec<_> = all.iter().map(|(name, e)| json!({ "study": name, "estimate": e })).collect();
        return serde_json::to_string_pretty(&list).unwrap_or_default() + "\n";
    }
    let mut rows = table(&[
        "study",
        "work",
        "cases",
        "cells",
        "steps",
        "cycles",
        "at most",
        "one cycle",
        "memory [MB]",
        "time",
    ]);
    let count = |v: f64| format!("{v:.0}");
    for (name, e) in &all {
        let kept = e.kept.filter(|k| *k > 0).map_or_else(String::new, |k| format!(", {k} known from before"));
        rows.add_row([
            (*name).to_owned(),
            format!("{}{kept}", e.work),
            e.cases.to_string(),
            e.cells.to_string(),
            e.steps.to_string(),
            count(e.cycles),
            e.most_cycles.map(count).unwrap_or_default(),
            e.cycle_s.map_or_else(|| "-".to_owned(), |s| format!("{} s", short(s))),
            short(e.memory_mb),
            e.seconds.map_or_else(|| "-".to_owned(), |s| format!("about {}", span(s))),
        ]);
    }
    let total: f64 = all.iter().filter_map(|(_, e)| e.seconds).sum();
    let mut text = format!("{rows}\n");
    if all.len() > 1 {
        text += &format!("together about {}\n", span(total));
    }
    text + "checked, nothing was computed. One cycle was measured; how many a search takes is what such searches took before.\n"
}

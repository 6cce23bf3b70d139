//! Experiments as tables for the terminal.

use super::tables::{maybe, table, word};
use crate::report::{Experiments, short, titled};

/// Runs that are printed; the others stand in the report.
const PRINTED: usize = 60;

/// Runs, what refinement tells, the best run.
pub(super) fn experiments(found: &Experiments) -> String {
    let mut head = vec!["run".to_owned()];
    head.extend(found.factors.iter().map(|f| titled(&f.name, &f.unit)));
    head.extend(["outcome".to_owned(), "limits".to_owned()]);
    // What is the same in all runs needs no column.
    let mut shown = found.shown();
    shown.retain(|k| *k == 0 || varies(found, *k));
    head.extend(shown.iter().map(|k| titled(&found.responses[*k].title, &found.responses[*k].unit)));
    let mut rows = table(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for run in found.runs.iter().take(PRINTED) {
        let mut row = vec![run.number.to_string()];
        row.extend(run.levels.iter().cloned());
        row.push(run.status.map_or_else(|| "not begun".to_owned(), word));
        let limits = run.feasible.map_or("-", |kept| if kept { "kept" } else { "broken" });
        row.push(limits.to_owned());
        row.extend(shown.iter().map(|k| maybe(run.responses.get(*k).copied().flatten())));
        rows.add_row(row);
    }
    let mut text = format!("{}\n\n{rows}\n", found.title);
    if found.runs.len() > PRINTED {
        text += &format!("{} more runs stand in the report\n", found.runs.len() - PRINTED);
    }
    for run in &found.runs {
        if let Some(reason) = &run.failure {
            text += &format!("run {} has no numbers: {reason}\n", run.number);
        }
    }
    if !found.refinements.is_empty() {
        let mut rows = table(&["refined", "response", "finest", "observed order", "limit", "off by [%]"]);
        for g in &found.refinements {
            let others =
                if g.others.is_empty() { String::new() } else { format!(" ({})", g.others.join(", ")) };
            rows.add_row([
                format!("{}{others}", g.factor),
                g.response.clone(),
                maybe(g.values.last().copied()),
                maybe(g.order),
                maybe(g.extrapolated),
                maybe(g.error_percent),
            ]);
        }
        text += &format!("\n{rows}\n");
    }
    for line in &found.answer {
        text += &format!("{line}\n");
    }
    text + &format!("{} runs, {} s\n", found.runs.len(), short(found.timing.seconds))
}

/// Whether a response is not the same in all runs that have it.
fn varies(found: &Experiments, k: usize) -> bool {
    let mut all = found.runs.iter().filter_map(|r| r.responses.get(k).copied().flatten());
    let first = all.next();
    all.any(|v| Some(v) != first)
}

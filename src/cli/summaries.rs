//! Many studies at a glance.

use super::stamp::Done;
use super::tables::{maybe, table};
use crate::report::{IndexEntry, Report, short};
use crate::study::Answer;

/// An answer in the few numbers of a list.
pub(super) fn done(found: &Answer, coarse: bool, told: String, code: u8) -> Done {
    let (title, (loss_w, saving_percent), seconds) = match found {
        Answer::Design(f) => (f.report.title.clone(), loss_and_saving(&f.report), f.report.timing.seconds),
        Answer::Characteristic(f) => (f.title.clone(), (None, None), f.timing.seconds),
        Answer::Comparison(f) => (f.title.clone(), (None, None), f.timing.seconds),
        Answer::Experiments(f) => {
            let best = f.best.and_then(|n| f.runs.get(n - 1)?.responses.first().copied().flatten());
            (f.title.clone(), (best, None), f.timing.seconds)
        }
        Answer::Gradient(_) => (String::new(), (None, None), 0.0),
    };
    let expected = found.expected();
    let entry = IndexEntry {
        name: String::new(),
        title,
        status: found.status(),
        good: code == 0,
        loss_w,
        saving_percent,
        expected: expected.len(),
        met: expected.iter().filter(|e| e.met).count(),
        coarse,
        seconds,
    };
    Done { code, told, entry }
}

/// What was minimised, W, and its saving, per cent; what a start that breaks its limits loses is no measure.
fn loss_and_saving(report: &Report) -> (Option<f64>, Option<f64>) {
    let fair = |saving: Option<f64>, broken: Option<f64>| saving.filter(|_| broken.is_none_or(|v| v <= 1e-6));
    match report.running_in.as_ref().and_then(|r| r.minimised.as_ref()) {
        Some(m) => ((m.unit == "W").then_some(m.optimum), fair(m.saving_percent, m.start_violation)),
        None => {
            let o = &report.objective;
            (o.optimum.as_ref().map(|l| l.total_w), fair(o.saving_percent, o.start_violation))
        }
    }
}

/// The list of a run of many.
pub(super) fn table_of(rows: &[(IndexEntry, bool)]) -> String {
    let mut all = table(&["study", "outcome", "loss [W]", "saving [%]", "figures met", "time [s]"]);
    for (e, before) in rows {
        let met = if e.expected == 0 { String::new() } else { format!("{} of {}", e.met, e.expected) };
        let time = if *before { "before".to_owned() } else { short(e.seconds) };
        let status = e.status.replace('-', " ");
        all.add_row([e.name.clone(), status, maybe(e.loss_w), maybe(e.saving_percent), met, time]);
    }
    format!("{all}\n")
}

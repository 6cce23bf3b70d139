//! An answer in the tables of its kind.

use super::{experiment_tables, proof_tables, tables};
use crate::report::ExpectedReport;
use crate::study::Answer;

/// The answer as tables, in colours or without.
pub(super) fn told(found: &Answer, colour: bool) -> String {
    let text = match found {
        Answer::Design(found) => tables::summary(&found.report, colour),
        Answer::Characteristic(found) => tables::characteristic(found),
        Answer::Comparison(found) => proof_tables::comparison(found),
        Answer::Experiments(found) => experiment_tables::experiments(found),
        Answer::Gradient(found) => tables::engines(found),
    };
    text + &expected(found.expected())
}

/// Figures that were expected: how many are met, and every one that is not.
fn expected(list: &[ExpectedReport]) -> String {
    if list.is_empty() {
        return String::new();
    }
    let met = list.iter().filter(|e| e.met).count();
    let mut text = format!("{met} of {} figures the study expects are met\n", list.len());
    for e in list.iter().filter(|e| !e.met) {
        let within = e.tolerance.map_or_else(String::new, |t| format!(" within {}", crate::report::short(t)));
        text += &format!("  {}: found {}, expected {}{within}\n", e.figure, e.found, e.expected);
    }
    text
}

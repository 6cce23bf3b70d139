//! Figures a study must reproduce: a path of its report, what must stand there, and how far it may be away.

use super::check::Study;
use super::faults::{Faults, join};
use super::file::{ExpectedFile, StudyFile};
use super::place::find;
use crate::report::ExpectedReport;
use serde_json::Value;

const PATH: &str = "expected";
/// Share of a number that it may be away, if nothing else is said.
const RELATIVE: f64 = 0.01;

/// A figure that is expected.
#[derive(Debug, Clone)]
pub(super) struct ExpectedPlan {
    path: String,
    value: Value,
    /// How far a number may be away, in its unit.
    tolerance: f64,
}

/// The figures of a study at its setting.
pub(super) fn expected(file: &mut StudyFile, coarse: bool, faults: &mut Faults) -> Vec<ExpectedPlan> {
    faults.get(&file.expected, PATH);
    let super::Given::Value(map) = &mut file.expected else { return Vec::new() };
    let mut all = Vec::new();
    for (path, given) in map {
        let at = format!("{PATH}.{path}");
        faults.get(given, &at);
        let super::Given::Value(one) = given else { continue };
        all.extend(figure(one, path, &at, coarse, faults));
    }
    all
}

fn figure(
    one: &mut ExpectedFile,
    path: &str,
    at: &str,
    coarse: bool,
    faults: &mut Faults,
) -> Option<ExpectedPlan> {
    faults.unknown::<ExpectedFile>(&one.unknown, at);
    let full = faults.need(&one.value, &join(at, "value"));
    let other = faults.get(&one.coarse, &join(at, "coarse"));
    let absolute = faults.get(&one.absolute, &join(at, "absolute"));
    for (given, key) in [(&full, "value"), (&other, "coarse")] {
        if given.as_ref().is_some_and(|v| v.is_object() || v.is_array() || v.is_null()) {
            faults.add(&join(at, key), "must be a number, a text or a truth value");
        }
    }
    if absolute.is_some() {
        faults.unused(&one.relative, &join(at, "relative"), "absolute is given");
    } else if full.as_ref().is_some_and(Value::is_number) {
        faults.or(&mut one.relative, &join(at, "relative"), RELATIVE);
    }
    let relative = one.relative.value().copied().unwrap_or(0.0);
    let positive = |v: f64| v >= 0.0;
    faults.range(absolute, &join(at, "absolute"), positive, "at or above zero");
    faults.range(Some(relative), &join(at, "relative"), positive, "at or above zero");
    let value = if coarse { other.or(full) } else { full }?;
    let tolerance = absolute.unwrap_or_else(|| relative * value.as_f64().unwrap_or(0.0).abs());
    Some(ExpectedPlan { path: path.to_owned(), value, tolerance })
}

/// The figures held against a report.
pub(super) fn judged(study: &Study, report: &Value) -> Vec<ExpectedReport> {
    let judge = |plan: &ExpectedPlan| {
        let found = find(report, &plan.path).cloned().unwrap_or(Value::Null);
        let met = match (plan.value.as_f64(), found.as_f64()) {
            (Some(wanted), Some(found)) => (wanted - found).abs() <= plan.tolerance,
            _ => plan.value == found,
        };
        let tolerance = plan.value.is_number().then_some(plan.tolerance);
        ExpectedReport { figure: plan.path.clone(), expected: plan.value.clone(), tolerance, found, met }
    };
    study.expected.iter().map(judge).collect()
}

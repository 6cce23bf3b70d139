//! One search for a study: plain, for the worst case, or with margins; polished if wanted.

use super::build::Plan;
use super::check::Study;
use super::keep::Keep;
use super::run_in_search::{RunInEnd, seek_run_in};
use super::running_in_design::Work;
use crate::optimise::{
    EvaluationError, Minimum, Outcome, Polished, SearchOptions, polish, search, search_worst,
};
use crate::run::RunContext;

/// A polish goes on to this share of the tolerance of the search.
const POLISHED: f64 = 1e-4;

/// What a search ended with.
pub(super) struct End {
    pub minimum: Minimum,
    /// Share of each operating point in the decision; empty unless the worst case counts.
    pub shares: Vec<f64>,
    /// What polishing did, if it was wanted.
    pub polished: Option<Polished>,
    /// Work of marches through running-in.
    pub marches: Work,
    /// How a running-in design was searched.
    pub run_in: Option<RunInEnd>,
}

/// Searches from a start.
pub(super) fn seek(
    study: &Study,
    plan: &Plan,
    start: &[f64],
    options: &SearchOptions,
    (keep, context): (&Keep<'_>, RunContext<'_>),
) -> Result<End, String> {
    if let Some(wanted) = study.running_in.as_ref().filter(|r| r.minimise.is_some()) {
        return seek_run_in(study, wanted, plan, start, options, (keep, context));
    }
    let (mut minimum, shares) = match &study.robust {
        _ if study.worst_case => search_worst(&plan.problem, start, options),
        Some(margins) => search(&margins.problem(plan), start, options).map(|end| (end, Vec::new())),
        None => search(&plan.problem, start, options).map(|end| (end, Vec::new())),
    }
    .map_err(|e| e.to_string())?;
    let usable = matches!(
        minimum.outcome,
        Outcome::Converged | Outcome::AlmostConverged | Outcome::NoProgress | Outcome::IterationLimit
    );
    let mut polished = None;
    if study.optimiser.polish && usable {
        let tolerance = options.settings.tolerance;
        match polish(&plan.problem, &mut minimum, POLISHED * tolerance) {
            Ok(done) => polished = Some(done),
            Err(EvaluationError::Cancelled) => minimum.outcome = Outcome::Cancelled,
            Err(EvaluationError::Failed(reason)) => minimum.failures.push(reason),
        }
        if minimum.kkt <= tolerance && minimum.outcome != Outcome::Cancelled {
            minimum.outcome = Outcome::Converged;
        }
    }
    Ok(End { minimum, shares, polished, marches: Work::default(), run_in: None })
}

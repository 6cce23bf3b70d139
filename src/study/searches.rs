//! The searches of a run: one from the study's start, or several from starts spread over the box; rivals beside them.
//!
//! Every search has a problem of its own, so that none starts its cycles from another's and the results do not depend on how many
//! run at once.

use super::build::{Plan, plan};
use super::check::Study;
use super::keep::Keep;
use super::run_in_search::RunInEnd;
use super::running_in_design::Work;
use super::seek::{End, seek};
use crate::gradient::EngineName;
use crate::optimise::{
    ConstrainedProblem, EvaluationError, Method, Minimum, Outcome, Polished, SearchOptions, latin_hypercube,
};
use crate::report::{LocalOptimum, RivalRun, StartRun, StartsReport};
use crate::run::{Cost, Event, RunContext, Silent, Store};
use rayon::prelude::*;
use std::time::Instant;

/// Relative difference of two losses, and of two designs in their box, up to which two ends are the same optimum.
const SAME_LOSS: f64 = 1e-4;
const SAME_DESIGN: f64 = 1e-2;
/// Violation up to which an end counts among the feasible ones.
pub(super) const FEASIBLE: f64 = 1e-5;

/// How a study searches.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SearchPlan {
    /// Method, settings, budget.
    pub options: SearchOptions,
    /// Searches: the first from the study's start, the others from a Latin hypercube.
    pub starts: u64,
    /// Seed of the hypercube.
    pub seed: u64,
    /// Whether the optimum is polished with second derivatives.
    pub polish: bool,
    /// Other methods and engines that are to search from the same start, for comparison.
    pub rivals: Vec<(Method, EngineName)>,
}

/// What the searches of a run found.
pub(super) struct Searched<'r> {
    pub plan: Plan<'r>,
    pub minimum: Minimum,
    /// Share of each operating point in the decision; empty unless the worst case counts.
    pub shares: Vec<f64>,
    /// What polishing did.
    pub polished: Option<Polished>,
    /// Work of all marches through running-in.
    pub marches: Work,
    /// How a running-in design was searched.
    pub run_in: Option<RunInEnd>,
    /// All searches, if there were several.
    pub starts: Option<StartsReport>,
    /// Work of the searches that did not win: simulations, and gradients beyond them.
    pub others: (Cost, Cost),
}

/// Lets a plan save what it knows, and gives it what was saved of the same study by the same program; returns the number of
/// simulations that were known.
pub(super) fn resume<'r>(plan: &mut Plan<'r>, keep: &Keep<'r>) -> u64 {
    let known = keep.load().is_some_and(|found| plan.problem.restore(&found));
    let keep = keep.clone();
    plan.problem.saved_by(move |snapshot| keep.save(snapshot));
    if known { plan.problem.costs().0.simulations } else { 0 }
}

/// Searches from the study's start or from another design; the reason if the study's model does not exist or argmin failed. What is
/// saved gets `prefix` before its name.
pub(super) fn searches<'r>(
    study: &Study,
    from: Option<&[f64]>,
    prefix: &str,
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> Result<Searched<'r>, String> {
    let options = &study.optimiser.options;
    if study.optimiser.starts <= 1 {
        let mut plan = plan(study, study.engine, context).map_err(|e| e.to_string())?;
        let keep = Keep::of(study, format!("{prefix}search"), store);
        let known = resume(&mut plan, &keep);
        if known > 0 {
            let name = format!("going on where the last run stopped, with {known} simulations known");
            context.progress.tell(&Event::Stage { name });
        }
        let start = from.unwrap_or(&plan.start).to_vec();
        let End { minimum, shares, polished, marches, run_in } =
            seek(study, &plan, &start, options, (&keep, context))?;
        let others = Default::default();
        return Ok(Searched { plan, minimum, shares, polished, marches, run_in, starts: None, others });
    }
    let mut starts = starts(study);
    if let Some(from) = from {
        starts[0] = from.to_vec();
    }
    let ends: Vec<Result<(Plan, End), String>> = starts
        .par_iter()
        .enumerate()
        .map(|(k, start)| {
            let quiet = RunContext { progress: &Silent, ..context };
            let mut plan = plan(study, study.engine, quiet).map_err(|e| e.to_string())?;
            let keep = Keep::of(study, format!("{prefix}start-{k}"), store);
            resume(&mut plan, &keep);
            let end = seek(study, &plan, start, options, (&keep, quiet))?;
            let loss = end.minimum.values.as_ref().map_or(f64::NAN, |v| v.objective);
            let name = format!("start {} of {}: {}", k + 1, starts.len(), crate::report::short(loss));
            context.progress.tell(&Event::Stage { name: format!("{name} W") });
            Ok((plan, end))
        })
        .collect();
    let mut ends: Vec<(Plan, End)> = ends.into_iter().collect::<Result<_, _>>()?;
    let report = report(study, &starts, &ends);
    let first = ends.first().and_then(|(_, end)| end.run_in.as_ref().map(|r| (r.start, r.start_violation)));
    let best = (0..ends.len())
        .min_by(|a, b| rank(&ends[*a].1.minimum).total_cmp(&rank(&ends[*b].1.minimum)))
        .unwrap_or(0);
    let mut marches = Work::default();
    ends.iter().for_each(|(_, end)| marches += end.marches);
    let (mut plan, End { minimum, shares, polished, mut run_in, .. }) = ends.swap_remove(best);
    if let (Some(run_in), Some(start)) = (run_in.as_mut(), first) {
        (run_in.start, run_in.start_violation) = start;
    }
    let others = ends
        .iter()
        .map(|(p, _)| p.problem.costs())
        .fold((Cost::default(), Cost::default()), |a, c| (a.0 + c.0, a.1 + c.1));
    // The saving is against the study's start, whichever start led to the best design.
    plan.start = study.parameters.iter().map(|p| p.start).collect();
    Ok(Searched { plan, minimum, shares, polished, marches, run_in, starts: Some(report), others })
}

/// The start design in place of a search.
pub(super) fn simulated<'r>(study: &Study, context: RunContext<'r>) -> Result<Searched<'r>, String> {
    let plan = plan(study, study.engine, context).map_err(|e| e.to_string())?;
    let (outcome, values, failures) = match plan.problem.values(&plan.start) {
        Ok(values) => (Outcome::Simulated, Some(values), Vec::new()),
        Err(EvaluationError::Cancelled) => (Outcome::Cancelled, None, Vec::new()),
        Err(EvaluationError::Failed(reason)) => (Outcome::StartFailed, None, vec![reason]),
    };
    let minimum = Minimum { values, ..Minimum::unknown(outcome, plan.start.clone(), failures) };
    let (marches, others) = Default::default();
    let shares = Vec::new();
    Ok(Searched { plan, minimum, shares, polished: None, marches, run_in: None, starts: None, others })
}

/// Designs simulated for a plan.
fn simulations(plan: &Plan) -> u64 {
    plan.problem.costs().0.simulations / plan.cases.len() as u64
}

/// Feasible ends by their loss, others behind them by their violation.
pub(super) fn rank(end: &Minimum) -> f64 {
    match &end.values {
        Some(v) if v.violation() <= FEASIBLE => v.objective,
        Some(v) => 1e100 * (1.0 + v.violation()),
        None => f64::INFINITY,
    }
}

fn starts(study: &Study) -> Vec<Vec<f64>> {
    let p = &study.parameters;
    let spread = latin_hypercube(study.optimiser.starts as usize - 1, p.len(), study.optimiser.seed);
    let inside = |u: Vec<f64>| u.iter().zip(p).map(|(u, p)| p.lower + u * (p.upper - p.lower)).collect();
    std::iter::once(p.iter().map(|p| p.start).collect()).chain(spread.into_iter().map(inside)).collect()
}

fn report(study: &Study, starts: &[Vec<f64>], ends: &[(Plan, End)]) -> StartsReport {
    let shown = |x: &[f64]| -> Vec<f64> {
        x.iter().zip(&study.parameters).map(|(x, p)| p.variable.shown(*x)).collect()
    };
    let apart = |a: &[f64], b: &[f64]| {
        a.iter()
            .zip(b)
            .zip(&study.parameters)
            .fold(0.0f64, |m, ((a, b), p)| m.max((a - b).abs() / (p.upper - p.lower)))
    };
    let mut optima: Vec<(&Minimum, usize)> = Vec::new();
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|a, b| rank(&ends[*a].1.minimum).total_cmp(&rank(&ends[*b].1.minimum)));
    let mut belongs = vec![None; ends.len()];
    for k in order {
        let end = &ends[k].1.minimum;
        let converged = matches!(end.outcome, Outcome::Converged | Outcome::AlmostConverged);
        let Some(loss) = end.values.as_ref().map(|v| v.objective).filter(|_| converged) else { continue };
        let same = optima.iter().position(|(o, _)| {
            let theirs = o.values.as_ref().map_or(f64::NAN, |v| v.objective);
            (loss - theirs).abs() <= SAME_LOSS * theirs.abs() && apart(&end.x, &o.x) <= SAME_DESIGN
        });
        let at = same.unwrap_or_else(|| {
            optima.push((end, 0));
            optima.len() - 1
        });
        optima[at].1 += 1;
        belongs[k] = Some(at + 1);
    }
    let mut simulated: Vec<u64> =
        (0..ends.len()).filter(|k| belongs[*k].is_some()).map(|k| simulations(&ends[k].0)).collect();
    simulated.sort_unstable();
    let runs =
        ends.iter().zip(starts).zip(&belongs).map(|(((plan, End { minimum: end, .. }), start), optimum)| {
            StartRun {
                start: shown(start),
                status: end.outcome,
                loss_w: end.values.as_ref().map(|v| v.objective),
                violation: end.values.as_ref().map(|v| v.violation()),
                kkt: end.kkt.is_finite().then_some(end.kkt),
                simulations: simulations(plan),
                gradient_calls: end.gradients,
                optimum: *optimum,
            }
        });
    let optimum = |(end, found): &(&Minimum, usize)| LocalOptimum {
        loss_w: end.values.as_ref().map_or(f64::NAN, |v| v.objective),
        design: shown(&end.x),
        found: *found as u64,
    };
    let losses = || optima.iter().filter_map(|(end, _)| end.values.as_ref().map(|v| v.objective));
    let spread = losses().fold(f64::NEG_INFINITY, f64::max) - losses().fold(f64::INFINITY, f64::min);
    let same_loss = losses().next().is_some_and(|first| spread <= SAME_LOSS * first.abs());
    StartsReport {
        same_loss,
        seed: study.optimiser.seed,
        parameters: study.parameters.iter().map(|p| p.name.clone()).collect(),
        units: study.parameters.iter().map(|p| p.variable.unit.to_owned()).collect(),
        runs: runs.collect(),
        median_simulations: simulated.get(simulated.len() / 2).copied(),
        optima: optima.iter().map(optimum).collect(),
    }
}

/// Rivals of the study's own search, from the same start, one after the other; with their work and wall times, s.
pub(super) fn rivals<'r>(
    study: &Study,
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> (Vec<RivalRun>, (Cost, Cost), Vec<f64>) {
    let own = (study.optimiser.options.method, study.engine);
    if study.optimiser.rivals.is_empty() {
        return Default::default();
    }
    let all = std::iter::once(own).chain(study.optimiser.rivals.iter().copied());
    let (mut runs, mut cost, mut seconds) = (Vec::new(), (Cost::default(), Cost::default()), Vec::new());
    for (run, spent, time_s) in
        all.enumerate().filter_map(|(k, rival)| rival_run(study, k, rival, context, store))
    {
        runs.push(run);
        seconds.push(time_s);
        cost = (cost.0 + spent.0, cost.1 + spent.1);
    }
    (runs, cost, seconds)
}

fn rival_run<'r>(
    study: &Study,
    k: usize,
    (method, engine): (Method, EngineName),
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> Option<(RivalRun, (Cost, Cost), f64)> {
    let name = format!("rival {}: {} with {}", k + 1, method.words(), engine.as_str());
    context.progress.tell(&Event::Stage { name });
    if context.cancel.is_cancelled() {
        return None;
    }
    let began = Instant::now();
    let mut plan = plan(study, engine, context).ok()?;
    let keep = Keep::of(study, format!("rival-{k}"), store);
    resume(&mut plan, &keep);
    let options = SearchOptions { method, ..study.optimiser.options };
    let End { minimum: end, marches, .. } =
        seek(study, &plan, &plan.start, &options, (&keep, context)).ok()?;
    let (simulations, gradients) = plan.problem.costs();
    let (simulations, gradients) = (simulations + marches.marches, gradients + marches.gradients);
    let per_cycle = simulations.factorisations as f64 / simulations.simulations.max(1) as f64;
    let cases = plan.cases.len() as f64;
    let run = RivalRun {
        method,
        engine,
        status: end.outcome,
        loss_w: end.values.as_ref().map(|v| v.objective),
        violation: end.values.as_ref().map(|v| v.violation()),
        kkt: end.kkt.is_finite().then_some(end.kkt),
        simulations: simulations.simulations as f64 / cases,
        gradient_calls: end.gradients,
        gradient_simulations: gradients.factorisations as f64 / per_cycle / cases,
    };
    Some((run, (simulations, gradients), began.elapsed().as_secs_f64()))
}

//! The search of a running-in design, in legs: if it pays, first with the cheap approximation of the march; then with the march itself,
//! in blocks that are right for where the leg begins, until they are right for where it ends.

use super::build::Plan;
use super::check::Study;
use super::keep::Keep;
use super::programme::programme;
use super::running_in::RunningInPlan;
use super::running_in_design::{Proof, RunningInProblem, Work};
use super::seek::End;
use crate::optimise::{Budget, ConstrainedProblem, EvaluationError, Minimum, Outcome, SearchOptions, search};
use crate::report::ApproximationReport;
use crate::run::{Event, RunContext};
use crate::running_in::weights;
use std::time::Instant;

/// Largest share of the blocks that groups may be, to be worth a leg of their own.
const WORTHWHILE: f64 = 0.5;
/// Blocks are right for a design if a march of its own finds values no farther apart than this.
const AGREES: f64 = 1e-3;
/// Tolerance of the leg with the approximation, which errs by more.
const NEAR: f64 = 1e-3;
/// Legs with the march itself at most.
const MOST_LEGS: usize = 3;

/// What the search of a running-in design tells beside its minimum.
#[derive(Debug, Clone)]
pub(super) struct RunInEnd {
    /// The minimised quantity at the study's start design.
    pub start: f64,
    /// Largest relative violation of any limit there; none if it is not known.
    pub start_violation: Option<f64>,
    /// The leg with the approximation, if there was one.
    pub approximation: Option<ApproximationReport>,
    /// The gradient at the design found.
    pub proof: Option<Proof>,
}

/// A search on its way.
struct Legs<'a, 'r> {
    study: &'a Study,
    wanted: &'a RunningInPlan,
    plan: &'a Plan<'r>,
    options: &'a SearchOptions,
    keep: &'a Keep<'a>,
    context: RunContext<'a>,
    began: Instant,
}

/// Searches from a start.
pub(super) fn seek_run_in(
    study: &Study,
    wanted: &RunningInPlan,
    plan: &Plan,
    start: &[f64],
    options: &SearchOptions,
    (keep, context): (&Keep<'_>, RunContext<'_>),
) -> Result<End, String> {
    let legs = Legs { study, wanted, plan, options, keep, context, began: Instant::now() };
    let known = legs.problem(start, 0).and_then(|p| p.objective(start).map(|value| (p, value)));
    let (mut problem, here) = match known {
        Ok(known) => known,
        Err(e) => return Ok(ended(stopped(start, &e), Work::default(), None)),
    };
    // What is saved is saved against the study's start, wherever this search began.
    let study_start = problem.values(&plan.start).ok();
    let mut marches = Work::default();
    let (mut minimum, mut rough, mut proof): (Option<Minimum>, _, _) = (None, None, None);
    let (blocks, groups) = problem.sizes();
    if wanted.approximate_first && groups as f64 <= WORTHWHILE * blocks as f64 {
        let (near, approximated) = legs.approximate(&problem, start)?;
        let iterations = near.history.len();
        let goes_on = near.values.is_some() && near.outcome != Outcome::Cancelled;
        let next = goes_on.then(|| legs.problem(&near.x, 1));
        let went_on = matches!(next, Some(Ok(_) | Err(EvaluationError::Failed(_))));
        match next {
            Some(Ok(next)) => {
                marches += std::mem::replace(&mut problem, next).work();
                minimum = Some(near);
            }
            // Where the march cannot follow, it begins at the start.
            Some(Err(EvaluationError::Failed(_))) => {}
            Some(Err(EvaluationError::Cancelled)) => {
                marches += problem.work();
                minimum = Some(Minimum { outcome: Outcome::Cancelled, ..near });
            }
            None => {
                marches += problem.work();
                minimum = Some(near);
            }
        }
        rough = Some((approximated, iterations, went_on));
    }
    if rough.as_ref().is_none_or(|(.., went_on)| *went_on) {
        let (end, found) = legs.with_the_march(problem, start, minimum, &mut marches)?;
        (minimum, proof) = (Some(end), found);
    }
    let minimum = minimum.ok_or("there was no search")?;
    let approximation = rough.map(|(rough, iterations, final_leg)| {
        let exact = [Some(here), minimum.values.as_ref().filter(|_| final_leg).map(|v| v.objective)];
        let error = |x: &[f64], exact: f64| rough.objective(x).ok().map(|a| 100.0 * (a / exact - 1.0));
        let [at_start, at_end] = exact;
        let report = ApproximationReport {
            blocks,
            groups,
            alpha: legs.alpha(&rough, start),
            start_error_percent: at_start.and_then(|exact| error(start, exact)).unwrap_or_default(),
            design_error_percent: at_end.and_then(|exact| error(&minimum.x, exact)),
            iterations: iterations as u64,
            simulations: rough.work().marches.simulations,
            march_simulations: marches.marches.simulations,
            final_leg,
        };
        marches += rough.work();
        report
    });
    let run_in = Some(RunInEnd {
        start: study_start.as_ref().map_or(here, |v| v.objective),
        start_violation: study_start.map(|v| v.violation()),
        approximation,
        proof,
    });
    Ok(ended(minimum, marches, run_in))
}

fn ended(minimum: Minimum, marches: Work, run_in: Option<RunInEnd>) -> End {
    End { minimum, shares: Vec::new(), polished: None, marches, run_in }
}

/// The end of a search whose start cannot be run in.
fn stopped(start: &[f64], why: &EvaluationError) -> Minimum {
    let (outcome, failures) = match why {
        EvaluationError::Cancelled => (Outcome::Cancelled, Vec::new()),
        EvaluationError::Failed(reason) => {
            (Outcome::StartFailed, vec![format!("the start design cannot be run in: {reason}")])
        }
    };
    Minimum::unknown(outcome, start.to_vec(), failures)
}

/// A leg behind those before it.
fn joined(before: Option<Minimum>, mut end: Minimum) -> Minimum {
    let Some(before) = before else { return end };
    let steps = before.history.len() as u64;
    let simulations = before.history.last().map_or(0, |h| h.simulations);
    for h in &mut end.history {
        h.iteration += steps;
        h.simulations += simulations;
    }
    end.history.splice(0..0, before.history);
    end.failures.splice(0..0, before.failures);
    end.evaluations += before.evaluations;
    end.gradients += before.gradients;
    end
}

impl<'a, 'r> Legs<'a, 'r> {
    /// The problem with the blocks of a design.
    fn problem(&self, from: &[f64], leg: usize) -> Result<RunningInProblem<'a, 'r>, EvaluationError> {
        let keep = self.keep.beside(&format!("marches-{leg}"));
        RunningInProblem::new(self.study, self.wanted, self.plan, from, keep, self.context)
    }

    fn tell(&self, name: &str) {
        self.context.progress.tell(&Event::Stage { name: name.to_owned() });
    }

    /// Searches with the march itself until its blocks are right for where it ends.
    fn with_the_march(
        &self,
        mut problem: RunningInProblem<'a, 'r>,
        start: &[f64],
        mut minimum: Option<Minimum>,
        marches: &mut Work,
    ) -> Result<(Minimum, Option<Proof>), String> {
        let mut leg = 1;
        let ended = loop {
            leg += 1;
            let from = minimum.as_ref().map_or(start, |m: &Minimum| &m.x).to_vec();
            let options = SearchOptions { budget: self.left(minimum.as_ref()), ..*self.options };
            let end = search(&problem, &from, &options).map_err(|e| e.to_string())?;
            let mut end = joined(minimum, end);
            if end.values.is_none() || matches!(end.outcome, Outcome::Cancelled | Outcome::BudgetSpent) {
                break (end, None);
            }
            let next = match self.problem(&end.x, leg) {
                Ok(next) => next,
                Err(EvaluationError::Cancelled) => {
                    break (Minimum { outcome: Outcome::Cancelled, ..end }, None);
                }
                Err(EvaluationError::Failed(reason)) => {
                    end.failures
                        .push(format!("the design found cannot be marched in blocks of its own: {reason}"));
                    break (Minimum { outcome: Outcome::NoProgress, ..end }, None);
                }
            };
            let apart = problem.apart(&end.x, &next).unwrap_or(f64::INFINITY);
            if apart > AGREES && leg <= MOST_LEGS {
                *marches += std::mem::replace(&mut problem, next).work();
                minimum = Some(end);
                continue;
            }
            *marches += next.work();
            if apart > AGREES {
                let percent = crate::report::short(100.0 * apart);
                end.failures.push(format!(
                    "marched in blocks of its own the design found differs by {percent} %; reduce running_in.wear_depth_tolerance"
                ));
                end.outcome = Outcome::NoProgress;
            }
            let proof = problem.proof(&end.x).ok();
            break (end, proof);
        };
        *marches += problem.work();
        Ok(ended)
    }

    /// What earlier legs left of the budget.
    fn left(&self, before: Option<&Minimum>) -> Budget {
        let (budget, spent) = (self.options.budget, before.map_or(0, |m| m.evaluations));
        Budget {
            simulations: budget.simulations.map(|n| n.saturating_sub(spent).max(1)),
            seconds: budget.seconds.map(|s| (s - self.began.elapsed().as_secs_f64()).max(0.0)),
        }
    }

    /// Searches with the approximation.
    fn approximate(
        &self,
        exact: &RunningInProblem<'a, 'r>,
        start: &[f64],
    ) -> Result<(Minimum, RunningInProblem<'a, 'r>), String> {
        self.tell("optimising with an approximation of the march");
        let rough = exact.approximated(self.keep.beside("groups"));
        let half = Budget {
            simulations: self.options.budget.simulations.map(|n| n.div_ceil(2)),
            seconds: self.options.budget.seconds.map(|s| 0.5 * s),
        };
        let mut options = SearchOptions { budget: half, ..*self.options };
        options.settings.tolerance = options.settings.tolerance.max(NEAR);
        let near = search(&rough, start, &options).map_err(|e| e.to_string())?;
        self.tell("optimising with the march itself");
        Ok((near, rough))
    }

    /// The weights of the first bearing's groups, which were chosen at a start.
    fn alpha(&self, rough: &RunningInProblem, start: &[f64]) -> Vec<f64> {
        let stages = programme(self.study, self.wanted, start);
        let durations_s: Vec<f64> = stages.iter().map(|s| s.duration_s).collect();
        rough.blocks().first().map_or_else(Vec::new, |own| weights(own, &durations_s))
    }
}

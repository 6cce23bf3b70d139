//! The search of a running-in design, in legs: if it pays, first with the cheap approximation of the march; then with the march itself,
//! in blocks that are right for where the leg begins, until they are right for where it ends.

use super::build::Plan;
use super::check::Study;
use super::keep::Keep;
use super::running_in::RunningInPlan;
use super::running_in_design::RunningInProblem;
use super::seek::End;
use crate::optimise::{Budget, EvaluationError, Minimum, Outcome, SearchOptions, search};
use crate::report::ApproximationReport;
use crate::run::{Cost, Event, RunContext};
use crate::running_in::{Stage, weights};

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
    /// The minimised quantity at the start design.
    pub start: f64,
    /// The leg with the approximation, if there was one.
    pub approximation: Option<ApproximationReport>,
}

/// A search on its way.
struct Legs<'a, 'r> {
    study: &'a Study,
    wanted: &'a RunningInPlan,
    plan: &'a Plan<'r>,
    options: &'a SearchOptions,
    keep: &'a Keep<'a>,
    context: RunContext<'a>,
}

fn cannot(e: EvaluationError) -> String {
    format!("the start design cannot be run in: {e}")
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
    let legs = Legs { study, wanted, plan, options, keep, context };
    let mut problem = legs.problem(start, 0).map_err(cannot)?;
    let start_value = problem.objective(start).map_err(cannot)?;
    let mut marches = Cost::default();
    let (mut minimum, mut rough) = (None, None);
    let (blocks, groups) = problem.sizes();
    if wanted.approximate_first && groups as f64 <= WORTHWHILE * blocks as f64 {
        let (near, approximated) = legs.approximate(&problem, start)?;
        let go_on = near.outcome != Outcome::Cancelled && near.values.is_some();
        marches += problem.cost();
        if go_on {
            problem = legs.problem(&near.x, 1).map_err(cannot)?;
        } else {
            marches = marches + approximated.cost() + problem.cost();
        }
        rough = Some((approximated, near.history.len(), go_on));
        minimum = Some(near);
    }
    if rough.as_ref().is_none_or(|(.., go_on)| *go_on) {
        for leg in 1..=MOST_LEGS {
            let from = minimum.as_ref().map_or(start, |m: &Minimum| &m.x).to_vec();
            let end = search(&problem, &from, options).map_err(|e| e.to_string())?;
            marches += problem.cost();
            let usable = end.values.is_some() && end.outcome != Outcome::Cancelled && leg < MOST_LEGS;
            let next = if usable { legs.problem(&end.x, leg + 1).ok() } else { None };
            minimum = Some(joined(minimum, end));
            let Some((next, end)) = next.zip(minimum.as_ref()) else { break };
            if problem.apart(&end.x, &next).is_ok_and(|apart| apart <= AGREES) {
                marches += next.cost();
                break;
            }
            problem = next;
        }
    }
    let minimum = minimum.ok_or("there was no search")?;
    let approximation = rough.map(|(rough, iterations, final_leg)| {
        let report = legs.report(&rough, start, start_value, (blocks, iterations), marches);
        marches += rough.cost();
        finished(report, &rough, &minimum, final_leg)
    });
    let run_in = Some(RunInEnd { start: start_value, approximation });
    Ok(End { minimum, shares: Vec::new(), polished: None, marches, run_in })
}

/// A leg behind those before it.
fn joined(before: Option<Minimum>, mut end: Minimum) -> Minimum {
    let Some(before) = before else { return end };
    let steps = before.history.len() as u64;
    end.history.iter_mut().for_each(|h| h.iteration += steps);
    end.history.splice(0..0, before.history);
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

    fn report(
        &self,
        rough: &RunningInProblem,
        start: &[f64],
        exact: f64,
        (blocks, iterations): (usize, usize),
        marches: Cost,
    ) -> ApproximationReport {
        let of = |stages: Vec<Stage>| rough.blocks().first().map(|own| weights(own, &stages));
        let stages = super::programme::stages(self.study, self.wanted, self.plan, 0, start);
        let at_start = rough.objective(start).unwrap_or(exact);
        ApproximationReport {
            blocks,
            groups: super::running_in_design::count(rough.blocks()),
            alpha: stages.ok().and_then(of).unwrap_or_default(),
            start_error_percent: 100.0 * (at_start / exact - 1.0),
            design_error_percent: None,
            iterations: iterations as u64,
            simulations: 0,
            march_simulations: marches.simulations,
            final_leg: false,
        }
    }
}

/// The report of the approximation with what is known in the end.
fn finished(
    mut report: ApproximationReport,
    rough: &RunningInProblem,
    end: &Minimum,
    final_leg: bool,
) -> ApproximationReport {
    let exact = end.values.as_ref().filter(|_| final_leg).map(|v| v.objective);
    let found = exact.and_then(|exact| rough.objective(&end.x).ok().map(|a| 100.0 * (a / exact - 1.0)));
    report.design_error_percent = found;
    report.simulations = rough.cost().simulations;
    report.final_leg = final_leg;
    report
}

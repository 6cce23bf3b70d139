//! Sequential quadratic programming with damped BFGS, an l1 merit function and second-order correction.
//!
//! Each iteration solves one sub-problem ([`super::qp`]) for a step `d` and multipliers, then searches along `d` on
//! `f + sum mu max(c, 0) + sum mu |g|`, where each weight `mu` follows the multiplier of its constraint up at once and down by halves
//! (Powell 1978); if the full step is refused because the constraints curve, it is corrected once with
//! their values there. A point that cannot be evaluated counts as a refused trial: the step is halved. Gradients are asked
//! at accepted points only. The Hessian is [`super::quasi_newton`]'s.
//!
//! The KKT residual is the largest of `|grad L|`, `|lambda c|` and the violation, in scaled variables and with the
//! objective divided by its start value.

use super::bundle;
use super::kkt::{kkt_residual, lagrangian};
use super::minimum::{Ended, Incumbent, Minimum};
use super::problem::Scaled;
use super::qp::{Qp, QpSolution};
use super::quasi_newton::QuasiNewton;
use super::state::Iterate;
use super::{ConstrainedProblem, EvaluationError, Outcome, Slopes, SqpState, Values};
use crate::run::IterationEvent;
use argmin::core::{Error, Executor, KV, Problem, Solver, State, TerminationStatus};
use nalgebra::{DMatrix, DVector};

/// Largest change of a scaled variable that counts as standing still, and how often in a row ends the search.
const STILL: f64 = 1e-9;
const STALLED: u32 = 3;
/// A KKT residual that does not fall below this share of the one before has come to a halt, perhaps at a kink.
const STAGNANT: f64 = 0.7;

/// Settings of the optimiser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SqpOptions {
    /// KKT residual (scaled) at which the design counts as optimal.
    pub tolerance: f64,
    /// Iterations at most.
    pub max_iterations: u64,
    /// Longest change of a scaled variable in the first iteration; it doubles whenever a step of that length was taken whole.
    pub step_limit: f64,
}

impl Default for SqpOptions {
    fn default() -> Self {
        Self { tolerance: 1e-6, max_iterations: 60, step_limit: 0.4 }
    }
}

/// The argmin solver.
pub struct Sqp {
    pub(super) options: SqpOptions,
}

impl Sqp {
    /// A solver with the given settings.
    pub fn new(options: SqpOptions) -> Self {
        Self { options }
    }
}

/// What argmin carries for the solver.
pub(super) struct Operator<'p, P: ?Sized> {
    pub(super) scaled: Scaled<'p, P>,
}

/// Minimises a problem from a start; the start is moved into the bounds if it lies outside.
pub fn minimise<P: ConstrainedProblem + ?Sized>(
    problem: &P,
    start: &[f64],
    options: SqpOptions,
) -> Result<Minimum, Error> {
    let mut scaled = Scaled::new(problem, start);
    let s = match scaled.allowed(start) {
        Ok(s) => s,
        Err(end) => return Ok(*end),
    };
    // A start that cannot be evaluated is told by the search itself.
    let _ = scaled.scale_objective_at(&s);
    let result = Executor::new(Operator { scaled }, Sqp::new(options))
        .configure(|state: SqpState| state.start(s.clone()).max_iters(options.max_iterations))
        .ctrlc(false)
        .run()?;
    let (mut problem, mut state) = (result.problem, result.state);
    settle_last(options, &mut problem, &mut state);
    let count = |name: &str| problem.counts.get(name).copied().unwrap_or(0);
    let (evaluations, gradients) = (count("evaluations"), count("gradients"));
    let converged = state.incumbent.as_ref().is_some_and(|b| b.kkt <= options.tolerance);
    let limit = if converged { Outcome::Converged } else { Outcome::IterationLimit };
    let operator = problem.problem.ok_or_else(|| Error::msg("argmin lost the problem"))?;
    let ended = Ended {
        outcome: state.outcome.unwrap_or(limit),
        best: state.incumbent,
        start: s,
        history: state.history,
        failures: state.failures,
        evaluations,
        gradients,
    };
    Ok(ended.restored(&operator.scaled))
}

/// At the iteration limit nothing has yet judged the last point; its sub-problem costs no evaluation.
fn settle_last<P: ConstrainedProblem + ?Sized>(
    options: SqpOptions,
    problem: &mut Problems<'_, P>,
    state: &mut SqpState,
) {
    let Some(now) = state.iterate.clone().filter(|_| state.outcome.is_none()) else { return };
    let qp = Sqp::new(options).sub_problem(problem, &now, state.model.matrix(), &now.values, state.radius);
    if let Some(qp) = qp {
        (state.kkt, state.combined) = (residual(problem, &now, &qp), 1);
        state.multipliers = qp.multipliers;
        report(problem, state, &now);
        state.judge(state.kkt <= options.tolerance);
    }
}

pub(super) type Problems<'p, P> = Problem<Operator<'p, P>>;

impl<'p, P: ConstrainedProblem + ?Sized> Solver<Operator<'p, P>, SqpState> for Sqp {
    fn name(&self) -> &str {
        "SQP"
    }

    fn init(
        &mut self,
        problem: &mut Problems<'p, P>,
        mut state: SqpState,
    ) -> Result<(SqpState, Option<KV>), Error> {
        let x = state.start_point().ok_or_else(|| Error::msg("no start"))?.to_vec();
        state.model = QuasiNewton::new(x.len());
        state.radius = self.options.step_limit;
        let values = match evaluate(problem, &x) {
            Ok(values) => values,
            Err(e) => return Ok((refuse(state, e, Outcome::StartFailed), None)),
        };
        match differentiate(problem, &x) {
            Ok(slopes) => state.iterate = Some(Iterate { x, values, slopes }),
            Err(e) => return Ok((refuse(state, e, Outcome::StartFailed), None)),
        }
        state.remember(self.options.tolerance);
        Ok((state, None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problems<'p, P>,
        mut state: SqpState,
    ) -> Result<(SqpState, Option<KV>), Error> {
        let Some(now) = state.iterate.clone() else { return Ok((state.end(Outcome::StartFailed), None)) };
        let Some(qp) = self.sub_problem(problem, &now, state.model.matrix(), &now.values, state.radius)
        else {
            return Ok((self.give_up(state), None));
        };
        state.kkt = residual(problem, &now, &qp);
        state.combined = 1;
        let stagnant = state.kkt > STAGNANT * state.last_kkt;
        state.last_kkt = state.kkt;
        let beyond = if stagnant { self.at_kink(problem, &mut state, &now) } else { None };
        let qp = beyond.unwrap_or(qp);
        state.multipliers = qp.multipliers.clone();
        report(problem, &mut state, &now);
        let converged = state.kkt <= self.options.tolerance;
        state.judge(converged);
        if converged {
            return Ok((state.end(Outcome::Converged), None));
        }
        if state.stalled >= STALLED {
            return Ok((self.give_up(state), None));
        }
        let size = qp.step.iter().fold(0.0f64, |a, d| a.max(d.abs()));
        if qp.elastic && size < 1e-8 && now.values.violation() > self.options.tolerance {
            return Ok((state.end(Outcome::Infeasible), None));
        }
        state.weigh(&qp.multipliers);
        match self.accept(problem, &mut state, &now, &qp) {
            Err(EvaluationError::Cancelled) => Ok((state.end(Outcome::Cancelled), None)),
            Err(EvaluationError::Failed(_)) if !state.model.is_fresh() => {
                // The curvature may be stale: try once more along the steepest descent.
                state.model.restart();
                Ok((state, None))
            }
            Err(EvaluationError::Failed(_)) => Ok((self.give_up(state), None)),
            Ok(None) => {
                state.nulls += 1;
                Ok((state, None))
            }
            Ok(Some(next)) => {
                state.nulls = 0;
                update_model(&mut state, &now, &next);
                let full = size >= 0.99 * state.radius;
                state.last_step = next.x.iter().zip(&now.x).fold(0.0, |a, (b, c)| a.max((b - c).abs()));
                // A whole step to the limit that was taken at once asks for a longer one.
                if full && state.last_step >= 0.99 * state.radius {
                    state.radius *= 2.0;
                }
                state.stalled = if state.last_step < STILL { state.stalled + 1 } else { 0 };
                state.earlier.push_front(now);
                state.earlier.truncate(bundle::KEPT);
                state.iterate = Some(next);
                state.remember(self.options.tolerance);
                Ok((state, None))
            }
        }
    }

    fn terminate_internal(&mut self, state: &SqpState) -> TerminationStatus {
        if state.terminated() {
            return state.get_termination_status().clone();
        }
        if state.get_iter() >= state.get_max_iters() {
            return TerminationStatus::Terminated(argmin::core::TerminationReason::MaxItersReached);
        }
        TerminationStatus::NotTerminated
    }
}

impl Sqp {
    pub(super) fn sub_problem<P: ConstrainedProblem + ?Sized>(
        &self,
        problem: &mut Problems<'_, P>,
        now: &Iterate,
        hessian: &DMatrix<f64>,
        values: &Values,
        radius: f64,
    ) -> Option<QpSolution> {
        let scaled = &problem.problem.as_ref()?.scaled;
        let (lower, upper) = self.room(&now.x, scaled, radius);
        let linear = &scaled.linear_from(&now.x);
        Qp { hessian, values, slopes: &now.slopes, linear, lower: &lower, upper: &upper }.solve()
    }

    /// The sub-problem with all gradients met within the tolerance of the point, if there are several: at a kink no single one says
    /// where to go. Lowers the KKT residual to that of their combination.
    fn at_kink<P: ConstrainedProblem + ?Sized>(
        &self,
        problem: &Problems<'_, P>,
        state: &mut SqpState,
        now: &Iterate,
    ) -> Option<QpSolution> {
        let tolerance = self.options.tolerance;
        let near = |i: &&Iterate| i.x.iter().zip(&now.x).all(|(a, b)| (a - b).abs() <= tolerance);
        let beside: Vec<&Iterate> = state.earlier.iter().filter(near).collect();
        if beside.is_empty() || state.kkt <= tolerance {
            return None;
        }
        let scaled = &problem.problem.as_ref()?.scaled;
        let (lower, upper) = self.room(&now.x, scaled, state.radius);
        let linear = scaled.linear_from(&now.x);
        let (solution, kkt) = bundle::solve(now, &beside, state.model.matrix(), &linear, (&lower, &upper))?;
        let combined = 1 + beside.len();
        if kkt < state.kkt {
            (state.kkt, state.combined) = (kkt, combined);
        }
        Some(solution)
    }

    /// Bounds of a step.
    fn room<P: ?Sized>(&self, x: &[f64], scaled: &Scaled<'_, P>, radius: f64) -> (Vec<f64>, Vec<f64>) {
        let lower = x.iter().zip(&scaled.lower).map(|(x, l)| (l - x).max(-radius)).collect();
        let upper = x.iter().zip(&scaled.upper).map(|(x, u)| (u - x).min(radius)).collect();
        (lower, upper)
    }

    /// Names the end of a run that cannot go on.
    fn give_up(&self, state: SqpState) -> SqpState {
        let outcome = Incumbent::give_up(state.incumbent.as_ref(), self.options.tolerance);
        state.end(outcome)
    }
}

fn residual<P: ConstrainedProblem + ?Sized>(
    problem: &Problems<'_, P>,
    now: &Iterate,
    qp: &QpSolution,
) -> f64 {
    let linear = problem.problem.as_ref().map_or_else(Vec::new, |o| o.scaled.linear_from(&now.x));
    kkt_residual(&now.values, &now.slopes, &linear, qp)
}

pub(super) fn evaluate<P: ConstrainedProblem + ?Sized>(
    problem: &mut Problems<'_, P>,
    x: &[f64],
) -> Result<Values, EvaluationError> {
    let mut refused = None;
    let result = problem.problem("evaluations", |o| o.scaled.values(x).map_err(|e| note(&mut refused, e)));
    result.map_err(|_| refused.unwrap_or(EvaluationError::Cancelled))
}

pub(super) fn differentiate<P: ConstrainedProblem + ?Sized>(
    problem: &mut Problems<'_, P>,
    x: &[f64],
) -> Result<Slopes, EvaluationError> {
    let mut refused = None;
    let result = problem.problem("gradients", |o| o.scaled.slopes(x).map_err(|e| note(&mut refused, e)));
    result.map_err(|_| refused.unwrap_or(EvaluationError::Cancelled))
}

/// argmin wants its own error type; the reason is kept beside it.
fn note(slot: &mut Option<EvaluationError>, e: EvaluationError) -> Error {
    let text = e.to_string();
    *slot = Some(e);
    Error::msg(text)
}

fn refuse(mut state: SqpState, e: EvaluationError, otherwise: Outcome) -> SqpState {
    match e {
        EvaluationError::Cancelled => state.end(Outcome::Cancelled),
        EvaluationError::Failed(reason) => {
            state.failures.push(reason);
            state.end(otherwise)
        }
    }
}

fn report<P: ConstrainedProblem + ?Sized>(problem: &Problems<'_, P>, state: &mut SqpState, now: &Iterate) {
    let Some(operator) = &problem.problem else { return };
    let news = IterationEvent {
        iteration: state.get_iter(),
        objective_w: now.values.objective * operator.scaled.objective_scale,
        violation: now.values.violation(),
        kkt: state.kkt,
        step: state.last_step,
        simulations: problem.counts.get("evaluations").copied().unwrap_or(0),
    };
    operator.scaled.problem.accepted(&news);
    state.history.push(news);
}

/// Lets the model of the curvature know the change of the Lagrangian's gradient.
fn update_model(state: &mut SqpState, last: &Iterate, next: &Iterate) {
    let s = DVector::from_iterator(last.x.len(), next.x.iter().zip(&last.x).map(|(b, a)| b - a));
    let y = lagrangian(&next.slopes, &state.multipliers) - lagrangian(&last.slopes, &state.multipliers);
    state.model.update(s, y);
}

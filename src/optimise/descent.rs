//! The way along a step of the sub-problem: trials until the merit function falls enough, a second-order correction where the
//! constraints curve, a null step where a kink lies in between.

use super::bundle;
use super::qp::QpSolution;
use super::sqp::{Problems, Sqp, differentiate, evaluate};
use super::state::Iterate;
use super::{ConstrainedProblem, EvaluationError, SqpState, Values};
use crate::math::dot;

/// Share of the predicted decrease that a step must achieve (Armijo).
const ARMIJO: f64 = 1e-4;
/// Shortest step tried.
const SHORTEST: f64 = 1e-7;
/// Rounding of the merit function that a search must not stumble over.
const ROUNDING: f64 = 1e-12;

impl Sqp {
    /// A point that improves the merit and has a gradient: a point without one counts as refused, like one without values.
    pub(super) fn accept<P: ConstrainedProblem + ?Sized>(
        &self,
        problem: &mut Problems<'_, P>,
        state: &mut SqpState,
        now: &Iterate,
        qp: &QpSolution,
    ) -> Result<Option<Iterate>, EvaluationError> {
        let mut longest = 1.0;
        loop {
            let found = self.search(problem, state, now, qp, longest)?;
            let Some((x, values, share)) = found else { return Ok(None) };
            match differentiate(problem, &x) {
                Ok(slopes) => return Ok(Some(Iterate { x, values, slopes })),
                Err(EvaluationError::Cancelled) => return Err(EvaluationError::Cancelled),
                Err(EvaluationError::Failed(reason)) => state.failures.push(reason),
            }
            longest = 0.5 * share;
        }
    }

    /// Searches along the step, no further than `longest` of it; returns an accepted point with its share of the step. A refused trial
    /// within the tolerance of the point lies beyond a kink: its gradient is kept, and nothing is returned (a null step, Lemarechal
    /// 1975), so that the next sub-problem knows both sides.
    fn search<P: ConstrainedProblem + ?Sized>(
        &self,
        problem: &mut Problems<'_, P>,
        state: &mut SqpState,
        now: &Iterate,
        qp: &QpSolution,
        longest: f64,
    ) -> Result<Option<(Vec<f64>, Values, f64)>, EvaluationError> {
        let longest_change = qp.step.iter().fold(0.0f64, |a, d| a.max(d.abs()));
        let penalties = state.penalties.clone();
        let missed = |v: &Values| v.weighted_violation(&penalties);
        let merit = |v: &Values| v.objective + missed(v);
        let here = merit(&now.values);
        let slope =
            dot(&now.slopes.objective, &qp.step) - (missed(&now.values) - missed(&linearised(now, &qp.step)));
        let enough = |v: &Values, share: f64| {
            merit(v) <= here + ARMIJO * share * slope.min(0.0) + ROUNDING * here.abs()
        };
        let mut share = longest;
        while share >= SHORTEST {
            let x = moved(problem, &now.x, &qp.step, share);
            match evaluate(problem, &x) {
                Err(EvaluationError::Cancelled) => return Err(EvaluationError::Cancelled),
                Err(EvaluationError::Failed(reason)) => {
                    state.failures.push(reason);
                    share *= 0.5;
                }
                Ok(values) if enough(&values, share) => return Ok(Some((x, values, share))),
                Ok(values) => {
                    let curved = share == 1.0 && missed(&values) > missed(&now.values);
                    if curved
                        && let Some(found) = self.corrected(problem, state, now, qp, &values, &enough)?
                    {
                        return Ok(Some((found.0, found.1, share)));
                    }
                    let beside = share * longest_change <= self.options.tolerance;
                    if beside
                        && state.nulls < bundle::KEPT
                        && let Ok(slopes) = differentiate(problem, &x)
                    {
                        state.earlier.push_front(Iterate { x, values, slopes });
                        state.earlier.truncate(bundle::KEPT);
                        return Ok(None);
                    }
                    // Minimum of the parabola through both merits and the slope.
                    let rise = merit(&values) - here - share * slope;
                    let best = if rise > 0.0 { -0.5 * slope * share * share / rise } else { 0.5 * share };
                    share = best.clamp(0.1 * share, 0.5 * share);
                }
            }
        }
        Err(EvaluationError::Failed("no step along the search direction improves the design".into()))
    }

    /// Second-order correction: the step again, with the constraints as they really are at its end.
    fn corrected<P: ConstrainedProblem + ?Sized>(
        &self,
        problem: &mut Problems<'_, P>,
        state: &SqpState,
        now: &Iterate,
        qp: &QpSolution,
        there: &Values,
        enough: &dyn Fn(&Values, f64) -> bool,
    ) -> Result<Option<(Vec<f64>, Values)>, EvaluationError> {
        let shifted = |rows: &[Vec<f64>], values: &[f64]| -> Vec<f64> {
            rows.iter().zip(values).map(|(row, c)| c - dot(row, &qp.step)).collect()
        };
        let values = Values {
            objective: now.values.objective,
            inequalities: shifted(&now.slopes.inequalities, &there.inequalities),
            equalities: shifted(&now.slopes.equalities, &there.equalities),
        };
        let Some(again) = self.sub_problem(problem, now, state.model.matrix(), &values, state.radius) else {
            return Ok(None);
        };
        let x = moved(problem, &now.x, &again.step, 1.0);
        match evaluate(problem, &x) {
            Ok(values) if enough(&values, 1.0) => Ok(Some((x, values))),
            Err(EvaluationError::Cancelled) => Err(EvaluationError::Cancelled),
            _ => Ok(None),
        }
    }
}

/// `x + share * step`, inside the bounds.
fn moved<P: ConstrainedProblem + ?Sized>(
    problem: &Problems<'_, P>,
    x: &[f64],
    step: &[f64],
    share: f64,
) -> Vec<f64> {
    let bounds = problem.problem.as_ref().map(|o| (&o.scaled.lower, &o.scaled.upper));
    (0..x.len())
        .map(|j| {
            let to = x[j] + share * step[j];
            bounds.map_or(to, |(low, high)| to.clamp(low[j], high[j]))
        })
        .collect()
}

/// Values of the linear model after a step.
fn linearised(now: &Iterate, step: &[f64]) -> Values {
    let after =
        |rows: &[Vec<f64>], values: &[f64]| rows.iter().zip(values).map(|(r, v)| v + dot(r, step)).collect();
    Values {
        objective: now.values.objective + dot(&now.slopes.objective, step),
        inequalities: after(&now.slopes.inequalities, &now.values.inequalities),
        equalities: after(&now.slopes.equalities, &now.values.equalities),
    }
}

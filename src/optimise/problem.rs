//! The abilities a problem needs to be optimised, and its form in scaled variables.

use super::linear::nearest;
use super::minimum::Ended;
use super::{LinearConstraint, Minimum, Outcome};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Objective and constraint values at a point. Constraints should be scaled to order one: one tolerance judges them all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// `f`.
    pub objective: f64,
    /// `c`, feasible at or below zero.
    pub inequalities: Vec<f64>,
    /// `g`, feasible at zero.
    pub equalities: Vec<f64>,
}

impl Values {
    /// Largest violation of any constraint.
    pub fn violation(&self) -> f64 {
        let above = self.inequalities.iter().fold(0.0f64, |a, c| a.max(*c));
        self.equalities.iter().fold(above, |a, g| a.max(g.abs()))
    }

    /// Sum of all violations with a weight each, inequalities first.
    pub(super) fn weighted_violation(&self, weights: &[f64]) -> f64 {
        let above = self.inequalities.iter().map(|c| c.max(0.0));
        above.chain(self.equalities.iter().map(|g| g.abs())).zip(weights).map(|(v, mu)| mu * v).sum()
    }
}

/// Gradients of objective and constraints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slopes {
    /// Gradient of `f`.
    pub objective: Vec<f64>,
    /// Gradient of each `c`.
    pub inequalities: Vec<Vec<f64>>,
    /// Gradient of each `g`.
    pub equalities: Vec<Vec<f64>>,
}

/// A point at which the problem has no value.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum EvaluationError {
    /// The point cannot be evaluated; the optimiser shortens its step.
    #[error("{0}")]
    Failed(String),
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}

/// A smooth constrained problem. Evaluation is through `&self`: a problem that remembers locks its own memory.
pub trait ConstrainedProblem {
    /// Lower and upper bound of each variable; infinite where there is none.
    fn bounds(&self) -> (Vec<f64>, Vec<f64>);
    /// Objective and constraints at `x`.
    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError>;
    /// Their gradients at `x`, asked only at points whose values were accepted.
    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError>;
    /// Constraints that are linear in the variables; none by default.
    fn linear(&self) -> Vec<LinearConstraint> {
        Vec::new()
    }
    /// Called at every accepted point.
    fn accepted(&self, _news: &crate::run::IterationEvent) {}
}

/// A problem whose objective has parts that can be told apart, such as the losses at several operating points.
pub trait ManyObjectives: ConstrainedProblem {
    /// The parts at `x`.
    fn objectives(&self, x: &[f64]) -> Result<Vec<f64>, EvaluationError>;
    /// Their gradients.
    fn objective_slopes(&self, x: &[f64]) -> Result<Vec<Vec<f64>>, EvaluationError>;
}

/// A problem that knows how its gradients change along a direction: Hessians times a vector.
pub trait Curved: ConstrainedProblem {
    /// Derivative of every gradient at `x` along `direction`. Differences may be taken over a thousandth of the direction, which
    /// should therefore not be longer than what variables change in practice.
    fn slopes_along(&self, x: &[f64], direction: &[f64]) -> Result<Slopes, EvaluationError>;
}

/// The problem in variables of order one, its objective divided by its size at the start.
pub(super) struct Scaled<'p, P: ?Sized> {
    pub problem: &'p P,
    origin: Vec<f64>,
    width: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    pub objective_scale: f64,
    /// Linear constraints, the largest factor of each one.
    pub linear: Vec<LinearConstraint>,
}

/// Size of each variable: the width of its box, or what it starts from.
pub(super) fn widths<P: ConstrainedProblem + ?Sized>(problem: &P, start: &[f64]) -> Vec<f64> {
    let (low, high) = problem.bounds();
    let of = |j: usize| if boxed(low[j], high[j]) { high[j] - low[j] } else { start[j].abs().max(1.0) };
    (0..start.len()).map(of).collect()
}

fn boxed(low: f64, high: f64) -> bool {
    low.is_finite() && high.is_finite() && high > low
}

impl<'p, P: ConstrainedProblem + ?Sized> Scaled<'p, P> {
    pub fn new(problem: &'p P, start: &[f64]) -> Self {
        let (low, high) = problem.bounds();
        let n = start.len();
        let width = widths(problem, start);
        let origin: Vec<f64> =
            (0..n).map(|j| if boxed(low[j], high[j]) { low[j] } else { start[j] }).collect();
        let scale = |v: &[f64]| (0..n).map(|j| (v[j] - origin[j]) / width[j]).collect();
        let (lower, upper) = (scale(&low), scale(&high));
        let linear = problem.linear().iter().map(|r| r.scaled(&origin, &width)).collect();
        Self { lower, upper, problem, origin, width, objective_scale: 1.0, linear }
    }

    /// Divides the objective by its size at a point; one that happens to vanish there has no size to scale by.
    pub fn scale_objective_at(&mut self, s: &[f64]) -> Result<(), EvaluationError> {
        self.scale_objective(self.values(s)?.objective);
        Ok(())
    }

    /// The same with a known value.
    pub fn scale_objective(&mut self, value: f64) {
        let size = value.abs();
        self.objective_scale = if size < 1e-8 { 1.0 } else { size };
    }

    pub fn to_scaled(&self, x: &[f64]) -> Vec<f64> {
        (0..x.len())
            .map(|j| ((x[j] - self.origin[j]) / self.width[j]).clamp(self.lower[j], self.upper[j]))
            .collect()
    }

    pub fn to_true(&self, s: &[f64]) -> Vec<f64> {
        let (low, high) = self.problem.bounds();
        (0..s.len()).map(|j| (self.origin[j] + s[j] * self.width[j]).clamp(low[j], high[j])).collect()
    }

    /// The allowed point nearest to a true one, in scaled variables; the end of a search that has none.
    pub fn allowed(&self, start: &[f64]) -> Result<Vec<f64>, Box<Minimum>> {
        let s = self.to_scaled(start);
        nearest(&s, &self.linear, &self.lower, &self.upper).ok_or_else(|| {
            let reason = "the linear constraints and the bounds contradict each other";
            Box::new(Ended::at_start(Outcome::Infeasible, s, reason).restored(self))
        })
    }

    /// The linear constraints for steps from a point.
    pub fn linear_from(&self, s: &[f64]) -> Vec<LinearConstraint> {
        self.linear.iter().map(|r| r.from(s)).collect()
    }

    /// Prices of linear constraints per unit of their own bound.
    pub fn linear_prices(&self, multipliers: &[f64]) -> Vec<f64> {
        let rows = self.problem.linear();
        rows.iter().zip(multipliers).map(|(r, m)| m * self.objective_scale / r.size(&self.width)).collect()
    }

    /// A direction of the scaled variables in true ones, times a factor.
    pub fn direction(&self, d: &[f64], by: f64) -> Vec<f64> {
        d.iter().zip(&self.width).map(|(d, w)| by * d * w).collect()
    }

    pub fn values(&self, s: &[f64]) -> Result<Values, EvaluationError> {
        let mut values = self.problem.values(&self.to_true(s))?;
        let finite = values.objective.is_finite()
            && values.inequalities.iter().chain(&values.equalities).all(|c| c.is_finite());
        if !finite {
            return Err(EvaluationError::Failed("a value is not a finite number".into()));
        }
        values.objective /= self.objective_scale;
        Ok(values)
    }

    pub fn slopes(&self, s: &[f64]) -> Result<Slopes, EvaluationError> {
        Ok(self.of(self.problem.slopes(&self.to_true(s))?))
    }

    /// True slopes in scaled variables.
    pub fn of(&self, slopes: Slopes) -> Slopes {
        let row = |g: Vec<f64>, by: f64| g.iter().zip(&self.width).map(|(g, w)| g * w / by).collect();
        Slopes {
            objective: row(slopes.objective, self.objective_scale),
            inequalities: slopes.inequalities.into_iter().map(|g| row(g, 1.0)).collect(),
            equalities: slopes.equalities.into_iter().map(|g| row(g, 1.0)).collect(),
        }
    }
}

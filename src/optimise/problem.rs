//! The abilities a problem needs to be optimised, and its form in scaled variables.

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
    /// Called at every accepted point.
    fn accepted(&self, _news: &crate::run::IterationEvent) {}
}

/// The problem in variables of order one, its objective divided by its size at the start.
pub(super) struct Scaled<'p, P: ?Sized> {
    pub problem: &'p P,
    origin: Vec<f64>,
    width: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    pub objective_scale: f64,
}

impl<'p, P: ConstrainedProblem + ?Sized> Scaled<'p, P> {
    pub fn new(problem: &'p P, start: &[f64]) -> Self {
        let (low, high) = problem.bounds();
        let boxed = |j: usize| low[j].is_finite() && high[j].is_finite() && high[j] > low[j];
        let n = start.len();
        let width: Vec<f64> =
            (0..n).map(|j| if boxed(j) { high[j] - low[j] } else { start[j].abs().max(1.0) }).collect();
        let origin: Vec<f64> = (0..n).map(|j| if boxed(j) { low[j] } else { start[j] }).collect();
        let scale = |v: &[f64]| (0..n).map(|j| (v[j] - origin[j]) / width[j]).collect();
        Self { lower: scale(&low), upper: scale(&high), problem, origin, width, objective_scale: 1.0 }
    }

    /// Divides the objective by its size at a point; one that happens to vanish there has no size to scale by.
    pub fn scale_objective(&mut self, s: &[f64]) -> Result<(), EvaluationError> {
        let size = self.values(s)?.objective.abs();
        self.objective_scale = if size < 1e-8 { 1.0 } else { size };
        Ok(())
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

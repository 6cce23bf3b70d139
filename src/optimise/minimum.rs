//! The best point of a search and what is handed out in the end: the same for every method.

use super::problem::Scaled;
use super::{ConstrainedProblem, Multipliers, Outcome, Values};
use crate::run::IterationEvent;

/// Smallest violation that matters when points are compared.
pub(super) const FEASIBLE: f64 = 1e-7;
/// KKT residual and violation at which a search that cannot go on counts as almost converged.
const CLOSE: f64 = 1e-5;

/// End of an optimisation, in true variables.
#[derive(Debug, Clone)]
pub struct Minimum {
    /// How it ended.
    pub outcome: Outcome,
    /// Best point: feasible if any was, then of lowest objective.
    pub x: Vec<f64>,
    /// Values there; `None` if the start could not be evaluated.
    pub values: Option<Values>,
    /// Multipliers there: objective units per unit of constraint (bounds: per unit of variable in its box).
    pub multipliers: Multipliers,
    /// KKT residual there; infinite if its sub-problem was not solved.
    pub kkt: f64,
    /// Gradients, met within the tolerance of the point, whose combination that residual is of; 1 where the problem is smooth.
    pub combined: usize,
    /// Accepted points.
    pub history: Vec<IterationEvent>,
    /// Reasons of refused evaluations.
    pub failures: Vec<String>,
    /// Evaluations asked of the problem.
    pub evaluations: u64,
    /// Gradients asked of the problem.
    pub gradients: u64,
}

impl Minimum {
    /// A point of which nothing is known, and why.
    pub fn unknown(outcome: Outcome, x: Vec<f64>, failures: Vec<String>) -> Self {
        Self {
            outcome,
            x,
            values: None,
            multipliers: Multipliers::default(),
            kkt: f64::INFINITY,
            combined: 1,
            history: Vec::new(),
            failures,
            evaluations: 0,
            gradients: 0,
        }
    }
}

/// The best point so far, in scaled variables: smaller violation first, then lower objective.
#[derive(Debug, Clone)]
pub(super) struct Incumbent {
    pub x: Vec<f64>,
    pub values: Values,
    /// Infinite until judged.
    pub kkt: f64,
    /// Gradients whose combination that residual is of.
    pub combined: usize,
    pub multipliers: Multipliers,
}

impl Incumbent {
    /// Keeps the better of the best point and another; violations within the tolerance count as none.
    pub fn keep_better(best: &mut Option<Self>, x: &[f64], values: &Values, tolerance: f64) {
        let rank = |v: &Values| (v.violation().max(tolerance.max(FEASIBLE)), v.objective);
        if best.as_ref().is_none_or(|b| rank(values) < rank(&b.values)) {
            let (x, values, multipliers) = (x.to_vec(), values.clone(), Multipliers::default());
            *best = Some(Self { x, values, kkt: f64::INFINITY, combined: 1, multipliers });
        }
    }

    /// How a search ends that cannot go on.
    pub fn give_up(best: Option<&Self>, tolerance: f64) -> Outcome {
        let close = |b: &Self| b.kkt <= CLOSE.max(10.0 * tolerance) && b.values.violation() <= CLOSE;
        if best.is_some_and(close) { Outcome::AlmostConverged } else { Outcome::NoProgress }
    }
}

/// What a search ends with, in scaled variables.
pub(super) struct Ended {
    pub outcome: Outcome,
    pub best: Option<Incumbent>,
    pub start: Vec<f64>,
    pub history: Vec<IterationEvent>,
    pub failures: Vec<String>,
    pub evaluations: u64,
    pub gradients: u64,
}

impl Ended {
    /// A search that ends before it began.
    pub fn at_start(outcome: Outcome, start: Vec<f64>, reason: &str) -> Self {
        let failures = vec![reason.to_owned()];
        Self { outcome, best: None, start, history: Vec::new(), failures, evaluations: 0, gradients: 0 }
    }

    /// The same in true variables.
    pub fn restored<P: ConstrainedProblem + ?Sized>(self, scaled: &Scaled<'_, P>) -> Minimum {
        let scale = scaled.objective_scale;
        let restore = |v: Vec<f64>| v.into_iter().map(|m| m * scale).collect();
        let (x, values, kkt, combined, m) = match self.best {
            Some(b) => (b.x, Some(b.values), b.kkt, b.combined, b.multipliers),
            None => (self.start, None, f64::INFINITY, 1, Multipliers::default()),
        };
        Minimum {
            outcome: self.outcome,
            x: scaled.to_true(&x),
            values: values.map(|v| Values { objective: v.objective * scale, ..v }),
            multipliers: Multipliers {
                inequalities: restore(m.inequalities),
                equalities: restore(m.equalities),
                lower: restore(m.lower),
                upper: restore(m.upper),
                linear: scaled.linear_prices(&m.linear),
            },
            kkt,
            combined,
            history: self.history,
            failures: self.failures,
            evaluations: self.evaluations,
            gradients: self.gradients,
        }
    }
}

//! Constraints that are linear in the variables: met at every point of a search, not only at its end.
//!
//! ```text
//! a x <= b   or   a x = b
//! ```
//!
//! The start is moved to the nearest point that meets them; the sub-problems of [`super::Sqp`] hold them without slack, so every
//! trial meets them too (to the rounding of the sub-problem, 1e-9 of the box). Methods without such sub-problems treat them as
//! ordinary constraints ([`Softened`]).

use super::problem::widths;
use super::qp::Qp;
use super::{ConstrainedProblem, EvaluationError, Minimum, Slopes, Values};
use crate::math::dot;
use crate::run::IterationEvent;
use nalgebra::DMatrix;

/// How a row is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// `a x <= b`.
    AtMost,
    /// `a x = b`.
    Equal,
}

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearConstraint {
    /// `a`, one factor per variable.
    pub factors: Vec<f64>,
    /// How it is meant.
    pub relation: Relation,
    /// `b`.
    pub bound: f64,
}

impl LinearConstraint {
    /// `a x - b`.
    pub fn excess(&self, x: &[f64]) -> f64 {
        dot(&self.factors, x) - self.bound
    }

    /// Its largest factor in variables of these widths.
    pub(super) fn size(&self, width: &[f64]) -> f64 {
        let of_width = self.factors.iter().zip(width).map(|(a, w)| (a * w).abs());
        of_width.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// The row in variables `s` with `x = origin + width * s`, its largest factor one.
    pub(super) fn scaled(&self, origin: &[f64], width: &[f64]) -> Self {
        let size = self.size(width);
        let bound = (self.bound - dot(&self.factors, origin)) / size;
        let factors = self.factors.iter().zip(width).map(|(a, w)| a * w / size).collect();
        Self { factors, relation: self.relation, bound }
    }

    /// The row for steps from `x`.
    pub(super) fn from(&self, x: &[f64]) -> Self {
        Self { factors: self.factors.clone(), relation: self.relation, bound: -self.excess(x) }
    }
}

/// The nearest point within the bounds that meets all rows; none if they contradict each other.
pub(super) fn nearest(
    x: &[f64],
    rows: &[LinearConstraint],
    lower: &[f64],
    upper: &[f64],
) -> Option<Vec<f64>> {
    let met = rows.iter().all(|r| match r.relation {
        Relation::AtMost => r.excess(x) <= 0.0,
        Relation::Equal => r.excess(x) == 0.0,
    });
    if met {
        return Some(x.to_vec());
    }
    let room = |bound: &[f64]| -> Vec<f64> { bound.iter().zip(x).map(|(b, x)| b - x).collect() };
    let (lower_room, upper_room) = (room(lower), room(upper));
    let steps: Vec<LinearConstraint> = rows.iter().map(|r| r.from(x)).collect();
    let values = Values { objective: 0.0, inequalities: Vec::new(), equalities: Vec::new() };
    let slopes = Slopes { objective: vec![0.0; x.len()], inequalities: Vec::new(), equalities: Vec::new() };
    let distance = DMatrix::identity(x.len(), x.len());
    let model = Qp {
        hessian: &distance,
        values: &values,
        slopes: &slopes,
        linear: &steps,
        lower: &lower_room,
        upper: &upper_room,
    };
    let step = model.solve()?.step;
    Some((0..x.len()).map(|j| (x[j] + step[j]).clamp(lower[j], upper[j])).collect())
}

/// A problem whose linear constraints stand among the others, behind them.
pub(super) struct Softened<'p, P: ?Sized> {
    pub problem: &'p P,
    rows: Vec<LinearConstraint>,
    sizes: Vec<f64>,
}

impl<'p, P: ConstrainedProblem + ?Sized> Softened<'p, P> {
    /// Rows relative to the boxes, like all constraints.
    pub fn new(problem: &'p P, start: &[f64]) -> Self {
        let width = widths(problem, start);
        let by = |r: LinearConstraint| {
            let size = r.size(&width);
            let factors = r.factors.iter().map(|a| a / size).collect();
            (LinearConstraint { factors, bound: r.bound / size, ..r }, size)
        };
        let (rows, sizes) = problem.linear().into_iter().map(by).unzip();
        Self { problem, rows, sizes }
    }

    /// The end of a search with the linear constraints back in their own place.
    pub fn restored(&self, mut end: Minimum) -> Minimum {
        let above = self.of(Relation::AtMost).count();
        let equal = self.rows.len() - above;
        let cut = |all: &mut Vec<f64>, count: usize| all.split_off(all.len().saturating_sub(count));
        if let Some(values) = &mut end.values {
            cut(&mut values.inequalities, above);
            cut(&mut values.equalities, equal);
        }
        let m = &mut end.multipliers;
        let mut above = cut(&mut m.inequalities, above).into_iter();
        let mut equal = cut(&mut m.equalities, equal).into_iter();
        let own = |(r, size): (&LinearConstraint, &f64)| {
            let next = if r.relation == Relation::Equal { equal.next() } else { above.next() };
            next.map(|m| m / size)
        };
        m.linear = self.rows.iter().zip(&self.sizes).filter_map(own).collect();
        end
    }

    fn of(&self, relation: Relation) -> impl Iterator<Item = &LinearConstraint> {
        self.rows.iter().filter(move |r| r.relation == relation)
    }
}

impl<P: ConstrainedProblem + ?Sized> ConstrainedProblem for Softened<'_, P> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        self.problem.bounds()
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let mut values = self.problem.values(x)?;
        values.inequalities.extend(self.of(Relation::AtMost).map(|r| r.excess(x)));
        values.equalities.extend(self.of(Relation::Equal).map(|r| r.excess(x)));
        Ok(values)
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let mut slopes = self.problem.slopes(x)?;
        slopes.inequalities.extend(self.of(Relation::AtMost).map(|r| r.factors.clone()));
        slopes.equalities.extend(self.of(Relation::Equal).map(|r| r.factors.clone()));
        Ok(slopes)
    }

    fn accepted(&self, news: &IterationEvent) {
        self.problem.accepted(news);
    }
}

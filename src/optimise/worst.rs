//! The worst of several objectives: minimise the largest of them.
//!
//! ```text
//! minimise t   subject to   f_i(x) / F - t <= 0,   c(x) <= 0,   ...            F: the largest f_i at the start
//! ```
//!
//! The largest of smooth functions has kinks where two are equal, which is where its minimum likes to lie. With `t` as a variable
//! of its own (the epigraph form) the problem is smooth again, and the multipliers of its first rows say which objectives decide,
//! and how much each.

use super::methods::{SearchOptions, search};
use super::minimum::Minimum;
use super::{ConstrainedProblem, EvaluationError, LinearConstraint, ManyObjectives, Slopes, Values};
use crate::run::IterationEvent;
use argmin::core::Error;

/// The problem with `t` behind its variables.
struct Epigraph<'p, P: ?Sized> {
    problem: &'p P,
    scale: f64,
}

/// Minimises the largest objective of a problem; also returns the share of each in the decision, which add up to one.
///
/// The end is that of the problem itself: its objective is the largest one.
///
/// # Errors
/// Only if argmin itself fails.
pub fn search_worst<P: ManyObjectives + ?Sized>(
    problem: &P,
    start: &[f64],
    options: &SearchOptions,
) -> Result<(Minimum, Vec<f64>), Error> {
    // A start that cannot be evaluated is told by the search itself.
    let largest = problem.objectives(start).map_or(0.0, |f| f.into_iter().fold(0.0, f64::max));
    let epigraph = Epigraph { problem, scale: if largest > 0.0 { largest } else { 1.0 } };
    let begin: Vec<f64> = start.iter().copied().chain([1.0]).collect();
    let mut end = search(&epigraph, &begin, options)?;
    end.x.pop();
    end.multipliers.lower.pop();
    end.multipliers.upper.pop();
    let mut prices = Vec::new();
    if let Some(values) = &mut end.values {
        let own = values.inequalities.len() - epigraph.rows(&end.x);
        values.inequalities.truncate(own);
        prices = end.multipliers.inequalities.split_off(own.min(end.multipliers.inequalities.len()));
        values.objective = worst(&problem.objectives(&end.x).unwrap_or_default());
    }
    let sum: f64 = prices.iter().sum();
    Ok((end, prices.into_iter().map(|p| if sum > 0.0 { p / sum } else { 0.0 }).collect()))
}

/// The largest.
fn worst(objectives: &[f64]) -> f64 {
    objectives.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

impl<P: ManyObjectives + ?Sized> Epigraph<'_, P> {
    fn rows(&self, x: &[f64]) -> usize {
        self.problem.objectives(x).map_or(0, |f| f.len())
    }
}

impl<P: ManyObjectives + ?Sized> ConstrainedProblem for Epigraph<'_, P> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut lower, mut upper) = self.problem.bounds();
        lower.push(f64::NEG_INFINITY);
        upper.push(f64::INFINITY);
        (lower, upper)
    }

    fn values(&self, xt: &[f64]) -> Result<Values, EvaluationError> {
        let (x, t) = xt.split_at(xt.len() - 1);
        let mut values = self.problem.values(x)?;
        values.inequalities.extend(self.problem.objectives(x)?.iter().map(|f| f / self.scale - t[0]));
        values.objective = t[0] * self.scale;
        Ok(values)
    }

    fn slopes(&self, xt: &[f64]) -> Result<Slopes, EvaluationError> {
        let (x, _) = xt.split_at(xt.len() - 1);
        let slopes = self.problem.slopes(x)?;
        let wider = |mut row: Vec<f64>, t: f64| {
            row.push(t);
            row
        };
        let parts = self.problem.objective_slopes(x)?;
        let scaled = |row: Vec<f64>| row.into_iter().map(|g| g / self.scale).collect();
        let inequalities = slopes.inequalities.into_iter().map(|row| wider(row, 0.0));
        Ok(Slopes {
            objective: wider(vec![0.0; x.len()], self.scale),
            inequalities: inequalities.chain(parts.into_iter().map(|row| wider(scaled(row), -1.0))).collect(),
            equalities: slopes.equalities.into_iter().map(|row| wider(row, 0.0)).collect(),
        })
    }

    fn linear(&self) -> Vec<LinearConstraint> {
        let mut rows = self.problem.linear();
        rows.iter_mut().for_each(|r| r.factors.push(0.0));
        rows
    }

    fn accepted(&self, news: &IterationEvent) {
        self.problem.accepted(news);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::Outcome;

    /// Largest of three distances squared: the centre of the smallest circle about three points, none to the right of a line.
    struct Circle;

    const POINTS: [[f64; 2]; 3] = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0]];

    impl ConstrainedProblem for Circle {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![-10.0; 2], vec![10.0; 2])
        }
        fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
            Ok(Values { objective: f64::NAN, inequalities: vec![x[0] - 5.0], equalities: vec![] })
        }
        fn slopes(&self, _: &[f64]) -> Result<Slopes, EvaluationError> {
            Ok(Slopes { objective: vec![], inequalities: vec![vec![1.0, 0.0]], equalities: vec![] })
        }
    }

    impl ManyObjectives for Circle {
        fn objectives(&self, x: &[f64]) -> Result<Vec<f64>, EvaluationError> {
            Ok(POINTS.iter().map(|p| (x[0] - p[0]).powi(2) + (x[1] - p[1]).powi(2)).collect())
        }
        fn objective_slopes(&self, x: &[f64]) -> Result<Vec<Vec<f64>>, EvaluationError> {
            Ok(POINTS.iter().map(|p| vec![2.0 * (x[0] - p[0]), 2.0 * (x[1] - p[1])]).collect())
        }
    }

    #[test]
    fn the_smallest_circle_is_found_with_the_points_that_decide() {
        let (end, shares) = search_worst(&Circle, &[7.0, -6.0], &SearchOptions::default()).unwrap();
        assert_eq!(end.outcome, Outcome::Converged);
        assert!((end.x[0] - 2.0).abs() < 1e-6 && end.x[1].abs() < 1e-6, "{:?}", end.x);
        assert!((end.values.unwrap().objective - 4.0).abs() < 1e-5);
        assert!((shares[0] - 0.5).abs() < 1e-5 && (shares[1] - 0.5).abs() < 1e-5 && shares[2] < 1e-5);
        assert_eq!((end.multipliers.inequalities.len(), end.multipliers.upper.len()), (1, 2));
    }
}

//! Designs that stay good although what is made differs from what is drawn.
//!
//! ```text
//! minimise f + k s_f   subject to   c + k s_c <= 0            s_q^2 = sum_j (dq/du_j)^2 sigma_j^2
//! ```
//!
//! `u` are quantities that scatter about their nominal values with standard deviations `sigma`, design variables or others; to first
//! order `s_q` is the standard deviation of a quantity `q` (Gauss). It comes from the gradient, so each value costs one gradient; its
//! own gradient, `H (sigma^2 dq/du) / s_q`, comes from one Hessian product per quantity. Constraints so far inside that their margin
//! cannot matter ([`FAR`]) do without: what is left out belongs to rows that have no multiplier. Deliberately not here: the check of
//! the first order by sampling, which belongs to the run.

use super::{ConstrainedProblem, Curved, EvaluationError, LinearConstraint, Slopes, Values};
use crate::run::IterationEvent;

/// Distance from its limit beyond which a constraint's margin is taken as constant.
const FAR: f64 = 0.25;

/// A problem whose quantities carry margins.
pub struct Robust<'p, P: ?Sized> {
    problem: &'p P,
    /// Variables that scatter but are not searched, behind those that are.
    beside: Vec<f64>,
    /// Standard deviation of each variable, those of the search first.
    deviations: Vec<f64>,
    sigmas: f64,
}

/// `k s` of a point's quantities.
#[derive(Debug, Clone, PartialEq)]
pub struct Margins {
    /// Of the objective.
    pub objective: f64,
    /// Of each inequality.
    pub inequalities: Vec<f64>,
}

impl<'p, P: Curved + ?Sized> Robust<'p, P> {
    /// A problem with margins of `sigmas` standard deviations. The problem must take points with the variables `beside` behind its
    /// own; `deviations` has one entry for each of both.
    pub fn new(problem: &'p P, beside: Vec<f64>, deviations: Vec<f64>, sigmas: f64) -> Self {
        Self { problem, beside, deviations, sigmas }
    }

    /// The point with the variables beside it.
    pub fn whole(&self, x: &[f64]) -> Vec<f64> {
        x.iter().chain(&self.beside).copied().collect()
    }

    /// The margins at a point.
    pub fn margins(&self, x: &[f64]) -> Result<Margins, EvaluationError> {
        let slopes = self.problem.slopes(&self.whole(x))?;
        let margin = |row: &Vec<f64>| self.sigmas * self.deviation(row);
        Ok(Margins {
            objective: margin(&slopes.objective),
            inequalities: slopes.inequalities.iter().map(margin).collect(),
        })
    }

    fn deviation(&self, row: &[f64]) -> f64 {
        row.iter().zip(&self.deviations).map(|(g, s)| (g * s).powi(2)).sum::<f64>().sqrt()
    }

    /// Gradient of a margin: of the row picked from all slopes.
    fn margin_slope(
        &self,
        whole: &[f64],
        row: &[f64],
        pick: impl Fn(Slopes) -> Vec<f64>,
    ) -> Result<Vec<f64>, EvaluationError> {
        let size = self.deviation(row);
        if size == 0.0 {
            return Ok(vec![0.0; row.len()]);
        }
        let direction: Vec<f64> = row.iter().zip(&self.deviations).map(|(g, s)| g * s * s / size).collect();
        let change = pick(self.problem.slopes_along(whole, &direction)?);
        Ok(change.into_iter().map(|h| self.sigmas * h).collect())
    }
}

impl<P: Curved + ?Sized> ConstrainedProblem for Robust<'_, P> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        self.problem.bounds()
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let mut values = self.problem.values(&self.whole(x))?;
        let margins = self.margins(x)?;
        values.objective += margins.objective;
        values.inequalities.iter_mut().zip(&margins.inequalities).for_each(|(c, m)| *c += m);
        Ok(values)
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let (whole, values) = (self.whole(x), self.values(x)?);
        let nominal = self.problem.slopes(&whole)?;
        let with = |row: &[f64], margin: Vec<f64>| -> Vec<f64> {
            row.iter().zip(margin).take(x.len()).map(|(g, m)| g + m).collect()
        };
        let margin = self.margin_slope(&whole, &nominal.objective, |s| s.objective)?;
        let objective = with(&nominal.objective, margin);
        let mut inequalities = Vec::with_capacity(nominal.inequalities.len());
        for (k, row) in nominal.inequalities.iter().enumerate() {
            let margin = match values.inequalities[k] < -FAR {
                true => vec![0.0; row.len()],
                false => self.margin_slope(&whole, row, |mut s| s.inequalities.swap_remove(k))?,
            };
            inequalities.push(with(row, margin));
        }
        let equalities = nominal.equalities.into_iter().map(|mut row| {
            row.truncate(x.len());
            row
        });
        Ok(Slopes { objective, inequalities, equalities: equalities.collect() })
    }

    fn linear(&self) -> Vec<LinearConstraint> {
        self.problem.linear()
    }

    fn accepted(&self, news: &IterationEvent) {
        self.problem.accepted(news);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::dot;
    use crate::optimise::{Outcome, SearchOptions, search};

    /// `f = (x - 1)^2 (1 + u) + y^2`, `c = 1 - x y / u`: everything in closed form.
    struct Plain;

    impl Plain {
        fn hessians(p: &[f64]) -> [[[f64; 3]; 3]; 2] {
            let (x, y, u) = (p[0], p[1], p[2]);
            let f = [[2.0 * (1.0 + u), 0.0, 2.0 * (x - 1.0)], [0.0, 2.0, 0.0], [2.0 * (x - 1.0), 0.0, 0.0]];
            let (a, b) = (y / (u * u), x / (u * u));
            let c = [[0.0, -1.0 / u, a], [-1.0 / u, 0.0, b], [a, b, -2.0 * x * y / u.powi(3)]];
            [f, c]
        }
    }

    impl ConstrainedProblem for Plain {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![0.1, 0.1], vec![5.0, 5.0])
        }
        fn values(&self, p: &[f64]) -> Result<Values, EvaluationError> {
            let objective = (p[0] - 1.0).powi(2) * (1.0 + p[2]) + p[1] * p[1];
            Ok(Values { objective, inequalities: vec![1.0 - p[0] * p[1] / p[2]], equalities: vec![] })
        }
        fn slopes(&self, p: &[f64]) -> Result<Slopes, EvaluationError> {
            let (x, y, u) = (p[0], p[1], p[2]);
            Ok(Slopes {
                objective: vec![2.0 * (x - 1.0) * (1.0 + u), 2.0 * y, (x - 1.0).powi(2)],
                inequalities: vec![vec![-y / u, -x / u, x * y / (u * u)]],
                equalities: vec![],
            })
        }
    }

    impl Curved for Plain {
        fn slopes_along(&self, p: &[f64], d: &[f64]) -> Result<Slopes, EvaluationError> {
            let [f, c] = Self::hessians(p);
            let times = |h: [[f64; 3]; 3]| h.iter().map(|row| dot(row, d)).collect::<Vec<f64>>();
            Ok(Slopes { objective: times(f), inequalities: vec![times(c)], equalities: vec![] })
        }
    }

    fn robust() -> Robust<'static, Plain> {
        Robust::new(&Plain, vec![0.8], vec![0.05, 0.0, 0.1], 3.0)
    }

    #[test]
    fn gradients_hold_those_of_the_margins() {
        let (problem, x) = (robust(), [1.7, 0.6]);
        let slopes = problem.slopes(&x).unwrap();
        for j in 0..2 {
            let side = |h: f64| {
                let mut x = x;
                x[j] += h;
                let v = problem.values(&x).unwrap();
                [v.objective, v.inequalities[0]]
            };
            let (above, below) = (side(1e-5), side(-1e-5));
            let rows = [slopes.objective[j], slopes.inequalities[0][j]];
            for k in 0..2 {
                assert!((rows[k] - (above[k] - below[k]) / 2e-5).abs() < 1e-8, "{j} {k}");
            }
        }
    }

    #[test]
    fn a_robust_design_keeps_its_distance() {
        let end = search(&robust(), &[2.0, 2.0], &SearchOptions::default()).unwrap();
        assert_eq!(end.outcome, Outcome::Converged);
        let nominal = Plain.values(&[end.x[0], end.x[1], 0.8]).unwrap();
        let margins = robust().margins(&end.x).unwrap();
        assert!((nominal.inequalities[0] + margins.inequalities[0]).abs() < 1e-6);
        assert!(margins.inequalities[0] > 0.1 && margins.objective > 0.0);
    }
}

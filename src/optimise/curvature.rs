//! Curvature at an optimum: is it one, and how sharp is it?
//!
//! At a point that meets the first-order conditions, the Hessian of the Lagrangian `L = f + lambda c + mu g`, restricted to the
//! directions that leave every active bound and constraint where it is, decides: all eigenvalues above zero make a strict
//! local minimum (the second-order sufficient condition). It is found by central differences of gradients along those
//! directions only: a design that stands in a corner of its limits has none, and costs nothing.

use super::problem::Scaled;
use super::{ConstrainedProblem, EvaluationError, Multipliers};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Length of the differences, in boxes.
const STEP: f64 = 1e-4;
/// Closer to a bound than this share of the box, a variable stands at it.
const AT_BOUND: f64 = 1e-6;
/// Multipliers above this share of the largest one belong to active constraints.
const ACTIVE: f64 = 1e-6;
/// An eigenvalue below this share of the largest one is none.
const FLAT: f64 = 1e-5;
/// Entries of a direction below this size are none.
const NOTHING: f64 = 1e-12;
/// Directions up to which the curvature is worth its simulations.
const MOST: usize = 12;

/// Curvature of the Lagrangian along the directions that active limits leave free.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Curvature {
    /// Directions left free by bounds and active constraints.
    pub free_directions: usize,
    /// Eigenvalues along them, smallest first: objective per box squared, of the whole box of each variable. Empty if there
    /// are none, or too many to be worth it.
    pub eigenvalues: Vec<f64>,
    /// Directions of the eigenvalues, one per eigenvalue, in shares of the boxes.
    pub directions: Vec<Vec<f64>>,
}

impl Curvature {
    /// Size below which an eigenvalue is nothing but what differences leave.
    fn noise(&self) -> f64 {
        FLAT * self.eigenvalues.iter().fold(0.0f64, |a, e| a.max(e.abs()))
    }

    /// What it says about the design.
    pub fn verdict(&self) -> &'static str {
        match self.eigenvalues.first() {
            None if self.free_directions == 0 => {
                "a corner of the limits: bounds and active constraints leave no direction free"
            }
            None => "not computed: too many directions are free",
            Some(least) if least.abs() <= self.noise() => {
                "flat: along a direction the limits leave free, the loss hardly changes"
            }
            Some(least) if *least > 0.0 => {
                "a strict local minimum: the loss rises along every direction the limits leave free"
            }
            Some(_) => {
                "no strict local minimum: along a direction the limits leave free, the loss does not rise"
            }
        }
    }
}

/// The curvature at `x` with the multipliers found there; gradients at `2 free_directions` neighbours are asked for.
pub fn curvature<P: ConstrainedProblem + ?Sized>(
    problem: &P,
    x: &[f64],
    multipliers: &Multipliers,
) -> Result<Curvature, EvaluationError> {
    let scaled = Scaled::new(problem, x);
    let s = scaled.to_scaled(x);
    // At the point itself, not at its image in the unit box: the search has its cycles and gradients at hand.
    let slopes = scaled.of(problem.slopes(x)?);
    let largest = multipliers.inequalities.iter().fold(0.0f64, |a, l| a.max(l.abs()));
    let mut rows: Vec<Vec<f64>> = slopes.equalities.clone();
    let active = slopes.inequalities.iter().zip(&multipliers.inequalities);
    rows.extend(active.filter(|(_, l)| **l > ACTIVE * largest).map(|(g, _)| g.clone()));
    let held = scaled.linear.iter().filter(|r| r.excess(&s).abs() < AT_BOUND);
    rows.extend(held.map(|r| r.factors.clone()));
    for (j, v) in s.iter().enumerate() {
        if v - scaled.lower[j] < AT_BOUND || scaled.upper[j] - v < AT_BOUND {
            rows.push((0..s.len()).map(|k| f64::from(u8::from(k == j))).collect());
        }
    }
    let basis = free_directions(&rows, s.len());
    let free = basis.len();
    if free == 0 || free > MOST {
        return Ok(Curvature { free_directions: free, eigenvalues: Vec::new(), directions: Vec::new() });
    }
    let mut hessian = DMatrix::zeros(free, free);
    for (j, d) in basis.iter().enumerate() {
        // Differences stay in the box.
        let room = |k: usize| (s[k] - scaled.lower[k]).min(scaled.upper[k] - s[k]) / d[k].abs();
        let step = (0..s.len()).filter(|k| d[*k].abs() > NOTHING).map(room).fold(STEP, f64::min);
        let side = |sign: f64| -> Result<DVector<f64>, EvaluationError> {
            let moved: Vec<f64> = s.iter().zip(d.iter()).map(|(s, d)| s + sign * step * d).collect();
            Ok(lagrangian(&scaled.slopes(&moved)?, multipliers))
        };
        let change = (side(1.0)? - side(-1.0)?) / (2.0 * step);
        (0..free).for_each(|i| hessian[(i, j)] = basis[i].dot(&change));
    }
    let symmetric = (&hessian + hessian.transpose()) * 0.5;
    let eigen = symmetric.symmetric_eigen();
    let mut order: Vec<usize> = (0..free).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let direction = |k: usize| {
        let column = eigen.eigenvectors.column(k);
        let sum = basis.iter().zip(column.iter()).map(|(d, w)| d * *w);
        let sum = sum.fold(DVector::zeros(s.len()), |a, d| a + d);
        sum.iter().map(|v| if v.abs() < NOTHING { 0.0 } else { *v }).collect()
    };
    Ok(Curvature {
        free_directions: free,
        eigenvalues: order.iter().map(|k| eigen.eigenvalues[*k]).collect(),
        directions: order.iter().map(|k| direction(*k)).collect(),
    })
}

/// Gradient of the Lagrangian, the bounds left out: they have no curvature.
fn lagrangian(slopes: &super::Slopes, l: &Multipliers) -> DVector<f64> {
    let mut sum = DVector::from_column_slice(&slopes.objective);
    let constraints = slopes.inequalities.iter().zip(&l.inequalities);
    for (g, l) in constraints.chain(slopes.equalities.iter().zip(&l.equalities)) {
        sum.axpy(*l, &DVector::from_column_slice(g), 1.0);
    }
    sum
}

/// An orthonormal basis of the directions at right angles to all rows.
pub(super) fn free_directions(rows: &[Vec<f64>], n: usize) -> Vec<DVector<f64>> {
    const INDEPENDENT: f64 = 1e-8;
    let mut taken: Vec<DVector<f64>> = Vec::new();
    let mut free: Vec<DVector<f64>> = Vec::new();
    let unit = |k: usize| DVector::from_fn(n, |i, _| f64::from(u8::from(i == k)));
    let given = rows.iter().map(|r| DVector::from_column_slice(r)).map(|v| (v, false));
    for (v, is_free) in given.chain((0..n).map(|k| (unit(k), true))) {
        let size = v.norm();
        let mut rest = v;
        for _ in 0..2 {
            taken.iter().for_each(|t| rest -= t * t.dot(&rest));
        }
        if size > 0.0 && rest.norm() > INDEPENDENT * size {
            let direction = rest.normalize();
            taken.push(direction.clone());
            if is_free {
                free.push(direction);
            }
        }
    }
    free
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::{Slopes, Values};

    /// `f = x^2 + 3 y^2 + 5 z^2 + x y` under `x + y >= 1`, boxes of width 4 about 0.
    struct Bowl;

    impl ConstrainedProblem for Bowl {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![-2.0; 3], vec![2.0; 3])
        }

        fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
            let objective = x[0] * x[0] + 3.0 * x[1] * x[1] + 5.0 * x[2] * x[2] + x[0] * x[1];
            Ok(Values { objective, inequalities: vec![1.0 - x[0] - x[1]], equalities: Vec::new() })
        }

        fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
            Ok(Slopes {
                objective: vec![2.0 * x[0] + x[1], 6.0 * x[1] + x[0], 10.0 * x[2]],
                inequalities: vec![vec![-1.0, -1.0, 0.0]],
                equalities: Vec::new(),
            })
        }
    }

    fn multipliers(l: f64) -> Multipliers {
        Multipliers {
            inequalities: vec![l],
            equalities: Vec::new(),
            lower: vec![0.0; 3],
            upper: vec![0.0; 3],
            linear: Vec::new(),
        }
    }

    #[test]
    fn curvature_is_that_along_the_active_constraint() {
        // Along (1, -1, 0) / sqrt 2 the Hessian gives (2 + 6 - 2) / 2 = 3, along z 10; boxes of width 4 make them 16 times larger.
        let found = curvature(&Bowl, &[5.0 / 6.0, 1.0 / 6.0, 0.0], &multipliers(11.0 / 6.0)).unwrap();
        assert_eq!(found.free_directions, 2);
        assert!((found.eigenvalues[0] / 48.0 - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.eigenvalues[1] / 160.0 - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.directions[0][0] + found.directions[0][1]).abs() < 1e-12);
        assert!(found.verdict().starts_with("a strict local minimum"));
    }

    #[test]
    fn a_corner_has_none() {
        let found = curvature(&Bowl, &[2.0, -2.0, 2.0], &multipliers(0.0)).unwrap();
        assert_eq!((found.free_directions, found.eigenvalues.len()), (0, 0));
        assert!(found.verdict().starts_with("a corner"));
    }
}

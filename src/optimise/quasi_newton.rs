//! The curvature of the Lagrangian as gradients tell it: Powell's damped BFGS (1978).
//!
//! ```text
//! B+ = B - B s s'B / s'B s + y y' / s'y,      y replaced by t y + (1 - t) B s where s'y < 0.2 s'B s
//! ```
//!
//! Up to [`MANY`] variables every change since the last fresh start is in the matrix. Above, only the latest [`PAIRS`] changes are
//! (limited memory, Nocedal and Wright 2006, ch. 7.2): the matrix is rebuilt from them over a multiple of the unit matrix that
//! follows the latest change, so that curvature met long ago, far from here, is forgotten.

use nalgebra::{DMatrix, DVector};
use std::collections::VecDeque;

/// Variables above which the memory is limited. Forgetting pays early: a stiff chain of 20 (50) links needs 29 (26) evaluations with
/// it and 55 (129) without.
pub(super) const MANY: usize = 10;
/// Changes that are kept then.
const PAIRS: usize = 40;
/// A change of the gradient over a step this short that is this many times as large is the jump at a kink, no curvature.
const SHORT: f64 = 1e-5;
const STEEP: f64 = 1e5;
/// Powell's damping.
const DAMPING: f64 = 0.2;
/// Curvature of a fresh matrix.
const CURVATURE: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

/// A positive definite model of the Hessian.
#[derive(Debug, Clone)]
pub(super) struct QuasiNewton {
    matrix: DMatrix<f64>,
    fresh: bool,
    pairs: VecDeque<(DVector<f64>, DVector<f64>)>,
}

impl QuasiNewton {
    /// The unit matrix.
    pub fn new(n: usize) -> Self {
        Self { matrix: DMatrix::identity(n, n), fresh: true, pairs: VecDeque::new() }
    }

    /// The matrix.
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// Whether no change is known yet.
    pub fn is_fresh(&self) -> bool {
        self.fresh
    }

    /// Forgets everything.
    pub fn restart(&mut self) {
        *self = Self::new(self.matrix.nrows());
    }

    /// Takes in how the gradient changed (`y`) over a step `s`.
    pub fn update(&mut self, s: DVector<f64>, y: DVector<f64>) {
        let length = s.norm();
        if length == 0.0 || (length < SHORT && y.norm() > STEEP * length) {
            return;
        }
        let n = s.len();
        if n <= MANY {
            if self.fresh && s.dot(&y) > 0.0 {
                self.matrix = DMatrix::identity(n, n) * size(&s, &y);
            }
            add(&mut self.matrix, &s, &y);
        } else {
            self.pairs.truncate(PAIRS - 1);
            self.pairs.push_front((s, y));
            self.rebuild();
        }
        self.fresh = false;
    }

    fn rebuild(&mut self) {
        let told = self.pairs.iter().find(|(s, y)| s.dot(y) > 0.0);
        let curvature = told.map_or(1.0, |(s, y)| size(s, y));
        self.matrix.fill_with_identity();
        self.matrix *= curvature;
        for (s, y) in self.pairs.iter().rev() {
            add(&mut self.matrix, s, y);
        }
    }
}

/// Curvature along a change.
fn size(s: &DVector<f64>, y: &DVector<f64>) -> f64 {
    (y.norm_squared() / s.dot(y)).clamp(*CURVATURE.start(), *CURVATURE.end())
}

/// One damped update.
fn add(matrix: &mut DMatrix<f64>, s: &DVector<f64>, y: &DVector<f64>) {
    let bs = &*matrix * s;
    let (sbs, sy) = (s.dot(&bs), s.dot(y));
    let mut y = y.clone();
    if sy < DAMPING * sbs {
        let theta = (1.0 - DAMPING) * sbs / (sbs - sy);
        y = y * theta + &bs * (1.0 - theta);
    }
    let sy = s.dot(&y);
    matrix.ger(1.0 / sy, &y, &y, 1.0);
    matrix.ger(-1.0 / sbs, &bs, &bs, 1.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Secant condition, and a matrix that stays positive definite, whatever changes come.
    #[test]
    fn the_latest_change_is_met_and_the_matrix_stays_positive() {
        for n in [3, MANY + 10] {
            let mut model = QuasiNewton::new(n);
            let mut last = (DVector::zeros(n), DVector::zeros(n));
            for k in 0..2 * PAIRS {
                let s = DVector::from_fn(n, |j, _| ((7 * j + 3 * k) as f64).sin());
                let y = DVector::from_fn(n, |j, _| (1.0 + j as f64) * s[j]);
                model.update(s.clone(), y.clone());
                last = (s, y);
            }
            let (s, y) = last;
            assert!((model.matrix() * &s - &y).norm() < 1e-9 * y.norm());
            model.update(s.clone(), -y);
            assert!(model.matrix().clone().symmetric_eigenvalues().iter().all(|e| *e > 0.0));
        }
    }
}

//! Elimination in a small dense matrix whose rows and columns are of very different size.
//!
//! A step of a constrained system weighs inertia with `alpha = 3 / (2 dt)` and constraint forces with 1: rows and columns
//! are first balanced until the largest entry of each is near 1 (Ruiz 2001), then rows are exchanged as pivots ask.
//!
//! ```text
//! P (R A C) = L U,      A x = b:  x = C U^-1 L^-1 P R b,      A^T x = b:  x = R P^T L^-T U^-T C b
//! ```
//!
//! Deliberately not here: sparsity. Nothing allocates after [`Lu::new`].

use crate::math::Singular;

/// Passes of balancing.
const PASSES: usize = 5;

/// A factorised matrix. Fill [`Self::matrix`], then call [`Self::factor`].
#[derive(Debug, Clone)]
pub(super) struct Lu {
    n: usize,
    /// Row by row; holds `L` (its diagonal of ones left out) and `U` after [`Self::factor`].
    pub matrix: Vec<f64>,
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    /// Row exchanged with row `k` before column `k` was eliminated.
    exchange: Vec<usize>,
}

impl Lu {
    pub fn new(n: usize) -> Self {
        Self {
            n,
            matrix: vec![0.0; n * n],
            row_scale: vec![1.0; n],
            column_scale: vec![1.0; n],
            exchange: vec![0; n],
        }
    }

    /// Size of the factors of `n` unknowns.
    pub fn bytes(n: usize) -> usize {
        (n * n + 3 * n) * size_of::<f64>()
    }

    pub fn factor(&mut self) -> Result<(), Singular> {
        self.balance()?;
        let n = self.n;
        // All that is left of a row that others determine is rounding.
        let least = n as f64 * f64::EPSILON;
        for k in 0..n {
            let size = |r: &usize| self.matrix[r * n + k].abs();
            let pivot = (k..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(k);
            let found = size(&pivot);
            if !found.is_finite() || found <= least {
                return Err(Singular(k));
            }
            self.exchange[k] = pivot;
            if pivot != k {
                (0..n).for_each(|j| self.matrix.swap(k * n + j, pivot * n + j));
            }
            let (above, below) = self.matrix.split_at_mut((k + 1) * n);
            let row = &above[k * n..];
            for other in below.chunks_exact_mut(n) {
                other[k] /= row[k];
                let factor = other[k];
                other[k + 1..].iter_mut().zip(&row[k + 1..]).for_each(|(o, r)| *o -= factor * r);
            }
        }
        Ok(())
    }

    /// Scales rows and columns by powers of two, which costs no digit.
    fn balance(&mut self) -> Result<(), Singular> {
        let n = self.n;
        self.row_scale.fill(1.0);
        self.column_scale.fill(1.0);
        for _ in 0..PASSES {
            for i in 0..n {
                let row = &mut self.matrix[i * n..(i + 1) * n];
                let largest = row.iter().fold(0.0f64, |a, v| a.max(v.abs()));
                let scale = halfway(largest).ok_or(Singular(i))?;
                row.iter_mut().for_each(|v| *v *= scale);
                self.row_scale[i] *= scale;
            }
            for j in 0..n {
                let largest = (0..n).fold(0.0f64, |a, i| a.max(self.matrix[i * n + j].abs()));
                let scale = halfway(largest).ok_or(Singular(j))?;
                (0..n).for_each(|i| self.matrix[i * n + j] *= scale);
                self.column_scale[j] *= scale;
            }
        }
        Ok(())
    }

    /// Replaces each column of `rhs` by the solution.
    pub fn solve(&self, rhs: &mut [f64]) {
        let n = self.n;
        for x in rhs.chunks_exact_mut(n.max(1)) {
            x.iter_mut().zip(&self.row_scale).for_each(|(x, s)| *x *= s);
            (0..n).for_each(|k| x.swap(k, self.exchange[k]));
            for i in 1..n {
                x[i] -= (0..i).map(|j| self.matrix[i * n + j] * x[j]).sum::<f64>();
            }
            for i in (0..n).rev() {
                let known: f64 = (i + 1..n).map(|j| self.matrix[i * n + j] * x[j]).sum();
                x[i] = (x[i] - known) / self.matrix[i * n + i];
            }
            x.iter_mut().zip(&self.column_scale).for_each(|(x, s)| *x *= s);
        }
    }

    /// Replaces each column of `rhs` by the solution with the transposed matrix.
    pub fn solve_transposed(&self, rhs: &mut [f64]) {
        let n = self.n;
        for x in rhs.chunks_exact_mut(n.max(1)) {
            x.iter_mut().zip(&self.column_scale).for_each(|(x, s)| *x *= s);
            for i in 0..n {
                let known: f64 = (0..i).map(|j| self.matrix[j * n + i] * x[j]).sum();
                x[i] = (x[i] - known) / self.matrix[i * n + i];
            }
            for i in (0..n).rev() {
                x[i] -= (i + 1..n).map(|j| self.matrix[j * n + i] * x[j]).sum::<f64>();
            }
            (0..n).rev().for_each(|k| x.swap(k, self.exchange[k]));
            x.iter_mut().zip(&self.row_scale).for_each(|(x, s)| *x *= s);
        }
    }
}

/// The power of two nearest to `1 / sqrt(largest)`; none for a line without entries.
fn halfway(largest: f64) -> Option<f64> {
    (largest > 0.0 && largest.is_finite()).then(|| (-0.5 * largest.log2()).round().exp2())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The step matrix of a constrained mass: `[alpha m, s; 1, 0]` in awkward units, and a third unknown.
    const AWKWARD: [f64; 9] = [3e9, 2e-7, 0.0, 1e-3, 0.0, 0.0, 5.0, -1e-9, 4e5];

    #[test]
    fn solves_both_ways_whatever_the_units() {
        let mut lu = Lu::new(3);
        lu.matrix.copy_from_slice(&AWKWARD);
        lu.factor().unwrap();
        // Solutions whose terms are of like size in every equation; others lose digits to cancellation, not to elimination.
        let (x, y) = ([2e-6, -3e10, 1e-4], [1.0, -3e12, 200.0]);
        let row = |i: usize| (0..3).map(|j| AWKWARD[i * 3 + j] * x[j]).sum::<f64>();
        let column = |j: usize| (0..3).map(|i| AWKWARD[i * 3 + j] * y[i]).sum::<f64>();
        let (mut forward, mut backward) = ([0, 1, 2].map(row), [0, 1, 2].map(column));
        lu.solve(&mut forward);
        lu.solve_transposed(&mut backward);
        for k in 0..3 {
            assert!((forward[k] / x[k] - 1.0).abs() < 1e-13, "{forward:?}");
            assert!((backward[k] / y[k] - 1.0).abs() < 1e-13, "{backward:?}");
        }
    }

    #[test]
    fn a_row_that_others_determine_is_reported() {
        let mut lu = Lu::new(3);
        lu.matrix.copy_from_slice(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        assert_eq!(lu.factor(), Err(Singular(2)));
        lu.matrix.fill(0.0);
        assert!(lu.factor().is_err());
    }
}

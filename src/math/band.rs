//! Direct solver for five-point stencils on a grid that is periodic in its first direction.
//!
//! Unknown `(i, j)` has the index `i * b + j`; block `i` couples to `i - 1` and `i + 1` (cyclic) and, inside, `j` to
//! `j +- 1`. All blocks but one form a band of half-width `b`, factorised `L U` row by row; the remaining block is a
//! border, eliminated by its Schur complement:
//!
//! ```text
//! [ A11 E ] [x1]   [r1]        Y = L^-1 E,  Z = G U^-1,  S = D - Z Y
//! [ G   D ] [x2] = [r2]
//! ```
//!
//! If some block's rows couple to nothing (a fully cavitated or supplied column), that block becomes the border: then
//! `G = 0`, the ring is cut open, and neither `Y` nor `Z` is needed. Rows that couple to nothing cost nothing inside the
//! band either. There is no pivoting: film matrices are M-matrices, for which elimination is stable (Funderlic and
//! Plemmons 1981); a pivot that collapses is reported as [`Singular`].
//!
//! Factor, solve and transposed solve are separate calls and allocate nothing.

use super::vector::{axpy, dot};
use thiserror::Error;

/// A pivot collapsed: the matrix is singular to working accuracy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the film matrix is singular at unknown {0}")]
pub struct Singular(pub usize);

/// Coefficients of a five-point stencil, one entry of each array per unknown.
#[derive(Debug, Clone, Default)]
pub struct Stencil {
    /// Coefficient of the unknown itself.
    pub diagonal: Vec<f64>,
    /// Coefficient of `(i - 1, j)`, cyclic.
    pub west: Vec<f64>,
    /// Coefficient of `(i + 1, j)`, cyclic.
    pub east: Vec<f64>,
    /// Coefficient of `(i, j - 1)`; must be zero for `j = 0`.
    pub south: Vec<f64>,
    /// Coefficient of `(i, j + 1)`; must be zero for `j = b - 1`.
    pub north: Vec<f64>,
}

impl Stencil {
    /// A zero stencil for `n` unknowns.
    pub fn zeros(n: usize) -> Self {
        let z = || vec![0.0; n];
        Self { diagonal: z(), west: z(), east: z(), south: z(), north: z() }
    }

    /// Sets every coefficient to zero.
    pub fn clear(&mut self) {
        for part in [&mut self.diagonal, &mut self.west, &mut self.east, &mut self.south, &mut self.north] {
            part.fill(0.0);
        }
    }

    /// Makes row `k` say `scale * x_k = rhs_k`.
    pub fn decouple(&mut self, k: usize, scale: f64) {
        self.diagonal[k] = scale;
        for side in [&mut self.west, &mut self.east, &mut self.south, &mut self.north] {
            side[k] = 0.0;
        }
    }

    /// Whether row `k` couples to no other unknown.
    pub fn is_decoupled(&self, k: usize) -> bool {
        [&self.west, &self.east, &self.south, &self.north].iter().all(|side| side[k] == 0.0)
    }
}

/// Factorised cyclic stencil; see the module page.
#[derive(Debug, Clone)]
pub struct CyclicBand {
    blocks: usize,
    b: usize,
    /// First unknown of the band (the border block is the one before it).
    start: usize,
    cut: bool,
    /// `L` and `U` of the band: row `r` holds the columns `r - b ..= r + b`.
    band: Vec<f64>,
    /// `Y` (or, if cut, the couplings `E` of first and last block), one row of `b` per band unknown.
    y: Vec<f64>,
    /// `Z` transposed, one row of `b` per band unknown.
    z: Vec<f64>,
    /// `L U` of the border's Schur complement.
    schur: Vec<f64>,
}

impl CyclicBand {
    /// Room for `blocks >= 3` blocks of `b` unknowns.
    pub fn new(blocks: usize, b: usize) -> Self {
        assert!(blocks >= 3 && b >= 1, "a cyclic band needs at least 3 blocks");
        let rows = (blocks - 1) * b;
        Self {
            blocks,
            b,
            start: 0,
            cut: false,
            band: vec![0.0; rows * (2 * b + 1)],
            y: vec![0.0; rows * b],
            z: vec![0.0; rows * b],
            schur: vec![0.0; b * b],
        }
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.blocks * self.b
    }

    /// Whether there is nothing to solve.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Factorises `a`.
    pub fn factor(&mut self, a: &Stencil) -> Result<(), Singular> {
        let (n, b) = (self.blocks, self.b);
        let free = (0..n).find(|i| (i * b..(i + 1) * b).all(|k| a.is_decoupled(k)));
        self.cut = free.is_some();
        self.start = (free.unwrap_or(n - 1) + 1) % n * b;
        self.fill(a);
        let rows = self.rows();
        eliminate(&mut self.band, rows, b).map_err(|r| Singular((r + self.start) % self.len()))?;
        self.complete_border()
    }

    fn rows(&self) -> usize {
        (self.blocks - 1) * self.b
    }

    /// Copies the stencil, rotated, into band, border columns (`y`), border rows (`z`) and corner (`schur`).
    fn fill(&mut self, a: &Stencil) {
        let (b, len, rows) = (self.b, self.len(), self.rows());
        let w = 2 * b + 1;
        self.band.fill(0.0);
        self.y.fill(0.0);
        self.z.fill(0.0);
        self.schur.fill(0.0);
        for r in 0..rows {
            let (k, j) = ((r + self.start) % len, r % b);
            let row = &mut self.band[r * w..(r + 1) * w];
            row[b] = a.diagonal[k];
            row[0] = if r >= b { a.west[k] } else { 0.0 };
            row[2 * b] = if r + b < rows { a.east[k] } else { 0.0 };
            // With one unknown per block the neighbours in j do not exist and the slots belong to west and east.
            if b > 1 {
                row[b - 1] = if j > 0 { a.south[k] } else { 0.0 };
                row[b + 1] = if j + 1 < b { a.north[k] } else { 0.0 };
            }
            if r < b {
                self.y[r * b + j] += a.west[k];
            }
            if r + b >= rows {
                self.y[r * b + j] += a.east[k];
            }
        }
        for j in 0..b {
            let k = (rows + j + self.start) % len;
            self.z[j * b + j] += a.east[k];
            self.z[(rows - b + j) * b + j] += a.west[k];
            self.schur[j * b + j] = a.diagonal[k];
            if j > 0 {
                self.schur[j * b + j - 1] = a.south[k];
            }
            if j + 1 < b {
                self.schur[j * b + j + 1] = a.north[k];
            }
        }
    }

    fn complete_border(&mut self) -> Result<(), Singular> {
        let (b, rows, w) = (self.b, self.rows(), 2 * self.b + 1);
        if !self.cut {
            for r in 0..rows {
                let row = &self.band[r * w..(r + 1) * w];
                let (done, rest) = self.y.split_at_mut(r * b);
                for k in r.saturating_sub(b)..r {
                    axpy(&mut rest[..b], -row[k + b - r], &done[k * b..(k + 1) * b]);
                }
                // Column r of Z^T: z_r = (g_r - sum_k u_kr z_k) / u_rr.
                let (done, rest) = self.z.split_at_mut(r * b);
                for k in r.saturating_sub(b)..r {
                    axpy(&mut rest[..b], -self.band[k * w + b + r - k], &done[k * b..(k + 1) * b]);
                }
                let pivot = row[b];
                rest[..b].iter_mut().for_each(|v| *v /= pivot);
                for i in 0..b {
                    axpy(
                        &mut self.schur[i * b..(i + 1) * b],
                        -self.z[r * b + i],
                        &self.y[r * b..(r + 1) * b],
                    );
                }
            }
        }
        eliminate_dense(&mut self.schur, b).map_err(|j| Singular((rows + j + self.start) % self.len()))
    }

    /// Replaces each column of `rhs` (consecutive vectors of [`Self::len`]) by the solution of `A x = rhs`.
    pub fn solve(&self, rhs: &mut [f64]) {
        for x in rhs.chunks_exact_mut(self.len()) {
            x.rotate_left(self.start);
            let (x1, x2) = x.split_at_mut(self.rows());
            if self.cut {
                dense_solve(&self.schur, self.b, x2);
                self.border_columns(x1, x2);
                lower_solve(&self.band, self.b, x1);
            } else {
                lower_solve(&self.band, self.b, x1);
                for (z, v) in self.z.chunks_exact(self.b).zip(&*x1) {
                    axpy(x2, -v, z);
                }
                dense_solve(&self.schur, self.b, x2);
                self.border_columns(x1, x2);
            }
            upper_solve(&self.band, self.b, x1);
            x.rotate_right(self.start);
        }
    }

    /// Replaces each column of `rhs` by the solution of `A^T x = rhs`.
    pub fn solve_transposed(&self, rhs: &mut [f64]) {
        for x in rhs.chunks_exact_mut(self.len()) {
            x.rotate_left(self.start);
            let (x1, x2) = x.split_at_mut(self.rows());
            upper_solve_transposed(&self.band, self.b, x1);
            if self.cut {
                lower_solve_transposed(&self.band, self.b, x1);
                self.border_columns_transposed(x1, x2);
                dense_solve_transposed(&self.schur, self.b, x2);
            } else {
                self.border_columns_transposed(x1, x2);
                dense_solve_transposed(&self.schur, self.b, x2);
                for (z, v) in self.z.chunks_exact(self.b).zip(x1.iter_mut()) {
                    *v -= dot(z, x2);
                }
                lower_solve_transposed(&self.band, self.b, x1);
            }
            x.rotate_right(self.start);
        }
    }

    /// `x1 -= Y x2`; if cut, only the first and last block of `Y = E` are occupied.
    fn border_columns(&self, x1: &mut [f64], x2: &[f64]) {
        for r in self.border_rows() {
            x1[r] -= dot(&self.y[r * self.b..(r + 1) * self.b], x2);
        }
    }

    fn border_columns_transposed(&self, x1: &[f64], x2: &mut [f64]) {
        for r in self.border_rows() {
            axpy(x2, -x1[r], &self.y[r * self.b..(r + 1) * self.b]);
        }
    }

    fn border_rows(&self) -> impl Iterator<Item = usize> + use<> {
        let (rows, b) = (self.rows(), self.b);
        let head = if self.cut { b } else { rows };
        (0..head).chain((rows - b).max(head)..rows)
    }
}

/// `L U` in place of a band with rows of `2 b + 1`; the multipliers of `L` stay below the diagonal.
fn eliminate(band: &mut [f64], rows: usize, b: usize) -> Result<(), usize> {
    let w = 2 * b + 1;
    for k in 0..rows {
        let (head, tail) = band.split_at_mut((k + 1) * w);
        let pivot_row = &head[k * w..];
        let pivot = pivot_row[b];
        if !pivot.is_finite() || pivot.abs() < f64::MIN_POSITIVE {
            return Err(k);
        }
        for r in k + 1..(k + b + 1).min(rows) {
            let row = &mut tail[(r - k - 1) * w..(r - k) * w];
            let at = b - (r - k);
            if row[at] != 0.0 {
                let m = row[at] / pivot;
                row[at] = m;
                axpy(&mut row[at + 1..at + 1 + b], -m, &pivot_row[b + 1..]);
            }
        }
    }
    Ok(())
}

fn lower_solve(band: &[f64], b: usize, x: &mut [f64]) {
    let w = 2 * b + 1;
    for r in 1..x.len() {
        let first = r.saturating_sub(b);
        x[r] -= dot(&band[r * w + b + first - r..r * w + b], &x[first..r]);
    }
}

fn upper_solve(band: &[f64], b: usize, x: &mut [f64]) {
    let w = 2 * b + 1;
    for r in (0..x.len()).rev() {
        let last = (r + b + 1).min(x.len());
        let row = &band[r * w + b..];
        x[r] = (x[r] - dot(&row[1..last - r], &x[r + 1..last])) / row[0];
    }
}

fn upper_solve_transposed(band: &[f64], b: usize, x: &mut [f64]) {
    let w = 2 * b + 1;
    for r in 0..x.len() {
        let last = (r + b + 1).min(x.len());
        let row = &band[r * w + b..];
        x[r] /= row[0];
        let v = x[r];
        axpy(&mut x[r + 1..last], -v, &row[1..last - r]);
    }
}

fn lower_solve_transposed(band: &[f64], b: usize, x: &mut [f64]) {
    let w = 2 * b + 1;
    for r in (1..x.len()).rev() {
        let first = r.saturating_sub(b);
        let v = x[r];
        axpy(&mut x[first..r], -v, &band[r * w + b + first - r..r * w + b]);
    }
}

fn eliminate_dense(a: &mut [f64], n: usize) -> Result<(), usize> {
    for k in 0..n {
        let (head, tail) = a.split_at_mut((k + 1) * n);
        let pivot_row = &head[k * n..];
        if !pivot_row[k].is_finite() || pivot_row[k].abs() < f64::MIN_POSITIVE {
            return Err(k);
        }
        for row in tail.chunks_exact_mut(n) {
            let m = row[k] / pivot_row[k];
            row[k] = m;
            axpy(&mut row[k + 1..], -m, &pivot_row[k + 1..]);
        }
    }
    Ok(())
}

fn dense_solve(a: &[f64], n: usize, x: &mut [f64]) {
    for r in 1..n {
        x[r] -= dot(&a[r * n..r * n + r], &x[..r]);
    }
    for r in (0..n).rev() {
        x[r] = (x[r] - dot(&a[r * n + r + 1..(r + 1) * n], &x[r + 1..])) / a[r * n + r];
    }
}

fn dense_solve_transposed(a: &[f64], n: usize, x: &mut [f64]) {
    for r in 0..n {
        x[r] /= a[r * n + r];
        let v = x[r];
        axpy(&mut x[r + 1..], -v, &a[r * n + r + 1..(r + 1) * n]);
    }
    for r in (1..n).rev() {
        let v = x[r];
        axpy(&mut x[..r], -v, &a[r * n..r * n + r]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    /// A diagonally dominant stencil from random numbers; blocks in `free` couple to nothing.
    fn stencil(n: usize, b: usize, noise: &[f64], free: &[usize]) -> (Stencil, DMatrix<f64>) {
        let len = n * b;
        let mut a = Stencil::zeros(len);
        let mut dense = DMatrix::zeros(len, len);
        for k in 0..len {
            let (i, j) = (k / b, k % b);
            let v = |s: usize| 0.1 + noise[(k * 5 + s) % noise.len()].abs();
            if free.contains(&i) {
                a.decouple(k, v(4));
            } else {
                a.west[k] = -v(0);
                a.east[k] = -v(1);
                a.south[k] = if j > 0 { -v(2) } else { 0.0 };
                a.north[k] = if j + 1 < b { -v(3) } else { 0.0 };
                a.diagonal[k] = v(4) + 4.0;
            }
            let at = |i: usize, j: usize| i % n * b + j;
            dense[(k, k)] += a.diagonal[k];
            dense[(k, at(i + n - 1, j))] += a.west[k];
            dense[(k, at(i + 1, j))] += a.east[k];
            if j > 0 {
                dense[(k, k - 1)] += a.south[k];
            }
            if j + 1 < b {
                dense[(k, k + 1)] += a.north[k];
            }
        }
        (a, dense)
    }

    proptest! {
        #[test]
        fn agrees_with_a_dense_solver(
            n in 3usize..9, b in 1usize..6,
            noise in prop::collection::vec(-1.0f64..1.0, 37),
            free in prop::collection::vec(0usize..9, 0..3),
        ) {
            let (a, dense) = stencil(n, b, &noise, &free);
            let mut solver = CyclicBand::new(n, b);
            solver.factor(&a).unwrap();
            let truth = DVector::from_fn(n * b, |i, _| 1.0 + (i as f64 * 0.7).sin());
            let mut rhs: Vec<f64> = (&dense * &truth).iter().chain((&dense * &truth * 2.0).iter()).copied().collect();
            solver.solve(&mut rhs);
            let mut transposed: Vec<f64> = (dense.transpose() * &truth).iter().copied().collect();
            solver.solve_transposed(&mut transposed);
            for i in 0..n * b {
                prop_assert!((rhs[i] - truth[i]).abs() < 1e-10);
                prop_assert!((rhs[n * b + i] - 2.0 * truth[i]).abs() < 1e-10);
                prop_assert!((transposed[i] - truth[i]).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_reported() {
        let mut solver = CyclicBand::new(3, 2);
        assert!(solver.factor(&Stencil::zeros(6)).is_err());
    }
}

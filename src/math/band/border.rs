//! The border: which block it is, the dense factors of its Schur complement, and its part in a solve.

use super::kernels::{Arithmetic, four, minus_dots, update};
use super::{CyclicBand, Stencil};
use std::cmp::Reverse;

/// What the choice of the border needs to know of one block.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Census {
    /// Rows that couple to the block before.
    west: usize,
    /// Rows that couple to the block after.
    east: usize,
    /// Whether no row couples to more than one neighbour: elimination passes through without fill.
    thin: bool,
}

/// The block after which the ring is best opened; it becomes the border.
///
/// Best is a block that couples to no other block: nothing of the closure needs elimination. Next best is a place where
/// one direction of coupling is missing: either `Y` or `Z` then is almost empty. Among such places, the one in front of
/// the longest thin stretch wins, because the fill of the other factor stays diagonal up to the stretch's end.
pub(super) fn choose(a: &Stencil, b: usize, census: &mut [Census]) -> usize {
    let n = census.len();
    for (i, c) in census.iter_mut().enumerate() {
        *c = Census { thin: true, ..Census::default() };
        for k in i * b..(i + 1) * b {
            let (west, east) = (a.west[k] != 0.0, a.east[k] != 0.0);
            c.west += west as usize;
            c.east += east as usize;
            c.thin &= !(west && east) && a.south[k] == 0.0 && a.north[k] == 0.0;
        }
    }
    let mut run = census.iter().take_while(|c| c.thin).count();
    let mut best = (usize::MAX, Reverse(0), Reverse(0));
    for i in (0..n).rev() {
        let (here, next) = (census[i], census[(i + 1) % n]);
        let leak = if here.west + here.east == 0 { 0 } else { 1 + here.east.min(next.west) };
        best = best.min((leak, Reverse(run), Reverse(i)));
        run = if here.thin { (run + 1).min(n) } else { 0 };
    }
    best.2.0
}

/// `L U` in place of an `n x n` matrix with rows of `stride`; `Err` names the row whose pivot collapsed.
pub(super) fn eliminate_dense(
    a: &mut [f64],
    n: usize,
    stride: usize,
    collapsed: impl Fn(usize, f64) -> bool,
) -> Result<(), usize> {
    for k in 0..n {
        let (head, tail) = a.split_at_mut((k + 1) * stride);
        let pivot_row = &head[k * stride..];
        if collapsed(k, pivot_row[k]) {
            return Err(k);
        }
        for row in tail.chunks_exact_mut(stride).take(n - k - 1) {
            if row[k] != 0.0 {
                let m = row[k] / pivot_row[k];
                row[k] = m;
                for j in k + 1..n {
                    row[j] -= m * pivot_row[j];
                }
            }
        }
    }
    Ok(())
}

impl CyclicBand {
    /// `x2 -= Z x1`, then the border's own unknowns.
    #[inline(always)]
    pub(super) fn border<A: Arithmetic>(&self, x: &mut [f64]) {
        let (x1, x2) = x.split_at_mut(self.rows);
        for (part, (from, to)) in self.z_ranges().into_iter().enumerate() {
            let (storage, width, at) = self.z_storage(part);
            for (z, x2) in storage.chunks_exact(4 * width.max(1)).zip(x2.chunks_mut(4)) {
                let z = four(z, width, at, 0, to - from);
                let mut t = [0.0; 4];
                minus_dots::<A>(&mut t, z, &x1[from..to]);
                x2.iter_mut().zip(t).for_each(|(x, t)| *x += t);
            }
        }
        dense_solve(&self.schur, self.stride, x2);
    }

    /// The border's own unknowns, then `x1 -= Z^T x2`.
    #[inline(always)]
    pub(super) fn border_transposed<A: Arithmetic>(&self, x: &mut [f64]) {
        let (x1, x2) = x.split_at_mut(self.rows);
        dense_solve_transposed(&self.schur, self.stride, x2);
        for (part, (from, to)) in self.z_ranges().into_iter().enumerate() {
            let (storage, width, at) = self.z_storage(part);
            for (z, x2) in storage.chunks_exact(4 * width.max(1)).zip(x2.chunks(4)) {
                let z = four(z, width, at, 0, to - from);
                let m = [0, 1, 2, 3].map(|q| x2.get(q).copied().unwrap_or(0.0));
                update::<A, 4, 1>([&mut x1[from..to]], [m], z);
            }
        }
    }

    /// The two stretches of columns in which `Z` is occupied.
    #[inline(always)]
    pub(super) fn z_ranges(&self) -> [(usize, usize); 2] {
        let (from, to) = self.z_gap;
        [(0, from), (to, self.rows)]
    }

    /// Where a stretch of `Z` stands: storage, length of a row, first column.
    #[inline(always)]
    fn z_storage(&self, part: usize) -> (&[f64], usize, usize) {
        let (gap, until) = self.z_gap;
        match &self.packed {
            Some(packed) => (packed.z(), gap + self.rows - until, if part == 0 { 0 } else { gap }),
            None => (&self.z, self.padded, if part == 0 { 0 } else { until }),
        }
    }

    /// A cut ring: the border depends on nothing, so it is known first.
    pub(super) fn edge(&self, x: &mut [f64]) {
        let (x1, x2) = x.split_at_mut(self.rows);
        dense_solve(&self.schur, self.stride, x2);
        let last = self.rows - self.b;
        for j in 0..self.b {
            x1[j] -= self.edge[j] * x2[j];
            x1[last + j] -= self.edge[self.b + j] * x2[j];
        }
    }

    pub(super) fn edge_transposed(&self, x: &mut [f64]) {
        let (x1, x2) = x.split_at_mut(self.rows);
        let last = self.rows - self.b;
        for j in 0..self.b {
            x2[j] -= self.edge[j] * x1[j] + self.edge[self.b + j] * x1[last + j];
        }
        dense_solve_transposed(&self.schur, self.stride, x2);
    }
}

fn dense_solve(a: &[f64], stride: usize, x: &mut [f64]) {
    let n = x.len();
    let dot = |a: &[f64], x: &[f64]| -> f64 { a.iter().zip(x).map(|(a, x)| a * x).sum() };
    for r in 1..n {
        x[r] -= dot(&a[r * stride..r * stride + r], &x[..r]);
    }
    for r in (0..n).rev() {
        x[r] = (x[r] - dot(&a[r * stride + r + 1..r * stride + n], &x[r + 1..])) / a[r * stride + r];
    }
}

fn dense_solve_transposed(a: &[f64], stride: usize, x: &mut [f64]) {
    let n = x.len();
    for r in 0..n {
        x[r] /= a[r * stride + r];
        for j in r + 1..n {
            x[j] -= x[r] * a[r * stride + j];
        }
    }
    for r in (1..n).rev() {
        for j in 0..r {
            x[j] -= x[r] * a[r * stride + j];
        }
    }
}

//! Forward and backward substitution, four rows at a time, all right-hand sides of a call side by side.
//!
//! `solve` takes dot products with the rows of the factors, `solve_transposed` adds multiples of the rows; either way a
//! group of rows is read once and serves every right-hand side while the cache holds it. Ranges of zeros are skipped.

use super::kernels::{Arithmetic, Job, four, minus_dots, update};
use super::{CyclicBand, Group};

pub(super) struct Solve<'a> {
    pub(super) by: &'a CyclicBand,
    pub(super) rhs: &'a mut [f64],
    /// From the start of one right-hand side to the start of the next.
    pub(super) spacing: usize,
    pub(super) transposed: bool,
}

impl Job for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        let Self { by, rhs, spacing, transposed } = self;
        let len = by.len();
        for x in rhs.chunks_exact_mut(spacing) {
            x[..len].rotate_left(by.start);
        }
        if transposed {
            for k in (0..by.padded).step_by(4) {
                let rows = by.group(k);
                for x in rhs.chunks_exact_mut(spacing) {
                    by.upper_transposed::<A>(k, &rows, &mut x[..len]);
                }
            }
            if !by.cut {
                for x in rhs.chunks_exact_mut(spacing) {
                    by.border_transposed::<A>(&mut x[..len]);
                }
            }
            for k in (0..by.padded).step_by(4).rev() {
                let rows = by.group(k);
                for x in rhs.chunks_exact_mut(spacing) {
                    by.lower_transposed::<A>(k, &rows, &mut x[..len]);
                }
            }
            if by.cut {
                for x in rhs.chunks_exact_mut(spacing) {
                    by.edge_transposed(&mut x[..len]);
                }
            }
        } else {
            if by.cut {
                for x in rhs.chunks_exact_mut(spacing) {
                    by.edge(&mut x[..len]);
                }
            }
            for k in (0..by.padded).step_by(4) {
                let rows = by.group(k);
                for x in rhs.chunks_exact_mut(spacing) {
                    by.lower::<A>(k, &rows, &mut x[..len]);
                }
            }
            if !by.cut {
                for x in rhs.chunks_exact_mut(spacing) {
                    by.border::<A>(&mut x[..len]);
                }
            }
            for k in (0..by.padded).step_by(4).rev() {
                let rows = by.group(k);
                for x in rhs.chunks_exact_mut(spacing) {
                    by.upper::<A>(k, &rows, &mut x[..len]);
                }
            }
        }
        for x in rhs.chunks_exact_mut(spacing) {
            x[..len].rotate_right(by.start);
        }
    }
}

/// What a substitution reads of one group of rows.
pub(super) struct Rows<'a> {
    pub(super) at: Group,
    pub(super) l: [&'a [f64]; 4],
    pub(super) u: [&'a [f64]; 4],
    pub(super) y: [&'a [f64]; 4],
    pub(super) inverse: [[f64; 4]; 4],
}

impl CyclicBand {
    /// Ranges of a group that hold anything.
    #[inline(always)]
    pub(super) fn ranges(&self, k: usize) -> Group {
        let mut at = self.groups[k / 4];
        // Whole vectors may reach beyond what there is.
        at.u.1 = at.u.1.min(k + 4 + self.b).min(self.rows).max(at.u.0);
        at.y.1 = at.y.1.min(self.b).max(at.y.0);
        at
    }

    #[inline(always)]
    pub(super) fn group(&self, k: usize) -> Rows<'_> {
        let at = self.ranges(k);
        if let Some(packed) = &self.packed {
            let [l, inverse, u, y] = packed.group(k / 4);
            let block = std::array::from_fn(|q| std::array::from_fn(|c| inverse[4 * q + c]));
            let [l, u, y] = [l, u, y].map(|of| four(of, of.len() / 4, 0, 0, of.len() / 4));
            return Rows { at, l, u, y, inverse: block };
        }
        let (w, stride) = (self.w, self.stride);
        let rows = &self.band[k * w..(k + 4) * w];
        Rows {
            at,
            l: four(rows, w, self.left - (k - at.l.0), 1, at.l.1 - at.l.0),
            u: four(rows, w, self.left + at.u.0 - k, 1, at.u.1 - at.u.0),
            y: four(&self.y[k * stride..(k + 4) * stride], stride, at.y.0, 0, at.y.1 - at.y.0),
            inverse: self.diagonal_block(k),
        }
    }

    /// The unknowns `k..k + 4`; those of the padding do not exist.
    #[inline(always)]
    fn load(&self, k: usize, x: &[f64]) -> [f64; 4] {
        if k + 4 <= self.rows {
            [x[k], x[k + 1], x[k + 2], x[k + 3]]
        } else {
            [0, 1, 2, 3].map(|q| if k + q < self.rows { x[k + q] } else { 0.0 })
        }
    }

    #[inline(always)]
    fn store(&self, k: usize, t: &[f64; 4], x: &mut [f64]) {
        let n = (self.rows - k).min(4);
        if n == 4 {
            x[k..k + 4].copy_from_slice(t);
        } else {
            x[k..k + n].copy_from_slice(&t[..n]);
        }
    }

    #[inline(always)]
    fn lower<A: Arithmetic>(&self, k: usize, rows: &Rows, x: &mut [f64]) {
        let mut t = self.load(k, x);
        minus_dots::<A>(&mut t, rows.l, &x[rows.at.l.0..rows.at.l.1]);
        let v = &rows.inverse;
        let t = [
            t[0],
            t[1] + v[1][0] * t[0],
            t[2] + v[2][0] * t[0] + v[2][1] * t[1],
            t[3] + v[3][0] * t[0] + v[3][1] * t[1] + v[3][2] * t[2],
        ];
        self.store(k, &t, x);
    }

    #[inline(always)]
    fn upper<A: Arithmetic>(&self, k: usize, rows: &Rows, x: &mut [f64]) {
        let mut t = self.load(k, x);
        minus_dots::<A>(&mut t, rows.u, &x[rows.at.u.0..rows.at.u.1]);
        minus_dots::<A>(&mut t, rows.y, &x[self.rows + rows.at.y.0..self.rows + rows.at.y.1]);
        let v = &rows.inverse;
        let t = [
            v[0][0] * t[0] + v[0][1] * t[1] + v[0][2] * t[2] + v[0][3] * t[3],
            v[1][1] * t[1] + v[1][2] * t[2] + v[1][3] * t[3],
            v[2][2] * t[2] + v[2][3] * t[3],
            v[3][3] * t[3],
        ];
        self.store(k, &t, x);
    }

    #[inline(always)]
    fn upper_transposed<A: Arithmetic>(&self, k: usize, rows: &Rows, x: &mut [f64]) {
        let (t, v) = (self.load(k, x), &rows.inverse);
        let t = [
            v[0][0] * t[0],
            v[0][1] * t[0] + v[1][1] * t[1],
            v[0][2] * t[0] + v[1][2] * t[1] + v[2][2] * t[2],
            v[0][3] * t[0] + v[1][3] * t[1] + v[2][3] * t[2] + v[3][3] * t[3],
        ];
        self.store(k, &t, x);
        update::<A, 4, 1>([&mut x[rows.at.u.0..rows.at.u.1]], [t], rows.u);
        update::<A, 4, 1>([&mut x[self.rows + rows.at.y.0..self.rows + rows.at.y.1]], [t], rows.y);
    }

    #[inline(always)]
    fn lower_transposed<A: Arithmetic>(&self, k: usize, rows: &Rows, x: &mut [f64]) {
        let (t, v) = (self.load(k, x), &rows.inverse);
        let t = [
            t[0] + v[1][0] * t[1] + v[2][0] * t[2] + v[3][0] * t[3],
            t[1] + v[2][1] * t[2] + v[3][1] * t[3],
            t[2] + v[3][2] * t[3],
            t[3],
        ];
        self.store(k, &t, x);
        update::<A, 4, 1>([&mut x[rows.at.l.0..rows.at.l.1]], [t], rows.l);
    }
}

//! Elimination, four pivot rows at a time.
//!
//! Of each group of four rows the `4 x 4` diagonal block is factorised first and replaced by the inverses of its triangles:
//! the multipliers of any row below, and later the four unknowns of a solve, then are short products instead of a chain
//! of divisions. Rows enter the moving window (are copied from the stencil) just before they are first needed, while
//! the cache holds them.

use super::block::{eliminate_inside, inverses, multipliers, rows_of, upper_inverse};
use super::border::eliminate_dense;
use super::kernels::{Arithmetic, Job, four, update};
use super::{CyclicBand, Stencil};

pub(super) struct Eliminate<'a> {
    pub(super) to: &'a mut CyclicBand,
    pub(super) a: &'a Stencil,
}

impl Job for Eliminate<'_> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn run<A: Arithmetic>(self) -> Result<(), usize> {
        let Self { to, a } = self;
        let (b, rows, padded) = (to.b, to.rows, to.padded);
        to.enter_corner(a);
        to.z_gap = (0, 0);
        for (g, group) in to.groups.iter_mut().enumerate() {
            group.l = (4 * g, 4 * g);
        }
        // Columns of `z` that are open; the couplings of the border to the first block are there from the start.
        let mut z_end = if to.first_coupled { to.extend_z(a, 0, b) } else { 0 };
        let mut entered = 0;
        for k in (0..padded).step_by(4) {
            // An even number of rows, as they are taken in pairs.
            let window = (k + 4 + b.next_multiple_of(2)).min(padded);
            to.enter_rows(a, entered, window);
            entered = window;
            to.factor_group::<A>(a, k)?;
            to.update_window::<A>(k, window);
            if to.cut {
                continue;
            }
            // The border's couplings to the last block come into play only here.
            if k + 4 > rows - b && z_end < padded {
                if z_end < k {
                    to.z_gap = (z_end, k);
                    z_end = k;
                }
                z_end = to.extend_z(a, z_end, padded);
            }
            if k < z_end {
                let reach = to.groups[k / 4].u.1;
                if reach > z_end {
                    z_end = to.extend_z(a, z_end, reach);
                }
                to.update_border::<A>(k);
            }
        }
        let (len, start) = (to.len(), to.start);
        let diagonal = |j: usize| a.diagonal[(rows + j + start) % len];
        eliminate_dense(&mut to.schur, b, to.stride, |j, pivot| collapsed(pivot, diagonal(j)))
            .map_err(|j| rows + j)
    }
}

/// Whether nothing but rounding is left of the pivot of a row that started with `diagonal`.
fn collapsed(pivot: f64, diagonal: f64) -> bool {
    !pivot.is_finite() || pivot.abs() < f64::MIN_POSITIVE.max(8.0 * f64::EPSILON * diagonal.abs())
}

impl CyclicBand {
    /// Eliminates inside the rows `k..k + 4` and finds which of their columns are occupied.
    #[inline(always)]
    fn factor_group<A: Arithmetic>(&mut self, a: &Stencil, k: usize) -> Result<(), usize> {
        let (w, left, stride) = (self.w, self.left, self.stride);
        let mut t = self.diagonal_block(k);
        let mut reciprocal = [0.0; 4];
        for p in 0..4 {
            let original = if k + p < self.rows { a.diagonal[self.unknown(k + p)] } else { 1.0 };
            if collapsed(t[p][p], original) {
                return Err(k + p);
            }
            reciprocal[p] = 1.0 / t[p][p];
            for q in p + 1..4 {
                t[q][p] *= reciprocal[p];
                for c in p + 1..4 {
                    t[q][c] = A::minus(t[q][c], t[q][p], t[p][c]);
                }
            }
        }
        let head = &mut self.band[k * w..(k + 4) * w];
        let u = eliminate_inside::<A>(rows_of(head, w, left + 4, 1, stride), &t);
        let y = if self.cut {
            (0, 0)
        } else {
            let head = &mut self.y[k * stride..(k + 4) * stride];
            eliminate_inside::<A>(rows_of(head, stride, 0, 0, stride), &t)
        };
        let group = &mut self.groups[k / 4];
        group.u = if u.0 < u.1 { (k + 4 + u.0, k + 4 + u.1) } else { (k, k) };
        group.y = y;
        for (q, t) in inverses::<A>(&t, &reciprocal).iter().enumerate() {
            let at = (k + q) * w + left - q;
            self.band[at..at + 4].copy_from_slice(t);
        }
        Ok(())
    }

    /// The entries of the rows `k..k + 4` in their own columns.
    #[inline(always)]
    pub(super) fn diagonal_block(&self, k: usize) -> [[f64; 4]; 4] {
        let mut t = [[0.0; 4]; 4];
        for (q, t) in t.iter_mut().enumerate() {
            let at = (k + q) * self.w + self.left - q;
            t.copy_from_slice(&self.band[at..at + 4]);
        }
        t
    }

    /// Eliminates the columns `k..k + 4` from the rows `k + 4..window`, two rows at a time.
    #[inline(always)]
    fn update_window<A: Arithmetic>(&mut self, k: usize, window: usize) {
        let (w, left, stride) = (self.w, self.left, self.stride);
        let inverse = upper_inverse(&self.diagonal_block(k));
        let group = &self.groups[k / 4];
        let ((u0, u1), (y0, y1)) = (group.u, group.y);
        let (head, tail) = self.band[k * w..window * w].split_at_mut(4 * w);
        let (y_head, y_tail) = self.y[k * stride..window * stride].split_at_mut(4 * stride);
        let u = four(head, w, left + u0 - k, 1, u1 - u0);
        let y = four(y_head, stride, y0, 0, y1 - y0);
        let pairs = tail.chunks_exact_mut(2 * w).zip(y_tail.chunks_exact_mut(2 * stride));
        for (i, (pair, y_pair)) in pairs.enumerate() {
            // Distance of the pair's first row to row k.
            let r = 4 + 2 * i;
            let at = left - r;
            let (first, second) = pair.split_at_mut(w);
            let Some(m) = multipliers::<A>(&mut first[at..at + 4], &mut second[at - 1..at + 3], &inverse)
            else {
                continue;
            };
            let l = &mut self.groups[(k + r) / 4].l;
            if l.0 > k {
                l.0 = l.0.min(k + (0..3).find(|&p| m[0][p] != 0.0 || m[1][p] != 0.0).unwrap_or(3));
            }
            l.1 = k + 4;
            if u0 < u1 {
                let (from, to) = (at + u0 - k, at + u1 - k);
                update::<A, 4, 2>([&mut first[from..to], &mut second[from - 1..to - 1]], m, u);
            }
            if y0 < y1 {
                let (y_first, y_second) = y_pair.split_at_mut(stride);
                update::<A, 4, 2>([&mut y_first[y0..y1], &mut y_second[y0..y1]], m, y);
            }
        }
    }

    /// The same for the border's rows: their multipliers are `Z`.
    #[inline(always)]
    fn update_border<A: Arithmetic>(&mut self, k: usize) {
        let (w, left, stride, padded) = (self.w, self.left, self.stride, self.padded);
        let inverse = upper_inverse(&self.diagonal_block(k));
        let group = &self.groups[k / 4];
        let ((u0, u1), (y0, y1)) = (group.u, group.y);
        let u = four(&self.band[k * w..(k + 4) * w], w, left + u0 - k, 1, u1 - u0);
        let y = four(&self.y[k * stride..(k + 4) * stride], stride, y0, 0, y1 - y0);
        for (pair, s_pair) in self.z.chunks_exact_mut(2 * padded).zip(self.schur.chunks_exact_mut(2 * stride))
        {
            let (first, second) = pair.split_at_mut(padded);
            let Some(m) = multipliers::<A>(&mut first[k..k + 4], &mut second[k..k + 4], &inverse) else {
                continue;
            };
            if u0 < u1 {
                update::<A, 4, 2>([&mut first[u0..u1], &mut second[u0..u1]], m, u);
            }
            if y0 < y1 {
                let (s_first, s_second) = s_pair.split_at_mut(stride);
                update::<A, 4, 2>([&mut s_first[y0..y1], &mut s_second[y0..y1]], m, y);
            }
        }
    }
}

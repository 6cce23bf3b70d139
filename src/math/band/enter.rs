//! Copies the stencil into the factors, piece by piece, as elimination gets there.

use super::{CyclicBand, Stencil};

impl CyclicBand {
    /// The unknown in which row `r` of the rotated system, border included, is diagonal.
    #[inline(always)]
    pub(super) fn unknown(&self, r: usize) -> usize {
        let (k, len) = (r + self.start, self.len());
        if k < len { k } else { k - len }
    }

    /// Copies the rows `from..to` into the band and, where they couple to the border, into `y`.
    #[inline(always)]
    pub(super) fn enter_rows(&mut self, a: &Stencil, from: usize, to: usize) {
        self.band[from * self.w..to * self.w].fill(0.0);
        self.y[from * self.stride..to * self.stride].fill(0.0);
        let mut j = from % self.b;
        for r in from..to.min(self.rows) {
            self.enter_row(a, r, j);
            j = if j + 1 < self.b { j + 1 } else { 0 };
        }
        // The padding says `x = 0`.
        for r in from.max(self.rows)..to {
            self.band[r * self.w + self.left] = 1.0;
        }
    }

    /// Copies row `r`, which is the `j`-th of its block.
    #[inline(always)]
    fn enter_row(&mut self, a: &Stencil, r: usize, j: usize) {
        let (b, rows, w, left, stride) = (self.b, self.rows, self.w, self.left, self.stride);
        let k = self.unknown(r);
        let row = &mut self.band[r * w..(r + 1) * w];
        let y = &mut self.y[r * stride..(r + 1) * stride];
        row[left] = a.diagonal[k];
        // With one unknown per block the neighbours in j do not exist and the slots belong to west and east.
        if b > 1 {
            row[left - 1] = if j > 0 { a.south[k] } else { 0.0 };
            row[left + 1] = if j + 1 < b { a.north[k] } else { 0.0 };
        }
        if r >= b {
            row[left - b] = a.west[k];
        } else if !self.cut {
            y[r] += a.west[k];
        }
        if r + b < rows {
            row[left + b] = a.east[k];
        } else if !self.cut {
            y[r + b - rows] += a.east[k];
        }
    }

    /// Copies the border's own rows into `schur` and, if the ring is cut, the couplings to the border into `edge`.
    pub(super) fn enter_corner(&mut self, a: &Stencil) {
        let (b, rows, stride) = (self.b, self.rows, self.stride);
        self.schur.fill(0.0);
        for j in 0..b {
            let k = self.unknown(rows + j);
            self.schur[j * stride + j] = a.diagonal[k];
            if j > 0 {
                self.schur[j * stride + j - 1] = a.south[k];
            }
            if j + 1 < b {
                self.schur[j * stride + j + 1] = a.north[k];
            }
            self.edge[j] = a.west[self.unknown(j)];
            self.edge[b + j] = a.east[self.unknown(rows - b + j)];
        }
    }

    /// Opens the columns `from..to` of `z`, with the border's couplings to the first and last block; returns `to`, rounded
    /// up to a full cache line.
    #[inline(always)]
    pub(super) fn extend_z(&mut self, a: &Stencil, from: usize, to: usize) -> usize {
        let (b, rows) = (self.b, self.rows);
        let to = to.next_multiple_of(8).min(self.padded);
        for row in self.z.chunks_exact_mut(self.padded) {
            for v in &mut row[from..to] {
                *v = 0.0;
            }
        }
        if from < b || to > rows - b {
            for j in 0..b {
                let k = self.unknown(rows + j);
                for (column, value) in [(j, a.east[k]), (rows - b + j, a.west[k])] {
                    if (from..to).contains(&column) {
                        self.z[j * self.padded + column] += value;
                    }
                }
            }
        }
        to
    }
}

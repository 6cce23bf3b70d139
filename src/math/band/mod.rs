//! Direct solver for five-point stencils on a grid that is periodic in its first direction.
//!
//! Unknown `(i, j)` has the index `i * b + j`; block `i` couples to `i - 1` and `i + 1` (cyclic) and, inside, `j` to
//! `j +- 1`. All blocks but one form a band of half-width `b`, factorised `L U`; the remaining block is a border,
//! eliminated by its Schur complement:
//!
//! ```text
//! [ A11 E ] [x1]   [r1]        Y = L^-1 E,  Z = G U^-1,  S = D - Z Y
//! [ G   D ] [x2] = [r2]
//! ```
//!
//! Closing the ring costs three times the band itself if `Y` and `Z` are full. The border is therefore put where the film
//! is cavitated: such cells couple to their upwind neighbour only, so that `Z` (or, upstream, `Y`) is all but empty; and
//! if the border couples to nothing at all, `G = 0` and neither is needed. What is zero is found while factorising: each
//! group of four rows knows the ranges its `L`, `U` and `Y` occupy, and nothing outside them is touched.
//!
//! There is no pivoting: film matrices are M-matrices, for which elimination is stable (Funderlic and Plemmons 1981); a
//! pivot that collapses is reported as [`Singular`]. Factor, solve and transposed solve allocate nothing and give the same
//! bits on every run of one machine.

mod aligned;
mod block;
mod border;
mod eliminate;
mod enter;
pub(super) mod kernels;
mod pack;
mod stencil;
mod substitute;
#[cfg(test)]
mod tests;

pub use stencil::Stencil;

use aligned::Aligned;
use border::Census;
use thiserror::Error;

/// A pivot collapsed: the matrix is singular to working accuracy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the film matrix is singular at unknown {0}")]
pub struct Singular(pub usize);

/// Ranges that four rows of the factors occupy outside their diagonal block: columns of the band, columns of `Y`.
#[derive(Debug, Clone, Copy)]
struct Group {
    l: (usize, usize),
    u: (usize, usize),
    y: (usize, usize),
}

/// Factorised cyclic stencil; see the module page.
#[derive(Debug, Clone)]
pub struct CyclicBand {
    blocks: usize,
    b: usize,
    /// Unknowns of the band, and the same rounded up to whole groups of four by rows of the identity.
    rows: usize,
    padded: usize,
    /// `b` rounded up to whole vectors of four: the length of a row of `Y` and of the Schur complement.
    stride: usize,
    /// Length of a stored row of the band, and the place of its diagonal. Entries beyond the band on either side stay zero,
    /// so that the four rows of a group can be read over the same columns, in whole vectors. A column that is a multiple of
    /// four is aligned in every row.
    w: usize,
    left: usize,
    /// First unknown of the band (the border block is the one before it).
    start: usize,
    /// The border couples to the first band block; to no block at all.
    first_coupled: bool,
    cut: bool,
    band: Aligned,
    groups: Vec<Group>,
    /// `Y`, one row of `b` per band unknown.
    y: Aligned,
    /// `Z`, one row per border unknown (rounded up to four), valid outside the columns `z_gap`, where it is zero.
    z: Aligned,
    z_gap: (usize, usize),
    /// If cut: couplings of the first and of the last band block to the border.
    edge: Vec<f64>,
    /// `L U` of the border's Schur complement.
    schur: Aligned,
    census: Vec<Census>,
    /// The factors without their zeros, if they were packed; band, `y` and `z` are empty then.
    packed: Option<pack::Packed>,
}

impl CyclicBand {
    /// Room for `blocks >= 3` blocks of `b` unknowns.
    pub fn new(blocks: usize, b: usize) -> Self {
        let empty = Self::sized(blocks, b);
        Self {
            band: Aligned::zeros(empty.padded * empty.w),
            groups: vec![Group { l: (0, 0), u: (0, 0), y: (0, 0) }; empty.padded / 4],
            y: Aligned::zeros(empty.padded * empty.stride),
            z: Aligned::zeros(empty.stride * empty.padded),
            census: vec![Census::default(); blocks],
            ..empty
        }
    }

    /// Everything but the room for the factors.
    fn sized(blocks: usize, b: usize) -> Self {
        assert!(blocks >= 3 && b >= 1, "a cyclic band needs at least 3 blocks");
        let rows = (blocks - 1) * b;
        let stride = b.next_multiple_of(4);
        let left = (b + 4).next_multiple_of(4);
        Self {
            blocks,
            b,
            rows,
            padded: rows.next_multiple_of(4),
            stride,
            w: left + stride + 5,
            left,
            start: 0,
            first_coupled: false,
            cut: false,
            band: Aligned::zeros(0),
            groups: Vec::new(),
            y: Aligned::zeros(0),
            z: Aligned::zeros(0),
            z_gap: (0, 0),
            edge: vec![0.0; 2 * b],
            schur: Aligned::zeros(stride * stride),
            census: Vec::new(),
            packed: None,
        }
    }

    /// Size of the factors of such a matrix.
    pub fn bytes(blocks: usize, b: usize) -> usize {
        let (rows, stride) = ((blocks - 1) * b, b.next_multiple_of(4));
        let (padded, left) = (rows.next_multiple_of(4), (b + 4).next_multiple_of(4));
        let numbers = padded * (left + stride + 5) + 2 * padded * stride + stride * stride + 2 * b;
        numbers * size_of::<f64>() + padded / 4 * size_of::<Group>() + blocks * size_of::<Census>()
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
    ///
    /// # Panics
    /// If this is a [`Self::keeper`].
    pub fn factor(&mut self, a: &Stencil) -> Result<(), Singular> {
        assert!(!self.band.is_empty(), "a keeper has no room to factorise in");
        let border = border::choose(a, self.b, &mut self.census);
        self.start = (border + 1) % self.blocks * self.b;
        let couples = |side: &[f64]| side[border * self.b..(border + 1) * self.b].iter().any(|&v| v != 0.0);
        self.first_coupled = couples(&a.east);
        self.cut = !self.first_coupled && !couples(&a.west);
        let (len, start) = (self.len(), self.start);
        kernels::fastest(eliminate::Eliminate { to: self, a }).map_err(|r| Singular((r + start) % len))
    }

    /// Replaces each column of `rhs` (consecutive vectors of [`Self::len`]) by the solution of `A x = rhs`. Several columns
    /// in one call are cheaper than one at a time.
    pub fn solve(&self, rhs: &mut [f64]) {
        self.solve_spaced(rhs, self.len());
    }

    /// Replaces each column of `rhs` by the solution of `A^T x = rhs`.
    pub fn solve_transposed(&self, rhs: &mut [f64]) {
        self.solve_transposed_spaced(rhs, self.len());
    }

    /// Like [`Self::solve`], for columns that are the heads of consecutive vectors of `spacing`.
    pub(super) fn solve_spaced(&self, rhs: &mut [f64], spacing: usize) {
        kernels::fastest(substitute::Solve { by: self, rhs, spacing, transposed: false });
    }

    /// Like [`Self::solve_transposed`], for columns that are the heads of consecutive vectors of `spacing`.
    pub(super) fn solve_transposed_spaced(&self, rhs: &mut [f64], spacing: usize) {
        kernels::fastest(substitute::Solve { by: self, rhs, spacing, transposed: true });
    }
}

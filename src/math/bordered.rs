//! A cyclic band with a few dense rows and columns: film unknowns bordered by the journal's motion.
//!
//! ```text
//! [ A X ] [x1]   [r1]        V = A^-1 X,  Sigma = S - K V
//! [ K S ] [x2] = [r2]
//! ```
//!
//! One band solve serves all right-hand sides of a call, forward or transposed, and one gives all of `V`. `A` may be empty (a film in closed form): then `S` is all.

use super::vector::{axpy, dot};
use super::{CyclicBand, Singular, Stencil};
use nalgebra::DMatrix;

/// Most border unknowns: journal motion with tilt, their velocities and a film temperature fit well.
const MOST: usize = 16;
/// Right-hand sides that are solved side by side: as many as a cache holds beside the factors.
const TOGETHER: usize = 8;

/// Factorised bordered matrix. Fill [`Self::columns`], [`Self::rows`] and [`Self::corner`], then call [`Self::factor`].
#[derive(Debug, Clone)]
pub struct Bordered {
    band: Option<CyclicBand>,
    n: usize,
    k: usize,
    /// `X`, column by column, and room for one more; holds `V` after [`Self::factor`]. Columns of zeros at the end (velocities) cost
    /// nothing.
    pub columns: Vec<f64>,
    /// `K`, row by row.
    pub rows: Vec<f64>,
    /// `S`.
    pub corner: DMatrix<f64>,
    /// Which columns and rows hold anything: others are not worked with.
    used: [[bool; MOST]; 2],
    sigma_inverse: DMatrix<f64>,
}

impl Bordered {
    /// Room for `blocks * b` band unknowns (none if `blocks` is 0) and `k` border unknowns.
    pub fn new(blocks: usize, b: usize, k: usize) -> Self {
        Self::bordering((blocks > 0).then(|| CyclicBand::new(blocks, b)), blocks * b, k)
    }

    /// Room for packed factors of such a matrix, not for factorising.
    pub fn keeper(blocks: usize, b: usize, k: usize) -> Self {
        Self::bordering((blocks > 0).then(|| CyclicBand::keeper(blocks, b)), blocks * b, k)
    }

    fn bordering(band: Option<CyclicBand>, n: usize, k: usize) -> Self {
        assert!(k <= MOST, "at most {MOST} border unknowns");
        Self {
            band,
            n,
            k,
            columns: vec![0.0; n * (k + 1)],
            rows: vec![0.0; n * k],
            corner: DMatrix::zeros(k, k),
            used: [[true; MOST]; 2],
            sigma_inverse: DMatrix::zeros(k, k),
        }
    }

    /// Copies the factors into a keeper.
    pub fn pack_into(&self, keeper: &mut Self) {
        if let (Some(band), Some(kept)) = (&self.band, &mut keeper.band) {
            band.pack_into(kept);
        }
        for (part, (from, to)) in
            [(&self.columns, &mut keeper.columns), (&self.rows, &mut keeper.rows)].into_iter().enumerate()
        {
            for c in (0..self.k).filter(|c| self.used[part][*c]) {
                let one = c * self.n..(c + 1) * self.n;
                to[one.clone()].copy_from_slice(&from[one]);
            }
        }
        keeper.used = self.used;
        keeper.corner.copy_from(&self.corner);
        keeper.sigma_inverse.copy_from(&self.sigma_inverse);
    }

    /// Size of the factors of such a matrix.
    pub fn bytes(blocks: usize, b: usize, k: usize) -> usize {
        let band = if blocks > 0 { CyclicBand::bytes(blocks, b) } else { 0 };
        band + ((2 * k + 1) * blocks * b + 2 * k * k) * size_of::<f64>()
    }

    /// Number of unknowns, band and border.
    pub fn len(&self) -> usize {
        self.n + self.k
    }

    /// Whether there is nothing to solve.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Factorises with `a` as the band part.
    pub fn factor(&mut self, a: &Stencil) -> Result<(), Singular> {
        self.eliminate(a, &mut [])
    }

    /// Factorises and replaces one right-hand side by the solution: cheaper than one after the other, as the band is solved
    /// for it together with the columns.
    pub fn factor_and_solve(&mut self, a: &Stencil, rhs: &mut [f64]) -> Result<(), Singular> {
        let (x1, x2) = rhs.split_at_mut(self.n);
        self.eliminate(a, x1)?;
        self.solve_border(x1, x2);
        Ok(())
    }

    /// Factorises, and solves with the band alone.
    fn eliminate(&mut self, a: &Stencil, x1: &mut [f64]) -> Result<(), Singular> {
        // A handful of unknowns: the inverse serves both kinds of solve without allocation.
        let sigma = &mut self.sigma_inverse;
        sigma.copy_from(&self.corner);
        if let Some(band) = &mut self.band {
            band.factor(a)?;
            let n = self.n;
            for (used, part) in self.used.iter_mut().zip([&self.columns, &self.rows]) {
                for (used, one) in used.iter_mut().zip(part.chunks_exact(n)) {
                    *used = one.iter().any(|v| *v != 0.0);
                }
            }
            let full = (0..self.k).rev().find(|c| self.used[0][*c]).map_or(0, |c| c + 1);
            let behind = full * n..full * n + x1.len();
            self.columns[behind.clone()].copy_from_slice(x1);
            band.solve(&mut self.columns[..behind.end]);
            x1.copy_from_slice(&self.columns[behind.clone()]);
            self.columns[behind].fill(0.0);
            for (i, row) in self.rows.chunks_exact(n).enumerate() {
                if !self.used[1][i] {
                    continue;
                }
                for (j, column) in self.columns.chunks_exact(n).take(full).enumerate() {
                    sigma[(i, j)] -= dot(row, column);
                }
            }
        }
        let regular = sigma.try_inverse_mut() && sigma.iter().all(|v| v.is_finite());
        if regular { Ok(()) } else { Err(Singular(self.n)) }
    }

    /// Completes a solution from that of the band alone.
    fn solve_border(&self, x1: &mut [f64], x2: &mut [f64]) {
        for (i, v) in x2.iter_mut().enumerate().filter(|(i, _)| self.used[1][*i]) {
            *v -= dot(&self.rows[i * self.n..(i + 1) * self.n], x1);
        }
        self.solve_corner(x2, false);
        for (j, v) in x2.iter().enumerate().filter(|(j, _)| self.used[0][*j]) {
            axpy(x1, -v, &self.columns[j * self.n..(j + 1) * self.n]);
        }
    }

    /// `x = Sigma^-1 x`, or with the transposed matrix.
    fn solve_corner(&self, x: &mut [f64], transposed: bool) {
        let mut result = [0.0; MOST];
        for (i, r) in result[..self.k].iter_mut().enumerate() {
            let entry = |j| if transposed { self.sigma_inverse[(j, i)] } else { self.sigma_inverse[(i, j)] };
            *r = x.iter().enumerate().map(|(j, v)| entry(j) * v).sum();
        }
        x.copy_from_slice(&result[..self.k]);
    }

    /// Replaces each column of `rhs` by the solution.
    pub fn solve(&self, rhs: &mut [f64]) {
        rhs.chunks_mut(TOGETHER * self.len()).for_each(|some| self.solve_some(some));
    }

    fn solve_some(&self, rhs: &mut [f64]) {
        if let Some(band) = &self.band {
            band.solve_spaced(rhs, self.len());
        }
        for x in rhs.chunks_exact_mut(self.len()) {
            let (x1, x2) = x.split_at_mut(self.n);
            self.solve_border(x1, x2);
        }
    }

    /// Replaces each column of `rhs` by the solution of the transposed system.
    pub fn solve_transposed(&self, rhs: &mut [f64]) {
        rhs.chunks_mut(TOGETHER * self.len()).for_each(|some| self.solve_some_transposed(some));
    }

    fn solve_some_transposed(&self, rhs: &mut [f64]) {
        for x in rhs.chunks_exact_mut(self.len()) {
            let (x1, x2) = x.split_at_mut(self.n);
            for (j, v) in x2.iter_mut().enumerate().filter(|(j, _)| self.used[0][*j]) {
                *v -= dot(&self.columns[j * self.n..(j + 1) * self.n], x1);
            }
            self.solve_corner(x2, true);
            for (i, v) in x2.iter().enumerate().filter(|(i, _)| self.used[1][*i]) {
                axpy(x1, -v, &self.rows[i * self.n..(i + 1) * self.n]);
            }
        }
        if let Some(band) = &self.band {
            band.solve_transposed_spaced(rhs, self.len());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of 4 x 2 unknowns bordered by 3, as the solver takes it and as a dense matrix.
    fn example() -> (Bordered, Stencil, DMatrix<f64>) {
        let (n, k) = (8, 3);
        let mut system = Bordered::new(4, 2, k);
        let mut a = Stencil::zeros(n);
        let mut dense = DMatrix::from_fn(n + k, n + k, |i, j| ((3 * i + 5 * j) as f64).sin());
        dense.view_mut((0, 0), (n, n)).fill(0.0);
        (n..n + k).for_each(|i| dense[(i, i)] += 4.0);
        for r in 0..n {
            a.diagonal[r] = 5.0 + r as f64;
            a.west[r] = -1.0 - 0.1 * r as f64;
            a.east[r] = -0.5;
            dense[(r, r)] = a.diagonal[r];
            dense[(r, (r + 6) % n)] = a.west[r];
            dense[(r, (r + 2) % n)] = a.east[r];
        }
        for i in 0..k {
            for r in 0..n {
                system.columns[i * n + r] = dense[(r, n + i)];
                system.rows[i * n + r] = dense[(n + i, r)];
            }
        }
        system.corner.copy_from(&dense.view((n, n), (k, k)));
        (system, a, dense)
    }

    #[test]
    fn agrees_with_a_dense_solver_both_ways() {
        let (mut system, a, dense) = example();
        system.factor(&a).unwrap();
        let truth = nalgebra::DVector::from_fn(11, |i, _| i as f64 - 4.0);
        // Three right-hand sides, of which the solutions are multiples of one.
        let columns = |m: &DMatrix<f64>| -> Vec<f64> {
            [1.0, -2.0, 0.5]
                .iter()
                .flat_map(|f| (m * &truth * *f).iter().copied().collect::<Vec<_>>())
                .collect()
        };
        let (mut x, mut y) = (columns(&dense), columns(&dense.transpose()));
        system.solve(&mut x);
        system.solve_transposed(&mut y);
        for (c, f) in [1.0, -2.0, 0.5].iter().enumerate() {
            for i in 0..11 {
                let wanted = f * truth[i];
                assert!((x[11 * c + i] - wanted).abs() < 1e-11 && (y[11 * c + i] - wanted).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn packed_factors_and_a_first_solve_beside_the_factors_give_the_same() {
        let ((mut system, a, _), (mut beside, ..)) = (example(), example());
        let mut first: Vec<f64> = (0..11).map(|i| f64::from(i) - 4.0).collect();
        let (mut rhs, mut packed, mut transposed) = (first.clone(), first.clone(), first.clone());
        let mut packed_transposed = first.clone();
        system.factor(&a).unwrap();
        beside.factor_and_solve(&a, &mut first).unwrap();
        let mut keeper = Bordered::keeper(4, 2, 3);
        beside.pack_into(&mut keeper);
        system.solve(&mut rhs);
        keeper.solve(&mut packed);
        system.solve_transposed(&mut transposed);
        keeper.solve_transposed(&mut packed_transposed);
        // The very same operations on numbers that stand elsewhere.
        assert_eq!(packed, rhs);
        assert_eq!(packed_transposed, transposed);
        assert!(first.iter().zip(&rhs).all(|(a, b)| (a - b).abs() <= 1e-14 * b.abs().max(1.0)));
    }

    #[test]
    fn a_singular_corner_is_reported() {
        let mut system = Bordered::new(0, 0, 2);
        assert!(system.factor(&Stencil::zeros(0)).is_err());
    }
}

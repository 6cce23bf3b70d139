//! Fixed points of linear maps that are known by their action only: `x = b + K x` by GMRES (Saad and Schultz 1986).
//!
//! Several columns advance side by side, each in its own Krylov space, because one action of `K` on many columns is cheaper
//! than many actions on one. A map that forgets most of what it is given needs a handful of actions, also where the plain
//! iteration `x <- b + K x` would take many, or run away. Deliberately not here: preconditioning, restarts.

use super::vector::{axpy, dot};

/// Outcome of [`fixed_points`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPoints {
    /// Largest residual `|b + K x - x| / |b|` of any column.
    pub residual: f64,
    /// Actions of `K` on all columns.
    pub actions: usize,
}

/// Krylov space of one column.
struct Space {
    basis: Vec<Vec<f64>>,
    /// Columns of the triangle that Givens rotations make of the Hessenberg matrix.
    triangle: Vec<Vec<f64>>,
    rotations: Vec<[f64; 2]>,
    rhs: Vec<f64>,
    size: f64,
}

impl Space {
    fn new(b: &[f64]) -> Self {
        let size = dot(b, b).sqrt();
        let first = b.iter().map(|v| if size > 0.0 { v / size } else { 0.0 }).collect();
        Self { basis: vec![first], triangle: Vec::new(), rotations: Vec::new(), rhs: vec![size], size }
    }

    /// Residual relative to `b`.
    fn residual(&self) -> f64 {
        if self.size > 0.0 { self.rhs[self.triangle.len()].abs() / self.size } else { 0.0 }
    }

    /// Takes `K v` for the newest base vector `v`.
    fn extend(&mut self, image: &[f64]) {
        let newest = self.basis.last().expect("a space has a first vector");
        let mut w: Vec<f64> = newest.iter().zip(image).map(|(v, k)| v - k).collect();
        let mut column = vec![0.0; self.basis.len()];
        // Twice is enough (Giraud, Langou and Rozloznik 2005) to keep the base orthogonal to rounding.
        for _ in 0..2 {
            for (h, v) in column.iter_mut().zip(&self.basis) {
                let part = dot(v, &w);
                *h += part;
                axpy(&mut w, -part, v);
            }
        }
        let below = dot(&w, &w).sqrt();
        for (k, [c, s]) in self.rotations.iter().enumerate() {
            let (a, b) = (column[k], column[k + 1]);
            (column[k], column[k + 1]) = (c * a + s * b, c * b - s * a);
        }
        let k = column.len() - 1;
        let length = column[k].hypot(below);
        let [c, s] = if length > 0.0 { [column[k] / length, below / length] } else { [1.0, 0.0] };
        column[k] = length;
        self.rotations.push([c, s]);
        self.triangle.push(column);
        self.rhs.push(-s * self.rhs[k]);
        self.rhs[k] *= c;
        let scale = if below > 0.0 { 1.0 / below } else { 0.0 };
        self.basis.push(w.iter().map(|v| v * scale).collect());
    }

    fn solution(&self, x: &mut [f64]) {
        let n = self.triangle.len();
        let mut y = vec![0.0; n];
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| self.triangle[j][k] * y[j]).sum();
            let pivot = self.triangle[k][k];
            y[k] = if pivot != 0.0 { (self.rhs[k] - known) / pivot } else { 0.0 };
        }
        x.fill(0.0);
        self.basis.iter().zip(&y).for_each(|(v, y)| axpy(x, *y, v));
    }
}

/// Replaces each column of `b` (vectors of `length`) by the solution of `x = b + K x`, to a relative residual of `tolerance` or as near
/// as `most` actions of `K` lead. `act` replaces columns by their images; columns that are done are handed over as zeros.
pub fn fixed_points<E>(
    b: &mut [f64],
    length: usize,
    tolerance: f64,
    most: usize,
    mut act: impl FnMut(&mut [f64]) -> Result<(), E>,
) -> Result<FixedPoints, E> {
    if length == 0 {
        return Ok(FixedPoints { residual: 0.0, actions: 0 });
    }
    let mut spaces: Vec<Space> = b.chunks_exact(length).map(Space::new).collect();
    let mut images = vec![0.0; b.len()];
    let mut actions = 0;
    let open = |s: &Space| s.residual() > tolerance;
    while actions < most && spaces.iter().any(open) {
        for (image, space) in images.chunks_exact_mut(length).zip(&spaces) {
            match open(space) {
                true => image.copy_from_slice(space.basis.last().expect("a space has a first vector")),
                false => image.fill(0.0),
            }
        }
        act(&mut images)?;
        actions += 1;
        let pairs = spaces.iter_mut().zip(images.chunks_exact(length));
        pairs.filter(|(space, _)| open(space)).for_each(|(space, image)| space.extend(image));
    }
    b.chunks_exact_mut(length).zip(&spaces).for_each(|(x, space)| space.solution(x));
    Ok(FixedPoints { residual: spaces.iter().map(Space::residual).fold(0.0, f64::max), actions })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use std::convert::Infallible;

    fn solved(k: &DMatrix<f64>, b: &DMatrix<f64>) -> (DMatrix<f64>, FixedPoints) {
        let n = b.nrows();
        let mut x = b.clone();
        let found = fixed_points(x.as_mut_slice(), n, 1e-13, 50, |columns| {
            for column in columns.chunks_exact_mut(n) {
                let image = k * DVector::from_column_slice(column);
                column.copy_from_slice(image.as_slice());
            }
            Ok::<(), Infallible>(())
        });
        (x, found.unwrap())
    }

    #[test]
    fn fixed_points_of_contracting_and_of_expanding_maps_are_found() {
        for size in [0.3, 4.0] {
            let k = DMatrix::from_fn(9, 9, |i, j| size * ((2 * i + 5 * j) as f64).sin() / 3.0);
            let b = DMatrix::from_fn(9, 3, |i, j| ((i + 1) * (j + 2)) as f64 % 7.0);
            let (x, found) = solved(&k, &b);
            assert!(found.residual < 1e-13, "{found:?}");
            let left = (&b + &k * &x - &x).norm() / b.norm();
            assert!(left < 1e-12, "{left:.1e}");
        }
    }

    #[test]
    fn a_map_of_low_rank_needs_one_action_per_rank_and_one_more() {
        let n = 40;
        let k = DMatrix::from_fn(n, n, |i, j| {
            0.9 * f64::from(u8::from(i == 3 && j == 3)) + if i == 5 && j == 1 { 2.0 } else { 0.0 }
        });
        let (_, found) = solved(&k, &DMatrix::from_element(n, 1, 1.0));
        assert!(found.actions <= 3, "{found:?}");
        let (x, found) = solved(&k, &DMatrix::zeros(n, 2));
        assert_eq!((found.actions, x.norm()), (0, 0.0));
    }
}

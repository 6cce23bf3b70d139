//! A free form: tensor product of cubic B-splines, periodic around and clamped across, with many coefficients.
//!
//! Coefficient `(i, k)` is number `i * across + k`. Around the knots are even and coefficient `i` is centred at
//! `phi = 2 pi i / around`. Across there are four knots at each edge and even ones between, so that the outermost
//! coefficients are the values at the edges; coefficient `k` stands at its Greville abscissa, see [`TensorSpline::sites`].
//! The surface lies within the range of its coefficients, which makes bounds on them bounds on the gap. One coefficient
//! in a direction means constant in that direction.
//!
//! Deliberately not here: uneven knots and refinement.

use super::ShapeError;
use super::basis::{Span, greville};
use super::error::{all_finite, count};
use std::f64::consts::TAU;

/// A spline surface over the unwrapped bearing, twice continuously differentiable; its coefficients are lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub struct TensorSpline {
    around: usize,
    across: usize,
    mirrored: bool,
    coefficients: Vec<f64>,
}

impl TensorSpline {
    /// `around` (1 or at least 4) by `across` (1 or at least 4) coefficients, m.
    pub fn new(around: usize, across: usize, coefficients: Vec<f64>) -> Result<Self, ShapeError> {
        if across != 1 && across < 4 {
            return Err(few("spline coefficients across", "1 or at least 4", across));
        }
        Self { around, across, mirrored: false, coefficients }.checked()
    }

    /// A surface that is symmetric about the mid-plane: `across_half` (at least 3) coefficients for `zeta >= 0`, the
    /// first of them at the mid-plane. It is the surface of [`Self::new`] with `2 across_half - 1` mirrored coefficients.
    pub fn symmetric(around: usize, across_half: usize, coefficients: Vec<f64>) -> Result<Self, ShapeError> {
        if across_half < 3 {
            return Err(few("spline coefficients from the mid-plane to the edge", "at least 3", across_half));
        }
        Self { around, across: across_half, mirrored: true, coefficients }.checked()
    }

    /// The same knots with other coefficients, m.
    pub fn with_coefficients(&self, coefficients: &[f64]) -> Result<Self, ShapeError> {
        Self { coefficients: coefficients.to_vec(), ..*self }.checked()
    }

    fn checked(self) -> Result<Self, ShapeError> {
        if self.around != 1 && self.around < 4 {
            return Err(few("spline coefficients around", "1 or at least 4", self.around));
        }
        count("spline coefficients", self.coefficients.len(), self.around * self.across)?;
        all_finite("coefficients", &self.coefficients)?;
        Ok(self)
    }

    /// The coefficients, m.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Number of coefficients around and across (across: from the mid-plane to the edge for a symmetric surface).
    pub fn counts(&self) -> [usize; 2] {
        [self.around, self.across]
    }

    /// Whether the surface is symmetric about the mid-plane whatever its coefficients.
    pub fn is_symmetric(&self) -> bool {
        self.mirrored || self.across == 1
    }

    /// Whether the surface is the same all around whatever its coefficients.
    pub fn is_axisymmetric(&self) -> bool {
        self.around == 1
    }

    /// Where every coefficient stands, as `[phi, zeta]`.
    pub fn sites(&self) -> Vec<[f64; 2]> {
        let zeta = |k| {
            if self.mirrored {
                greville(2 * self.across - 1, self.across - 1 + k)
            } else {
                greville(self.across, k)
            }
        };
        (0..self.around)
            .flat_map(|i| (0..self.across).map(move |k| [TAU * i as f64 / self.around as f64, zeta(k)]))
            .collect()
    }

    /// Value (m) and slope around (m/rad) at a point.
    pub(super) fn at(&self, phi: f64, zeta: f64) -> [f64; 2] {
        let (a, c) = self.spans(phi, zeta);
        let mut sum = [0.0; 2];
        for i in 0..4 {
            let row = &self.coefficients[a.index[i] * self.across..];
            let inner: f64 = (0..4).map(|k| c.value[k] * row[c.index[k]]).sum();
            sum[0] += a.value[i] * inner;
            sum[1] += a.slope[i] * inner;
        }
        sum
    }

    /// Derivatives of [`Self::at`] by every coefficient that matters there, at most 16.
    pub(super) fn visit(&self, phi: f64, zeta: f64, each: &mut impl FnMut(usize, [f64; 2])) {
        let (a, c) = self.spans(phi, zeta);
        for i in 0..4 {
            for k in 0..4 {
                let d = [a.value[i] * c.value[k], a.slope[i] * c.value[k]];
                if d != [0.0; 2] {
                    each(a.index[i] * self.across + c.index[k], d);
                }
            }
        }
    }

    fn spans(&self, phi: f64, zeta: f64) -> (Span, Span) {
        let across = if self.mirrored {
            Span::across(2 * self.across - 1, zeta).mirrored(self.across)
        } else {
            Span::across(self.across, zeta)
        };
        (Span::around(self.around, phi), across)
    }
}

fn few(what: &'static str, range: &str, found: usize) -> ShapeError {
    ShapeError::Count { what, range: range.into(), found }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_coefficients_are_a_constant() {
        for spline in [
            TensorSpline::new(7, 5, vec![3.0; 35]).unwrap(),
            TensorSpline::new(1, 4, vec![3.0; 4]).unwrap(),
            TensorSpline::new(4, 1, vec![3.0; 4]).unwrap(),
            TensorSpline::symmetric(6, 3, vec![3.0; 18]).unwrap(),
        ] {
            for i in 0..100 {
                let [gap, slope] = spline.at(0.1 * f64::from(i) - 2.0, 0.02 * f64::from(i) - 1.0);
                assert!((gap - 3.0).abs() < 1e-14 && slope.abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_symmetric_surface_is_the_full_one_with_mirrored_coefficients() {
        let half: Vec<f64> = (0..20).map(|k| f64::from(k * k % 7)).collect();
        let full: Vec<f64> =
            half.chunks(4).flat_map(|r| [r[3], r[2], r[1], r[0], r[1], r[2], r[3]]).collect();
        let (half, full) =
            (TensorSpline::symmetric(5, 4, half).unwrap(), TensorSpline::new(5, 7, full).unwrap());
        for i in 0..=100 {
            let (phi, zeta) = (0.07 * f64::from(i), 0.02 * f64::from(i) - 1.0);
            let (a, b) = (half.at(phi, zeta), full.at(phi, zeta));
            assert!((a[0] - b[0]).abs() < 1e-13 && (a[1] - b[1]).abs() < 1e-13);
        }
        assert_eq!(half.sites()[4..6], full.sites()[10..12]);
    }

    #[test]
    fn edge_coefficients_are_edge_values_and_a_point_needs_at_most_16() {
        let spline = TensorSpline::new(6, 5, (0..30).map(f64::from).collect()).unwrap();
        let edge: f64 =
            [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0].iter().zip([0.0, 5.0, 10.0]).map(|(w, c)| w * c).sum();
        assert!((spline.at(TAU / 6.0, -1.0)[0] - edge).abs() < 1e-14);
        let mut visits = 0;
        spline.visit(0.3, 0.2, &mut |_, _| visits += 1);
        assert_eq!(visits, 16);
    }

    #[test]
    fn wrong_counts_are_named() {
        let message = TensorSpline::new(3, 4, vec![0.0; 12]).unwrap_err().to_string();
        assert_eq!(message, "spline coefficients around: 1 or at least 4 needed, 3 given");
        assert!(TensorSpline::new(4, 4, vec![0.0; 15]).is_err());
        assert!(TensorSpline::symmetric(4, 2, vec![0.0; 8]).is_err());
        let mut c = vec![0.0; 16];
        c[5] = f64::NAN;
        let message = TensorSpline::new(4, 4, c).unwrap_err().to_string();
        assert_eq!(message, "coefficients[5] has to be a finite number, not NaN");
    }
}

//! A measured surface: heights on a grid of angles and axial positions.
//!
//! Between the grid points the surface is the tensor product of cubic Hermite polynomials; the slope at a grid line is
//! that of the parabola through the line and its two neighbours. The surface passes through every height, has continuous
//! slopes, and a scratch in the table does not ring around the bearing, as it would with an interpolating spline. Next to
//! a sharp step it may swing over by a tenth of the step.
//!
//! Deliberately not here: smoothing and alignment of raw measurements.

use super::ShapeError;
use super::error::{all_finite, count, finite};
use super::hermite::{slopes, weights};
use std::f64::consts::TAU;

/// Heights on a grid, with one coefficient: the factor `scale`.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceTable {
    angles_rad: Vec<f64>,
    zetas: Vec<f64>,
    scale: f64,
    /// Height, slope around, slope across and the mixed derivative at every grid point.
    nodes: Vec<[f64; 4]>,
    symmetric: bool,
    axisymmetric: bool,
}

impl SurfaceTable {
    /// Heights in m, `heights_m[i * zetas.len() + k]` at angle `i` and axial position `k`.
    ///
    /// The angles (one, or at least three) increase strictly within one turn, the axial positions increase strictly
    /// within -1 to 1. Beyond the outermost axial positions the outermost heights hold.
    pub fn new(angles_rad: Vec<f64>, zetas: Vec<f64>, heights_m: &[f64]) -> Result<Self, ShapeError> {
        let what = "angles of the surface table";
        increasing(what, &angles_rad)?;
        increasing("axial positions of the surface table", &zetas)?;
        if angles_rad.is_empty() || angles_rad.len() == 2 {
            return Err(ShapeError::Count { what, range: "1 or at least 3".into(), found: angles_rad.len() });
        }
        let turn = angles_rad[angles_rad.len() - 1] - angles_rad[0];
        if turn >= TAU * (1.0 - 1e-9) {
            return Err(ShapeError::OutOfRange {
                what: "the angle from the first to the last column of the surface table",
                range: "less than a full turn (the first column closes the circle)",
                value: turn,
            });
        }
        let (n, m) = (angles_rad.len(), zetas.len());
        if m == 0 {
            let what = "axial positions of the surface table";
            return Err(ShapeError::Count { what, range: "at least 1".into(), found: 0 });
        }
        if let Some(&value) = zetas.iter().find(|z| z.abs() > 1.0) {
            return Err(ShapeError::OutOfRange { what: "an axial position", range: "within -1 to 1", value });
        }
        count("heights of the surface table", heights_m.len(), n * m)?;
        all_finite("heights", heights_m)?;

        let across = slopes(heights_m, |i, k| i * m + k, n, &zetas, None);
        let around = slopes(heights_m, |k, i| i * m + k, m, &angles_rad, Some(TAU));
        let mixed = slopes(&across, |k, i| i * m + k, m, &angles_rad, Some(TAU));
        let nodes = (0..n * m).map(|a| [heights_m[a], around[a], across[a], mixed[a]]).collect();

        let near = 1e-12 * heights_m.iter().fold(0.0, |s: f64, h| s.max(h.abs()));
        let mirror = |k: usize| m - 1 - k;
        let symmetric = (0..m).all(|k| (zetas[k] + zetas[mirror(k)]).abs() < 1e-12)
            && (0..n * m).all(|a| (heights_m[a] - heights_m[a - a % m + mirror(a % m)]).abs() <= near);
        let axisymmetric = (0..n * m).all(|a| (heights_m[a] - heights_m[a % m]).abs() <= near);
        Ok(Self { angles_rad, zetas, scale: 1.0, nodes, symmetric, axisymmetric })
    }

    /// The same table with another factor.
    pub fn with_scale(&self, scale: f64) -> Result<Self, ShapeError> {
        finite("scale", scale)?;
        Ok(Self { scale, ..self.clone() })
    }

    /// The factor on the heights.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Whether the table is symmetric about the mid-plane.
    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Whether the table is the same all around.
    pub fn is_axisymmetric(&self) -> bool {
        self.axisymmetric
    }

    /// Height (m) and slope around (m/rad) at a point, for a factor of 1.
    pub(super) fn unit(&self, phi: f64, zeta: f64) -> [f64; 2] {
        let (n, m) = (self.angles_rad.len(), self.zetas.len());
        let first = self.angles_rad[0];
        let phi = first + (phi - first).rem_euclid(TAU);
        let i = self.angles_rad.partition_point(|a| *a <= phi).max(1) - 1;
        let (next, end) = if i + 1 < n { (i + 1, self.angles_rad[i + 1]) } else { (0, first + TAU) };
        let (a, slope) = weights(self.angles_rad[i], end, phi);

        let zeta = zeta.clamp(self.zetas[0], self.zetas[m - 1]);
        let k = self.zetas.partition_point(|z| *z <= zeta).clamp(1, (m - 1).max(1)) - 1;
        let above = (k + 1).min(m - 1);
        let (c, _) = weights(self.zetas[k], self.zetas[above], zeta);

        let mut sum = [0.0; 2];
        for (row, at) in [(i, 0), (next, 2)] {
            for (column, at_z) in [(k, 0), (above, 2)] {
                let [f, f_phi, f_z, f_both] = self.nodes[row * m + column];
                let value = c[at_z] * f + c[at_z + 1] * f_z;
                let around = c[at_z] * f_phi + c[at_z + 1] * f_both;
                sum[0] += a[at] * value + a[at + 1] * around;
                sum[1] += slope[at] * value + slope[at + 1] * around;
            }
        }
        sum
    }
}

fn increasing(what: &'static str, x: &[f64]) -> Result<(), ShapeError> {
    all_finite(what, x)?;
    match x.windows(2).find(|w| w[1] <= w[0]) {
        Some(w) => Err(ShapeError::Order { what, before: w[0], after: w[1] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uneven() -> SurfaceTable {
        let angles = vec![0.2, 1.0, 2.5, 3.1, 4.0, 5.9];
        let zetas = vec![-0.9, -0.2, 0.5, 1.0];
        let heights: Vec<f64> =
            angles.iter().flat_map(|a: &f64| zetas.iter().map(move |z| a.sin() * (1.0 + z * z))).collect();
        SurfaceTable::new(angles, zetas, &heights).unwrap()
    }

    #[test]
    fn the_surface_passes_through_the_table_with_continuous_slopes() {
        let table = uneven();
        for &phi in &table.angles_rad {
            for &zeta in &table.zetas {
                assert!((table.unit(phi, zeta)[0] - phi.sin() * (1.0 + zeta * zeta)).abs() < 1e-14);
                for turned in [phi, phi + TAU, phi - TAU] {
                    let (low, high) =
                        (table.unit(turned - 1e-9, zeta - 1e-9), table.unit(turned + 1e-9, zeta));
                    assert!((low[0] - high[0]).abs() < 1e-8 && (low[1] - high[1]).abs() < 1e-7);
                }
            }
        }
    }

    #[test]
    fn parabolas_across_and_the_slope_around_are_exact() {
        let table = uneven();
        for i in 0..300 {
            let (phi, zeta) = (0.021 * f64::from(i) + 0.003, 0.0063 * f64::from(i) - 0.9);
            let scale = table.unit(phi, 0.0)[0];
            assert!(
                (table.unit(phi, zeta.min(1.0))[0] - scale * (1.0 + zeta.min(1.0).powi(2))).abs() < 1e-13
            );
            let slope = (table.unit(phi + 1e-6, zeta)[0] - table.unit(phi - 1e-6, zeta)[0]) / 2e-6;
            assert!((slope - table.unit(phi, zeta)[1]).abs() < 1e-5);
        }
    }

    #[test]
    fn symmetries_are_seen() {
        let angles = vec![0.0, 2.0, 4.0];
        let even =
            SurfaceTable::new(angles.clone(), vec![-1.0, 0.0, 1.0], &[1.0, 0.0, 1.0].repeat(3)).unwrap();
        assert!(even.is_symmetric() && even.is_axisymmetric());
        let odd = SurfaceTable::new(angles, vec![-1.0, 1.0], &[1.0, 0.0, 0.0, 1.0, 0.0, 0.0]).unwrap();
        assert!(!odd.is_symmetric() && !odd.is_axisymmetric());
        let flat = SurfaceTable::new(vec![1.0], vec![0.3], &[2.0]).unwrap();
        assert!(flat.is_axisymmetric() && flat.unit(5.0, -0.7) == [2.0, 0.0]);
    }

    #[test]
    fn wrong_tables_are_refused() {
        assert!(SurfaceTable::new(vec![0.0, 1.0, 1.0], vec![0.0], &[0.0; 3]).is_err());
        assert!(SurfaceTable::new(vec![0.0, 3.0, TAU], vec![0.0], &[0.0; 3]).is_err());
        assert!(SurfaceTable::new(vec![0.0], vec![-2.0, 0.0], &[0.0; 2]).is_err());
        assert!(SurfaceTable::new(vec![0.0], vec![], &[]).is_err());
        assert!(SurfaceTable::new(vec![0.0], vec![0.0], &[0.0; 2]).is_err());
    }
}

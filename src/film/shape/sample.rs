//! A profile at the points of a mesh: gap, slope around, and both by every coefficient.
//!
//! A profile that turns with the journal by the angle `rotation` adds `g(phi - rotation, zeta)`; at a fixed point of the
//! shell this changes at the rate `-rotation' dg/dphi`, which is why the slope around leaves together with the gap.

use super::{Profile, bore};

/// What a profile adds to the gap at each point, and its derivatives by the coefficients.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SampledProfile {
    /// The addition to the gap at each point, m.
    pub gap_m: Vec<f64>,
    /// For each coefficient the points it moves and the derivative of the gap there.
    pub slopes: Vec<Vec<(usize, f64)>>,
}

impl Profile {
    /// The profile at points `[phi, zeta]`.
    pub fn sample(&self, points: &[[f64; 2]]) -> SampledProfile {
        self.sample_turned(points, 0.0)
    }

    /// The profile, turned by an angle, at points `[phi, zeta]`.
    pub fn sample_turned(&self, points: &[[f64; 2]], rotation_rad: f64) -> SampledProfile {
        let mut gap_m = vec![0.0; points.len()];
        self.gap_m_into(points, rotation_rad, &mut gap_m);
        let mut slopes = vec![Vec::new(); self.coefficient_count()];
        for (at, [phi, zeta]) in points.iter().enumerate() {
            self.visit(phi - rotation_rad, *zeta, &mut |j, d| {
                if d[0] != 0.0 {
                    slopes[j].push((at, d[0]));
                }
            });
        }
        SampledProfile { gap_m, slopes }
    }

    /// Writes what the profile, turned by an angle, adds to the gap, m.
    pub fn gap_m_into(&self, points: &[[f64; 2]], rotation_rad: f64, out: &mut [f64]) {
        assert_eq!(points.len(), out.len(), "one number per point");
        for ([phi, zeta], out) in points.iter().zip(out) {
            *out = self.at(phi - rotation_rad, *zeta)[0];
        }
    }

    /// Writes the slope of the gap around, `dg/dphi` at fixed coefficients, for the profile turned by an angle, m/rad.
    pub fn around_m_into(&self, points: &[[f64; 2]], rotation_rad: f64, out: &mut [f64]) {
        assert_eq!(points.len(), out.len(), "one number per point");
        for ([phi, zeta], out) in points.iter().zip(out) {
            *out = self.at(phi - rotation_rad, *zeta)[1];
        }
    }

    /// Adds to `bar` (one number per coefficient) what the derivatives by the gap and by its slope around mean for the
    /// coefficients; the transpose of [`Self::push_forward`].
    pub fn pull_back(
        &self,
        points: &[[f64; 2]],
        rotation_rad: f64,
        gap_bar: &[f64],
        around_bar: Option<&[f64]>,
        bar: &mut [f64],
    ) {
        for (at, [phi, zeta]) in points.iter().enumerate() {
            let weights = [gap_bar[at], around_bar.map_or(0.0, |a| a[at])];
            if weights != [0.0; 2] {
                self.visit(phi - rotation_rad, *zeta, &mut |j, d| {
                    bar[j] += d[0] * weights[0] + d[1] * weights[1];
                });
            }
        }
    }

    /// Adds to `gap` (m) and `around` (m/rad) their changes for a change of the coefficients.
    pub fn push_forward(
        &self,
        points: &[[f64; 2]],
        rotation_rad: f64,
        change: &[f64],
        gap: &mut [f64],
        mut around: Option<&mut [f64]>,
    ) {
        for (at, [phi, zeta]) in points.iter().enumerate() {
            let mut sum = [0.0; 2];
            self.visit(phi - rotation_rad, *zeta, &mut |j, d| {
                sum[0] += d[0] * change[j];
                sum[1] += d[1] * change[j];
            });
            gap[at] += sum[0];
            if let Some(around) = &mut around {
                around[at] += sum[1];
            }
        }
    }

    /// Gap (m) and slope around (m/rad) at a point.
    pub(super) fn at(&self, phi: f64, zeta: f64) -> [f64; 2] {
        match self {
            Self::LemonBore { offset_m, angle_rad } => {
                let [f, f1, _] = bore::lemon(phi - angle_rad);
                [offset_m * f, offset_m * f1]
            }
            Self::OffsetBore { offset_m, angle_rad } => {
                let [f, f1, _] = bore::offset(phi - angle_rad);
                [offset_m * f, offset_m * f1]
            }
            Self::Barrel { height_m } => [height_m * zeta * zeta, 0.0],
            Self::Cone { height_m } => [height_m * 0.5 * (1.0 + zeta), 0.0],
            Self::EdgeRelief { depth_m, length_share } => {
                let share = relief(zeta, *length_share);
                [depth_m * share * share, 0.0]
            }
            Self::Spline(spline) => spline.at(phi, zeta),
            Self::Table(table) => table.unit(phi, zeta).map(|v| v * table.scale()),
        }
    }

    /// Calls `each` with a coefficient's index and the derivatives of [`Self::at`] by it.
    pub(super) fn visit(&self, phi: f64, zeta: f64, each: &mut impl FnMut(usize, [f64; 2])) {
        let arcs = |offset: f64, [f, f1, f2]: [f64; 3]| [[f, f1], [-offset * f1, -offset * f2]];
        match self {
            Self::LemonBore { offset_m, angle_rad } => {
                let [by_offset, by_angle] = arcs(*offset_m, bore::lemon(phi - angle_rad));
                each(0, by_offset);
                each(1, by_angle);
            }
            Self::OffsetBore { offset_m, angle_rad } => {
                let [by_offset, by_angle] = arcs(*offset_m, bore::offset(phi - angle_rad));
                each(0, by_offset);
                each(1, by_angle);
            }
            Self::Barrel { .. } => each(0, [zeta * zeta, 0.0]),
            Self::Cone { .. } => each(0, [0.5 * (1.0 + zeta), 0.0]),
            Self::EdgeRelief { depth_m, length_share: length } => {
                let share = relief(zeta, *length);
                each(0, [share * share, 0.0]);
                each(1, [2.0 * depth_m * share * (1.0 - zeta.abs()) / (length * length), 0.0]);
            }
            Self::Spline(spline) => spline.visit(phi, zeta, each),
            Self::Table(table) => each(0, table.unit(phi, zeta)),
        }
    }
}

/// How far into the relief a point stands: 0 where it starts, 1 at the edge.
fn relief(zeta: f64, length: f64) -> f64 {
    ((zeta.abs() - 1.0 + length) / length).max(0.0)
}

//! The gap as a sum of fields: clearance, rigid motion, tilt and shape,
//!
//! ```text
//! h = C - (e + zeta L/2 tilt).n + shape
//! ```
//!
//! Each field says what it adds to `h` and how derivatives by the gap become derivatives by its own quantities. The
//! derivatives of `h` by eccentricity and tilt are the *modes*: pressure times mode, integrated, is the load against it.
//!
//! Deliberately not here: elastic deformation and wear, which will be further summands of the shape.

use super::{FilmInput, FilmSite, Mesh};

/// The gap; see the module page.
#[derive(Debug, Clone, Copy)]
pub struct Gap;

impl Gap {
    /// Writes `h` of every cell.
    pub fn fill(mesh: &Mesh, site: &FilmSite, h: &mut [f64]) {
        let u = &site.input;
        for (i, column) in h.chunks_exact_mut(mesh.n_z).enumerate() {
            let modes = Modes::at(mesh, u, i);
            for (j, h) in column.iter_mut().enumerate() {
                *h = u.clearance_m + modes.change(mesh.zetas[j], &motion(u));
            }
        }
        h.iter_mut().zip(site.shape_m).for_each(|(h, s)| *h += s);
    }

    /// Writes the change of `h` for a change of input and shape.
    pub(super) fn tangent(mesh: &Mesh, u: &FilmInput, du: &FilmInput, d_shape: &[f64], dh: &mut [f64]) {
        let (tilt, stretch) = (u.tilt_rad, du.width_m / u.width_m);
        for (i, column) in dh.chunks_exact_mut(mesh.n_z).enumerate() {
            let modes = Modes::at(mesh, u, i);
            let mut change = motion(du);
            change[2] += stretch * tilt[0];
            change[3] += stretch * tilt[1];
            for (j, h) in column.iter_mut().enumerate() {
                *h = du.clearance_m + modes.change(mesh.zetas[j], &change);
            }
        }
        dh.iter_mut().zip(d_shape).for_each(|(h, s)| *h += s);
    }

    /// Adds to `u_bar` what derivatives by the gap mean for motion, tilt, clearance and width.
    pub(super) fn pull_back(mesh: &Mesh, u: &FilmInput, h_bar: &[f64], u_bar: &mut FilmInput) {
        for (i, column) in h_bar.chunks_exact(mesh.n_z).enumerate() {
            let modes = Modes::at(mesh, u, i);
            for (bar, zeta) in column.iter().zip(&mesh.zetas) {
                let m = modes.of(*zeta);
                u_bar.clearance_m += bar;
                for a in 0..2 {
                    u_bar.eccentricity_m[a] += bar * m[a];
                    u_bar.tilt_rad[a] += bar * m[2 + a];
                    u_bar.width_m += bar * m[2 + a] * u.tilt_rad[a] / u.width_m;
                }
            }
        }
    }

    /// Smallest gap of the aligned cylindrical bearing, `C - |e|`, exact between the cells too.
    pub fn minimum_m(u: &FilmInput) -> f64 {
        u.clearance_m - u.eccentricity_m[0].hypot(u.eccentricity_m[1])
    }

    /// Largest gap, `C + |e|`.
    pub fn maximum_m(u: &FilmInput) -> f64 {
        u.clearance_m + u.eccentricity_m[0].hypot(u.eccentricity_m[1])
    }

    /// Derivative of [`Self::minimum_m`] by the eccentricity (zero for the centred journal, where it has a kink).
    pub fn minimum_slope(u: &FilmInput) -> [f64; 2] {
        let e = u.eccentricity_m[0].hypot(u.eccentricity_m[1]);
        if e > 0.0 { [-u.eccentricity_m[0] / e, -u.eccentricity_m[1] / e] } else { [0.0; 2] }
    }

    /// Largest share of the change `de`, at most 1, that keeps at least `keep` of the smallest gap at `e`.
    pub fn admissible(clearance_m: f64, e: [f64; 2], de: [f64; 2], keep: f64) -> f64 {
        let now = clearance_m - e[0].hypot(e[1]);
        let reach = clearance_m - keep * now.max(0.0);
        // |e + s de| = reach: a s^2 + 2 b s + c = 0 with c <= 0 has one root s >= 0.
        let a = de[0] * de[0] + de[1] * de[1];
        let b = e[0] * de[0] + e[1] * de[1];
        let c = e[0] * e[0] + e[1] * e[1] - reach * reach;
        if a == 0.0 || now <= 0.0 {
            return 1.0;
        }
        let root = (b * b - a * c).max(0.0).sqrt();
        let s = if b > 0.0 { -c / (b + root) } else { (root - b) / a };
        s.min(1.0)
    }

    /// The same cell by cell, for tilted and shaped bearings whose gaps may reach down to `-depth` (rough contact).
    pub(super) fn admissible_cells(
        mesh: &Mesh,
        u: &FilmInput,
        h: &[f64],
        depth_m: f64,
        motion: &[f64; 4],
        keep: f64,
    ) -> f64 {
        let mut share = 1.0f64;
        for (i, column) in h.chunks_exact(mesh.n_z).enumerate() {
            let modes = Modes::at(mesh, u, i);
            for (h, zeta) in column.iter().zip(&mesh.zetas) {
                let dh = modes.change(*zeta, motion);
                let room = h + depth_m;
                if dh < 0.0 && room > 0.0 {
                    share = share.min((1.0 - keep) * room / -dh);
                }
            }
        }
        share
    }
}

/// Eccentricity and tilt as one vector.
pub(super) fn motion(u: &FilmInput) -> [f64; 4] {
    [u.eccentricity_m[0], u.eccentricity_m[1], u.tilt_rad[0], u.tilt_rad[1]]
}

/// `dh / d(e, tilt)` along one column of cells.
pub(super) struct Modes {
    normal: [f64; 2],
    half_width: f64,
}

impl Modes {
    pub fn at(mesh: &Mesh, u: &FilmInput, column: usize) -> Self {
        Self { normal: mesh.normals[column], half_width: u.width_m / 2.0 }
    }

    /// The four modes at an axial place.
    pub fn of(&self, zeta: f64) -> [f64; 4] {
        let arm = zeta * self.half_width;
        let [x, y] = self.normal;
        [-x, -y, -arm * x, -arm * y]
    }

    /// Change of the gap for a motion.
    pub fn change(&self, zeta: f64, motion: &[f64; 4]) -> f64 {
        let arm = zeta * self.half_width;
        -(motion[0] + arm * motion[2]) * self.normal[0] - (motion[1] + arm * motion[3]) * self.normal[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_admissible_step_keeps_its_share_of_the_gap(
            r in 0.0f64..0.999, a in 0.0f64..6.3, dx in -5.0f64..5.0, dy in -5.0f64..5.0,
        ) {
            let e = [r * a.cos(), r * a.sin()];
            let s = Gap::admissible(1.0, e, [dx, dy], 0.2);
            let after = 1.0 - (e[0] + s * dx).hypot(e[1] + s * dy);
            prop_assert!((0.0..=1.0).contains(&s));
            prop_assert!(after >= 0.2 * (1.0 - r) - 1e-12);
            prop_assert!(s == 1.0 || (after - 0.2 * (1.0 - r)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_smallest_gap_lies_where_the_journal_approaches_the_shell() {
        let mesh = Mesh::new(36, 1, super::super::Axial::Half);
        let u = FilmInput { clearance_m: 1.0, eccentricity_m: [0.0, 0.6], ..Default::default() };
        let mut h = vec![0.0; mesh.cells()];
        Gap::fill(&mesh, &u.into(), &mut h);
        let (at, h) = h.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert_eq!(at, 9);
        assert!((h - Gap::minimum_m(&u)).abs() < 1e-15 && (h - 0.4).abs() < 1e-15);
    }

    #[test]
    fn a_tilted_journal_is_nearer_at_one_edge() {
        let mesh = Mesh::new(8, 4, super::super::Axial::Full);
        let u = FilmInput { clearance_m: 1.0, tilt_rad: [0.1, 0.0], width_m: 2.0, ..Default::default() };
        let mut h = vec![0.0; mesh.cells()];
        Gap::fill(&mesh, &u.into(), &mut h);
        for (h, wanted) in h[..4].iter().zip([1.075, 1.025, 0.975, 0.925]) {
            assert!((h - wanted).abs() < 1e-15);
        }
    }
}

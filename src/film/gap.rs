//! The gap as a sum of fields. Each field says what it adds to `h` and `h'` and how derivatives by the gap become
//! derivatives by the field's own quantities; today the rigid, aligned, cylindrical gap `h = C - e.n` is the only one.
//!
//! Deliberately not here: profiles, tilt, elastic deformation and wear, which are further summands.

use super::{FilmInput, Mesh};

/// Gap and squeeze rate in every cell.
#[derive(Debug, Clone)]
pub struct Gap {
    /// `h`, m.
    pub h: Vec<f64>,
    /// `dh/dt`, m/s.
    pub rate: Vec<f64>,
}

impl Gap {
    /// The gap for a journal motion; called with a change `du` it yields the change of the gap, since the gap is linear.
    pub fn of(mesh: &Mesh, u: &FilmInput) -> Self {
        let ([ex, ey], [vx, vy]) = (u.eccentricity_m, u.velocity_m_s);
        let mut gap = Self { h: Vec::with_capacity(mesh.cells()), rate: Vec::with_capacity(mesh.cells()) };
        for n in &mesh.normals {
            let (h, rate) = (u.clearance_m - ex * n[0] - ey * n[1], -vx * n[0] - vy * n[1]);
            gap.h.resize(gap.h.len() + mesh.n_z, h);
            gap.rate.resize(gap.rate.len() + mesh.n_z, rate);
        }
        gap
    }

    /// No gap: a place to add derivatives up.
    pub fn zeros(mesh: &Mesh) -> Self {
        Self { h: vec![0.0; mesh.cells()], rate: vec![0.0; mesh.cells()] }
    }

    /// Adds to `u_bar` what the derivatives by the gap (held in `self`) mean for the journal's motion and the clearance.
    pub fn pull_back(&self, mesh: &Mesh, u_bar: &mut FilmInput) {
        for (i, n) in mesh.normals.iter().enumerate() {
            let column = i * mesh.n_z..(i + 1) * mesh.n_z;
            let by_h: f64 = self.h[column.clone()].iter().sum();
            let by_rate: f64 = self.rate[column].iter().sum();
            u_bar.clearance_m += by_h;
            for (a, n) in n.iter().enumerate() {
                u_bar.eccentricity_m[a] -= by_h * n;
                u_bar.velocity_m_s[a] -= by_rate * n;
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
        let gap = Gap::of(&mesh, &u);
        let (at, h) = gap.h.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert_eq!(at, 9);
        assert!((h - Gap::minimum_m(&u)).abs() < 1e-15 && (h - 0.4).abs() < 1e-15);
    }
}

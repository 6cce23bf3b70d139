//! Kinematics of the slider-crank mechanism, piston pin offset included, in closed form.
//!
//! Frame of the cylinder: `x` from the crank's centre along the cylinder axis, `y` a quarter turn further in the sense of
//! rotation. With crank radius `r`, rod length `l`, offset `d` and the crank at `theta` from the `x` axis:
//!
//! ```text
//! sin psi = (d - r sin theta) / l       direction of the rod from big end to small end
//! s       = r cos theta + l cos psi     height of the piston pin
//! ```
//!
//! The *crank angle* of every public function counts from top dead centre of the piston, where `theta = asin(d / (l + r))`.

/// Geometry of one slider-crank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliderCrank {
    /// Crank radius (half the stroke without offset), m.
    pub throw_m: f64,
    /// Length of the connecting rod, m.
    pub rod_m: f64,
    /// Distance of the cylinder axis from the crank's centre along `y`, m.
    pub offset_m: f64,
}

/// Position and derivatives by the crank angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Angle of the crank from the cylinder axis, rad.
    pub crank_rad: f64,
    /// Height of the piston pin, m, and its first and second derivative by crank angle.
    pub piston_m: [f64; 3],
    /// Direction of the rod from the cylinder axis, rad, and its first and second derivative by crank angle.
    pub rod_rad: [f64; 3],
}

impl SliderCrank {
    /// Whether the mechanism can turn: `r + |d| < l`.
    pub fn turns(&self) -> bool {
        self.throw_m > 0.0 && self.throw_m + self.offset_m.abs() < self.rod_m
    }

    /// Angle of the crank from the cylinder axis at top dead centre.
    pub fn top_dead_centre_rad(&self) -> f64 {
        (self.offset_m / (self.rod_m + self.throw_m)).asin()
    }

    /// Distance between the dead centres.
    pub fn stroke_m(&self) -> f64 {
        let height = |reach: f64| (reach * reach - self.offset_m * self.offset_m).sqrt();
        height(self.rod_m + self.throw_m) - height(self.rod_m - self.throw_m)
    }

    /// Kinematics at a crank angle after top dead centre.
    pub fn at(&self, crank_angle_rad: f64) -> Kinematics {
        let crank_rad = crank_angle_rad + self.top_dead_centre_rad();
        let (sin, cos) = crank_rad.sin_cos();
        let (r, l) = (self.throw_m, self.rod_m);
        let sin_psi = (self.offset_m - r * sin) / l;
        let psi = sin_psi.asin();
        let cos_psi = psi.cos();
        let d1 = -r * cos / (l * cos_psi);
        let d2 = (r * sin / l + sin_psi * d1 * d1) / cos_psi;
        Kinematics {
            crank_rad,
            piston_m: [
                r * cos + l * cos_psi,
                -r * sin - l * sin_psi * d1,
                -r * cos - l * (cos_psi * d1 * d1 + sin_psi * d2),
            ],
            rod_rad: [psi, d1, d2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    const CENTRED: SliderCrank = SliderCrank { throw_m: 0.1075, rod_m: 0.1075 / 0.274, offset_m: 0.0 };
    const OFFSET: SliderCrank = SliderCrank { offset_m: 0.012, ..CENTRED };

    #[test]
    fn closed_forms_of_the_centred_mechanism() {
        let (r, lambda) = (CENTRED.throw_m, 0.274);
        for k in 0..720 {
            let a = k as f64 * PI / 360.0;
            let at = CENTRED.at(a);
            let root = (1.0 - (lambda * a.sin()).powi(2)).sqrt();
            let position = r * (a.cos() + root / lambda);
            let velocity = -r * (a.sin() + lambda * (2.0 * a).sin() / (2.0 * root));
            let acceleration =
                -r * (a.cos() + (lambda * (2.0 * a).cos() + lambda.powi(3) * a.sin().powi(4)) / root.powi(3));
            for (found, exact) in at.piston_m.iter().zip([position, velocity, acceleration]) {
                assert!((found - exact).abs() < 1e-12 * r, "{found} {exact} at {k}");
            }
            assert!((at.rod_rad[0] + (lambda * a.sin()).asin()).abs() < 1e-12);
            assert!((at.rod_rad[1] + lambda * a.cos() / root).abs() < 1e-12);
        }
    }

    #[test]
    fn the_rod_keeps_its_length_and_derivatives_are_consistent() {
        for k in 0..97 {
            let a = k as f64 * TAU / 97.0;
            let at = OFFSET.at(a);
            let pin = [OFFSET.throw_m * at.crank_rad.cos(), OFFSET.throw_m * at.crank_rad.sin()];
            let length = (at.piston_m[0] - pin[0]).hypot(OFFSET.offset_m - pin[1]);
            assert!((length - OFFSET.rod_m).abs() < 1e-15);
            let e = 1e-5;
            let (next, last) = (OFFSET.at(a + e), OFFSET.at(a - e));
            for d in 0..2 {
                let by_piston = (next.piston_m[d] - last.piston_m[d]) / (2.0 * e);
                let by_rod = (next.rod_rad[d] - last.rod_rad[d]) / (2.0 * e);
                assert!((by_piston - at.piston_m[d + 1]).abs() < 1e-9);
                assert!((by_rod - at.rod_rad[d + 1]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn dead_centres_bound_the_stroke() {
        for crank in [CENTRED, OFFSET] {
            assert!(crank.turns());
            assert!(crank.at(0.0).piston_m[1].abs() < 1e-15);
            let heights: Vec<f64> =
                (0..7200).map(|k| crank.at(k as f64 * TAU / 7200.0).piston_m[0]).collect();
            let top = heights.iter().copied().fold(f64::MIN, f64::max);
            let low = heights.iter().copied().fold(f64::MAX, f64::min);
            assert!((top - heights[0]).abs() < 1e-15);
            assert!((top - low - crank.stroke_m()).abs() < 1e-7);
        }
        assert!((CENTRED.stroke_m() - 0.215).abs() < 1e-15);
    }
}

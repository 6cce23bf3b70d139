//! The short-bearing film in closed form (Ocvirk 1952), the physics of Booker's mobility method (1965).
//!
//! Axial flow alone carries the oil away. With the velocity `V = v + omega/2 (e_y, -e_x)` seen by the rotating film,
//!
//! ```text
//! p(phi, z) = 6 eta (V.n) / h^3 (L^2/4 - z^2)   where V.n > 0, else 0            (half film)
//! force     = -eta L^3 R  Int_{V.n > 0} (V.n) n / h^3 dphi
//! ```
//!
//! Booker inverts this impedance to the mobility, velocity for a given load; here the journal's motion is solved
//! implicitly, so the impedance itself is used and no curve fit is needed. In Sommerfeld's variable `gamma`,
//! `1 - eps cos phi = (1 - eps^2) / (1 + eps cos gamma)`, all integrands are trigonometric polynomials of degree four
//! at most, which a Gauss rule of [`NODES`] points integrates to rounding.
//!
//! Valid for `L/D` up to about 1/2 at moderate eccentricity; an instant first answer elsewhere.

use super::{
    FilmChange, FilmCotangent, FilmInput, FilmLinear, FilmModel, FilmOutput, FilmPlace, FilmPoint, FilmSite,
    FilmTangent, FilmWeights, Gap, INPUTS, Mesh, Wanted,
};
use crate::math::PowerMean;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Points of the Gauss rule.
const NODES: usize = 32;
/// Angles at which the pressure of the mid-plane is looked at.
const ANGLES: usize = 360;

/// Short-bearing film.
#[derive(Debug, Clone)]
pub struct ShortFilm {
    /// Sharpness of the smooth maximum of the film pressure.
    pub sharpness: f64,
    /// Nodes on [-1, 1] and weights.
    rule: Vec<(f64, f64)>,
    normals: Vec<[f64; 2]>,
}

/// Integrals over the loaded half of the film.
#[derive(Default)]
struct Integrals {
    /// `Int n n^T / h^3`.
    i: [[f64; 2]; 2],
    /// `Int (V.n) n / h^4`.
    s: [f64; 2],
    /// `Int (V.n) n n^T / h^4`.
    t: [[f64; 2]; 2],
}

/// Force of the film with what its derivatives need.
struct Impedance {
    v: [f64; 2],
    sums: Integrals,
    scale: f64,
    force: [f64; 2],
}

impl Impedance {
    fn at(film: &ShortFilm, u: &FilmInput) -> Self {
        let v = film_velocity(u);
        let sums = film.integrals(u, v);
        let scale = -u.viscosity_pa_s * u.width_m.powi(3) * u.diameter_m / 2.0;
        Self { v, force: times(&sums.i, v).map(|x| scale * x), sums, scale }
    }

    /// The limits of the integrals move too, but there `V.n = 0`.
    fn force_change(&self, u: &FilmInput, du: &FilmInput) -> [f64; 2] {
        let relative = du.viscosity_pa_s / u.viscosity_pa_s
            + 3.0 * du.width_m / u.width_m
            + du.diameter_m / u.diameter_m;
        let by_velocity = times(&self.sums.i, film_velocity_change(u, du));
        let by_position = times(&self.sums.t, du.eccentricity_m);
        std::array::from_fn(|a| {
            let by_gap = 3.0 * (by_position[a] - self.sums.s[a] * du.clearance_m);
            relative * self.force[a] + self.scale * (by_velocity[a] + by_gap)
        })
    }
}

fn times(m: &[[f64; 2]; 2], x: [f64; 2]) -> [f64; 2] {
    [m[0][0] * x[0] + m[0][1] * x[1], m[1][0] * x[0] + m[1][1] * x[1]]
}

impl ShortFilm {
    /// A short film; `sharpness` as in [`super::Reynolds`].
    pub fn new(sharpness: f64) -> Self {
        let direction = |i: usize| {
            let (s, c) = (TAU * i as f64 / ANGLES as f64).sin_cos();
            [c, s]
        };
        Self { sharpness, rule: gauss_legendre(NODES), normals: (0..ANGLES).map(direction).collect() }
    }

    fn integrals(&self, u: &FilmInput, v: [f64; 2]) -> Integrals {
        let [ex, ey] = u.eccentricity_m;
        let eps = ex.hypot(ey) / u.clearance_m;
        let along = ey.atan2(ex);
        let (sin, cos) = along.sin_cos();
        let root = (1.0 - eps * eps).sqrt();
        let stretch = ((1.0 + eps) / (1.0 - eps)).sqrt();
        let gamma = |phi: f64| 2.0 * (stretch * (phi / 2.0).sin()).atan2((phi / 2.0).cos());
        let delta = (v[1].atan2(v[0]) - along + PI).rem_euclid(TAU) - PI;
        let (low, high) = (gamma(delta - FRAC_PI_2), gamma(delta + FRAC_PI_2));
        let mut sum = Integrals::default();
        for &(x, weight) in &self.rule {
            let (sg, cg) = (low + (high - low) * (x + 1.0) / 2.0).sin_cos();
            let den = 1.0 + eps * cg;
            let (c, s) = ((eps + cg) / den, root * sg / den);
            let n = [cos * c - sin * s, sin * c + cos * s];
            let h = u.clearance_m * root * root / den;
            let w = weight * (high - low) / 2.0 * root / den / (h * h * h);
            let flow = (v[0] * n[0] + v[1] * n[1]) / h;
            for a in 0..2 {
                sum.s[a] += w * flow * n[a];
                for b in 0..2 {
                    sum.i[a][b] += w * n[a] * n[b];
                    sum.t[a][b] += w * flow * n[a] * n[b];
                }
            }
        }
        sum
    }
}

/// The film at one input: what outputs and their derivatives share.
struct State<'a> {
    film: &'a ShortFilm,
    u: &'a FilmInput,
    impedance: Impedance,
    /// Couette part of the loss.
    couette_w: f64,
    /// `e x force`.
    arm: f64,
    /// Size of the film velocity.
    speed: f64,
    peak: PowerMean,
}

impl<'a> State<'a> {
    fn at(film: &'a ShortFilm, u: &'a FilmInput) -> Self {
        let impedance = Impedance::at(film, u);
        let ([ex, ey], force, v) = (u.eccentricity_m, impedance.force, impedance.v);
        let radius = u.diameter_m / 2.0;
        let couette_w = u.viscosity_pa_s * (u.speed_rad_s * radius).powi(2) * radius * u.width_m * TAU
            / (u.clearance_m * (1.0 - ratio_squared(u)).sqrt());
        let pressures = film.normals.iter().map(|n| mid_plane(u, v, n));
        let peak = PowerMean::maximum(film.sharpness).of(pressures);
        Self {
            film,
            u,
            couette_w,
            arm: ex * force[1] - ey * force[0],
            speed: v[0].hypot(v[1]),
            impedance,
            peak,
        }
    }

    fn output(&self) -> FilmOutput {
        let (u, force) = (self.u, self.impedance.force);
        let loss_w = self.couette_w + u.speed_rad_s / 2.0 * self.arm;
        FilmOutput {
            force_n: force,
            loss_w,
            dissipation_w: loss_w - force[0] * u.velocity_m_s[0] - force[1] * u.velocity_m_s[1],
            gap_min_m: Gap::minimum_m(u),
            pressure_peak_pa: self.peak.value(),
            side_flow_m3_s: u.width_m * u.diameter_m * self.speed,
            ..Default::default()
        }
    }

    /// Change of the outputs for a change of the input.
    fn change(&self, du: &FilmInput) -> FilmOutput {
        let (u, force, v) = (self.u, self.impedance.force, self.impedance.v);
        let ([ex, ey], de, dc) = (u.eccentricity_m, du.eccentricity_m, du.clearance_m);
        let dv = film_velocity_change(u, du);
        let df = self.impedance.force_change(u, du);
        let e2 = ratio_squared(u);
        let d_ln_root =
            -((ex * de[0] + ey * de[1]) / u.clearance_m.powi(2) - e2 * dc / u.clearance_m) / (1.0 - e2);
        let mut relative = du.viscosity_pa_s / u.viscosity_pa_s
            + 3.0 * du.diameter_m / u.diameter_m
            + du.width_m / u.width_m
            - dc / u.clearance_m
            - d_ln_root;
        if u.speed_rad_s != 0.0 {
            relative += 2.0 * du.speed_rad_s / u.speed_rad_s;
        }
        let d_arm = de[0] * force[1] + ex * df[1] - de[1] * force[0] - ey * df[0];
        let loss_w = self.couette_w * relative + (du.speed_rad_s * self.arm + u.speed_rad_s * d_arm) / 2.0;
        let squeeze_w: f64 = (0..2).map(|a| df[a] * u.velocity_m_s[a] + force[a] * du.velocity_m_s[a]).sum();
        let d_speed = if self.speed > 0.0 { (v[0] * dv[0] + v[1] * dv[1]) / self.speed } else { 0.0 };
        let slope = Gap::minimum_slope(u);
        FilmOutput {
            force_n: df,
            loss_w,
            dissipation_w: loss_w - squeeze_w,
            gap_min_m: dc + slope[0] * de[0] + slope[1] * de[1],
            pressure_peak_pa: self.peak_change(du, dv),
            side_flow_m3_s: u.width_m * u.diameter_m * d_speed
                + (du.width_m * u.diameter_m + u.width_m * du.diameter_m) * self.speed,
            ..Default::default()
        }
    }

    fn peak_change(&self, du: &FilmInput, dv: [f64; 2]) -> f64 {
        let (u, v) = (self.u, self.impedance.v);
        let share = |n: &[f64; 2]| {
            let p = mid_plane(u, v, n);
            if self.peak.is_lost(p) {
                0.0
            } else {
                self.peak.derivative(p) * mid_plane_change(u, v, du, dv, n)
            }
        };
        self.film.normals.iter().map(share).sum()
    }
}

/// Square of the eccentricity ratio.
fn ratio_squared(u: &FilmInput) -> f64 {
    let [ex, ey] = u.eccentricity_m;
    (ex * ex + ey * ey) / (u.clearance_m * u.clearance_m)
}

/// `V = v + omega/2 (e_y, -e_x)`.
fn film_velocity(u: &FilmInput) -> [f64; 2] {
    let ([ex, ey], half) = (u.eccentricity_m, u.speed_rad_s / 2.0);
    [u.velocity_m_s[0] + half * ey, u.velocity_m_s[1] - half * ex]
}

/// Change of the film velocity for a change `du` at `u`.
fn film_velocity_change(u: &FilmInput, du: &FilmInput) -> [f64; 2] {
    let moved = film_velocity(&FilmInput { speed_rad_s: u.speed_rad_s, ..*du });
    let ([ex, ey], half) = (u.eccentricity_m, du.speed_rad_s / 2.0);
    [moved[0] + half * ey, moved[1] - half * ex]
}

/// Pressure of the mid-plane in the direction `n`.
fn mid_plane(u: &FilmInput, v: [f64; 2], n: &[f64; 2]) -> f64 {
    let h = u.clearance_m - u.eccentricity_m[0] * n[0] - u.eccentricity_m[1] * n[1];
    1.5 * u.viscosity_pa_s * u.width_m.powi(2) * (v[0] * n[0] + v[1] * n[1]).max(0.0) / h.powi(3)
}

fn mid_plane_change(u: &FilmInput, v: [f64; 2], du: &FilmInput, dv: [f64; 2], n: &[f64; 2]) -> f64 {
    let h = u.clearance_m - u.eccentricity_m[0] * n[0] - u.eccentricity_m[1] * n[1];
    let dh = du.clearance_m - du.eccentricity_m[0] * n[0] - du.eccentricity_m[1] * n[1];
    let (flow, d_flow) = (v[0] * n[0] + v[1] * n[1], dv[0] * n[0] + dv[1] * n[1]);
    if flow <= 0.0 {
        return 0.0;
    }
    mid_plane(u, v, n)
        * (du.viscosity_pa_s / u.viscosity_pa_s + 2.0 * du.width_m / u.width_m + d_flow / flow - 3.0 * dh / h)
}

fn unit_input(k: usize) -> FilmInput {
    let mut a = [0.0; INPUTS];
    a[k] = 1.0;
    FilmInput::from_array(a)
}

/// Gauss-Legendre nodes and weights on [-1, 1] by Newton's method on the Legendre polynomial.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let polynomial = |x: f64| {
        let (mut p, mut before) = (1.0, 0.0);
        for k in 1..=n {
            let k = k as f64;
            (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
        }
        (p, n as f64 * (x * p - before) / (x * x - 1.0))
    };
    (1..=n)
        .map(|i| {
            let mut x = (PI * (i as f64 - 0.25) / (n as f64 + 0.5)).cos();
            for _ in 0..50 {
                let (p, slope) = polynomial(x);
                x -= p / slope;
            }
            let slope = polynomial(x).1;
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

impl FilmModel for ShortFilm {
    fn mesh(&self) -> Option<&Mesh> {
        None
    }

    fn content(&self, _: &FilmSite, _: &[f64], _: &mut [f64]) {}

    fn residual(&self, _: &FilmSite, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn linearise(&self, site: &FilmSite, _: &[f64], alpha: f64, _: &[f64], into: &mut FilmLinear) {
        let impedance = Impedance::at(self, &site.input);
        into.loads = [impedance.force[0], impedance.force[1], 0.0, 0.0];
        for (b, unit) in [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            let du = FilmInput {
                eccentricity_m: unit,
                velocity_m_s: unit.map(|v| alpha * v),
                ..Default::default()
            };
            let df = impedance.force_change(&site.input, &du);
            (0..2).for_each(|a| into.corner[a][b] = df[a]);
            let squeeze = FilmInput { velocity_m_s: unit, ..Default::default() };
            let df = impedance.force_change(&site.input, &squeeze);
            (0..2).for_each(|a| into.carry.damping[a][b] = df[a]);
        }
    }

    fn output(&self, site: &FilmSite, _: &[f64]) -> FilmOutput {
        State::at(self, &site.input).output()
    }

    fn fix(&self, _: &FilmSite, _: &[f64], _: bool, _: &mut FilmPoint) {}

    fn tangent_at(&self, place: &FilmPlace, change: &FilmChange, _: Wanted) -> FilmTangent {
        FilmTangent { output: State::at(self, &place.site.input).change(&change.input), ..Default::default() }
    }

    fn cotangent_at(&self, place: &FilmPlace, weights: &FilmWeights) -> FilmCotangent {
        if weights.output == FilmOutput::default() {
            return FilmCotangent::default();
        }
        let (state, w) = (State::at(self, &place.site.input), weights.output.to_array());
        let by = |k: usize| {
            let change = state.change(&unit_input(k)).to_array();
            change.iter().zip(w).map(|(j, w)| j * w).sum()
        };
        FilmCotangent { input: FilmInput::from_array(std::array::from_fn(by)), ..Default::default() }
    }

    fn admissible(&self, site: &FilmSite, motion: [f64; 4], keep: f64) -> f64 {
        let (u, [x, y, ..]) = (&site.input, motion);
        Gap::admissible(u.clearance_m, u.eccentricity_m, [x, y], keep)
    }

    fn contains(&self, site: &FilmSite) -> bool {
        Gap::minimum_m(&site.input) > 0.0
    }

    fn change(&self, _: &[f64], _: &[f64]) -> f64 {
        0.0
    }

    fn pressure_max_pa(&self, site: &FilmSite, _: &[f64]) -> f64 {
        let v = film_velocity(&site.input);
        self.normals.iter().map(|n| mid_plane(&site.input, v, n)).fold(0.0, f64::max)
    }

    fn contact_max_pa(&self, _: &FilmSite, _: &[f64]) -> f64 {
        0.0
    }

    fn contact_pa(&self, _: &FilmSite, _: &mut [f64]) {}

    fn conserves_mass(&self) -> bool {
        false
    }

    fn least_fill(&self, _: &[f64]) -> f64 {
        1.0
    }

    fn weakly_active(&self, _: &[f64]) -> usize {
        0
    }

    fn pressure_map_pa(&self, site: &FilmSite, _: &[f64]) -> Vec<Vec<f64>> {
        const ACROSS: usize = 16;
        let (u, v) = (&site.input, film_velocity(&site.input));
        let share = |j: usize| 2.0 * (j as f64 + 0.5) / ACROSS as f64 - 1.0;
        self.normals
            .iter()
            .map(|n| (0..ACROSS).map(|j| mid_plane(u, v, n) * (1.0 - share(j).powi(2))).collect())
            .collect()
    }

    fn fill_map(&self, _: &FilmSite, _: &[f64]) -> Vec<Vec<f64>> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_rule_integrates_polynomials() {
        let integral: f64 = gauss_legendre(NODES).iter().map(|(x, w)| w * x.powi(62)).sum();
        assert!((integral - 2.0 / 63.0).abs() < 1e-14);
    }
}

//! Published tables and closed forms. Every test states its boundary conditions; tolerances are those of the source.

mod balances;
mod butenschoen;
mod cavitation;
mod charts;
mod closed_forms;
mod plates;
mod sliders;
mod starved;
mod stiffness;
mod stribeck_curve;

use stribeck::film::{
    Axial, Cavitation, FilmInput, FilmSite, Mesh, Reynolds, SteadyState, steady, steady_at,
};

/// Columns and cells across half the width on which the tables are met.
const MESH: (usize, usize) = (360, 24);

/// Swift-Stieber, no pressure along the widest gap (`phi = pi`) and at both edges, the whole gap sheared.
fn line_of_no_pressure(n_phi: usize, n_z: usize) -> Reynolds {
    Reynolds { held_columns: vec![(n_phi / 2, 0.0)], ..Reynolds::new(Mesh::new(n_phi, n_z, Axial::Half)) }
}

/// A steady film, started from the same film on half as many columns and so on: the edge of a Swift-Stieber cavity moves by
/// a column an iteration, so a cold start on many columns takes as many iterations.
fn nested(film: &Reynolds, u: &FilmInput) -> SteadyState {
    let (n, b) = (film.mesh.n_phi, film.mesh.n_z);
    if n % 2 == 1 || n <= 90 {
        return steady(film, u).unwrap();
    }
    let mut coarse = film.clone();
    coarse.mesh = Mesh::new(n / 2, b, film.mesh.axial);
    coarse.held_columns.iter_mut().for_each(|(i, _)| *i /= 2);
    let below = nested(&coarse, u).q;
    let start: Vec<f64> = (0..n * b).map(|k| below[k / b / 2 * b + k % b]).collect();
    steady_at(film, &(*u).into(), Some(&start)).unwrap()
}

fn size(f: [f64; 2]) -> f64 {
    f[0].hypot(f[1])
}

/// Angle between eccentricity (along x) and load (against the film's force), degrees.
fn attitude(state: &SteadyState) -> f64 {
    let [x, y] = state.output.force_n;
    (-y).atan2(-x).to_degrees().abs()
}

/// Relative tolerance of a table value: the accuracy wanted, or half a digit of the last place.
fn allowed(wanted: f64, value: f64, half_digit: f64) -> f64 {
    wanted.max(half_digit / value)
}

/// A plane slider, infinitely wide, as part of a ring: columns `1..=n` are its cells; column 0 is a deep hole held at the
/// pressure of its ends, so the boundaries stand exactly on the outer faces of the first and the last cell.
struct Slider {
    film: Reynolds,
    input: FilmInput,
    shape_m: Vec<f64>,
    dx: f64,
}

impl Slider {
    /// Depth of the hole over the reference gap.
    const DEEP: f64 = 1e3;
    /// Width over length: what leaks over the edges is of the order of the square of its inverse.
    const WIDE: f64 = 1e5;

    /// A slider of a length at a speed, with the gap `h0 + extra(x)` and the pressure `end_pa` at both ends.
    fn new(
        n: usize,
        length: f64,
        (speed, eta, h0): (f64, f64, f64),
        end_pa: f64,
        extra: impl Fn(f64) -> f64,
    ) -> Self {
        let dx = length / n as f64;
        let diameter = dx * (n + 1) as f64 / std::f64::consts::PI;
        let film = Reynolds {
            cavitation: Cavitation::None,
            held_columns: vec![(0, end_pa)],
            ..Reynolds::new(Mesh::new(n + 1, 1, Axial::Half))
        };
        let input = FilmInput::at_rest(0.0, Self::WIDE * length, diameter, h0, eta, 2.0 * speed / diameter);
        let x = |i: usize| (i as f64 - 0.5) * dx;
        let shape_m = (0..=n).map(|i| if i == 0 { Self::DEEP * h0 } else { extra(x(i)) }).collect();
        Self { film, input, shape_m, dx }
    }

    fn site(&self) -> FilmSite<'_> {
        FilmSite {
            input: self.input,
            shape_m: &self.shape_m,
            journal_angle_rad: 0.0,
            marks: &[],
            shell_left: &[],
        }
    }

    /// Gap of a column.
    fn gap(&self, i: usize) -> f64 {
        self.input.clearance_m + self.shape_m[i]
    }

    /// Flux per width from column `i` to the next, both full: `(p_a - p_b) / (12 eta dx) / mean(1/h^3) + U T / 2`.
    fn flux(&self, i: usize, q: &[f64]) -> f64 {
        let speed = self.input.speed_rad_s * self.input.diameter_m / 2.0;
        let (a, b) = (self.gap(i), self.gap(i + 1));
        let (ra, rb) = (a.powi(-3), b.powi(-3));
        let pressure = (q[i] - q[i + 1]) / (12.0 * self.input.viscosity_pa_s * self.dx) * 2.0 / (ra + rb);
        pressure + speed / 2.0 * (a * ra + b * rb) / (ra + rb)
    }
}

//! Raimondi and Boyd 1958: charts of the full journal bearing.
//!
//! Isoviscous, Swift-Stieber, p = 0 along the widest gap and at both edges, the whole gap sheared.

use super::{allowed, attitude, line_of_no_pressure, nested, size};
use crate::common::{bearing, table};
use std::f64::consts::PI;
use stribeck::film::{FilmInput, FilmModel, Gap, Reynolds, SteadyState};

const SPEED: f64 = 100.0;

/// Attitude (degrees), S, friction, flow, side leakage ratio, pressure ratio.
fn numbers(film: &Reynolds, u: &FilmInput) -> [f64; 6] {
    let state = nested(film, u);
    let (force, radius, turns) = (size(state.output.force_n), u.diameter_m / 2.0, SPEED / (2.0 * PI));
    let specific = force / (u.width_m * u.diameter_m);
    let ratio = radius / u.clearance_m;
    let drawn = drawn_in(film, u, &state);
    [
        attitude(&state),
        ratio * ratio * u.viscosity_pa_s * turns / specific,
        ratio * state.output.loss_w / (SPEED * radius * force),
        drawn / (radius * u.clearance_m * turns * u.width_m),
        state.output.side_flow_m3_s / drawn,
        specific / film.pressure_max_pa(&(*u).into(), &state.q),
    ]
}

/// Flow that leaves the line of no pressure into the narrowing gap.
fn drawn_in(film: &Reynolds, u: &FilmInput, state: &SteadyState) -> f64 {
    let (mesh, line) = (&film.mesh, film.mesh.n_phi / 2);
    let mut gap = vec![0.0; mesh.cells()];
    Gap::fill(mesh, &(*u).into(), &mut gap);
    let (dx, dz) = (u.diameter_m / 2.0 * mesh.d_phi(), u.width_m * mesh.cell_share());
    let flow = |k: usize| {
        let (a, b) = (k, k + mesh.n_z);
        let (ra, rb) = (gap[a].powi(-3), gap[b].powi(-3));
        let pressure = (state.q[a] - state.q[b]) / (12.0 * u.viscosity_pa_s * dx) * 2.0 / (ra + rb);
        pressure + SPEED * u.diameter_m / 4.0 * (gap[a] * ra + gap[b] * rb) / (ra + rb)
    };
    (line * mesh.n_z..(line + 1) * mesh.n_z).map(|k| flow(k) * dz).sum::<f64>() * mesh.copies()
}

/// Half of the third digit of a number.
fn half_digit(value: f64) -> f64 {
    0.5 * 10f64.powf(value.log10().floor() - 2.0)
}

#[test]
fn raimondi_boyd() {
    let film = line_of_no_pressure(720, 24);
    for row in table("raimondi_boyd.csv") {
        let (ratio, eps) = (row[0], row[1]);
        let [phi, s, friction, flow, side, p] = numbers(&film, &bearing(eps, ratio, SPEED));
        // What the charts are good for, and half of the last of the three digits printed.
        let wide = if eps < 0.97 { 0.015 } else { 0.03 } + half_digit(row[3]) / row[3];
        let misses = [s / row[3] - 1.0, friction / row[4] - 1.0, flow / row[5] - 1.0, side / row[6] - 1.0];
        println!(
            "L/D {ratio} eps {eps}: attitude {:+.2}, S {:+.4} ({:+.4}), friction {:+.4}, flow {:+.4}, side {:+.4}, p {:+.4} ({:+.4})",
            phi - row[2],
            misses[0],
            s / row[8] - 1.0,
            misses[1],
            misses[2],
            misses[3],
            p - row[7],
            p / row[10] - 1.0
        );
        let at = format!("L/D {ratio} eps {eps}");
        // Against the charts.
        assert!((phi - row[2]).abs() <= 0.6, "attitude {phi} not {} at {at}", row[2]);
        assert!(misses[0].abs() <= wide, "S {s} not {} at {at}", row[3]);
        // Friction over load errs like the load; both flows as far as three digits are worth.
        let friction_wide = wide + half_digit(row[4]) / row[4];
        assert!(misses[1].abs() <= friction_wide, "friction {friction} not {} at {at}", row[4]);
        assert!(misses[2].abs() <= 0.01 && misses[3].abs() <= 0.01, "flow {flow}, side {side} at {at}");
        assert!((p - row[7]).abs() <= 0.012, "P/p_max {p} not {} at {at}", row[7]);
        // Against an independent solution; half a digit of what is printed.
        assert!((s / row[8] - 1.0).abs() <= 0.005, "S {s} not {} at {at}", row[8]);
        assert!((phi / row[9] - 1.0).abs() <= 0.005, "attitude {phi} not {} at {at}", row[9]);
        assert!((p / row[10] - 1.0).abs() <= allowed(0.005, row[10], 0.5e-3), "P/p_max {p} at {at}");
    }
}

//! Published tables and closed forms.

use crate::common::{bearing, table};
use stribeck::film::{
    Axial, Cavitation, FilmInput, FilmModel, Mesh, Reynolds, ShortFilm, SteadyState, steady,
};

/// Columns and cells across half the width on which the tables are met.
const MESH: (usize, usize) = (360, 24);

/// Butenschoen's model: Swift-Stieber, no pressure along the widest gap and at both edges.
fn butenschoen() -> Reynolds {
    let mesh = Mesh::new(MESH.0, MESH.1, Axial::Half);
    Reynolds { held_columns: vec![(MESH.0 / 2, 0.0)], ..Reynolds::new(mesh) }
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

#[test]
fn butenschoen_rotation() {
    let film = butenschoen();
    let so = table("butenschoen_rotation_sommerfeld.csv");
    let beta = table("butenschoen_rotation_attitude_deg.csv");
    let flow = table("butenschoen_rotation_side_flow.csv");
    // Misprints of the transcription, found by three independent solutions: (eps, column, printed, right).
    let misprints = [(0.2, 3, 75.287, 75.377), (0.3, 3, 68.204, 68.289)];
    for (i, row) in so.iter().enumerate().filter(|(_, r)| r[0] <= 0.95) {
        for (k, ratio) in [1.0, 0.5, 0.25].into_iter().enumerate() {
            let u = bearing(row[0], ratio, 100.0);
            let state = steady(&film, &u).unwrap();
            let found = u.sommerfeld(size(state.output.force_n), 100.0);
            let miss = (found / row[k + 1] - 1.0).abs();
            assert!(
                miss <= allowed(0.005, row[k + 1], 0.5e-4),
                "So {found} at eps {} B/D {ratio}: {miss:.4}",
                row[0]
            );
            let printed = beta[i][k + 1];
            let right = misprints
                .iter()
                .find(|m| m.0 == row[0] && m.1 == k + 1 && m.2 == printed)
                .map_or(printed, |m| m.3);
            let angle = attitude(&state);
            assert!(
                (angle - right).abs() <= 0.15,
                "beta {angle} instead of {right} at eps {} B/D {ratio}",
                row[0]
            );
            let scale = (u.diameter_m / 2.0).powi(3) * 2.0 * u.clearance_m / u.diameter_m * 100.0;
            let q = state.output.side_flow_m3_s / scale;
            assert!((q / flow[i][k + 1] - 1.0).abs() <= 0.01, "Q {q} at eps {} B/D {ratio}", row[0]);
        }
    }
}

#[test]
fn butenschoen_friction_follows_from_load_and_attitude() {
    // mu/Psi = pi / (So sqrt(1 - eps^2)) + eps/2 sin(beta), full 2 pi film.
    let film = butenschoen();
    for eps in [0.2, 0.5, 0.8, 0.95] {
        let u = bearing(eps, 0.5, 100.0);
        let state = steady(&film, &u).unwrap();
        let so = u.sommerfeld(size(state.output.force_n), 100.0);
        let psi = 2.0 * u.clearance_m / u.diameter_m;
        let mu = state.output.loss_w / (size(state.output.force_n) * 100.0 * u.diameter_m / 2.0);
        let formula = std::f64::consts::PI / (so * (1.0 - eps * eps).sqrt())
            + eps / 2.0 * attitude(&state).to_radians().sin();
        assert!((mu / psi / formula - 1.0).abs() < 1e-3, "{} {formula}", mu / psi);
    }
}

#[test]
fn butenschoen_squeeze() {
    // The line without pressure lies behind the moving journal, in the ruptured half of the film.
    let film = butenschoen();
    // Misprints: (eps, column, printed, right).
    let misprints = [(0.1, 2, 0.9814, 0.9314), (0.2, 2, 1.2236, 1.2337), (-0.7, 1, 0.7242, 0.7220)];
    for row in table("butenschoen_squeeze_sommerfeld.csv").iter().filter(|r| r[0].abs() <= 0.95) {
        for (k, ratio) in [1.0, 0.5, 0.25].into_iter().enumerate() {
            let mut u = bearing(row[0], ratio, 0.0);
            u.velocity_m_s = [u.clearance_m, 0.0];
            let state = steady(&film, &u).unwrap();
            let printed = row[k + 1];
            let right = misprints
                .iter()
                .find(|m| m.0 == row[0] && m.1 == k + 1 && m.2 == printed)
                .map_or(printed, |m| m.3);
            let found = u.sommerfeld(size(state.output.force_n), 1.0);
            let miss = (found / right - 1.0).abs();
            assert!(
                miss <= allowed(0.005, right, 0.5e-4),
                "So {found} not {right} at eps {} B/D {ratio}: {miss:.4}",
                row[0]
            );
        }
    }
}

#[test]
fn observed_order_in_the_cell_size_is_two() {
    let load = |n: usize| {
        let film =
            Reynolds { cavitation: Cavitation::None, ..Reynolds::new(Mesh::new(9 * n, 2 * n, Axial::Half)) };
        let mut u = bearing(0.5, 0.5, 100.0);
        u.velocity_m_s = [0.3 * u.clearance_m * 100.0, 0.0];
        let y = steady(&film, &u).unwrap().output;
        [y.force_n[0], y.force_n[1], y.loss_w, y.dissipation_w]
    };
    let (a, b, c) = (load(4), load(8), load(16));
    for k in 0..4 {
        let order = ((a[k] - b[k]) / (b[k] - c[k])).abs().log2();
        assert!((order - 2.0).abs() <= 0.1, "order {order} of output {k}");
    }
}

#[test]
fn petroff() {
    let (d, clearance, width, eta) = (0.01, 0.01 * 1e-5, 0.005, 0.001);
    let omega = 2.0 * std::f64::consts::PI * (150.0 - 120.0);
    let exact = eta / 2.0 * std::f64::consts::PI * d * d * d * width / clearance * omega * omega;
    let u = FilmInput::at_rest(0.0, width, d, clearance / 2.0, eta, omega);
    let films: [&dyn FilmModel; 2] = [&Reynolds::new(Mesh::new(36, 4, Axial::Full)), &ShortFilm::new(200.0)];
    for film in films {
        let loss = steady(film, &u).unwrap().output.loss_w;
        assert!((loss / exact - 1.0).abs() < 1e-12, "{loss} {exact}");
    }
}

#[test]
fn short_bearing_closed_forms() {
    let film = ShortFilm::new(200.0);
    for row in table("short_bearing_ocvirk.csv") {
        let u = bearing(row[0], 0.25, 100.0);
        let state = steady(&film, &u).unwrap();
        let unit = u.viscosity_pa_s * 100.0 * u.diameter_m / 2.0 * u.width_m.powi(3) / u.clearance_m.powi(2);
        assert!((size(state.output.force_n) / unit / row[1] - 1.0).abs() < 1e-10, "force at {}", row[0]);
        assert!((attitude(&state) - row[2]).abs() < 1e-8, "attitude at {}", row[0]);
        let flow = 100.0 * u.diameter_m / 2.0 * u.width_m * u.clearance_m * row[3];
        assert!((state.output.side_flow_m3_s / flow - 1.0).abs() < 1e-10, "flow at {}", row[0]);
    }
}

#[test]
fn booker_mobility_of_the_centred_journal_and_his_fit_near_the_wall() {
    // Mobility along the load: M = (1 - xi)^(5/2) (L/D)^-2 / pi (Booker 1971), exact at the centre.
    let film = ShortFilm::new(200.0);
    for (xi, tolerance) in [(0.0f64, 1e-12), (0.4, 0.03), (0.8, 0.06)] {
        let mut u = bearing(xi, 0.25, 0.0);
        u.velocity_m_s = [1e-3, 0.0];
        let force = size(steady(&film, &u).unwrap().output.force_n);
        let ratio: f64 = u.width_m / u.diameter_m;
        let mobility = (1.0 - xi).powf(2.5) / (ratio * ratio) / std::f64::consts::PI;
        let speed = u.clearance_m * force * (2.0 * u.clearance_m / u.diameter_m).powi(2)
            / (u.width_m * u.diameter_m * u.viscosity_pa_s)
            * mobility;
        assert!((speed / 1e-3 - 1.0).abs() <= tolerance, "{speed} at {xi}");
    }
}

#[test]
fn a_narrow_bearing_on_a_mesh_approaches_the_short_bearing() {
    let u = bearing(0.5, 0.05, 100.0);
    let mesh = steady(&Reynolds::new(Mesh::new(180, 24, Axial::Half)), &u).unwrap().output;
    let short = steady(&ShortFilm::new(200.0), &u).unwrap().output;
    assert!((size(mesh.force_n) / size(short.force_n) - 1.0).abs() < 0.01);
    assert!((mesh.loss_w / short.loss_w - 1.0).abs() < 1e-3);
    assert!((mesh.pressure_peak_pa / short.pressure_peak_pa - 1.0).abs() < 0.02);
}

#[test]
fn wall_power_is_dissipation_and_squeeze_power_to_rounding() {
    for cavitation in [Cavitation::None, Cavitation::SwiftStieber] {
        let film = Reynolds { cavitation, ..Reynolds::new(Mesh::new(48, 6, Axial::Full)) };
        let mut u = bearing(0.7, 0.5, 100.0);
        u.velocity_m_s = [2e-3, -1e-3];
        let y = steady(&film, &u).unwrap().output;
        let squeeze = y.force_n[0] * u.velocity_m_s[0] + y.force_n[1] * u.velocity_m_s[1];
        assert!(((y.loss_w - squeeze) / y.dissipation_w - 1.0).abs() < 1e-11);
    }
}

#[test]
fn half_and_full_width_are_the_same_film() {
    let u = bearing(0.8, 0.5, 100.0);
    let half = steady(&Reynolds::new(Mesh::new(48, 5, Axial::Half)), &u).unwrap().output;
    let full = steady(&Reynolds::new(Mesh::new(48, 10, Axial::Full)), &u).unwrap().output;
    for (a, b) in [
        (half.force_n[0], full.force_n[0]),
        (half.loss_w, full.loss_w),
        (half.side_flow_m3_s, full.side_flow_m3_s),
    ] {
        assert!((a / b - 1.0).abs() < 1e-10);
    }
}

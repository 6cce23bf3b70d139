//! Closed forms: long bearing, short bearing, Petroff, and the order of the discretisation.

use super::{attitude, line_of_no_pressure, nested, size};
use crate::common::{bearing, table};
use std::f64::consts::PI;
use stribeck::film::{
    Axial, Cavitation, FilmInput, FilmModel, Mesh, Reynolds, ShortFilm, SteadyState, steady,
};

/// The ruptured long film in units of the table, and its state: radial and tangential force, force, largest pressure.
fn long(n: usize, eps: f64, cavitation: Cavitation) -> ([f64; 4], SteadyState) {
    // One cell across and L/D = 5000: what leaks over the edges is 2 (D/L)^2 of the whole.
    let film = Reynolds { cavitation, ..line_of_no_pressure(n, 1) };
    let u = bearing(eps, 5000.0, 100.0);
    let state = nested(&film, &u);
    let (radius, psi) = (u.diameter_m / 2.0, 2.0 * u.clearance_m / u.diameter_m);
    let pressure = u.viscosity_pa_s * 100.0 / (psi * psi);
    let [x, y] = state.output.force_n.map(|f| f / (pressure * radius * u.width_m));
    let top = film.pressure_max_pa(&u.into(), &state.q) / pressure;
    ([x.abs(), y.abs(), x.hypot(y), top], state)
}

#[test]
fn infinitely_long_bearing() {
    // p = 0 along the widest gap; ruptured after Swift and Stieber, after Guembel, and not at all. The pressure of a nearly
    // touching journal is narrow: 720 columns are good for 1e-4 up to 0.8, four times as many beyond.
    let mut worst = [0.0f64; 4];
    for row in table("long_bearing_sommerfeld.csv") {
        let eps = row[0];
        let n = if eps <= 0.8 { 720 } else { 2880 };
        let (ruptured, state) = long(n, eps, Cavitation::SwiftStieber);
        let (half, _) = long(n, eps, Cavitation::Guembel);
        let (full, whole) = long(n, eps, Cavitation::None);
        let torque = whole.output.loss_w / (100.0 * 0.01 * 100.0 * 0.05 * 0.05 * 500.0 / 1e-3);
        let pairs = [
            (ruptured[0], row[5]),
            (ruptured[1], row[6]),
            (ruptured[2], row[7]),
            (ruptured[3], row[9]),
            (half[0], row[2]),
            (half[1], row[3]),
            (full[2], row[1]),
            (torque, row[10]),
        ];
        let misses = pairs.map(|(found, right)| found / right - 1.0);
        println!("eps {eps}: {}", misses.map(|m| format!("{m:+.1e}")).join(" "));
        for (k, miss) in misses.iter().enumerate() {
            assert!(miss.abs() < 1e-4, "quantity {k} at {eps}: {:?} ({miss:.1e})", pairs[k]);
        }
        let angle = attitude(&state) - row[8];
        assert!(angle.abs() < 1e-4 * row[8], "attitude off by {angle} at {eps}");
        worst[0] = worst[0].max(angle.abs());
        check_rupture(&state.q, row[4], eps);
    }
    println!("worst attitude {:.1e} deg", worst[0]);
}

/// The face after the last full column stands within one cell of the place of rupture.
fn check_rupture(q: &[f64], rupture_deg: f64, eps: f64) {
    let (n, half) = (q.len(), q.len() / 2);
    let full = (1..n).take_while(|i| q[(half + i) % n] > 0.0).count();
    let found = 360.0 / n as f64 * (full as f64 + 0.5);
    assert!((found - rupture_deg).abs() <= 360.0 / n as f64, "rupture at {found} not {rupture_deg} at {eps}");
}

#[test]
fn the_long_bearing_is_met_with_order_two() {
    for eps in [0.3, 0.6, 0.9] {
        let at = |n| long(n, eps, Cavitation::None).0[2];
        let (a, b, c) = (at(180), at(360), at(720));
        let order = ((a - b) / (b - c)).abs().log2();
        assert!((order - 2.0).abs() <= 0.1, "order {order} at {eps}");
    }
}

#[test]
fn observed_order_in_the_cell_size_is_two() {
    // Full film of finite width, p = 0 at both edges, rotation and squeeze.
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
    // P = eta pi d^3 B omega^2 / (2 (D - d)); centred, p = 0 at both edges.
    let (d, clearance, width, eta) = (0.01, 0.01 * 1e-5, 0.005, 0.001);
    let omega = 2.0 * PI * (150.0 - 120.0);
    let exact = eta / 2.0 * PI * d * d * d * width / clearance * omega * omega;
    let u = FilmInput::at_rest(0.0, width, d, clearance / 2.0, eta, omega);
    let films: [&dyn FilmModel; 2] = [&Reynolds::new(Mesh::new(36, 4, Axial::Full)), &ShortFilm::new(200.0)];
    for film in films {
        let loss = steady(film, &u).unwrap().output.loss_w;
        println!("Petroff {:.1e}", loss / exact - 1.0);
        assert!((loss / exact - 1.0).abs() < 1e-6, "{loss} {exact}");
    }
}

#[test]
fn short_bearing_closed_forms() {
    // Half film from the widest to the smallest gap, no pressure flow around, p = 0 at both edges.
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
        let mobility = (1.0 - xi).powf(2.5) / (ratio * ratio) / PI;
        let speed = u.clearance_m * force * (2.0 * u.clearance_m / u.diameter_m).powi(2)
            / (u.width_m * u.diameter_m * u.viscosity_pa_s)
            * mobility;
        assert!((speed / 1e-3 - 1.0).abs() <= tolerance, "{speed} at {xi}");
    }
}

/// Force, side flow and loss on a mesh over those of the closed form, less 1, and the miss of the attitude in degrees.
fn against_the_short_bearing(film: &Reynolds, eps: f64, width_ratio: f64) -> [f64; 4] {
    let u = bearing(eps, width_ratio, 100.0);
    let (mesh, short) = (nested(film, &u), steady(&ShortFilm::new(200.0), &u).unwrap());
    let (y, z) = (&mesh.output, &short.output);
    [
        size(y.force_n) / size(z.force_n) - 1.0,
        y.side_flow_m3_s / z.side_flow_m3_s - 1.0,
        y.loss_w / z.loss_w - 1.0,
        attitude(&mesh) - attitude(&short),
    ]
}

#[test]
fn a_narrow_bearing_on_a_mesh_approaches_the_short_bearing() {
    // Swift-Stieber on the mesh, half film in closed form, p = 0 at both edges.
    let film = Reynolds::new(Mesh::new(360, 48, Axial::Half));
    for eps in [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] {
        let [force, flow, loss, angle] = against_the_short_bearing(&film, eps, 0.05);
        println!("narrow {eps}: force {force:+.1e} flow {flow:+.1e} loss {loss:+.1e} {angle:+.3} deg");
        assert!(force.abs() < 0.005 && flow.abs() < 0.005 && loss.abs() < 0.005, "at {eps}");
    }
    // The pressure flow around that the closed form leaves out takes 0.5 % of the force at eps 0.7 and 0.8 % at 0.8 (on any
    // mesh); it falls with the square of L/D.
    for eps in [0.7, 0.8] {
        let [wide, narrow] = [0.05, 0.025].map(|ratio| against_the_short_bearing(&film, eps, ratio)[0]);
        println!("narrow {eps}: force {wide:+.1e}, at half the width {narrow:+.1e}");
        assert!(narrow.abs() < 0.005 && wide.abs() < 0.01 && wide / narrow > 2.5, "{wide} {narrow}");
    }
}

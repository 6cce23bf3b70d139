//! Butenschoen 1976: the cylindrical bearing of finite width under rotation and under squeeze.
//!
//! Isoviscous, Swift-Stieber, p = 0 at both edges **and along the widest gap** (without that line the attitude is off by
//! up to 4.4 degrees and the flow by 12 % at B/D = 1); the whole gap is sheared.

use super::{MESH, allowed, attitude, line_of_no_pressure, nested, size};
use crate::common::{bearing, table};
use stribeck::film::Reynolds;

fn film() -> Reynolds {
    line_of_no_pressure(MESH.0, MESH.1)
}

/// A misprint of the source or its transcription, found by three independent solutions: eps, column, printed, right.
type Misprint = (f64, usize, f64, f64);

/// The printed value, or the right one where it is misprinted.
fn mended(misprints: &[Misprint], eps: f64, column: usize, printed: f64) -> f64 {
    let found = misprints.iter().find(|m| (m.0, m.1, m.2) == (eps, column, printed));
    found.map_or(printed, |m| m.3)
}

#[test]
fn rotation() {
    let film = film();
    let so = table("butenschoen_rotation_sommerfeld.csv");
    let beta = table("butenschoen_rotation_attitude_deg.csv");
    let flow = table("butenschoen_rotation_side_flow.csv");
    let misprints = [(0.2, 3, 75.287, 75.377), (0.3, 3, 68.204, 68.289)];
    let mut worst = [0.0f64; 3];
    for (i, row) in so.iter().enumerate().filter(|(_, r)| r[0] <= 0.95) {
        for (k, ratio) in [1.0, 0.5, 0.25].into_iter().enumerate() {
            let (u, eps) = (bearing(row[0], ratio, 100.0), row[0]);
            let state = nested(&film, &u);
            let found = u.sommerfeld(size(state.output.force_n), 100.0);
            let miss = (found / row[k + 1] - 1.0).abs();
            assert!(miss <= allowed(0.005, row[k + 1], 0.5e-4), "So {found} at {eps} B/D {ratio}: {miss:.4}");
            let right = mended(&misprints, eps, k + 1, beta[i][k + 1]);
            let angle = attitude(&state);
            assert!((angle - right).abs() <= 0.15, "beta {angle} not {right} at {eps} B/D {ratio}");
            let scale = (u.diameter_m / 2.0).powi(3) * 2.0 * u.clearance_m / u.diameter_m * 100.0;
            let q = state.output.side_flow_m3_s / scale;
            let flow_miss = (q / flow[i][k + 1] - 1.0).abs();
            assert!(flow_miss <= 0.01, "Q {q} at {eps} B/D {ratio}: {flow_miss:.4}");
            let misses = [if row[k + 1] > 0.05 { miss } else { 0.0 }, (angle - right).abs(), flow_miss];
            (0..3).for_each(|a| worst[a] = worst[a].max(misses[a]));
        }
    }
    println!("worst So {:.2e}, beta {:.3} deg, Q {:.2e}", worst[0], worst[1], worst[2]);
}

#[test]
fn friction_follows_from_load_and_attitude() {
    // mu/Psi = pi / (So sqrt(1 - eps^2)) + eps/2 sin(beta), full 2 pi film.
    let film = film();
    for eps in [0.2, 0.5, 0.8, 0.95] {
        let u = bearing(eps, 0.5, 100.0);
        let state = nested(&film, &u);
        let so = u.sommerfeld(size(state.output.force_n), 100.0);
        let psi = 2.0 * u.clearance_m / u.diameter_m;
        let mu = state.output.loss_w / (size(state.output.force_n) * 100.0 * u.diameter_m / 2.0);
        let formula = std::f64::consts::PI / (so * (1.0 - eps * eps).sqrt())
            + eps / 2.0 * attitude(&state).to_radians().sin();
        println!("friction at {eps}: {:.1e}", mu / psi / formula - 1.0);
        assert!((mu / psi / formula - 1.0).abs() < 1e-3, "{} {formula}", mu / psi);
    }
}

#[test]
fn squeeze() {
    // The line without pressure lies behind the moving journal, in the ruptured half of the film.
    // Close to the wall the pressure is so narrow that 360 columns are 0.6 % off the table, and 720 half a percent.
    let (film, fine) = (film(), line_of_no_pressure(720, 32));
    let misprints = [(0.1, 2, 0.9814, 0.9314), (0.2, 2, 1.2236, 1.2337), (-0.7, 1, 0.7242, 0.7220)];
    let mut worst = 0.0f64;
    for row in table("butenschoen_squeeze_sommerfeld.csv").iter().filter(|r| r[0].abs() <= 0.95) {
        for (k, ratio) in [1.0, 0.5, 0.25].into_iter().enumerate() {
            let mut u = bearing(row[0], ratio, 0.0);
            u.velocity_m_s = [u.clearance_m, 0.0];
            let film = if row[0] < 0.9 { &film } else { &fine };
            let state = nested(film, &u);
            let right = mended(&misprints, row[0], k + 1, row[k + 1]);
            let found = u.sommerfeld(size(state.output.force_n), 1.0);
            let miss = (found / right - 1.0).abs();
            let limit = allowed(0.005, right, 0.5e-4);
            assert!(miss <= limit, "So {found} not {right} at {} B/D {ratio}: {miss:.4}", row[0]);
            worst = worst.max(miss);
        }
    }
    println!("worst So {worst:.2e}");
}

//! Stiffness and damping of a bearing with two axial grooves (Lund and Thomsen 1978).
//!
//! Isoviscous, Swift-Stieber, p = 0 at both edges and in two grooves of 20 degrees at the split; the load stands along x,
//! midway between the grooves. K and B are the exact derivatives of the discrete film: `dq = -J^-1 dr`.

use super::{nested, size};
use crate::common::{bearing, table};
use std::f64::consts::PI;
use stribeck::film::{Axial, FilmChange, FilmInput, FilmLinear, FilmModel, Mesh, Reynolds, steady_at};
use stribeck::math::CyclicBand;

const SPEED: f64 = 100.0;

fn grooved(n_phi: usize, n_z: usize) -> Reynolds {
    let column = |degree: usize| degree * n_phi / 360;
    let held = (column(80)..=column(100)).chain(column(260)..=column(280)).map(|i| (i, 0.0)).collect();
    Reynolds { held_columns: held, ..Reynolds::new(Mesh::new(n_phi, n_z, Axial::Half)) }
}

/// Force on the journal and its derivatives by eccentricity and by velocity.
pub(super) struct Response {
    pub force: [f64; 2],
    pub by_position: [[f64; 2]; 2],
    by_velocity: [[f64; 2]; 2],
}

/// The response of the steady film, solved from the unknowns of a similar one; `q` takes those found.
pub(super) fn response(film: &Reynolds, u: &FilmInput, q: &mut Vec<f64>) -> Option<Response> {
    let (n, (blocks, b), site) = (film.unknowns(), film.shape(), (*u).into());
    let state = steady_at(film, &site, Some(q)).ok()?;
    let (mut linear, mut band) = (FilmLinear::new(n, 2), CyclicBand::new(blocks, b));
    film.linearise(&site, &state.q, 0.0, &[], &mut linear);
    band.factor(&linear.stencil).unwrap();
    let answer = |mut dr: Vec<f64>, a: usize| {
        band.solve(&mut dr);
        -dr.iter().zip(&linear.rows[a * n..(a + 1) * n]).map(|(x, r)| x * r).sum::<f64>()
    };
    let squeeze = |j: usize| {
        // The velocity enters through the rate of the content: that of the gap, in full cells.
        let mut unit = FilmInput::default();
        unit.eccentricity_m[j] = 1.0;
        let moved = FilmChange { q: &[], rate: &[], input: unit, shape_m: &[], shell_left: &[] };
        let rate = film.tangent(&site, &state.q, &[], &moved).content;
        let change =
            FilmChange { q: &[], rate: &rate, input: FilmInput::default(), shape_m: &[], shell_left: &[] };
        film.tangent(&site, &state.q, &vec![0.0; n], &change).residual
    };
    let column = |j: usize| linear.columns[j * n..(j + 1) * n].to_vec();
    let matrix = |of: &dyn Fn(usize) -> Vec<f64>| [0, 1].map(|a| [0, 1].map(|j| answer(of(j), a)));
    let mut by_position = matrix(&column);
    (0..2).for_each(|a| (0..2).for_each(|j| by_position[a][j] += linear.corner[a][j]));
    let by_velocity = matrix(&squeeze);
    *q = state.q;
    Some(Response { force: state.output.force_n, by_position, by_velocity })
}

/// `-k^-1 off`.
pub(super) fn newton(k: [[f64; 2]; 2], off: [f64; 2]) -> [f64; 2] {
    let det = k[0][0] * k[1][1] - k[0][1] * k[1][0];
    [-(k[1][1] * off[0] - k[0][1] * off[1]) / det, -(k[0][0] * off[1] - k[1][0] * off[0]) / det]
}

/// Eccentricity ratio, attitude (degrees), Kxx, Kxy, Kyx, Kyy, Bxx, Bxy, Byx, Byy at a Sommerfeld number.
fn coefficients(film: &Reynolds, width_ratio: f64, s: f64, start: (f64, f64)) -> [f64; 10] {
    let mut u = bearing(start.0, width_ratio, SPEED);
    let (c, radius) = (u.clearance_m, u.diameter_m / 2.0);
    let turned = start.1.to_radians();
    u.eccentricity_m = [turned.cos(), turned.sin()].map(|x| x * start.0 * c);
    let load = u.viscosity_pa_s * SPEED / (2.0 * PI) * u.width_m * u.diameter_m * (radius / c).powi(2) / s;
    let mut q = nested(film, &u).q;
    for _ in 0..20 {
        let r = response(film, &u, &mut q).unwrap();
        let k = r.by_position;
        let off = [r.force[0] + load, r.force[1]];
        if size(off) < 1e-9 * load {
            let [ex, ey] = u.eccentricity_m;
            let (k, b) = (k.map(|r| r.map(|v| -v * c / load)), r.by_velocity);
            let b = b.map(|r| r.map(|v| -v * c * SPEED / load));
            let at = [ex.hypot(ey) / c, ey.atan2(ex).to_degrees()];
            return [at[0], at[1], k[0][0], k[0][1], k[1][0], k[1][1], b[0][0], b[0][1], b[1][0], b[1][1]];
        }
        let step = newton(k, off);
        let share = film.admissible(&u.into(), [step[0], step[1], 0.0, 0.0], 0.2);
        (0..2).for_each(|a| u.eccentricity_m[a] += share * step[a]);
    }
    panic!("no equilibrium at S = {s}");
}

#[test]
fn lund_thomsen_two_axial_grooves() {
    let (film, fine) = (grooved(720, 12), grooved(1440, 24));
    for row in table("lund_thomsen_two_axial_grooves.csv") {
        let found = coefficients(&film, row[0], row[1], (row[2], row[3]));
        let finer = coefficients(&fine, row[0], row[1], (found[0], found[1]));
        // The print leaves Byx out, which is Bxy.
        let printed =
            [found[0], found[1], found[2], found[3], found[4], found[5], found[6], found[7], found[9]];
        println!("S {}: {}", row[1], printed.map(|v| format!("{v:.3}")).join(" "));
        println!(
            "     own finer mesh {}",
            [2, 3, 4, 5, 6, 7, 9].map(|k| format!("{:+.4}", found[k] / finer[k] - 1.0)).join(" ")
        );
        assert!((found[0] - row[2]).abs() <= 0.005, "eps {} not {} at S {}", found[0], row[2], row[1]);
        assert!((found[1] - row[3]).abs() <= 0.3, "phi {} not {} at S {}", found[1], row[3], row[1]);
        for k in 2..9 {
            let (v, right) = (printed[k], row[k + 2]);
            assert!(
                (v - right).abs() <= 0.06 * right.abs() + 0.06,
                "coefficient {k}: {v} not {right} at S {}",
                row[1]
            );
        }
        for k in 2..10 {
            let size = finer[k].abs().max(0.5);
            assert!((found[k] - finer[k]).abs() <= 0.01 * size, "{k}: {} {}", found[k], finer[k]);
        }
        assert!((found[7] - found[8]).abs() < 0.02 * found[7].abs(), "Bxy {} Byx {}", found[7], found[8]);
    }
}

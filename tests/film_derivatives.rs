//! Every derivative of every film, against differences and against its own transpose.

use proptest::prelude::*;
use stribeck::film::{
    Axial, Cavitation, FilmInput, FilmModel, FilmOutput, Mesh, Reynolds, ShortFilm, steady,
};

fn films() -> Vec<Box<dyn FilmModel>> {
    let mesh = || Mesh::new(24, 3, Axial::Half);
    vec![
        Box::new(Reynolds { cavitation: Cavitation::None, ..Reynolds::new(mesh()) }),
        Box::new(Reynolds {
            side_pressure_pa: 2e5,
            cavitation_pressure_pa: -5e4,
            sharpness: 20.0,
            held_columns: vec![(5, 3e5)],
            ..Reynolds::new(Mesh::new(24, 4, Axial::Full))
        }),
        Box::new(ShortFilm::new(20.0)),
    ]
}

fn input(x: &[f64; 9]) -> FilmInput {
    FilmInput {
        eccentricity_m: [30e-6 * x[0], 30e-6 * x[1]],
        velocity_m_s: [2e-3 * x[2], 2e-3 * x[3]],
        speed_rad_s: 100.0 + 40.0 * x[4],
        width_m: 0.05 + 0.02 * x[5],
        diameter_m: 0.1 + 0.03 * x[6],
        clearance_m: 60e-6 + 10e-6 * x[7],
        viscosity_pa_s: 0.01 + 0.005 * x[8],
    }
}

/// `u + t du`.
fn moved(u: &FilmInput, du: &FilmInput, t: f64) -> FilmInput {
    FilmInput {
        eccentricity_m: [0, 1].map(|a| u.eccentricity_m[a] + t * du.eccentricity_m[a]),
        velocity_m_s: [0, 1].map(|a| u.velocity_m_s[a] + t * du.velocity_m_s[a]),
        speed_rad_s: u.speed_rad_s + t * du.speed_rad_s,
        width_m: u.width_m + t * du.width_m,
        diameter_m: u.diameter_m + t * du.diameter_m,
        clearance_m: u.clearance_m + t * du.clearance_m,
        viscosity_pa_s: u.viscosity_pa_s + t * du.viscosity_pa_s,
    }
}

fn inner(a: &FilmInput, b: &FilmInput) -> f64 {
    (0..2)
        .map(|k| a.eccentricity_m[k] * b.eccentricity_m[k] + a.velocity_m_s[k] * b.velocity_m_s[k])
        .sum::<f64>()
        + a.speed_rad_s * b.speed_rad_s
        + a.width_m * b.width_m
        + a.diameter_m * b.diameter_m
        + a.clearance_m * b.clearance_m
        + a.viscosity_pa_s * b.viscosity_pa_s
}

fn numbers(y: &FilmOutput) -> [f64; 7] {
    [y.force_n[0], y.force_n[1], y.loss_w, y.dissipation_w, y.gap_min_m, y.pressure_peak_pa, y.side_flow_m3_s]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn tangents_are_limits_of_differences_and_cotangents_their_transposes(
        x in prop::array::uniform9(-1.0f64..1.0), dx in prop::array::uniform9(-1.0f64..1.0),
        noise in prop::collection::vec(-1.0f64..1.0, 96),
    ) {
        let u = input(&x);
        // A direction of the size of the quantities themselves.
        let (a, b) = (input(&dx), input(&[0.0; 9]));
        let du = moved(&a, &b, -1.0);
        for film in films() {
            let q = steady(film.as_ref(), &u).unwrap().q;
            let n = q.len();
            let top = q.iter().fold(1.0f64, |m, v| m.max(v.abs()));
            let dq: Vec<f64> = noise.iter().cycle().take(n).map(|v| 0.1 * v * top).collect();
            check_residual(film.as_ref(), &u, &q, &du, &noise);
            check_outputs(film.as_ref(), &u, &q, &du, &dq);
        }
    }
}

fn check_residual(film: &dyn FilmModel, u: &FilmInput, q: &[f64], du: &FilmInput, noise: &[f64]) {
    let n = q.len();
    if n == 0 {
        return;
    }
    // Pressures away from the edge of the cavity, so that a small step changes no active set.
    let lifted: Vec<f64> = q.iter().map(|v| if *v > 0.0 { v + 1e5 } else { *v }).collect();
    let mut tangent = vec![0.0; n];
    film.residual_tangent(u, &lifted, du, &mut tangent);
    let at = |t: f64| {
        let mut r = vec![0.0; n];
        film.residual(&moved(u, du, t), &lifted, &mut r);
        r
    };
    let mut stencil = stribeck::math::Stencil::zeros(n);
    film.stencil(u, &lifted, &mut stencil);
    let e = 1e-6;
    let (plus, minus) = (at(e), at(-e));
    let size = tangent.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    for k in (0..n).filter(|&k| !stencil.is_decoupled(k)) {
        let difference = (plus[k] - minus[k]) / (2.0 * e);
        assert!((difference - tangent[k]).abs() < 1e-6 * size, "row {k}: {difference} {}", tangent[k]);
    }
    let lambda: Vec<f64> = noise.iter().cycle().take(n).copied().collect();
    let forward: f64 = lambda.iter().zip(&tangent).map(|(l, t)| l * t).sum();
    let backward = inner(&film.residual_cotangent(u, &lifted, &lambda), du);
    assert!((forward - backward).abs() < 1e-11 * size * n as f64);
}

fn check_outputs(film: &dyn FilmModel, u: &FilmInput, q: &[f64], du: &FilmInput, dq: &[f64]) {
    let tangent = numbers(&film.output_tangent(u, q, dq, du));
    let at = |t: f64| {
        let moved_q: Vec<f64> = q.iter().zip(dq).map(|(q, d)| q + t * d).collect();
        numbers(&film.output(&moved(u, du, t), &moved_q))
    };
    let e = 1e-6;
    let (plus, minus, here) = (at(e), at(-e), at(0.0));
    let weights = [0.3, -1.2, 0.7, 0.4, 1e6, 1e-4, 1e5];
    let mut forward = 0.0;
    for k in 0..7 {
        let difference = (plus[k] - minus[k]) / (2.0 * e);
        let size = tangent[k].abs() + here[k].abs();
        assert!((difference - tangent[k]).abs() < 1e-5 * size, "output {k}: {difference} {}", tangent[k]);
        forward += weights[k] * tangent[k];
    }
    let w = FilmOutput {
        force_n: [weights[0], weights[1]],
        loss_w: weights[2],
        dissipation_w: weights[3],
        gap_min_m: weights[4],
        pressure_peak_pa: weights[5],
        side_flow_m3_s: weights[6],
    };
    let mut q_bar = vec![0.0; q.len()];
    let u_bar = film.output_cotangent(u, q, &w, &mut q_bar);
    let backward = inner(&u_bar, du) + q_bar.iter().zip(dq).map(|(a, b)| a * b).sum::<f64>();
    let size: f64 = weights.iter().zip(&tangent).map(|(w, t)| (w * t).abs()).sum();
    assert!((forward - backward).abs() < 1e-10 * size, "{forward} {backward}");

    let df = film.force_tangent(u, q, du);
    let by_pressure = film.output_tangent(u, q, dq, &FilmInput::default());
    for a in 0..2 {
        assert!((df[a] + by_pressure.force_n[a] - tangent[a]).abs() < 1e-9 * tangent[a].abs().max(1.0));
    }
    let mut row = vec![0.0; q.len()];
    let f_bar = film.force_cotangent(u, q, [0.3, -1.2], Some(&mut row));
    let direct = 0.3 * tangent[0] - 1.2 * tangent[1];
    let turned = inner(&f_bar, du) + row.iter().zip(dq).map(|(a, b)| a * b).sum::<f64>();
    assert!((direct - turned).abs() < 1e-9 * (tangent[0].abs() + tangent[1].abs()));
}

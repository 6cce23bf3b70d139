//! Slopes of every output by every argument, the sign of the shear stress factor, limits.

use super::*;
use crate::laws::taylor::assert_slope;
use proptest::prelude::*;

fn outputs(film: &RoughFilm) -> [Partials; 9] {
    [
        film.pressure_around,
        film.pressure_across,
        film.flow_gap,
        film.average_gap,
        film.shear_thickness,
        film.couette_journal_per_m,
        film.couette_shell_per_m,
        film.drag_per_m,
        film.pressure_stress,
    ]
}

#[test]
fn every_output_by_every_argument_passes_the_taylor_test() {
    for (gammas, sigmas) in [([1.0, 1.0], [0.4e-6, 0.6e-6]), ([3.0, 0.2], [0.8e-6, 0.3e-6])] {
        let rough = RoughSurfaces::new(gammas[0], gammas[1], sigmas[0], sigmas[1]).unwrap();
        for step in -10..120 {
            let gap_m = (0.1 * f64::from(step) + 0.0321) * f64::hypot(sigmas[0], sigmas[1]);
            let at = [gap_m, sigmas[0], sigmas[1]];
            let found = outputs(&rough.at(at[0], at[1], at[2]));
            for (output, partials) in found.iter().enumerate() {
                for k in 0..3 {
                    let along = |x: f64| {
                        let mut moved = at;
                        moved[k] = x;
                        outputs(&rough.at(moved[0], moved[1], moved[2]))[output].value
                    };
                    assert_slope(along, at[k], partials.by[k], 2e-10);
                }
            }
        }
    }
}

#[test]
fn relabelling_the_surfaces_leaves_the_power_and_mirrors_the_flow() {
    let (eta, dp_dx, gap) = (0.012, 3e9, 1.7e-6);
    let (u1, u2) = (9.0, 1.5);
    let power_and_shear = |gammas: [f64; 2], sigmas: [f64; 2], u1: f64, u2: f64| {
        let film = RoughSurfaces::new(gammas[0], gammas[1], sigmas[0], sigmas[1])
            .unwrap()
            .at(gap, sigmas[0], sigmas[1]);
        let pressure = film.pressure_stress.value * film.flow_gap.value / 2.0 * dp_dx;
        let journal = eta * (u2 - u1) * film.couette_journal_per_m.value - pressure;
        let shell = eta * (u2 - u1) * film.couette_shell_per_m.value + pressure;
        (shell * u2 - journal * u1, (u1 - u2) / 2.0 * film.shear_thickness.value, film.drag_per_m.value)
    };
    let one = power_and_shear([1.0, 3.0], [0.7e-6, 0.2e-6], u1, u2);
    let other = power_and_shear([3.0, 1.0], [0.2e-6, 0.7e-6], u2, u1);
    for (a, b) in [(one.0, other.0), (one.1, other.1), (one.2, other.2)] {
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    }
}

/// Ridges across, small against the gap, solved exactly in the frame of the rough wall (there the flow is steady):
/// the smooth wall feels more shear, and shear flow goes with the rough wall.
#[test]
fn signs_follow_from_ridges_across_a_steady_flow() {
    // Rough wall 1 at rest, smooth wall 2 at speed 1, eta = 1, mean gap 1: p' = 12 (h/2 - q)/h^3, tau_2,1 = 1/h +- h p'/2.
    let n = 2000;
    let gap = |k: i32| 1.0 - 0.2 * (std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(n)).sin();
    let mean = |f: &dyn Fn(f64) -> f64| (0..n).map(|k| f(gap(k))).sum::<f64>() / f64::from(n);
    let flow = 0.5 * mean(&|h| h.powi(-2)) / mean(&|h| h.powi(-3));
    let slope = |h: f64| 12.0 * (h / 2.0 - flow) / h.powi(3);
    let smooth_wall = mean(&|h| 1.0 / h + h / 2.0 * slope(h));
    let rough_wall = mean(&|h| 1.0 / h - h / 2.0 * slope(h));
    // Flow = 1/2 - phi_s sigma/2 with the rough wall as surface 1.
    assert!(flow < 0.5 && smooth_wall > rough_wall, "{flow} {smooth_wall} {rough_wall}");

    let rough = RoughSurfaces::new(1.0 / 9.0, 1.0 / 9.0, 1e-6, 0.0).unwrap().at(4e-6, 1e-6, 0.0);
    assert!(rough.shear_thickness.value > 0.0);
    assert!(rough.couette_shell_per_m.value > rough.couette_journal_per_m.value);
    // A smooth shell has no flanks: its wall shear is the whole drag.
    assert_eq!(rough.drag_per_m, rough.couette_shell_per_m);
}

#[test]
fn a_thick_film_is_smooth() {
    let film = RoughSurfaces::new(1.0, 1.0, 0.3e-6, 0.5e-6).unwrap().at(60e-6, 0.3e-6, 0.5e-6);
    for factor in [film.pressure_around, film.pressure_across, film.pressure_stress] {
        assert!((factor.value - 1.0).abs() < 1e-10);
    }
    assert_eq!((film.flow_gap.value, film.flow_gap.by[0]), (60e-6, 1.0));
    assert!((film.average_gap.value / 60e-6 - 1.0).abs() < 1e-14);
    assert!((film.drag_per_m.value * 60e-6 - 1.0).abs() < 2e-4);
    assert!(film.shear_thickness.value.abs() < 1e-12);
}

#[test]
fn refuses_surfaces_outside_the_tables() {
    let made = RoughSurfaces::new;
    assert_eq!(made(0.05, 1.0, 1e-6, 1e-6), Err(RoughnessError::Peklenik(0.05)));
    assert_eq!(made(1.0, 1.0, 0.0, 0.0), Err(RoughnessError::Sigma(0.0, 0.0)));
    assert!(made(1.0, 1.0, -1e-6, 1e-6).is_err() && made(1.0, 1.0, f64::NAN, 1e-6).is_err());
    let combined = made(9.0, 1.0 / 9.0, 1e-6, 1e-6).unwrap().gamma_combined();
    assert!((combined - 1.0).abs() < 1e-12);
}

proptest! {
    #[test]
    fn matrix_and_stresses_stay_positive(
        height in -8.0..12.0f64,
        log_journal in -2.197..2.197f64,
        log_shell in -2.197..2.197f64,
        share in 0.0..1.0f64,
    ) {
        let (s1, s2) = (1e-6 * share.sqrt(), 1e-6 * (1.0 - share).sqrt());
        let rough = RoughSurfaces::new(log_journal.exp(), log_shell.exp(), s1, s2).unwrap();
        let film = rough.at(height * 1e-6, s1, s2);
        let positive =
            [film.pressure_around, film.pressure_across, film.flow_gap, film.couette_journal_per_m, film.couette_shell_per_m];
        for value in positive.map(|partials| partials.value) {
            prop_assert!(value > 0.0 && value.is_finite());
        }
        prop_assert!(outputs(&film).iter().all(|p| p.by.iter().all(|slope| slope.is_finite())));
    }
}

#[test]
fn the_table_is_as_good_as_the_formulas() {
    let surfaces = RoughSurfaces::new(1.0, 4.0, 0.3e-6, 0.5e-6).unwrap();
    let sigma = 0.3e-6f64.hypot(0.5e-6);
    let fine = (-300..1800).map(|k| f64::from(k) * 0.010_37);
    for h in fine.chain((0..700).map(|k| 16.0 + f64::from(k) * 0.811)) {
        let gap = sigma * h;
        let (exact, quick) =
            (surfaces.at(gap, 0.3e-6, 0.5e-6), surfaces.tabulated(gap, [0.3e-6, 0.5e-6], true));
        let pairs = [
            (exact.pressure_around, quick.pressure_around, 1.0),
            (exact.pressure_across, quick.pressure_across, 1.0),
            (exact.flow_gap, quick.flow_gap, sigma),
            (exact.average_gap, quick.average_gap, sigma),
            (exact.shear_thickness, quick.shear_thickness, sigma),
            (exact.couette_journal_per_m, quick.couette_journal_per_m, 1.0 / sigma),
            (exact.pressure_stress, quick.pressure_stress, 1.0),
        ];
        for (a, b, scale) in pairs {
            assert!((a.value - b.value).abs() <= 1e-8 * scale, "H = {h}: {a:?} {b:?}");
        }
    }
}

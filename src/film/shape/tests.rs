//! All profiles together: derivatives, symmetries, continuity, names.

use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// One profile of every kind from 40 numbers between -1 and 1.
fn all(c: &[f64]) -> Vec<Profile> {
    let grid = |n: usize, low: f64, d: f64| (0..n).map(|i| low + d * i as f64).collect::<Vec<f64>>();
    vec![
        Profile::LemonBore { offset_m: c[0], angle_rad: 4.0 * c[1] },
        Profile::OffsetBore { offset_m: c[2], angle_rad: 4.0 * c[3] },
        Profile::Barrel { height_m: c[4] },
        Profile::Cone { height_m: c[5] },
        Profile::EdgeRelief { depth_m: c[6], length_share: 0.55 + 0.4 * c[7] },
        Profile::Spline(TensorSpline::new(8, 5, c[..40].to_vec()).unwrap()),
        Profile::Spline(TensorSpline::symmetric(6, 4, c[..24].to_vec()).unwrap()),
        Profile::Spline(TensorSpline::new(1, 6, c[..6].to_vec()).unwrap()),
        Profile::Table(SurfaceTable::new(grid(7, 0.3, 0.8), grid(5, -0.9, 0.45), &c[..35]).unwrap()),
    ]
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0f64..1.0, 40)
}

fn points() -> Vec<[f64; 2]> {
    (0..96).map(|a| [0.173 * f64::from(a) - 5.0, (f64::from(a) * 0.61).sin()]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn derivatives_by_every_coefficient_are_central_differences(c in numbers(), rotation in -9.0f64..9.0) {
        let points = points();
        let d = 1e-6;
        for profile in all(&c) {
            let sampled = profile.sample_turned(&points, rotation);
            prop_assert!(sampled.gap_m.iter().all(|g| g.is_finite()));
            let at = profile.coefficients();
            for j in 0..at.len() {
                let moved = |by: f64| {
                    let mut at = at.clone();
                    at[j] += by;
                    let other = profile.with_coefficients(&at).unwrap();
                    let mut both = (vec![0.0; points.len()], vec![0.0; points.len()]);
                    other.gap_m_into(&points, rotation, &mut both.0);
                    other.around_m_into(&points, rotation, &mut both.1);
                    both
                };
                let mut exact = (vec![0.0; points.len()], vec![0.0; points.len()]);
                let mut unit = vec![0.0; at.len()];
                unit[j] = 1.0;
                profile.push_forward(&points, rotation, &unit, &mut exact.0, Some(&mut exact.1));
                let mut sparse = vec![0.0; points.len()];
                for &(a, s) in &sampled.slopes[j] {
                    prop_assert_eq!(sparse[a], 0.0);
                    sparse[a] = s;
                }
                prop_assert_eq!(&sparse, &exact.0);
                let (low, high) = (moved(-d), moved(d));
                for a in 0..points.len() {
                    let (gap, around) = ((high.0[a] - low.0[a]) / (2.0 * d), (high.1[a] - low.1[a]) / (2.0 * d));
                    prop_assert!((gap - exact.0[a]).abs() < 2e-3, "{:?} {} {} {}", profile, j, gap, exact.0[a]);
                    prop_assert!((around - exact.1[a]).abs() < 5e-2 * (1.0 + around.abs()));
                }
            }
        }
    }

    #[test]
    fn the_slope_around_is_that_of_the_gap_and_the_gap_is_periodic(c in numbers()) {
        for profile in all(&c) {
            for [phi, zeta] in points() {
                let d = 1e-6;
                let slope = (profile.at(phi + d, zeta)[0] - profile.at(phi - d, zeta)[0]) / (2.0 * d);
                prop_assert!((slope - profile.at(phi, zeta)[1]).abs() < 1e-3);
                prop_assert!((profile.at(phi + TAU, zeta)[0] - profile.at(phi, zeta)[0]).abs() < 1e-12);
                prop_assert!((profile.at(phi, zeta + d)[0] - profile.at(phi, zeta - d)[0]).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn symmetries_hold_and_pull_back_is_the_transpose(c in numbers(), rotation in -9.0f64..9.0) {
        let points = points();
        for profile in all(&c) {
            for &[phi, zeta] in &points {
                let here = profile.at(phi, zeta)[0];
                prop_assert!(!profile.symmetric() || (here - profile.at(phi, -zeta)[0]).abs() < 1e-13);
                prop_assert!(!profile.axisymmetric() || (here - profile.at(0.0, zeta)[0]).abs() < 1e-13);
            }
            let n = profile.coefficient_count();
            let change: Vec<f64> = (0..n).map(|j| c[39 - j]).collect();
            let bars: Vec<f64> = (0..points.len()).map(|a| c[a % 37]).collect();
            let (mut gap, mut around) = (vec![0.0; points.len()], vec![0.0; points.len()]);
            profile.push_forward(&points, rotation, &change, &mut gap, Some(&mut around));
            let mut bar = vec![0.0; n];
            let turned: Vec<f64> = bars.iter().rev().copied().collect();
            profile.pull_back(&points, rotation, &bars, Some(&turned), &mut bar);
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let (left, right) = (dot(&gap, &bars) + dot(&around, &turned), dot(&change, &bar));
            prop_assert!((left - right).abs() < 1e-10 * (1.0 + dot(&around, &around)));
        }
    }
}

#[test]
fn the_remainder_of_nonlinear_coefficients_falls_with_the_square_of_the_step() {
    let points = points();
    for (profile, j) in [
        (Profile::LemonBore { offset_m: 1.0, angle_rad: 0.4 }, 1),
        (Profile::OffsetBore { offset_m: 1.0, angle_rad: 0.4 }, 1),
        (Profile::EdgeRelief { depth_m: 1.0, length_share: 0.5 }, 1),
    ] {
        let sampled = profile.sample(&points);
        let remainder = |step: f64| {
            let mut c = profile.coefficients();
            c[j] += step;
            let mut off = profile.with_coefficients(&c).unwrap().sample(&points).gap_m;
            off.iter_mut().zip(&sampled.gap_m).for_each(|(o, g)| *o -= g);
            sampled.slopes[j].iter().for_each(|&(a, s)| off[a] -= step * s);
            off.iter().map(|o| o * o).sum::<f64>().sqrt()
        };
        let rate = (remainder(2e-4) / remainder(1e-4)).log2();
        assert!((1.9..2.1).contains(&rate), "{profile:?} {rate}");
    }
}

#[test]
fn names_and_refusals() {
    let names: Vec<Vec<String>> = all(&[0.5; 40]).iter().map(Profile::coefficient_names).collect();
    assert_eq!(names[0], ["offset", "angle"]);
    assert_eq!(names[4], ["depth", "length"]);
    assert_eq!(names[5][12], "coefficients[12]");
    assert_eq!(names[8], ["scale"]);
    for profile in all(&[0.5; 40]) {
        assert_eq!(profile.coefficient_names().len(), profile.coefficient_count());
        assert_eq!(profile.with_coefficients(&profile.coefficients()).unwrap(), profile);
        assert!(profile.with_coefficients(&vec![f64::NAN; profile.coefficient_count()]).is_err());
        assert!(profile.with_coefficients(&[]).is_err());
    }
    let relief = Profile::EdgeRelief { depth_m: 1e-5, length_share: 0.1 };
    let message = relief.with_coefficients(&[1e-5, 0.0]).unwrap_err().to_string();
    assert_eq!(
        message,
        "the length of the edge relief has to be above 0 and at most 1 (half the width), not 0"
    );
}

//! Masks conserve the area of their openings, are smooth, and refuse what cannot be.

use super::*;
use proptest::prelude::*;

fn every(a: f64, around: f64, z: f64, across: f64) -> [Opening; 4] {
    [
        Opening::CircumferentialGroove {
            centre_zeta: z,
            width_share: across,
            start_rad: a,
            extent_rad: around,
        },
        Opening::AxialGroove { angle_rad: a, extent_rad: around, length_share: across },
        Opening::Pocket { angle_rad: a, extent_rad: around, centre_zeta: z, width_share: across },
        Opening::Hole { angle_rad: a, centre_zeta: z, radius_rad: 0.5 * around, radius_zeta: across },
    ]
}

fn cells(n: usize, m: usize) -> (Vec<[f64; 2]>, [f64; 2]) {
    let blur = [TAU / n as f64, 2.0 / m as f64];
    let cell = |a: usize| [(a / m) as f64 * blur[0], ((a % m) as f64 + 0.5) * blur[1] - 1.0];
    ((0..n * m).map(cell).collect(), blur)
}

proptest! {
    #[test]
    fn the_mask_has_the_area_of_the_opening_however_small(
        a in -7.0f64..7.0, around in 0.001f64..6.25, at in -1.0f64..1.0, across in 0.01f64..1.0,
        n in 8usize..60, m in 2usize..12,
    ) {
        let (points, blur) = cells(n, m);
        for opening in every(a, around, at * (1.0 - across), across) {
            prop_assert!(opening.validate().is_ok());
            let mut out = vec![0.0; points.len()];
            covers(&[Feed { opening, on_journal: true }], &points, blur, 0.37, &mut out);
            let share = out.iter().sum::<f64>() / out.len() as f64;
            prop_assert!((share / opening.area_share() - 1.0).abs() < 1e-6, "{:?} {}", opening, share);
            prop_assert!(out.iter().all(|m| (0.0..=1.0).contains(m)));
        }
    }

    #[test]
    fn it_is_1_well_inside_and_0_well_outside(
        a in -7.0f64..7.0, x in -3.1f64..3.1, zeta in -1.0f64..1.0, z in -0.5f64..0.5,
    ) {
        let (around, across, blur) = (0.5, 0.3, [0.1, 0.08]);
        for opening in every(a, 2.0 * around, z, across) {
            let ([middle, _], [centre, _]) = opening.bounds();
            let m = opening.cover(middle + x, zeta, blur);
            let outside = x.abs() > around + blur[0] || (zeta - centre).abs() > across + blur[1];
            prop_assert!(!outside || m < 1e-14);
            let corner = matches!(opening, Opening::Hole { .. });
            let reach = ((x.abs() + 1.2 * blur[0]) / around).hypot(((zeta - centre).abs() + 1.2 * blur[1]) / across);
            let inside = x.abs() < around - blur[0] && (zeta - centre).abs() < across - blur[1];
            let inside = if corner { reach < 1.0 } else { inside };
            prop_assert!(!inside || m > 1.0 - 1e-14);
        }
    }

    #[test]
    fn it_turns_smoothly_with_the_journal(a in -7.0f64..7.0, phi in -7.0f64..7.0, zeta in -1.0f64..1.0) {
        let blur = [0.1, 0.2];
        for opening in every(a, 0.3, 0.1, 0.2) {
            let at = |angle: f64| {
                let mut out = [0.0];
                covers(&[Feed { opening, on_journal: true }], &[[phi, zeta]], blur, angle, &mut out);
                out[0]
            };
            let slope = |angle: f64| (at(angle + 1e-5) - at(angle - 1e-5)) / 2e-5;
            for k in 0..30 {
                let angle = 0.21 * f64::from(k);
                // Second derivatives are at most 1.5 / blur^2.
                let bend = (slope(angle + 1e-4) - slope(angle)) / 1e-4;
                prop_assert!(bend.abs() < 2.0 * 1.6 / (blur[0] * blur[0]), "{} {}", angle, bend);
            }
            prop_assert!((at(0.4) - at(0.4 + TAU)).abs() < 1e-12);
        }
    }
}

#[test]
fn openings_that_close_or_reach_the_edges_have_no_seam() {
    let (points, blur) = cells(24, 6);
    let full = every(1.0, TAU, 0.0, 1.0);
    assert!(points.iter().all(|p| full[..3].iter().all(|o| (o.cover(p[0], p[1], blur) - 1.0).abs() < 1e-14)));
    let around = Feed { opening: full[0], on_journal: true };
    let hole = Feed { opening: every(0.0, 0.2, 0.0, 0.2)[3], on_journal: false };
    assert!(!any_on_journal(&[around, hole]) && any_on_journal(&[Feed { on_journal: true, ..hole }]));
    assert!(all_symmetric(&[around, hole]) && !every(0.0, 0.2, 0.1, 0.2)[3].symmetric());
}

#[test]
fn feeds_combine_and_only_those_of_the_journal_turn() {
    let opening = every(0.0, 0.4, 0.0, 0.5)[2];
    let feeds = [Feed { opening, on_journal: false }, Feed { opening, on_journal: true }];
    let (mut out, points) = ([0.0; 3], [[0.0, 0.0], [2.0, 0.0], [0.2, 0.0]]);
    covers(&feeds, &points, [0.1; 2], 2.0, &mut out);
    let near = |out: [f64; 3], right: [f64; 3]| (0..3).all(|a| (out[a] - right[a]).abs() < 1e-12);
    assert!(near(out, [1.0, 1.0, 0.5]), "{out:?}");
    covers(&feeds, &points, [0.1; 2], 0.0, &mut out);
    assert!(near(out, [1.0, 0.0, 0.75]), "{out:?}");
    covers(&[], &points, [0.1; 2], 0.0, &mut out);
    assert_eq!(out, [0.0; 3]);
}

#[test]
fn openings_that_make_no_sense_are_refused() {
    let message = every(0.0, 0.2, 0.9, 0.25)[3].validate().unwrap_err().to_string();
    assert!(message.contains("beyond the edges of the bearing"), "{message}");
    for opening in every(0.0, 7.0, 0.0, 0.2).iter().chain(&every(f64::NAN, 1.0, 0.0, 0.2)) {
        assert!(opening.validate().is_err());
    }
    let message = every(0.0, 0.0, 0.0, 0.2)[1].validate().unwrap_err().to_string();
    assert_eq!(message, "the extent around has to be above 0 and at most a full turn, not 0");
}

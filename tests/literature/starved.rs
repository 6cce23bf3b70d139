//! Robustness of the steady mass-conserving film: cold starts from light to almost touching, well fed to starved.
//!
//! B/D = 0.5, pressure 0 at both edges, an opening at the widest gap. Converged means: fill within 0 to 1 and oil conserved
//! to 1e-10 of the side flow (or of what is dragged around where nothing flows out).

use crate::common::bearing;
use crate::common::films::{live_oil, touching};
use proptest::prelude::*;
use std::f64::consts::PI;
use stribeck::film::{
    Axial, Cavitation, CavityShear, Feed, FilmInput, FilmModel, Mesh, Oil, Opening, Reynolds, SteadyError,
    steady,
};

const ECCENTRICITIES: [f64; 5] = [0.1, 0.5, 0.9, 0.99, 0.999];
const MESHES: [(usize, usize); 4] = [(36, 5), (72, 9), (144, 17), (360, 41)];

/// Name, opening, supply pressure, cavitation pressure.
type Supply = (&'static str, Opening, f64, f64);

fn supplies() -> [Supply; 5] {
    let groove = Opening::AxialGroove { angle_rad: PI, extent_rad: 0.35, length_share: 0.8 };
    let hole = Opening::Hole { angle_rad: PI, centre_zeta: 0.0, radius_rad: 0.1, radius_zeta: 0.2 };
    [
        ("groove, 1e5 Pa", groove, 1e5, 0.0),
        ("groove, 1e5 Pa, cavitation at -0.9e5 Pa", groove, 1e5, -0.9e5),
        ("groove, 10 Pa", groove, 10.0, 0.0),
        ("small hole, 1e5 Pa", hole, 1e5, 0.0),
        ("small hole, 10 Pa", hole, 10.0, 0.0),
    ]
}

fn film((n_phi, n_z): (usize, usize), (_, opening, _, cavitation_pressure_pa): Supply) -> Reynolds {
    Reynolds {
        cavitation: Cavitation::MassConserving,
        cavity_shear: CavityShear::Fill,
        cavitation_pressure_pa,
        feeds: vec![Feed { opening, on_journal: false }],
        ..Reynolds::new(Mesh::new(n_phi, n_z, Axial::Half))
    }
}

/// Newton iterations, and the largest share of oil lost.
fn solve(film: &Reynolds, u: &FilmInput) -> Result<(usize, f64), SteadyError> {
    let state = steady(film, u)?;
    let fill = film.fill_map(&(*u).into(), &state.q);
    assert!(fill.iter().flatten().all(|f| (-1e-9..=1.0).contains(f)), "fill outside 0 to 1");
    let balance = film.mass_balance(&(*u).into(), &state.q, &state.rate);
    let dragged = u.speed_rad_s.abs() * u.diameter_m / 4.0 * u.width_m * u.clearance_m;
    Ok((state.iterations, balance.error.abs() / balance.side.abs().max(1e-6 * dragged)))
}

#[test]
fn steady_films_are_found_from_cold_starts() {
    let mut failed = Vec::new();
    for supply in supplies() {
        println!("{}: iterations over eccentricity {ECCENTRICITIES:?}", supply.0);
        for mesh in MESHES {
            let (film, mut line) = (film(mesh, supply), String::new());
            for eps in ECCENTRICITIES {
                let mut u = bearing(eps, 0.5, 100.0);
                u.supply_pressure_pa = supply.2;
                let begun = std::time::Instant::now();
                match solve(&film, &u) {
                    Ok((iterations, lost)) => {
                        line += &format!(" {iterations:5} ({lost:.0e}, {} ms)", begun.elapsed().as_millis());
                        if lost > 1e-10 {
                            failed.push(format!("{} {mesh:?} eps {eps}: {lost:.1e} lost", supply.0));
                        }
                    }
                    Err(e) => {
                        line += "  fails";
                        failed.push(format!("{} {mesh:?} eps {eps}: {e}", supply.0));
                    }
                }
            }
            println!("  {mesh:?}:{line}");
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A groove, a hole or a groove around, from four numbers of 0 to 1.
fn opening(kind: usize, x: [f64; 4]) -> Opening {
    let angle_rad = 2.0 * PI * x[0];
    let (extent_rad, length_share) = (0.05 + 0.5 * x[1], 0.1 + 0.85 * x[2]);
    match kind {
        0 => Opening::AxialGroove { angle_rad, extent_rad, length_share },
        1 => Opening::Hole {
            angle_rad,
            centre_zeta: 0.0,
            radius_rad: 0.02 + 0.1 * x[1],
            radius_zeta: 0.02 + 0.2 * x[2],
        },
        _ => Opening::CircumferentialGroove {
            centre_zeta: 0.0,
            width_share: 0.05 + 0.2 * x[1],
            start_rad: angle_rad,
            extent_rad: 2.0 * PI * (0.01 + 0.99 * x[3]),
        },
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn random_films_are_found(
        kind in 0usize..3, shape in prop::array::uniform4(0.0f64..1.0), log_gap in -3.0f64..0.0,
        mesh in 0usize..3, at in 0.0f64..6.3, width_m in 0.02f64..0.08, log_supply in 1.0f64..6.0,
        (deep, back, live, rough) in (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>()),
    ) {
        // An oil that stiffens with pressure has no steady film in gaps of a hundredth of the clearance and less.
        let eps = 1.0 - 10f64.powf(if live { log_gap / 3.0 } else { log_gap });
        let cavitation_pressure_pa = if deep { -0.9e5 } else { 0.0 };
        let film = Reynolds {
            oil: if live { live_oil() } else { Oil::plain() },
            rough: rough.then(touching),
            ..film(MESHES[mesh], ("", opening(kind, shape), 0.0, cavitation_pressure_pa))
        };
        let speed = if back { -100.0 } else { 100.0 };
        let mut u = FilmInput::at_rest(eps, width_m, 0.1, 50e-6, 0.01, speed);
        u.eccentricity_m = [at.cos(), at.sin()].map(|x| x * eps * u.clearance_m);
        (u.journal_roughness_m, u.shell_roughness_m) = (0.5e-6, 0.3e-6);
        u.supply_pressure_pa = 10f64.powf(log_supply);
        let (iterations, lost) = solve(&film, &u).unwrap();
        prop_assert!(iterations <= 400 && lost < 1e-9, "{} iterations, {:e} lost", iterations, lost);
    }
}

//! Periodic orbits: order in the time step, force balance, independence of the start of the cycle.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use stribeck::cranktrain::{
    BearingLoad, BearingOutput, BearingParameter, BearingSetup, JournalBearing, LoadTable,
};
use stribeck::dae::{At, Dae};
use stribeck::film::{
    Axial, Cavitation, CavityShear, Feed, FilmModel, Mesh, Oil, Opening, Reynolds, ShortFilm,
};
use stribeck::laws::Viscosity;
use stribeck::math::PeriodicSpline;
use stribeck::orbit::{Orbit, OrbitError, OrbitOptions, Quantity, Reduction, Scheme, settle};
use stribeck::run::Cancel;

const CYCLE: f64 = 2.0 * TAU;

/// A smooth load over two turns, begun at a share of the cycle, N.
fn load(begin: f64) -> BearingLoad {
    let knots: Vec<f64> = (0..360).map(|k| CYCLE * k as f64 / 360.0).collect();
    let angle = |a: &f64| a + begin * CYCLE;
    let x = knots.iter().map(|a| 8e3 + 3e3 * (angle(a) / 2.0).cos()).collect();
    let y = knots.iter().map(|a| 2e3 * angle(a).sin()).collect();
    BearingLoad::Table(LoadTable {
        x: PeriodicSpline::new(knots.clone(), x, CYCLE).unwrap(),
        y: PeriodicSpline::new(knots, y, CYCLE).unwrap(),
    })
}

fn model(film: Arc<dyn FilmModel>, load: BearingLoad, journal_mass_kg: f64) -> JournalBearing {
    let viscosity = Viscosity::Constant { viscosity_pa_s: 0.02 };
    JournalBearing::new(BearingSetup {
        speed_rad_s: 150.0,
        journal_mass_kg,
        width_m: 0.03,
        diameter_m: 0.06,
        diametral_clearance_m: 70e-6,
        parameters: vec![BearingParameter::Width, BearingParameter::DiametralClearance],
        ..BearingSetup::plain(film, Arc::new(load), viscosity)
    })
    .unwrap()
}

fn options(steps: usize, scheme: Scheme) -> OrbitOptions {
    OrbitOptions { steps, scheme, periodicity_tolerance: 1e-13, max_cycles: 200, memory_bytes: 1 << 30 }
}

fn solve(model: &JournalBearing, steps: usize, scheme: Scheme) -> Orbit {
    settle(model, &options(steps, scheme), None, &Cancel::default()).unwrap()
}

const LOSS: Quantity = Quantity { output: 0, reduction: Reduction::Mean };

#[test]
fn observed_order_in_the_step_is_that_of_the_formula() {
    // The short film is smooth in time: no cell enters or leaves a cavity.
    let film: Arc<dyn FilmModel> = Arc::new(ShortFilm::new(200.0));
    for (scheme, wanted) in [(Scheme::Bdf1, 1.0), (Scheme::Bdf2, 2.0)] {
        let bearing = model(film.clone(), load(0.0), 0.0);
        let loss = |steps| solve(&bearing, steps, scheme).value(&LOSS);
        let (a, b, c) = (loss(360), loss(720), loss(1440));
        let order = ((a - b) / (b - c)).abs().log2();
        assert!((order - wanted).abs() <= 0.1, "{scheme:?}: order {order} from {a} {b} {c}");
    }
}

#[test]
fn film_force_balances_the_load_at_every_step() {
    let films: [Arc<dyn FilmModel>; 2] =
        [Arc::new(ShortFilm::new(200.0)), Arc::new(Reynolds::new(Mesh::new(36, 4, Axial::Half)))];
    for film in films {
        let bearing = model(film, load(0.0), 0.0);
        let orbit = solve(&bearing, 360, Scheme::Bdf2);
        let (rates, mut r) = (orbit.rates(&bearing), vec![0.0; bearing.states()]);
        for (n, rate) in rates.iter().enumerate() {
            bearing.residual(At { t_s: orbit.time_s(n), z: orbit.state(n), rate }, &mut r);
            let [x, y] = bearing.drive(orbit.time_s(n)).load_n;
            let force = &r[bearing.film().unknowns()..];
            assert!(force[0].hypot(force[1]) < 1e-10 * x.hypot(y), "step {n}: {force:?}");
        }
    }
}

#[test]
fn the_orbit_does_not_depend_on_where_the_cycle_starts() {
    let film: Arc<dyn FilmModel> = Arc::new(ShortFilm::new(200.0));
    let first = solve(&model(film.clone(), load(0.0), 0.0), 360, Scheme::Bdf2);
    let later = solve(&model(film, load(0.25), 0.0), 360, Scheme::Bdf2);
    for output in BearingOutput::ALL {
        for n in 0..360 {
            let (a, b) = (first.outputs[(n + 90) % 360][output.index()], later.outputs[n][output.index()]);
            assert!((a - b).abs() <= 1e-8 * a.abs().max(b.abs()), "{output:?} at {n}: {a} {b}");
        }
    }
}

#[test]
fn a_journal_with_mass_settles_and_a_light_one_moves_like_a_massless_one() {
    let film: Arc<dyn FilmModel> = Arc::new(Reynolds::new(Mesh::new(36, 4, Axial::Half)));
    let loss = |mass| solve(&model(film.clone(), load(0.0), mass), 360, Scheme::Bdf2).value(&LOSS);
    let (none, light, heavy) = (loss(0.0), loss(0.01), loss(20.0));
    assert!((light / none - 1.0).abs() < 1e-4, "{none} {light}");
    assert!((heavy / none - 1.0).abs() > 1e-6, "{none} {heavy}");
}

#[test]
fn a_warm_start_gives_the_same_cycle_with_less_work() {
    let bearing = model(Arc::new(Reynolds::new(Mesh::new(36, 4, Axial::Half))), load(0.0), 0.0);
    let cold = solve(&bearing, 360, Scheme::Bdf2);
    let near = bearing.with_parameters(&[0.0301, 70.2e-6]).unwrap();
    let warm = settle(&near, &options(360, Scheme::Bdf2), Some(&cold), &Cancel::default()).unwrap();
    let fresh = solve(&near, 360, Scheme::Bdf2);
    assert!((warm.value(&LOSS) / fresh.value(&LOSS) - 1.0).abs() < 1e-9);
    assert!(warm.cost.newton_iterations < fresh.cost.newton_iterations, "{:?} {:?}", warm.cost, fresh.cost);
    assert_eq!(warm.cost.simulations, 1);
}

#[test]
fn endings_are_told_apart() {
    let bearing = model(Arc::new(ShortFilm::new(200.0)), load(0.0), 0.0);
    let impatient = OrbitOptions { max_cycles: 1, ..options(360, Scheme::Bdf2) };
    let end = settle(&bearing, &impatient, None, &Cancel::default());
    assert!(matches!(end, Err(OrbitError::NotPeriodic { cycles: 1, .. })));
    let cancel = Cancel::default();
    cancel.cancel();
    let end = settle(&bearing, &options(360, Scheme::Bdf2), None, &cancel);
    assert!(matches!(end, Err(OrbitError::Cancelled(_))));
    assert!(bearing.with_parameters(&[-1.0, 70e-6]).is_err());
}

#[test]
fn a_free_mass_moves_straight_in_the_frame_at_rest() {
    // Seen from a shell that turns (connecting rod), a point at rest outside circles: its Coriolis, Euler and centrifugal terms
    // must cancel. The bearing's residual less film force and load is mass times absolute acceleration.
    let pressure = stribeck::cranktrain::CylinderPressure::from_table(
        (0..72).map(|k| CYCLE * f64::from(k) / 72.0).collect(),
        vec![2e5; 72],
    )
    .unwrap();
    let cylinder = stribeck::cranktrain::Cylinder {
        crank: stribeck::cranktrain::SliderCrank { throw_m: 0.1, rod_m: 0.3, offset_m: 0.0 },
        bore_m: 0.1,
        oscillating_mass_kg: 5.0,
        rotating_mass_kg: 5.0,
        crankcase_pressure_pa: 1e5,
        pressure: Arc::new(pressure),
    };
    let mass = 40.0;
    let bearing = model(Arc::new(ShortFilm::new(200.0)), BearingLoad::BigEnd(cylinder.clone()), mass);
    let (fixed, omega) = ([2e-5, -1e-5], 150.0);
    // Position in the turning frame at a time, by turning the fixed point back by the angle of the rod.
    let seen = |t: f64| {
        let (s, c) = cylinder.crank.at(t * omega).rod_rad[0].sin_cos();
        [c * fixed[0] + s * fixed[1], -s * fixed[0] + c * fixed[1]]
    };
    for t in [0.003, 0.011, 0.02] {
        let h = 1e-6;
        let (a, b, d) = (seen(t - h), seen(t), seen(t + h));
        let velocity = [0, 1].map(|k| (d[k] - a[k]) / (2.0 * h));
        let acceleration = [0, 1].map(|k| (d[k] - 2.0 * b[k] + a[k]) / (h * h));
        let z = [b[0], b[1], velocity[0], velocity[1]];
        let rate = [velocity[0], velocity[1], acceleration[0], acceleration[1]];
        let mut with = vec![0.0; 4];
        bearing.residual(At { t_s: t, z: &z, rate: &rate }, &mut with);
        // The same instant for a journal without mass tells film force and load.
        let light = model(Arc::new(ShortFilm::new(200.0)), BearingLoad::BigEnd(cylinder.clone()), 0.0);
        let mut forces = vec![0.0; 2];
        light.residual(At { t_s: t, z: &z[..2], rate: &rate[..2] }, &mut forces);
        let size = mass * acceleration[0].hypot(acceleration[1]);
        for k in 0..2 {
            assert!((with[k]).abs() < 1e-12, "velocity is the rate of the position");
            let inertia = with[2 + k] + forces[k];
            assert!(inertia.abs() < 1e-3 * size, "{inertia} of {size} at {t}");
        }
    }
}

#[test]
fn oil_is_conserved_at_every_step_and_over_the_cycle() {
    // Mass conserving, a groove at ambient pressure plus 1e5 Pa, cavitation 8e4 Pa below; plain oil and one that follows
    // pressure and shear.
    let groove = Opening::AxialGroove { angle_rad: PI, extent_rad: 0.4, length_share: 0.6 };
    for oil in [Oil::plain(), crate::common::films::live_oil()] {
        let film = Reynolds {
            cavitation: Cavitation::MassConserving,
            cavity_shear: CavityShear::Fill,
            cavitation_pressure_pa: -8e4,
            feeds: vec![Feed { opening: groove, on_journal: false }],
            oil,
            ..Reynolds::new(Mesh::new(36, 4, Axial::Half))
        };
        let mut setup = model(Arc::new(film.clone()), load(0.0), 0.0).setup().clone();
        setup.supply_pressure_pa = 1e5;
        let bearing = JournalBearing::new(setup).unwrap();
        let orbit = solve(&bearing, 360, Scheme::Bdf2);
        let (mut supply, mut side, mut void) = (0.0, 0.0, 0);
        for (n, rate) in orbit.rates(&bearing).iter().enumerate() {
            let (z, mut room) = (orbit.state(n), Vec::new());
            let at = At { t_s: orbit.time_s(n), z, rate };
            let site = bearing.film_site(at, &mut room);
            let q = bearing.film_unknowns(z);
            let balance = film.mass_balance(&site, q, bearing.content_rate(rate));
            let flow = balance.side.abs().max(balance.stored.abs());
            assert!(balance.error.abs() <= 1e-10 * flow, "step {n}: {balance:?}");
            (supply, side) = (supply + balance.supply, side + balance.side);
            void += q.iter().filter(|q| **q < 0.0).count();
        }
        println!("{:?} supply {supply} side {side} void {void}", orbit.cost);
        assert!(void > 0 && (supply / side - 1.0).abs() < 1e-9, "{supply} {side}");
    }
}

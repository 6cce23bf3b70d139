//! A driven pendulum as a point on a circle, with both its constraints (Gear, Gupta and Leimkuhler 1985): index 2, nonlinear.
//!
//! ```text
//! x' = u + x mu     m u' = -c u - x lambda + f cos(w t)      x^2 + y^2 = l^2
//! y' = v + y mu     m v' = -c v - y lambda - m g             x u + y v = 0
//! ```
//!
//! The same pendulum in its angle has no constraint; both must tell the same powers as the steps shrink.

use super::{MEANS, gradient, ladder, options};
use stribeck::dae::{Dense, Equations, Instant, Number, Sizes};
use stribeck::gradient::{EngineName, check_ladder, taylor_table, verdict};
use stribeck::orbit::{OrbitOptions, Quantity, Reduction, settle};
use stribeck::run::Cancel;

const GRAVITY_M_S2: f64 = 9.81;
const DRIVE_RAD_S: f64 = 5.0;
/// Mass kg, length m, damping kg/s, force N.
const AT: [f64; 4] = [1.2, 0.5, 0.9, 4.0];

#[derive(Clone)]
struct OnCircle;

impl Equations for OnCircle {
    fn sizes(&self) -> Sizes {
        Sizes { states: 6, memories: 4, outputs: 3 }
    }

    fn period_s(&self) -> f64 {
        std::f64::consts::TAU / DRIVE_RAD_S
    }

    fn state_scale(&self) -> Vec<f64> {
        vec![0.5, 0.5, 1.0, 1.0, 20.0, 1.0]
    }

    fn cold_start(&self, p: &[f64]) -> Vec<f64> {
        vec![0.0, -p[1], 0.0, 0.0, p[0] * GRAVITY_M_S2 / p[1], 0.0]
    }

    fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]) {
        let ([x, y, u, v, _, _], [], [mass, _, _, _]) = at.parts();
        memory.copy_from_slice(&[x, y, mass * u, mass * v]);
    }

    fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]) {
        let ([x, y, u, v, lambda, mu], [dx, dy, force_x, force_y], [mass, length, damping, drive]) =
            at.parts();
        residual[0] = dx - u - x * mu;
        residual[1] = dy - v - y * mu;
        residual[2] = force_x + damping * u + x * lambda - drive * (DRIVE_RAD_S * at.t_s).cos();
        residual[3] = force_y + damping * v + y * lambda + mass * GRAVITY_M_S2;
        residual[4] = x * x + y * y - length * length;
        residual[5] = x * u + y * v;
    }

    /// Power that the damper takes, force in the rod, square of the force of inertia.
    fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]) {
        let ([_, _, u, v, lambda, _], [_, _, force_x, force_y], [_, length, damping, _]) = at.parts();
        output.copy_from_slice(&[
            damping * (u * u + v * v),
            lambda * length,
            force_x * force_x + force_y * force_y,
        ]);
    }
}

/// The same pendulum in its angle.
#[derive(Clone)]
struct InAngle;

impl Equations for InAngle {
    fn sizes(&self) -> Sizes {
        Sizes { states: 2, memories: 2, outputs: 3 }
    }

    fn period_s(&self) -> f64 {
        OnCircle.period_s()
    }

    fn state_scale(&self) -> Vec<f64> {
        vec![1.0, 3.0]
    }

    fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]) {
        memory.copy_from_slice(at.z);
    }

    fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]) {
        let ([angle, speed], [turning, acceleration], [mass, length, damping, drive]) = at.parts();
        let push = drive * (DRIVE_RAD_S * at.t_s).cos() * angle.cos();
        residual[0] = turning - speed;
        residual[1] =
            length * (mass * acceleration + damping * speed) + mass * angle.sin() * GRAVITY_M_S2 - push;
    }

    fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]) {
        let ([angle, speed], [_, acceleration], [mass, length, damping, drive]) = at.parts();
        let push = drive * (DRIVE_RAD_S * at.t_s).cos() * angle.sin();
        let rod = mass * (length * speed * speed + angle.cos() * GRAVITY_M_S2) + push;
        let inertia = (mass * length).powi(2) * (acceleration.powi(2) + speed.powi(4));
        output.copy_from_slice(&[damping * length * length * speed * speed, rod, inertia]);
    }
}

/// Mean power, largest force in the rod, mean square of the force of inertia.
const OF: [Quantity; 3] = [
    MEANS[0],
    Quantity { output: 1, reduction: Reduction::SmoothMax(30.0) },
    Quantity { output: 2, reduction: Reduction::Mean },
];

/// Largest difference of two gradients, each entry relative to its quantity and parameter.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>], values: &[f64]) -> f64 {
    let entry = |q: usize, j: usize| ((a[q][j] - b[q][j]) * AT[j] / values[q]).abs();
    (0..12).map(|k| entry(k / 4, k % 4)).fold(0.0, f64::max)
}

#[test]
fn a_pendulum_with_constraints_has_exact_gradients() {
    let model = Dense::new(OnCircle, &AT).unwrap();
    let cancel = Cancel::default();
    let orbit = settle(&model, &options(), None, &cancel).unwrap();
    let largest = orbit.states.iter().fold(0.0f64, |a, z| a.max(z[0].abs()));
    println!("cycles {} corrections {} x {largest} of {}", orbit.cycles, orbit.corrections, AT[1]);
    println!("{:?}", orbit.cost);
    assert!(largest > 0.6 * AT[1], "it swings far from linear: {largest}");
    let values: Vec<f64> = OF.iter().map(|q| orbit.value(q)).collect();
    let adj = gradient(EngineName::Adj, &model, &orbit, &options(), &OF);
    for (name, allowed) in
        [(EngineName::Tra, 1e-11), (EngineName::Cen, 1e-7), (EngineName::Fw, 1e-3), (EngineName::Bw, 1e-3)]
    {
        let other = gradient(name, &model, &orbit, &options(), &OF);
        let miss = apart(&other.rows, &adj.rows, &values);
        println!("{name:?}: {miss:.1e}");
        assert!(miss < allowed, "{name:?}: {miss:.1e}");
    }
    let along = [0.5, -1.0, 0.7, 0.9];
    let checks = taylor_table(&model, &orbit, &options(), &OF, &adj, &along, (1e-3, 5), &cancel).unwrap();
    for check in &checks {
        println!("{}", verdict(check));
        assert!(verdict(check).starts_with("exact: the remainder falls"), "{check:#?}");
    }
    ladder::assert_sound("pendulum", &check_ladder(&model, &orbit).unwrap());
}

#[test]
fn a_pendulum_with_constraints_is_the_one_in_its_angle() {
    let far = |steps: usize| {
        let options = OrbitOptions { steps, ..options() };
        let of = |orbit: &stribeck::orbit::Orbit| OF.map(|q| orbit.value(&q));
        let circle = Dense::new(OnCircle, &AT).unwrap();
        let angle = Dense::new(InAngle, &AT).unwrap();
        let a = settle(&circle, &options, None, &Cancel::default()).unwrap();
        let b = settle(&angle, &options, None, &Cancel::default()).unwrap();
        let slopes = apart(
            &gradient(EngineName::Adj, &circle, &a, &options, &OF).rows,
            &gradient(EngineName::Adj, &angle, &b, &options, &OF).rows,
            &of(&b),
        );
        let miss = |q: usize| (of(&a)[q] / of(&b)[q] - 1.0).abs();
        [miss(0), miss(1), miss(2), slopes]
    };
    let (coarse, fine) = (far(200), far(400));
    for k in 0..4 {
        let order = (coarse[k] / fine[k]).log2();
        println!("{:.2e} {:.2e}: order {order:.2}", coarse[k], fine[k]);
        assert!((order - 2.0).abs() < 0.2 && fine[k] < 1e-2, "{coarse:?} {fine:?}");
    }
}

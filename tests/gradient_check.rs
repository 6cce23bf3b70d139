//! The check of a gradient says what is there: an exact gradient, a kink, noise, a wrong gradient.
//!
//! A model of one state with kinks of known place and size, written by hand; then bearings.

use crate::common::{COARSE, main_study, quietly};
use std::f64::consts::TAU;
use stribeck::dae::{At, Cotangent, Dae, Direction, InvalidParameters, LinearisedDae, SensitiveDae, Step};
use stribeck::gradient::{
    Adjoint, CheckPlan, Finding, GradientCheck, GradientEngine, GradientTable, Transient, check_gradient,
    check_tables,
};
use stribeck::math::Singular;
use stribeck::orbit::{OrbitOptions, Quantity, Reduction, Scheme, settle};
use stribeck::run::Cancel;
use stribeck::study::prove;

const STEPS: usize = 24;
const PERIOD_S: f64 = 1.0;

/// `z' + a (z - cos t) = 0` with outputs that show a smooth quantity, a kink at `b = knee`, and two steps that share the
/// largest value at `b = 1`.
#[derive(Clone)]
struct Follower {
    p: Vec<f64>,
    knee: f64,
    /// Size of a ripple in `b` that stands for rounding.
    ripple: f64,
}

impl Follower {
    fn new(knee: f64) -> Self {
        Self { p: vec![2.0, 1.0], knee, ripple: 0.0 }
    }

    fn bend(&self) -> f64 {
        if self.p[1] >= self.knee { 1.0 } else { -1.0 }
    }

    fn step(t_s: f64) -> usize {
        (t_s / PERIOD_S * STEPS as f64).round() as usize % STEPS
    }
}

impl Dae for Follower {
    fn states(&self) -> usize {
        1
    }
    fn memories(&self) -> usize {
        1
    }
    fn parameters(&self) -> &[f64] {
        &self.p
    }
    fn period_s(&self) -> f64 {
        PERIOD_S
    }
    fn outputs(&self) -> usize {
        3
    }
    fn cold_start(&self) -> Vec<f64> {
        vec![0.0]
    }
    fn memory(&self, _: f64, z: &[f64], m: &mut [f64]) {
        m[0] = z[0];
    }
    fn residual(&self, at: At, residual: &mut [f64]) {
        residual[0] = at.rate[0] + self.p[0] * (at.z[0] - (TAU * at.t_s / PERIOD_S).cos());
    }
    fn output(&self, at: At, y: &mut [f64]) {
        let (b, n) = (self.p[1], Self::step(at.t_s));
        y[0] = 1.0 + at.z[0] * at.z[0] * b * b + self.ripple * (1e15 * b).sin();
        y[1] = 2.0 + at.z[0] * at.z[0] + 0.5 * (b - self.knee).abs();
        y[2] = if n == 3 {
            b
        } else if n == 9 {
            2.0 - b
        } else {
            0.0
        };
    }
    fn change(&self, _: &[f64], dz: &[f64]) -> f64 {
        dz[0].abs()
    }
    fn memory_change(&self, dm: &[f64]) -> f64 {
        dm[0].abs()
    }
    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters> {
        Ok(Self { p: p.to_vec(), ..self.clone() })
    }
}

impl LinearisedDae for Follower {
    type Factors = f64;
    type Room = ();
    fn factors(&self) -> f64 {
        1.0
    }
    fn factor_bytes(&self) -> usize {
        8
    }
    fn room(&self) {}
    fn linearise(
        &self,
        s: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        _: &mut (),
        into: &mut f64,
    ) -> Result<(), Singular> {
        memory[0] = s.z[0];
        let rate = [s.alpha * s.z[0] + s.past[0]];
        self.residual(At { t_s: s.t_s, z: s.z, rate: &rate }, residual);
        *into = self.p[0] + s.alpha;
        Ok(())
    }
    fn solve(&self, factors: &f64, rhs: &mut [f64]) {
        rhs.iter_mut().for_each(|r| *r /= factors);
    }
    fn rate_times(&self, _: &f64, rate: &[f64], out: &mut [f64]) {
        out[0] += rate[0];
    }
    fn memory_times(&self, _: &f64, dz: &[f64], dm: &mut [f64]) {
        dm[0] += dz[0];
    }
}

impl SensitiveDae for Follower {
    type Point = ();
    fn point(&self) {}
    fn fix(&self, _: At, _: &mut ()) {}
    fn factor(&self, _: At, alpha: f64, _: &mut (), into: &mut f64) -> Result<(), Singular> {
        *into = self.p[0] + alpha;
        Ok(())
    }
    fn solve_transposed(&self, factors: &f64, rhs: &mut [f64]) {
        self.solve(factors, rhs);
    }
    fn rate_cotangent(&self, _: &f64, v: &[f64], rate: &mut [f64]) {
        rate[0] += v[0];
    }
    fn memory_cotangent(&self, _: &f64, w: &[f64], z: &mut [f64]) {
        z[0] += w[0];
    }
    fn push(&self, (): &(), at: At, du: &[f64], residual: &mut [f64], memory: &mut [f64]) {
        residual[0] = du[0] * (at.z[0] - (TAU * at.t_s / PERIOD_S).cos());
        memory[0] = 0.0;
    }
    fn pull(&self, (): &(), at: At, v: &[f64], _: &[f64], u: &mut [f64]) {
        u[0] += v[0] * (at.z[0] - (TAU * at.t_s / PERIOD_S).cos());
    }
    fn output_tangent(&self, (): &(), at: At, d: Direction, dy: &mut [f64]) {
        let (z, b) = (at.z[0], self.p[1]);
        dy[0] = 2.0 * z * b * b * d.z[0] + 2.0 * z * z * b * d.u[1];
        dy[1] = 2.0 * z * d.z[0] + 0.5 * self.bend() * d.u[1];
        dy[2] = [0.0, 1.0, -1.0][slot(at.t_s)] * d.u[1];
    }
    fn output_cotangent(&self, (): &(), at: At, w: &[f64], out: Cotangent) {
        let (z, b) = (at.z[0], self.p[1]);
        out.z[0] += w[0] * 2.0 * z * b * b + w[1] * 2.0 * z;
        out.u[1] += w[0] * 2.0 * z * z * b + w[1] * 0.5 * self.bend() + w[2] * [0.0, 1.0, -1.0][slot(at.t_s)];
    }
}

/// Which of the two steps of the third output this is, or none.
fn slot(t_s: f64) -> usize {
    match Follower::step(t_s) {
        3 => 1,
        9 => 2,
        _ => 0,
    }
}

const OPTIONS: OrbitOptions = OrbitOptions {
    steps: STEPS,
    scheme: Scheme::Bdf2,
    periodicity_tolerance: 1e-13,
    max_cycles: 200,
    memory_bytes: 1 << 20,
};

/// The check of three quantities, after `change` had its way with the gradient.
fn checked(model: &Follower, change: impl Fn(&mut GradientTable)) -> GradientCheck {
    let cancel = Cancel::default();
    let orbit = settle(model, &OPTIONS, None, &cancel).unwrap();
    let mean = |output| Quantity { output, reduction: Reduction::Mean };
    let quantities = vec![mean(0), mean(1), Quantity { output: 2, reduction: Reduction::Max }];
    let plan = CheckPlan::usual(quantities, vec!["lag".to_owned(), "gain".to_owned()]);
    let table = |engine: &dyn GradientEngine<Follower>| {
        let mut table = engine.gradient(model, &orbit, &OPTIONS, &plan.quantities, &cancel).unwrap();
        change(&mut table);
        table
    };
    let tables = (table(&Adjoint), table(&Transient));
    check_tables(model, &orbit, &OPTIONS, &plan, tables, &cancel).unwrap()
}

fn finding(check: &GradientCheck, quantity: usize) -> (Finding, &str) {
    let verdict = &check.quantities[quantity].verdict;
    (verdict.finding, &verdict.words)
}

#[test]
fn a_smooth_quantity_is_exact_and_kinks_are_named() {
    let check = checked(&Follower::new(1.0), |_| ());
    let (found, words) = finding(&check, 0);
    assert_eq!(found, Finding::Exact, "{words}");
    assert!(words.contains("TRA = ADJ") && words.contains("CEN meets them"), "{words}");
    for quantity in [1, 2] {
        let (found, words) = finding(&check, quantity);
        assert_eq!(found, Finding::Kink, "{words}");
        assert!(
            words.contains("from 1e-3 to 1e-8, most by gain; ADJ is closer to the forward side"),
            "{words}"
        );
        let [ahead, behind, expected] = check.quantities[quantity].slopes;
        assert!((ahead - behind).abs() > 0.5 * expected.abs(), "one-sided slopes {ahead} and {behind}");
    }
    assert_eq!(check.quantities[0].verdict.parameter, None);
    assert_eq!(check.quantities[2].verdict.parameter, Some(1));
}

#[test]
fn a_kink_at_a_distance_leaves_the_gradient_exact_and_the_large_perturbations_off() {
    let distance = 3e-5;
    let check = checked(&Follower::new(1.0 + distance), |_| ());
    let (found, words) = finding(&check, 1);
    assert_eq!(found, Finding::Exact, "{words}");
    for (step, errors) in check.steps.iter().zip(&check.quantities[1].errors) {
        let central = errors.unwrap()[2];
        assert_eq!(central > 1e-2, step.perturbation > distance, "{:e}: {central:e}", step.perturbation);
    }
    // Nearer than the finest perturbation and the finest step, it is a kink at the point for all that can be seen.
    let check = checked(&Follower::new(1.0 + 1e-10), |_| ());
    assert_eq!(finding(&check, 1).0, Finding::Kink);
}

#[test]
fn a_falsified_gradient_is_called_wrong() {
    for (entry, factor) in [(0, 1.01), (1, 0.5), (1, -1.0), (1, 1.0 + 2e-4)] {
        let check = checked(&Follower::new(0.0), |table| table.rows[0][entry] *= factor);
        let (found, words) = finding(&check, 0);
        assert_eq!(found, Finding::Wrong, "{entry}, {factor}: {words}");
        assert!(words.contains(["lag", "gain"][entry]), "{words}");
        assert_eq!(finding(&check, 1).0, Finding::Exact, "the other quantities are not falsified");
    }
    let model = Follower::new(0.0);
    let once = std::cell::Cell::new(true);
    let check = checked(&model, |table| {
        if once.replace(false) {
            table.rows[0][1] *= 1.0 + 1e-6;
        }
    });
    let (found, words) = finding(&check, 0);
    assert!(found == Finding::Wrong && words.contains("TRA and ADJ differ by 1e-6"), "{words}");
}

#[test]
fn rounding_that_hides_the_differences_is_called_noise() {
    let check = checked(&Follower { ripple: 1e-4, ..Follower::new(0.0) }, |_| ());
    let (found, words) = finding(&check, 0);
    assert_eq!(found, Finding::Noisy, "{words}");
}

#[test]
fn differences_that_fail_are_told_and_the_rest_decides() {
    let model = Follower::new(0.0);
    let cancel = Cancel::default();
    let orbit = settle(&model, &OPTIONS, None, &cancel).unwrap();
    let quantities = vec![Quantity { output: 0, reduction: Reduction::Mean }];
    let usual = CheckPlan::usual(quantities, Vec::new());
    let none = CheckPlan { perturbations: Vec::new(), direction: vec![1.0, 1.0], ..usual.clone() };
    let check = check_gradient(&model, &orbit, &OPTIONS, &none, &cancel).unwrap();
    assert_eq!(finding(&check, 0).0, Finding::Exact);
    assert!(check.steps.is_empty() && check.quantities[0].errors.is_empty());
    cancel.cancel();
    assert!(check_gradient(&model, &orbit, &OPTIONS, &usual, &cancel).is_err());
}

#[test]
fn the_main_study_is_proven_with_its_weakly_active_cells_counted() {
    let study = main_study(&[("[oil]", COARSE)]);
    let proven = quietly(|run| prove(&study, &[1e-4, 1e-5, 1e-6, 1e-7], run)).unwrap();
    assert_eq!(proven.len(), 1);
    for q in &proven[0].quantities {
        println!("{}: {}", q.quantity, q.verdict);
        assert!(q.mismatch <= 1e-9, "{}: {}", q.quantity, q.verdict);
        assert!(matches!(q.finding, Finding::Exact | Finding::Kink), "{}: {}", q.quantity, q.verdict);
    }
}

//! The products of a ladder against each other: what a hand-written [`SensitiveDae`] gets wrong shows up by name.
//!
//! ```text
//! A = F_z + alpha F_m' M_z           <v, A^-1 b> = <A^-T v, b>,   <v, F_u du> + <w, M_u du> = <pull(v, w), du>, ...
//! A dz, M_z dz, F_m' dm', F_p dp, M_p dp, dg        against central differences of residual, memory and output
//! ```
//!
//! Checked at a few points of a settled cycle, in directions of order one in the model's own units. Differences take the
//! best of several widths. At a kink of a piecewise smooth model they may miss where the products are right; transposes
//! never do. Deliberately not here: the orbit as a whole (see [`super::taylor_table`]).

mod probe;

use super::GradientError;
use crate::dae::{At, CycleEquations, Dae, SensitiveDae};
use crate::orbit::Orbit;
use probe::{Probe, best, differences, raise, shifted};

/// Points of the cycle that are looked at.
const POINTS: usize = 5;
/// What rounding may leave of an identity.
const ROUNDING: f64 = 1e-9;
/// What rounding and truncation may leave of a difference.
const DIFFERENCE: f64 = 1e-5;

/// Two ways to the same numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LadderRow {
    /// The product in question, by its name in the ladder.
    pub product: &'static str,
    /// What it was held against.
    pub against: &'static str,
    /// Largest difference between the two, relative to their size in an order-one direction.
    pub mismatch: f64,
    /// What rounding (identities) or truncation (differences) may leave.
    pub allowed: f64,
}

impl LadderRow {
    /// Whether the two agree.
    pub fn holds(&self) -> bool {
        self.mismatch <= self.allowed
    }
}

/// Holds the products of a model against each other at a settled cycle of it: [`LadderRow::holds`] of every row if the ladder is
/// sound. Costs some dozens of evaluations per parameter.
///
/// # Errors
///
/// If the model does not exist at the parameters of the cycle or a step matrix is singular there.
pub fn check_ladder<M: SensitiveDae>(model: &M, at: &Orbit) -> Result<Vec<LadderRow>, GradientError> {
    let model = at.model(model)?;
    let (rates, mut report) = (at.rates(&model), Report::default());
    for k in 0..POINTS.min(at.steps()) {
        let n = k * at.steps() / POINTS;
        let here = At { t_s: at.time_s(n), z: at.state(n), rate: &rates[n] };
        let alpha = at.scheme.rates(at.dt_s)[0];
        let mut probe = Probe::new(&model, here, alpha, k);
        probe.linearised(&mut report)?;
        probe.by_states(&mut report);
        probe.solves(&mut report);
        probe.by_parameters(&mut report);
        probe.outputs(&mut report);
    }
    if let Some(equations) = model.cycle() {
        let means: Vec<f64> = equations.outputs().iter().map(|&o| at.mean(o)).collect();
        cycle(&model, equations, &means, &mut report);
    }
    Ok(report.0)
}

/// The worst of every comparison so far.
#[derive(Default)]
struct Report(Vec<LadderRow>);

impl Report {
    fn add(&mut self, product: &'static str, against: &'static str, mismatch: f64, allowed: f64) {
        // What is no number is as wrong as can be.
        let mismatch = if mismatch.is_nan() { f64::INFINITY } else { mismatch };
        match self.0.iter_mut().find(|r| r.product == product && r.against == against) {
            Some(row) => row.mismatch = row.mismatch.max(mismatch),
            None => self.0.push(LadderRow { product, against, mismatch, allowed }),
        }
    }

    /// `<v, y> = <w, x>` for `y = A x` and `w = A^T v`.
    fn transposed(&mut self, product: &'static str, against: &'static str, left: &[Pair], right: &[Pair]) {
        let (mut sum, mut size) = (0.0, 0.0);
        for (pairs, sign) in [(left, 1.0), (right, -1.0)] {
            for (a, b) in pairs.iter().flat_map(|(a, b)| a.iter().zip(b.iter())) {
                sum += sign * a * b;
                size += (a * b).abs();
            }
        }
        self.add(product, against, if sum == 0.0 { 0.0 } else { sum.abs() / size }, ROUNDING);
    }
}

/// Two vectors whose scalar product is meant.
type Pair<'a> = (&'a [f64], &'a [f64]);

/// Slopes of the equations of the cycle unknowns against differences.
fn cycle(model: &impl Dae, equations: &dyn CycleEquations, means: &[f64], report: &mut Report) {
    let p = model.parameters();
    let (by_mean, by_p) = equations.slopes(means, p);
    let mut size = vec![0.0; equations.unknowns()];
    let parts = [("residual along means", means, by_mean), ("residual along parameters", p, by_p)];
    for (against, x, slopes) in parts {
        for j in 0..x.len() {
            let mut dx = vec![0.0; x.len()];
            dx[j] = if x[j] == 0.0 { 1.0 } else { x[j].abs() };
            let along = |h: f64| {
                let there = shifted(x, h, &dx);
                let along_means = against == "residual along means";
                Some(if along_means {
                    equations.residual(&there, p)
                } else {
                    equations.residual(means, &there)
                })
            };
            let all: Vec<Vec<f64>> = differences(along).collect();
            all.iter().for_each(|v| raise(&mut size, v));
            let product: Vec<f64> = slopes.iter().map(|row| row[j] * dx[j]).collect();
            report.add("cycle slopes", against, best(&all, &product, &size), DIFFERENCE);
        }
    }
}

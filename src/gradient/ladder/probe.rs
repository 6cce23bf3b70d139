//! One point of a cycle, directions of order one there, and what a model says along them.
//!
//! The sizes of what these directions do to residual, memory and outputs are learned on the way: rows in newtons and rows in
//! cubic metres a second then count alike. Deliberately not here: which comparisons make a sound ladder.

use super::{DIFFERENCE, Pair, ROUNDING, Report};
use crate::dae::{At, Cotangent, Direction, SensitiveDae, Step};
use crate::gradient::GradientError;

/// Half widths of the differences, relative to a direction of order one.
const WIDTHS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];

/// Numbers between 0.5 and 1 in size, of both signs, always the same.
fn numbers(seed: usize, count: usize) -> Vec<f64> {
    let golden = 0.618_033_988_749_895;
    let number = |i: usize| {
        let x = ((seed * 97 + i + 1) as f64 * golden).fract();
        if x < 0.5 { -0.5 - x } else { x }
    };
    (0..count).map(number).collect()
}

/// Weights of order one for entries of the given sizes.
fn weights(seed: usize, size: &[f64]) -> Vec<f64> {
    let weigh = |(r, size): (f64, &f64)| if *size == 0.0 { r } else { r / size };
    numbers(seed, size.len()).into_iter().zip(size).map(weigh).collect()
}

/// `(f(h) - f(-h)) / 2h` for each width at which both exist.
pub(super) fn differences<'a>(
    f: impl Fn(f64) -> Option<Vec<f64>> + 'a,
) -> impl Iterator<Item = Vec<f64>> + 'a {
    WIDTHS.into_iter().filter_map(move |h| {
        let (plus, minus) = (f(h)?, f(-h)?);
        Some(plus.iter().zip(&minus).map(|(a, b)| (a - b) / (2.0 * h)).collect())
    })
}

/// The least of the mismatches at all widths: the largest difference of an entry relative to its size.
pub(super) fn best(all: &[Vec<f64>], product: &[f64], size: &[f64]) -> f64 {
    let miss = |v: &Vec<f64>| {
        let entries = v.iter().zip(product).zip(size);
        entries.fold(0.0, |worst: f64, ((a, b), s)| match a == b {
            true => worst,
            false if (a - b).is_nan() => f64::INFINITY,
            false => worst.max((a - b).abs() / s),
        })
    };
    all.iter().map(miss).fold(f64::INFINITY, f64::min)
}

/// Raises sizes to those of more values.
pub(super) fn raise(size: &mut [f64], values: &[f64]) {
    size.iter_mut().zip(values).for_each(|(s, v)| *s = s.max(v.abs()));
}

pub(super) fn shifted(x: &[f64], by: f64, dx: &[f64]) -> Vec<f64> {
    x.iter().zip(dx).map(|(x, d)| x + by * d).collect()
}

/// A direction whose every entry is of order one where `change` judges.
fn order_one(seed: usize, count: usize, change: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let mut unit = vec![0.0; count];
    let mut direction = numbers(seed, count);
    for (i, d) in direction.iter_mut().enumerate() {
        unit[i] = 1.0;
        let size = change(&unit);
        unit[i] = 0.0;
        // An entry that nothing judges stays at rest.
        *d = if size > 0.0 { *d / size } else { 0.0 };
    }
    direction
}

/// One point of a cycle with directions and what the model keeps there.
pub(super) struct Probe<'a, M: SensitiveDae> {
    model: &'a M,
    at: At<'a>,
    alpha: f64,
    seed: usize,
    dz: Vec<f64>,
    drate: Vec<f64>,
    factors: M::Factors,
    point: M::Point,
    /// Sizes of what order-one directions do.
    residual_size: Vec<f64>,
    memory_size: Vec<f64>,
    /// Differences of the residual along `dz`, its memory and rate included.
    along: Vec<Vec<f64>>,
}

impl<'a, M: SensitiveDae> Probe<'a, M> {
    pub fn new(model: &'a M, at: At<'a>, alpha: f64, seed: usize) -> Self {
        let dz = order_one(3 * seed, model.states(), |dz| model.change(at.z, dz));
        // A memory that changes by order one over a radian of the period.
        let per_s = std::f64::consts::TAU / model.period_s();
        let dm = order_one(3 * seed + 1, model.memories(), |dm| model.memory_change(dm));
        let mut point = model.point();
        model.fix(at, &mut point);
        Self {
            model,
            at,
            alpha,
            seed,
            dz,
            drate: dm.iter().map(|d| per_s * d).collect(),
            factors: model.factors(),
            point,
            residual_size: vec![0.0; model.states()],
            memory_size: vec![0.0; model.memories()],
            along: Vec::new(),
        }
    }

    fn memory(&self, model: &M, z: &[f64]) -> Vec<f64> {
        let mut memory = vec![0.0; model.memories()];
        model.memory(self.at.t_s, z, &mut memory);
        memory
    }

    fn residual(&self, model: &M, z: &[f64], rate: &[f64]) -> Vec<f64> {
        let mut residual = vec![0.0; model.states()];
        model.residual(At { z, rate, ..self.at }, &mut residual);
        residual
    }

    fn output(&self, model: &M, z: &[f64], rate: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; model.outputs()];
        model.output(At { z, rate, ..self.at }, &mut y);
        y
    }

    /// The state moved along `dz`, if the model is defined there.
    fn moved(&self, h: f64) -> Option<Vec<f64>> {
        Some(shifted(self.at.z, h, &self.dz)).filter(|z| self.model.contains(z))
    }

    /// Factorises, and holds what a linearisation says against the evaluation.
    pub fn linearised(&mut self, report: &mut Report) -> Result<(), GradientError> {
        let (model, at, alpha) = (self.model, self.at, self.alpha);
        let (memory, residual) = (self.memory(model, at.z), self.residual(model, at.z, at.rate));
        let past: Vec<f64> = at.rate.iter().zip(&memory).map(|(r, m)| r - alpha * m).collect();
        let (mut m, mut r) = (vec![0.0; model.memories()], vec![0.0; model.states()]);
        let (mut room, mut stepped) = (model.room(), model.factors());
        let step = Step { t_s: at.t_s, z: at.z, alpha, past: &past };
        model.linearise(step, &mut m, &mut r, &mut room, &mut stepped)?;
        model.factor(at, alpha, &mut room, &mut self.factors)?;
        // Sizes first: a residual at a settled step is nothing but rounding.
        self.go_along(&memory);
        raise(&mut self.memory_size, &memory);
        report.add("linearise", "residual", best(&[residual], &r, &self.residual_size), ROUNDING);
        report.add("linearise", "memory", best(&[memory], &m, &self.memory_size), ROUNDING);
        if let Some(b) = self.along.last() {
            let (mut x, mut y) = (b.clone(), b.clone());
            model.solve(&stepped, &mut x);
            model.solve(&self.factors, &mut y);
            let apart: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x - y).collect();
            report.add("factor", "linearise", model.change(at.z, &apart), ROUNDING);
        }
        Ok(())
    }

    /// Differences of the residual along `dz`, the rate following as in a step.
    fn go_along(&mut self, memory: &[f64]) {
        let along = |h: f64| {
            let z = self.moved(h)?;
            let there = self.memory(self.model, &z);
            let moved = there.iter().zip(memory).zip(self.at.rate);
            let rate: Vec<f64> = moved.map(|((new, old), rate)| rate + self.alpha * (new - old)).collect();
            Some(self.residual(self.model, &z, &rate))
        };
        self.along = differences(along).collect();
        self.along.iter().for_each(|v| raise(&mut self.residual_size, v));
    }

    /// Products with `M_z`, `A`, `F_m'` against differences.
    pub fn by_states(&mut self, report: &mut Report) {
        let (model, at) = (self.model, self.at);
        let memories: Vec<Vec<f64>> = differences(|h| Some(self.memory(model, &self.moved(h)?))).collect();
        let mut dm = vec![0.0; model.memories()];
        model.memory_times(&self.factors, &self.dz, &mut dm);
        memories.iter().for_each(|v| raise(&mut self.memory_size, v));
        report.add("memory_times", "memory", best(&memories, &dm, &self.memory_size), DIFFERENCE);
        let solved = |b: &Vec<f64>| {
            let mut x = b.clone();
            model.solve(&self.factors, &mut x);
            let apart: Vec<f64> = x.iter().zip(&self.dz).map(|(x, d)| x - d).collect();
            model.change(at.z, &apart)
        };
        let miss = self.along.iter().map(solved).fold(f64::INFINITY, f64::min);
        report.add("solve", "residual", miss, DIFFERENCE);
        let by_rate = |h: f64| Some(self.residual(model, at.z, &shifted(at.rate, h, &self.drate)));
        let all: Vec<Vec<f64>> = differences(by_rate).collect();
        let mut out = vec![0.0; model.states()];
        model.rate_times(&self.factors, &self.drate, &mut out);
        all.iter().for_each(|v| raise(&mut self.residual_size, v));
        report.add("rate_times", "residual", best(&all, &out, &self.residual_size), DIFFERENCE);
    }

    /// Transposed products with `A^-1`, `F_m'`, `M_z`.
    pub fn solves(&self, report: &mut Report) {
        let (model, factors) = (self.model, &self.factors);
        let (n, m) = (model.states(), model.memories());
        if let Some(b) = self.along.last() {
            let mut x = b.clone();
            model.solve(factors, &mut x);
            let v = weights(self.seed, &self.dz);
            let mut y = v.clone();
            model.solve_transposed(factors, &mut y);
            report.transposed("solve_transposed", "solve", &[(&v, &x)], &[(&y, b)]);
        }
        let (mut out, mut back) = (vec![0.0; n], vec![0.0; m]);
        model.rate_times(factors, &self.drate, &mut out);
        let v = weights(self.seed, &self.residual_size);
        model.rate_cotangent(factors, &v, &mut back);
        report.transposed("rate_cotangent", "rate_times", &[(&v, &out)], &[(&back, &self.drate)]);
        let (mut dm, mut back) = (vec![0.0; m], vec![0.0; n]);
        model.memory_times(factors, &self.dz, &mut dm);
        let w = weights(self.seed, &self.memory_size);
        model.memory_cotangent(factors, &w, &mut back);
        report.transposed("memory_cotangent", "memory_times", &[(&w, &dm)], &[(&back, &self.dz)]);
    }

    /// The model at parameters moved along `dp`, where it exists.
    fn other(&self, h: f64, dp: &[f64]) -> Option<M> {
        self.model.with_parameters(&shifted(self.model.parameters(), h, dp)).ok()
    }

    /// A direction of all parameters, and the fields along it.
    fn parameter_direction(&self) -> (Vec<f64>, Vec<f64>) {
        let (model, count) = (self.model, self.model.parameters().len());
        let r = numbers(3 * self.seed + 2, count);
        let dp: Vec<f64> = (0..count).map(|j| r[j] * model.parameter_scale(j)).collect();
        let mut du = vec![0.0; model.fields()];
        model.field_tangent(&dp, &mut du);
        (dp, du)
    }

    /// `F_p` and `M_p` against differences, one parameter after the other, and their transposes.
    pub fn by_parameters(&mut self, report: &mut Report) {
        let (model, at, count) = (self.model, self.at, self.model.parameters().len());
        for j in 0..count {
            let mut dp = vec![0.0; count];
            dp[j] = model.parameter_scale(j);
            let (mut du, mut r) = (vec![0.0; model.fields()], vec![0.0; model.states()]);
            let mut m = vec![0.0; model.memories()];
            model.field_tangent(&dp, &mut du);
            model.push(&self.point, at, &du, &mut r, &mut m);
            let residuals: Vec<Vec<f64>> =
                differences(|h| Some(self.residual(&self.other(h, &dp)?, at.z, at.rate))).collect();
            let memories: Vec<Vec<f64>> =
                differences(|h| Some(self.memory(&self.other(h, &dp)?, at.z))).collect();
            residuals.iter().for_each(|v| raise(&mut self.residual_size, v));
            memories.iter().for_each(|v| raise(&mut self.memory_size, v));
            report.add("push", "residual", best(&residuals, &r, &self.residual_size), DIFFERENCE);
            report.add("push", "memory", best(&memories, &m, &self.memory_size), DIFFERENCE);
        }
        self.transposed_parameters(report);
    }

    fn transposed_parameters(&self, report: &mut Report) {
        let (model, at) = (self.model, self.at);
        let (dp, du) = self.parameter_direction();
        let (mut r, mut m) = (vec![0.0; model.states()], vec![0.0; model.memories()]);
        model.push(&self.point, at, &du, &mut r, &mut m);
        let (v, w) = (weights(self.seed, &self.residual_size), weights(self.seed + 1, &self.memory_size));
        let mut u = vec![0.0; model.fields()];
        model.pull(&self.point, at, &v, &w, &mut u);
        report.transposed("pull", "push", &[(&v, &r), (&w, &m)], &[(&u, &du)]);
        let (u, mut p) = (weights(self.seed, &du), vec![0.0; dp.len()]);
        model.field_cotangent(&u, &mut p);
        report.transposed("field_cotangent", "field_tangent", &[(&u, &du)], &[(&p, &dp)]);
    }

    /// Derivatives of the outputs by states, rates and parameters against differences, and their transposes.
    pub fn outputs(&self, report: &mut Report) {
        let (model, at) = (self.model, self.at);
        let (dp, du) = self.parameter_direction();
        let none = (vec![0.0; self.dz.len()], vec![0.0; self.drate.len()], vec![0.0; du.len()]);
        let mut size = self.output(model, at.z, at.rate);
        size.iter_mut().for_each(|s| *s = s.abs());
        let mut compare = |against, all: Vec<Vec<f64>>, direction: Direction| {
            let mut dy = vec![0.0; model.outputs()];
            model.output_tangent(&self.point, at, direction, &mut dy);
            all.iter().for_each(|v| raise(&mut size, v));
            report.add("output_tangent", against, best(&all, &dy, &size), DIFFERENCE);
        };
        let by_state = differences(|h| Some(self.output(model, &self.moved(h)?, at.rate))).collect();
        compare("output along states", by_state, Direction { z: &self.dz, rate: &none.1, u: &none.2 });
        let turned = |h: f64| Some(self.output(model, at.z, &shifted(at.rate, h, &self.drate)));
        let by_rate = differences(turned).collect();
        compare("output along rates", by_rate, Direction { z: &none.0, rate: &self.drate, u: &none.2 });
        let by_parameter = differences(|h| Some(self.output(&self.other(h, &dp)?, at.z, at.rate))).collect();
        compare("output along parameters", by_parameter, Direction { z: &none.0, rate: &none.1, u: &du });
        self.transposed_outputs(&du, &size, report);
    }

    fn transposed_outputs(&self, du: &[f64], size: &[f64], report: &mut Report) {
        let (model, w) = (self.model, weights(self.seed, size));
        let (mut dy, direction) =
            (vec![0.0; model.outputs()], Direction { z: &self.dz, rate: &self.drate, u: du });
        model.output_tangent(&self.point, self.at, direction, &mut dy);
        let (mut z, mut rate, mut u) =
            (vec![0.0; self.dz.len()], vec![0.0; self.drate.len()], vec![0.0; du.len()]);
        let out = Cotangent { z: &mut z, rate: &mut rate, u: &mut u };
        model.output_cotangent(&self.point, self.at, &w, out);
        let back: [Pair; 3] = [(&z, &self.dz), (&rate, &self.drate), (&u, du)];
        report.transposed("output_cotangent", "output_tangent", &[(&w, &dy)], &back);
    }
}

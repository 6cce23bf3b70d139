//! One implicit step: Newton's method on `F(t_n, z_n, m'_n) = 0`.
//!
//! The step is damped only as far as the model needs to stay defined. If Newton fails from the guess, the way from the
//! last state to the new one is walked in short implicit Euler steps to find a better one; the equation that is solved in
//! the end stays the same, so the result does not depend on how it was found. Where even that does not help, the march goes on
//! from the walked state; a cycle counts as settled only if every step of it solves its own equation.

use super::Scheme;
use crate::dae::{LinearisedDae, Step};
use crate::run::Cost;

/// A change below this ends the iteration; convergence is quadratic, so the error left is about its square.
const TOLERANCE: f64 = 1e-8;
/// A full step below this is followed by chord steps (the factors stay, only the residual is new) until one is below the second:
/// each leaves of the error before it a share of the size of that full step.
const CHORD: f64 = 1e-4;
const CHORD_TOLERANCE: f64 = 1e-10;
/// A chord step longer than this share of the step before it is no gain over a full one.
const CHORD_GAIN: f64 = 1e-2;
/// Iterations of one attempt.
const MOST_ITERATIONS: usize = 40;
/// Full steps before damping may set in.
const FREE: usize = 6;
/// A step that is not shorter than this share of the one before makes no progress.
const PROGRESS: f64 = 0.7;
/// Shortest share of a step that is taken.
const SHORTEST: f64 = 1.0 / 16.0;
/// Implicit Euler steps of the rescue, fewest and most.
const SHORT_STEPS: [usize; 3] = [8, 64, 512];

/// Workspace and counters of a march.
pub(super) struct Stepper<'m, M: LinearisedDae> {
    model: &'m M,
    /// Factors of the last iteration.
    pub factors: M::Factors,
    room: M::Room,
    residual: Vec<f64>,
    /// Memory of the last iteration.
    memory: Vec<f64>,
    past: Vec<f64>,
    pub cost: Cost,
}

/// How a step was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Taken {
    /// Its equation is solved.
    Solved,
    /// The state was reached in short steps of another formula: good enough to march on, no part of a settled cycle.
    Walked,
}

/// What a step starts from.
#[derive(Clone, Copy)]
pub(super) struct From<'a> {
    /// State of the step before.
    pub z: &'a [f64],
    /// Memory of the step before.
    pub last: &'a [f64],
    /// Memory of the step before that.
    pub before: &'a [f64],
}

impl<'m, M: LinearisedDae> Stepper<'m, M> {
    pub fn new(model: &'m M) -> Self {
        Self {
            model,
            factors: model.factors(),
            room: model.room(),
            residual: vec![0.0; model.states()],
            memory: vec![0.0; model.memories()],
            past: vec![0.0; model.memories()],
            cost: Cost::default(),
        }
    }

    /// Solves the step to `t_s` from the guess in `z`; `None` if neither the step nor a walk in short steps converged.
    pub fn step(&mut self, scheme: Scheme, dt_s: f64, t_s: f64, z: &mut [f64], from: From) -> Option<Taken> {
        self.cost.steps += 1;
        self.remember(scheme, dt_s, from);
        let alpha = scheme.rates(dt_s)[0];
        if self.newton(alpha, t_s, z) {
            return Some(Taken::Solved);
        }
        z.copy_from_slice(from.z);
        if self.newton(alpha, t_s, z) {
            return Some(Taken::Solved);
        }
        z.copy_from_slice(from.z);
        if self.rescued(alpha, t_s, z) {
            return Some(Taken::Solved);
        }
        for count in SHORT_STEPS {
            if self.walk(dt_s, count, t_s, z, from) {
                let walked = z.to_vec();
                self.remember(scheme, dt_s, from);
                if self.newton(alpha, t_s, z) {
                    return Some(Taken::Solved);
                }
                z.copy_from_slice(&walked);
                if self.rescued(alpha, t_s, z) {
                    return Some(Taken::Solved);
                }
                z.copy_from_slice(&walked);
                return Some(Taken::Walked);
            }
        }
        None
    }

    /// Share of the older memories in the rate.
    fn remember(&mut self, scheme: Scheme, dt_s: f64, from: From) {
        let a = scheme.rates(dt_s);
        for ((past, last), before) in self.past.iter_mut().zip(from.last).zip(from.before) {
            *past = a[1] * last + a[2] * before;
        }
    }

    /// Short implicit Euler steps from `t_s - dt` to `t_s`.
    fn walk(&mut self, dt_s: f64, count: usize, t_s: f64, z: &mut [f64], from: From) -> bool {
        let short = dt_s / count as f64;
        let mut memory = from.last.to_vec();
        z.copy_from_slice(from.z);
        for k in 1..=count {
            let t = t_s - dt_s + k as f64 * short;
            self.remember(Scheme::Bdf1, short, From { z: from.z, last: &memory, before: &memory });
            let before = z.to_vec();
            if !self.newton(1.0 / short, t, z) {
                z.copy_from_slice(&before);
                if !self.rescued(1.0 / short, t, z) {
                    return false;
                }
            }
            self.model.memory(t, z, &mut memory);
        }
        true
    }

    /// Newton's method from the model's own guess.
    fn rescued(&mut self, alpha: f64, t_s: f64, z: &mut [f64]) -> bool {
        let guess = z.to_vec();
        let step = Step { t_s, z: &guess, alpha, past: &self.past };
        // A guess that fell short is often good enough.
        self.model.rescue(step, z);
        self.newton(alpha, t_s, z)
    }

    fn newton(&mut self, alpha: f64, t_s: f64, z: &mut [f64]) -> bool {
        let mut damping = Damping::new();
        for _ in 0..MOST_ITERATIONS {
            let step = Step { t_s, z, alpha, past: &self.past };
            let (memory, residual) = (&mut self.memory, &mut self.residual);
            let found = self.model.newton(step, memory, residual, &mut self.room, &mut self.factors);
            if found.is_err() {
                return false;
            }
            self.cost.newton_iterations += 1;
            self.cost.factorisations += 1;
            self.cost.solves += 1;
            let Some((share, change)) = self.update(z, |change| damping.share(change)) else {
                return false;
            };
            if share == 1.0 && (change < TOLERANCE || (change < CHORD && self.chords(alpha, t_s, z, change)))
            {
                return true;
            }
        }
        false
    }

    /// Chord steps behind a full step of a given size; whether they end below their tolerance.
    fn chords(&mut self, alpha: f64, t_s: f64, z: &mut [f64], mut last: f64) -> bool {
        loop {
            let step = Step { t_s, z, alpha, past: &self.past };
            self.model.balance(step, &mut self.memory, &mut self.residual, &mut self.room);
            self.model.solve(&self.factors, &mut self.residual);
            self.cost.newton_iterations += 1;
            self.cost.solves += 1;
            match self.update(z, |_| 1.0) {
                Some((1.0, change)) if change < CHORD_TOLERANCE => return true,
                Some((1.0, change)) if change < CHORD_GAIN * last => last = change,
                _ => return false,
            }
        }
    }

    /// Takes what stands in the residual's place off the state, as far as the model and `share` allow; returns that share and the size
    /// of the whole change, or nothing if it is no number.
    fn update(&mut self, z: &mut [f64], share: impl FnOnce(f64) -> f64) -> Option<(f64, f64)> {
        self.residual.iter_mut().for_each(|v| *v = -*v);
        let change = self.model.change(z, &self.residual);
        if !change.is_finite() {
            return None;
        }
        let share = share(change).min(self.model.admissible(z, &self.residual));
        self.model.advance(z, &self.residual, share);
        Some((share, change))
    }
}

/// Shortens steps that make no progress: cells that change between full and void by turns (the active set going in circles)
/// come to rest when they move part of the way. Undamped as long as Newton's method converges by itself.
struct Damping {
    taken: usize,
    share: f64,
    last: f64,
}

impl Damping {
    fn new() -> Self {
        Self { taken: 0, share: 1.0, last: f64::INFINITY }
    }

    /// Share of a step of the given size.
    fn share(&mut self, change: f64) -> f64 {
        self.taken += 1;
        let stuck = self.taken > FREE && change > PROGRESS * self.last;
        self.share = if stuck { (self.share / 2.0).max(SHORTEST) } else { (self.share * 2.0).min(1.0) };
        self.last = change;
        self.share
    }
}

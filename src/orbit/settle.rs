//! Marching to the periodic orbit.

use super::step::Stepper;
use super::{Quantity, Scheme};
use crate::dae::{At, Dae, LinearisedDae};
use crate::run::{Cancel, Cancelled, Cost};
use thiserror::Error;

/// Steps between two looks at the cancel flag.
const CANCEL_EVERY: usize = 16;

/// How a cycle is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitOptions {
    /// Steps per period, at least 3.
    pub steps: usize,
    /// Difference formula.
    pub scheme: Scheme,
    /// Largest difference between two cycles, in the model's own units of change, that counts as settled.
    pub periodicity_tolerance: f64,
    /// Cycles after which settling is given up.
    pub max_cycles: usize,
}

/// Why there is no settled cycle.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OrbitError {
    /// Newton's method failed.
    #[error("the step at {at_share:.4} of cycle {cycle} did not converge; try more steps per cycle")]
    StepFailed {
        /// Position in the period, 0 to 1.
        at_share: f64,
        /// Cycle, counted from 1.
        cycle: usize,
    },
    /// The cycle keeps changing.
    #[error(
        "the orbit did not become periodic within {cycles} cycles: two cycles still differ by {residual:.2e}"
    )]
    NotPeriodic {
        /// Cycles marched.
        cycles: usize,
        /// Difference of the last two.
        residual: f64,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A settled cycle.
#[derive(Debug, Clone)]
pub struct Orbit {
    /// Difference formula.
    pub scheme: Scheme,
    /// Step length, s.
    pub dt_s: f64,
    /// States at `t = n dt`.
    pub states: Vec<Vec<f64>>,
    /// Outputs at the same times.
    pub outputs: Vec<Vec<f64>>,
    /// Difference between the last two passes where marching stopped.
    pub periodicity: f64,
    /// Cycles marched, a fraction.
    pub cycles: f64,
    /// Work done.
    pub cost: Cost,
}

impl Orbit {
    /// Number of steps per period.
    pub fn steps(&self) -> usize {
        self.states.len()
    }

    /// Time of step `n`.
    pub fn time_s(&self, n: usize) -> f64 {
        n as f64 * self.dt_s
    }

    /// State `back` steps before step `n`, around the cycle.
    pub fn state(&self, n: usize, back: usize) -> &[f64] {
        let count = self.states.len();
        &self.states[(n + count - back) % count]
    }

    /// Writes the rate at step `n`.
    pub fn rate(&self, model: &impl Dae, n: usize, rate: &mut [f64]) {
        let newest = [self.state(n, 0), self.state(n, 1), self.state(n, 2)];
        self.scheme.rate(model, self.dt_s, newest, rate);
    }

    /// Value of a quantity.
    pub fn value(&self, quantity: &Quantity) -> f64 {
        quantity.value(&self.outputs)
    }
}

/// Marches `model` until its cycle repeats, from a cold start or from the cycle of a similar model.
pub fn settle<M: LinearisedDae>(
    model: &M,
    options: &OrbitOptions,
    start: Option<&Orbit>,
    cancel: &Cancel,
) -> Result<Orbit, OrbitError> {
    let mut march = March::new(model, options, start);
    march.run(cancel)?;
    Ok(march.finish())
}

struct March<'m, M: LinearisedDae> {
    model: &'m M,
    options: OrbitOptions,
    dt_s: f64,
    stepper: Stepper<'m, M>,
    /// States of the pass in progress and, ahead of it, of the pass before (or of the similar model).
    states: Vec<Vec<f64>>,
    /// Whether `states` ahead of the march may serve as guesses.
    warm: bool,
    taken: usize,
    periodicity: f64,
}

impl<'m, M: LinearisedDae> March<'m, M> {
    fn new(model: &'m M, options: &OrbitOptions, start: Option<&Orbit>) -> Self {
        let dt_s = model.period_s() / options.steps as f64;
        let similar = start.filter(|o| o.steps() == options.steps && o.states[0].len() == model.states());
        let (states, warm) = match similar {
            Some(orbit) if orbit.states.iter().all(|z| model.contains(z)) => (orbit.states.clone(), true),
            _ => (vec![model.cold_start(); options.steps], false),
        };
        let stepper = Stepper::new(model, options.scheme, dt_s);
        Self { model, options: *options, dt_s, stepper, states, warm, taken: 0, periodicity: f64::INFINITY }
    }

    fn run(&mut self, cancel: &Cancel) -> Result<(), OrbitError> {
        let count = self.options.steps;
        let mut close = 0;
        while close < 2 {
            if self.taken.is_multiple_of(CANCEL_EVERY) {
                cancel.check()?;
            }
            if self.taken >= count * self.options.max_cycles {
                return Err(OrbitError::NotPeriodic {
                    cycles: self.options.max_cycles,
                    residual: self.periodicity,
                });
            }
            let difference = self.advance()?;
            // Only a full cycle has left every start behind.
            let settled = self.taken > count && difference <= self.options.periodicity_tolerance;
            close = if settled { close + 1 } else { 0 };
            self.periodicity = if close == 2 { self.periodicity.max(difference) } else { difference };
        }
        Ok(())
    }

    /// Takes one step and returns how far its result is from the state of the pass before.
    fn advance(&mut self) -> Result<f64, OrbitError> {
        let count = self.options.steps;
        let n = self.taken % count;
        let last = self.states[(n + count - 1) % count].clone();
        let before = self.states[(n + count - 2) % count].clone();
        let mut z = self.guess(n, &last, &before);
        let t_s = n as f64 * self.dt_s;
        self.stepper.step(t_s, &mut z, &last, &before).ok_or(OrbitError::StepFailed {
            at_share: n as f64 / count as f64,
            cycle: self.taken / count + 1,
        })?;
        let mut difference = vec![0.0; z.len()];
        for &i in self.model.memory() {
            difference[i] = z[i] - self.states[n][i];
        }
        let difference = self.model.change(&z, &difference);
        self.states[n] = z;
        self.taken += 1;
        Ok(difference)
    }

    /// The state of the pass before, or the last step continued.
    fn guess(&self, n: usize, last: &[f64], before: &[f64]) -> Vec<f64> {
        if self.warm || self.taken > self.options.steps {
            return self.states[n].clone();
        }
        let mut step = vec![0.0; last.len()];
        for &i in self.model.memory() {
            step[i] = last[i] - before[i];
        }
        let share = self.model.admissible(last, &step);
        last.iter().zip(&step).map(|(z, s)| z + share * s).collect()
    }

    fn finish(self) -> Orbit {
        let count = self.options.steps;
        let cost = Cost { simulations: 1, ..self.stepper.cost };
        let mut orbit = Orbit {
            scheme: self.options.scheme,
            dt_s: self.dt_s,
            states: self.states,
            outputs: Vec::with_capacity(count),
            periodicity: self.periodicity,
            cycles: self.taken as f64 / count as f64,
            cost,
        };
        let mut rate = vec![0.0; self.model.states()];
        for n in 0..count {
            orbit.rate(self.model, n, &mut rate);
            let mut y = vec![0.0; self.model.outputs()];
            self.model.output(At { t_s: orbit.time_s(n), z: &orbit.states[n], rate: &rate }, &mut y);
            orbit.outputs.push(y);
        }
        orbit
    }
}

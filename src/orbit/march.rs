//! Marching a model until its cycle repeats.

use super::accelerate::Accelerator;
use super::step::{From, Stepper, Taken};
use super::{Orbit, OrbitError, OrbitOptions, Recording};
use crate::dae::LinearisedDae;
use crate::run::{Cancel, Cost};

/// A pass before that was farther off than this, in units of change, is a worse guess than the last step continued.
const NEAR: f64 = 0.05;
/// Steps between two looks at the cancel flag.
const CANCEL_EVERY: usize = 16;

pub(super) struct March<'m, M: LinearisedDae> {
    pub model: &'m M,
    pub options: OrbitOptions,
    pub dt_s: f64,
    pub stepper: Stepper<'m, M>,
    /// States of the pass in progress and, ahead of it, of the pass before (or of the similar model).
    pub states: Vec<Vec<f64>>,
    /// Memories of the same passes.
    pub memories: Vec<Vec<f64>>,
    /// Memories of the last two steps, newest first: what the next step starts from.
    pub last: [Vec<f64>; 2],
    /// Memories of the same steps one pass earlier.
    pub replaced: [Vec<f64>; 2],
    /// How far the state that stood ahead of the last step was from its solution, in units of change: whether the states of
    /// the pass before (or of the similar model) are better guesses than the last step continued.
    off: f64,
    /// The state that stood for the last step before it was taken; empty if none did.
    stood: Vec<f64>,
    /// Room for the next guess, and for differences: the loop over the steps allocates nothing.
    next: Vec<f64>,
    change: Vec<f64>,
    pub taken: usize,
    /// Steps taken when the last one was walked instead of solved.
    walked: Option<usize>,
    accelerator: Accelerator<M>,
    recording: Recording,
    periodicity: f64,
}

impl<'m, M: LinearisedDae> March<'m, M> {
    pub fn new(model: &'m M, options: &OrbitOptions, start: Option<&Orbit>) -> Self {
        let (count, dt_s) = (options.steps, model.period_s() / options.steps as f64);
        let recording = Recording::of(model, options);
        let kept = |z: &Vec<f64>| z.is_empty() || model.contains(z);
        let similar = start.filter(|o| o.steps() == count && o.states[count - 1].len() == model.states());
        let (mut states, warm) = match similar {
            Some(orbit) if orbit.states.iter().all(kept) => (orbit.states.clone(), true),
            _ => (vec![model.cold_start(); count], false),
        };
        let dropped = (0..count).filter(|n| !recording.keeps(*n, count));
        dropped.for_each(|n| states[n] = Vec::new());
        let mut memories = vec![Vec::new(); count];
        for n in count - 2..count {
            memories[n] = vec![0.0; model.memories()];
            model.memory(n as f64 * dt_s, &states[n], &mut memories[n]);
        }
        let last = [memories[count - 1].clone(), memories[count - 2].clone()];
        Self {
            model,
            options: *options,
            dt_s,
            stepper: Stepper::new(model),
            states,
            replaced: last.clone(),
            last,
            memories,
            off: if warm { 0.0 } else { f64::INFINITY },
            stood: Vec::new(),
            next: Vec::new(),
            change: Vec::new(),
            taken: 0,
            walked: None,
            accelerator: Accelerator::new(recording),
            recording,
            periodicity: f64::INFINITY,
        }
    }

    pub fn run(&mut self, cancel: &Cancel) -> Result<(), OrbitError> {
        let count = self.options.steps;
        let mut close = 0;
        while close < 2 {
            if self.taken.is_multiple_of(CANCEL_EVERY) {
                cancel.check()?;
            }
            if self.taken >= count * self.options.max_cycles {
                return Err(self.unsettled());
            }
            let difference = match self.advance() {
                Ok(difference) => difference,
                Err(failed) if !self.take_back() => return Err(failed),
                Err(_) => continue,
            };
            // Only a full cycle has left every start behind.
            let solved = self.walked.is_none_or(|w| self.taken > w + count + 1);
            let whole = self.taken > count && self.accelerator.verified(self.taken + 1, count);
            let settled = whole && solved && difference <= self.options.periodicity_tolerance;
            close = if settled { close + 1 } else { 0 };
            self.periodicity = if close == 2 { self.periodicity.max(difference) } else { difference };
            if close == 0 {
                self.accelerate(difference);
            }
        }
        Ok(())
    }

    /// Why the cycles granted were not enough.
    fn unsettled(&self) -> OrbitError {
        match self.walked.filter(|w| self.taken <= w + self.options.steps) {
            Some(walked) => self.failed(walked - 1),
            None => OrbitError::NotPeriodic { cycles: self.options.max_cycles, residual: self.periodicity },
        }
    }

    fn failed(&self, step: usize) -> OrbitError {
        let count = self.options.steps;
        OrbitError::StepFailed { at_share: (step % count) as f64 / count as f64, cycle: step / count + 1 }
    }

    /// Takes one step and returns how far its memory is from that of the pass before.
    fn advance(&mut self) -> Result<f64, OrbitError> {
        let count = self.options.steps;
        let n = self.taken % count;
        let t_s = n as f64 * self.dt_s;
        let mut z = self.guess(n);
        let from =
            From { z: &self.states[(n + count - 1) % count], last: &self.last[0], before: &self.last[1] };
        let taken = self.stepper.step(self.options.scheme, self.dt_s, t_s, &mut z, from);
        let Some(taken) = taken else {
            self.next = z;
            return Err(self.failed(self.taken));
        };
        self.next = std::mem::replace(&mut self.stood, std::mem::replace(&mut self.states[n], z));
        self.off = self.distance(n);
        self.taken += 1;
        if taken == Taken::Walked {
            self.walked = Some(self.taken);
        }
        self.accelerator.record(self.model, n, taken, &mut self.stepper.factors);
        self.last.rotate_right(1);
        self.model.memory(t_s, &self.states[n], &mut self.last[0]);
        self.remember(n);
        let known = self.taken > count && !self.replaced[0].is_empty();
        Ok(if known { self.difference(0) } else { f64::INFINITY })
    }

    /// Replaces the memory of step `n` and drops what is not kept.
    fn remember(&mut self, n: usize) {
        let count = self.options.steps;
        self.replaced.rotate_right(1);
        std::mem::swap(&mut self.replaced[0], &mut self.memories[n]);
        if self.recording.keeps(n, count) {
            self.memories[n].clone_from(&self.last[0]);
        } else {
            self.memories[n] = Vec::new();
        }
        // The last two steps are the next one's past.
        let old = (n + count - 2) % count;
        if !self.recording.keeps(old, count) {
            self.states[old] = Vec::new();
        }
    }

    /// How far the memory of the last step (or the one before) is from that of the pass before.
    pub fn difference(&mut self, back: usize) -> f64 {
        self.change.clear();
        self.change.extend(self.last[back].iter().zip(&self.replaced[back]).map(|(a, b)| a - b));
        self.model.memory_change(&self.change)
    }

    /// Size of the change from the state that stood for step `n` to its solution.
    fn distance(&mut self, n: usize) -> f64 {
        if self.stood.is_empty() {
            return f64::INFINITY;
        }
        self.change_of(n);
        self.model.change(&self.states[n], &self.change)
    }

    /// Writes what the solution of step `n` changed of the state that stood for it.
    fn change_of(&mut self, n: usize) {
        self.change.clear();
        self.change.extend(self.states[n].iter().zip(&self.stood).map(|(z, old)| z - old));
    }

    /// States were changed by other means than a step: what the last step changed says nothing about the next.
    pub fn forget_move(&mut self) {
        self.stood.clear();
    }

    /// The state of the pass before, moved like the step before, or the last step continued.
    fn guess(&mut self, n: usize) -> Vec<f64> {
        let count = self.options.steps;
        let mut z = std::mem::take(&mut self.next);
        let last = (n + count - 1) % count;
        if self.off <= NEAR && !self.states[n].is_empty() {
            z.clone_from(&self.states[n]);
            if !self.stood.is_empty() {
                self.change_of(last);
                let share = self.model.admissible(&z, &self.change);
                self.model.advance(&mut z, &self.change, share);
            }
            return z;
        }
        z.clone_from(&self.states[last]);
        let before = &self.states[(n + count - 2) % count];
        if !before.is_empty() {
            self.model.predict(before, &mut z);
        }
        z
    }

    /// Corrects the start of the next pass where that pays.
    fn accelerate(&mut self, difference: f64) {
        let mut accelerator = std::mem::take(&mut self.accelerator);
        accelerator.consider(self, difference);
        self.accelerator = accelerator;
    }

    /// Goes back to where the last correction was made, if there was one.
    fn take_back(&mut self) -> bool {
        let mut accelerator = std::mem::take(&mut self.accelerator);
        let back = accelerator.take_back(self);
        self.accelerator = accelerator;
        back
    }

    /// The cycle with its outputs; a step that was dropped and cannot be solved again counts as failed.
    pub fn finish(self) -> Result<Orbit, OrbitError> {
        let count = self.options.steps;
        let mut orbit = Orbit {
            scheme: self.options.scheme,
            dt_s: self.dt_s,
            parameters: self.model.parameters().to_vec(),
            recording: self.recording,
            states: self.states,
            outputs: Vec::with_capacity(count),
            periodicity: self.periodicity,
            balance: 0.0,
            response: Vec::new(),
            cycles: self.taken as f64 / count as f64,
            corrections: self.accelerator.corrections,
            cost: Cost { simulations: 1, ..self.stepper.cost },
        };
        let mut keeps = (0..count).map(|n| self.recording.keeps(n, count));
        orbit.states.iter_mut().for_each(|z| {
            if !keeps.next().unwrap_or(true) {
                *z = Vec::new();
            }
        });
        let mut outputs = Vec::with_capacity(count);
        let shown = orbit.for_each(self.model, |_, at| {
            let mut y = vec![0.0; self.model.outputs()];
            self.model.output(at, &mut y);
            outputs.push(y);
        });
        if !shown {
            return Err(OrbitError::StepFailed { at_share: outputs.len() as f64 / count as f64, cycle: 1 });
        }
        orbit.outputs = outputs;
        Ok(orbit)
    }
}

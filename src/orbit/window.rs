//! What is recorded of a cycle, and some steps of it at a time: the states as they were solved, the rates of the memory.
//!
//! Everything a backward sweep needs follows from the states, so nothing else of the cycle is recorded. If even they do not fit the memory
//! granted, only the two states in front of every block of [`BLOCK`] steps are kept (checkpoints, one part in sixteen), and
//! a block is solved again, from them, whenever it is looked at: Newton's method brings back the same states to rounding.

use super::step::{From, Stepper};
use super::{Orbit, OrbitOptions};
use crate::dae::{At, LinearisedDae};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// Steps of a block.
pub(crate) const BLOCK: usize = 32;

/// How much of a cycle is kept in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Recording {
    /// States and, while they are of use, the factors of every step: no step is factorised twice. While a gradient is under
    /// way it keeps its adjoint states beside them, two more states per quantity.
    Factors,
    /// States: steps are factorised again in every sweep.
    States,
    /// Two states in front of every block of 32 steps: blocks are solved again when they are looked at.
    Checkpoints,
}

impl Recording {
    /// What fits.
    pub fn of<M: LinearisedDae>(model: &M, options: &OrbitOptions) -> Self {
        let fits = |recording: Self| options.steps * recording.bytes_per_step(model) <= options.memory_bytes;
        [Self::Factors, Self::States].into_iter().find(|r| fits(*r)).unwrap_or(Self::Checkpoints)
    }

    /// Memory per step, the factors of a block under way left out.
    pub fn bytes_per_step<M: LinearisedDae>(self, model: &M) -> usize {
        let state = model.states() * size_of::<f64>();
        match self {
            Self::Factors => state + model.factor_bytes(),
            Self::States => state,
            Self::Checkpoints => (2 * state).div_ceil(BLOCK),
        }
    }

    /// Whether the state of step `n` of `count` is kept.
    pub(super) fn keeps(self, n: usize, count: usize) -> bool {
        self != Self::Checkpoints || n % BLOCK >= BLOCK - 2 || n + 2 >= count
    }
}

/// Some consecutive steps of a settled cycle.
pub struct Window<'a> {
    orbit: &'a Orbit,
    steps: Range<usize>,
    states: Vec<Cow<'a, [f64]>>,
    rates: Vec<Vec<f64>>,
}

impl Window<'_> {
    /// The steps.
    pub fn steps(&self) -> Range<usize> {
        self.steps.clone()
    }

    /// Step `n`, one of [`Self::steps`].
    pub fn at(&self, n: usize) -> At<'_> {
        let k = n - self.steps.start;
        At { t_s: self.orbit.time_s(n), z: &self.states[k], rate: &self.rates[k] }
    }
}

impl Orbit {
    /// The blocks a cycle of `count` steps is looked at in.
    pub(crate) fn blocks(count: usize) -> impl DoubleEndedIterator<Item = Range<usize>> + ExactSizeIterator {
        (0..count.div_ceil(BLOCK)).map(move |k| k * BLOCK..((k + 1) * BLOCK).min(count))
    }

    /// A block of the cycle of `model`; `None` if it is not kept and cannot be solved again.
    pub fn window<M: LinearisedDae>(&self, model: &M, steps: Range<usize>) -> Option<Window<'_>> {
        let (count, a) = (self.steps(), self.scheme.rates(self.dt_s));
        let memory = |n: usize, z: &[f64]| {
            let mut m = vec![0.0; model.memories()];
            model.memory(self.time_s(n), z, &mut m);
            m
        };
        let back = |k: usize| (steps.start + count - k) % count;
        let mut last = [1, 2].map(|k| memory(back(k), &self.states[back(k)]));
        let mut states: Vec<Cow<'_, [f64]>> = Vec::with_capacity(steps.len());
        let mut rates = Vec::with_capacity(steps.len());
        let mut stepper: Option<Stepper<M>> = None;
        for n in steps.clone() {
            let z: Cow<'_, [f64]> = if !self.states[n].is_empty() {
                Cow::Borrowed(&self.states[n])
            } else {
                let earlier = |k: usize| match states.len().checked_sub(k) {
                    Some(i) => &*states[i],
                    None => &self.states[back(k - states.len())],
                };
                let (from, before) = (earlier(1), earlier(2));
                let mut z = from.to_vec();
                model.predict(before, &mut z);
                let start = From { z: from, last: &last[0], before: &last[1] };
                let stepper = stepper.get_or_insert_with(|| Stepper::new(model));
                stepper.step(self.scheme, self.dt_s, self.time_s(n), &mut z, start)?;
                Cow::Owned(z)
            };
            let now = memory(n, &z);
            rates.push(
                (0..now.len()).map(|i| a[0] * now[i] + a[1] * last[0][i] + a[2] * last[1][i]).collect(),
            );
            last.rotate_right(1);
            last[0] = now;
            states.push(z);
        }
        Some(Window { orbit: self, steps, states, rates })
    }

    /// Calls `visit` with every step of the cycle, in order; whether all could be shown.
    pub fn for_each<M: LinearisedDae>(&self, model: &M, mut visit: impl FnMut(usize, At)) -> bool {
        Self::blocks(self.steps()).all(|steps| match self.window(model, steps.clone()) {
            Some(window) => {
                steps.for_each(|n| visit(n, window.at(n)));
                true
            }
            None => false,
        })
    }

    /// Rates of the memory at all steps.
    pub fn rates<M: LinearisedDae>(&self, model: &M) -> Vec<Vec<f64>> {
        let mut rates = Vec::with_capacity(self.steps());
        self.for_each(model, |_, at| rates.push(at.rate.to_vec()));
        rates
    }
}

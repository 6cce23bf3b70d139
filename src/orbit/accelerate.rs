//! Newton's method on the period map, for cycles that marching alone would settle slowly.
//!
//! A period maps the memory `x` it starts from to the memory `G(x)` at its end. From one pass with kept factors, `G'` is
//! known by its action ([`super::carry`]), and the start of the next pass becomes
//!
//! ```text
//! x* = x + d,     (I - G') d = G(x) - x        by GMRES, to a share of the right-hand side
//! ```
//!
//! The states ahead are moved along, so the next pass needs few iterations. A correction is never a result: the cycle
//! counts as settled only after a whole pass that ends where it began. Where a pass from a corrected start fails or comes
//! no nearer, the march goes on from where it was.
//!
//! Most bearings forget all but a hundredth of their memory, or less, in a period: there marching is hard to beat. The
//! march therefore watches how fast passes draw together and corrects only if many more would be needed.

use super::Recording;
use super::carry::Carry;
use super::march::March;
use super::step::Taken;
use crate::dae::LinearisedDae;
use crate::math::fixed_points;

/// Share of the right-hand side that GMRES may leave.
const LEFT: f64 = 1e-4;
/// Sweeps of one correction.
const SWEEPS: usize = 24;
/// A pass that does not come nearer than this share of the pass before it is no progress.
const PROGRESS: f64 = 0.5;
/// Largest difference of two passes, in units of change, at which a correction is worth a try.
const NEAR: f64 = 0.3;
/// Passes that marching alone must still need, by its own pace, for factors to be kept; and for another correction. Keeping
/// them slows a pass down by half, a correction takes almost a pass, and another pass has to show that it was right.
const MANY: f64 = 3.5;
const SOME: f64 = 2.0;

/// What was before a correction.
struct Before {
    taken: usize,
    states: Vec<Vec<f64>>,
    memories: Vec<Vec<f64>>,
    last: [Vec<f64>; 2],
    replaced: [Vec<f64>; 2],
    difference: f64,
}

/// Keeps factors and corrects.
pub(super) struct Accelerator<M: LinearisedDae> {
    /// Factors of the last steps, by their place in the cycle; empty until wanted.
    factors: Vec<M::Factors>,
    /// Consecutive steps kept.
    kept: usize,
    allowed: bool,
    /// Difference at the first look, an eighth into the second pass.
    early: f64,
    /// What a pass of plain marching leaves of the difference.
    pace: f64,
    before: Option<Before>,
    pub corrections: usize,
}

impl<M: LinearisedDae> Default for Accelerator<M> {
    fn default() -> Self {
        Self {
            factors: Vec::new(),
            kept: 0,
            allowed: false,
            early: f64::INFINITY,
            pace: 0.0,
            before: None,
            corrections: 0,
        }
    }
}

impl<M: LinearisedDae> Accelerator<M> {
    pub fn new(recording: Recording) -> Self {
        Self { allowed: recording == Recording::Factors, ..Self::default() }
    }

    /// Whether a whole pass lies between the last correction and the step that will be the `taken`-th.
    pub fn verified(&self, taken: usize, count: usize) -> bool {
        self.before.as_ref().is_none_or(|b| taken >= b.taken + count)
    }

    /// Keeps the factors of step `n`.
    pub fn record(&mut self, model: &M, n: usize, taken: Taken, factors: &mut M::Factors) {
        if self.factors.is_empty() {
            return;
        }
        model.keep(factors, &mut self.factors[n]);
        self.kept = if taken == Taken::Solved { self.kept + 1 } else { 0 };
    }

    /// Starts keeping factors where settling is slow; corrects once a whole pass of them is there.
    pub fn consider(&mut self, march: &mut March<M>, difference: f64) {
        let count = march.options.steps;
        if march.taken == count + count / 8 {
            self.early = difference;
        }
        if !self.allowed || march.taken < 2 * count || !march.taken.is_multiple_of(count) {
            return;
        }
        let now = march.difference(0).max(march.difference(1));
        if self.factors.is_empty() {
            self.pace = if march.taken == 2 * count { now / self.early } else { self.pace };
            if self.passes_left(march, now) > MANY {
                self.factors = (0..count).map(|_| march.model.keeper()).collect();
            }
            return;
        }
        if self.before.as_ref().is_some_and(|b| now > PROGRESS * b.difference) {
            self.stop();
        } else if self.kept >= count && now <= NEAR && self.passes_left(march, now) > SOME {
            self.correct(march, now);
        }
    }

    /// Passes that marching alone would still need.
    fn passes_left(&self, march: &March<M>, difference: f64) -> f64 {
        let wanted = march.options.periodicity_tolerance / difference;
        if self.pace < 1.0 { (wanted.ln() / self.pace.ln()).max(0.0) } else { f64::INFINITY }
    }

    fn stop(&mut self) {
        *self = Self { corrections: self.corrections, ..Self::default() };
    }

    fn correct(&mut self, march: &mut March<M>, difference: f64) {
        let (count, m) = (march.options.steps, march.model.memories());
        let n = march.taken % count;
        let order = || (0..count).map(|k| (n + k) % count);
        let mut change = vec![0.0; 2 * m];
        for (back, part) in change.chunks_exact_mut(m).enumerate() {
            let pair = march.last[back].iter().zip(&march.replaced[back]);
            part.iter_mut().zip(pair).for_each(|(d, (a, b))| *d = a - b);
        }
        let mut carry = Carry::new(march.model, march.options.scheme.rates(march.dt_s), 1);
        let mut solves = 0;
        let found = fixed_points(&mut change, 2 * m, LEFT, SWEEPS, |v| {
            solves += carry.around(order().map(|k| &self.factors[k]), v) as u64;
            Ok::<(), std::convert::Infallible>(())
        });
        let Ok(found) = found;
        march.stepper.cost.solves += solves;
        if found.residual > PROGRESS || !change.iter().all(|d| d.is_finite()) {
            self.stop();
            return;
        }
        self.before = Some(Before {
            taken: march.taken,
            states: march.states.clone(),
            memories: march.memories.clone(),
            last: march.last.clone(),
            replaced: march.replaced.clone(),
            difference,
        });
        for (back, part) in change.chunks_exact(m).enumerate() {
            let pair = march.replaced[back].iter().zip(part);
            march.last[back].iter_mut().zip(pair).for_each(|(x, (old, d))| *x = old + d);
        }
        carry.heads.unpack(&change);
        for k in order() {
            carry.step(&self.factors[k]);
            let share = march.model.admissible(&march.states[k], &carry.z);
            march.model.advance(&mut march.states[k], &carry.z, share);
        }
        march.stepper.cost.solves += count as u64;
        for back in 0..2 {
            let k = (n + count - 1 - back) % count;
            march.memories[k].copy_from_slice(&march.last[back]);
        }
        march.forget_move();
        self.kept = 0;
        self.corrections += 1;
    }

    /// Undoes the last correction, if its pass is not yet complete, and makes no more.
    pub fn take_back(&mut self, march: &mut March<M>) -> bool {
        let Some(before) = self.before.take() else { return false };
        if march.taken >= before.taken + march.options.steps {
            return false;
        }
        march.states = before.states;
        march.memories = before.memories;
        march.last = before.last;
        march.replaced = before.replaced;
        march.taken = before.taken;
        march.forget_move();
        self.stop();
        true
    }
}

//! The factorised steps of a settled cycle, and sweeps that carry memory through them.
//!
//! If the budget allows, every step is factorised once and kept: sweeps that follow cost a solve per step. Otherwise the
//! factors of a block of steps are made again whenever a sweep comes by. Steps of a block are factorised in parallel, columns
//! are carried in parallel; neither changes a bit of the result.

use super::GradientError;
use crate::dae::{At, SensitiveDae};
use crate::math::{FixedPoints, fixed_points};
use crate::orbit::{BLOCK, GONE, Heads, Orbit, OrbitError, OrbitOptions, Recording, Window};
use crate::run::{Cancel, Cost};
use rayon::prelude::*;
use std::ops::Range;

/// Columns that are carried together.
pub(super) const COLUMNS: usize = 8;
/// What a fixed point may leave of its right-hand side. That is what a cycle leaves of its own memory, a few per cent for most
/// bearings, so gradients are closed to 1e-12.
const CLOSED: f64 = 1e-11;
/// Memory below this share of its start counts as gone.
pub(super) const FADED: f64 = 1e-13;
/// What it may leave if rounding lets it come no nearer.
const ALMOST_CLOSED: f64 = 1e-9;
/// Sweeps granted.
const MOST_SWEEPS: usize = 60;

/// Which way a sweep goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Forward,
    Backward,
}

impl Way {
    /// The blocks of a cycle in order.
    pub fn blocks(self, count: usize) -> Vec<Range<usize>> {
        match self {
            Self::Forward => Orbit::blocks(count).collect(),
            Self::Backward => Orbit::blocks(count).rev().collect(),
        }
    }

    /// The steps of a block in order.
    pub fn steps(self, block: Range<usize>) -> Box<dyn Iterator<Item = usize>> {
        match self {
            Self::Forward => Box::new(block),
            Self::Backward => Box::new(block.rev()),
        }
    }
}

/// Something that carries changes of the memory over single steps.
pub(super) trait Carrier<M: SensitiveDae>: Send {
    fn heads(&mut self) -> &mut Heads;
    fn step(&mut self, factors: &M::Factors);
}

pub(super) struct Chain<'a, M: SensitiveDae> {
    pub model: &'a M,
    pub orbit: &'a Orbit,
    /// The blocks looked at: all of them if factors are kept, else the one at hand.
    windows: Vec<Window<'a>>,
    /// Which of them is at hand.
    here: usize,
    /// Factors of all steps, or of one block.
    factors: Vec<M::Factors>,
    kept: bool,
    /// Steps whose factors were made, if they are kept.
    done: Vec<bool>,
    /// The block whose factors are there, if they are not.
    block: Range<usize>,
    pub cost: Cost,
    cancel: &'a Cancel,
}

impl<'a, M: SensitiveDae> Chain<'a, M> {
    pub fn new(model: &'a M, orbit: &'a Orbit, options: &OrbitOptions, cancel: &'a Cancel) -> Self {
        let count = orbit.steps();
        let kept = Recording::of(model, options) == Recording::Factors;
        let room = if kept { count } else { BLOCK.min(count) };
        Self {
            model,
            orbit,
            windows: Vec::new(),
            here: 0,
            factors: (0..room).map(|_| model.keeper()).collect(),
            kept,
            done: vec![false; count],
            block: 0..0,
            cost: Cost::default(),
            cancel,
        }
    }

    /// Step `n` of the block looked at last.
    pub fn at(&self, n: usize) -> At<'_> {
        self.windows[self.here].at(n)
    }

    /// Looks at the states of a block.
    pub fn look(&mut self, block: Range<usize>) -> Result<(), GradientError> {
        if let Some(known) = self.windows.iter().position(|w| w.steps() == block) {
            self.here = known;
            return Ok(());
        }
        let share = block.start as f64 / self.orbit.steps() as f64;
        let lost = || OrbitError::StepFailed { at_share: share, cycle: 1 };
        let window = self.orbit.window(self.model, block).ok_or_else(lost)?;
        if !self.kept {
            self.windows.clear();
        }
        self.here = self.windows.len();
        self.windows.push(window);
        Ok(())
    }

    /// Whether the memory granted holds the factors of all steps.
    pub fn keeps(&self) -> bool {
        self.kept
    }

    /// Weights of the newest and the two older memories in the rate, 1/s.
    pub fn weights(&self) -> [f64; 3] {
        self.orbit.scheme.rates(self.orbit.dt_s)
    }

    pub fn factors(&self, n: usize) -> &M::Factors {
        &self.factors[if self.kept { n } else { n - self.block.start }]
    }

    /// Sees to it that the factors of a block are there.
    pub fn ready(&mut self, block: Range<usize>) -> Result<(), GradientError> {
        self.cancel.check()?;
        let there = if self.kept { self.done[block.start] } else { self.block == block };
        if there {
            return Ok(());
        }
        self.look(block.clone())?;
        let (model, alpha, window) = (self.model, self.weights()[0], &self.windows[self.here]);
        let first = if self.kept { block.start } else { 0 };
        self.factors[first..first + block.len()].par_iter_mut().enumerate().try_for_each_init(
            || (model.room(), model.factors()),
            |(room, made), (k, into)| {
                model.factor(window.at(block.start + k), alpha, room, made)?;
                model.keep(made, into);
                Ok::<(), crate::math::Singular>(())
            },
        )?;
        self.cost.factorisations += block.len() as u64;
        self.done[block.clone()].fill(true);
        self.block = block;
        Ok(())
    }

    /// Carries packed memories (two per column) once around the cycle.
    fn around<C: Carrier<M>>(
        &mut self,
        way: Way,
        carriers: &mut [C],
        packed: &mut [f64],
    ) -> Result<(), GradientError> {
        let pair = 2 * self.model.memories();
        let columns = packed.len() / pair;
        let mut first = 0.0f64;
        for (carrier, part) in carriers.iter_mut().zip(packed.chunks(COLUMNS * pair)) {
            carrier.heads().unpack(part);
            first = first.max(carrier.heads().size());
        }
        for block in way.blocks(self.orbit.steps()) {
            let size = carriers.iter_mut().map(|c| c.heads().size()).fold(0.0f64, f64::max);
            if size <= GONE * first {
                packed.fill(0.0);
                return Ok(());
            }
            self.ready(block.clone())?;
            let this = &*self;
            carriers.par_iter_mut().for_each(|carrier| {
                way.steps(block.clone()).for_each(|n| carrier.step(this.factors(n)));
            });
            self.cost.steps += block.len() as u64;
            self.cost.solves += (block.len() * columns) as u64;
        }
        for (carrier, part) in carriers.iter_mut().zip(packed.chunks_mut(COLUMNS * pair)) {
            carrier.heads().pack(part);
        }
        Ok(())
    }

    /// Replaces the memories that one forced sweep left, starting from none, by those of the periodic sweep.
    pub fn close<C: Carrier<M>>(
        &mut self,
        way: Way,
        carriers: &mut [C],
        packed: &mut [f64],
    ) -> Result<FixedPoints, GradientError> {
        let pair = 2 * self.model.memories();
        let found =
            fixed_points(packed, pair, CLOSED, MOST_SWEEPS, |columns| self.around(way, carriers, columns))?;
        if found.residual <= ALMOST_CLOSED { Ok(found) } else { Err(GradientError::NotClosed(found.actions)) }
    }
}

//! A march on its way: surfaces, time, energy, blocks behind it, and how one block is attempted and accepted.

use super::field::{largest, moved, new_surfaces};
use super::march::{Block, Course, End, March, Moment};
use super::rate::{Rate, settled_with_wear};
use super::stage::{MarchError, MarchOptions, Stage};
use crate::cranktrain::SurfaceField;
use crate::orbit::Orbit;
use crate::run::{Cancel, Cost};
use std::sync::Arc;

pub(super) struct Walk<'a> {
    pub stages: &'a [Stage],
    pub options: &'a MarchOptions,
    pub cancel: &'a Cancel,
    pub worn_m: SurfaceField,
    pub from_s: f64,
    pub energy_j: f64,
    pub blocks: Vec<Block>,
    moments: Vec<Moment>,
    ends: Vec<End>,
    /// Time, energy and loss at the beginning of the stage.
    began: (f64, f64, f64),
    /// The cycle settled last: where the next one starts.
    near: Option<Arc<Rate>>,
    /// The march of a similar design: where each cycle starts instead, from its fellow there.
    like: Option<&'a March>,
    pub refused: usize,
    /// States of cycles kept with the blocks, bytes.
    kept_bytes: usize,
    pub cost: Cost,
}

impl<'a> Walk<'a> {
    pub fn new(
        stages: &'a [Stage],
        options: &'a MarchOptions,
        like: Option<&'a March>,
        cancel: &'a Cancel,
    ) -> Result<Self, MarchError> {
        let first = stages.first().ok_or_else(|| MarchError::Parameters("no stages".to_owned()))?;
        let worn_m = new_surfaces(&first.model, options.journal_share > 0.0);
        Ok(Self {
            stages,
            options,
            cancel,
            worn_m,
            from_s: 0.0,
            energy_j: 0.0,
            blocks: Vec::new(),
            moments: Vec::new(),
            ends: Vec::new(),
            began: (0.0, 0.0, 0.0),
            near: like.map(|m| m.course.last.clone()),
            like,
            refused: 0,
            kept_bytes: 0,
            cost: Cost::default(),
        })
    }

    /// The cycle of the similar march that stands where the next one here does; none if its states were not kept.
    fn fellow(&self, stage: usize, reached: bool) -> Option<&Arc<Rate>> {
        let like = self.like?;
        let block = like.blocks.get(self.blocks.len()).filter(|b| b.stage == stage);
        let end = || like.course.ends.get(stage).map(|end| &end.rate);
        let fellow = block.map(|b| &b.rates[usize::from(reached)]).or_else(end);
        fellow.filter(|rate| rate.state_bytes() > 0)
    }

    /// The cycle at the beginning of a stage.
    pub fn begin(&mut self, stage: usize) -> Result<Arc<Rate>, MarchError> {
        let rate = self.rate(stage, None)?;
        self.began = (self.from_s, self.energy_j, rate.loss_w());
        self.remember(stage, &rate);
        Ok(rate)
    }

    /// Notes the moment.
    fn remember(&mut self, stage: usize, rate: &Rate) {
        let rate = Arc::new(rate.without_states());
        self.moments.push(Moment { stage, at_s: self.from_s, worn_m: self.worn_m.clone(), rate });
    }

    /// The cycle of a stage with surfaces of its own, or with those of the moment.
    pub fn rate(&mut self, stage: usize, worn_m: Option<&SurfaceField>) -> Result<Arc<Rate>, MarchError> {
        self.rate_from(stage, worn_m, None)
    }

    /// The same from a start of its own.
    pub fn rate_from(
        &mut self,
        stage: usize,
        worn_m: Option<&SurfaceField>,
        start: Option<&Orbit>,
    ) -> Result<Arc<Rate>, MarchError> {
        let reached = worn_m.is_some();
        self.cancel.check().map_err(|_| MarchError::Cancelled)?;
        let (model, worn_m) = (&self.stages[stage].model, worn_m.unwrap_or(&self.worn_m));
        let near = start.or_else(|| self.fellow(stage, reached).or(self.near.as_ref()).map(|r| &r.orbit));
        let found = Arc::new(settled_with_wear(model, worn_m, &self.options.orbit, near, self.cancel)?);
        self.cost += found.orbit.cost;
        self.near = Some(found.clone());
        Ok(found)
    }

    /// The block of a length from the surfaces of the moment, whose cycle is `first`.
    pub fn attempt(&mut self, stage: usize, length_s: f64, first: &Arc<Rate>) -> Result<Block, MarchError> {
        let k1 = self.options.depths(first);
        let reached_m = moved(&self.worn_m, length_s, &k1);
        let second = self.rate(stage, Some(&reached_m))?;
        let k2 = self.options.depths(&second);
        let error_m = 0.5 * length_s * largest(&moved(&k2, -1.0, &k1));
        let (worn_m, rates) = (self.worn_m.clone(), [first.clone(), second]);
        Ok(Block { stage, from_s: self.from_s, length_s, worn_m, reached_m, rates, error_m })
    }

    /// Goes over a block; returns the cycle at its end.
    pub fn accept(
        &mut self,
        mut block: Block,
        tell: &mut dyn FnMut(&Block),
    ) -> Result<Arc<Rate>, MarchError> {
        if self.blocks.len() >= self.options.max_blocks {
            return Err(MarchError::TooManyBlocks(self.options.max_blocks));
        }
        tell(&block);
        let h = block.length_s;
        let [k1, k2] = [0, 1].map(|k| self.options.depths(&block.rates[k]));
        self.worn_m = moved(&moved(&self.worn_m, 0.5 * h, &k1), 0.5 * h, &k2);
        self.energy_j += 0.5 * h * (block.rates[0].loss_w() + block.rates[1].loss_w());
        self.from_s += h;
        let stage = block.stage;
        self.keep(&mut block);
        self.blocks.push(block);
        let end = self.rate(stage, None)?;
        self.remember(stage, &end);
        Ok(end)
    }

    /// Goes over a stretch whose end was found by prediction and checked by a solved cycle.
    pub fn pass(
        &mut self,
        stage: usize,
        worn_m: SurfaceField,
        energy_j: f64,
        length_s: f64,
        checked: &Rate,
    ) -> Result<(), MarchError> {
        if self.moments.len() > self.options.max_blocks {
            return Err(MarchError::TooManyBlocks(self.options.max_blocks));
        }
        self.worn_m = worn_m;
        self.energy_j += energy_j;
        self.from_s += length_s;
        self.remember(stage, checked);
        Ok(())
    }

    /// Drops the states of the cycles of a block if they do not fit.
    fn keep(&mut self, block: &mut Block) {
        for rate in &mut block.rates {
            self.kept_bytes += rate.state_bytes();
            if self.kept_bytes > self.options.memory_bytes {
                self.kept_bytes -= rate.state_bytes();
                *rate = Arc::new(rate.without_states());
            }
        }
    }

    /// The end of a stage, which stands for the last moment in it.
    pub fn end(&mut self, rate: Arc<Rate>) {
        self.moments.pop();
        self.ends.push(End { at_s: self.from_s, worn_m: self.worn_m.clone(), rate });
    }

    pub fn finish(self) -> Result<March, MarchError> {
        let empty = || MarchError::Parameters("an empty programme".to_owned());
        let last = self.ends.last().ok_or_else(empty)?.rate.clone();
        let (began_s, began_j, first_loss_w) = self.began;
        let course = Course {
            moments: self.moments,
            worn_m: self.worn_m,
            last,
            ends: self.ends,
            energy_j: self.energy_j,
            last_energy_j: self.energy_j - began_j,
            last_duration_s: self.from_s - began_s,
            first_loss_w,
            duration_s: self.from_s,
            refused: self.refused,
            cost: self.cost,
        };
        Ok(March { course, blocks: self.blocks })
    }
}

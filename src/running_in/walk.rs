//! A march on its way: surfaces, time, energy, blocks behind it, and how one block is attempted and accepted.

use super::field::{largest, moved};
use super::march::{Block, End, March};
use super::rate::{Rate, settled_with_wear};
use super::stage::{MarchError, MarchOptions, Stage};
use crate::cranktrain::SurfaceField;
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
    ends: Vec<End>,
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
        let mut worn_m = first.model.blank_field();
        if options.journal_share == 0.0 {
            worn_m.journal.clear();
        }
        Ok(Self {
            stages,
            options,
            cancel,
            worn_m,
            from_s: 0.0,
            energy_j: 0.0,
            blocks: Vec::new(),
            ends: Vec::new(),
            near: like.map(|m| m.last.clone()),
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
        let end = || like.ends.get(stage).map(|end| &end.rate);
        let fellow = block.map(|b| &b.rates[usize::from(reached)]).or_else(end);
        fellow.filter(|rate| rate.state_bytes() > 0)
    }

    /// The cycle of a stage with surfaces of its own, or with those of the moment.
    pub fn rate(&mut self, stage: usize, worn_m: Option<&SurfaceField>) -> Result<Arc<Rate>, MarchError> {
        let reached = worn_m.is_some();
        self.cancel.check().map_err(|_| MarchError::Cancelled)?;
        let (model, worn_m) = (&self.stages[stage].model, worn_m.unwrap_or(&self.worn_m));
        let near = self.fellow(stage, reached).or(self.near.as_ref()).map(|r| &r.orbit);
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
        self.rate(stage, None)
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

    /// The end of a stage.
    pub fn end(&mut self, rate: Arc<Rate>) {
        self.ends.push(End { at_s: self.from_s, worn_m: self.worn_m.clone(), rate });
    }

    pub fn finish(self) -> Result<March, MarchError> {
        let Self { blocks, ends, worn_m, energy_j, from_s, refused, cost, .. } = self;
        let empty = || MarchError::Parameters("an empty programme".to_owned());
        let last = ends.last().ok_or_else(empty)?.rate.clone();
        Ok(March { blocks, worn_m, last, ends, energy_j, duration_s: from_s, refused, cost })
    }
}

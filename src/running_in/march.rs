//! The march through a programme: Heun's method in blocks, their length from the error of the wear depth.
//!
//! ```text
//! k1 = f(w),  k2 = f(w + h k1),   w+ = w + h (k1 + k2) / 2,   E+ = E + h (P1 + P2) / 2,   error = h/2 max |k2 - k1|
//! ```

use super::rate::{Rate, settled_with_wear};
use crate::cranktrain::{JournalBearing, SurfaceField};
use crate::gradient::GradientError;
use crate::orbit::{OrbitError, OrbitOptions};
use crate::run::{Cancel, Cost};
use thiserror::Error;

/// Shortest block, as a share of its stage.
const SHORTEST: f64 = 1e-9;
/// Length of the next block against the last: safety, least, most.
const SAFETY: f64 = 0.9;
const CHANGE: (f64, f64) = (0.2, 4.0);
/// The first block wears its surfaces by about this many times what one block may err by.
const FIRST: f64 = 2.0;

/// One operating point of a programme.
#[derive(Clone)]
pub struct Stage {
    /// The bearing there; all stages have the same film and the same parameters in the same order.
    pub model: JournalBearing,
    /// How long it lasts, s.
    pub duration_s: f64,
}

/// How a march is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarchOptions {
    /// Archard's `K / H`, m3 per N of load and m of way.
    pub wear_m3_per_n_m: f64,
    /// Share of the wear that the journal takes; the shell takes the rest.
    pub journal_share: f64,
    /// Error of the depth that a block may have, m.
    pub tolerance_m: f64,
    /// Blocks at most.
    pub max_blocks: usize,
    /// How each cycle is computed. The states of a cycle must find room in its memory.
    pub orbit: OrbitOptions,
}

impl MarchOptions {
    /// Depth worn off per time, m/s, per rubbing, W/m2: of the shell and of the journal.
    pub(super) fn depth_rates(&self) -> [f64; 2] {
        [self.wear_m3_per_n_m * (1.0 - self.journal_share), self.wear_m3_per_n_m * self.journal_share]
    }

    /// How fast each cell wears at a rate.
    pub(super) fn depths(&self, rate: &Rate) -> SurfaceField {
        let [shell, journal] = self.depth_rates();
        let times = |by: f64, v: &[f64]| v.iter().map(|r| by * r).collect();
        SurfaceField {
            shell: times(shell, &rate.rubbing_w_m2.shell),
            journal: if journal == 0.0 { Vec::new() } else { times(journal, &rate.rubbing_w_m2.journal) },
        }
    }
}

/// Why a march ended early.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MarchError {
    /// A cycle did not settle.
    #[error(transparent)]
    Orbit(OrbitError),
    /// A bearing does not exist.
    #[error("{0}")]
    Parameters(String),
    /// A gradient failed.
    #[error(transparent)]
    Gradient(GradientError),
    /// The states of a cycle are not kept.
    #[error("orbit.memory has no room for the states of a cycle, which wear is made of; raise it")]
    Memory,
    /// More blocks than allowed.
    #[error(
        "the programme needs more than {0} blocks; raise the tolerance of the wear depth or their number"
    )]
    TooManyBlocks(usize),
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}

impl From<OrbitError> for MarchError {
    fn from(e: OrbitError) -> Self {
        match e {
            OrbitError::Cancelled(_) => Self::Cancelled,
            other => Self::Orbit(other),
        }
    }
}

impl From<GradientError> for MarchError {
    fn from(e: GradientError) -> Self {
        match e {
            GradientError::Cancelled(_) => Self::Cancelled,
            GradientError::Orbit(e) => e.into(),
            other => Self::Gradient(other),
        }
    }
}

/// One block of many cycles.
#[derive(Debug, Clone)]
pub struct Block {
    /// Which stage it belongs to.
    pub stage: usize,
    /// When it begins, s after the start of the programme.
    pub from_s: f64,
    /// How long it lasts, s.
    pub length_s: f64,
    /// Surfaces at its beginning.
    pub worn_m: SurfaceField,
    /// Surfaces at its end if they wore on as they do at its beginning.
    pub reached_m: SurfaceField,
    /// The cycles with both.
    pub rates: [Rate; 2],
    /// Error of the depth, m.
    pub error_m: f64,
}

/// A programme that was gone through.
#[derive(Debug, Clone)]
pub struct March {
    /// The blocks.
    pub blocks: Vec<Block>,
    /// Surfaces in the end.
    pub worn_m: SurfaceField,
    /// The cycle of the last stage with them.
    pub last: Rate,
    /// The end of each stage: when, the surfaces, the cycle.
    pub ends: Vec<(f64, SurfaceField, Rate)>,
    /// Energy lost to friction, J.
    pub energy_j: f64,
    /// Length of the programme, s.
    pub duration_s: f64,
    /// Blocks that were tried and found too long.
    pub refused: usize,
    /// Work done.
    pub cost: Cost,
}

/// `w + h k`, nothing for fields that are not there.
pub(super) fn moved(w: &SurfaceField, h: f64, k: &SurfaceField) -> SurfaceField {
    let add = |w: &[f64], k: &[f64]| w.iter().zip(k).map(|(w, k)| w + h * k).collect();
    SurfaceField { shell: add(&w.shell, &k.shell), journal: add(&w.journal, &k.journal) }
}

/// Sum of the products of all cells.
pub(super) fn product(a: &SurfaceField, b: &SurfaceField) -> f64 {
    crate::math::dot(&a.shell, &b.shell) + crate::math::dot(&a.journal, &b.journal)
}

fn largest(a: &SurfaceField) -> f64 {
    a.shell.iter().chain(&a.journal).fold(0.0f64, |m, v| m.max(v.abs()))
}

/// Goes through a programme, `tell` is called with every block that is done.
pub fn march(
    stages: &[Stage],
    options: &MarchOptions,
    near: Option<&Rate>,
    cancel: &Cancel,
    tell: &mut dyn FnMut(&Block),
) -> Result<March, MarchError> {
    let mut walk = Walk::new(stages, options, near.cloned(), cancel)?;
    let mut length_s = None;
    for (stage, at) in stages.iter().enumerate() {
        let mut gone_s = 0.0;
        let mut first = walk.rate(stage, None)?;
        while gone_s < at.duration_s * (1.0 - SHORTEST) {
            let depths = options.depths(&first);
            let speed = largest(&depths);
            // The first guess wears the surfaces by as much as a block may err by, and a little more.
            let guess = if speed > 0.0 { FIRST * options.tolerance_m / speed } else { f64::INFINITY };
            let rest_s = at.duration_s - gone_s;
            let mut h: f64 = length_s.unwrap_or(guess).min(rest_s);
            let (block, wanted) = loop {
                let block = walk.attempt(stage, h, &first)?;
                let factor = SAFETY * (options.tolerance_m / block.error_m.max(f64::MIN_POSITIVE)).sqrt();
                let wanted = h * factor.clamp(CHANGE.0, CHANGE.1);
                if block.error_m <= options.tolerance_m || h <= SHORTEST * at.duration_s {
                    break (block, wanted);
                }
                walk.refused += 1;
                h = wanted;
            };
            // A rest that is left over must not shorten the blocks that follow.
            length_s = Some(if h < rest_s { wanted } else { wanted.max(length_s.unwrap_or(0.0)) });
            gone_s += h;
            first = walk.accept(block, tell)?;
        }
        walk.ends.push((walk.from_s, walk.worn_m.clone(), first));
    }
    walk.finish()
}

/// Goes through a programme in given blocks: shares of the duration of each stage. What a frozen derivative is the derivative of.
pub fn replay(
    stages: &[Stage],
    shares: &[Vec<f64>],
    options: &MarchOptions,
    near: Option<&Rate>,
    cancel: &Cancel,
) -> Result<March, MarchError> {
    let mut walk = Walk::new(stages, options, near.cloned(), cancel)?;
    for (stage, (at, shares)) in stages.iter().zip(shares).enumerate() {
        let mut first = walk.rate(stage, None)?;
        for share in shares {
            let block = walk.attempt(stage, share * at.duration_s, &first)?;
            first = walk.accept(block, &mut |_| {})?;
        }
        walk.ends.push((walk.from_s, walk.worn_m.clone(), first));
    }
    walk.finish()
}

impl March {
    /// The blocks as shares of the durations of their stages.
    pub fn shares(&self, stages: &[Stage]) -> Vec<Vec<f64>> {
        let of = |(k, stage): (usize, &Stage)| {
            let mine = self.blocks.iter().filter(|b| b.stage == k);
            mine.map(|b| b.length_s / stage.duration_s).collect()
        };
        stages.iter().enumerate().map(of).collect()
    }
}

/// A march on its way.
struct Walk<'a> {
    stages: &'a [Stage],
    options: &'a MarchOptions,
    cancel: &'a Cancel,
    worn_m: SurfaceField,
    from_s: f64,
    energy_j: f64,
    blocks: Vec<Block>,
    ends: Vec<(f64, SurfaceField, Rate)>,
    /// The cycle settled last: where the next one starts.
    near: Option<Rate>,
    refused: usize,
    cost: Cost,
}

impl<'a> Walk<'a> {
    fn new(
        stages: &'a [Stage],
        options: &'a MarchOptions,
        near: Option<Rate>,
        cancel: &'a Cancel,
    ) -> Result<Self, MarchError> {
        let first = stages.first().ok_or_else(|| MarchError::Parameters("no stages".to_owned()))?;
        let mut worn_m = first.model.blank_field();
        if options.journal_share == 0.0 {
            worn_m.journal.clear();
        }
        let (blocks, ends, cost) = (Vec::new(), Vec::new(), Cost::default());
        Ok(Self {
            stages,
            options,
            cancel,
            worn_m,
            from_s: 0.0,
            energy_j: 0.0,
            blocks,
            ends,
            near,
            refused: 0,
            cost,
        })
    }

    /// The cycle of a stage with surfaces of its own, or with those of the moment.
    fn rate(&mut self, stage: usize, worn_m: Option<&SurfaceField>) -> Result<Rate, MarchError> {
        self.cancel.check().map_err(|_| MarchError::Cancelled)?;
        let (model, worn_m) = (&self.stages[stage].model, worn_m.unwrap_or(&self.worn_m));
        let near = self.near.as_ref().map(|r| &r.orbit);
        let found = settled_with_wear(model, worn_m, &self.options.orbit, near, self.cancel)?;
        self.cost += found.orbit.cost;
        self.near = Some(found.clone());
        Ok(found)
    }

    fn attempt(&mut self, stage: usize, length_s: f64, first: &Rate) -> Result<Block, MarchError> {
        let k1 = self.options.depths(first);
        let reached_m = moved(&self.worn_m, length_s, &k1);
        let second = self.rate(stage, Some(&reached_m))?;
        let k2 = self.options.depths(&second);
        let error_m = 0.5 * length_s * largest(&moved(&k2, -1.0, &k1));
        let (worn_m, rates) = (self.worn_m.clone(), [first.clone(), second]);
        Ok(Block { stage, from_s: self.from_s, length_s, worn_m, reached_m, rates, error_m })
    }

    fn accept(&mut self, block: Block, tell: &mut dyn FnMut(&Block)) -> Result<Rate, MarchError> {
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
        self.blocks.push(block);
        self.rate(stage, None)
    }

    fn finish(self) -> Result<March, MarchError> {
        let Self { blocks, ends, worn_m, energy_j, from_s, refused, cost, .. } = self;
        let last =
            ends.last().ok_or_else(|| MarchError::Parameters("an empty programme".to_owned()))?.2.clone();
        Ok(March { blocks, worn_m, last, ends, energy_j, duration_s: from_s, refused, cost })
    }
}

//! The march through a programme: Heun's method in blocks, their length from the error of the wear depth.
//!
//! ```text
//! k1 = f(w),  k2 = f(w + h k1),   w+ = w + h (k1 + k2) / 2,   E+ = E + h (P1 + P2) / 2,   error = h/2 max |k2 - k1|
//! ```

use super::field::{largest, moved};
use super::rate::Rate;
use super::stage::{MarchError, MarchOptions, Stage};
use super::walk::Walk;
use crate::cranktrain::SurfaceField;
use crate::run::{Cancel, Cost};
use std::sync::Arc;

/// Shortest block, as a share of its stage.
pub(super) const SHORTEST: f64 = 1e-9;
/// Length of the next block against the last: safety, least, most.
const SAFETY: f64 = 0.9;
const CHANGE: (f64, f64) = (0.2, 4.0);
/// The first block wears its surfaces by about this many times what one block may err by.
const FIRST: f64 = 2.0;

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
    pub rates: [Arc<Rate>; 2],
    /// Error of the depth, m.
    pub error_m: f64,
}

/// The end of a stage.
#[derive(Debug, Clone)]
pub struct End {
    /// When, s after the start of the programme.
    pub at_s: f64,
    /// The surfaces then.
    pub worn_m: SurfaceField,
    /// The cycle with them.
    pub rate: Arc<Rate>,
}

/// A moment of a programme whose cycle was solved.
#[derive(Debug, Clone)]
pub struct Moment {
    /// Stage.
    pub stage: usize,
    /// When, s after the start of the programme.
    pub at_s: f64,
    /// The surfaces then.
    pub worn_m: SurfaceField,
    /// The cycle with them, without its states.
    pub rate: Arc<Rate>,
}

/// How a programme went.
#[derive(Debug, Clone)]
pub struct Course {
    /// Moments in their order, the beginning of every stage among them; their ends stand for themselves.
    pub moments: Vec<Moment>,
    /// Surfaces in the end.
    pub worn_m: SurfaceField,
    /// The cycle of the last stage with them.
    pub last: Arc<Rate>,
    /// The end of each stage.
    pub ends: Vec<End>,
    /// Energy lost to friction, J.
    pub energy_j: f64,
    /// Its part in the last stage, J.
    pub last_energy_j: f64,
    /// Length of the last stage, s.
    pub last_duration_s: f64,
    /// Mean friction loss at the beginning of the last stage, W.
    pub first_loss_w: f64,
    /// Length of the programme, s; less than was asked for if stages had nothing more to tell.
    pub duration_s: f64,
    /// Blocks that were tried and found too long.
    pub refused: usize,
    /// Work done.
    pub cost: Cost,
}

/// A programme that was gone through block by block.
#[derive(Debug, Clone)]
pub struct March {
    /// How it went.
    pub course: Course,
    /// The blocks.
    pub blocks: Vec<Block>,
}

/// Length that an error allows, given the length that made it.
pub(super) fn wanted_s(length_s: f64, error_m: f64, tolerance_m: f64) -> f64 {
    let factor = SAFETY * (tolerance_m / error_m.max(f64::MIN_POSITIVE)).sqrt();
    length_s * factor.clamp(CHANGE.0, CHANGE.1)
}

/// Length to go on with: a rest that is left over must not shorten what follows.
pub(super) fn follows_s(length_s: f64, rest_s: f64, wanted_s: f64, before_s: Option<f64>) -> f64 {
    if length_s < rest_s { wanted_s } else { wanted_s.max(before_s.unwrap_or(0.0)) }
}

/// A first guess of a length: it wears the surfaces by as much as a block may err by, and a little more.
pub(super) fn first_guess_s(depths: &SurfaceField, tolerance_m: f64) -> f64 {
    let speed = largest(depths);
    if speed > 0.0 { FIRST * tolerance_m / speed } else { f64::INFINITY }
}

/// Goes through a programme, `tell` is called with every block that is done.
pub fn march(
    stages: &[Stage],
    options: &MarchOptions,
    cancel: &Cancel,
    tell: &mut dyn FnMut(&Block),
) -> Result<March, MarchError> {
    let mut walk = Walk::new(stages, options, None, cancel)?;
    let mut length_s = None;
    for (stage, at) in stages.iter().enumerate() {
        let mut gone_s = 0.0;
        let mut first = walk.begin(stage)?;
        while gone_s < at.duration_s * (1.0 - SHORTEST) {
            let rest_s = at.duration_s - gone_s;
            let guess = first_guess_s(&options.depths(&first), options.tolerance_m);
            let mut h: f64 = length_s.unwrap_or(guess).min(rest_s);
            let (block, wanted) = loop {
                let block = walk.attempt(stage, h, &first)?;
                let wanted = wanted_s(h, block.error_m, options.tolerance_m);
                if block.error_m <= options.tolerance_m || h <= SHORTEST * at.duration_s {
                    break (block, wanted);
                }
                walk.refused += 1;
                h = wanted;
            };
            length_s = Some(follows_s(h, rest_s, wanted, length_s));
            gone_s += h;
            let (loss_w, worn_m) = (first.loss_w(), block.worn_m.clone());
            first = walk.accept(block, tell)?;
            if options.nothing_new(h, (loss_w, &worn_m), (first.loss_w(), &walk.worn_m)) {
                break;
            }
        }
        walk.end(first);
    }
    walk.finish()
}

impl MarchOptions {
    /// Whether loss and surfaces changed so little over a time that a stage has nothing more to tell.
    pub(super) fn nothing_new(
        &self,
        over_s: f64,
        (loss_w, worn_m): (f64, &SurfaceField),
        (then_w, then_m): (f64, &SurfaceField),
    ) -> bool {
        self.settled.is_some_and(|s| {
            (then_w - loss_w).abs() <= s.loss_share_per_s * over_s * then_w.abs()
                && largest(&moved(then_m, -1.0, worn_m)) <= s.depth_m_per_s * over_s
        })
    }
}

/// Goes through a programme in given blocks: shares of the duration of each stage. What a frozen derivative is the derivative of.
/// With the march of a similar design, `like`, each cycle starts from its fellow there.
pub fn replay(
    stages: &[Stage],
    shares: &[Vec<f64>],
    options: &MarchOptions,
    like: Option<&March>,
    cancel: &Cancel,
) -> Result<March, MarchError> {
    let mut walk = Walk::new(stages, options, like, cancel)?;
    for (stage, (at, shares)) in stages.iter().zip(shares).enumerate() {
        let mut first = walk.begin(stage)?;
        for share in shares {
            let block = walk.attempt(stage, share * at.duration_s, &first)?;
            first = walk.accept(block, &mut |_| {})?;
        }
        walk.end(first);
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

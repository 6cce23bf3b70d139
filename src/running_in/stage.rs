//! What a march is given: stages of a programme, options; and why it may end early.

use super::rate::Rate;
use crate::cranktrain::{BearingParameter, JournalBearing, SurfaceField};
use crate::gradient::GradientError;
use crate::orbit::{OrbitError, OrbitOptions};
use thiserror::Error;

/// One operating point of a programme.
#[derive(Clone)]
pub struct Stage {
    /// The bearing there; all stages have the same film.
    pub model: JournalBearing,
    /// How long it lasts, s.
    pub duration_s: f64,
    /// Which variable of the programme each parameter of the bearing is. Several stages may share variables.
    pub variables: Vec<usize>,
    /// Which variable the duration is; none if it is fixed.
    pub duration_variable: Option<usize>,
}

impl Stage {
    /// A stage of fixed length whose parameters are the variables, in their order.
    pub fn new(model: JournalBearing, duration_s: f64) -> Self {
        let variables = (0..varied(&model)).collect();
        Self { model, duration_s, variables, duration_variable: None }
    }

    /// The stage after a change of the variables; fails if there is no such bearing.
    pub(super) fn moved(&self, variable: usize, by: f64) -> Result<Self, MarchError> {
        use crate::dae::Dae;
        let mut p = self.model.parameters().to_vec();
        for (p, v) in p.iter_mut().zip(&self.variables) {
            *p += if *v == variable { by } else { 0.0 };
        }
        let model = self.model.with_parameters(&p).map_err(|e| MarchError::Parameters(e.to_string()))?;
        let duration_s = self.duration_s + if self.duration_variable == Some(variable) { by } else { 0.0 };
        Ok(Self { model, duration_s, ..self.clone() })
    }
}

/// Number of parameters of a bearing that are not cycle unknowns.
fn varied(model: &JournalBearing) -> usize {
    model.setup().parameters.iter().filter(|p| **p != BearingParameter::FilmTemperature).count()
}

/// Number of variables of a programme.
pub(super) fn variable_count(stages: &[Stage]) -> usize {
    let of = |s: &Stage| s.variables.iter().copied().chain(s.duration_variable).max();
    stages.iter().filter_map(of).max().map_or(0, |last| last + 1)
}

/// When a stage has nothing more to tell: in a block both changed by less than this per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// The friction loss, as a share of itself, 1/s.
    pub loss_share_per_s: f64,
    /// The wear depth anywhere, m/s.
    pub depth_m_per_s: f64,
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
    /// Ends a stage before its time, if given.
    pub settled: Option<Settled>,
    /// How each cycle is computed. The states of a cycle must find room in its memory.
    pub orbit: OrbitOptions,
    /// Memory for the states of all cycles together, bytes: what does not fit is settled again where a gradient wants it.
    pub memory_bytes: usize,
}

impl MarchOptions {
    /// Depth worn off per time, m/s, per rubbing, W/m2: of the shell and of the journal.
    pub(super) fn depth_rates(&self) -> [f64; 2] {
        [self.wear_m3_per_n_m * (1.0 - self.journal_share), self.wear_m3_per_n_m * self.journal_share]
    }

    /// How fast each cell wears at a rate.
    pub(super) fn depths(&self, rate: &Rate) -> SurfaceField {
        self.depths_of(&rate.rubbing_w_m2)
    }

    /// How fast each cell wears, or by how much faster, given its rubbing.
    pub(super) fn depths_of(&self, rubbing_w_m2: &SurfaceField) -> SurfaceField {
        let [shell, journal] = self.depth_rates();
        let times = |by: f64, v: &[f64]| v.iter().map(|r| by * r).collect();
        SurfaceField {
            shell: times(shell, &rubbing_w_m2.shell),
            journal: if journal == 0.0 { Vec::new() } else { times(journal, &rubbing_w_m2.journal) },
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

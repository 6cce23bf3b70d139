//! A job: what was asked for, how far it is, how it ended.

use crate::study::Task;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What a job does with its study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JobKind {
    /// Whatever the study asks for: a design, a table, a comparison of gradient engines.
    Study,
    /// The design with the least loss in service.
    Operational,
    /// The design with the least loss while it runs in; the study says `running_in.minimise`.
    RunningIn,
    /// The start design simulated, nothing searched.
    Simulation,
    /// The gradient at the start design.
    Gradient,
    /// The study with all its defaults.
    Check,
}

impl JobKind {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Study, Self::Operational, Self::RunningIn, Self::Simulation, Self::Gradient, Self::Check];

    /// As written in requests.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Study => "study",
            Self::Operational => "operational",
            Self::RunningIn => "running-in",
            Self::Simulation => "simulation",
            Self::Gradient => "gradient",
            Self::Check => "check",
        }
    }

    /// What is asked of the study; nothing to compute for a check.
    pub fn task(self) -> Option<Task> {
        match self {
            Self::Study | Self::Operational | Self::RunningIn => Some(Task::Answer),
            Self::Simulation => Some(Task::Simulation),
            Self::Gradient => Some(Task::Gradient),
            Self::Check => None,
        }
    }
}

/// Where a job stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JobState {
    /// Waits for a worker.
    Queued,
    /// A worker is at it.
    Running,
    /// Ended with an answer; `outcome` says which, and it may be that no design was found.
    Succeeded,
    /// Ended without an answer; `problem` says why.
    Failed,
    /// Ended because somebody asked it to; what was known by then is the result.
    Cancelled,
}

impl JobState {
    /// As written in requests.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Queued => "queued",
            Self::Running => "running",
            Self::Succeeded => "succeeded",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }

    /// Whether nothing happens to it any more.
    pub fn is_over(self) -> bool {
        matches!(self, Self::Succeeded | Self::Failed | Self::Cancelled)
    }
}

/// How far a running job is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct JobProgress {
    /// What is done now, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<String>,
    /// Working cycles simulated so far.
    #[serde(default)]
    pub simulations: u64,
    /// Accepted designs so far, the start included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub iteration: Option<u64>,
    /// Objective of the last of them, W.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective_w: Option<f64>,
    /// Its largest relative excess over a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub violation: Option<f64>,
    /// Its residual of the optimality conditions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kkt: Option<f64>,
    /// Its smallest film thickness, um.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_film_thickness_um: Option<f64>,
    /// Time that is left, s: an estimate from how fast the residual falls. None where it does not fall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds_left: Option<f64>,
}

/// A job as the store knows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// Id.
    pub id: String,
    /// Key that submitted it; "local" where no keys are asked for.
    pub owner: String,
    /// What it does.
    pub kind: JobKind,
    /// Where it stands.
    pub state: JobState,
    /// Title of its study.
    pub title: String,
    /// Hash of its study.
    pub study_hash: String,
    /// When it was submitted, ms since 1970.
    pub created_ms: i64,
    /// When a worker began it last.
    pub started_ms: Option<i64>,
    /// When it ended.
    pub finished_ms: Option<i64>,
    /// How often a worker began it.
    pub attempts: i64,
    /// Whether somebody asked it to end.
    pub cancel_requested: bool,
    /// How far it is.
    pub progress: Option<JobProgress>,
    /// How its study ended: an outcome of the search, "complete" or "incomplete".
    pub outcome: Option<String>,
    /// Why it failed, as a word.
    pub problem_code: Option<String>,
    /// Why it failed, in words.
    pub problem_detail: Option<String>,
}

//! A job as it goes over the wire.

use crate::service::job::{Job, JobKind, JobProgress, JobState};
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Why a job failed.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct JobProblem {
    /// Stable word: not-computable, time-limit, worker-lost, internal, report-failed, study-of-another-version.
    pub code: String,
    /// In words.
    pub detail: String,
}

/// Where everything about a job is.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct Links {
    /// The job itself.
    #[serde(rename = "self")]
    pub this: String,
    /// Its news, as server-sent events.
    pub events: String,
    /// Its study with all defaults.
    pub study: String,
    /// Its answer as JSON, once it is over.
    pub result: String,
    /// Its answer as a page.
    pub report: String,
    /// Tables, fields and figures.
    pub files: String,
    /// Asks it to end.
    pub cancel: String,
}

/// A job.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct JobView {
    /// Id.
    pub id: String,
    /// What it does.
    pub kind: JobKind,
    /// Where it stands.
    pub state: JobState,
    /// Title of its study.
    pub title: String,
    /// SHA-256 of its study.
    pub study_hash: String,
    /// When it was submitted (RFC 3339).
    pub created_at: String,
    /// When a worker began it last.
    pub started_at: Option<String>,
    /// When it ended.
    pub finished_at: Option<String>,
    /// How often a worker began it.
    pub attempts: i64,
    /// Whether somebody asked it to end.
    pub cancel_requested: bool,
    /// How its study ended: "converged", "infeasible", ... of a search, "complete" or "incomplete" of anything else.
    pub outcome: Option<String>,
    /// Why it failed.
    pub problem: Option<JobProblem>,
    /// How far it is.
    pub progress: Option<JobProgress>,
    /// Where everything about it is.
    pub links: Links,
}

/// A list of jobs.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct JobPage {
    /// Newest first.
    pub jobs: Vec<JobView>,
    /// Give this as `after` to read on; null at the end.
    pub next: Option<String>,
}

fn time(ms: i64) -> String {
    Timestamp::from_millisecond(ms).map(|t| t.to_string()).unwrap_or_default()
}

impl From<Job> for JobView {
    fn from(job: Job) -> Self {
        let at = |what: &str| format!("/v1/jobs/{}{what}", job.id);
        let links = Links {
            this: at(""),
            events: at("/events"),
            study: at("/study"),
            result: at("/result"),
            report: at("/report"),
            files: at("/files"),
            cancel: at("/cancel"),
        };
        let problem = job.problem_code.zip(job.problem_detail);
        Self {
            links,
            kind: job.kind,
            state: job.state,
            title: job.title,
            study_hash: job.study_hash,
            created_at: time(job.created_ms),
            started_at: job.started_ms.map(time),
            finished_at: job.finished_ms.map(time),
            attempts: job.attempts,
            cancel_requested: job.cancel_requested,
            outcome: job.outcome,
            problem: problem.map(|(code, detail)| JobProblem { code, detail }),
            progress: job.progress,
            id: job.id,
        }
    }
}

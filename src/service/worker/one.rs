//! One job: its study computed in a thread of its own, its answer written if the job is still this worker's.

use super::progress::{Teller, write};
use crate::optimise::EvaluationError;
use crate::report::{ReportFile, plain_page};
use crate::run::{Cancel, RunContext, Store as Checkpoints};
use crate::service::job::{JobKind, JobState};
use crate::service::store::{Claim, Ending, Fence, Store};
use crate::study::{Answer, Format, Study, answer};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;
use tokio::runtime::Handle;

/// Why a running job was stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Stop {
    /// It was not.
    No,
    /// Somebody asked for it.
    Asked,
    /// It took too long.
    Time,
    /// This process ends: somebody else is to go on.
    HandBack,
    /// The job is another worker's by now.
    Lost,
}

/// How a running job is stopped.
#[derive(Debug, Clone, Default)]
pub(super) struct Handles {
    pub cancel: Cancel,
    why: Arc<AtomicU8>,
}

impl Handles {
    /// Stops it; the first reason counts.
    pub fn stop(&self, why: Stop) {
        let first = self.why.compare_exchange(Stop::No as u8, why as u8, Ordering::AcqRel, Ordering::Acquire);
        if first.is_ok() {
            self.cancel.cancel();
        }
    }

    fn why(&self) -> Stop {
        let all = [Stop::No, Stop::Asked, Stop::Time, Stop::HandBack, Stop::Lost];
        all.into_iter().find(|s| *s as u8 == self.why.load(Ordering::Acquire)).unwrap_or(Stop::No)
    }
}

/// Checkpoints of a job in the store. Called from computing threads, which wait for the database.
struct InStore {
    store: Store,
    fence: Fence,
    handle: Handle,
}

impl Checkpoints for InStore {
    fn load(&self, name: &str) -> Option<Vec<u8>> {
        self.handle.block_on(self.store.checkpoint(&self.fence.id, name)).ok().flatten()
    }

    fn save(&self, name: &str, what: &[u8]) {
        if let Err(e) = self.handle.block_on(self.store.save_checkpoint(&self.fence, name, what)) {
            tracing::warn!(job = self.fence.id, "this job could not be resumed here: {e}");
        }
    }
}

/// Does a job.
pub(super) async fn run(store: Store, claim: Claim, handles: Handles, wall_time: Duration) {
    let Claim { fence, kind, study } = claim;
    let began = std::time::Instant::now();
    tracing::info!(job = fence.id, attempt = fence.attempt, kind = kind.as_str(), "begun");
    let (to, from) = tokio::sync::mpsc::unbounded_channel();
    let writer = tokio::spawn(write(store.clone(), fence.clone(), from));
    let checkpoints = InStore { store: store.clone(), fence: fence.clone(), handle: Handle::current() };
    let cancel = handles.cancel.clone();
    let mut work = tokio::task::spawn_blocking(move || {
        let study = Study::read(&study, Format::Json, None).map_err(|e| {
            // Written by this service; only another version of it can find mistakes.
            ("study-of-another-version", format!("this version reads it differently: {e}"))
        })?;
        let teller = Teller::new(to, study.optimiser.options.settings.tolerance);
        let context = RunContext { cancel: &cancel, progress: &teller };
        compute(&study, kind, context, &checkpoints)
    });
    let found = tokio::select! {
        found = &mut work => found,
        () = tokio::time::sleep(wall_time) => {
            handles.stop(Stop::Time);
            work.await
        }
    };
    // The computation told its last news; they come before the end.
    let _ = writer.await;
    let written = match ending(found, handles.why(), wall_time) {
        Some(ending) => {
            let state = ending.state.as_str();
            let seconds = began.elapsed().as_secs_f64();
            metrics::counter!("stribeck_jobs_finished_total", "state" => state).increment(1);
            metrics::histogram!("stribeck_job_seconds").record(seconds);
            tracing::info!(job = fence.id, state, outcome = ending.outcome, seconds, "ended");
            finish(&store, &fence, &ending).await
        }
        None if handles.why() == Stop::HandBack => {
            tracing::info!(job = fence.id, "handed back");
            store.hand_back(&fence).await
        }
        None => {
            tracing::warn!(job = fence.id, "left alone: another worker has it");
            Ok(true)
        }
    };
    match written {
        Ok(true) => {}
        Ok(false) => tracing::warn!(job = fence.id, "its end was not kept: another worker has it"),
        Err(e) => tracing::error!(job = fence.id, "its end was not kept: {e}"),
    }
}

/// Writes an end; a database that is away for a moment does not lose it.
async fn finish(
    store: &Store,
    fence: &Fence,
    ending: &Ending,
) -> Result<bool, crate::service::store::StoreError> {
    let mut wait = Duration::from_millis(200);
    loop {
        match store.finish(fence, ending).await {
            Err(e) if wait < Duration::from_secs(10) => {
                tracing::warn!(job = fence.id, "its end is written again in {wait:?}: {e}");
                tokio::time::sleep(wait).await;
                wait *= 2;
            }
            other => return other,
        }
    }
}

/// An answer with its files, or a word and a sentence on why there is none.
type Found = Result<(String, bool, Vec<ReportFile>), (&'static str, String)>;

fn compute(study: &Study, kind: JobKind, context: RunContext<'_>, store: &dyn Checkpoints) -> Found {
    let Some(task) = kind.task() else {
        let text = serde_json::to_string_pretty(&study.to_json()).unwrap_or_default() + "\n";
        let files = vec![ReportFile { name: "report.json".to_owned(), text }];
        return with_page(study, files).map(|files| ("complete".to_owned(), false, files));
    };
    let found = match answer(study, task, context, store) {
        Ok(found) => found,
        Err(EvaluationError::Cancelled) => return Ok(("cancelled".to_owned(), true, Vec::new())),
        Err(EvaluationError::Failed(reason)) => return Err(("not-computable", reason)),
    };
    let mut files = found.files(true).map_err(|e| ("report-failed", e.to_string()))?;
    if !matches!(found, Answer::Gradient(_)) {
        let text = study.to_toml();
        files.push(ReportFile { name: "study.toml".to_owned(), text });
    }
    with_page(study, files).map(|files| (found.status(), found.is_cancelled(), files))
}

/// Files with a page, if they have none.
fn with_page(study: &Study, mut files: Vec<ReportFile>) -> Result<Vec<ReportFile>, (&'static str, String)> {
    if files.iter().all(|f| f.name != "report.html") {
        let title = study.file.title.value().map_or("", String::as_str);
        let text = files.iter().find(|f| f.name == "report.json").map_or("", |f| f.text.as_str());
        let text = plain_page(title, text).map_err(|e| ("report-failed", e.to_string()))?;
        files.push(ReportFile { name: "report.html".to_owned(), text });
    }
    Ok(files)
}

/// How a job ends; none if it goes on elsewhere.
fn ending(found: Result<Found, tokio::task::JoinError>, why: Stop, wall_time: Duration) -> Option<Ending> {
    let failed = |code, detail: String, files| Ending {
        state: JobState::Failed,
        outcome: None,
        problem: Some((code, detail)),
        files,
    };
    match found {
        Err(e) => {
            tracing::error!("a computation ended unexpectedly: {e}");
            let words = "An error of this program; its log tells more. Nothing is wrong with the request.";
            Some(failed("internal", words.to_owned(), Vec::new()))
        }
        Ok(Err((code, detail))) => Some(failed(code, detail, Vec::new())),
        Ok(Ok((outcome, false, files))) => {
            Some(Ending { state: JobState::Succeeded, outcome: Some(outcome), problem: None, files })
        }
        Ok(Ok((_, true, files))) => match why {
            Stop::HandBack | Stop::Lost => None,
            Stop::Time => {
                let words = format!(
                    "It took longer than the {} s a job may take here. What was known by then is its result. Make the \
                     mesh coarser, or limit the search with optimiser.max_time.",
                    wall_time.as_secs()
                );
                Some(failed("time-limit", words, files))
            }
            Stop::Asked | Stop::No => Some(Ending {
                state: JobState::Cancelled,
                outcome: Some("cancelled".to_owned()),
                problem: None,
                files,
            }),
        },
    }
}

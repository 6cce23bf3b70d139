//! Jobs in: one or many, each checked completely before anything is kept.

use super::App;
use super::extract::{Body, Fields, StudyBody};
use super::guard::Owner;
use super::problem::{AnyProblem, BodyProblem, FieldError, Problem};
use super::view::JobView;
use crate::service::job::JobKind;
use crate::service::limits::Limits;
use crate::service::store::{NewJob, Submitted};
use crate::study::{Study, sha256};
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::{Extension, Json};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use utoipa::{IntoParams, ToSchema};

/// A job to submit.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct Submission {
    /// What to do with the study; "study" (whatever it asks for) if absent.
    #[schema(default = "study")]
    pub kind: Option<JobKind>,
    /// The study: an object in the form of the study file (`GET /v1/schema/study`), or the text of one in TOML.
    #[schema(value_type = StudyForm)]
    pub study: Value,
}

/// A study in one of its two forms.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum StudyForm {
    /// In the form of the study file; its schema is at `/v1/schema/study`.
    #[schema(value_type = Object)]
    Object(Map<String, Value>),
    /// TOML.
    Toml(String),
}

/// Where a kind may stand beside a study in TOML.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "describes a parameter; none is made of it")]
pub struct KindParameter {
    /// What to do with the study, where the body does not say it.
    #[param(nullable = false)]
    kind: Option<JobKind>,
}

/// Jobs to submit.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct Batch {
    /// All or none are kept.
    #[schema(min_items = 1)]
    pub jobs: Vec<Submission>,
}

/// Jobs that were submitted.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct Submissions {
    /// In the order of the request.
    pub jobs: Vec<JobView>,
}

const KNOWN: [&str; 2] = ["kind", "study"];

/// Characters of an idempotency key at most.
const LONGEST_KEY: usize = 200;

/// A checked submission, or all that is wrong with it.
fn checked(given: Map<String, Value>, at: &str, limits: &Limits) -> Result<NewJob, Vec<FieldError>> {
    let request_hash = sha256(&Value::Object(given.clone()).to_string());
    let mut fields = Fields::new(given, at);
    let words = JobKind::ALL.map(JobKind::as_str).join(", ");
    let kind: JobKind = fields.get("kind", &format!("one of {words}")).unwrap_or(JobKind::Study);
    let study = fields.study(limits);
    if let Some(words) = study.as_ref().and_then(|study| mismatch(kind, study)) {
        fields.wrong("kind", words);
    }
    let errors = fields.finish(&KNOWN);
    let Some(study) = study.filter(|_| errors.is_empty()) else { return Err(errors) };
    let title = study.file.title.value().cloned().unwrap_or_default();
    Ok(NewJob {
        kind,
        title: title.chars().filter(|c| !c.is_control()).take(300).collect(),
        study: study.to_json().to_string(),
        study_hash: study.hash,
        idempotency_key: None,
        request_hash,
    })
}

/// Why a study does not suit what is to be done with it.
fn mismatch(kind: JobKind, study: &Study) -> Option<String> {
    let (runs_in, tabulates) = (study.runs_in(), !study.searches());
    match kind {
        JobKind::Operational if runs_in => {
            Some("the study asks for a running-in design: remove running_in.minimise".to_owned())
        }
        JobKind::RunningIn if !runs_in => {
            Some("the study asks for no running-in design: give running_in.minimise".to_owned())
        }
        JobKind::Operational | JobKind::RunningIn | JobKind::Simulation if tabulates => Some(
            "the study asks for no design but for a table, experiments or a comparison: submit it with kind \"study\""
                .to_owned(),
        ),
        JobKind::Gradient if study.points.is_empty() => {
            Some("the study tabulates a characteristic, which has no gradient".to_owned())
        }
        _ => None,
    }
}

async fn has_room(app: &App, owner: &Owner, more: usize) -> Result<(), Problem> {
    let open = app.store.open_jobs(&owner.id).await?;
    let most = app.limits.open_jobs;
    if open + more as i64 > most {
        let problem = Problem::new(StatusCode::TOO_MANY_REQUESTS, "queue-full", "Too many jobs are open");
        let words = format!("{open} of at most {most} jobs of this key wait or run. Wait, or cancel some.");
        return Err(problem.detail(words).retry_after(30));
    }
    Ok(())
}

/// Submits a job.
#[utoipa::path(
    post, path = "/v1/jobs", tag = "jobs",
    request_body(content((Submission = "application/json"), (String = "application/toml"))),
    params(KindParameter, ("Idempotency-Key" = Option<String>, Header, description = "A word of your own, at most 200 visible characters: the same \
        request sent again with it is answered with the job it made the first time", max_length = 200, pattern = "^[!-~]+$")),
    responses(
        (status = 202, description = "It waits for a worker", body = JobView,
            headers(("Location" = String, description = "Where it is"))),
        (status = 200, description = "The same request made this job before", body = JobView),
        (status = 409, description = "The idempotency key was used for another request", body = Problem,
            content_type = "application/problem+json"),
        BodyProblem, AnyProblem
    )
)]
pub async fn submit(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    headers: HeaderMap,
    StudyBody(given): StudyBody,
) -> Result<Response, Problem> {
    let key = idempotency_key(&headers)?;
    let job = checked(given, "", &app.limits).map_err(Problem::mistakes)?;
    has_room(&app, &owner, 1).await?;
    let found = app.store.submit(&owner.id, &[NewJob { idempotency_key: key, ..job }]).await?;
    match found.into_iter().next() {
        Some(Submitted::New(job)) => {
            app.wake.notify_one();
            app.store.audit(&owner.id, "submit", Some(&job.id), owner.remote.as_deref()).await?;
            metrics::counter!("stribeck_jobs_submitted_total").increment(1);
            let view = JobView::from(job);
            let place = [(header::LOCATION, view.links.this.clone())];
            Ok((StatusCode::ACCEPTED, place, Json(view)).into_response())
        }
        Some(Submitted::Known(job)) => Ok(Json(JobView::from(job)).into_response()),
        Some(Submitted::Reused) => Err(reused()),
        None => Err(Problem::internal()),
    }
}

fn idempotency_key(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(value) = headers.get("idempotency-key") else { return Ok(None) };
    let fits =
        |text: &&str| (1..=LONGEST_KEY).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_graphic());
    match value.to_str().ok().filter(fits) {
        Some(text) => Ok(Some(text.to_owned())),
        None => Err(Problem::unreadable(format!(
            "The header Idempotency-Key must have 1 to {LONGEST_KEY} visible ASCII characters."
        ))),
    }
}

fn reused() -> Problem {
    Problem::new(StatusCode::CONFLICT, "idempotency-key-reused", "The idempotency key is taken")
        .detail("It was sent with another request before; choose a new one.")
}

/// Submits many jobs, all or none. An `Idempotency-Key` holds for the batch as a whole.
#[utoipa::path(
    post, path = "/v1/jobs/batch", tag = "jobs", request_body = Batch,
    params(("Idempotency-Key" = Option<String>, Header, description = "As for one job", max_length = 200, pattern = "^[!-~]+$")),
    responses(
        (status = 202, description = "They wait for workers, or are those of an earlier request with the same key", body = Submissions),
        (status = 409, description = "The idempotency key was used for another request", body = Problem,
            content_type = "application/problem+json"),
        BodyProblem, AnyProblem
    )
)]
pub async fn submit_batch(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    headers: HeaderMap,
    Body(given): Body,
) -> Result<Response, Problem> {
    let key = idempotency_key(&headers)?;
    let mut fields = Fields::new(given, "");
    let list: Option<Vec<Value>> = fields.get("jobs", "a list of jobs");
    let (missing, most) = (list.is_none() && fields.errors.is_empty(), app.limits.batch);
    if missing {
        fields.wrong("jobs", "is missing: give a list of jobs");
    }
    let list = list.unwrap_or_default();
    if list.len() > most || (list.is_empty() && fields.errors.is_empty()) {
        fields.wrong("jobs", format!("found {} jobs: expected 1 to {most}", list.len()));
    }
    let mut errors = fields.finish(&["jobs"]);
    let mut jobs = Vec::new();
    for (k, value) in list.into_iter().take(most).enumerate() {
        let at = format!("jobs[{k}]");
        let found = match value {
            Value::Object(given) => checked(given, &at, &app.limits),
            _ => Err(vec![FieldError { path: at, message: "expected an object".to_owned() }]),
        };
        match found {
            Ok(job) => {
                let idempotency_key = key.as_ref().map(|key| format!("{key} {k}"));
                jobs.push(NewJob { idempotency_key, ..job });
            }
            Err(mut own) => errors.append(&mut own),
        }
    }
    if !errors.is_empty() {
        return Err(Problem::mistakes(errors));
    }
    has_room(&app, &owner, jobs.len()).await?;
    let found = app.store.submit(&owner.id, &jobs).await?;
    if found.contains(&Submitted::Reused) {
        return Err(reused());
    }
    app.wake.notify_waiters();
    let action = format!("submit {} jobs", found.len());
    app.store.audit(&owner.id, &action, None, owner.remote.as_deref()).await?;
    metrics::counter!("stribeck_jobs_submitted_total").increment(found.len() as u64);
    let view = |s: Submitted| match s {
        Submitted::New(job) | Submitted::Known(job) => Some(JobView::from(job)),
        Submitted::Reused => None,
    };
    let jobs = found.into_iter().filter_map(view).collect();
    Ok((StatusCode::ACCEPTED, Json(Submissions { jobs })).into_response())
}

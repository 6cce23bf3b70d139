//! Jobs: looked at, listed, cancelled, deleted.

use super::App;
use super::extract::{Place, Query};
use super::guard::Owner;
use super::problem::{AnyProblem, Missing, Problem};
use super::view::{JobPage, JobView};
use crate::service::job::{Job, JobKind, JobState};
use crate::service::store::JobFilter;
use axum::extract::State;
use axum::http::StatusCode;
use axum::{Extension, Json};
use serde::Deserialize;
use utoipa::IntoParams;

/// Jobs of a page if nothing else is said, and at most.
const PAGE: u16 = 50;
const LARGEST_PAGE: u16 = 200;

/// Which jobs are wanted.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub struct ListQuery {
    /// In this state.
    state: Option<JobState>,
    /// Of this kind.
    kind: Option<JobKind>,
    /// With this text in their title; capitals do not count.
    title: Option<String>,
    /// `next` of the page before.
    #[param(format = "uuid", nullable = false)]
    after: Option<String>,
    /// At most so many.
    #[param(minimum = 1, maximum = 200, default = 50)]
    limit: Option<u16>,
}

/// Jobs, newest first.
#[utoipa::path(
    get, path = "/v1/jobs", tag = "jobs", params(ListQuery),
    responses((status = 200, description = "A page of jobs", body = JobPage), AnyProblem)
)]
pub async fn list(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Query(query): Query<ListQuery>,
) -> Result<Json<JobPage>, Problem> {
    let limit = query.limit.unwrap_or(PAGE);
    if !(1..=LARGEST_PAGE).contains(&limit) {
        let words = format!("The query is wrong: limit must lie between 1 and {LARGEST_PAGE}.");
        return Err(Problem::unreadable(words));
    }
    if query.title.as_ref().is_some_and(|t| t.contains('\0')) {
        return Err(Problem::unreadable("The query is wrong: title contains a character NUL."));
    }
    if query.after.as_ref().is_some_and(|after| uuid::Uuid::try_parse(after).is_err()) {
        return Err(Problem::unreadable("The query is wrong: after must be the next of a page."));
    }
    let filter = JobFilter {
        state: query.state,
        kind: query.kind,
        title: query.title,
        before: query.after,
        limit: i64::from(limit) + 1,
    };
    let mut jobs = app.store.jobs(&owner.id, &filter).await?;
    let more = jobs.len() > usize::from(limit);
    jobs.truncate(usize::from(limit));
    let next = jobs.last().filter(|_| more).map(|job| job.id.clone());
    Ok(Json(JobPage { jobs: jobs.into_iter().map(JobView::from).collect(), next }))
}

/// A job of an owner, or the problem that there is none.
pub(super) async fn find(app: &App, owner: &Owner, id: &str) -> Result<Job, Problem> {
    let found = if uuid::Uuid::try_parse(id).is_ok() { app.store.job(&owner.id, id).await? } else { None };
    found.ok_or_else(|| Problem::not_found("job"))
}

/// A job.
#[utoipa::path(
    get, path = "/v1/jobs/{id}", tag = "jobs", params(("id" = String, Path, description = "Job")),
    responses((status = 200, description = "The job", body = JobView), Missing, AnyProblem)
)]
pub async fn get(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
) -> Result<Json<JobView>, Problem> {
    Ok(Json(find(&app, &owner, &id).await?.into()))
}

/// Asks a job to end. One that waits does at once; one that runs as soon as it comes to a safe place, with what is known by then.
#[utoipa::path(
    post, path = "/v1/jobs/{id}/cancel", tag = "jobs", params(("id" = String, Path, description = "Job")),
    responses(
        (status = 202, description = "It ends, or is over already", body = JobView), Missing, AnyProblem
    )
)]
pub async fn cancel(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
) -> Result<(StatusCode, Json<JobView>), Problem> {
    find(&app, &owner, &id).await?;
    let job = app.store.cancel(&owner.id, &id).await?.ok_or_else(|| Problem::not_found("job"))?;
    app.store.audit(&owner.id, "cancel", Some(&id), owner.remote.as_deref()).await?;
    Ok((StatusCode::ACCEPTED, Json(job.into())))
}

/// Removes a job that is over, with its result.
#[utoipa::path(
    delete, path = "/v1/jobs/{id}", tag = "jobs", params(("id" = String, Path, description = "Job")),
    responses(
        (status = 204, description = "It is gone"),
        (status = 409, description = "It is not over: cancel it first", body = Problem,
            content_type = "application/problem+json"),
        Missing, AnyProblem
    )
)]
pub async fn delete(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
) -> Result<StatusCode, Problem> {
    let job = find(&app, &owner, &id).await?;
    if !job.state.is_over() || !app.store.delete(&owner.id, &id).await? {
        let problem = Problem::new(StatusCode::CONFLICT, "not-over", "The job is not over");
        return Err(problem.detail("Cancel it, and delete it when it has ended."));
    }
    app.store.audit(&owner.id, "delete", Some(&id), owner.remote.as_deref()).await?;
    Ok(StatusCode::NO_CONTENT)
}

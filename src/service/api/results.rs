//! Designs out: the answer of a job as JSON, as a page, as tables, fields and figures; and the study as it was run.

use super::App;
use super::extract::{Place, Query};
use super::guard::Owner;
use super::jobs::find;
use super::problem::{AnyProblem, Missing, Problem};
use crate::study::{Format, Study};
use axum::extract::State;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::{Extension, Json};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

/// A page out of a job is shown by itself: it has no scripts, and may not load or send anything.
const REPORT_POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox; frame-ancestors 'self'";

/// A file of a job.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct FileView {
    /// Name.
    pub name: String,
    /// Media type.
    pub media_type: String,
    /// Length in characters.
    pub characters: i64,
    /// Where it is.
    pub link: String,
}

/// Files of a job.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct FileList {
    /// By name.
    pub files: Vec<FileView>,
}

fn media_type(name: &str) -> &'static str {
    match name.rsplit('.').next() {
        Some("json") => "application/json",
        Some("html") => "text/html; charset=utf-8",
        Some("csv") => "text/csv; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("vts") => "application/xml",
        Some("toml") => "application/toml",
        _ => "text/plain; charset=utf-8",
    }
}

async fn content(app: &App, owner: &Owner, id: &str, name: &str) -> Result<Response, Problem> {
    let job = find(app, owner, id).await?;
    match app.store.file(id, name).await? {
        Some(text) => Ok(sent(name, text)),
        None if !job.state.is_over() => {
            let problem = Problem::new(StatusCode::CONFLICT, "not-over", "The job is not over");
            Err(problem.detail("Its result is there when it has ended; /events tells when.").retry_after(1))
        }
        None => Err(Problem::not_found("file of this job")),
    }
}

fn sent(name: &str, text: String) -> Response {
    let kind = HeaderValue::from_static(media_type(name));
    let mut response = ([(header::CONTENT_TYPE, kind)], text).into_response();
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(REPORT_POLICY));
    if name.ends_with(".html") {
        headers.insert("x-frame-options", HeaderValue::from_static("SAMEORIGIN"));
    }
    response
}

/// The answer of a job: a report, a table, a comparison, gradients, or the study of a check; see `GET /v1/schema/report`.
#[utoipa::path(
    get, path = "/v1/jobs/{id}/result", tag = "results", params(("id" = String, Path, description = "Job")),
    responses(
        (status = 200, description = "The answer", content_type = "application/json", body = serde_json::Value),
        (status = 409, description = "The job is not over", body = Problem, content_type = "application/problem+json"),
        Missing, AnyProblem
    )
)]
pub async fn result(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
) -> Result<Response, Problem> {
    content(&app, &owner, &id, "report.json").await
}

/// The answer of a job as a page.
#[utoipa::path(
    get, path = "/v1/jobs/{id}/report", tag = "results", params(("id" = String, Path, description = "Job")),
    responses(
        (status = 200, description = "The page", content_type = "text/html", body = String),
        (status = 409, description = "The job is not over", body = Problem, content_type = "application/problem+json"),
        Missing, AnyProblem
    )
)]
pub async fn report(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
) -> Result<Response, Problem> {
    content(&app, &owner, &id, "report.html").await
}

/// Files of a job: tables (CSV), fields (VTK), figures (SVG), the study (TOML).
#[utoipa::path(
    get, path = "/v1/jobs/{id}/files", tag = "results", params(("id" = String, Path, description = "Job")),
    responses((status = 200, description = "The files", body = FileList), Missing, AnyProblem)
)]
pub async fn files(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
) -> Result<Json<FileList>, Problem> {
    find(&app, &owner, &id).await?;
    let view = |(name, characters): (String, i64)| FileView {
        media_type: media_type(&name).to_owned(),
        characters,
        link: format!("/v1/jobs/{id}/files/{name}"),
        name,
    };
    let files = app.store.file_names(&id).await?.into_iter().map(view).collect();
    Ok(Json(FileList { files }))
}

/// A file of a job.
#[utoipa::path(
    get, path = "/v1/jobs/{id}/files/{name}", tag = "results",
    params(("id" = String, Path, description = "Job"), ("name" = String, Path, description = "File")),
    responses(
        (status = 200, description = "The file",
            content((String = "text/csv"), (String = "image/svg+xml"), (String = "application/xml"),
                (String = "application/toml"), (String = "text/html"), (serde_json::Value = "application/json"))),
        (status = 409, description = "The job is not over", body = Problem, content_type = "application/problem+json"),
        Missing, AnyProblem
    )
)]
pub async fn file(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place((id, name)): Place<(String, String)>,
) -> Result<Response, Problem> {
    if name.contains('\0') {
        return Err(Problem::not_found("file of this job"));
    }
    content(&app, &owner, &id, &name).await
}

/// In which form a study is wanted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum StudyFormat {
    /// JSON.
    #[default]
    Json,
    /// TOML, as the command line reads it.
    Toml,
}

/// How a study is wanted.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub struct StudyQuery {
    /// "json" or "toml".
    #[serde(default)]
    #[param(inline)]
    format: StudyFormat,
}

/// The study of a job with every default written out.
#[utoipa::path(
    get, path = "/v1/jobs/{id}/study", tag = "results",
    params(("id" = String, Path, description = "Job"), StudyQuery),
    responses(
        (status = 200, description = "The study",
            content((serde_json::Value = "application/json"), (String = "application/toml"))),
        Missing, AnyProblem
    )
)]
pub async fn study(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
    Query(query): Query<StudyQuery>,
) -> Result<Response, Problem> {
    let text = kept(&app, &owner, &id).await?;
    match query.format {
        StudyFormat::Json => Ok(sent("study.json", text)),
        StudyFormat::Toml => {
            let study = Study::read(&text, Format::Json, None).map_err(|_| Problem::internal())?;
            Ok(sent("study.toml", study.to_toml()))
        }
    }
}

/// The study of a job as JSON text.
pub(super) async fn kept(app: &App, owner: &Owner, id: &str) -> Result<String, Problem> {
    find(app, owner, id).await?;
    app.store.study(&owner.id, id).await?.ok_or_else(|| Problem::not_found("job"))
}

//! For those who run the service: is it alive, is it ready, how much does it do.

use super::App;
use super::problem::{AnyProblem, Problem};
use axum::Json;
use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// That the service is there.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct Health {
    /// "ok".
    pub status: String,
    /// Version of the program.
    pub version: String,
}

fn health() -> Json<Health> {
    Json(Health { status: "ok".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() })
}

/// Whether the process lives.
#[utoipa::path(
    get, path = "/health/live", tag = "operation",
    responses((status = 200, description = "It does", body = Health))
)]
pub async fn live() -> Json<Health> {
    health()
}

/// Whether requests can be served: the database answers.
#[utoipa::path(
    get, path = "/health/ready", tag = "operation",
    responses(
        (status = 200, description = "They can", body = Health),
        (status = 503, description = "The database does not answer", body = Problem, content_type = "application/problem+json")
    )
)]
pub async fn ready(State(app): State<App>) -> Result<Json<Health>, Problem> {
    app.store.ping().await?;
    Ok(health())
}

/// Numbers for Prometheus: requests, jobs by state, how long they take.
#[utoipa::path(
    get, path = "/metrics", tag = "operation",
    responses((status = 200, description = "Text exposition format", content_type = "text/plain", body = String), AnyProblem)
)]
pub async fn metrics(State(app): State<App>) -> Result<Response, Problem> {
    let counts = app.store.counts().await?;
    for state in ["queued", "running", "succeeded", "failed", "cancelled"] {
        let count = counts.iter().find(|(s, _)| s == state).map_or(0, |(_, n)| *n);
        metrics::gauge!("stribeck_jobs", "state" => state).set(count as f64);
    }
    let text = app.metrics.render();
    Ok(([(header::CONTENT_TYPE, "text/plain; version=0.0.4; charset=utf-8")], text).into_response())
}

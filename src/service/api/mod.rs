//! The HTTP interface, version 1: jobs, direct answers, UM-Bridge, operation, the page.

mod direct;
mod docs;
mod events;
mod extract;
mod guard;
mod jobs;
mod models;
mod operation;
mod page;
mod problem;
mod results;
mod submit;
mod view;

pub use docs::openapi;
pub use problem::{FieldError, Problem};

use super::limits::Limits;
use super::store::Store;
use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::response::IntoResponse;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{Notify, Semaphore};
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use tower_http::request_id::{MakeRequestUuid, PropagateRequestIdLayer, SetRequestIdLayer};
use tower_http::set_header::SetResponseHeaderLayer;
use tower_http::trace::TraceLayer;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

/// What all requests share.
#[derive(Clone)]
pub struct App {
    /// Jobs.
    pub store: Store,
    /// Wakes the workers of this process.
    pub wake: Arc<Notify>,
    /// What may be asked for.
    pub limits: Arc<Limits>,
    /// Whether a key is needed.
    pub keys: bool,
    /// Requests that may compute at the same time.
    pub direct: Arc<Semaphore>,
    /// Numbers for Prometheus.
    pub metrics: metrics_exporter_prometheus::PrometheusHandle,
}

/// Time in which a request that computes nothing is answered.
const PATIENCE: Duration = Duration::from_secs(30);

/// Routes that need a key, with their description.
fn guarded() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(submit::submit, jobs::list))
        .routes(routes!(submit::submit_batch))
        .routes(routes!(jobs::get, jobs::delete))
        .routes(routes!(jobs::cancel))
        .routes(routes!(events::events))
        .routes(routes!(results::result))
        .routes(routes!(results::report))
        .routes(routes!(results::files))
        .routes(routes!(results::file))
        .routes(routes!(results::study))
        .routes(routes!(direct::check))
        .routes(routes!(direct::gradient))
        .routes(routes!(models::info))
        .routes(routes!(models::model_info))
        .routes(routes!(models::input_sizes))
        .routes(routes!(models::output_sizes))
        .routes(routes!(models::evaluate))
        .routes(routes!(models::gradient))
        .routes(routes!(models::apply_jacobian))
        .routes(routes!(models::apply_hessian))
        .routes(routes!(operation::metrics))
}

/// Routes for everybody.
fn public() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(docs::study_schema))
        .routes(routes!(docs::report_schema))
        .routes(routes!(docs::example))
        .routes(routes!(operation::live))
        .routes(routes!(operation::ready))
}

/// The whole service.
pub fn router(app: App) -> Router {
    let guard = guard::Guard::new(&app);
    let (guarded, _) = guarded().split_for_parts();
    let (public, _) = public().split_for_parts();
    let guarded = guarded.route_layer(axum::middleware::from_fn_with_state(guard, guard::guard));
    let body = DefaultBodyLimit::max(app.limits.body_bytes);
    guarded
        .merge(public)
        .with_state(app)
        .merge(page::routes())
        .merge(docs::routes())
        .fallback(|| async { Problem::not_found("address") })
        .method_not_allowed_fallback(|| async {
            Problem::new(StatusCode::METHOD_NOT_ALLOWED, "method-not-allowed", "Not for this address")
        })
        .layer(body)
        .layer(axum::middleware::from_fn(in_time))
        .layer(CompressionLayer::new())
        .layer(header_layer("x-content-type-options", "nosniff"))
        .layer(header_layer("x-frame-options", "DENY"))
        .layer(header_layer("referrer-policy", "no-referrer"))
        .layer(header_layer("cross-origin-opener-policy", "same-origin"))
        .layer(header_layer("cross-origin-resource-policy", "same-origin"))
        .layer(SetResponseHeaderLayer::if_not_present(
            header::CONTENT_SECURITY_POLICY,
            HeaderValue::from_static(PAGE_POLICY),
        ))
        .layer(SetResponseHeaderLayer::if_not_present(
            header::CACHE_CONTROL,
            HeaderValue::from_static("no-store"),
        ))
        .layer(CatchPanicLayer::custom(|_: Box<dyn std::any::Any + Send>| {
            Problem::internal().into_response()
        }))
        .layer(PropagateRequestIdLayer::x_request_id())
        .layer(TraceLayer::new_for_http().make_span_with(span))
        .layer(SetRequestIdLayer::x_request_id(MakeRequestUuid))
}

/// Everything the page needs comes from here.
const PAGE_POLICY: &str = "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; \
    frame-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

fn header_layer(name: &'static str, value: &'static str) -> SetResponseHeaderLayer<HeaderValue> {
    SetResponseHeaderLayer::if_not_present(HeaderName::from_static(name), HeaderValue::from_static(value))
}

fn span(request: &axum::extract::Request) -> tracing::Span {
    let id = request.headers().get("x-request-id").and_then(|v| v.to_str().ok()).unwrap_or("");
    tracing::info_span!("request", method = %request.method(), path = request.uri().path(), id)
}

/// Ends what takes too long; streams of events may, and direct computations have a limit of their own.
async fn in_time(request: axum::extract::Request, next: axum::middleware::Next) -> axum::response::Response {
    let began = std::time::Instant::now();
    let patient = request.uri().path().ends_with("/events") || direct::computes(request.uri().path());
    let response = if patient {
        next.run(request).await
    } else {
        match tokio::time::timeout(PATIENCE, next.run(request)).await {
            Ok(response) => response,
            Err(_) => Problem::new(StatusCode::SERVICE_UNAVAILABLE, "busy", "The service is too busy")
                .detail("The answer took too long; try again.")
                .retry_after(5)
                .into_response(),
        }
    };
    let status = response.status().as_u16().to_string();
    metrics::counter!("stribeck_requests_total", "status" => status).increment(1);
    metrics::histogram!("stribeck_request_seconds").record(began.elapsed().as_secs_f64());
    response
}

//! The description of the interface (OpenAPI 3.1, made from the handlers), its browsable form, and the schemas of what goes in and out.

use axum::response::{IntoResponse, Response};
use axum::{Json, Router};
use serde_json::Value;
use utoipa::OpenApi;
use utoipa::openapi::security::{Http, HttpAuthScheme, SecurityScheme};
use utoipa::openapi::{RefOr, Schema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_swagger_ui::SwaggerUi;

/// The example of the page and of `GET /v1/example`: small, with its tables inline.
const EXAMPLE: &str = include_str!("../page/example.toml");

#[derive(OpenApi)]
#[openapi(
    info(
        title = "stribeck",
        description = "Which journal bearing loses the least power to friction, and is still safe? Jobs in, designs out.\n\n\
            Studies have the form of the study file; numbers carry their units in text (\"75 um\"). Errors are problem documents \
            (RFC 9457) with a stable `code` and every wrong field in `errors`.",
        license(name = "MIT OR Apache-2.0", identifier = "MIT OR Apache-2.0")
    ),
    components(schemas(super::problem::Problem, super::models::BridgeError, super::models::BridgeErrorBody)),
    tags(
        (name = "jobs", description = "Submit, follow, cancel, delete"),
        (name = "results", description = "Answers as JSON, page, tables, fields, figures"),
        (name = "direct", description = "Answers while the caller waits"),
        (name = "um-bridge", description = "Every stored study as a function for optimisation and uncertainty (UM-Bridge 1.0)"),
        (name = "schemas", description = "What goes in and out"),
        (name = "operation", description = "For those who run the service")
    )
)]
struct Description;

/// The description of the whole interface.
pub fn openapi() -> utoipa::openapi::OpenApi {
    let all =
        OpenApiRouter::with_openapi(Description::openapi()).merge(super::guarded()).merge(super::public());
    let mut api = all.into_openapi();
    api.components.get_or_insert_default().add_security_scheme(
        "key",
        SecurityScheme::Http(Http::builder().scheme(HttpAuthScheme::Bearer).build()),
    );
    examples(&mut api);
    // With or without a key, as the service is run.
    api.security = Some(vec![
        Default::default(),
        utoipa::openapi::SecurityRequirement::new::<_, [&str; 0], &str>("key", []),
    ]);
    api
}

/// Requests that work, made of the example.
fn examples(api: &mut utoipa::openapi::OpenApi) {
    let submission = serde_json::json!({ "kind": "check", "study": EXAMPLE });
    let all = [
        ("Batch", serde_json::json!({ "jobs": [submission] })),
        ("CheckRequest", serde_json::json!({ "study": EXAMPLE })),
        ("GradientRequest", serde_json::json!({ "study": EXAMPLE, "point": { "big_end.width": 92.0 } })),
        ("Submission", submission),
    ];
    let Some(components) = &mut api.components else { return };
    for (name, example) in all {
        if let Some(RefOr::T(Schema::Object(schema))) = components.schemas.get_mut(name) {
            schema.examples = vec![example];
        }
    }
}

/// `/openapi.json` and `/docs`.
pub(super) fn routes() -> Router {
    Router::new().merge(SwaggerUi::new("/docs").url("/openapi.json", openapi()))
}

/// JSON Schema of the study.
#[utoipa::path(
    get, path = "/v1/schema/study", tag = "schemas",
    responses((status = 200, description = "JSON Schema (2020-12)", body = Object, content_type = "application/json"))
)]
pub async fn study_schema() -> Json<Value> {
    Json(crate::study::schema())
}

/// JSON Schema of the report, the answer to a study that searches a design.
#[utoipa::path(
    get, path = "/v1/schema/report", tag = "schemas",
    responses((status = 200, description = "JSON Schema (2020-12)", body = Object, content_type = "application/json"))
)]
pub async fn report_schema() -> Json<Value> {
    Json(crate::report::schema::<crate::report::Report>())
}

/// A worked example: a study that is searched within seconds.
#[utoipa::path(
    get, path = "/v1/example", tag = "schemas",
    responses((status = 200, description = "A study, as TOML", content_type = "application/toml", body = String))
)]
pub async fn example() -> Response {
    ([("content-type", "application/toml")], EXAMPLE).into_response()
}

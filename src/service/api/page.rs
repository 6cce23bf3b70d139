//! The page at `/`: plain files in the program, nothing to build and nothing from elsewhere.

use axum::Router;
use axum::response::{IntoResponse, Response};
use axum::routing::get;

fn file(media_type: &'static str, text: &'static str) -> Response {
    ([("content-type", media_type), ("cache-control", "no-cache")], text).into_response()
}

/// Its files.
pub(super) fn routes() -> Router {
    let script =
        |text: &'static str| get(move || async move { file("text/javascript; charset=utf-8", text) });
    Router::new()
        .route("/", get(|| async { file("text/html; charset=utf-8", include_str!("../page/index.html")) }))
        .route(
            "/page/style.css",
            get(|| async { file("text/css; charset=utf-8", include_str!("../page/style.css")) }),
        )
        .route("/page/app.js", script(include_str!("../page/app.js")))
        .route("/page/base.js", script(include_str!("../page/base.js")))
        .route("/page/draw.js", script(include_str!("../page/draw.js")))
        .route("/page/form.js", script(include_str!("../page/form.js")))
}

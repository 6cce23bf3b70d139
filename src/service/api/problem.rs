//! Errors as problem documents (RFC 9457): a stable word, a sentence for people, and every field that is wrong, at once.

use crate::service::store::StoreError;
use crate::study::Fault;
use axum::Json;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoResponses, ToSchema};

/// A field that is wrong.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct FieldError {
    /// Path in the request, like `study.parameters[0].lower`.
    pub path: String,
    /// What is wrong and what would be right.
    pub message: String,
}

/// A problem document.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Problem {
    /// `urn:stribeck:problem:CODE`.
    #[serde(rename = "type")]
    pub kind: String,
    /// The problem in short.
    #[schema(value_type = String)]
    pub title: &'static str,
    /// HTTP status.
    pub status: u16,
    /// Stable word for programs.
    #[schema(value_type = String)]
    pub code: &'static str,
    /// What happened and what to do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
    /// Every field that is wrong.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<FieldError>,
    /// Seconds after which to try again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub retry_after_s: Option<u32>,
}

impl Problem {
    /// A problem.
    pub fn new(status: StatusCode, code: &'static str, title: &'static str) -> Self {
        Self {
            kind: format!("urn:stribeck:problem:{code}"),
            title,
            status: status.as_u16(),
            code,
            detail: None,
            errors: Vec::new(),
            retry_after_s: None,
        }
    }

    /// With a sentence on what happened.
    #[must_use]
    pub fn detail(self, detail: impl Into<String>) -> Self {
        Self { detail: Some(detail.into()), ..self }
    }

    /// With the fields that are wrong.
    #[must_use]
    pub fn errors(self, errors: Vec<FieldError>) -> Self {
        Self { errors, ..self }
    }

    /// With a time after which to try again.
    #[must_use]
    pub fn retry_after(self, seconds: u32) -> Self {
        Self { retry_after_s: Some(seconds), ..self }
    }

    /// Something that is not there, or belongs to somebody else.
    pub fn not_found(what: &str) -> Self {
        Self::new(StatusCode::NOT_FOUND, "not-found", "Not found").detail(format!("There is no such {what}."))
    }

    /// A request that is understood, with mistakes in it.
    pub fn mistakes(errors: Vec<FieldError>) -> Self {
        let n = errors.len();
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-study", "The request has mistakes")
            .detail(format!("{n} mistake{}, told in errors.", if n == 1 { "" } else { "s" }))
            .errors(errors)
    }

    /// A request that cannot be read.
    pub fn unreadable(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, "unreadable", "The request cannot be read").detail(detail)
    }

    /// An error of the service itself, of which the log tells more.
    pub fn internal() -> Self {
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, "internal", "An error of this service")
            .detail("Nothing is wrong with the request; the log of the service tells more.")
    }
}

/// Mistakes of a study that stands at a path of the request.
pub fn of_study(faults: &[Fault], at: &str) -> Vec<FieldError> {
    let of = |f: &Fault| {
        let path = match (f.path.is_empty(), f.path.starts_with('[')) {
            (true, _) => at.to_owned(),
            (_, true) => format!("{at}{}", f.path),
            _ => format!("{at}.{}", f.path),
        };
        let line = f.line.filter(|_| f.path.is_empty()).map_or_else(String::new, |n| format!(" (line {n})"));
        FieldError { path, message: format!("{}{line}", f.message) }
    };
    faults.iter().map(of).collect()
}

impl From<StoreError> for Problem {
    fn from(e: StoreError) -> Self {
        tracing::error!("{e}");
        Self::new(StatusCode::SERVICE_UNAVAILABLE, "database-unavailable", "The database does not answer")
            .detail("Try again; nothing of this request was kept.")
            .retry_after(2)
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let retry = self.retry_after_s;
        let mut response = (status, Json(self)).into_response();
        let json = HeaderValue::from_static("application/problem+json");
        response.headers_mut().insert(header::CONTENT_TYPE, json);
        if let Some(seconds) = retry {
            response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from(seconds));
        }
        if status == StatusCode::UNAUTHORIZED {
            let how = HeaderValue::from_static("Bearer realm=\"stribeck\"");
            response.headers_mut().insert(header::WWW_AUTHENTICATE, how);
        }
        response
    }
}

/// What any request can come to.
#[derive(IntoResponses)]
#[expect(dead_code, reason = "describes responses; none is made of it")]
pub enum AnyProblem {
    /// The request cannot be read.
    #[response(status = 400, content_type = "application/problem+json")]
    Unreadable(Problem),
    /// A key is missing or not valid.
    #[response(status = 401, content_type = "application/problem+json")]
    Unknown(Problem),
    /// Without keys, the service was asked under a name that is not this machine's.
    #[response(status = 403, content_type = "application/problem+json")]
    WrongHost(Problem),
    /// Too many requests.
    #[response(status = 429, content_type = "application/problem+json")]
    TooMany(Problem),
    /// An error of the service.
    #[response(status = 500, content_type = "application/problem+json")]
    Internal(Problem),
    /// The database does not answer, or everything is busy.
    #[response(status = 503, content_type = "application/problem+json")]
    Unavailable(Problem),
}

/// What a request about one thing can come to.
#[derive(IntoResponses)]
#[expect(dead_code, reason = "describes responses; none is made of it")]
pub enum Missing {
    /// There is no such thing, or it belongs to somebody else.
    #[response(status = 404, content_type = "application/problem+json")]
    NotFound(Problem),
}

/// What a request with a body can come to.
#[derive(IntoResponses)]
#[expect(dead_code, reason = "describes responses; none is made of it")]
pub enum BodyProblem {
    /// Too large.
    #[response(status = 413, content_type = "application/problem+json")]
    TooLarge(Problem),
    /// Not JSON.
    #[response(status = 415, content_type = "application/problem+json")]
    WrongType(Problem),
    /// Mistakes, all of them told.
    #[response(status = 422, content_type = "application/problem+json")]
    Mistakes(Problem),
}

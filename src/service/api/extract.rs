//! Bodies, queries and studies of requests, with every mistake as a problem document.

use super::problem::{FieldError, Problem, of_study};
use crate::service::limits::Limits;
use crate::study::{Format, Reading, Study};
use axum::body::Bytes;
use axum::extract::rejection::BytesRejection;
use axum::extract::{FromRequest, FromRequestParts, Request};
use axum::http::request::Parts;
use axum::http::{StatusCode, header};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// A JSON object.
pub struct Body(pub Map<String, Value>);

impl<S: Send + Sync> FromRequest<S> for Body {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self, Problem> {
        if media_type(&request) != "application/json" {
            return Err(wrong_type("Send it with Content-Type: application/json."));
        }
        object(request, state).await.map(Self)
    }
}

/// An object with a study: JSON, or the study alone as TOML. A kind may stand in the query.
pub struct StudyBody(pub Map<String, Value>);

/// What the query may add to a body.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct KindQuery {
    kind: Option<String>,
}

impl<S: Send + Sync> FromRequest<S> for StudyBody {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self, Problem> {
        let (mut parts, body) = request.into_parts();
        let Query(KindQuery { kind }) = Query::from_request_parts(&mut parts, state).await?;
        let request = Request::from_parts(parts, body);
        let mut fields = match media_type(&request).as_str() {
            "application/json" => object(request, state).await?,
            "application/toml" => {
                let bytes = Bytes::from_request(request, state).await.map_err(|e| too_large(&e))?;
                let text = String::from_utf8(bytes.into());
                let text = text.map_err(|_| Problem::unreadable("The body is no text in UTF-8."))?;
                std::iter::once(("study".to_owned(), Value::String(text))).collect()
            }
            _ => return Err(wrong_type("Send it with Content-Type: application/json, or application/toml.")),
        };
        if let Some(kind) = kind {
            if fields.contains_key("kind") {
                let message = "stands in the query and in the body: give it once".to_owned();
                return Err(Problem::mistakes(vec![FieldError { path: "kind".to_owned(), message }]));
            }
            fields.insert("kind".to_owned(), Value::String(kind));
        }
        Ok(Self(fields))
    }
}

fn media_type(request: &Request) -> String {
    let kind = request.headers().get(header::CONTENT_TYPE).and_then(|v| v.to_str().ok()).unwrap_or("");
    kind.split(';').next().unwrap_or("").trim().to_ascii_lowercase()
}

fn wrong_type(words: &str) -> Problem {
    Problem::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, "wrong-media-type", "The body is of another type")
        .detail(words)
}

async fn object<S: Send + Sync>(request: Request, state: &S) -> Result<Map<String, Value>, Problem> {
    let bytes = Bytes::from_request(request, state).await.map_err(|e| too_large(&e))?;
    match serde_json::from_slice(&bytes) {
        Ok(Value::Object(fields)) => Ok(fields),
        Ok(_) => Err(Problem::unreadable("The body must be a JSON object.")),
        Err(e) => Err(Problem::unreadable(format!("The body is no JSON: {e}."))),
    }
}

fn too_large(rejection: &BytesRejection) -> Problem {
    match rejection.status() {
        StatusCode::PAYLOAD_TOO_LARGE => {
            Problem::new(StatusCode::PAYLOAD_TOO_LARGE, "too-large", "The body is too large")
                .detail("Put fewer jobs into a batch, or shorter tables into a study.")
        }
        _ => Problem::unreadable("The body ended early."),
    }
}

/// The query of a request.
pub struct Query<T>(pub T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Query<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        match axum::extract::Query::try_from_uri(&parts.uri) {
            Ok(axum::extract::Query(value)) => Ok(Self(value)),
            Err(e) => {
                let text = e.body_text();
                let words = text.strip_prefix("Failed to deserialize query string: ").unwrap_or(&text);
                Err(Problem::unreadable(format!("The query is wrong: {words}.")))
            }
        }
    }
}

/// Fields of a request's object, taken one by one; what is left at the end is unknown.
pub struct Fields {
    left: Map<String, Value>,
    at: String,
    /// Mistakes so far.
    pub errors: Vec<FieldError>,
}

impl Fields {
    /// Of an object that stands at a path.
    pub fn new(left: Map<String, Value>, at: &str) -> Self {
        Self { left, at: at.to_owned(), errors: Vec::new() }
    }

    fn path(&self, key: &str) -> String {
        if self.at.is_empty() { key.to_owned() } else { format!("{}.{key}", self.at) }
    }

    /// Notes a mistake.
    pub fn wrong(&mut self, key: &str, message: impl Into<String>) {
        let path = self.path(key);
        self.errors.push(FieldError { path, message: message.into() });
    }

    /// A field, if it is there and not null.
    pub fn take(&mut self, key: &str) -> Option<Value> {
        self.left.remove(key).filter(|v| !v.is_null())
    }

    /// A field of some type.
    pub fn get<T: DeserializeOwned>(&mut self, key: &str, wanted: &str) -> Option<T> {
        let value = self.take(key)?;
        let found = shortened(&value);
        match serde_json::from_value(value) {
            Ok(value) => Some(value),
            Err(_) => {
                self.wrong(key, format!("found {found}: expected {wanted}"));
                None
            }
        }
    }

    /// The study: an object in the form of the study file, or the text of one in TOML. Files are not read.
    pub fn study(&mut self, limits: &Limits) -> Option<Study> {
        let path = self.path("study");
        let with = Reading { most_runs: Some(limits.experiments), ..Reading::default() };
        let read = match self.take("study") {
            None => {
                self.wrong("study", "is missing: give a study as JSON object, or as TOML text");
                return None;
            }
            Some(Value::String(toml)) => Study::read_with(&toml, Format::Toml, &with),
            Some(value @ Value::Object(_)) => Study::read_with(&value.to_string(), Format::Json, &with),
            Some(other) => {
                let found = shortened(&other);
                self.wrong("study", format!("found {found}: expected an object, or TOML text"));
                return None;
            }
        };
        match read {
            Err(e) => {
                self.errors.extend(of_study(&e.faults, &path));
                None
            }
            Ok(study) if has_nul(&study.to_json()) => {
                self.wrong("study", "contains a character NUL, which no text has: remove it");
                None
            }
            Ok(study) => {
                let beyond = limits.exceeded_by(&study);
                let of =
                    |(key, message): (String, String)| FieldError { path: format!("{path}.{key}"), message };
                let fits = beyond.is_empty();
                self.errors.extend(beyond.into_iter().map(of));
                fits.then_some(study)
            }
        }
    }

    /// Ends: fields that nobody took are mistakes.
    pub fn finish(mut self, known: &[&str]) -> Vec<FieldError> {
        let names: Vec<String> = self.left.keys().cloned().collect();
        for name in names {
            self.wrong(&name, format!("is not known; known are {}", known.join(", ")));
        }
        self.errors
    }
}

/// Whether a key or a text has the character NUL, which PostgreSQL does not keep.
fn has_nul(value: &Value) -> bool {
    match value {
        Value::String(text) => text.contains('\0'),
        Value::Array(list) => list.iter().any(has_nul),
        Value::Object(map) => map.iter().any(|(key, value)| key.contains('\0') || has_nul(value)),
        _ => false,
    }
}

/// A value as it is told in a mistake.
fn shortened(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

/// What stands in the address.
pub struct Place<T>(pub T);

impl<S: Send + Sync, T: DeserializeOwned + Send> FromRequestParts<S> for Place<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        match axum::extract::Path::<T>::from_request_parts(parts, state).await {
            Ok(axum::extract::Path(value)) => Ok(Self(value)),
            Err(_) => Err(Problem::not_found("address")),
        }
    }
}

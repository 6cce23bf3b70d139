//! UM-Bridge 1.0 (Seelinger et al., 2023): every stored study as a function `y(x)` for clients of optimisation and of uncertainty.
//!
//! Models are jobs by their ids. One input vector: the parameters; one output vector: the mean friction loss of all bearings and every
//! limited quantity; both in the units of reports. Errors have the form of the protocol, not that of the rest of this interface.

use super::App;
use super::direct::compute;
use super::extract::Body;
use super::guard::Owner;
use super::problem::{AnyProblem, Problem};
use super::results::kept;
use crate::optimise::EvaluationError;
use crate::run::{Cancel, RunContext, Silent};
use crate::service::store::JobFilter;
use crate::study::{Format, Study, StudyModel};
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use axum::{Extension, Json};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use utoipa::{IntoResponses, ToSchema};

/// Models told of at most; older ones are models all the same.
const MOST_MODELS: i64 = 1000;

/// An error in the form of the protocol.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct BridgeError {
    /// What happened.
    pub error: BridgeErrorBody,
}

/// What happened.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct BridgeErrorBody {
    /// "ModelNotFound", "InvalidInput", "UnsupportedFeature" or "InvalidEvaluation".
    #[serde(rename = "type")]
    pub kind: String,
    /// In words.
    pub message: String,
}

/// What a request to a model can come to.
#[derive(IntoResponses)]
#[expect(dead_code, reason = "describes responses; none is made of it")]
pub enum BridgeProblem {
    /// No such model, a wrong request, or it cannot be computed.
    #[response(status = 400)]
    Refused(BridgeError),
    /// A key is missing or not valid.
    #[response(status = 401, content_type = "application/problem+json")]
    Unknown(Problem),
    /// Without keys, the service was asked under a name that is not this machine's.
    #[response(status = 403, content_type = "application/problem+json")]
    WrongHost(Problem),
    /// The request is too large.
    #[response(status = 413)]
    TooLarge(BridgeError),
    /// Too many requests.
    #[response(status = 429, content_type = "application/problem+json")]
    TooMany(Problem),
    /// An error of the service.
    #[response(status = 500)]
    Internal(BridgeError),
    /// Everything is busy.
    #[response(status = 503)]
    Unavailable(BridgeError),
    /// It takes too long.
    #[response(status = 504)]
    TooSlow(BridgeError),
}

/// Which model, and more of what is asked of it: see the protocol.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct BridgeRequest {
    /// Id of a job.
    pub name: String,
    /// Vectors of the input: one, with all parameters.
    pub input: Option<Vec<Vec<f64>>>,
    /// Which output vector is differentiated.
    #[serde(rename = "outWrt")]
    pub out_wrt: Option<u32>,
    /// By which input vector.
    #[serde(rename = "inWrt")]
    pub in_wrt: Option<u32>,
    /// By which input vector first.
    #[serde(rename = "inWrt1")]
    pub in_wrt1: Option<u32>,
    /// By which input vector then.
    #[serde(rename = "inWrt2")]
    pub in_wrt2: Option<u32>,
    /// Weights of the outputs.
    pub sens: Option<Vec<f64>>,
    /// Direction.
    pub vec: Option<Vec<f64>>,
    /// Not used.
    #[schema(value_type = Option<Object>)]
    pub config: Option<Map<String, Value>>,
}

/// An answer that is no answer.
pub struct Refusal(StatusCode, BridgeError);

impl Refusal {
    fn new(kind: &str, message: impl Into<String>) -> Self {
        let body = BridgeErrorBody { kind: kind.to_owned(), message: message.into() };
        Self(StatusCode::BAD_REQUEST, BridgeError { error: body })
    }

    fn input(message: impl Into<String>) -> Self {
        Self::new("InvalidInput", message)
    }
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        let kind = match problem.status {
            404 => "ModelNotFound",
            422 | 504 => "InvalidEvaluation",
            _ => "InvalidInput",
        };
        let status = match problem.status {
            404 | 422 | 400 | 415 => StatusCode::BAD_REQUEST,
            other => StatusCode::from_u16(other).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR),
        };
        let message = problem.detail.unwrap_or_else(|| problem.title.to_owned());
        Self(status, BridgeError { error: BridgeErrorBody { kind: kind.to_owned(), message } })
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, Json(self.1)).into_response()
    }
}

/// What a model is asked.
struct Question {
    fields: Map<String, Value>,
    study: Study,
    inputs: usize,
    outputs: usize,
}

async fn question(app: &App, owner: &Owner, body: Result<Body, Problem>) -> Result<Question, Refusal> {
    let Body(fields) = body?;
    let Some(name) = fields.get("name").and_then(Value::as_str) else {
        return Err(Refusal::input("\"name\" must be the id of a job"));
    };
    let text = kept(app, owner, name).await?;
    let study = Study::read(&text, Format::Json, None).map_err(|_| Problem::internal())?;
    let cancel = Cancel::default();
    let model = StudyModel::new(&study, RunContext { cancel: &cancel, progress: &Silent });
    let model = model.map_err(|words| Refusal::new("UnsupportedFeature", words))?;
    let (inputs, outputs) = (model.inputs().len(), model.outputs().len());
    drop(model);
    Ok(Question { fields, study, inputs, outputs })
}

impl Question {
    /// The point: one vector of finite numbers.
    fn point(&self) -> Result<Vec<f64>, Refusal> {
        let wanted = || Refusal::input(format!("\"input\" must be one list of {} numbers", self.inputs));
        let list = self.fields.get("input").and_then(Value::as_array).ok_or_else(wanted)?;
        match list.as_slice() {
            [one] => numbers(one, self.inputs).ok_or_else(wanted),
            _ => Err(wanted()),
        }
    }

    /// A list of numbers.
    fn list(&self, key: &str, length: usize) -> Result<Vec<f64>, Refusal> {
        let found = self.fields.get(key).and_then(|v| numbers(v, length));
        found.ok_or_else(|| Refusal::input(format!("\"{key}\" must be a list of {length} numbers")))
    }

    /// There is one vector only, so every choice is the first.
    fn first(&self, keys: &[&str]) -> Result<(), Refusal> {
        match keys.iter().find(|key| self.fields.get(**key).and_then(Value::as_u64) != Some(0)) {
            Some(key) => Err(Refusal::input(format!("\"{key}\" must be 0: there is one vector only"))),
            None => Ok(()),
        }
    }
}

fn numbers(value: &Value, length: usize) -> Option<Vec<f64>> {
    let list = value.as_array().filter(|list| list.len() == length)?;
    list.iter().map(Value::as_f64).collect()
}

/// Weighted sum of rows.
fn combined(rows: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    (0..columns).map(|j| rows.iter().zip(weights).map(|(row, w)| w * row[j]).sum()).collect()
}

/// Which models there are.
#[utoipa::path(
    get, path = "/Info", tag = "um-bridge",
    responses((status = 200, description = "Version and models", body = Object, content_type = "application/json"), AnyProblem)
)]
pub async fn info(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
) -> Result<Json<Value>, Problem> {
    let filter = JobFilter { limit: MOST_MODELS, ..JobFilter::default() };
    let jobs = app.store.jobs(&owner.id, &filter).await?;
    let models: Vec<String> = jobs.into_iter().map(|job| job.id).collect();
    Ok(Json(json!({ "protocolVersion": 1.0, "models": models })))
}

/// What a model can do.
#[utoipa::path(
    post, path = "/ModelInfo", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "What it can do", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn model_info(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    question(&app, &owner, body).await?;
    let support = json!({ "Evaluate": true, "Gradient": true, "ApplyJacobian": true, "ApplyHessian": true });
    Ok(Json(json!({ "support": support })))
}

/// How many parameters a model has.
#[utoipa::path(
    post, path = "/InputSizes", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "Length of the input", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn input_sizes(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    Ok(Json(json!({ "inputSizes": [question(&app, &owner, body).await?.inputs] })))
}

/// How many values a model has.
#[utoipa::path(
    post, path = "/OutputSizes", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "Length of the output", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn output_sizes(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    Ok(Json(json!({ "outputSizes": [question(&app, &owner, body).await?.outputs] })))
}

/// Computes an output.
async fn output<T: Serialize + Send + 'static>(
    app: &App,
    study: Study,
    work: impl FnOnce(&StudyModel<'_>) -> Result<T, EvaluationError> + Send + 'static,
) -> Result<Json<Value>, Refusal> {
    if !app.limits.is_direct(&study) {
        let words = "this study is too large to be computed while you wait: coarsen its mesh or its steps";
        return Err(Refusal::new("UnsupportedFeature", words));
    }
    let found = json!(compute(app, study, work).await?);
    // JSON has no infinity: what is beyond all numbers becomes null.
    if found.to_string().contains("null") {
        return Err(Refusal::new("InvalidEvaluation", "the result is no finite number"));
    }
    Ok(Json(json!({ "output": found })))
}

/// Values at a point.
#[utoipa::path(
    post, path = "/Evaluate", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "Values", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn evaluate(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    let asked = question(&app, &owner, body).await?;
    let x = asked.point()?;
    output(&app, asked.study, move |model| model.values(&x).map(|y| vec![y])).await
}

/// The gradient of a weighted sum of values.
#[utoipa::path(
    post, path = "/Gradient", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "Gradient", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn gradient(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    let asked = question(&app, &owner, body).await?;
    asked.first(&["outWrt", "inWrt"])?;
    let (x, weights) = (asked.point()?, asked.list("sens", asked.outputs)?);
    output(&app, asked.study, move |model| model.jacobian(&x).map(|rows| combined(&rows, &weights))).await
}

/// How all values change along a direction.
#[utoipa::path(
    post, path = "/ApplyJacobian", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "Changes", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn apply_jacobian(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    let asked = question(&app, &owner, body).await?;
    asked.first(&["outWrt", "inWrt"])?;
    let (x, along) = (asked.point()?, asked.list("vec", asked.inputs)?);
    let product = move |row: &Vec<f64>| row.iter().zip(&along).map(|(a, b)| a * b).sum::<f64>();
    output(&app, asked.study, move |model| {
        model.jacobian(&x).map(|rows| rows.iter().map(product).collect::<Vec<f64>>())
    })
    .await
}

/// How the gradient of a weighted sum of values changes along a direction.
#[utoipa::path(
    post, path = "/ApplyHessian", tag = "um-bridge", request_body = BridgeRequest,
    responses(
        (status = 200, description = "Hessian product", body = Object, content_type = "application/json"),
        BridgeProblem
    )
)]
pub async fn apply_hessian(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    body: Result<Body, Problem>,
) -> Result<Json<Value>, Refusal> {
    let asked = question(&app, &owner, body).await?;
    asked.first(&["outWrt", "inWrt1", "inWrt2"])?;
    let (x, weights) = (asked.point()?, asked.list("sens", asked.outputs)?);
    let along = asked.list("vec", asked.inputs)?;
    output(&app, asked.study, move |model| {
        model.hessians_times(&x, &along).map(|rows| combined(&rows, &weights))
    })
    .await
}

//! Answers while the caller waits: the check of a study, and values with gradients of a small one.

use super::App;
use super::extract::{Fields, StudyBody};
use super::problem::{AnyProblem, BodyProblem, Problem};
use crate::optimise::EvaluationError;
use crate::run::{Cancel, RunContext, Silent};
use crate::study::{ModelInput, ModelOutput, Study, StudyModel};
use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::time::Duration;
use utoipa::ToSchema;

/// Whether an address computes while the caller waits, within a time limit of its own.
pub(super) fn computes(path: &str) -> bool {
    ["/v1/gradient", "/Evaluate", "/Gradient", "/ApplyJacobian", "/ApplyHessian"].contains(&path)
}

/// A study to check.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct CheckRequest {
    /// As in a submission.
    #[schema(value_type = super::submit::StudyForm)]
    pub study: Value,
}

/// A study without mistakes.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct Checked {
    /// SHA-256 of the study.
    pub study_hash: String,
    /// The study with every default written out.
    pub study: Value,
}

/// Checks a study; nothing is kept.
#[utoipa::path(
    post, path = "/v1/check", tag = "direct",
    request_body(content((CheckRequest = "application/json"), (String = "application/toml"))),
    responses((status = 200, description = "No mistakes", body = Checked), BodyProblem, AnyProblem)
)]
pub async fn check(State(app): State<App>, StudyBody(given): StudyBody) -> Result<Json<Checked>, Problem> {
    let mut fields = Fields::new(given, "");
    let study = fields.study(&app.limits);
    let errors = fields.finish(&["study"]);
    match study.filter(|_| errors.is_empty()) {
        Some(study) => Ok(Json(Checked { study: study.to_json(), study_hash: study.hash })),
        None => Err(Problem::mistakes(errors)),
    }
}

/// Where a gradient is wanted.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct GradientRequest {
    /// As in a submission; its `gradient.engine` computes.
    #[schema(value_type = super::submit::StudyForm)]
    pub study: Value,
    /// Values of parameters by their names, numbers in the units of the answer; those that are not given stand at their start.
    #[schema(value_type = Option<std::collections::BTreeMap<String, f64>>)]
    pub point: Option<Map<String, Value>>,
}

/// A derivative.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct Slope {
    /// Parameter.
    pub parameter: String,
    /// Unit of the parameter.
    pub unit: String,
    /// Value of the parameter.
    pub at: f64,
    /// Units of the quantity per unit of the parameter.
    pub slope: f64,
}

/// A quantity with its gradient.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct QuantityGradient {
    /// Quantity: first the objective, "mean-friction-loss" of all bearings, then whatever is limited.
    pub quantity: String,
    /// Bearing; null for all.
    pub bearing: Option<String>,
    /// Operating point; null for all.
    pub operating_point: Option<String>,
    /// Unit.
    pub unit: String,
    /// Value, where there is a smooth extremum the smooth one.
    pub value: f64,
    /// One entry per parameter.
    pub gradient: Vec<Slope>,
}

/// Values and gradients at a point.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct GradientAnswer {
    /// Engine.
    pub engine: String,
    /// Quantities.
    pub quantities: Vec<QuantityGradient>,
}

/// Values and gradients of a small study at a point, while the caller waits. A study that is too large, or takes too long, is one for
/// a job.
#[utoipa::path(
    post, path = "/v1/gradient", tag = "direct",
    request_body(content((GradientRequest = "application/json"), (String = "application/toml"))),
    responses(
        (status = 200, description = "Values and gradients", body = GradientAnswer),
        (status = 504, description = "It takes longer than a request may: submit a job", body = Problem,
            content_type = "application/problem+json"),
        BodyProblem, AnyProblem
    )
)]
pub async fn gradient(
    State(app): State<App>,
    StudyBody(given): StudyBody,
) -> Result<Json<GradientAnswer>, Problem> {
    let mut fields = Fields::new(given, "");
    let study = fields.study(&app.limits);
    let point: Option<Map<String, Value>> = fields.get("point", "an object of numbers");
    let x = study.as_ref().and_then(|study| place(study, point.unwrap_or_default(), &mut fields));
    if study.as_ref().is_some_and(|study| !app.limits.is_direct(study)) {
        fields
            .wrong("study", "is too large to be computed while you wait: submit a job of kind \"gradient\"");
    }
    let errors = fields.finish(&["study", "point"]);
    let Some((study, x)) = study.zip(x).filter(|_| errors.is_empty()) else {
        return Err(Problem::mistakes(errors));
    };
    let engine = study.engine.as_str().to_owned();
    let found = compute(&app, study, move |model| {
        let (values, rows) = (model.values(&x)?, model.jacobian(&x)?);
        Ok(quantities(model.inputs(), model.outputs(), &x, &values, &rows))
    });
    Ok(Json(GradientAnswer { engine, quantities: found.await? }))
}

/// The point of a request within the box of a study.
fn place(study: &Study, point: Map<String, Value>, fields: &mut Fields) -> Option<Vec<f64>> {
    let cancel = Cancel::default();
    let context = RunContext { cancel: &cancel, progress: &Silent };
    let model = match StudyModel::new(study, context) {
        Ok(model) => model,
        Err(words) => {
            fields.wrong("study", words);
            return None;
        }
    };
    let mut x: Vec<f64> = model.inputs().iter().map(|i| i.start).collect();
    let before = fields.errors.len();
    for (name, value) in point {
        let key = format!("point.{name}");
        let Some(k) = model.inputs().iter().position(|i| i.name == name) else {
            let names: Vec<&str> = model.inputs().iter().map(|i| i.name.as_str()).collect();
            fields.wrong(&key, format!("is no parameter of the study; parameters are {}", names.join(", ")));
            continue;
        };
        let input = &model.inputs()[k];
        match value.as_f64().filter(|v| (input.lower..=input.upper).contains(v)) {
            Some(v) => x[k] = v,
            None => {
                let (lower, upper, unit) = (input.lower, input.upper, &input.unit);
                fields.wrong(
                    &key,
                    format!("found {value}: expected a number between {lower} and {upper} [{unit}]"),
                );
            }
        }
    }
    (fields.errors.len() == before).then_some(x)
}

fn quantities(
    inputs: &[ModelInput],
    outputs: &[ModelOutput],
    x: &[f64],
    values: &[f64],
    rows: &[Vec<f64>],
) -> Vec<QuantityGradient> {
    let slopes = |row: &Vec<f64>| {
        let of = |((input, at), slope): ((&ModelInput, &f64), &f64)| Slope {
            parameter: input.name.clone(),
            unit: input.unit.clone(),
            at: *at,
            slope: *slope,
        };
        inputs.iter().zip(x).zip(row).map(of).collect()
    };
    let of = |((output, value), row): ((&ModelOutput, &f64), &Vec<f64>)| QuantityGradient {
        quantity: output.quantity.clone(),
        bearing: output.bearing.clone(),
        operating_point: output.operating_point.clone(),
        unit: output.unit.clone(),
        value: *value,
        gradient: slopes(row),
    };
    outputs.iter().zip(values).zip(rows).map(of).collect()
}

/// Computes something of a model within the time a request may take, a few at a time.
pub(super) async fn compute<T: Send + 'static>(
    app: &App,
    study: Study,
    work: impl FnOnce(&StudyModel<'_>) -> Result<T, EvaluationError> + Send + 'static,
) -> Result<T, Problem> {
    let Ok(Ok(slot)) = tokio::time::timeout(Duration::from_secs(5), app.direct.clone().acquire_owned()).await
    else {
        let problem = Problem::new(StatusCode::SERVICE_UNAVAILABLE, "busy", "The service is too busy");
        return Err(problem.detail("Other requests compute; try again, or submit a job.").retry_after(5));
    };
    let cancel = Cancel::default();
    let flag = cancel.clone();
    let mut task = tokio::task::spawn_blocking(move || {
        let context = RunContext { cancel: &flag, progress: &Silent };
        let found = StudyModel::new(&study, context).map_err(EvaluationError::Failed).and_then(|m| work(&m));
        drop(slot);
        found
    });
    // A caller that goes away stops the computation, too.
    let gone = Raise(cancel);
    let limit = app.limits.direct_s;
    let found = tokio::select! {
        found = &mut task => found,
        () = tokio::time::sleep(Duration::from_secs(limit)) => {
            let problem = Problem::new(StatusCode::GATEWAY_TIMEOUT, "too-slow", "It takes too long");
            return Err(problem.detail(format!("It takes longer than {limit} s: submit a job of kind \"gradient\".")));
        }
    };
    drop(gone);
    match found {
        Ok(Ok(found)) => Ok(found),
        Ok(Err(EvaluationError::Failed(reason))) => {
            let problem =
                Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "not-computable", "It cannot be computed");
            Err(problem.detail(reason))
        }
        Ok(Err(EvaluationError::Cancelled)) => Err(Problem::internal()),
        Err(e) => {
            tracing::error!("a computation ended unexpectedly: {e}");
            Err(Problem::internal())
        }
    }
}

/// Raises a flag when it goes out of scope.
struct Raise(Cancel);

impl Drop for Raise {
    fn drop(&mut self) {
        self.0.cancel();
    }
}

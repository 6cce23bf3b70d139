//! A study as a function of its parameters: values, gradients and Hessian products at any point of the box, in the units of reports.
//!
//! ```text
//! y(x):  y_0 the weighted mean friction loss of all bearings, W;  y_1.. the limited quantities, one per limit, bearing and operating point
//! ```
//!
//! For programs that ask point by point (UM-Bridge, the synchronous gradient). Deliberately not here: running-in designs, whose
//! objective is a march and not a cycle.

use super::build::{Plan, plan};
use super::check::Study;
use super::plans::ParameterPlan;
use crate::optimise::{ConstrainedProblem, Curved, EvaluationError, Slopes, relative_excess};
use crate::run::RunContext;
use serde::Serialize;

/// A parameter of the function.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelInput {
    /// Name in the study.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Start of the study.
    pub start: f64,
}

/// A value of the function.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelOutput {
    /// Quantity, in the words of the study.
    pub quantity: String,
    /// Bearing; none for the sum of all.
    pub bearing: Option<String>,
    /// Operating point; none for the mean of all.
    pub operating_point: Option<String>,
    /// Unit.
    pub unit: String,
    /// SI value of one unit.
    #[serde(skip)]
    size: f64,
}

/// The function.
pub struct StudyModel<'r> {
    plan: Plan<'r>,
    study: Study,
    inputs: Vec<ModelInput>,
    outputs: Vec<ModelOutput>,
}

fn shown(p: &ParameterPlan, si: f64) -> f64 {
    p.variable.shown(si)
}

impl<'r> StudyModel<'r> {
    /// The function of a study; the reason if it is none.
    pub fn new(study: &Study, context: RunContext<'r>) -> Result<Self, String> {
        if study.points.is_empty() || study.comparison.is_some() {
            return Err("this study asks for a table, not for a design: it has no objective".to_owned());
        }
        if study.runs_in() {
            let words = "this study minimises over a running-in programme, which has no value point by point: remove running_in.minimise";
            return Err(words.to_owned());
        }
        let study = study.without_search();
        let plan = plan(&study, study.engine, context).map_err(|e| e.to_string())?;
        let input = |p: &ParameterPlan| ModelInput {
            name: p.name.clone(),
            unit: p.variable.unit.to_owned(),
            lower: shown(p, p.lower),
            upper: shown(p, p.upper),
            start: shown(p, p.start),
        };
        let inputs = study.parameters.iter().map(input).collect();
        let loss = ModelOutput {
            quantity: "mean-friction-loss".to_owned(),
            bearing: None,
            operating_point: None,
            unit: "W".to_owned(),
            size: 1.0,
        };
        let limited = plan.limits.iter().map(|label| {
            let (case, quantity) = (plan.cases[label.case], study.constraints[label.constraint].quantity);
            let (unit, size) = quantity.unit();
            ModelOutput {
                quantity: quantity.key().to_owned(),
                bearing: Some(study.bearings[case.bearing].name.clone()),
                operating_point: Some(study.points[case.point].name.clone()),
                unit: unit.to_owned(),
                size,
            }
        });
        let outputs = std::iter::once(loss).chain(limited).collect();
        Ok(Self { plan, study, inputs, outputs })
    }

    /// Parameters.
    pub fn inputs(&self) -> &[ModelInput] {
        &self.inputs
    }

    /// Values.
    pub fn outputs(&self) -> &[ModelOutput] {
        &self.outputs
    }

    /// SI values of a point, which may lie a little outside of the box (differences do).
    fn si(&self, x: &[f64]) -> Vec<f64> {
        let of = |(p, v): (&ParameterPlan, &f64)| v * p.variable.scale.0 + p.variable.scale.1;
        self.study.parameters.iter().zip(x).map(of).collect()
    }

    /// All values at a point.
    pub fn values(&self, x: &[f64]) -> Result<Vec<f64>, EvaluationError> {
        let found = self.plan.problem.values(&self.si(x))?;
        let limited = self.plan.limits.iter().zip(&found.inequalities).map(|(label, excess)| {
            let c = &self.study.constraints[label.constraint];
            let (_, slope) = relative_excess(c.sense, c.limit, c.limit);
            c.quantity.shown(c.limit + excess / slope)
        });
        Ok(std::iter::once(found.objective).chain(limited).collect())
    }

    /// Derivatives of all values (rows) by all parameters.
    pub fn jacobian(&self, x: &[f64]) -> Result<Vec<Vec<f64>>, EvaluationError> {
        self.plan.problem.slopes(&self.si(x)).map(|slopes| self.rows(&slopes))
    }

    /// Derivatives of the rows of the Jacobian along a direction: one Hessian product per value.
    pub fn hessians_times(&self, x: &[f64], direction: &[f64]) -> Result<Vec<Vec<f64>>, EvaluationError> {
        let scaled = |(p, d): (&ParameterPlan, &f64)| d * p.variable.scale.0;
        let along: Vec<f64> = self.study.parameters.iter().zip(direction).map(scaled).collect();
        if along.iter().all(|d| *d == 0.0) {
            return Ok(vec![vec![0.0; x.len()]; self.outputs.len()]);
        }
        self.plan.problem.slopes_along(&self.si(x), &along).map(|slopes| self.rows(&slopes))
    }

    /// Rows in the units of reports.
    fn rows(&self, slopes: &Slopes) -> Vec<Vec<f64>> {
        let row = |by_si: &[f64], factor: f64| -> Vec<f64> {
            let scaled = |(p, g): (&ParameterPlan, &f64)| g * factor * p.variable.scale.0;
            self.study.parameters.iter().zip(by_si).map(scaled).collect()
        };
        let limited = self.plan.limits.iter().zip(&slopes.inequalities).enumerate();
        let limited = limited.map(|(k, (label, by_si))| {
            let c = &self.study.constraints[label.constraint];
            let (_, slope) = relative_excess(c.sense, c.limit, c.limit);
            row(by_si, 1.0 / (slope * self.outputs[k + 1].size))
        });
        std::iter::once(row(&slopes.objective, 1.0)).chain(limited).collect()
    }
}

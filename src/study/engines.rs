//! The five gradient engines side by side on a study's start design.

use super::build::plan;
use super::check::Study;
use super::plans::ParameterPlan;
use super::vocabulary::QuantityName;
use crate::dae::Dae;
use crate::gradient::{EngineName, GradientTable, engine};
use crate::optimise::EvaluationError;
use crate::run::{Cost, Event, RunContext};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Which perturbations the finite differences use.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep(pub Vec<f64>);

impl Sweep {
    /// From 1e-3 to 1e-8.
    pub fn wide() -> Self {
        Self((3..=8).map(|k| 10f64.powi(-k)).collect())
    }
}

/// Result of one engine on one bearing at one operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EngineRow {
    /// Engine.
    pub engine: EngineName,
    /// Relative perturbation; none for TRA and ADJ.
    pub perturbation: Option<f64>,
    /// One row per quantity, one value per parameter, units as in the comparison.
    pub values: Vec<Vec<f64>>,
    /// Largest difference to ADJ in each row, relative to the largest elasticity of the row.
    pub error: Vec<f64>,
    /// Sweeps over the cycle (settled cycles for the differences).
    pub sweeps: f64,
    /// Work done.
    pub cost: Cost,
    /// Wall time over the wall time of the simulation at the point.
    pub time_ratio: f64,
    /// Why there are no values, if so.
    pub failure: Option<String>,
}

/// All engines on one bearing at one operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EngineComparison {
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Quantities, one per row of values.
    pub quantities: Vec<String>,
    /// Parameters, one per column of values.
    pub parameters: Vec<String>,
    /// Units of the values.
    pub units: Vec<Vec<String>>,
    /// Engines.
    pub rows: Vec<EngineRow>,
}

/// Computes the gradient at the start design with the engines asked for, each measured against ADJ.
pub fn compare_engines(
    study: &Study,
    engines: &[EngineName],
    sweep: &Sweep,
    context: RunContext<'_>,
) -> Result<Vec<EngineComparison>, EvaluationError> {
    let failed = |e: String| EvaluationError::Failed(e);
    let plan = plan(study, EngineName::Adj, context).map_err(|e| failed(e.to_string()))?;
    let began = Instant::now();
    context.progress.tell(&Event::Stage { name: "simulating".to_owned() });
    let at = plan.problem.evaluated(&plan.start)?;
    let simulation_s = began.elapsed().as_secs_f64() / plan.cases.len() as f64;
    let mut comparisons = Vec::new();
    for (c, label) in plan.cases.iter().enumerate() {
        let case = &plan.problem.cases()[c];
        let model = plan.problem.model(c, &plan.start)?;
        let parameters: Vec<_> = case.variables.iter().map(|&j| &study.parameters[j]).collect();
        let compute = |name: EngineName, eps: f64| -> Result<(GradientTable, f64), EvaluationError> {
            context.progress.tell(&Event::Stage { name: format!("gradient with {}", name.as_str()) });
            let began = Instant::now();
            let table = engine(name, eps)
                .gradient(&model, &at.orbits[c], &case.options, &case.quantities, context.cancel)
                .map_err(|e| {
                    if context.cancel.is_cancelled() {
                        EvaluationError::Cancelled
                    } else {
                        failed(e.to_string())
                    }
                })?;
            Ok((table, began.elapsed().as_secs_f64() / simulation_s))
        };
        let (reference, _) = compute(EngineName::Adj, 0.0)?;
        let mut rows = Vec::new();
        for &name in engines {
            let finite = !matches!(name, EngineName::Tra | EngineName::Adj);
            let steps: Vec<Option<f64>> =
                if finite { sweep.0.iter().map(|e| Some(*e)).collect() } else { vec![None] };
            for perturbation in steps {
                let row = match compute(name, perturbation.unwrap_or(0.0)) {
                    Ok((table, time_ratio)) => EngineRow {
                        engine: name,
                        perturbation,
                        values: shown(&table, &plan.quantities[c], &parameters),
                        error: differences(&table, &reference, model.parameters()),
                        sweeps: table.sweeps,
                        cost: table.cost,
                        time_ratio,
                        failure: None,
                    },
                    Err(EvaluationError::Cancelled) => return Err(EvaluationError::Cancelled),
                    Err(EvaluationError::Failed(reason)) => EngineRow {
                        engine: name,
                        perturbation,
                        values: Vec::new(),
                        error: Vec::new(),
                        sweeps: 0.0,
                        cost: Cost::default(),
                        time_ratio: 0.0,
                        failure: Some(reason),
                    },
                };
                rows.push(row);
            }
        }
        let units = plan.quantities[c].iter().map(|q| {
            parameters
                .iter()
                .map(|p| format!("{}/{}", q.unit().0, p.variable.unit.replace("degC", "K")))
                .collect()
        });
        comparisons.push(EngineComparison {
            bearing: study.bearings[label.bearing].name.clone(),
            operating_point: study.points[label.point].name.clone(),
            quantities: plan.quantities[c].iter().map(|q| q.key().to_owned()).collect(),
            parameters: parameters.iter().map(|p| p.name.clone()).collect(),
            units: units.collect(),
            rows,
        });
    }
    Ok(comparisons)
}

/// Derivatives in the units of reports.
fn shown(table: &GradientTable, quantities: &[QuantityName], parameters: &[&ParameterPlan]) -> Vec<Vec<f64>> {
    let row = |(row, quantity): (&Vec<f64>, &QuantityName)| {
        let (_, scale) = quantity.unit();
        row.iter().zip(parameters).map(|(g, p)| g / scale * p.variable.scale.0).collect()
    };
    table.rows.iter().zip(quantities).map(row).collect()
}

/// Largest difference of elasticities in each row, relative to the row's largest elasticity.
fn differences(table: &GradientTable, reference: &GradientTable, p: &[f64]) -> Vec<f64> {
    let row = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let size = b.iter().zip(p).fold(0.0f64, |m, (g, p)| m.max((g * p).abs()));
        let miss = a.iter().zip(b).zip(p).fold(0.0f64, |m, ((a, b), p)| m.max(((a - b) * p).abs()));
        if size > 0.0 { miss / size } else { miss }
    };
    table.rows.iter().zip(&reference.rows).map(row).collect()
}

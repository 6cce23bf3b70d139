//! The five gradient engines side by side on a study's start design.

use super::build::{Plan, plan};
use super::check::Study;
use super::plans::ParameterPlan;
use super::vocabulary::QuantityName;
use crate::cranktrain::JournalBearing;
use crate::dae::Dae;
use crate::gradient::{EngineName, GradientTable, engine};
use crate::optimise::EvaluationError;
use crate::orbit::Orbit;
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
    /// Cells at which the film has a kink, over all steps.
    pub weakly_active_cells: usize,
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
    let plan = plan(study, EngineName::Adj, context).map_err(|e| EvaluationError::Failed(e.to_string()))?;
    let began = Instant::now();
    context.progress.tell(&Event::Stage { name: "simulating".to_owned() });
    let at = plan.problem.evaluated(&plan.start)?;
    let simulation_s = began.elapsed().as_secs_f64() / plan.cases.len() as f64;
    (0..plan.cases.len())
        .map(|c| {
            let bench = Bench { study, plan: &plan, case: c, orbit: &at.orbits[c], simulation_s, context };
            bench.compare(engines, sweep)
        })
        .collect()
}

/// One bearing at one operating point on which engines are compared.
struct Bench<'a> {
    study: &'a Study,
    plan: &'a Plan<'a>,
    case: usize,
    orbit: &'a Orbit,
    simulation_s: f64,
    context: RunContext<'a>,
}

impl Bench<'_> {
    fn compare(&self, engines: &[EngineName], sweep: &Sweep) -> Result<EngineComparison, EvaluationError> {
        let (label, quantities) = (self.plan.cases[self.case], &self.plan.quantities[self.case]);
        let parameters = self.parameters();
        let model = self.plan.problem.model(self.case, &self.plan.start)?;
        let sizes: Vec<f64> = parameters.iter().zip(model.parameters()).map(|(p, v)| size(p, *v)).collect();
        let (reference, _) = self.compute(&model, EngineName::Adj, 0.0)?;
        let mut rows = Vec::new();
        for &name in engines {
            let finite = !matches!(name, EngineName::Tra | EngineName::Adj);
            let steps: Vec<Option<f64>> =
                if finite { sweep.0.iter().map(|e| Some(*e)).collect() } else { vec![None] };
            for perturbation in steps {
                rows.push(match self.compute(&model, name, perturbation.unwrap_or(0.0)) {
                    Ok((table, time_ratio)) => EngineRow {
                        values: shown(&table.rows, quantities, &parameters),
                        error: differences(&table, &reference, &sizes),
                        sweeps: table.sweeps,
                        cost: table.cost,
                        time_ratio,
                        ..EngineRow::failed(name, perturbation, None)
                    },
                    Err(EvaluationError::Cancelled) => return Err(EvaluationError::Cancelled),
                    Err(EvaluationError::Failed(reason)) => {
                        EngineRow::failed(name, perturbation, Some(reason))
                    }
                });
            }
        }
        let unit = |q: &QuantityName, p: &ParameterPlan| p.variable.slope_unit(q.unit().0);
        Ok(EngineComparison {
            bearing: self.study.bearings[label.bearing].name.clone(),
            operating_point: self.study.points[label.point].name.clone(),
            quantities: quantities.iter().map(|q| q.key().to_owned()).collect(),
            parameters: parameters.iter().map(|p| p.name.clone()).collect(),
            units: quantities.iter().map(|q| parameters.iter().map(|p| unit(q, p)).collect()).collect(),
            weakly_active_cells: super::observe::weakly_active(&model, self.orbit),
            rows,
        })
    }

    fn parameters(&self) -> Vec<&ParameterPlan> {
        let case = &self.plan.problem.cases()[self.case];
        case.variables.iter().map(|&j| &self.study.parameters[j]).collect()
    }

    /// Gradient of one engine and its wall time in simulations.
    fn compute(
        &self,
        model: &JournalBearing,
        name: EngineName,
        perturbation: f64,
    ) -> Result<(GradientTable, f64), EvaluationError> {
        let (case, cancel) = (&self.plan.problem.cases()[self.case], self.context.cancel);
        self.context.progress.tell(&Event::Stage { name: format!("gradient with {}", name.as_str()) });
        let began = Instant::now();
        let result =
            engine(name, perturbation).gradient(model, self.orbit, &case.options, &case.quantities, cancel);
        let table = result.map_err(|e| match cancel.is_cancelled() {
            true => EvaluationError::Cancelled,
            false => EvaluationError::Failed(e.to_string()),
        })?;
        Ok((table, began.elapsed().as_secs_f64() / self.simulation_s))
    }
}

impl EngineRow {
    /// A row without values.
    fn failed(engine: EngineName, perturbation: Option<f64>, failure: Option<String>) -> Self {
        Self {
            engine,
            perturbation,
            values: Vec::new(),
            error: Vec::new(),
            sweeps: 0.0,
            cost: Cost::default(),
            time_ratio: 0.0,
            failure,
        }
    }
}

/// Derivatives in the units of reports.
pub(super) fn shown(
    rows: &[Vec<f64>],
    quantities: &[QuantityName],
    parameters: &[&ParameterPlan],
) -> Vec<Vec<f64>> {
    let row = |(row, quantity): (&Vec<f64>, &QuantityName)| {
        let (_, scale) = quantity.unit();
        row.iter().zip(parameters).map(|(g, p)| g / scale * p.variable.scale.0).collect()
    };
    rows.iter().zip(quantities).map(row).collect()
}

/// What a change of a parameter is measured by: its value, or the width of its box where it is zero.
fn size(plan: &ParameterPlan, value: f64) -> f64 {
    if value == 0.0 { plan.upper - plan.lower } else { value }
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

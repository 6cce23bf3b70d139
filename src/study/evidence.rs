//! The third part of a report: the gradient at the design, with its proof.

use super::build::Plan;
use super::check::Study;
use super::{observe, sensitivity};
use crate::gradient::{GradientTable, taylor_table};
use crate::optimise::{Evaluated, EvaluationError};
use crate::report::{Curves, GradientReport, GradientRow};
use crate::run::RunContext;

/// First step (relative) and number of steps of the Taylor test.
const TAYLOR: (f64, usize) = (1e-4, 6);

pub(super) fn gradient(
    study: &Study,
    plan: &Plan,
    x: &[f64],
    at: &Evaluated,
    curves: &mut [Curves],
    context: RunContext<'_>,
) -> Result<GradientReport, EvaluationError> {
    let tables = plan.problem.tables(x)?;
    let mut rows = Vec::new();
    let mut weakly_active_cells = 0;
    for (c, table) in tables.iter().enumerate() {
        let model = plan.problem.model(c, x)?;
        weakly_active_cells += observe::weakly_active(&model, &at.orbits[c]);
        rows.extend(case_rows(study, plan, c, x, at, table, context));
        if let Some(curves) = curves.get_mut(c) {
            curves.sensitivity = sensitivity::maps(plan, c, x, at, table, context.cancel);
        }
    }
    let closure = tables.iter().fold(0.0f64, |a, t| a.max(t.closure));
    let sweeps = tables.iter().fold(0.0f64, |a, t| a.max(t.sweeps));
    let gap_sensitivity = curves.iter().filter_map(sensitivity::summary).collect();
    Ok(GradientReport { engine: study.engine, rows, closure, sweeps, weakly_active_cells, gap_sensitivity })
}

fn case_rows(
    study: &Study,
    plan: &Plan,
    c: usize,
    x: &[f64],
    at: &Evaluated,
    table: &GradientTable,
    context: RunContext<'_>,
) -> Vec<GradientRow> {
    let case = &plan.problem.cases()[c];
    // A direction without symmetry, so that errors of single parameters cannot cancel.
    let direction: Vec<f64> = (0..case.variables.len()).map(|j| [0.6, -0.8, 1.0, 0.4][j % 4]).collect();
    let proof = plan.problem.model(c, x).ok().and_then(|model| {
        let orbit = &at.orbits[c];
        taylor_table(
            &model,
            orbit,
            &case.options,
            &case.quantities,
            table,
            &direction,
            TAYLOR,
            context.cancel,
        )
        .ok()
    });
    plan.quantities[c]
        .iter()
        .enumerate()
        .map(|(k, quantity)| {
            let (unit, scale) = quantity.unit();
            let check = proof.as_ref().map(|p| p[k].clone()).unwrap_or_default();
            let all: Vec<&super::ParameterPlan> = study.variables().collect();
            let parameters: Vec<&super::ParameterPlan> = case.variables.iter().map(|&j| all[j]).collect();
            GradientRow {
                quantity: quantity.key().to_owned(),
                bearing: study.bearings[plan.cases[c].bearing].name.clone(),
                operating_point: study.points[plan.cases[c].point].name.clone(),
                parameters: parameters.iter().map(|p| p.name.clone()).collect(),
                values: table.rows[k]
                    .iter()
                    .zip(&parameters)
                    .map(|(g, p)| g / scale * p.variable.scale.0)
                    .collect(),
                units: parameters.iter().map(|p| p.variable.slope_unit(unit)).collect(),
                verdict: crate::gradient::verdict(&check),
                check,
            }
        })
        .collect()
}

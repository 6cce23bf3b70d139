//! The proof of a study's gradients at its start design: the check of the gradient floor with names, units and the kinks
//! that only the film knows of.

use super::build::{Plan, plan};
use super::check::Study;
use super::engines::{Sweep, shown};
use super::observe;
use super::plans::ParameterPlan;
use crate::gradient::{CheckPlan, EngineName, GradientCheck, GradientError, QuantityCheck, check_gradient};
use crate::gradient::{Difference, DifferenceStep};
use crate::optimise::EvaluationError;
use crate::orbit::{Orbit, OrbitError};
use crate::report::{BestError, DifferenceRow, ProvenCase, ProvenQuantity};
use crate::run::{Event, RunContext};

impl Study {
    /// Perturbations with which its gradient is checked: those of its comparison, or from 1e-3 to 1e-8.
    pub fn check_perturbations(&self) -> Vec<f64> {
        self.comparison.as_ref().map_or_else(|| Sweep::wide().0, |c| c.perturbations.clone())
    }
}

/// Proves the gradient of every bearing at every operating point.
pub fn prove(
    study: &Study,
    perturbations: &[f64],
    context: RunContext<'_>,
) -> Result<Vec<ProvenCase>, EvaluationError> {
    let plan = plan(study, EngineName::Adj, context).map_err(|e| EvaluationError::Failed(e.to_string()))?;
    context.progress.tell(&Event::Stage { name: "simulating".to_owned() });
    let at = plan.problem.evaluated(&plan.start)?;
    (0..plan.cases.len())
        .map(|c| prove_case(study, &plan, c, &at.orbits[c], perturbations, context))
        .collect()
}

/// Proves the gradient of one case at its settled cycle.
pub(super) fn prove_case(
    study: &Study,
    plan: &Plan,
    case: usize,
    orbit: &Orbit,
    perturbations: &[f64],
    context: RunContext<'_>,
) -> Result<ProvenCase, EvaluationError> {
    let label = plan.cases[case];
    let (bearing, point) = (&study.bearings[label.bearing].name, &study.points[label.point].name);
    context.progress.tell(&Event::Stage { name: format!("checking the gradient of {bearing}, {point}") });
    let (asked, model) = (&plan.problem.cases()[case], plan.problem.model(case, &plan.start)?);
    let parameters: Vec<&ParameterPlan> = asked.variables.iter().map(|&j| &study.parameters[j]).collect();
    let names: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
    let usual = CheckPlan::usual(asked.quantities.clone(), names.clone());
    let wanted = CheckPlan { perturbations: perturbations.to_vec(), ..usual };
    let check = check_gradient(&model, orbit, &asked.options, &wanted, context.cancel).map_err(failure)?;
    let failed =
        |s: &DifferenceStep| Some(format!("perturbation {:.0e}: {}", s.perturbation, s.failure.as_ref()?));
    Ok(ProvenCase {
        bearing: bearing.clone(),
        operating_point: point.clone(),
        parameters: names,
        weakly_active_cells: observe::weakly_active(&model, orbit),
        closure: check.adj.closure.max(check.tra.closure),
        failures: check.steps.iter().filter_map(failed).collect(),
        difference_cost: check.steps.iter().flat_map(|s| s.cost).sum(),
        quantities: (0..check.quantities.len())
            .map(|k| quantity(plan, case, k, &parameters, &check))
            .collect(),
    })
}

/// A failure of the gradient floor in the words of the floors above.
pub(super) fn failure(e: GradientError) -> EvaluationError {
    match e {
        GradientError::Cancelled(_) | GradientError::Orbit(OrbitError::Cancelled(_)) => {
            EvaluationError::Cancelled
        }
        other => EvaluationError::Failed(other.to_string()),
    }
}

/// One quantity in the units of reports.
fn quantity(
    plan: &Plan,
    case: usize,
    k: usize,
    parameters: &[&ParameterPlan],
    check: &GradientCheck,
) -> ProvenQuantity {
    let (name, found) = (plan.quantities[case][k], &check.quantities[k]);
    let (unit, scale) = name.unit();
    let row = |row: &Vec<f64>| shown(std::slice::from_ref(row), &[name], parameters).swap_remove(0);
    let differences = differences(check, found, k, &row);
    let [ahead, behind, expected] = found.slopes;
    ProvenQuantity {
        quantity: name.key().to_owned(),
        value: found.value / scale,
        unit: unit.to_owned(),
        finding: found.verdict.finding,
        verdict: found.verdict.words.clone(),
        most_by: found.verdict.parameter.map(|j| parameters[j].name.clone()),
        mismatch: found.mismatch,
        units: parameters.iter().map(|p| p.variable.slope_unit(unit)).collect(),
        adj: row(&check.adj.rows[k]),
        tra: row(&check.tra.rows[k]),
        best: best(&differences),
        differences,
        taylor_ahead: found.ahead.clone(),
        taylor_behind: found.behind.clone(),
        slope_ratios: (expected != 0.0).then(|| [ahead, behind].map(|s| s / expected)),
    }
}

/// The differences of one quantity, those of each engine together.
fn differences(
    check: &GradientCheck,
    found: &QuantityCheck,
    k: usize,
    row: &impl Fn(&Vec<f64>) -> Vec<f64>,
) -> Vec<DifferenceRow> {
    let kinds = [
        (EngineName::Fw, Difference::Forward),
        (EngineName::Bw, Difference::Backward),
        (EngineName::Cen, Difference::Central),
    ];
    let mut rows = Vec::new();
    for (e, (engine, kind)) in kinds.into_iter().enumerate() {
        for (step, errors) in check.steps.iter().zip(&found.errors) {
            let Some(errors) = errors else { continue };
            let values = row(&step.rows(kind)[k]);
            rows.push(DifferenceRow { engine, perturbation: step.perturbation, error: errors[e], values });
        }
    }
    rows
}

fn best(rows: &[DifferenceRow]) -> Vec<BestError> {
    let of = |rows: &[DifferenceRow]| {
        let closest = rows.iter().min_by(|a, b| a.error.total_cmp(&b.error))?;
        let DifferenceRow { engine, perturbation, error, .. } = *closest;
        Some(BestError { engine, perturbation, error })
    };
    rows.chunk_by(|a, b| a.engine == b.engine).filter_map(of).collect()
}

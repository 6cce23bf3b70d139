//! The run: simulate the start, search, look at what was found, prove the gradient there.

use super::build::{Plan, plan};
use super::check::Study;
use super::faults::pointer;
use super::methods::methods;
use super::pareto::front;
use super::searches::{rivals, searches};
use super::vocabulary::QuantityName;
use super::{observe, sensitivity};
use crate::gradient::{GradientTable, taylor_table};
use crate::optimise::{ConstrainedProblem, Evaluated, EvaluationError, Minimum, Outcome, Sense, curvature};
use crate::report::{
    Assumption, AtBound, CaseLoss, ConstraintReport, CostReport, Curves, DesignValue, Findings,
    GradientReport, GradientRow, KktReport, ObjectiveReport, OutcomeReport, Provenance, REPORT_FORMAT,
    Report,
};
use crate::run::{Cancel, Event, NoStore, RunContext, Store};
use crate::units::tidy;
use std::sync::Arc;
use std::time::Instant;

/// A parameter closer to a bound than this share of its box stands at it.
const AT_BOUND: f64 = 1e-6;
/// Relative distance from its limit up to which a constraint can be active.
const ACTIVE_GAP: f64 = 1e-4;
/// Relative violation that counts as none.
const FEASIBLE: f64 = 1e-7;
/// A constraint whose multiplier exceeds this share of the objective is active.
const ACTIVE: f64 = 1e-6;
/// First step (relative) and number of steps of the Taylor test.
const TAYLOR: (f64, usize) = (1e-4, 6);

/// Runs a study to its end, whatever that is: failures to converge are outcomes in the report.
pub fn run(study: &Study, context: RunContext<'_>) -> Findings {
    run_saved(study, context, &NoStore)
}

/// The same with checkpoints: a run that was stopped goes on where it was, to the same report.
pub fn run_saved<'r>(study: &Study, context: RunContext<'r>, store: &'r dyn Store) -> Findings {
    let began = Instant::now();
    let stage = |name: &str| context.progress.tell(&Event::Stage { name: name.to_owned() });
    stage("optimising");
    let searched = match searches(study, context, store) {
        Ok(found) => found,
        Err(reason) => return failed(study, reason, began),
    };
    let (plan, minimum) = (&searched.plan, &searched.minimum);
    stage("checking the design");
    let known = minimum.values.as_ref().and_then(|_| revisit(study, plan, minimum, context));
    let mut findings = report(study, plan, minimum, known, context);
    findings.report.rivals = rivals(study, context, store);
    findings.report.pareto = front(study, &searched, context, store);
    findings.report.starts = searched.starts;
    let cost = &mut findings.report.cost;
    let (simulations, gradients) = searched.others;
    cost.total += simulations + gradients;
    cost.gradients += gradients;
    cost.seconds = began.elapsed().as_secs_f64();
    findings
}

/// Cycles at start and optimum.
struct Known {
    start: Option<Arc<Evaluated>>,
    optimum: Arc<Evaluated>,
}

/// The cycles at both designs, from the search's memory where it still holds them. A run that was cancelled simulates what is
/// missing all the same: a report without its design would be worth nothing.
fn revisit(study: &Study, search: &Plan, minimum: &Minimum, context: RunContext<'_>) -> Option<Known> {
    let patient = Cancel::default();
    let fresh = plan(study, study.engine, RunContext { cancel: &patient, ..context }).ok()?;
    let at = |x: &[f64]| search.problem.evaluated(x).or_else(|_| fresh.problem.evaluated(x)).ok();
    Some(Known { optimum: at(&minimum.x)?, start: at(&search.start) })
}

fn report(
    study: &Study,
    plan: &Plan,
    minimum: &Minimum,
    known: Option<Known>,
    context: RunContext<'_>,
) -> Findings {
    let mut findings = blank(study, minimum.outcome, minimum.failures.clone());
    let report = &mut findings.report;
    report.design = design(study, &minimum.x);
    report.kkt.residual = minimum.kkt.is_finite().then_some(minimum.kkt);
    report.kkt.combined = minimum.combined as u64;
    report.history = minimum.history.clone();
    if let Some(known) = &known {
        report.objective = objective(study, plan, known);
        let start = known.start.as_deref();
        let mut all: Vec<Curves> = (0..plan.cases.len())
            .filter_map(|c| observe::curves(study, plan, c, &minimum.x, &known.optimum, start))
            .collect();
        for (case, c) in all.iter().enumerate() {
            let orbit = &known.optimum.orbits[case];
            if let Some(model) = observe::found(plan, case, &minimum.x, orbit) {
                report.orbit.push(observe::orbit_report(&model, orbit, c));
            }
        }
        report.constraints = constraints(study, plan, minimum, &known.optimum, &all);
        if report.constraints.iter().any(|c| !c.met) {
            // A design that breaks its limits saves nothing.
            report.objective.saving_percent = None;
        }
        if minimum.outcome != Outcome::Cancelled {
            if matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged) {
                report.kkt.curvature = curvature(&plan.problem, &minimum.x, &minimum.multipliers).ok();
                report.kkt.verdict = report.kkt.curvature.as_ref().map(|c| c.verdict().to_owned());
            }
            report.gradient = gradient(study, plan, &minimum.x, &known.optimum, &mut all, context).ok();
            price_parameters(study, plan, minimum, &mut report.design);
        }
        findings.curves = all;
    }
    let (simulations, gradients) = plan.problem.costs();
    let total = simulations + gradients;
    findings.report.cost = CostReport { total, gradients, gradient_calls: minimum.gradients, seconds: 0.0 };
    findings
}

fn failed(study: &Study, reason: String, began: Instant) -> Findings {
    let mut findings = blank(study, Outcome::StartFailed, vec![reason]);
    let start: Vec<f64> = study.parameters.iter().map(|p| p.start).collect();
    findings.report.design = design(study, &start);
    findings.report.cost.seconds = began.elapsed().as_secs_f64();
    findings
}

/// A report without results.
fn blank(study: &Study, status: Outcome, mut refused: Vec<String>) -> Findings {
    refused.dedup();
    let text = |given: &super::Given<String>| given.value().cloned();
    let report = Report {
        schema_version: REPORT_FORMAT.to_owned(),
        study_hash: study.hash.clone(),
        title: text(&study.file.title).unwrap_or_default(),
        question: text(&study.file.question),
        outcome: OutcomeReport { status, advice: status.advice().to_owned(), refused },
        design: Vec::new(),
        objective: ObjectiveReport {
            quantity: "weighted mean friction loss of all bearings, W".to_owned(),
            start: None,
            optimum: None,
            saving_percent: None,
            operating_points: Vec::new(),
        },
        constraints: unknown_constraints(study),
        kkt: KktReport {
            residual: None,
            combined: 1,
            tolerance: study.optimiser.options.settings.tolerance,
            curvature: None,
            verdict: None,
        },
        cylinder_pressure: observe::cylinder(study).0,
        gradient: None,
        orbit: Vec::new(),
        history: Vec::new(),
        starts: None,
        pareto: None,
        rivals: Vec::new(),
        cost: CostReport {
            total: Default::default(),
            gradients: Default::default(),
            gradient_calls: 0,
            seconds: 0.0,
        },
        assumptions: assumptions(study),
        provenance: provenance(study),
    };
    Findings { report, curves: Vec::new(), cylinder: observe::cylinder(study).1 }
}

/// What the answer to a study rests on.
pub(super) fn provenance(study: &Study) -> Provenance {
    Provenance {
        program: env!("CARGO_PKG_NAME").to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        methods: methods(study),
        study: study.to_json(),
    }
}

fn design(study: &Study, x: &[f64]) -> Vec<DesignValue> {
    let value = |(p, x): (&super::ParameterPlan, &f64)| {
        let shown = |v: f64| tidy(p.variable.shown(v));
        let near = AT_BOUND * (p.upper - p.lower);
        let at_bound = if *x <= p.lower + near {
            AtBound::Lower
        } else if *x >= p.upper - near {
            AtBound::Upper
        } else {
            AtBound::No
        };
        DesignValue {
            name: p.name.clone(),
            value: shown(*x),
            unit: p.variable.unit.to_owned(),
            start: shown(p.start),
            lower: shown(p.lower),
            upper: shown(p.upper),
            at_bound,
            moved: (x - p.start) / (p.upper - p.lower),
            effect_w_per_percent: None,
            bound_price_w_per_unit: None,
        }
    };
    study.parameters.iter().zip(x).map(value).collect()
}

/// What a little more of each parameter, or of room for it, does to the loss.
fn price_parameters(study: &Study, plan: &Plan, minimum: &Minimum, design: &mut [DesignValue]) {
    let Ok(slopes) = plan.problem.slopes(&minimum.x) else { return };
    let optimal = matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged);
    for (j, (d, p)) in design.iter_mut().zip(&study.parameters).enumerate() {
        let width = p.upper - p.lower;
        d.effect_w_per_percent = Some(0.01 * width * slopes.objective[j]);
        let price = match d.at_bound {
            AtBound::No => None,
            AtBound::Lower => minimum.multipliers.lower.get(j),
            AtBound::Upper => minimum.multipliers.upper.get(j),
        };
        d.bound_price_w_per_unit = price.filter(|_| optimal).map(|m| m / width * p.variable.scale.0);
    }
}

fn objective(study: &Study, plan: &Plan, known: &Known) -> ObjectiveReport {
    let total = |at: &Evaluated| observe::total_loss(study, &plan.cases, at);
    let start = known.start.as_deref().map(total);
    let optimum = total(&known.optimum);
    let operating_points = plan.cases.iter().enumerate().map(|(c, label)| CaseLoss {
        operating_point: study.points[label.point].name.clone(),
        bearing: study.bearings[label.bearing].name.clone(),
        count: study.bearings[label.bearing].count,
        weight: study.points[label.point].weight,
        start: known.start.as_ref().map(|s| observe::loss(&s.orbits[c])),
        optimum: Some(observe::loss(&known.optimum.orbits[c])),
    });
    ObjectiveReport {
        quantity: "weighted mean friction loss of all bearings, W".to_owned(),
        start,
        optimum: Some(optimum),
        saving_percent: start.map(|s| 100.0 * (1.0 - optimum.total_w / s.total_w)),
        operating_points: operating_points.collect(),
    }
}

/// The limits when no design was simulated.
fn unknown_constraints(study: &Study) -> Vec<ConstraintReport> {
    let all = study.constraints.iter().flat_map(|c| {
        let bearings = (0..study.bearings.len()).filter(|b| c.bearing.is_none_or(|only| only == *b));
        bearings.flat_map(move |b| study.points.iter().map(move |p| (c, b, p)))
    });
    all.map(|(c, bearing, point)| {
        let (unit, _) = c.quantity.unit();
        ConstraintReport {
            quantity: c.quantity.key().to_owned(),
            bearing: study.bearings[bearing].name.clone(),
            operating_point: point.name.clone(),
            sense: words(c.sense).to_owned(),
            value: None,
            exact_value: None,
            bias: None,
            limit: tidy(c.quantity.shown(c.limit)),
            unit: unit.to_owned(),
            active: false,
            met: false,
            price_w_per_unit: None,
        }
    })
    .collect()
}

pub(super) fn words(sense: Sense) -> &'static str {
    match sense {
        Sense::AtLeast => "at least",
        Sense::AtMost => "at most",
    }
}

fn constraints(
    study: &Study,
    plan: &Plan,
    minimum: &Minimum,
    at: &Evaluated,
    curves: &[Curves],
) -> Vec<ConstraintReport> {
    let objective = minimum.values.as_ref().map_or(1.0, |v| v.objective.abs());
    let optimal = matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged);
    let row = |(k, label): (usize, &super::LimitLabel)| {
        let (c, case) = (&study.constraints[label.constraint], plan.cases[label.case]);
        let (unit, scale) = c.quantity.unit();
        let (smooth, exact) = c.quantity.of_cycle(study.sharpness);
        let orbit = &at.orbits[label.case];
        let multiplier = minimum.multipliers.inequalities.get(k).copied().unwrap_or(0.0);
        let value = orbit.value(&smooth);
        let excess = match c.sense {
            Sense::AtLeast => 1.0 - value / c.limit,
            Sense::AtMost => value / c.limit - 1.0,
        };
        let active = excess > -ACTIVE_GAP && multiplier > ACTIVE * objective;
        // Outputs hold the smooth extremum over the cells; the exact one stands in the curves.
        let largest = |curve: &[f64]| curve.iter().copied().fold(0.0, f64::max);
        let exact_value = match c.quantity {
            QuantityName::MaxFilmPressure => largest(&curves[label.case].pressure_max_mpa),
            QuantityName::MaxContactPressure => largest(&curves[label.case].contact_max_mpa),
            QuantityName::MinFilmThickness => {
                curves[label.case].film_min_um.iter().copied().fold(f64::INFINITY, f64::min)
            }
            _ => c.quantity.shown(orbit.value(&exact)),
        };
        ConstraintReport {
            quantity: c.quantity.key().to_owned(),
            bearing: study.bearings[case.bearing].name.clone(),
            operating_point: study.points[case.point].name.clone(),
            sense: words(c.sense).to_owned(),
            value: Some(c.quantity.shown(value)),
            exact_value: Some(exact_value),
            bias: Some(c.quantity.shown(value) - exact_value),
            limit: tidy(c.quantity.shown(c.limit)),
            unit: unit.to_owned(),
            active,
            met: excess <= study.optimiser.options.settings.tolerance.max(FEASIBLE),
            price_w_per_unit: optimal.then_some(if active { multiplier / c.limit * scale } else { 0.0 }),
        }
    };
    plan.limits.iter().enumerate().map(row).collect()
}

fn gradient(
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
            let parameters: Vec<&super::ParameterPlan> =
                case.variables.iter().map(|&j| &study.parameters[j]).collect();
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

pub(super) fn assumptions(study: &Study) -> Vec<Assumption> {
    let values = study.to_json();
    let map = study.file.assumptions.value().cloned().unwrap_or_default();
    map.into_iter()
        .map(|(key, reason)| {
            let found = values.pointer(&pointer(&key));
            let value =
                found.map_or_else(String::new, |v| v.as_str().map_or_else(|| v.to_string(), str::to_owned));
            Assumption { key, value, reason }
        })
        .collect()
}

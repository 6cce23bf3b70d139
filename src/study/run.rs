//! The run: simulate the start, search, look at what was found, prove the gradient there.

use super::answer::{Known, design, objective, objective_words, price_parameters};
use super::build::{Plan, plan};
use super::check::Study;
use super::choices::choose;
use super::evidence::gradient;
use super::limits::{constraints, linear, unknown_constraints};
use super::methods::{methods, references};
use super::pareto::front;
use super::place::find;
use super::searches::{Searched, rivals, searches, simulated};
use super::{observe, robust, run_in};
use crate::optimise::{Minimum, Outcome, curvature};
use crate::report::{
    Assumption, ChoicesReport, CostReport, Curves, Findings, KktReport, ObjectiveReport, OutcomeReport,
    Provenance, REPORT_FORMAT, Report, ReportTiming, headline, word,
};
use crate::run::{Cancel, Cost, Event, NoStore, RunContext, Store};
use std::time::Instant;

/// Runs a study to its end, whatever that is: failures to converge are outcomes in the report.
pub fn run(study: &Study, context: RunContext<'_>) -> Findings {
    run_saved(study, context, &NoStore)
}

/// Simulates the start design, and runs it in if the study says how; nothing is searched.
pub fn simulate(study: &Study, context: RunContext<'_>) -> Findings {
    let began = Instant::now();
    let study = &study.without_search();
    tell(context, "simulating");
    match simulated(study, context) {
        Ok(found) => answered(study, (study, found, None), (context, &NoStore), began),
        Err(reason) => failed(study, reason, began),
    }
}

/// The same with checkpoints: a run that was stopped goes on where it was, to the same report.
pub fn run_saved<'r>(study: &Study, context: RunContext<'r>, store: &'r dyn Store) -> Findings {
    let began = Instant::now();
    tell(context, "optimising");
    let found = match &study.choices {
        Some(choices) => choose(choices, context, store).map(|(s, found, table)| (s, found, Some(table))),
        None => searches(study, None, "", context, store).map(|found| (study, found, None)),
    };
    match found {
        Ok(found) => answered(study, found, (context, store), began),
        Err(reason) => failed(study, reason, began),
    }
}

fn tell(context: RunContext<'_>, stage: &str) {
    context.progress.tell(&Event::Stage { name: stage.to_owned() });
}

/// Everything that is known about the design a search of the given study ended with.
fn answered<'r>(
    given: &Study,
    (study, searched, choices): (&Study, Searched<'r>, Option<ChoicesReport>),
    (context, store): (RunContext<'r>, &'r dyn Store),
    began: Instant,
) -> Findings {
    let (plan, minimum) = (&searched.plan, &searched.minimum);
    tell(context, "checking the design");
    let known = minimum.values.as_ref().and_then(|_| revisit(study, plan, minimum, context));
    let optimum = known.as_ref().map(|known| known.optimum.clone());
    let mut findings = report(study, &searched, known, context);
    if let Some(optimum) = optimum {
        if !context.cancel.is_cancelled() {
            findings.report.robust = robust::report(study, plan, &minimum.x, optimum, context);
        }
        findings.report.running_in = run_in::report(study, &searched, context);
        if let Some(r) = findings.report.running_in.as_ref().and_then(|r| r.gradient.as_ref()) {
            let design = findings.report.design.iter_mut().zip(&r.effect_w_per_percent);
            design.for_each(|(d, effect)| d.effect_w_per_percent = Some(*effect));
        }
        let report = &mut findings.report;
        if let Some(r) = report.running_in.as_mut().filter(|r| r.limits.iter().any(|l| !l.met)) {
            // As with its other limits.
            report.objective.saving_percent = None;
            r.minimised.iter_mut().for_each(|m| m.saving_percent = None);
        }
    }
    findings.report.choices = choices;
    findings.report.study_hash = given.hash.clone();
    let (rivals, of_rivals, rivals_s) = rivals(study, context, store);
    findings.report.rivals = rivals;
    let front = front(study, &searched, context, store);
    findings.report.starts = searched.starts;
    // Everything that was simulated for this report, whichever search asked for it.
    let marches = (searched.marches.marches, searched.marches.gradients);
    let all = [plan.problem.costs(), searched.others, of_rivals, marches];
    let mut sum = all.into_iter().fold((Cost::default(), Cost::default()), |a, c| (a.0 + c.0, a.1 + c.1));
    if let Some((front, cost)) = front {
        findings.report.pareto = Some(front);
        sum = (sum.0 + cost.0, sum.1 + cost.1);
    }
    let cost = &mut findings.report.cost;
    cost.total = sum.0 + sum.1;
    cost.gradients = sum.1;
    let report = &mut findings.report;
    if context.cancel.is_cancelled() && report.outcome.status != Outcome::Cancelled {
        // The search had ended, but not everything that the study asks for beside it is there.
        let ended = word(report.outcome.status).replace('-', " ");
        report.outcome.status = Outcome::Cancelled;
        report.outcome.advice = format!(
            "Stopped on request before everything was there that the study asks for; the search itself had ended ({ended}). The \
             same command goes on from there."
        );
    }
    report.timing = ReportTiming { seconds: began.elapsed().as_secs_f64(), rivals_s };
    report.answer = headline(report);
    findings
}

/// The cycles at both designs, from the search's memory where it still holds them. A run that was cancelled simulates what is
/// missing all the same: a report without its design would be worth nothing.
fn revisit(study: &Study, search: &Plan, minimum: &Minimum, context: RunContext<'_>) -> Option<Known> {
    let patient = Cancel::default();
    let fresh = plan(study, study.engine, RunContext { cancel: &patient, ..context }).ok()?;
    let at = |x: &[f64]| search.problem.evaluated(x).or_else(|_| fresh.problem.evaluated(x)).ok();
    Some(Known { optimum: at(&minimum.x)?, start: at(&search.start) })
}

fn report(study: &Study, found: &Searched, known: Option<Known>, context: RunContext<'_>) -> Findings {
    let (plan, minimum) = (&found.plan, &found.minimum);
    let mut findings = blank(study, minimum.outcome, minimum.failures.clone());
    let report = &mut findings.report;
    report.design = design(study, &minimum.x);
    report.kkt.residual = minimum.kkt.is_finite().then_some(minimum.kkt);
    report.kkt.combined = minimum.combined as u64;
    report.kkt.polish_steps = found.polished.map(|p| p.steps);
    report.linear_constraints = linear(study, minimum);
    report.history = minimum.history.clone();
    if let Some(known) = &known {
        report.objective = objective(study, found, known);
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
        if report.constraints.iter().any(|c| !c.met) || report.linear_constraints.iter().any(|l| !l.met) {
            // A design that breaks its limits saves nothing.
            report.objective.saving_percent = None;
        }
        if !matches!(minimum.outcome, Outcome::Cancelled | Outcome::Simulated) {
            report.gradient = gradient(study, plan, &minimum.x, &known.optimum, &mut all, context).ok();
            price_parameters(study, found, &mut report.design);
            let plain = study.robust.is_none() && !study.worst_case && !study.runs_in();
            if plain && matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged) {
                report.kkt.curvature = curvature(&plan.problem, &minimum.x, &minimum.multipliers).ok();
                report.kkt.verdict = report.kkt.curvature.as_ref().map(|c| c.verdict().to_owned());
            }
        }
        findings.curves = all;
    }
    let (simulations, gradients) = plan.problem.costs();
    let total = simulations + gradients;
    findings.report.cost = CostReport { total, gradients, gradient_calls: minimum.gradients };
    findings
}

fn failed(study: &Study, reason: String, began: Instant) -> Findings {
    let mut findings = blank(study, Outcome::StartFailed, vec![reason]);
    let start: Vec<f64> = study.parameters.iter().map(|p| p.start).collect();
    findings.report.design = design(study, &start);
    findings.report.timing.seconds = began.elapsed().as_secs_f64();
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
        answer: Vec::new(),
        outcome: OutcomeReport { status, advice: status.advice().to_owned(), refused },
        design: Vec::new(),
        objective: ObjectiveReport {
            quantity: objective_words(study),
            start: None,
            optimum: None,
            start_violation: None,
            saving_percent: None,
            operating_points: Vec::new(),
            worst_case: Vec::new(),
        },
        constraints: unknown_constraints(study),
        kkt: KktReport {
            residual: None,
            combined: 1,
            polish_steps: None,
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
        robust: None,
        running_in: None,
        choices: None,
        linear_constraints: Vec::new(),
        rivals: Vec::new(),
        cost: CostReport { total: Default::default(), gradients: Default::default(), gradient_calls: 0 },
        expected: Vec::new(),
        timing: ReportTiming::default(),
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
        references: references(study),
        coarse: study.coarse,
        started_from: study.started_from.clone(),
        study: study.to_json(),
    }
}

pub(super) fn assumptions(study: &Study) -> Vec<Assumption> {
    let values = study.to_json();
    let map = study.file.assumptions.value().cloned().unwrap_or_default();
    map.into_iter()
        .map(|(key, reason)| {
            let value = find(&values, &key).map_or_else(String::new, written);
            Assumption { key, value, reason }
        })
        .collect()
}

/// A value as people write it: sections as `key = value`, one after the other.
fn written(value: &serde_json::Value) -> String {
    use serde_json::Value;
    match value {
        Value::String(text) => text.clone(),
        Value::Object(map) => {
            let one = |(key, value): (&String, &Value)| match value {
                Value::Object(_) | Value::Array(_) => format!("{key}: ({})", written(value)),
                _ => format!("{key} {}", written(value)),
            };
            map.iter().map(one).collect::<Vec<_>>().join(", ")
        }
        Value::Array(list) => list.iter().map(written).collect::<Vec<_>>().join("; "),
        other => other.to_string(),
    }
}

//! Experiments made: every study of the layout simulated or searched, as many at once as there are cores.
//!
//! What was found of a study is kept under its hash, so that a rerun, or other experiments with studies in common, computes only
//! what is new. Every study starts from its own start, so the numbers do not depend on the order.

use super::check::Study;
use super::file::EachName;
use super::layout::{ExperimentsPlan, RunPlan};
use super::run::{assumptions, provenance, run_saved, simulate};
use crate::optimise::Outcome;
use crate::report::{
    EXPERIMENTS_FORMAT, ExperimentRun, Experiments, ExperimentsStatus, FactorReport, Report, ReportTiming,
    ResponseReport, effects, experiments_headline, refinements, word,
};
use crate::run::{Event, RunContext, Silent, Store, Within};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// What is kept of a study: its outcome and responses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Kept {
    status: Outcome,
    failure: Option<String>,
    feasible: Option<bool>,
    responses: Vec<Option<f64>>,
}

/// Makes the experiments of a study that has some.
pub fn experiment<'r>(study: &Study, context: RunContext<'r>, store: &'r dyn Store) -> Option<Experiments> {
    let plan = study.experiments.as_ref()?;
    let (began, done) = (Instant::now(), AtomicUsize::new(0));
    let responses = responses(study, plan);
    let total = plan.runs.len();
    context.progress.tell(&Event::Part { done: 0, total });
    let one = |(k, run): (usize, &RunPlan)| {
        let found = kept(plan, run, context, store);
        if found.is_some() {
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            context.progress.tell(&Event::Part { done, total });
        }
        row(k, run, found, responses.len())
    };
    // Handed out one by one: runs differ much in length.
    let runs: Vec<ExperimentRun> = plan.runs.par_iter().enumerate().with_max_len(1).map(one).collect();
    let status = match () {
        () if runs.iter().any(|r| r.status.is_none()) => ExperimentsStatus::Cancelled,
        () if runs.iter().any(|r| r.failure.is_some()) => ExperimentsStatus::Incomplete,
        () => ExperimentsStatus::Complete,
    };
    let factor = |f: &super::factors::Factor| FactorReport {
        name: f.name.clone(),
        unit: f.unit.clone(),
        refinement_ratio: f.ratio,
    };
    let factors: Vec<FactorReport> = plan.factors.iter().map(factor).collect();
    let mut found = Experiments {
        schema_version: EXPERIMENTS_FORMAT.to_owned(),
        study_hash: study.hash.clone(),
        title: study.file.title.value().cloned().unwrap_or_default(),
        question: study.file.question.value().cloned(),
        status,
        answer: Vec::new(),
        plan: word(plan.plan),
        each: word(plan.each),
        best: best(&runs),
        effects: effects(&factors, &responses, &runs),
        refinements: refinements(&factors, &responses, &runs),
        factors,
        responses,
        runs,
        expected: Vec::new(),
        timing: ReportTiming { seconds: began.elapsed().as_secs_f64(), rivals_s: Vec::new() },
        assumptions: assumptions(study),
        provenance: provenance(study),
    };
    found.answer = experiments_headline(&found);
    Some(found)
}

/// Where what was found of a study is kept.
pub(super) fn kept_name(each: EachName, hash: &str) -> String {
    format!("run-{}-{}-{hash}", word(each), env!("CARGO_PKG_VERSION"))
}

/// What was found of a study, now or before; none if it was stopped.
fn kept<'r>(
    plan: &ExperimentsPlan,
    run: &RunPlan,
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> Option<Kept> {
    let name = kept_name(plan.each, &run.study.hash);
    let before = store.recall(&name).and_then(|bytes| serde_json::from_slice(&bytes).ok());
    if before.is_some() || context.cancel.is_cancelled() {
        return before;
    }
    let quiet = RunContext { progress: &Silent, ..context };
    let own = Within { store, prefix: format!("{}-", &run.study.hash[..16]) };
    let findings = match plan.each {
        EachName::Simulate => simulate(&run.study, quiet),
        EachName::Search => run_saved(&run.study, quiet, &own),
    };
    if context.cancel.is_cancelled() {
        return None;
    }
    let found = of(&findings.report, plan.each);
    store.keep(&name, &serde_json::to_vec(&found).unwrap_or_default());
    Some(found)
}

fn row(k: usize, run: &RunPlan, found: Option<Kept>, count: usize) -> ExperimentRun {
    let (status, failure, feasible, mut responses) =
        found.map_or_else(Default::default, |f| (Some(f.status), f.failure, f.feasible, f.responses));
    // A run without an answer has a place for every response all the same.
    responses.resize(count, None);
    ExperimentRun {
        number: k + 1,
        levels: run.levels.iter().map(|l| l.text.clone()).collect(),
        numbers: run.levels.iter().map(|l| l.number).collect(),
        study_hash: run.study.hash.clone(),
        status,
        failure,
        feasible,
        responses,
    }
}

/// The run with the least loss among those that keep all limits.
fn best(runs: &[ExperimentRun]) -> Option<usize> {
    let loss = |r: &&ExperimentRun| r.responses.first().copied().flatten();
    let kept = runs.iter().filter(|r| r.feasible == Some(true) && loss(r).is_some());
    let least = kept.min_by(|a, b| loss(a).partial_cmp(&loss(b)).unwrap_or(std::cmp::Ordering::Equal));
    least.map(|r| r.number)
}

/// What is looked at, the loss first.
fn responses(study: &Study, plan: &ExperimentsPlan) -> Vec<ResponseReport> {
    let new = |key: &str, title: &str, unit: &str| ResponseReport {
        key: key.to_owned(),
        title: title.to_owned(),
        unit: unit.to_owned(),
    };
    let mut all = vec![
        new("mean_friction_loss_w", "mean friction loss", "W"),
        new("contact_loss_w", "contact part", "W"),
        new("min_film_thickness_um", "smallest film", "um"),
        new("max_film_pressure_mpa", "largest film pressure", "MPa"),
        new("max_contact_pressure_mpa", "largest contact pressure", "MPa"),
        new("max_specific_load_mpa", "largest specific load", "MPa"),
        new("side_flow_l_min", "side flow of all bearings", "l/min"),
        new("film_temperature_c", "highest film temperature", "degC"),
    ];
    if plan.each == EachName::Search {
        all.push(new("simulations", "cycles simulated", "1"));
        all.extend(study.parameters.iter().map(|p| new(&p.name, &p.name, p.variable.unit)));
    }
    all
}

/// The responses of a report, in the order of the list.
fn of(report: &Report, each: EachName) -> Kept {
    let orbit = &report.orbit;
    let largest = |of: fn(&crate::report::OrbitReport) -> f64| orbit.iter().map(of).reduce(f64::max);
    let loss = report.objective.optimum.as_ref();
    let mut responses = vec![
        loss.map(|l| l.total_w),
        loss.map(|l| l.contact_w),
        orbit.iter().map(|o| o.min_film_thickness_um.value).reduce(f64::min),
        largest(|o| o.max_film_pressure_mpa.value),
        largest(|o| o.max_contact_pressure_mpa.value),
        largest(|o| o.max_specific_load_mpa.value),
        (!orbit.is_empty()).then(|| orbit.iter().map(|o| o.mean_side_flow_l_min).sum()),
        largest(|o| o.film_temperature_c),
    ];
    if each == EachName::Search {
        responses.push(Some(report.cost.total.simulations as f64));
        responses.extend(report.design.iter().map(|d| Some(d.value)));
    }
    let known = loss.is_some();
    let met = report.constraints.iter().all(|c| c.met) && report.linear_constraints.iter().all(|l| l.met);
    let status = report.outcome.status;
    let failure = (!known).then(|| match report.outcome.refused.last() {
        Some(reason) => reason.clone(),
        None => status.advice().to_owned(),
    });
    Kept { status, failure, feasible: known.then_some(met), responses }
}

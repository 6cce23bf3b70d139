//! How much work a study will be, before any of it is done: counts from the study, and the time of one cycle measured on the spot.
//!
//! The number of designs a search takes is not known before; told is what searches like it have taken (`SEARCH`) and the most the
//! study grants. Deliberately not here: any promise.

use super::build::plan;
use super::characteristic::Vary;
use super::check::Study;
use super::file::EachName;
use super::layout::RunPlan;
use crate::gradient::EngineName;
use crate::orbit::settle;
use crate::run::{Cancel, RunContext, Silent, Store};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Designs a search takes to 1e-6 as a rule: a few more with many parameters. As found on the studies of this repository.
const SEARCH: f64 = 9.0;
const PER_PARAMETER: f64 = 0.1;
/// Cycles of a march through a stage of running-in, with what is solved again at its end.
const STAGE: f64 = 12.0;
/// Work of a gradient of all quantities by ADJ, in simulations; what TRA takes per parameter, CEN, FW and BW.
const ADJ: f64 = 0.45;
const TRA: f64 = 0.4;
const CEN: f64 = 0.75;
/// Longest measurement of one cycle.
const PATIENCE: Duration = Duration::from_secs(10);

/// What is to be expected.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// What will be done, in words.
    pub work: String,
    /// Bearings times operating points.
    pub cases: usize,
    /// Cells of the largest film.
    pub cells: usize,
    /// Steps per cycle.
    pub steps: usize,
    /// Working cycles, gradients converted; an expectation for searches.
    pub cycles: f64,
    /// Most cycles the study's limits allow; none where the count is known.
    pub most_cycles: Option<f64>,
    /// Memory for the recordings of the cycles held at a time, MB.
    pub memory_mb: f64,
    /// Runs whose numbers are known from before; none without experiments.
    pub kept: Option<usize>,
    /// Time of one cycle of one bearing, measured, s; none if it took longer than ten seconds, or there is none.
    pub cycle_s: Option<f64>,
    /// Time of everything on these cores, s.
    pub seconds: Option<f64>,
}

/// The estimate of a study, whose results of before are in the store.
pub fn estimate(study: &Study, store: &dyn Store) -> Estimate {
    let cases = study.bearings.len() * study.points.len();
    let new: Option<Vec<&RunPlan>> =
        study.experiments.as_ref().map(|e| e.runs.iter().filter(|r| !known(r, e.each, store)).collect());
    let kept = new.as_ref().map(|new| study.experiments().count() - new.len());
    let (work, cycles, most) = amount(study, new.as_deref().unwrap_or_default());
    let cycle_s = measured(study);
    // Bearings, operating points and runs share the cores.
    let width = rayon::current_num_threads() as f64;
    let at_once = cases.max(study.experiments().count()).max(study.optimiser.starts as usize).max(1) as f64;
    let seconds = cycle_s.map(|s| s * cycles / width.min(at_once));
    let states = |b: usize| (study.cells(b) * study.orbit.steps * size_of::<f64>()) as f64;
    let held: f64 = (0..study.bearings.len()).map(states).sum::<f64>() * study.points.len().max(1) as f64;
    Estimate {
        work,
        cases,
        cells: (0..study.bearings.len()).map(|b| study.cells(b)).max().unwrap_or(0),
        steps: study.orbit.steps,
        cycles,
        most_cycles: most,
        memory_mb: held * 1e-6,
        kept,
        cycle_s,
        seconds,
    }
}

fn known(run: &RunPlan, each: EachName, store: &dyn Store) -> bool {
    store.recall(&super::experiment::kept_name(each, &run.study.hash)).is_some()
}

/// Work in words, cycles expected, cycles at most; of experiments the new runs count.
fn amount(study: &Study, new: &[&RunPlan]) -> (String, f64, Option<f64>) {
    let cases = (study.bearings.len() * study.points.len()) as f64;
    let parameters = study.parameters.len() as f64;
    if let Some(plan) = &study.characteristic {
        let bearings = study.bearings.len();
        return match &plan.vary {
            Vary::Eccentricity { ratios, .. } => {
                (format!("{} films at rest", ratios.len() * bearings), 0.0, None)
            }
            Vary::Speed(speeds) => {
                let cycles = speeds.len() * bearings;
                (format!("{cycles} points of a curve"), cycles as f64, None)
            }
        };
    }
    if let Some(plan) = &study.comparison {
        let differences = 2.0 * parameters * plan.perturbations.len() as f64;
        let counts: f64 = plan.counts.iter().map(|k| *k as f64).sum();
        let cycles = cases * (1.0 + CEN / 2.0 * differences + counts * (2.0 * CEN + TRA));
        return (
            format!("{differences} differences and {} costs by engine", plan.counts.len()),
            cycles,
            None,
        );
    }
    if let Some(plan) = &study.experiments {
        let (mut cycles, mut most) = (0.0, 0.0);
        let own = (study.cells(0) * study.orbit.steps) as f64;
        for run in new {
            let size = (run.study.cells(0) * run.study.orbit.steps) as f64 / own;
            let (one, limit) = match plan.each {
                EachName::Simulate => ((run.study.points.len() * run.study.bearings.len()) as f64, None),
                EachName::Search => searched(&run.study),
            };
            cycles += one * size;
            most += limit.unwrap_or(one) * size;
        }
        let limit = (plan.each == EachName::Search).then_some(most);
        return (format!("{} of {} runs", new.len(), plan.runs.len()), cycles, limit);
    }
    let (cycles, most) = searched(study);
    let mut words = vec![format!("a search over {parameters} parameters")];
    words.extend((study.optimiser.starts > 1).then(|| format!("from {} starts", study.optimiser.starts)));
    words.extend(study.choices.as_ref().map(|c| format!("for each of {} combinations", c.variants.len())));
    words.extend(study.pareto.as_ref().map(|p| format!("and {} points of a front", p.limits.len())));
    words.extend(study.running_in.is_some().then(|| "and a running-in".to_owned()));
    (words.join(" "), cycles, most)
}

/// Cycles of a search with all that belongs to it: expected, and at most.
fn searched(study: &Study) -> (f64, Option<f64>) {
    let cases = (study.bearings.len() * study.points.len()) as f64;
    let parameters = study.parameters.len() as f64;
    let gradient = match study.engine {
        EngineName::Adj => ADJ,
        EngineName::Tra => TRA * parameters,
        EngineName::Cen => 2.0 * CEN * parameters,
        EngineName::Fw | EngineName::Bw => CEN * parameters,
    };
    let settings = &study.optimiser.options.settings;
    let most = settings.max_iterations as f64;
    let mut searches = study.optimiser.starts.max(1) as f64 + study.optimiser.rivals.len() as f64;
    searches *= study.choices.as_ref().map_or(1.0, |c| c.variants.len() as f64);
    searches += study.pareto.as_ref().map_or(0.0, |p| p.limits.len() as f64);
    let designs = (SEARCH + PER_PARAMETER * parameters).min(most);
    let mut each = cases * (1.0 + gradient);
    let stages = study.running_in.as_ref().map_or(0.0, |r| r.stages.len() as f64);
    let march = STAGE * stages * study.bearings.len() as f64;
    if study.runs_in() {
        each = march * (1.0 + gradient);
    }
    let drawn = study.robust.as_ref().map_or(0.0, |r| r.samples as f64) * cases;
    (each * designs * searches + march + drawn, Some(each * most * searches + march + drawn))
}

/// Time of one cycle of the first case from a cold start.
fn measured(study: &Study) -> Option<f64> {
    if study.points.is_empty() {
        return None;
    }
    let cancel = Cancel::default();
    let context = RunContext { cancel: &cancel, progress: &Silent };
    let plan = plan(&study.without_search(), study.engine, context).ok()?;
    let case = plan.problem.cases().first()?;
    let (done, ended) = std::sync::mpsc::channel::<()>();
    let began = Instant::now();
    std::thread::scope(|scope| {
        let flag = cancel.clone();
        scope.spawn(move || {
            if ended.recv_timeout(PATIENCE) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
                flag.cancel();
            }
        });
        let found = settle(&case.model, &case.options, None, &cancel);
        drop(done);
        found.is_ok().then(|| began.elapsed().as_secs_f64())
    })
}

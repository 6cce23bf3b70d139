//! The comparison of the gradient engines: proof of the gradients, cost over the number of parameters.
//!
//! Costs are measured one after the other on one thread, each against the simulation from a cold start, so that wall times
//! can be compared; the differences of the proof run in parallel and are not timed.

use super::build::{Plan, plan};
use super::check::Study;
use super::comparison::{ComparisonPlan, is_difference};
use super::prove::{failure, prove_case};
use super::run::{assumptions, provenance};
use crate::cranktrain::{BearingSetup, JournalBearing};
use crate::gradient::{EngineName, GradientTable, engine};
use crate::optimise::EvaluationError;
use crate::orbit::{Orbit, settle};
use crate::report::{
    COMPARISON_FORMAT, CaseTiming, ComparedCase, Comparison, ComparisonStatus, EngineCost, EngineTime,
    SpeedUp, Timing, comparison_headline,
};
use crate::run::{Event, RunContext};
use std::time::Instant;

/// Times something quick is done; the quickest counts.
const REPEATS: usize = 3;

/// Compares the engines on a study that has a comparison.
pub fn compare(study: &Study, context: RunContext<'_>) -> Option<Comparison> {
    let wanted = study.comparison.as_ref()?;
    let began = Instant::now();
    let (mut cases, mut timing, mut failures) = (Vec::new(), Timing::default(), Vec::new());
    let stop = compare_all(study, wanted, context, &mut cases, &mut timing.cases).err();
    failures.extend(cases.iter().flat_map(|c: &ComparedCase| {
        let name = format!("{}, {}", c.proof.bearing, c.proof.operating_point);
        c.proof.failures.iter().map(move |f| format!("{name}, {f}"))
    }));
    failures.extend(stop.iter().filter(|e| **e != EvaluationError::Cancelled).map(ToString::to_string));
    let status = match (&stop, failures.is_empty()) {
        (Some(EvaluationError::Cancelled), _) => ComparisonStatus::Cancelled,
        (_, true) => ComparisonStatus::Complete,
        (_, false) => ComparisonStatus::Incomplete,
    };
    timing.seconds = began.elapsed().as_secs_f64();
    let mut found = Comparison {
        schema_version: COMPARISON_FORMAT.to_owned(),
        study_hash: study.hash.clone(),
        title: study.file.title.value().cloned().unwrap_or_default(),
        question: study.file.question.value().cloned(),
        status,
        answer: Vec::new(),
        failures,
        engines: wanted.engines.clone(),
        perturbation: study.perturbation,
        cases,
        expected: Vec::new(),
        timing,
        assumptions: assumptions(study),
        provenance: provenance(study),
    };
    found.answer = comparison_headline(&found);
    Some(found)
}

/// One case after the other; what is finished stays if one fails.
fn compare_all(
    study: &Study,
    wanted: &ComparisonPlan,
    context: RunContext<'_>,
    cases: &mut Vec<ComparedCase>,
    timing: &mut Vec<CaseTiming>,
) -> Result<(), EvaluationError> {
    let failed = |e: String| EvaluationError::Failed(e);
    let plan = plan(study, EngineName::Adj, context).map_err(|e| failed(e.to_string()))?;
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| failed(e.to_string()))?;
    for c in 0..plan.cases.len() {
        let bench = Bench { study, wanted, plan: &plan, case: c, context };
        let (orbit, simulation_s) = alone.install(|| bench.simulate())?;
        let proof = prove_case(study, &plan, c, &orbit, &wanted.perturbations, context)?;
        let (costs, engines) = alone.install(|| bench.costs(&orbit, simulation_s))?;
        let mut counts: Vec<usize> = costs.iter().map(|c| c.parameters).collect();
        counts.sort_unstable();
        counts.dedup();
        let price = |engine, k| {
            let row = costs.iter().find(|c| c.engine == engine && c.parameters == k)?;
            Some(row.factorisations_ratio)
        };
        let time = |engine, k| {
            let row = engines.iter().find(|c: &&EngineTime| c.engine == engine && c.parameters == k)?;
            Some(row.simulations)
        };
        timing.push(CaseTiming {
            simulation_s,
            speed_ups: SpeedUp::list(&counts, time),
            engines: engines.clone(),
        });
        cases.push(ComparedCase {
            proof,
            simulation: orbit.cost,
            speed_ups: SpeedUp::list(&counts, price),
            costs,
        });
    }
    Ok(())
}

/// One bearing at one operating point whose gradients are priced.
struct Bench<'a> {
    study: &'a Study,
    wanted: &'a ComparisonPlan,
    plan: &'a Plan<'a>,
    case: usize,
    context: RunContext<'a>,
}

impl Bench<'_> {
    fn stage(&self, name: String) {
        self.context.progress.tell(&Event::Stage { name });
    }

    /// The settled cycle from a cold start, and how long it takes.
    fn simulate(&self) -> Result<(Orbit, f64), EvaluationError> {
        self.stage("simulating".to_owned());
        let model = self.plan.problem.model(self.case, &self.plan.start)?;
        let options = &self.plan.problem.cases()[self.case].options;
        let once = || settle(&model, options, None, self.context.cancel).map_err(|e| failure(e.into()));
        quickest(once)
    }

    /// Cost and wall time of each engine for each number of parameters.
    fn costs(
        &self,
        orbit: &Orbit,
        simulation_s: f64,
    ) -> Result<(Vec<EngineCost>, Vec<EngineTime>), EvaluationError> {
        let all = self.plan.problem.cases()[self.case].variables.len();
        let mut counts: Vec<usize> = self.wanted.counts.iter().map(|k| (*k).min(all)).collect();
        counts.dedup();
        let (mut costs, mut times) = (Vec::new(), Vec::new());
        for &name in &self.wanted.engines {
            for &k in &counts {
                self.stage(format!("cost of {} for {k} parameters", name.as_str()));
                let (table, seconds) = self.gradient(orbit, name, k)?;
                costs.push(cost(name, k, &table, orbit));
                let simulations = seconds / simulation_s;
                times.push(EngineTime { engine: name, parameters: k, seconds, simulations });
            }
        }
        Ok((costs, times))
    }

    /// Gradient by the first parameters.
    fn gradient(
        &self,
        orbit: &Orbit,
        name: EngineName,
        count: usize,
    ) -> Result<(GradientTable, f64), EvaluationError> {
        let asked = &self.plan.problem.cases()[self.case];
        let (model, orbit) = self.first(orbit, count)?;
        let engine = engine(name, self.study.perturbation);
        let once = || {
            let cancel = self.context.cancel;
            engine.gradient(&model, &orbit, &asked.options, &asked.quantities, cancel).map_err(failure)
        };
        match is_difference(&name) {
            true => {
                let began = Instant::now();
                Ok((once()?, began.elapsed().as_secs_f64()))
            }
            false => quickest(once),
        }
    }

    /// The bearing and its cycle with nothing but the first parameters varied.
    fn first(&self, orbit: &Orbit, count: usize) -> Result<(JournalBearing, Orbit), EvaluationError> {
        let model = self.plan.problem.model(self.case, &self.plan.start)?;
        let all = self.plan.problem.cases()[self.case].variables.len();
        let setup = model.setup().clone();
        let parameters = setup.parameters[..count].to_vec();
        let model = JournalBearing::new(BearingSetup { parameters, ..setup })
            .map_err(|e| EvaluationError::Failed(e.to_string()))?;
        let mut orbit = orbit.clone();
        orbit.parameters.drain(count..all);
        Ok((model, orbit))
    }
}

/// The result of something and the shortest time it takes.
fn quickest<T>(once: impl Fn() -> Result<T, EvaluationError>) -> Result<(T, f64), EvaluationError> {
    let timed = || {
        let began = Instant::now();
        once().map(|found| (found, began.elapsed().as_secs_f64()))
    };
    let mut best = timed()?;
    for _ in 1..REPEATS {
        let next = timed()?;
        best.1 = best.1.min(next.1);
    }
    Ok(best)
}

fn cost(engine: EngineName, parameters: usize, table: &GradientTable, simulation: &Orbit) -> EngineCost {
    let over = |a: u64, b: u64| a as f64 / b as f64;
    let (cost, one) = (table.cost, simulation.cost);
    EngineCost {
        engine,
        parameters,
        sweeps: table.sweeps,
        cost,
        newton_iterations_ratio: over(cost.newton_iterations, one.newton_iterations),
        factorisations_ratio: over(cost.factorisations, one.factorisations),
        solves_ratio: over(cost.solves, one.solves),
    }
}

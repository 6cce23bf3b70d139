//! Checks of the sections that stand for themselves: orbit, objective, gradient, optimiser, assumptions.

use super::Given;
use super::faults::{Faults, join, without_nulls};
use super::file::{
    AggregateName, GradientFile, ObjectiveFile, OperatingPointFile, OptimiserFile, OrbitFile, SchemeName,
    StudyFile,
};
use super::place::find;
use super::plans::OperatingPoint;
use super::searches::SearchPlan;
use crate::gradient::EngineName;
use crate::optimise::{Budget, Method, SearchOptions, SqpOptions};
use crate::orbit::{OrbitOptions, Scheme};

/// Default sharpness of smooth extrema.
pub(super) const SHARPNESS: f64 = 200.0;
/// Default relative perturbation of the finite differences.
pub(super) const PERTURBATION: f64 = 1e-6;

pub(super) fn orbit_options(o: &mut OrbitFile, faults: &mut Faults) -> OrbitOptions {
    faults.unknown::<OrbitFile>(&o.unknown, "orbit");
    let steps = faults.or(&mut o.steps_per_cycle, "orbit.steps_per_cycle", 720);
    let scheme = faults.or(&mut o.scheme, "orbit.scheme", SchemeName::Bdf2);
    let tolerance = faults.or(&mut o.periodicity_tolerance, "orbit.periodicity_tolerance", 1e-12);
    let cycles = faults.or(&mut o.max_cycles, "orbit.max_cycles", 30);
    faults.range(
        Some(steps as f64),
        "orbit.steps_per_cycle",
        |v| (36.0..=100_000.0).contains(&v),
        "between 36 and 100000",
    );
    faults.range(
        Some(tolerance),
        "orbit.periodicity_tolerance",
        |v| (1e-14..=1e-2).contains(&v),
        "between 1e-14 and 1e-2",
    );
    faults.range(
        Some(cycles as f64),
        "orbit.max_cycles",
        |v| (2.0..=10_000.0).contains(&v),
        "between 2 and 10000",
    );
    let memory = faults.or(&mut o.memory, "orbit.memory", "1 GB".parse().expect("a valid amount"));
    let memory_bytes = memory.si();
    faults.range(
        Some(memory_bytes),
        "orbit.memory",
        |v| (0.0..=1e12).contains(&v),
        "between \"0 B\" and \"1000 GB\"",
    );
    let scheme = match scheme {
        SchemeName::Bdf1 => Scheme::Bdf1,
        SchemeName::Bdf2 => Scheme::Bdf2,
    };
    OrbitOptions {
        steps,
        scheme,
        periodicity_tolerance: tolerance,
        max_cycles: cycles,
        memory_bytes: memory_bytes as usize,
    }
}

/// The operating points, and whether the worst of them counts.
pub(super) fn points(file: &mut StudyFile, faults: &mut Faults) -> Option<(Vec<OperatingPoint>, bool)> {
    faults.need(&file.objective, "objective");
    let Given::Value(objective) = &mut file.objective else { return None };
    faults.unknown::<ObjectiveFile>(&objective.unknown, "objective");
    let aggregate = faults.or(&mut objective.aggregate, "objective.aggregate", AggregateName::WeightedMean);
    let path = "objective.operating_points";
    faults.need(&objective.operating_points, path);
    let Given::Value(list) = &mut objective.operating_points else { return None };
    if list.is_empty() {
        faults.add(path, "needs at least one operating point");
    }
    let mut points = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{path}[{i}]");
        faults.get(given, &path);
        let Given::Value(p) = given else { continue };
        faults.unknown::<OperatingPointFile>(&p.unknown, &path);
        let at = |key: &str| join(&path, key);
        let name = faults.need(&p.name, &at("name"));
        let speed = faults.need(&p.speed, &at("speed")).map(|v| v.si());
        let weight = faults.or(&mut p.weight, &at("weight"), 1.0);
        let load_factor = faults.or(&mut p.load_factor, &at("load_factor"), 1.0);
        faults.range(speed, &at("speed"), |v| v > 0.0 && v <= 2e4, "above zero and at most 190000 rpm");
        faults.range(Some(weight), &at("weight"), |v| v > 0.0 && v <= 1e6, "above zero and at most 1e6");
        faults.range(
            Some(load_factor),
            &at("load_factor"),
            |v| v > 0.0 && v <= 100.0,
            "above zero and at most 100",
        );
        if let (Some(name), Some(speed_rad_s)) = (name, speed) {
            if points.iter().any(|p: &OperatingPoint| p.name == name) {
                faults.add(&at("name"), format!("the name \"{name}\" stands twice"));
            }
            points.push(OperatingPoint { name, speed_rad_s, weight, load_factor });
        }
    }
    let worst = aggregate == AggregateName::WorstCase;
    let sum: f64 = if worst { 1.0 } else { points.iter().map(|p| p.weight).sum() };
    points.iter_mut().for_each(|p| p.weight /= sum);
    Some((points, worst))
}

pub(super) fn gradient(file: &mut StudyFile, faults: &mut Faults) -> Option<(EngineName, f64)> {
    let g = faults.section(&mut file.gradient, "gradient")?;
    faults.unknown::<GradientFile>(&g.unknown, "gradient");
    let engine = faults.or(&mut g.engine, "gradient.engine", EngineName::Adj);
    let perturbation = faults.or(&mut g.perturbation, "gradient.perturbation", PERTURBATION);
    faults.range(
        Some(perturbation),
        "gradient.perturbation",
        |v| v > 0.0 && v <= 0.1,
        "above 0 and at most 0.1",
    );
    Some((engine, perturbation))
}

pub(super) fn optimiser(file: &mut StudyFile, faults: &mut Faults) -> Option<(SearchPlan, f64)> {
    let worst_or_robust = worst_case(file) || !file.robust.is_absent();
    let o = faults.section(&mut file.optimiser, "optimiser")?;
    faults.unknown::<OptimiserFile>(&o.unknown, "optimiser");
    let at = |key: &str| join("optimiser", key);
    let method = faults.or(&mut o.method, &at("method"), Method::Sqp);
    let starts = faults.or(&mut o.starts, &at("starts"), 1);
    let seed = faults.or(&mut o.seed, &at("seed"), 1);
    let rivals = faults.or(&mut o.rivals, &at("rivals"), Vec::new());
    let simulations = faults.get(&o.max_simulations, &at("max_simulations"));
    let seconds = faults.get(&o.max_time, &at("max_time")).map(|t| t.si());
    faults.range(
        Some(starts as f64),
        &at("starts"),
        |v| (1.0..=10_000.0).contains(&v),
        "between 1 and 10000",
    );
    faults.range(simulations.map(|v| v as f64), &at("max_simulations"), |v| v >= 1.0, "at least 1");
    faults.range(seconds, &at("max_time"), |v| v > 0.0, "above zero");
    let defaults = SqpOptions::default();
    let options = SqpOptions {
        tolerance: faults.or(&mut o.tolerance, &at("tolerance"), defaults.tolerance),
        max_iterations: faults.or(&mut o.max_iterations, &at("max_iterations"), defaults.max_iterations),
        step_limit: faults.or(&mut o.step_limit, &at("step_limit"), defaults.step_limit),
    };
    let sharpness = faults.or(&mut o.aggregate_sharpness, &at("aggregate_sharpness"), SHARPNESS);
    faults.range(Some(options.tolerance), &at("tolerance"), |v| v > 0.0 && v < 1.0, "above 0 and below 1");
    faults.range(
        Some(options.max_iterations as f64),
        &at("max_iterations"),
        |v| (1.0..=100_000.0).contains(&v),
        "between 1 and 100000",
    );
    faults.range(
        Some(options.step_limit),
        &at("step_limit"),
        |v| v > 0.0 && v <= 1.0,
        "above 0 and at most 1",
    );
    faults.range(
        Some(sharpness),
        &at("aggregate_sharpness"),
        |v| (10.0..=2000.0).contains(&v),
        "between 10 and 2000",
    );
    let rivals = rivals.iter().map(|r| (r.method, r.engine.unwrap_or(EngineName::Adj))).collect();
    let options = SearchOptions { method, settings: options, budget: Budget { simulations, seconds } };
    let polish = faults.or(&mut o.polish, &at("polish"), false);
    if polish && worst_or_robust {
        let words = "is for weighted means without margins; remove it, the worst case or [robust]";
        faults.add(&at("polish"), words);
    }
    Some((SearchPlan { options, starts, seed, rivals, polish }, sharpness))
}

/// Whether a study asks for the worst case.
pub(super) fn worst_case(file: &StudyFile) -> bool {
    file.objective.value().and_then(|o| o.aggregate.value()) == Some(&AggregateName::WorstCase)
}

/// Assumptions must belong to keys that exist.
pub(super) fn assumptions(file: &mut StudyFile, faults: &mut Faults) {
    let Some(map) = faults.get(&file.assumptions, "assumptions") else { return };
    let values = without_nulls(serde_json::to_value(&*file).unwrap_or_default());
    for path in map.keys() {
        if find(&values, path).is_none() && faults.raw(path).is_none() {
            faults.add(&format!("assumptions.{path}"), format!("there is no key '{path}' in this study"));
        }
    }
}

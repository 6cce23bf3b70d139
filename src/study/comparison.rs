//! Checks of a comparison of gradient engines, and of the search sections that mean something beside it.
//!
//! Deliberately not here: the comparison itself (see [`super::compare`]).

use super::Given;
use super::faults::{Faults, join, refuse_others};
use super::file::{ComparisonFile, GradientFile, OptimiserFile, StudyFile};
use super::searches::SearchPlan;
use super::sections::{self, SHARPNESS};
use crate::gradient::EngineName;

const PATH: &str = "comparison";
/// Why sections of the search mean nothing here.
pub(super) const WHY: &str = "the study compares gradient engines instead of searching a design";

/// A checked comparison.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ComparisonPlan {
    /// Engines in the order of the file.
    pub engines: Vec<EngineName>,
    /// Relative perturbations, from the largest to the smallest.
    pub perturbations: Vec<f64>,
    /// Numbers of parameters, rising.
    pub counts: Vec<usize>,
}

fn at(key: &str) -> String {
    join(PATH, key)
}

/// Whether an engine is a finite difference.
pub(super) fn is_difference(engine: &EngineName) -> bool {
    matches!(engine, EngineName::Fw | EngineName::Bw | EngineName::Cen)
}

/// The comparison of a study with so many parameters, if it has one.
pub(super) fn comparison(
    file: &mut StudyFile,
    parameters: Option<usize>,
    faults: &mut Faults,
) -> Option<ComparisonPlan> {
    faults.get(&file.comparison, PATH);
    let Given::Value(c) = &mut file.comparison else { return None };
    faults.unknown::<ComparisonFile>(&c.unknown, PATH);
    let engines = faults.or(&mut c.engines, &at("engines"), EngineName::ALL.to_vec());
    listed(&engines, &at("engines"), |a, b| a == b, faults);
    let mut perturbations = match engines.iter().any(is_difference) {
        true => faults.or(&mut c.perturbations, &at("perturbations"), half_decades()),
        false => {
            let why = "no finite difference is among the engines";
            faults.unused(&c.perturbations, &at("perturbations"), why);
            Vec::new()
        }
    };
    for (i, eps) in perturbations.iter().enumerate() {
        let path = format!("{}[{i}]", at("perturbations"));
        faults.range(Some(*eps), &path, |v| (1e-12..=0.1).contains(&v), "between 1e-12 and 0.1");
    }
    if engines.iter().any(is_difference) {
        listed(&perturbations, &at("perturbations"), |a, b| a == b, faults);
    }
    let counts = counts(c, parameters, faults);
    perturbations.sort_by(|a, b| b.total_cmp(a));
    Some(ComparisonPlan { engines, perturbations, counts: counts? })
}

/// Numbers of parameters; defaults are written only if it is known how many there are.
fn counts(c: &mut ComparisonFile, parameters: Option<usize>, faults: &mut Faults) -> Option<Vec<usize>> {
    let path = at("parameter_counts");
    let most = match parameters {
        Some(most) => most,
        None => return faults.get(&c.parameter_counts, &path),
    };
    let mut counts = faults.or(&mut c.parameter_counts, &path, doubling(most));
    for (i, k) in counts.iter().enumerate() {
        let words = format!("between 1 and {most}, the number of parameters");
        let within = |v| (1.0..=most as f64).contains(&v);
        faults.range(Some(*k as f64), &format!("{path}[{i}]"), within, &words);
    }
    listed(&counts, &path, |a, b| a == b, faults);
    counts.sort_unstable();
    Some(counts)
}

/// A list has at least one value, and none twice.
fn listed<T>(list: &[T], path: &str, same: impl Fn(&T, &T) -> bool, faults: &mut Faults) {
    if list.is_empty() {
        faults.add(path, "needs at least one value");
    }
    for (i, value) in list.iter().enumerate() {
        if list[..i].iter().any(|other| same(other, value)) {
            faults.add(&format!("{path}[{i}]"), "stands twice");
        }
    }
}

fn half_decades() -> Vec<f64> {
    let text = (2..=9).flat_map(|k| [format!("1e-{k}"), format!("3e-{}", k + 1)]);
    // From text, so that the file shows the numbers as one writes them.
    text.take(15).filter_map(|t| t.parse().ok()).collect()
}

fn doubling(most: usize) -> Vec<usize> {
    let mut counts: Vec<usize> =
        std::iter::successors(Some(1), |k| Some(2 * k)).take_while(|k| *k < most).collect();
    counts.push(most);
    counts
}

/// What a comparison reads of `[gradient]`: the perturbation at which cost is measured.
pub(super) fn perturbation(file: &mut StudyFile, faults: &mut Faults) -> Option<f64> {
    let g = faults.section(&mut file.gradient, "gradient")?;
    faults.unknown::<GradientFile>(&g.unknown, "gradient");
    faults.unused(&g.engine, "gradient.engine", WHY);
    let eps = faults.or(&mut g.perturbation, "gradient.perturbation", sections::PERTURBATION);
    faults.range(Some(eps), "gradient.perturbation", |v| v > 0.0 && v <= 0.1, "above 0 and at most 0.1");
    Some(eps)
}

/// What a comparison reads of `[optimiser]`: the sharpness of smooth extrema.
pub(super) fn sharpness(file: &mut StudyFile, faults: &mut Faults) -> Option<(SearchPlan, f64)> {
    let o = faults.section(&mut file.optimiser, "optimiser")?;
    faults.unknown::<OptimiserFile>(&o.unknown, "optimiser");
    let used = ["aggregate_sharpness"];
    refuse_others!(
        faults,
        o,
        "optimiser",
        WHY,
        used,
        [
            method,
            tolerance,
            max_iterations,
            step_limit,
            starts,
            seed,
            max_simulations,
            max_time,
            rivals,
            polish
        ]
    );
    let path = "optimiser.aggregate_sharpness";
    let sharpness = faults.or(&mut o.aggregate_sharpness, path, SHARPNESS);
    faults.range(Some(sharpness), path, |v| (10.0..=2000.0).contains(&v), "between 10 and 2000");
    Some((SearchPlan::default(), sharpness))
}

//! Robust designs: what scatters, and the check of its margins by drawing bearings.

use super::Given;
use super::bearings::Bearings;
use super::build::Plan;
use super::check::Study;
use super::faults::{Faults, join};
use super::file::{RobustFile, StudyFile, ToleranceFile};
use super::lexicon::Lexicon;
use super::plans::{FilmPlan, ParameterPlan};
use super::sections::worst_case;
use crate::cranktrain::JournalBearing;
use crate::optimise::{ConstrainedProblem, DesignProblem, Evaluated, Margins, Robust, latin_hypercube};
use crate::report::{RobustReport, SampledLimit, ToleranceReport};
use crate::run::{Event, RunContext};
use crate::units::TemperatureRise;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};
use std::sync::Arc;

const PATH: &str = "robust";
/// Relative difference between drawn and first-order deviations up to which first order holds; what a few dozen draws leave open is
/// about half of it.
const REFUTED: f64 = 0.3;

/// A checked robust design.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RobustPlan {
    /// Standard deviations in each margin.
    pub sigmas: f64,
    /// What scatters: index among the variables (parameters first, then `beside`) and standard deviation, SI units.
    pub scatter: Vec<(usize, f64)>,
    /// What scatters without being a parameter, at its value in the study.
    pub beside: Vec<ParameterPlan>,
    pub samples: u64,
    seed: u64,
}

impl RobustPlan {
    /// Standard deviation of each of `n` parameters and of what is beside them.
    pub fn deviations(&self, n: usize) -> Vec<f64> {
        let mut all = vec![0.0; n + self.beside.len()];
        self.scatter.iter().for_each(|&(j, s)| all[j] = s);
        all
    }

    /// Values of what is beside the parameters.
    pub fn values(&self) -> Vec<f64> {
        self.beside.iter().map(|p| p.start).collect()
    }

    /// The problem of a plan with margins.
    pub fn problem<'p, 'r>(&self, plan: &'p Plan<'r>) -> Robust<'p, DesignProblem<'r, JournalBearing>> {
        let n = plan.start.len();
        Robust::new(&plan.problem, self.values(), self.deviations(n), self.sigmas)
    }
}

/// The margins a study asks for, if any.
pub(super) fn robust(
    file: &mut StudyFile,
    bearings: &Bearings,
    film: Option<&FilmPlan>,
    parameters: &[ParameterPlan],
    faults: &mut Faults,
) -> Option<RobustPlan> {
    let lexicon = Lexicon::of(file, bearings, film);
    let worst = worst_case(file);
    faults.get(&file.robust, PATH);
    let Given::Value(r) = &mut file.robust else { return None };
    faults.unknown::<RobustFile>(&r.unknown, PATH);
    if worst {
        faults
            .add(PATH, "does not go together with objective.aggregate = \"worst-case\"; remove one of them");
    }
    let at = |key: &str| join(PATH, key);
    let sigmas = faults.or(&mut r.sigmas, &at("sigmas"), 3.0);
    let samples = faults.or(&mut r.samples, &at("samples"), 50);
    let seed = faults.or(&mut r.seed, &at("seed"), 1);
    faults.range(Some(sigmas), &at("sigmas"), |v| v > 0.0 && v <= 10.0, "above 0 and at most 10");
    let counted = |v: f64| v == 0.0 || (10.0..=1e5).contains(&v);
    faults.range(Some(samples as f64), &at("samples"), counted, "0 or between 10 and 100000");
    let list = faults.need(&r.tolerances, &at("tolerances"))?;
    if list.is_empty() {
        faults.add(&at("tolerances"), "needs at least one [[robust.tolerances]]");
    }
    let mut plan = RobustPlan { sigmas, scatter: Vec::new(), beside: Vec::new(), samples, seed };
    for (i, given) in list.iter().enumerate() {
        let path = format!("{}[{i}]", at("tolerances"));
        if let Some(t) = faults.get(given, &path) {
            tolerance(&t, &path, &lexicon, parameters, &mut plan, faults);
        }
    }
    Some(plan)
}

fn tolerance(
    t: &ToleranceFile,
    path: &str,
    lexicon: &Lexicon,
    parameters: &[ParameterPlan],
    plan: &mut RobustPlan,
    faults: &mut Faults,
) -> Option<()> {
    faults.unknown::<ToleranceFile>(&t.unknown, path);
    let (name_at, deviation_at) = (join(path, "parameter"), join(path, "standard_deviation"));
    let name = faults.need(&t.parameter, &name_at);
    let text = faults.need(&t.standard_deviation, &deviation_at);
    let (name, text) = (name?, text?.0);
    let targets = lexicon.targets(&name, &name_at, faults)?;
    let variable = targets.first()?.variable;
    let deviation = match variable.unit {
        "degC" => text.parse::<TemperatureRise>().map(|v| v.si()).map_err(|e| e.to_string()),
        _ => variable.si(&text),
    };
    let deviation =
        deviation.map_err(|e| faults.add(&deviation_at, format!("found \"{text}\": {e}"))).ok()?;
    faults.range(Some(deviation), &deviation_at, |v| v > 0.0, "above zero");
    for target in targets {
        let known = parameters.iter().chain(&plan.beside).position(|p| p.name == target.name);
        let index = match known {
            Some(index) => index,
            None => {
                let start = lexicon.value(&target)?;
                let (lower, upper) = lexicon.allowed(&target);
                let (bearing, variable) = (target.bearing, target.variable);
                plan.beside.push(ParameterPlan {
                    name: target.name,
                    bearing,
                    stage: target.stage,
                    variable,
                    lower,
                    upper,
                    start,
                });
                parameters.len() + plan.beside.len() - 1
            }
        };
        if plan.scatter.iter().any(|(j, _)| *j == index) {
            faults.add(&name_at, format!("\"{name}\" stands twice"));
        }
        plan.scatter.push((index, deviation));
    }
    Some(())
}

/// Margins at a design; none without.
pub(super) fn margins(study: &Study, plan: &Plan, x: &[f64]) -> Option<Margins> {
    study.robust.as_ref()?.problem(plan).margins(x).ok()
}

/// The margins of the design, held against bearings drawn around it.
pub(super) fn report(
    study: &Study,
    plan: &Plan,
    x: &[f64],
    at: Arc<Evaluated>,
    context: RunContext<'_>,
) -> Option<RobustReport> {
    let wanted = study.robust.as_ref()?;
    let margins = margins(study, plan, x)?;
    let nominal = plan.problem.values(x).ok()?;
    let name = format!("drawing {} bearings around the design", wanted.samples);
    context.progress.tell(&Event::Stage { name });
    plan.problem.begin_beside(at);
    let whole = plan.problem.whole(x);
    let normal = Normal::standard();
    let points = latin_hypercube(wanted.samples as usize, wanted.scatter.len(), wanted.seed);
    let drawn: Vec<_> = points
        .par_iter()
        .map(|u| {
            let mut y = whole.clone();
            for (&(j, s), u) in wanted.scatter.iter().zip(u) {
                y[j] += s * normal.inverse_cdf(*u);
            }
            plan.problem.values(&y)
        })
        .collect();
    if context.cancel.is_cancelled() {
        // Bearings that were not simulated say nothing about the margins.
        return None;
    }
    let good: Vec<_> = drawn.iter().filter_map(|d| d.as_ref().ok()).collect();
    let failed = drawn.len() - good.len();
    let losses: Vec<f64> = good.iter().map(|v| v.objective).collect();
    let (mean, deviation) = moments(&losses);
    let covered = nominal.objective + margins.objective;
    let limits = plan.limits.iter().enumerate().map(|(k, label)| {
        let (c, case) = (&study.constraints[label.constraint], plan.cases[label.case]);
        let (unit, scale) = c.quantity.unit();
        let rows: Vec<f64> = good.iter().map(|v| v.inequalities[k]).collect();
        let size = c.limit / scale;
        SampledLimit {
            quantity: c.quantity.key().to_owned(),
            bearing: study.bearings[case.bearing].name.clone(),
            operating_point: study.points[case.point].name.clone(),
            unit: unit.replace("degC", "K"),
            deviation: margins.inequalities[k] / wanted.sigmas * size,
            sampled_deviation: (!rows.is_empty()).then(|| moments(&rows).1 * size),
            broken_percent: percent(&rows, 1e-6, failed),
        }
    });
    let limits: Vec<SampledLimit> = limits.collect();
    let all = || study.variables();
    Some(RobustReport {
        sigmas: wanted.sigmas,
        tolerances: wanted
            .scatter
            .iter()
            .filter_map(|&(j, s)| {
                let p = all().nth(j)?;
                Some(ToleranceReport {
                    parameter: p.name.clone(),
                    nominal: p.variable.shown(whole[j]),
                    deviation: s / p.variable.scale.0,
                    unit: p.variable.unit.to_owned(),
                    deviation_unit: p.variable.unit.replace("degC", "K"),
                })
            })
            .collect(),
        nominal_w: nominal.objective,
        deviation_w: margins.objective / wanted.sigmas,
        robust_w: covered,
        samples: wanted.samples,
        failed: failed as u64,
        verdict: verdict(&limits, margins.objective / wanted.sigmas, deviation, good.len()),
        sampled_mean_w: (!losses.is_empty()).then_some(mean),
        sampled_deviation_w: (!losses.is_empty()).then_some(deviation),
        above_percent: percent(&losses.iter().map(|l| l / covered - 1.0).collect::<Vec<_>>(), 0.0, failed),
        limits,
    })
}

/// Mean and standard deviation of a sample.
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (square / (n - 1.0).max(1.0)).sqrt())
}

/// Share of values above a bound, per cent; those that failed are above it too.
fn percent(values: &[f64], bound: f64, failed: usize) -> Option<f64> {
    let above = values.iter().filter(|v| **v > bound).count() + failed;
    let all = values.len() + failed;
    (all > 0).then(|| 100.0 * above as f64 / all as f64)
}

/// Whether the drawn deviations are those of first order.
fn verdict(limits: &[SampledLimit], first_order: f64, drawn: f64, count: usize) -> Option<String> {
    if count < 2 {
        return None;
    }
    let of_limits = limits.iter().filter_map(|l| Some((l.deviation, l.sampled_deviation?)));
    let pairs = std::iter::once((first_order, drawn)).chain(of_limits);
    let apart = |(first, drawn): (f64, f64)| if first > 0.0 { (drawn / first - 1.0).abs() } else { 0.0 };
    let worst = pairs.map(apart).fold(0.0, f64::max);
    let percent = crate::report::short((1e3 * worst).round() / 10.0);
    Some(match worst < REFUTED {
        true => format!("the first order holds, drawn deviations are within {percent} % of it"),
        false => format!(
            "the first order does not hold here, a drawn deviation differs by {percent} % from it: trust the drawn values, narrow the \
             tolerances or ask for more standard deviations"
        ),
    })
}

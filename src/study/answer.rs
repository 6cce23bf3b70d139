//! The first part of a report: the design, what it costs to move it, the objective before and after.

use super::build::Plan;
use super::check::Study;
use super::observe;
use super::searches::Searched;
use crate::optimise::{ConstrainedProblem, Evaluated, ManyObjectives, Outcome};
use crate::report::{AtBound, CaseLoss, DesignValue, ObjectiveReport, WorstCaseReport};
use crate::units::tidy;
use std::sync::Arc;

/// A parameter closer to a bound than this share of its box stands at it.
const AT_BOUND: f64 = 1e-6;

/// Cycles at start and optimum.
pub(super) struct Known {
    pub start: Option<Arc<Evaluated>>,
    pub optimum: Arc<Evaluated>,
}

pub(super) fn design(study: &Study, x: &[f64]) -> Vec<DesignValue> {
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
pub(super) fn price_parameters(study: &Study, found: &Searched, design: &mut [DesignValue]) {
    let (plan, minimum) = (&found.plan, &found.minimum);
    let slopes = match found.shares.is_empty() {
        true => plan.problem.slopes(&minimum.x).map(|s| s.objective),
        // What the largest loss does, as far as each operating point has a share in it.
        false => plan.problem.objective_slopes(&minimum.x).map(|parts| {
            let sum = |j: usize| parts.iter().zip(&found.shares).map(|(row, share)| share * row[j]).sum();
            (0..minimum.x.len()).map(sum).collect()
        }),
    };
    let Ok(slopes) = slopes else { return };
    let optimal = matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged);
    for (j, (d, p)) in design.iter_mut().zip(&study.parameters).enumerate() {
        let width = p.upper - p.lower;
        // Of a running-in design the loss of new surfaces is not what was minimised.
        d.effect_w_per_percent = (!study.runs_in()).then_some(0.01 * width * slopes[j]);
        let price = match d.at_bound {
            AtBound::No => None,
            AtBound::Lower => minimum.multipliers.lower.get(j),
            AtBound::Upper => minimum.multipliers.upper.get(j),
        };
        d.bound_price_w_per_unit = price.filter(|_| optimal).map(|m| m / width * p.variable.scale.0);
    }
}

/// Largest relative violation of any limit by the start design, margins included.
fn start_violation(study: &Study, plan: &Plan) -> Option<f64> {
    let values = match &study.robust {
        Some(robust) => robust.problem(plan).values(&plan.start),
        None => plan.problem.values(&plan.start),
    };
    let beyond = study.linear.iter().map(|l| l.excess(&plan.start) / l.room(&study.parameters));
    values.ok().map(|v| beyond.fold(v.violation(), f64::max))
}

/// What is minimised.
pub(super) fn objective_words(study: &Study) -> String {
    match (study.worst_case, &study.robust) {
        _ if study.runs_in() => {
            "friction loss of the running-in (see running_in); here that of new surfaces, all bearings, W"
                .to_owned()
        }
        (true, _) => "largest weighted mean friction loss of an operating point, all bearings, W".to_owned(),
        (_, Some(r)) => {
            format!("weighted mean friction loss of all bearings, with {} standard deviations, W", r.sigmas)
        }
        _ => "weighted mean friction loss of all bearings, W".to_owned(),
    }
}

pub(super) fn objective(study: &Study, found: &Searched, known: &Known) -> ObjectiveReport {
    let plan = &found.plan;
    let at_point = |at: &Evaluated, point: usize| observe::total_loss(study, &plan.cases, at, Some(point));
    let total = |at: &Evaluated| match study.worst_case {
        false => observe::total_loss(study, &plan.cases, at, None),
        true => {
            let all = (0..study.points.len()).map(|p| at_point(at, p));
            all.reduce(|a, b| if b.total_w > a.total_w { b } else { a }).expect("there is an operating point")
        }
    };
    let worst_case = found.shares.iter().enumerate().map(|(p, share)| WorstCaseReport {
        operating_point: study.points[p].name.clone(),
        start_w: known.start.as_ref().map(|s| at_point(s, p).total_w),
        optimum_w: at_point(&known.optimum, p).total_w,
        share: *share,
    });
    let worst_case = worst_case.collect();
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
        quantity: objective_words(study),
        start_violation: match &found.run_in {
            Some(end) => end.start_violation,
            None => start_violation(study, plan),
        },
        start,
        optimum: Some(optimum),
        saving_percent: start.map(|s| 100.0 * (1.0 - optimum.total_w / s.total_w)),
        operating_points: operating_points.collect(),
        worst_case,
    }
}

//! A front of two quantities: the least loss for each of a list of limits on another quantity (epsilon-constraint method, Haimes
//! 1971). Every point starts from its neighbour's design and cycles.

use super::Given;
use super::bearings::Bearings;
use super::build::{Plan, plan};
use super::check::Study;
use super::constraints::{constraint, limit_si};
use super::faults::{Faults, join};
use super::file::{ConstraintFile, ParetoFile, StudyFile};
use super::keep::Keep;
use super::plans::ConstraintPlan;
use super::searches::{FEASIBLE, Searched, resume};
use super::seek::seek;
use crate::optimise::{Minimum, Outcome, Sense};
use crate::report::{ParetoPoint, ParetoReport};
use crate::run::{Cost, Event, RunContext, Store};
use crate::units::tidy;

const PATH: &str = "pareto";
/// A price that is a smaller share of the loss, for all of the limit, is none.
const PRICELESS: f64 = 1e-6;

/// A checked front.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ParetoPlan {
    /// What is limited; its own limit is the first of the list.
    base: ConstraintPlan,
    /// Limits from the easiest to the hardest, SI units.
    pub limits: Vec<f64>,
}

/// The front of a study, if it asks for one.
pub(super) fn pareto(file: &StudyFile, bearings: &Bearings, faults: &mut Faults) -> Option<ParetoPlan> {
    faults.get(&file.pareto, PATH);
    let Given::Value(p) = &file.pareto else { return None };
    faults.unknown::<ParetoFile>(&p.unknown, PATH);
    let (least, most) =
        (faults.get(&p.at_least, &join(PATH, "at_least")), faults.get(&p.at_most, &join(PATH, "at_most")));
    if p.at_least.is_absent() == p.at_most.is_absent() {
        faults.add(PATH, "give a list of limits, either at_least or at_most");
        return None;
    }
    let (key, texts) = match (least, most) {
        (Some(texts), None) => ("at_least", texts),
        (None, Some(texts)) => ("at_most", texts),
        _ => return None,
    };
    let path = join(PATH, key);
    let Some(first) = texts.first().filter(|_| texts.len() > 1) else {
        faults.add(&path, "needs at least two limits");
        return None;
    };
    let one = |wanted: &str| match wanted == key {
        true => Given::Value(first.clone()),
        false => Given::Absent,
    };
    let file = ConstraintFile {
        quantity: p.quantity.clone(),
        bearing: p.bearing.clone(),
        at_least: one("at_least"),
        at_most: one("at_most"),
        unknown: Default::default(),
    };
    let base = constraint(&file, PATH, bearings, faults)?;
    let mut limits = Vec::new();
    for (i, text) in texts.iter().enumerate() {
        let at = format!("{path}[{i}]");
        match limit_si(base.quantity, &text.0) {
            Ok(limit) if limit > 0.0 && limits.contains(&limit) => faults.add(&at, "stands twice"),
            Ok(limit) if limit > 0.0 => limits.push(limit),
            Ok(_) => faults.add(&at, format!("found \"{}\": must be above zero", text.0)),
            Err(e) => faults.add(&at, format!("found \"{}\": {e}", text.0)),
        }
    }
    limits.sort_by(f64::total_cmp);
    if base.sense == Sense::AtMost {
        limits.reverse();
    }
    Some(ParetoPlan { base, limits })
}

/// The front, from the limit that is easiest to meet on; none if the study does not ask for one.
pub(super) fn front<'r>(
    study: &Study,
    found: &Searched<'r>,
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> Option<(ParetoReport, (Cost, Cost))> {
    let mut cost = (Cost::default(), Cost::default());
    let wanted = study.pareto.as_ref()?;
    let (unit, _) = wanted.base.quantity.unit();
    let mut neighbour: Option<(Plan<'r>, Minimum)> = None;
    let mut points = Vec::new();
    for (k, limit) in wanted.limits.iter().enumerate() {
        if context.cancel.is_cancelled() {
            break;
        }
        let shown = tidy(wanted.base.quantity.shown(*limit));
        let name = format!("point {} of {} of the front: {shown} {unit}", k + 1, wanted.limits.len());
        context.progress.tell(&Event::Stage { name });
        let moved = limited(study, wanted, *limit);
        let Ok(mut plan) = plan(&moved, study.engine, context) else { continue };
        let keep = Keep::of(study, format!("pareto-{k}"), store);
        let known = resume(&mut plan, &keep) > 0;
        let (beside, end) = neighbour.as_ref().map_or((&found.plan, &found.minimum), |(p, m)| (p, m));
        let start = if end.values.is_some() { &end.x } else { &plan.start };
        if let (false, Ok(cycles)) = (known, beside.problem.evaluated(start)) {
            plan.problem.begin_beside(cycles);
        }
        let start = start.clone();
        let Ok(end) = seek(&moved, &plan, &start, &study.optimiser.options, (&keep, context)) else {
            continue;
        };
        let minimum = end.minimum;
        points.push(point(&moved, wanted, &plan, &minimum, *limit));
        let (own, beyond) = plan.problem.costs();
        cost = (cost.0 + own, cost.1 + beyond);
        // A search that found no allowed design is no good neighbour.
        if minimum.values.as_ref().is_some_and(|v| v.violation() <= FEASIBLE) {
            neighbour = Some((plan, minimum));
        }
    }
    let label = |b: usize| study.bearings[b].name.clone();
    let report = ParetoReport {
        quantity: wanted.base.quantity.key().to_owned(),
        bearing: wanted.base.bearing.map(label),
        sense: super::limits::words(wanted.base.sense).to_owned(),
        unit: unit.to_owned(),
        parameters: study.parameters.iter().map(|p| p.name.clone()).collect(),
        units: study.parameters.iter().map(|p| p.variable.unit.to_owned()).collect(),
        points,
    };
    Some((report, cost))
}

/// Whether a constraint is the one the front moves.
fn moved_by(c: &ConstraintPlan, wanted: &ParetoPlan) -> bool {
    let base = &wanted.base;
    c.quantity == base.quantity && c.bearing == base.bearing && c.sense == base.sense
}

/// The study with the limit in place.
fn limited(study: &Study, wanted: &ParetoPlan, limit: f64) -> Study {
    let mut moved = study.clone();
    moved.constraints.retain(|c| !moved_by(c, wanted));
    moved.constraints.push(ConstraintPlan { limit, ..wanted.base.clone() });
    moved
}

fn point(study: &Study, wanted: &ParetoPlan, plan: &Plan, end: &Minimum, limit: f64) -> ParetoPoint {
    let (_, scale) = wanted.base.quantity.unit();
    let optimal = matches!(end.outcome, Outcome::Converged | Outcome::AlmostConverged);
    let rows = plan.limits.iter().zip(&end.multipliers.inequalities);
    let price: f64 = rows
        .filter(|(l, _)| moved_by(&study.constraints[l.constraint], wanted))
        .map(|(_, m)| m / limit * scale)
        .sum();
    let shown = |(x, p): (&f64, &super::ParameterPlan)| p.variable.shown(*x);
    let loss = end.values.as_ref().map_or(0.0, |v| v.objective.abs()) * scale;
    ParetoPoint {
        limit: tidy(wanted.base.quantity.shown(limit)),
        status: end.outcome,
        // A design that breaks its limits is no point of the front.
        loss_w: end.values.as_ref().filter(|v| v.violation() <= FEASIBLE).map(|v| v.objective),
        violation: end.values.as_ref().map(|v| v.violation()),
        price_w_per_unit: optimal.then_some(if price * limit > PRICELESS * loss { price } else { 0.0 }),
        simulations: end.evaluations,
        design: end.x.iter().zip(&study.parameters).map(shown).collect(),
    }
}

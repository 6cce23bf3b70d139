//! The answer in sentences, the same in page, JSON and terminal: what the design loses and saves, what holds it back, what is
//! not met.

use super::{AtBound, ConstraintReport, Report, short};
use crate::optimise::Outcome;

/// Violation up to which a start keeps its limits.
const KEPT: f64 = 1e-6;
/// Things named in one sentence at most.
const NAMED: usize = 6;
/// Film pressure beyond which rigid bodies say little: real ones give way, MPa.
const RIGID_MPA: f64 = 400.0;

/// The sentences.
pub fn headline(report: &Report) -> Vec<String> {
    let mut all = Vec::new();
    all.extend(loss(report));
    all.extend(held_back(report));
    all.extend(not_met(report));
    all.extend(front(report));
    all.extend(beyond_rigid(report));
    all
}

/// The ends of a front.
fn front(report: &Report) -> Option<String> {
    let p = report.pareto.as_ref()?;
    let mut found = p.points.iter().filter_map(|q| Some((q.limit, q.loss_w?)));
    let (first, last) = (found.next()?, found.next_back()?);
    let end = |(limit, loss): (f64, f64)| format!("{} W at {} {}", short(loss), short(limit), p.unit);
    let what = p.quantity.replace('-', " ");
    Some(format!("The front over {what} ({}) runs from {} to {}.", p.sense, end(first), end(last)))
}

/// A film pressure that the model of the bodies does not bear.
fn beyond_rigid(report: &Report) -> Option<String> {
    let top = report
        .orbit
        .iter()
        .max_by(|a, b| a.max_film_pressure_mpa.value.total_cmp(&b.max_film_pressure_mpa.value))?;
    let p = top.max_film_pressure_mpa.value;
    (p > RIGID_MPA).then(|| {
        format!(
            "Mind that bodies are rigid here: the film pressure of {} MPa in {} at {} is more than elastic ones would let arise.",
            short(p),
            top.bearing,
            top.operating_point
        )
    })
}

fn loss(report: &Report) -> Option<String> {
    let o = &report.objective;
    let optimum = o.optimum.as_ref()?;
    let what = match (o.worst_case.is_empty(), report.running_in.as_ref().and_then(|r| r.minimised.as_ref()))
    {
        (_, Some(m)) => {
            let start = format!("the start {} {}", short(m.start), m.unit);
            let saved = m.saving_percent.map_or_else(String::new, |p| format!(", {} % saved", short(p)));
            let found = format!("{} {}", short(m.optimum), m.unit);
            return Some(format!("The design has a {} of {found}; {start}{saved}.", m.quantity));
        }
        (true, None) => "mean friction loss",
        (false, None) => "largest loss times weight",
    };
    if report.outcome.status == Outcome::Simulated {
        return Some(format!("The design as given has a {what} of {} W.", short(optimum.total_w)));
    }
    let found = format!("The design has a {what} of {} W", short(optimum.total_w));
    let Some(start) = &o.start else { return Some(format!("{found}.")) };
    let broken = o.start_violation.filter(|v| *v > KEPT);
    let less = start.total_w - optimum.total_w;
    Some(match (broken, o.saving_percent) {
        (Some(v), _) => format!(
            "{found}; the start, which breaks its limits by {} %, has {} W.",
            short(100.0 * v),
            short(start.total_w)
        ),
        (None, Some(percent)) => {
            format!("{found}, {} W ({} %) less than the start.", short(less), short(percent))
        }
        (None, None) => format!("{found}; the start has {} W.", short(start.total_w)),
    })
}

fn held_back(report: &Report) -> Option<String> {
    if !matches!(report.outcome.status, Outcome::Converged | Outcome::AlmostConverged) {
        return None;
    }
    let place = |c: &ConstraintReport| {
        format!("{} of {} at {}", c.quantity.replace('-', " "), c.bearing, c.operating_point)
    };
    let price = |price: Option<f64>, unit: &str| {
        price.filter(|p| *p > 0.0).map_or_else(String::new, |p| format!(" (price {} W per {unit})", short(p)))
    };
    let mut all: Vec<String> = report
        .constraints
        .iter()
        .filter(|c| c.active)
        .map(|c| format!("the limit on {}{}", place(c), price(c.price_w_per_unit, &c.unit)))
        .collect();
    all.extend(
        report
            .linear_constraints
            .iter()
            .filter(|l| l.active)
            .map(|l| format!("the limit on {}{}", l.sum, price(l.price_w_per_unit, &l.unit))),
    );
    if let Some(r) = &report.running_in {
        all.extend(r.limits.iter().filter(|l| l.active).map(|l| {
            let what = l.quantity.replace('-', " ");
            format!("the limit on {what} of {}{}", l.bearing, price(Some(l.price_w_per_unit), &l.unit))
        }));
    }
    all.extend(report.design.iter().filter(|d| d.at_bound != AtBound::No).map(|d| {
        let bound = if d.at_bound == AtBound::Lower { "lower" } else { "upper" };
        format!("the {bound} bound of {}{}", d.name, price(d.bound_price_w_per_unit, &d.unit))
    }));
    let more = all.len().saturating_sub(NAMED);
    all.truncate(NAMED);
    if more > 0 {
        all.push(format!("{more} more"));
    }
    match all.split_last() {
        None => Some("Nothing holds it back: the optimum lies inside its box and its limits.".to_owned()),
        Some((one, [])) => Some(format!("What holds it back: {one}.")),
        Some((last, others)) => Some(format!("What holds it back: {} and {last}.", others.join(", "))),
    }
}

fn not_met(report: &Report) -> Option<String> {
    let broken: Vec<&ConstraintReport> =
        report.constraints.iter().filter(|c| !c.met && c.value.is_some()).collect();
    let worst = broken.first()?;
    let value = worst.value.map_or_else(String::new, short);
    let more = match broken.len() {
        1 => String::new(),
        n => format!("; {} more limits are broken", n - 1),
    };
    Some(format!(
        "It is not safe: {} of {} at {} is {value} {unit}, {} {} {unit} is wanted{more}.",
        worst.quantity.replace('-', " "),
        worst.bearing,
        worst.operating_point,
        worst.sense,
        short(worst.limit),
        unit = worst.unit,
    ))
}

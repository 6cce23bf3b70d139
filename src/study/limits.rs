//! The second part of a report: what limits the design, and at which price.

use super::build::Plan;
use super::check::Study;
use super::robust;
use super::vocabulary::QuantityName;
use crate::optimise::{Evaluated, Minimum, Outcome, Sense, relative_excess};
use crate::report::{ConstraintReport, Curves, LinearReport};
use crate::units::tidy;

/// Relative distance from its limit up to which a constraint can be active.
pub(super) const ACTIVE_GAP: f64 = 1e-4;
/// Relative violation that counts as none.
pub(super) const MET: f64 = 1e-7;
/// A constraint whose multiplier exceeds this share of the objective is active.
pub(super) const ACTIVE: f64 = 1e-6;

/// The limits when no design was simulated.
pub(super) fn unknown_constraints(study: &Study) -> Vec<ConstraintReport> {
    let all = study.constraints.iter().flat_map(|c| {
        let bearings = (0..study.bearings.len()).filter(|b| c.bearing.is_none_or(|only| only == *b));
        bearings.flat_map(move |b| study.points.iter().map(move |p| (c, b, p)))
    });
    all.map(|(c, bearing, point)| {
        let (unit, _) = c.quantity.unit();
        ConstraintReport {
            quantity: c.quantity.key().to_owned(),
            bearing: study.bearings[bearing].name.clone(),
            operating_point: point.name.clone(),
            sense: words(c.sense).to_owned(),
            value: None,
            exact_value: None,
            bias: None,
            margin: None,
            limit: tidy(c.quantity.shown(c.limit)),
            unit: unit.to_owned(),
            active: false,
            met: false,
            price_w_per_unit: None,
        }
    })
    .collect()
}

pub(super) fn words(sense: Sense) -> &'static str {
    match sense {
        Sense::AtLeast => "at least",
        Sense::AtMost => "at most",
    }
}

pub(super) fn constraints(
    study: &Study,
    plan: &Plan,
    minimum: &Minimum,
    at: &Evaluated,
    curves: &[Curves],
) -> Vec<ConstraintReport> {
    let objective = minimum.values.as_ref().map_or(1.0, |v| v.objective.abs());
    let optimal = matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged);
    let margins = robust::margins(study, plan, &minimum.x);
    let row = |(k, label): (usize, &super::LimitLabel)| {
        let (c, case) = (&study.constraints[label.constraint], plan.cases[label.case]);
        let (unit, scale) = c.quantity.unit();
        let (smooth, exact) = c.quantity.of_cycle(study.sharpness);
        let orbit = &at.orbits[label.case];
        let multiplier = minimum.multipliers.inequalities.get(k).copied().unwrap_or(0.0);
        let value = orbit.value(&smooth);
        let (excess, _) = relative_excess(c.sense, c.limit, value);
        let margin = margins.as_ref().map(|m| m.inequalities[k]);
        let excess = excess + margin.unwrap_or(0.0);
        let active = excess > -ACTIVE_GAP && multiplier > ACTIVE * objective;
        // Outputs hold the smooth extremum over the cells; the exact one stands in the curves.
        let largest = |curve: &[f64]| curve.iter().copied().fold(0.0, f64::max);
        let exact_value = match c.quantity {
            QuantityName::MaxFilmPressure => largest(&curves[label.case].pressure_max_mpa),
            QuantityName::MaxContactPressure => largest(&curves[label.case].contact_max_mpa),
            QuantityName::MinFilmThickness => {
                curves[label.case].film_min_um.iter().copied().fold(f64::INFINITY, f64::min)
            }
            _ => c.quantity.shown(orbit.value(&exact)),
        };
        ConstraintReport {
            quantity: c.quantity.key().to_owned(),
            bearing: study.bearings[case.bearing].name.clone(),
            operating_point: study.points[case.point].name.clone(),
            sense: words(c.sense).to_owned(),
            value: Some(c.quantity.shown(value)),
            exact_value: Some(exact_value),
            bias: Some(c.quantity.shown(value) - exact_value),
            margin: margin.map(|m| m * c.limit / scale),
            limit: tidy(c.quantity.shown(c.limit)),
            unit: unit.to_owned(),
            active,
            met: excess <= study.optimiser.options.settings.tolerance.max(MET),
            price_w_per_unit: optimal.then_some(if active { multiplier / c.limit * scale } else { 0.0 }),
        }
    };
    plan.limits.iter().enumerate().map(row).collect()
}

/// Limits on sums of parameters.
pub(super) fn linear(study: &Study, minimum: &Minimum) -> Vec<LinearReport> {
    let optimal = matches!(minimum.outcome, Outcome::Converged | Outcome::AlmostConverged);
    let objective = minimum.values.as_ref().map_or(1.0, |v| v.objective.abs());
    let row = |(k, l): (usize, &super::linear::LinearPlan)| {
        let term = |&(j, factor): &(usize, f64)| {
            let name = &study.parameters[j].name;
            match factor {
                1.0 => name.clone(),
                -1.0 => format!("-{name}"),
                _ => format!("{} * {name}", tidy(factor)),
            }
        };
        let terms = l.terms.iter().map(term).collect::<Vec<_>>().join(" + ").replace("+ -", "- ");
        let size = l.variable.scale.0;
        let price = minimum.multipliers.linear.get(k).copied().unwrap_or(0.0);
        let (excess, room) = (l.excess(&minimum.x), l.room(&study.parameters));
        // Below the rounding of the sub-problem nobody wants to read digits.
        let at_limit = excess.abs() < 1e-9 * room;
        let met = excess <= study.optimiser.options.settings.tolerance.max(MET) * room;
        let pressed = excess.abs() < ACTIVE_GAP * room && price.abs() * room > ACTIVE * objective;
        let active = met && (l.sense.is_none() || pressed);
        LinearReport {
            sum: terms,
            sense: l.sense.map_or("equals", words).to_owned(),
            value: if at_limit { l.limit / size } else { l.value(&minimum.x) / size },
            limit: tidy(l.limit / size),
            unit: l.variable.unit.to_owned(),
            active,
            met,
            price_w_per_unit: optimal.then_some(if active { price * size } else { 0.0 }),
        }
    };
    study.linear.iter().enumerate().map(row).collect()
}

//! Checks of what is limited.

use super::bearings::Bearings;
use super::faults::{Faults, join};
use super::file::{ConstraintFile, StudyFile};
use super::plans::ConstraintPlan;
use super::vocabulary::QuantityName;
use crate::optimise::Sense;
use crate::units::{Length, Power, Pressure, Temperature, VolumeFlow, WearRate};

/// Limits of a safe design.
pub(super) fn constraints(
    file: &StudyFile,
    bearings: &Bearings,
    faults: &mut Faults,
) -> Option<Vec<ConstraintPlan>> {
    let list = faults.get(&file.constraints, "constraints").unwrap_or_default();
    let mut plans = Vec::new();
    for (i, given) in list.iter().enumerate() {
        let path = format!("constraints[{i}]");
        if let Some(c) = faults.get(given, &path) {
            plans.extend(constraint(&c, &path, bearings, faults));
        }
    }
    Some(plans)
}

pub(super) fn constraint(
    c: &ConstraintFile,
    path: &str,
    bearings: &Bearings,
    faults: &mut Faults,
) -> Option<ConstraintPlan> {
    faults.unknown::<ConstraintFile>(&c.unknown, path);
    let at = |key: &str| join(path, key);
    let bearing = faults.get(&c.bearing, &at("bearing")).and_then(|name| {
        let found = bearings.iter().position(|(n, _)| *n == name);
        if found.is_none() {
            let names: Vec<&str> = bearings.iter().map(|(n, _)| n.as_str()).collect();
            let words = format!("there is no bearing \"{name}\"; bearings: {}", names.join(", "));
            faults.add(&at("bearing"), words);
        }
        found
    });
    let least = faults.get(&c.at_least, &at("at_least"));
    let most = faults.get(&c.at_most, &at("at_most"));
    let quantity = faults.need(&c.quantity, &at("quantity"));
    if c.at_least.is_absent() && c.at_most.is_absent() {
        faults.add(path, "has no limit: give at_least or at_most");
        return None;
    }
    if let (Some(least), Some(most)) = (&least, &most) {
        faults.add(path, "has at_least and at_most; give one of them, the other in an entry of its own");
        for (key, text) in [("at_least", least), ("at_most", most)] {
            if let Some(Err(e)) = quantity.map(|q| limit_si(q, &text.0)) {
                faults.add(&at(key), format!("found \"{}\": {e}", text.0));
            }
        }
        return None;
    }
    let (sense, key, text) = match (least, most) {
        (Some(text), None) => (Sense::AtLeast, "at_least", text.0),
        (None, Some(text)) => (Sense::AtMost, "at_most", text.0),
        _ => return None,
    };
    let quantity = quantity?;
    let wrong = wrong_side(quantity, sense);
    if let Some(words) = wrong {
        faults.add(&at(key), words);
        return None;
    }
    let limit =
        limit_si(quantity, &text).map_err(|e| faults.add(&at(key), format!("found \"{text}\": {e}"))).ok()?;
    faults.range(Some(limit), &at(key), |v| v > 0.0, "above zero");
    if quantity == QuantityName::WearRate {
        needs_wear(&at("quantity"), bearings, bearing, faults);
    }
    if quantity.is_of_contact() {
        needs_contact(&at("quantity"), bearings, bearing, faults);
    }
    Some(ConstraintPlan { quantity, bearing, sense, limit })
}

pub(super) fn wrong_side(quantity: QuantityName, sense: Sense) -> Option<&'static str> {
    match quantity {
        QuantityName::MeanFrictionLoss => {
            Some("the mean friction loss is minimised; it cannot be limited too")
        }
        QuantityName::MinFilmThickness if sense == Sense::AtMost => {
            Some("a smallest film thickness needs at_least")
        }
        QuantityName::MaxFilmPressure | QuantityName::SpecificLoad | QuantityName::MaxContactPressure
            if sense == Sense::AtLeast =>
        {
            Some("a largest pressure needs at_most")
        }
        QuantityName::ContactLoss if sense == Sense::AtLeast => Some("a contact loss needs at_most"),
        QuantityName::WearRate if sense == Sense::AtLeast => Some("a wear rate needs at_most"),
        _ => None,
    }
}

/// A bearing whose surfaces cannot touch keeps every limit on contact: the limit would say nothing.
fn needs_contact(path: &str, bearings: &Bearings, only: Option<usize>, faults: &mut Faults) {
    let affected = bearings.iter().enumerate().filter(|(b, _)| only.is_none_or(|only| only == *b));
    for (_, (name, plan)) in affected {
        if plan.as_ref().is_some_and(|p| !p.has_contact()) {
            let words = format!(
                "has no effect on \"{name}\", whose surfaces do not touch: give bearings.{name}.roughness"
            );
            faults.add(path, format!("{words} with a contact, or name another bearing"));
        }
    }
}

/// A bearing whose contact rubs off nothing keeps every limit on wear.
pub(super) fn needs_wear(path: &str, bearings: &Bearings, only: Option<usize>, faults: &mut Faults) {
    let affected = bearings.iter().enumerate().filter(|(b, _)| only.is_none_or(|only| only == *b));
    for (_, (name, plan)) in affected {
        let Some(plan) = plan.as_ref().filter(|p| p.has_contact()) else { continue };
        if plan.roughness.as_ref().is_some_and(|r| r.wear_m3_per_j == 0.0) {
            let needed = format!("bearings.{name}.roughness.wear_coefficient and .boundary_friction");
            faults.add(path, format!("has no effect on \"{name}\": {needed} must be above zero"));
        }
    }
}

pub(super) fn limit_si(quantity: QuantityName, text: &str) -> Result<f64, String> {
    match quantity {
        QuantityName::MinFilmThickness => text.parse::<Length>().map(|v| v.si()).map_err(|e| e.to_string()),
        QuantityName::ContactLoss | QuantityName::HydrodynamicLoss => {
            text.parse::<Power>().map(|v| v.si()).map_err(|e| e.to_string())
        }
        QuantityName::FilmTemperature => {
            text.parse::<Temperature>().map(|v| v.si()).map_err(|e| e.to_string())
        }
        QuantityName::WearRate => text.parse::<WearRate>().map(|v| v.si()).map_err(|e| e.to_string()),
        QuantityName::SideFlow => text.parse::<VolumeFlow>().map(|v| v.si()).map_err(|e| e.to_string()),
        _ => text.parse::<Pressure>().map(|v| v.si()).map_err(|e| e.to_string()),
    }
}

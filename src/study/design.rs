//! Checks of what is varied and what is limited.

use super::Given;
use super::faults::{Faults, join};
use super::file::{ConstraintFile, ParameterFile, QuantityText, StudyFile};
use super::plans::{BearingPlan, ConstraintPlan, ParameterPlan};
use super::vocabulary::{QuantityName, Variable};
use crate::cranktrain::BearingParameter;
use crate::optimise::Sense;
use crate::report::short;
use crate::units::{Length, Pressure, Temperature, VolumeFlow, tidy};

/// Design parameters with their box.
pub(super) fn parameters(
    file: &mut StudyFile,
    names: &[String],
    bearings: Option<&[BearingPlan]>,
    faults: &mut Faults,
) -> Option<Vec<ParameterPlan>> {
    faults.need(&file.parameters, "parameters");
    let oil = file.oil.value().cloned().unwrap_or_default();
    let inlet_k = oil.inlet_temperature.value().map(|t| t.si());
    let constant = !oil.dynamic_viscosity.is_absent();
    let Given::Value(list) = &mut file.parameters else { return None };
    if list.is_empty() {
        faults.add("parameters", "needs at least one [[parameters]]");
    }
    let mut plans: Vec<ParameterPlan> = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("parameters[{i}]");
        faults.get(given, &path);
        let Given::Value(p) = given else { continue };
        faults.unknown::<ParameterFile>(&p.unknown, &path);
        let at = |key: &str| join(&path, key);
        let Some(name) = faults.need(&p.name, &at("name")) else { continue };
        let Some((bearing, variable)) = variable_of(&name, names) else {
            faults.add(
                &at("name"),
                format!("\"{name}\" is no parameter; choose from: {}", variable_names(names)),
            );
            continue;
        };
        if plans.iter().any(|q| q.name == name) {
            faults.add(&at("name"), format!("\"{name}\" stands twice"));
        }
        if constant && variable.parameter == BearingParameter::InletTemperature {
            faults.add(&at("name"), "has no effect: oil.dynamic_viscosity is the same at every temperature");
        }
        let known = match bearing {
            None => inlet_k,
            Some(b) => bearings.and_then(|all| all.get(b)).and_then(|b| base_value(b, variable)),
        };
        let owner = bearing.and_then(|b| bearings.and_then(|all| all.get(b)));
        if let Some((lower, upper, start)) = box_of(p, &path, variable, owner, known, faults) {
            plans.push(ParameterPlan { name, bearing, variable, lower, upper, start });
        }
    }
    Some(plans)
}

/// Lower bound, upper bound and start of a parameter, SI units; the start is written into the file.
fn box_of(
    p: &mut ParameterFile,
    path: &str,
    variable: Variable,
    owner: Option<&BearingPlan>,
    known: Option<f64>,
    faults: &mut Faults,
) -> Option<(f64, f64, f64)> {
    let at = |key: &str| join(path, key);
    let mut value = |text: Option<QuantityText>, key: &str| {
        let text = text?.0;
        si(variable, &text).map_err(|e| faults.add(&at(key), format!("found \"{text}\": {e}"))).ok()
    };
    let given = [p.lower.value().cloned(), p.upper.value().cloned(), p.start.value().cloned()];
    let [lower, upper, start] = given;
    let (lower, upper, start) = (value(lower, "lower"), value(upper, "upper"), value(start, "start"));
    faults.need(&p.lower, &at("lower"));
    faults.need(&p.upper, &at("upper"));
    faults.get(&p.start, &at("start"));
    let (lower, upper, start) = (lower?, upper?, start.or(known)?);
    let (least, most) = allowed(variable, owner);
    let unit = variable.unit;
    let words =
        format!("above {} and at most {} {unit}", short(variable.shown(least)), short(variable.shown(most)));
    faults.range(Some(lower), &at("lower"), |v| v > least && v <= most, &words);
    faults.range(Some(upper), &at("upper"), |v| v > least && v <= most, &words);
    if lower >= upper {
        faults.add(&at("upper"), "must be larger than lower");
    } else if !(lower..=upper).contains(&start) {
        let [low, high, found] = [lower, upper, start].map(|v| short(variable.shown(v)));
        let which = if p.start.is_absent() { "the value in its own section" } else { "the start" };
        faults.add(
            &at("start"),
            format!("{which} must lie between {low} and {high} {unit}, found {found} {unit}"),
        );
    }
    if p.start.is_absent() {
        p.start = Given::Value(QuantityText(format!("{} {unit}", tidy(variable.shown(start)))));
    }
    Some((lower, upper, start))
}

/// Values a variable may take at all, SI units.
fn allowed(variable: Variable, owner: Option<&BearingPlan>) -> (f64, f64) {
    match variable.parameter {
        BearingParameter::InletTemperature => (223.15, 473.15),
        BearingParameter::DiametralClearance => (0.0, owner.map_or(0.02, |b| 0.02 * b.diameter_m)),
        BearingParameter::Width | BearingParameter::Diameter => (0.0, 10.0),
    }
}

fn variable_of(name: &str, bearings: &[String]) -> Option<(Option<usize>, Variable)> {
    let (owner, key) = name.rsplit_once('.')?;
    if owner == "oil" {
        return Variable::OIL.into_iter().find(|v| v.key == key).map(|v| (None, v));
    }
    let bearing = bearings.iter().position(|b| b == owner)?;
    Variable::BEARING.into_iter().find(|v| v.key == key).map(|v| (Some(bearing), v))
}

fn variable_names(bearings: &[String]) -> String {
    let of_bearings = bearings.iter().flat_map(|b| Variable::BEARING.map(|v| format!("{b}.{}", v.key)));
    of_bearings.chain(Variable::OIL.map(|v| format!("oil.{}", v.key))).collect::<Vec<_>>().join(", ")
}

fn base_value(bearing: &BearingPlan, variable: Variable) -> Option<f64> {
    match variable.parameter {
        BearingParameter::Width => Some(bearing.width_m),
        BearingParameter::Diameter => Some(bearing.diameter_m),
        BearingParameter::DiametralClearance => Some(bearing.diametral_clearance_m),
        BearingParameter::InletTemperature => None,
    }
}

fn si(variable: Variable, text: &str) -> Result<f64, String> {
    match variable.unit {
        "degC" => text.parse::<Temperature>().map(|v| v.si()).map_err(|e| e.to_string()),
        _ => text.parse::<Length>().map(|v| v.si()).map_err(|e| e.to_string()),
    }
}

/// Limits of a safe design.
pub(super) fn constraints(
    file: &StudyFile,
    names: &[String],
    faults: &mut Faults,
) -> Option<Vec<ConstraintPlan>> {
    let list = faults.get(&file.constraints, "constraints").unwrap_or_default();
    let mut plans = Vec::new();
    for (i, given) in list.iter().enumerate() {
        let path = format!("constraints[{i}]");
        if let Some(c) = faults.get(given, &path) {
            plans.extend(constraint(&c, &path, names, faults));
        }
    }
    Some(plans)
}

fn constraint(
    c: &ConstraintFile,
    path: &str,
    names: &[String],
    faults: &mut Faults,
) -> Option<ConstraintPlan> {
    faults.unknown::<ConstraintFile>(&c.unknown, path);
    let at = |key: &str| join(path, key);
    let bearing = faults.get(&c.bearing, &at("bearing")).and_then(|name| {
        let found = names.iter().position(|n| *n == name);
        if found.is_none() {
            faults.add(
                &at("bearing"),
                format!("there is no bearing \"{name}\"; bearings: {}", names.join(", ")),
            );
        }
        found
    });
    let least = faults.get(&c.at_least, &at("at_least"));
    let most = faults.get(&c.at_most, &at("at_most"));
    let quantity = faults.need(&c.quantity, &at("quantity"));
    if c.at_least.is_absent() == c.at_most.is_absent() {
        faults.add(path, "give either at_least or at_most");
        return None;
    }
    let (sense, key, text) = match (least, most) {
        (Some(text), None) => (Sense::AtLeast, "at_least", text.0),
        (None, Some(text)) => (Sense::AtMost, "at_most", text.0),
        _ => return None,
    };
    let quantity = quantity?;
    let wrong = match quantity {
        QuantityName::MeanFrictionLoss => {
            Some("the mean friction loss is minimised; it cannot be limited too")
        }
        QuantityName::MinFilmThickness if sense == Sense::AtMost => {
            Some("a smallest film thickness needs at_least")
        }
        QuantityName::MaxFilmPressure | QuantityName::SpecificLoad if sense == Sense::AtLeast => {
            Some("a largest pressure needs at_most")
        }
        _ => None,
    };
    if let Some(words) = wrong {
        faults.add(&at(key), words);
        return None;
    }
    let limit =
        limit_si(quantity, &text).map_err(|e| faults.add(&at(key), format!("found \"{text}\": {e}"))).ok()?;
    faults.range(Some(limit), &at(key), |v| v > 0.0, "above zero");
    Some(ConstraintPlan { quantity, bearing, sense, limit })
}

fn limit_si(quantity: QuantityName, text: &str) -> Result<f64, String> {
    match quantity {
        QuantityName::MinFilmThickness => text.parse::<Length>().map(|v| v.si()).map_err(|e| e.to_string()),
        QuantityName::SideFlow => text.parse::<VolumeFlow>().map(|v| v.si()).map_err(|e| e.to_string()),
        _ => text.parse::<Pressure>().map(|v| v.si()).map_err(|e| e.to_string()),
    }
}

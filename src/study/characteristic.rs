//! Checks of a characteristic.

use super::Given;
use super::faults::{Faults, join};
use super::file::{BearingKind, CharacteristicFile, StudyFile, VaryName};
use super::table::Table;
use std::path::Path;

/// What is varied, SI units.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Vary {
    /// Eccentricity ratios at a speed.
    Eccentricity { ratios: Vec<f64>, speed_rad_s: f64, ambient_at_widest_gap: bool },
    /// Speeds.
    Speed(Vec<f64>),
}

/// A checked characteristic.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CharacteristicPlan {
    pub vary: Vary,
    pub reference: Option<Table>,
    pub source: Option<String>,
}

const PATH: &str = "characteristic";

fn at(key: &str) -> String {
    join(PATH, key)
}

/// Whether the study tabulates; what only a search needs is refused then.
pub(super) fn refuse_search(file: &StudyFile, faults: &mut Faults) -> bool {
    if file.characteristic.is_absent() {
        return false;
    }
    let why = "the study tabulates a characteristic instead of searching a design";
    faults.unused(&file.objective, "objective", why);
    faults.unused(&file.parameters, "parameters", why);
    faults.unused(&file.constraints, "constraints", why);
    faults.unused(&file.gradient, "gradient", why);
    faults.unused(&file.optimiser, "optimiser", why);
    faults.unused(&file.comparison, "comparison", why);
    faults.unused(&file.pareto, "pareto", why);
    faults.unused(&file.linear_constraints, "linear_constraints", why);
    faults.unused(&file.robust, "robust", why);
    faults.unused(&file.choices, "choices", why);
    faults.unused(&file.running_in, "running_in", why);
    true
}

pub(super) fn characteristic(
    file: &mut StudyFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<CharacteristicPlan> {
    faults.get(&file.characteristic, PATH);
    let Given::Value(c) = &mut file.characteristic else { return None };
    faults.unknown::<CharacteristicFile>(&c.unknown, PATH);
    let source = faults.get(&c.reference_source, &at("reference_source"));
    let reference = match &mut c.reference {
        Given::Value(table) => {
            let table = table.load(base, &at("reference"), faults);
            fingerprint.push_str(&table.as_ref().map(Table::fingerprint).unwrap_or_default());
            table
        }
        other => {
            faults.get(other, &at("reference"));
            None
        }
    };
    let vary = match faults.need(&c.vary, &at("vary"))? {
        VaryName::EccentricityRatio => eccentricity(c, faults)?,
        VaryName::Speed => speed(c, faults)?,
    };
    if let Some(words) = reference.as_ref().and_then(|r| r.column(&[(varied_key(&vary), 1.0)]).err()) {
        faults.add(&at("reference"), words);
    }
    Some(CharacteristicPlan { vary, reference, source })
}

/// Column of a reference that holds the varied quantity.
pub(super) fn varied_key(vary: &Vary) -> &'static str {
    match vary {
        Vary::Eccentricity { .. } => "eccentricity_ratio",
        Vary::Speed(_) => "speed_rpm",
    }
}

/// A bearing without load belongs to a characteristic that places its journal, and only to that.
pub(super) fn positions(file: &StudyFile, plan: Option<&CharacteristicPlan>, faults: &mut Faults) {
    let places = matches!(plan.map(|p| &p.vary), Some(Vary::Eccentricity { .. }));
    for (name, bearing) in file.bearings.value().into_iter().flatten() {
        let kind = bearing.value().and_then(|b| b.kind.value().copied());
        let over_speed = matches!(plan.map(|p| &p.vary), Some(Vary::Speed(_)));
        if over_speed && kind.is_some_and(|k| k != BearingKind::Constant) {
            let words =
                "a characteristic over the speed needs constant loads: kind = \"constant\" with force";
            faults.add(&format!("bearings.{name}.kind"), words);
        } else if kind == Some(BearingKind::Position) && !places {
            faults.add(
                &format!("bearings.{name}.kind"),
                "\"position\" has no load; it goes with characteristic.vary = \"eccentricity-ratio\" only",
            );
        }
    }
}

fn eccentricity(c: &mut CharacteristicFile, faults: &mut Faults) -> Option<Vary> {
    faults.unused(&c.speeds, &at("speeds"), "vary is \"eccentricity-ratio\"");
    let ratios = faults.need(&c.eccentricity_ratios, &at("eccentricity_ratios"));
    for (i, r) in ratios.iter().flatten().enumerate() {
        let path = format!("{}[{i}]", at("eccentricity_ratios"));
        faults.range(Some(*r), &path, |v| v > 0.0 && v < 1.0, "above 0 and below 1");
    }
    let speed = faults.need(&c.speed, &at("speed")).map(|v| v.si());
    faults.range(speed, &at("speed"), |v| v > 0.0 && v <= 2e4, "above zero and at most 190000 rpm");
    let ambient_at_widest_gap = faults.or(&mut c.ambient_at_widest_gap, &at("ambient_at_widest_gap"), false);
    Some(Vary::Eccentricity {
        ratios: some(ratios?, &at("eccentricity_ratios"), faults)?,
        speed_rad_s: speed?,
        ambient_at_widest_gap,
    })
}

fn speed(c: &mut CharacteristicFile, faults: &mut Faults) -> Option<Vary> {
    let why = "vary is \"speed\"";
    faults.unused(&c.eccentricity_ratios, &at("eccentricity_ratios"), why);
    faults.unused(&c.speed, &at("speed"), why);
    faults.unused(&c.ambient_at_widest_gap, &at("ambient_at_widest_gap"), why);
    let given = faults.need(&c.speeds, &at("speeds"))?;
    let mut speeds = Vec::new();
    for (i, speed) in given.iter().enumerate() {
        let path = format!("{}[{i}]", at("speeds"));
        let speed = faults.need(speed, &path).map(|v| v.si());
        faults.range(speed, &path, |v| v > 0.0 && v <= 2e4, "above zero and at most 190000 rpm");
        speeds.extend(speed);
    }
    Some(Vary::Speed(some(speeds, &at("speeds"), faults)?))
}

/// A list that is not empty.
fn some(list: Vec<f64>, path: &str, faults: &mut Faults) -> Option<Vec<f64>> {
    if list.is_empty() {
        faults.add(path, "needs at least one value");
        return None;
    }
    Some(list)
}

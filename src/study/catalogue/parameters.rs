//! What can be a design parameter: by patterns of names, or name by name for a study.
//!
//! Deliberately not here: what names stand for, which the lexicon knows.

use super::{EVERY_PARAMETER, docs};
use crate::cranktrain::BearingParameter;
use crate::study::bearings::Bearings;
use crate::study::file::FilmModelName;
use crate::study::lexicon::{EVERY, Lexicon, Target};
use crate::study::{Format, Study, Variable};
use crate::units::tidy;
use serde::Serialize;
use serde_json::Value;
use std::collections::HashSet;

/// Where the name of a coefficient of a spline becomes a number.
const COEFFICIENT: &str = "coefficients[";

/// Something that can be a parameter. Numbers are in its unit; without a study there are none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterEntry {
    /// Its name; a pattern without a study, with `<bearing>`, `<shape>`, `<stage>` and `<number>` for what a study names.
    pub name: String,
    /// Unit; "1" for numbers without one.
    pub unit: &'static str,
    /// What it is.
    pub meaning: String,
    /// What a study must have for it; empty for nothing.
    pub needs: &'static str,
    /// Value in its own section of the study; none for several coefficients that differ.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// What it may be at all: above the first, at most the second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowed: Option<[f64; 2]>,
    /// Its box, if it is a parameter of the study already.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 2]>,
    /// Where its search starts, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
}

impl ParameterEntry {
    /// Whether it stands for all coefficients of the spline another one belongs to.
    pub fn covers(&self, other: &Self) -> bool {
        let owner = self.name.strip_suffix(EVERY).filter(|_| self.name != other.name);
        let rest = owner.and_then(|owner| other.name.strip_prefix(owner));
        rest.is_some_and(|rest| rest.starts_with(COEFFICIENT))
    }
}

/// Everything that can be a parameter of a study (of one that searches nothing: if it searched), or the patterns of all names.
/// The coefficients of a spline stand there together and one by one.
pub fn parameters(study: Option<&Study>) -> Vec<ParameterEntry> {
    study.map_or_else(patterns, of_study)
}

/// Patterns of names, taken from a study that has everything.
fn patterns() -> Vec<ParameterEntry> {
    let study =
        Study::read(EVERY_PARAMETER, Format::Toml, None).expect("the study with every parameter is valid");
    let plain = |e: ParameterEntry| ParameterEntry {
        name: pattern(&e.name),
        value: None,
        allowed: None,
        bounds: None,
        start: None,
        ..e
    };
    let mut seen = HashSet::new();
    of_study(&study).into_iter().map(plain).filter(|e| seen.insert(e.name.clone())).collect()
}

/// A name of that study with what a study names left open.
fn pattern(name: &str) -> String {
    let (owner, key) = name.split_once('.').unwrap_or((name, ""));
    let last = key.rsplit_once('.').map_or(key, |(_, last)| last);
    match owner {
        "oil" => name.to_owned(),
        "running_in" => format!("running_in.<stage>.{last}"),
        _ if !key.starts_with("shapes.") => format!("<bearing>.{key}"),
        _ if last.starts_with(COEFFICIENT) && last != EVERY => {
            format!("<bearing>.shapes.<shape>.{COEFFICIENT}<number>]")
        }
        _ => format!("<bearing>.shapes.<shape>.{last}"),
    }
}

fn of_study(study: &Study) -> Vec<ParameterEntry> {
    let named: Bearings = study.bearings.iter().map(|b| (b.name.clone(), Some(b.clone()))).collect();
    let lexicon = Lexicon::of(&study.file, &named, Some(&study.film));
    let schema = crate::study::schema();
    let list = targets(study, &lexicon).into_iter().map(|target| entry(study, &lexicon, &schema, &target));
    with_splines(&list.collect::<Vec<_>>())
}

/// Everything of a study that can be a parameter.
fn targets(study: &Study, lexicon: &Lexicon) -> Vec<Target> {
    let tilts = study.film.model == FilmModelName::Reynolds;
    let mut all = Vec::new();
    for (b, plan) in study.bearings.iter().enumerate() {
        let list = Variable::of_bearing(plan, tilts).into_iter();
        all.extend(list.map(|(key, variable)| Target {
            name: format!("{}.{key}", plan.name),
            bearing: Some(b),
            stage: None,
            variable,
        }));
    }
    let oil = Variable::of_oil().into_iter().filter(|_| !lexicon.constant);
    all.extend(oil.map(|(key, variable)| Target {
        name: format!("oil.{key}"),
        bearing: None,
        stage: None,
        variable,
    }));
    let stages = study.running_in.iter().filter(|_| lexicon.runs_in).flat_map(|r| &r.stages);
    for (s, stage) in stages.enumerate() {
        let inlet = Some(BearingParameter::InletTemperature);
        let fits = |(_, v): &(String, Variable)| !lexicon.constant || v.parameter != inlet;
        let list = Variable::of_stage().into_iter().filter(fits);
        all.extend(list.map(|(key, variable)| Target {
            name: format!("running_in.{}.{key}", stage.point.name),
            bearing: None,
            stage: Some(s),
            variable,
        }));
    }
    all
}

fn entry(study: &Study, lexicon: &Lexicon, schema: &Value, target: &Target) -> ParameterEntry {
    let shown = |si: f64| tidy(target.variable.shown(si));
    let (least, most) = lexicon.allowed(target);
    let plan = study.parameters.iter().find(|p| p.name == target.name);
    let (meaning, needs) = told(schema, target);
    ParameterEntry {
        name: target.name.clone(),
        unit: target.variable.unit,
        meaning,
        needs,
        value: lexicon.value(target).map(shown),
        allowed: Some([shown(least), shown(most)]),
        bounds: plan.map(|p| [shown(p.lower), shown(p.upper)]),
        start: plan.map(|p| shown(p.start)),
    }
}

/// What a target is, by the section of the study file it belongs to, and what that section needs.
fn told(schema: &Value, target: &Target) -> (String, &'static str) {
    let key = target.name.split_once('.').map_or("", |(_, key)| key);
    let last = key.rsplit_once('.').map_or(key, |(_, last)| last);
    let (section, needs) = match (target.stage, target.bearing) {
        (Some(_), _) => ("StageFile", "[running_in] with minimise"),
        (_, None) => ("OilFile", "a viscosity that follows the temperature"),
        _ if key.starts_with("roughness.") => ("RoughnessFile", "[bearings.NAME.roughness]"),
        _ if key.starts_with("supply.") => ("SupplyFile", "[bearings.NAME.supply]"),
        _ if key.starts_with("shapes.") => ("ShapeFile", "[[bearings.NAME.shapes]]"),
        _ if key.starts_with("tilt_") => ("BearingFile", "film.model = \"reynolds\", no free_tilt"),
        _ => ("BearingFile", ""),
    };
    let word = last.split('[').next().unwrap_or(last);
    let meaning = docs::key(schema, section, word);
    // The one key that no section has: a table has it without being told.
    (meaning.unwrap_or_else(|| "Factor on the heights of a measured surface.".to_owned()), needs)
}

/// Where the coefficient of a spline belongs to.
fn spline(entry: &ParameterEntry) -> Option<&str> {
    entry.name.split_once(COEFFICIENT).map(|(owner, _)| owner)
}

/// The list with an entry for all coefficients of each spline ahead of them.
fn with_splines(list: &[ParameterEntry]) -> Vec<ParameterEntry> {
    let groups = list.chunk_by(|a, b| spline(a).is_some() && spline(a) == spline(b));
    let each = groups.flat_map(|group| {
        let all = spline(&group[0]).map(|owner| together(owner, group));
        all.into_iter().chain(group.iter().cloned())
    });
    each.collect()
}

fn together(owner: &str, group: &[ParameterEntry]) -> ParameterEntry {
    ParameterEntry {
        name: format!("{owner}{EVERY}"),
        value: shared(group, |e| e.value),
        bounds: shared(group, |e| e.bounds),
        start: shared(group, |e| e.start),
        ..group[0].clone()
    }
}

/// What all of a group have in common.
fn shared<T: PartialEq>(group: &[ParameterEntry], of: impl Fn(&ParameterEntry) -> Option<T>) -> Option<T> {
    let first = of(&group[0])?;
    group.iter().all(|e| of(e).as_ref() == Some(&first)).then_some(first)
}

#[cfg(test)]
mod tests;

//! The names of parameters: what they stand for, what values they may take.

use super::bearings::Bearings;
use super::faults::Faults;
use super::file::{FilmModelName, StageFile, StudyFile};
use super::plans::{BearingPlan, FilmPlan};
use super::variables::Variable;
use crate::cranktrain::BearingParameter;

/// All coefficients of a spline.
pub(super) const EVERY: &str = "coefficients[*]";
/// Keys below a bearing that exist only with a section of their own.
const DETAILS: [&str; 4] = ["roughness.", "supply.", "shapes.", "tilt_"];

/// Longest stage of a programme, s; largest factor on a load; fastest crankshaft, rad/s.
pub(super) const LONGEST_S: f64 = 1e9;
pub(super) const LARGEST_FACTOR: f64 = 100.0;
pub(super) const FASTEST_RAD_S: f64 = 2e4;

/// One thing a parameter of the file varies.
pub(super) struct Target {
    pub name: String,
    pub bearing: Option<usize>,
    /// Stage of the running-in programme, if it is one of those.
    pub stage: Option<usize>,
    pub variable: Variable,
}

/// What a stage of the programme says for itself.
pub(super) struct StageValues {
    name: String,
    duration_s: Option<f64>,
    speed_rad_s: Option<f64>,
    load_factor: f64,
    inlet_k: Option<f64>,
}

/// What parameters are looked up in.
pub(super) struct Lexicon<'a> {
    pub bearings: &'a Bearings,
    pub film: Option<&'a FilmPlan>,
    pub inlet_k: Option<f64>,
    /// The viscosity does not depend on the temperature.
    pub constant: bool,
    /// Stages of the running-in programme.
    pub stages: Vec<StageValues>,
    /// Whether a design for them is searched.
    pub runs_in: bool,
}

impl<'a> Lexicon<'a> {
    /// That of a study.
    pub fn of(file: &StudyFile, bearings: &'a Bearings, film: Option<&'a FilmPlan>) -> Self {
        let oil = file.oil.value();
        let inlet_k = oil.and_then(|o| o.inlet_temperature.value()).map(|t| t.si());
        let constant = oil.is_some_and(|o| !o.dynamic_viscosity.is_absent());
        let programme = file.running_in.value();
        let runs_in = programme.is_some_and(|r| !r.minimise.is_absent());
        let values = |s: &StageFile| {
            Some(StageValues {
                name: s.name.value()?.clone(),
                duration_s: s.duration.value().map(|v| v.si()),
                speed_rad_s: s.speed.value().map(|v| v.si()),
                load_factor: s.load_factor.value().copied().unwrap_or(1.0),
                inlet_k: s.oil_inlet_temperature.value().map(|t| t.si()).or(inlet_k),
            })
        };
        let list = programme.and_then(|r| r.stages.value());
        let stages = list.into_iter().flatten().filter_map(|s| s.value().and_then(values)).collect();
        Self { bearings, film, inlet_k, constant, stages, runs_in }
    }

    /// The targets of a stage of the programme, written `running_in.<stage>.<key>`.
    fn of_stage(&self, rest: &str) -> Vec<Target> {
        let Some((name, key)) = rest.rsplit_once('.') else { return Vec::new() };
        let stage = self.stages.iter().position(|s| s.name == name);
        let found = Variable::of_stage().into_iter().filter(|(k, _)| k == key && stage.is_some());
        let name = format!("running_in.{rest}");
        found.map(|(_, variable)| Target { name: name.clone(), bearing: None, stage, variable }).collect()
    }

    /// What a name stands for; several for all coefficients of a spline.
    pub fn targets(&self, name: &str, path: &str, faults: &mut Faults) -> Option<Vec<Target>> {
        let (owner, key) = name.split_once('.').unwrap_or((name, ""));
        let bearing = self.bearings.iter().position(|(b, _)| b == owner);
        let list = match bearing {
            _ if owner == "oil" => Variable::of_oil(),
            Some(b) => self.of_bearing(b),
            None => Vec::new(),
        };
        let fits = |found: &str| match key.strip_suffix(EVERY) {
            Some(shape) => found.strip_prefix(shape).is_some_and(|rest| rest.starts_with("coefficients[")),
            None => found == key,
        };
        let mut found: Vec<Target> = list
            .into_iter()
            .filter(|(found, _)| fits(found))
            .map(|(key, variable)| Target { name: format!("{owner}.{key}"), bearing, stage: None, variable })
            .collect();
        if owner == "running_in" {
            found.extend(self.of_stage(key));
        }
        if let Some(first) = found.first() {
            if self.constant && first.variable.parameter == Some(BearingParameter::InletTemperature) {
                faults.add(path, "has no effect: oil.dynamic_viscosity is the same at every temperature");
            }
            if first.stage.is_some() && !self.runs_in {
                faults.add(path, "belongs to a running-in design only: give running_in.minimise");
            }
            return Some(found);
        }
        let broken = bearing.is_some_and(|b| self.bearings[b].1.is_none());
        if !broken || !DETAILS.iter().any(|d| key.starts_with(d)) {
            faults.add(path, format!("\"{name}\" is no parameter; choose from: {}", self.names()));
        }
        None
    }

    fn of_bearing(&self, bearing: usize) -> Vec<(String, Variable)> {
        let tilts = self.film.is_none_or(|f| f.model == FilmModelName::Reynolds);
        match &self.bearings[bearing].1 {
            Some(plan) => Variable::of_bearing(plan, tilts),
            None => Variable::of_any_bearing(),
        }
    }

    /// All names, the coefficients of a spline together.
    fn names(&self) -> String {
        let mut names: Vec<String> = Vec::new();
        for (b, (owner, _)) in self.bearings.iter().enumerate() {
            for (key, _) in self.of_bearing(b) {
                let key = match key.split_once("coefficients[") {
                    Some((shape, _)) => format!("{shape}{EVERY}"),
                    None => key,
                };
                names.push(format!("{owner}.{key}"));
            }
        }
        names.dedup();
        names.extend(Variable::of_oil().iter().map(|(key, _)| format!("oil.{key}")));
        for stage in self.stages.iter().filter(|_| self.runs_in) {
            names.extend(
                Variable::of_stage().iter().map(|(key, _)| format!("running_in.{}.{key}", stage.name)),
            );
        }
        names.join(", ")
    }

    fn plan(&self, target: &Target) -> Option<&BearingPlan> {
        target.bearing.and_then(|b| self.bearings[b].1.as_ref())
    }

    /// The value in the section of the target.
    pub fn value(&self, target: &Target) -> Option<f64> {
        let parameter = target.variable.parameter;
        if let Some(stage) = target.stage.map(|s| &self.stages[s]) {
            return match parameter {
                Some(BearingParameter::Speed) => stage.speed_rad_s,
                Some(BearingParameter::LoadFactor) => Some(stage.load_factor),
                Some(_) => stage.inlet_k,
                None => stage.duration_s,
            };
        }
        match target.bearing {
            None => self.inlet_k,
            Some(_) => self.plan(target).and_then(|b| parameter.and_then(|p| b.value(p))),
        }
    }

    /// Values a target may take at all, SI units.
    pub fn allowed(&self, target: &Target) -> (f64, f64) {
        let plan = self.plan(target);
        let within = |most: f64| (-most, most);
        let Some(parameter) = target.variable.parameter else { return (0.0, LONGEST_S) };
        match parameter {
            BearingParameter::LoadFactor => (0.0, LARGEST_FACTOR),
            BearingParameter::Speed => (0.0, FASTEST_RAD_S),
            BearingParameter::InletTemperature | BearingParameter::FilmTemperature => (223.15, 473.15),
            BearingParameter::DiametralClearance => (0.0, plan.map_or(0.02, |b| 0.02 * b.diameter_m)),
            BearingParameter::Width | BearingParameter::Diameter => (0.0, 10.0),
            BearingParameter::JournalRoughness | BearingParameter::ShellRoughness => (0.0, 50e-6),
            BearingParameter::SupplyPressure => (self.film.map_or(0.0, |f| f.cavitation_pressure_pa), 1e8),
            // More would let the centred journal touch the edges.
            BearingParameter::Tilt(_) => within(plan.map_or(0.1, |b| b.diametral_clearance_m / b.width_m)),
            BearingParameter::Shape(..) => match target.variable.unit {
                "um" => within(1e-2),
                "deg" => within(4.0 * std::f64::consts::PI),
                _ if target.name.ends_with(".length_share") => (0.0, 1.0),
                _ => within(1e3),
            },
        }
    }
}

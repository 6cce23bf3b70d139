//! From the file to a checked study: SI values, defaults written in, every mistake reported.

use super::bearings::{Bearings, Frame};
use super::characteristic::CharacteristicPlan;
use super::choices::Choices;
use super::comparison::ComparisonPlan;
use super::expected::ExpectedPlan;
use super::faults::{Faults, without_nulls};
use super::file::{FilmModelName, StudyFile};
use super::hash::sha256;
use super::layout::ExperimentsPlan;
use super::linear::{LinearPlan, linear_constraints};
use super::oil::OilUse;
use super::pareto::ParetoPlan;
use super::plans::{BearingPlan, ConstraintPlan, FilmPlan, OilPlan, OperatingPoint, ParameterPlan};
use super::robust::{RobustPlan, robust};
use super::running_in::{RunningInPlan, running_in};
use super::searches::SearchPlan;
use super::{
    FORMAT, bearings, characteristic, comparison, constraints, film, heat, loads, oil, parameters, pareto,
    sections,
};
use crate::cranktrain::{BearingParameter, Cylinder, VeeEngine};
use crate::gradient::EngineName;
use crate::orbit::OrbitOptions;
use std::path::Path;

/// Cycles that are held in memory at a time, per bearing and operating point.
const KEPT_CYCLES: f64 = 5.0;
/// Share of a cycle that checkpoints take.
const CHECKPOINTED: f64 = 1.0 / 16.0;
/// Memory a study may ask for.
const MOST_BYTES: f64 = 8e9;

/// A study that can be run.
#[derive(Debug, Clone)]
pub struct Study {
    /// The file with every default written out.
    pub file: StudyFile,
    /// SHA-256 of the file with its tables.
    pub hash: String,
    /// Bearings.
    pub bearings: Vec<BearingPlan>,
    /// Operating points.
    pub points: Vec<OperatingPoint>,
    /// Design parameters.
    pub parameters: Vec<ParameterPlan>,
    /// Limits.
    pub constraints: Vec<ConstraintPlan>,
    /// Film.
    pub film: FilmPlan,
    /// Orbit.
    pub orbit: OrbitOptions,
    /// Oil.
    pub oil: OilPlan,
    /// Gradient engine.
    pub engine: EngineName,
    /// Relative perturbation of the finite differences.
    pub perturbation: f64,
    /// Optimiser.
    pub optimiser: SearchPlan,
    /// Sharpness of smooth extrema.
    pub sharpness: f64,
    pub(super) characteristic: Option<CharacteristicPlan>,
    pub(super) comparison: Option<ComparisonPlan>,
    pub(super) pareto: Option<ParetoPlan>,
    pub(super) linear: Vec<LinearPlan>,
    pub(super) worst_case: bool,
    pub(super) robust: Option<RobustPlan>,
    pub(super) running_in: Option<RunningInPlan>,
    pub(super) choices: Option<Choices>,
    pub(super) experiments: Option<ExperimentsPlan>,
    pub(super) expected: Vec<ExpectedPlan>,
    /// Whether it was read with its coarse setting.
    pub coarse: bool,
    /// Hash of the study whose design the starts are.
    pub(super) started_from: Option<String>,
    pub(super) cylinder: Option<Cylinder>,
    pub(super) vee: Option<VeeEngine>,
}

impl Study {
    /// The same without the studies that are made of it.
    pub(super) fn alone(&self) -> Self {
        Self { choices: None, experiments: None, ..self.clone() }
    }

    /// The studies of its experiments, if it has any.
    pub fn experiments(&self) -> impl Iterator<Item = &Study> {
        self.experiments.iter().flat_map(|plan| plan.runs.iter().map(|run| &run.study))
    }

    /// The same with nothing to search: its start design is the answer.
    pub(super) fn without_search(&self) -> Self {
        let mut study = Self { pareto: None, robust: None, worst_case: false, ..self.alone() };
        study.optimiser.rivals.clear();
        if let Some(running_in) = &mut study.running_in {
            running_in.minimise = None;
        }
        study
    }

    /// Whether a design is searched; otherwise the study asks for a table, experiments, or a comparison of gradient engines.
    pub fn searches(&self) -> bool {
        !self.points.is_empty() && self.comparison.is_none() && self.experiments.is_none()
    }

    /// Whether it compares times, which others must not disturb.
    pub fn measures_time(&self) -> bool {
        self.comparison.is_some() || !self.optimiser.rivals.is_empty()
    }

    /// Whether a running-in design is searched.
    pub fn runs_in(&self) -> bool {
        self.running_in.as_ref().is_some_and(|r| r.minimise.is_some())
    }

    /// Everything a gradient is taken by: the design parameters, then what scatters without being one.
    pub(super) fn variables(&self) -> impl Iterator<Item = &ParameterPlan> {
        self.parameters.iter().chain(self.robust.iter().flat_map(|r| &r.beside))
    }

    /// Whether half of the width of a bearing tells all.
    pub(super) fn half_suffices(&self, bearing: usize) -> bool {
        let tilts = self.variables().any(|p| {
            p.bearing == Some(bearing) && matches!(p.variable.parameter, Some(BearingParameter::Tilt(_)))
        });
        self.bearings[bearing].symmetric(tilts)
    }

    /// Cells of a bearing's film.
    pub(super) fn cells(&self, bearing: usize) -> usize {
        let halves = if self.half_suffices(bearing) { 1 } else { 2 };
        halves * self.film.cells_around * self.film.cells_across_half
    }

    /// The study with every default written out, as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string_pretty(&self.to_json()).expect("a checked study is valid TOML")
    }

    /// The study with every default written out, as JSON.
    pub fn to_json(&self) -> serde_json::Value {
        without_nulls(serde_json::to_value(&self.file).expect("a checked study is valid JSON"))
    }
}

pub(super) fn check(mut file: StudyFile, base: Option<&Path>, faults: &mut Faults) -> Option<Study> {
    faults.unknown::<StudyFile>(&file.unknown, "");
    if let Some(format) = faults.need(&file.format, "format").filter(|f| f != FORMAT) {
        faults.add("format", format!("this program reads \"{FORMAT}\", found \"{format}\""));
    }
    faults.need(&file.title, "title");
    faults.get(&file.question, "question");
    let mut fingerprint = String::new();
    let film = faults.section(&mut file.film, "film").and_then(|f| film::film(f, faults));
    let frame = Frame { film: film.as_ref(), base };
    let named = bearings::bearings(&mut file, &frame, faults, &mut fingerprint).unwrap_or_default();
    let (cylinder, vee) = loads::machine_of(&mut file, base, faults, &mut fingerprint);
    let used = OilUse {
        mobility: film.as_ref().is_some_and(|f| f.model == FilmModelName::Mobility),
        heat: heat::any_heat_balance(&file),
    };
    let oil = oil::oil(&mut file, used, faults, &mut fingerprint);
    let orbit = faults.section(&mut file.orbit, "orbit").map(|o| sections::orbit_options(o, faults));
    let characteristic = characteristic::characteristic(&mut file, base, faults, &mut fingerprint);
    if !faults.any() {
        characteristic::positions(&file, characteristic.as_ref(), faults);
    }
    let search = match characteristic::refuse_search(&file, faults) {
        true => Some(Search::none()),
        false => search(&mut file, &named, film.as_ref(), faults),
    };
    sections::assumptions(&mut file, faults);
    if faults.any() {
        return None;
    }
    let Search {
        points,
        parameters,
        constraints,
        engine,
        perturbation,
        optimiser,
        sharpness,
        comparison,
        pareto,
        linear,
        worst_case,
        robust,
        running_in,
    } = search?;
    let mut study = Study {
        hash: String::new(),
        bearings: named.into_iter().map(|(_, plan)| plan).collect::<Option<_>>()?,
        points,
        parameters,
        constraints,
        characteristic,
        comparison,
        pareto,
        linear,
        worst_case,
        robust,
        running_in,
        choices: None,
        experiments: None,
        expected: Vec::new(),
        coarse: false,
        started_from: None,
        film: film?,
        orbit: orbit?,
        oil: oil?,
        engine,
        perturbation,
        optimiser,
        sharpness,
        cylinder,
        vee,
        file,
    };
    if let Some(words) = too_large(&study) {
        faults.add("film", words);
        return None;
    }
    study.hash = sha256(&format!("{}{fingerprint}", computed(study.to_json())));
    Some(study)
}

/// What of a study decides on its answer: not its words, nor the figures it is held against, nor another setting.
fn computed(mut study: serde_json::Value) -> serde_json::Value {
    if let Some(map) = study.as_object_mut() {
        ["title", "question", "assumptions", "expected", "coarse"]
            .iter()
            .for_each(|section| drop(map.remove(*section)));
    }
    study
}

/// What is searched and how.
struct Search {
    points: Vec<OperatingPoint>,
    parameters: Vec<ParameterPlan>,
    constraints: Vec<ConstraintPlan>,
    engine: EngineName,
    perturbation: f64,
    optimiser: SearchPlan,
    sharpness: f64,
    comparison: Option<ComparisonPlan>,
    pareto: Option<ParetoPlan>,
    linear: Vec<LinearPlan>,
    worst_case: bool,
    robust: Option<RobustPlan>,
    running_in: Option<RunningInPlan>,
}

impl Search {
    /// Nothing: the study tabulates.
    fn none() -> Self {
        Self {
            points: Vec::new(),
            parameters: Vec::new(),
            constraints: Vec::new(),
            engine: EngineName::Adj,
            perturbation: sections::PERTURBATION,
            optimiser: SearchPlan::default(),
            sharpness: sections::SHARPNESS,
            comparison: None,
            pareto: None,
            linear: Vec::new(),
            worst_case: false,
            robust: None,
            running_in: None,
        }
    }
}

fn search(
    file: &mut StudyFile,
    named: &Bearings,
    film: Option<&FilmPlan>,
    faults: &mut Faults,
) -> Option<Search> {
    let (points, worst_case) = sections::points(file, faults).unzip();
    let before = faults.count();
    let parameters = parameters::parameters(file, named, film, faults);
    let all = parameters.as_ref().filter(|_| faults.count() == before).map(Vec::len);
    let constraints = constraints::constraints(file, named, faults);
    let comparison = comparison::comparison(file, all, faults);
    let pareto = pareto::pareto(file, named, faults);
    let linear = linear_constraints(file, parameters.as_deref().unwrap_or_default(), faults);
    let robust = robust(file, named, film, parameters.as_deref().unwrap_or_default(), faults);
    let (gradient, optimiser) = match file.comparison.is_absent() {
        true => (sections::gradient(file, faults), sections::optimiser(file, faults)),
        false => {
            faults.unused(&file.pareto, "pareto", comparison::WHY);
            faults.unused(&file.robust, "robust", comparison::WHY);
            faults.unused(&file.linear_constraints, "linear_constraints", comparison::WHY);
            faults.unused(&file.choices, "choices", comparison::WHY);
            faults.unused(&file.running_in, "running_in", comparison::WHY);
            let perturbation = comparison::perturbation(file, faults);
            (perturbation.map(|eps| (EngineName::Adj, eps)), comparison::sharpness(file, faults))
        }
    };
    let sharpness = optimiser.as_ref().map_or(sections::SHARPNESS, |(_, sharpness)| *sharpness);
    let running_in = running_in(file, named, film, sharpness, faults);
    let ((engine, perturbation), (optimiser, sharpness)) = (gradient?, optimiser?);
    Some(Search {
        points: points?,
        parameters: parameters?,
        constraints: constraints?,
        engine,
        perturbation,
        optimiser,
        sharpness,
        comparison,
        pareto,
        linear,
        worst_case: worst_case?,
        robust,
        running_in,
    })
}

/// Why a study needs more memory than there is.
fn too_large(study: &Study) -> Option<String> {
    let cycle = |bearing: usize| {
        let states = (study.cells(bearing) * study.orbit.steps * size_of::<f64>()) as f64;
        if states <= study.orbit.memory_bytes as f64 { states } else { states * CHECKPOINTED }
    };
    let cycles: f64 = (0..study.bearings.len()).map(cycle).sum();
    let bytes = cycles * study.points.len() as f64 * KEPT_CYCLES;
    (bytes > MOST_BYTES).then(|| {
        let (needed, most) = (crate::report::short(bytes * 1e-9), crate::report::short(MOST_BYTES * 1e-9));
        format!("cells times steps, bearings and operating points need {needed} GB; at most {most} GB")
    })
}

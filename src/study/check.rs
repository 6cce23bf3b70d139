//! From the file to a checked study: SI values, defaults written in, every mistake reported.

use super::document::{Format, parse};
use super::faults::{Fault, Faults, StudyErrors, line_of, without_nulls};
use super::file::{CavitationName, FilmModelName, StudyFile};
use super::vocabulary::{QuantityName, Variable};
use super::{FORMAT, bearings, design, sections};
use crate::cranktrain::{Cylinder, LoadTable, VeeEngine};
use crate::gradient::EngineName;
use crate::laws::Viscosity;
use crate::optimise::{Sense, SqpOptions};
use crate::orbit::OrbitOptions;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Where the load of a planned bearing comes from.
#[derive(Debug, Clone)]
pub(super) enum LoadPlan {
    BigEnd,
    Main(usize),
    Table(LoadTable),
}

/// A checked bearing.
#[derive(Debug, Clone)]
pub struct BearingPlan {
    /// Name in the study.
    pub name: String,
    /// Width, m.
    pub width_m: f64,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Diametral clearance, m.
    pub diametral_clearance_m: f64,
    /// Mass that moves with the journal, kg.
    pub journal_mass_kg: f64,
    /// How many there are.
    pub count: u32,
    pub(super) load: LoadPlan,
}

/// A checked operating point.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatingPoint {
    /// Name in reports.
    pub name: String,
    /// Speed of the crankshaft, rad/s.
    pub speed_rad_s: f64,
    /// Share in the objective; all shares add up to 1.
    pub weight: f64,
    /// Factor on cylinder pressure or load.
    pub load_factor: f64,
}

/// A checked design parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterPlan {
    /// Name in the study.
    pub name: String,
    /// Bearing it belongs to; `None` for the oil.
    pub bearing: Option<usize>,
    /// Which property.
    pub variable: Variable,
    /// Box and start, SI units.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Start.
    pub start: f64,
}

/// A checked limit.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstraintPlan {
    /// Limited quantity.
    pub quantity: QuantityName,
    /// Bearing; `None` for all.
    pub bearing: Option<usize>,
    /// Allowed side.
    pub sense: Sense,
    /// Limit, SI units.
    pub limit: f64,
}

/// A checked film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmPlan {
    /// Model.
    pub model: FilmModelName,
    /// Rupture.
    pub cavitation: CavitationName,
    /// Columns.
    pub cells_around: usize,
    /// Cells across half of the width.
    pub cells_across_half: usize,
    /// Above the surroundings, Pa.
    pub side_pressure_pa: f64,
    /// Above the surroundings, Pa.
    pub cavitation_pressure_pa: f64,
}

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
    /// Viscosity law.
    pub viscosity: Viscosity,
    /// Temperature at the inlet, K.
    pub inlet_temperature_k: f64,
    /// Film less inlet temperature, K.
    pub film_rise_k: f64,
    /// Gradient engine.
    pub engine: EngineName,
    /// Relative perturbation of the finite differences.
    pub perturbation: f64,
    /// Optimiser.
    pub optimiser: SqpOptions,
    /// Sharpness of smooth extrema.
    pub sharpness: f64,
    pub(super) cylinder: Option<Cylinder>,
    pub(super) vee: Option<VeeEngine>,
}

impl Study {
    /// Reads and checks a study. Tables in files are looked for below `base`; without a base no file is read.
    pub fn read(text: &str, format: Format, base: Option<&Path>) -> Result<Self, StudyErrors> {
        let (value, spans) = parse(text, format).map_err(|errors| {
            let faults = errors.into_iter().map(|(message, span)| Fault {
                path: String::new(),
                message,
                line: Some(line_of(text, span.start)),
                span: Some(span),
            });
            StudyErrors { faults: faults.collect(), text: text.to_owned() }
        })?;
        let mut faults = Faults::of(value.clone());
        let study = match StudyFile::deserialize(value) {
            Ok(file) => check(file, base, &mut faults),
            Err(e) => {
                faults.add("", format!("the file must be a table of sections ({e})"));
                None
            }
        };
        if let (Some(study), false) = (study, faults.any()) {
            return Ok(study);
        }
        let mut faults: Vec<Fault> = faults
            .into_list()
            .into_iter()
            .map(|(path, message)| {
                let span = spans.find(&path);
                Fault { line: span.as_ref().map(|s| line_of(text, s.start)), path, message, span }
            })
            .collect();
        faults.sort_by_key(|f| f.line);
        faults.dedup();
        Err(StudyErrors { faults, text: text.to_owned() })
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

fn check(mut file: StudyFile, base: Option<&Path>, faults: &mut Faults) -> Option<Study> {
    faults.unknown::<StudyFile>(&file.unknown, "");
    if let Some(format) = faults.need(&file.format, "format").filter(|f| f != FORMAT) {
        faults.add("format", format!("this program reads \"{FORMAT}\", found \"{format}\""));
    }
    faults.need(&file.title, "title");
    faults.get(&file.question, "question");
    let mut fingerprint = String::new();
    let plans = bearings::bearings(&mut file, base, faults, &mut fingerprint);
    let (cylinder, vee) = bearings::machine_of(&mut file, base, faults, &mut fingerprint);
    let oil = sections::oil(&mut file, faults);
    let film = faults.section(&mut file.film, "film").and_then(|f| sections::film(f, faults));
    let orbit = faults.section(&mut file.orbit, "orbit").map(|o| sections::orbit_options(o, faults));
    let points = sections::points(&mut file, faults);
    let names: Vec<String> = file.bearings.value().map(|b| b.keys().cloned().collect()).unwrap_or_default();
    let parameters = design::parameters(&mut file, &names, plans.as_deref(), faults);
    let constraints = design::constraints(&file, &names, faults);
    let gradient = sections::gradient(&mut file, faults);
    let optimiser = sections::optimiser(&mut file, faults);
    sections::assumptions(&mut file, faults);
    if faults.any() {
        return None;
    }
    let (viscosity, inlet_temperature_k, film_rise_k) = oil?;
    let (engine, perturbation) = gradient?;
    let (optimiser, sharpness) = optimiser?;
    let mut study = Study {
        hash: String::new(),
        bearings: plans?,
        points: points?,
        parameters: parameters?,
        constraints: constraints?,
        film: film?,
        orbit: orbit?,
        viscosity,
        inlet_temperature_k,
        film_rise_k,
        engine,
        perturbation,
        optimiser,
        sharpness,
        cylinder,
        vee,
        file,
    };
    let digest = Sha256::digest(format!("{}{fingerprint}", study.to_json()).as_bytes());
    study.hash = digest.iter().map(|b| format!("{b:02x}")).collect();
    Some(study)
}

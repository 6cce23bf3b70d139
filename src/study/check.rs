//! From the file to a checked study: SI values, defaults written in, every mistake reported.

use super::document::{Format, parse};
use super::faults::{Fault, Faults, StudyErrors, line_of, without_nulls};
use super::file::StudyFile;
use super::plans::{BearingPlan, ConstraintPlan, FilmPlan, OperatingPoint, ParameterPlan};
use super::{FORMAT, bearings, design, sections};
use crate::cranktrain::{Cylinder, VeeEngine};
use crate::gradient::EngineName;
use crate::laws::Viscosity;
use crate::optimise::SqpOptions;
use crate::orbit::OrbitOptions;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Cycles that are held in memory at a time, per bearing and operating point.
const KEPT_CYCLES: f64 = 5.0;
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
    if let (Some(film), Some(orbit), Some(plans), Some(points)) = (&film, &orbit, &plans, &points) {
        let cells = film.cells_around * film.cells_across_half;
        let bytes =
            cells as f64 * orbit.steps as f64 * 8.0 * KEPT_CYCLES * (plans.len() * points.len()) as f64;
        if bytes > MOST_BYTES {
            let needed = crate::report::short(bytes * 1e-9);
            let most = crate::report::short(MOST_BYTES * 1e-9);
            faults.add(
                "film",
                format!(
                    "cells times steps, bearings and operating points need {needed} GB; at most {most} GB"
                ),
            );
        }
    }
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

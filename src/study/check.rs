//! From the file to a checked study: SI values, defaults written in, every mistake reported.

use super::document::{Format, parse};
use super::faults::{Fault, Faults, StudyErrors, join, line_of, without_nulls};
use super::file::{
    BearingFile, BearingKind, CavitationName, ConstraintFile, FilmFile, FilmModelName, GradientFile,
    MethodName, ObjectiveFile, OilFile, OperatingPointFile, OptimiserFile, OrbitFile, ParameterFile,
    SchemeName, StudyFile,
};
use super::machine::{self, zero};
use super::table::{TableFile, periodic};
use super::vocabulary::{QuantityName, Variable};
use super::{FORMAT, Given};
use crate::cranktrain::{Cylinder, LoadTable, VeeEngine};
use crate::gradient::EngineName;
use crate::laws::Viscosity;
use crate::math::PeriodicSpline;
use crate::optimise::{Sense, SqpOptions};
use crate::orbit::{OrbitOptions, Scheme};
use crate::units::{Length, Pressure, Temperature, VolumeFlow};
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
        let mut faults = Faults::default();
        let study = match StudyFile::deserialize(value) {
            Ok(file) => check(file, base, &mut faults),
            Err(e) => {
                faults.add("", format!("the file must be a table of sections: {e}"));
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
    let bearings = bearings(&mut file, base, faults, &mut fingerprint);
    let (cylinder, vee) = machine_of(&mut file, base, faults, &mut fingerprint);
    if let (Some(bearings), Some(engine)) = (&bearings, &vee) {
        for b in bearings {
            if let LoadPlan::Main(m) = b.load
                && m > engine.throws.len()
            {
                faults.add(
                    &format!("bearings.{}.main_bearing", b.name),
                    format!("the last main bearing is {}", engine.throws.len()),
                );
            }
        }
    }
    let oil = oil(&mut file, faults);
    let film = faults.section(&mut file.film, "film").and_then(|f| film(f, faults));
    let orbit = faults.section(&mut file.orbit, "orbit").map(|o| orbit_options(o, faults));
    let points = points(&mut file, faults);
    let names: Vec<String> = bearings.iter().flatten().map(|b| b.name.clone()).collect();
    let parameters = parameters(&mut file, &names, &bearings, oil.as_ref().map(|o| o.1), faults);
    let constraints = constraints(&file, &names, faults);
    let gradient = gradient(&mut file, faults);
    let optimiser = optimiser(&mut file, faults);
    assumptions(&mut file, faults);
    if faults.any() {
        return None;
    }
    let (viscosity, inlet_temperature_k, film_rise_k) = oil?;
    let (engine, perturbation) = gradient?;
    let (optimiser, sharpness) = optimiser?;
    let mut study = Study {
        hash: String::new(),
        bearings: bearings?,
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

fn machine_of(
    file: &mut StudyFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> (Option<Cylinder>, Option<VeeEngine>) {
    let kinds: Vec<BearingKind> = file
        .bearings
        .value()
        .into_iter()
        .flat_map(|b| b.values())
        .filter_map(|b| b.value().and_then(|b| b.kind.value().copied()))
        .collect();
    let needs_vee = kinds.contains(&BearingKind::Main);
    if !needs_vee && !kinds.contains(&BearingKind::BigEnd) && file.machine.is_absent() {
        faults.unused(
            &file.cylinder_pressure,
            "cylinder_pressure",
            "no bearing takes its load from the machine",
        );
        return (None, None);
    }
    faults.need(&file.machine, "machine");
    faults.need(&file.cylinder_pressure, "cylinder_pressure");
    let (Given::Value(machine), Given::Value(pressure)) = (&mut file.machine, &mut file.cylinder_pressure)
    else {
        return (None, None);
    };
    let cylinder = machine::cylinder(machine, pressure, base, faults, fingerprint);
    let vee = if needs_vee || !machine.firing_order.is_absent() {
        machine::vee(machine, cylinder.as_ref(), faults)
    } else {
        None
    };
    (cylinder, vee)
}

fn bearings(
    file: &mut StudyFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<Vec<BearingPlan>> {
    faults.need(&file.bearings, "bearings")?;
    let Given::Value(map) = &mut file.bearings else { return None };
    if map.is_empty() {
        faults.add("bearings", "needs at least one bearing, like [bearings.big_end]");
    }
    let mut plans = Vec::new();
    let mut complete = true;
    for (name, given) in map.iter_mut() {
        let path = join("bearings", name);
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') || name == "oil" {
            faults.add(&path, "a bearing's name is made of letters, digits, '_' and '-', and is not 'oil'");
        }
        faults.get(given, &path);
        let plan = match given {
            Given::Value(bearing) => bearing_plan(name, bearing, &path, base, faults, fingerprint),
            _ => None,
        };
        complete &= plan.is_some();
        plans.extend(plan);
    }
    complete.then_some(plans)
}

fn bearing_plan(
    name: &str,
    b: &mut BearingFile,
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<BearingPlan> {
    faults.unknown::<BearingFile>(&b.unknown, path);
    let at = |key: &str| join(path, key);
    let mut positive = |given: &Given<Length>, key: &str| {
        let value = faults.need(given, &at(key)).map(|v| v.si());
        faults.range(value, &at(key), |v| v > 0.0, "above zero");
        value
    };
    let width = positive(&b.width, "width");
    let diameter = positive(&b.diameter, "diameter");
    let clearance = positive(&b.diametral_clearance, "diametral_clearance");
    if let (Some(d), Some(c)) = (diameter, clearance)
        && c > 0.02 * d
    {
        faults.add(&at("diametral_clearance"), "must be less than 2 % of the diameter");
    }
    let mass = faults.or(&mut b.journal_mass, &at("journal_mass"), zero("0 kg")).si();
    faults.range(Some(mass), &at("journal_mass"), |v| v >= 0.0, "at or above zero");
    let count = faults.or(&mut b.count, &at("count"), 1);
    faults.range(Some(f64::from(count)), &at("count"), |v| v >= 1.0, "at least 1");
    let kind = faults.need(&b.kind, &at("kind"))?;
    if kind != BearingKind::Main {
        faults.unused(&b.main_bearing, &at("main_bearing"), "the bearing is no main bearing");
    }
    if kind != BearingKind::Table {
        faults.unused(&b.load, &at("load"), "kind is not \"table\"");
        faults.unused(&b.cycle, &at("cycle"), "kind is not \"table\"");
    }
    let load = match kind {
        BearingKind::BigEnd => LoadPlan::BigEnd,
        BearingKind::Main => LoadPlan::Main(faults.need(&b.main_bearing, &at("main_bearing"))?),
        BearingKind::Table => {
            let cycle = faults.or(&mut b.cycle, &at("cycle"), zero("720 deg")).si();
            faults.range(Some(cycle), &at("cycle"), |v| v > 0.0, "above zero");
            faults.need(&b.load, &at("load"));
            let Given::Value(table) = &mut b.load else { return None };
            LoadPlan::Table(load_table(table, cycle, &at("load"), base, faults, fingerprint)?)
        }
    };
    Some(BearingPlan {
        name: name.to_owned(),
        width_m: width?,
        diameter_m: diameter?,
        diametral_clearance_m: clearance?,
        journal_mass_kg: mass,
        count,
        load,
    })
}

fn load_table(
    file: &mut TableFile,
    cycle: f64,
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<LoadTable> {
    let table = file.load(base, path, faults)?;
    fingerprint.push_str(&table.fingerprint());
    let x: &[(&str, f64)] = &[("force_x_n", 1.0), ("force_x_kn", 1e3)];
    let y: &[(&str, f64)] = &[("force_y_n", 1.0), ("force_y_kn", 1e3)];
    let curves = periodic(&table, cycle, &[x, y]).and_then(|(angles, mut columns)| {
        let y = columns.remove(1);
        let spline = |v| PeriodicSpline::new(angles.clone(), v, cycle).map_err(|e| e.to_string());
        Ok(LoadTable { x: spline(columns.remove(0))?, y: spline(y)? })
    });
    curves.map_err(|e| faults.add(path, e)).ok()
}

fn oil(file: &mut StudyFile, faults: &mut Faults) -> Option<(Viscosity, f64, f64)> {
    faults.need(&file.oil, "oil");
    let Given::Value(oil) = &mut file.oil else { return None };
    faults.unknown::<OilFile>(&oil.unknown, "oil");
    let inlet = faults.need(&oil.inlet_temperature, "oil.inlet_temperature").map(|v| v.si());
    faults.range(
        inlet,
        "oil.inlet_temperature",
        |v| (223.15..=473.15).contains(&v),
        "between -50 degC and 200 degC",
    );
    let rise = faults.or(&mut oil.film_temperature_rise, "oil.film_temperature_rise", zero("0 K")).si();
    faults.range(
        Some(rise),
        "oil.film_temperature_rise",
        |v| (0.0..=150.0).contains(&v),
        "between 0 K and 150 K",
    );
    let viscosity = if let Some(eta) = faults.get(&oil.dynamic_viscosity, "oil.dynamic_viscosity") {
        let why = "dynamic_viscosity is given";
        faults.unused(&oil.kinematic_viscosity_40c, "oil.kinematic_viscosity_40c", why);
        faults.unused(&oil.kinematic_viscosity_100c, "oil.kinematic_viscosity_100c", why);
        faults.unused(&oil.density_15c, "oil.density_15c", why);
        faults.range(Some(eta.si()), "oil.dynamic_viscosity", |v| v > 0.0, "above zero");
        Some(Viscosity::Constant { viscosity_pa_s: eta.si() })
    } else {
        let nu_40 =
            faults.need(&oil.kinematic_viscosity_40c, "oil.kinematic_viscosity_40c").map(|v| v.si() * 1e6);
        let nu_100 =
            faults.need(&oil.kinematic_viscosity_100c, "oil.kinematic_viscosity_100c").map(|v| v.si() * 1e6);
        let density = faults.need(&oil.density_15c, "oil.density_15c").map(|v| v.si());
        faults.range(
            density,
            "oil.density_15c",
            |v| (500.0..=2000.0).contains(&v),
            "between 500 and 2000 kg/m3",
        );
        let law = Viscosity::from_data_sheet(nu_40?, nu_100?, density?);
        law.map_err(|e| faults.add("oil.kinematic_viscosity_40c", e.to_string())).ok()
    };
    Some((viscosity?, inlet?, rise))
}

fn film(f: &mut FilmFile, faults: &mut Faults) -> Option<FilmPlan> {
    faults.unknown::<FilmFile>(&f.unknown, "film");
    let model = faults.or(&mut f.model, "film.model", FilmModelName::Reynolds);
    if model == FilmModelName::Mobility {
        let why = "film.model is \"mobility\"";
        faults.unused(&f.cavitation, "film.cavitation", why);
        faults.unused(&f.cells_around, "film.cells_around", why);
        faults.unused(&f.cells_across_half, "film.cells_across_half", why);
        faults.unused(&f.side_pressure, "film.side_pressure", why);
        faults.unused(&f.cavitation_pressure, "film.cavitation_pressure", why);
        return Some(FilmPlan {
            model,
            cavitation: CavitationName::SwiftStieber,
            cells_around: 0,
            cells_across_half: 0,
            side_pressure_pa: 0.0,
            cavitation_pressure_pa: 0.0,
        });
    }
    let cavitation = faults.or(&mut f.cavitation, "film.cavitation", CavitationName::SwiftStieber);
    let around = faults.or(&mut f.cells_around, "film.cells_around", 72);
    let across = faults.or(&mut f.cells_across_half, "film.cells_across_half", 8);
    let side = faults.or(&mut f.side_pressure, "film.side_pressure", zero("0 bar")).si();
    let cavity = faults.or(&mut f.cavitation_pressure, "film.cavitation_pressure", zero("0 bar")).si();
    faults.range(
        Some(around as f64),
        "film.cells_around",
        |v| (16.0..=2000.0).contains(&v),
        "between 16 and 2000",
    );
    faults.range(
        Some(across as f64),
        "film.cells_across_half",
        |v| (1.0..=200.0).contains(&v),
        "between 1 and 200",
    );
    faults.range(Some(cavity), "film.cavitation_pressure", |v| v <= side, "at or below the side pressure");
    Some(FilmPlan {
        model,
        cavitation,
        cells_around: around,
        cells_across_half: across,
        side_pressure_pa: side,
        cavitation_pressure_pa: cavity,
    })
}

fn orbit_options(o: &mut OrbitFile, faults: &mut Faults) -> OrbitOptions {
    faults.unknown::<OrbitFile>(&o.unknown, "orbit");
    let steps = faults.or(&mut o.steps_per_cycle, "orbit.steps_per_cycle", 720);
    let scheme = faults.or(&mut o.scheme, "orbit.scheme", SchemeName::Bdf2);
    let tolerance = faults.or(&mut o.periodicity_tolerance, "orbit.periodicity_tolerance", 1e-12);
    let cycles = faults.or(&mut o.max_cycles, "orbit.max_cycles", 30);
    faults.range(
        Some(steps as f64),
        "orbit.steps_per_cycle",
        |v| (36.0..=100_000.0).contains(&v),
        "between 36 and 100000",
    );
    faults.range(
        Some(tolerance),
        "orbit.periodicity_tolerance",
        |v| (1e-14..=1e-2).contains(&v),
        "between 1e-14 and 1e-2",
    );
    faults.range(
        Some(cycles as f64),
        "orbit.max_cycles",
        |v| (2.0..=10_000.0).contains(&v),
        "between 2 and 10000",
    );
    let scheme = match scheme {
        SchemeName::Bdf1 => Scheme::Bdf1,
        SchemeName::Bdf2 => Scheme::Bdf2,
    };
    OrbitOptions { steps, scheme, periodicity_tolerance: tolerance, max_cycles: cycles }
}

fn points(file: &mut StudyFile, faults: &mut Faults) -> Option<Vec<OperatingPoint>> {
    faults.need(&file.objective, "objective");
    let Given::Value(objective) = &mut file.objective else { return None };
    faults.unknown::<ObjectiveFile>(&objective.unknown, "objective");
    let path = "objective.operating_points";
    faults.need(&objective.operating_points, path);
    let Given::Value(list) = &mut objective.operating_points else { return None };
    if list.is_empty() {
        faults.add(path, "needs at least one operating point");
    }
    let mut points = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{path}[{i}]");
        faults.get(given, &path);
        let Given::Value(p) = given else { continue };
        faults.unknown::<OperatingPointFile>(&p.unknown, &path);
        let at = |key: &str| join(&path, key);
        let name = faults.need(&p.name, &at("name"));
        let speed = faults.need(&p.speed, &at("speed")).map(|v| v.si());
        let weight = faults.or(&mut p.weight, &at("weight"), 1.0);
        let load_factor = faults.or(&mut p.load_factor, &at("load_factor"), 1.0);
        faults.range(speed, &at("speed"), |v| v > 0.0, "above zero");
        faults.range(Some(weight), &at("weight"), |v| v > 0.0, "above zero");
        faults.range(Some(load_factor), &at("load_factor"), |v| v > 0.0, "above zero");
        if let (Some(name), Some(speed_rad_s)) = (name, speed) {
            if points.iter().any(|p: &OperatingPoint| p.name == name) {
                faults.add(&at("name"), format!("the name \"{name}\" stands twice"));
            }
            points.push(OperatingPoint { name, speed_rad_s, weight, load_factor });
        }
    }
    let sum: f64 = points.iter().map(|p| p.weight).sum();
    points.iter_mut().for_each(|p| p.weight /= sum);
    Some(points)
}

fn parameters(
    file: &mut StudyFile,
    names: &[String],
    bearings: &Option<Vec<BearingPlan>>,
    inlet_k: Option<f64>,
    faults: &mut Faults,
) -> Option<Vec<ParameterPlan>> {
    faults.need(&file.parameters, "parameters");
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
        let known =
            bearings.as_ref().zip(Some(bearing)).and_then(|(all, b)| base_value(all, b, variable)).or(
                match bearing {
                    None => inlet_k,
                    Some(_) => None,
                },
            );
        let mut bound = |given: &Given<String>, key: &str, needed: bool| {
            let text = if needed { faults.need(given, &at(key)) } else { faults.get(given, &at(key)) }?;
            si(variable, &text).map_err(|e| faults.add(&at(key), format!("found \"{text}\": {e}"))).ok()
        };
        let (lower, upper) = (bound(&p.lower, "lower", true), bound(&p.upper, "upper", true));
        let start = bound(&p.start, "start", false);
        if p.start.is_absent()
            && let Some(value) = known
        {
            p.start = Given::Value(format!("{} {}", rounded(variable.shown(value)), variable.unit));
        }
        let (Some(lower), Some(upper), Some(start)) = (lower, upper, start.or(known)) else { continue };
        faults.range(Some(lower), &at("lower"), |v| v > 0.0, "above zero");
        if lower >= upper {
            faults.add(&at("upper"), "must be larger than lower");
        } else if !(lower..=upper).contains(&start) {
            faults.add(&at("start"), "must lie between lower and upper");
        }
        plans.push(ParameterPlan { name, bearing, variable, lower, upper, start });
    }
    Some(plans)
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

fn base_value(bearings: &[BearingPlan], bearing: Option<usize>, variable: Variable) -> Option<f64> {
    let b = &bearings.get(bearing?)?;
    match variable.key {
        "width" => Some(b.width_m),
        "diameter" => Some(b.diameter_m),
        "diametral_clearance" => Some(b.diametral_clearance_m),
        _ => None,
    }
}

/// A number without the noise of unit conversion.
fn rounded(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

fn si(variable: Variable, text: &str) -> Result<f64, String> {
    match variable.unit {
        "degC" => text.parse::<Temperature>().map(|v| v.si()).map_err(|e| e.to_string()),
        _ => text.parse::<Length>().map(|v| v.si()).map_err(|e| e.to_string()),
    }
}

fn constraints(file: &StudyFile, names: &[String], faults: &mut Faults) -> Option<Vec<ConstraintPlan>> {
    let list = faults.get(&file.constraints, "constraints").unwrap_or_default();
    let mut plans = Vec::new();
    for (i, given) in list.iter().enumerate() {
        let path = format!("constraints[{i}]");
        let Some(c) = faults.get(given, &path) else { continue };
        faults.unknown::<ConstraintFile>(&c.unknown, &path);
        let at = |key: &str| join(&path, key);
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
        let Some(quantity) = faults.need(&c.quantity, &at("quantity")) else { continue };
        let (sense, key, text) = match (least, most) {
            (Some(text), None) => (Sense::AtLeast, "at_least", text),
            (None, Some(text)) => (Sense::AtMost, "at_most", text),
            _ => {
                faults.add(&path, "give either at_least or at_most");
                continue;
            }
        };
        let wrong_side = match quantity {
            QuantityName::MeanFrictionLoss => {
                Some("the mean friction loss is the objective and cannot be limited")
            }
            QuantityName::MinFilmThickness if sense == Sense::AtMost => {
                Some("a smallest film thickness needs at_least")
            }
            QuantityName::MaxFilmPressure | QuantityName::SpecificLoad if sense == Sense::AtLeast => {
                Some("a largest pressure needs at_most")
            }
            _ => None,
        };
        if let Some(words) = wrong_side {
            faults.add(&at(key), words);
        }
        match limit_si(quantity, &text) {
            Err(e) => faults.add(&at(key), format!("found \"{text}\": {e}")),
            Ok(limit) => {
                faults.range(Some(limit), &at(key), |v| v > 0.0, "above zero");
                plans.push(ConstraintPlan { quantity, bearing, sense, limit });
            }
        }
    }
    Some(plans)
}

fn limit_si(quantity: QuantityName, text: &str) -> Result<f64, String> {
    match quantity {
        QuantityName::MinFilmThickness => text.parse::<Length>().map(|v| v.si()).map_err(|e| e.to_string()),
        QuantityName::SideFlow => text.parse::<VolumeFlow>().map(|v| v.si()).map_err(|e| e.to_string()),
        _ => text.parse::<Pressure>().map(|v| v.si()).map_err(|e| e.to_string()),
    }
}

fn gradient(file: &mut StudyFile, faults: &mut Faults) -> Option<(EngineName, f64)> {
    let g = faults.section(&mut file.gradient, "gradient")?;
    faults.unknown::<GradientFile>(&g.unknown, "gradient");
    let engine = faults.or(&mut g.engine, "gradient.engine", EngineName::Adj);
    let perturbation = faults.or(&mut g.perturbation, "gradient.perturbation", 1e-6);
    faults.range(
        Some(perturbation),
        "gradient.perturbation",
        |v| v > 0.0 && v <= 0.1,
        "above 0 and at most 0.1",
    );
    Some((engine, perturbation))
}

fn optimiser(file: &mut StudyFile, faults: &mut Faults) -> Option<(SqpOptions, f64)> {
    let o = faults.section(&mut file.optimiser, "optimiser")?;
    faults.unknown::<OptimiserFile>(&o.unknown, "optimiser");
    let at = |key: &str| join("optimiser", key);
    faults.or(&mut o.method, &at("method"), MethodName::Sqp);
    let defaults = SqpOptions::default();
    let options = SqpOptions {
        tolerance: faults.or(&mut o.tolerance, &at("tolerance"), defaults.tolerance),
        max_iterations: faults.or(&mut o.max_iterations, &at("max_iterations"), defaults.max_iterations),
        step_limit: faults.or(&mut o.step_limit, &at("step_limit"), defaults.step_limit),
    };
    let sharpness = faults.or(&mut o.aggregate_sharpness, &at("aggregate_sharpness"), 200.0);
    faults.range(Some(options.tolerance), &at("tolerance"), |v| v > 0.0 && v < 1.0, "above 0 and below 1");
    faults.range(Some(options.max_iterations as f64), &at("max_iterations"), |v| v >= 1.0, "at least 1");
    faults.range(
        Some(options.step_limit),
        &at("step_limit"),
        |v| v > 0.0 && v <= 1.0,
        "above 0 and at most 1",
    );
    faults.range(
        Some(sharpness),
        &at("aggregate_sharpness"),
        |v| (10.0..=2000.0).contains(&v),
        "between 10 and 2000",
    );
    Some((options, sharpness))
}

/// Assumptions must belong to keys that exist.
fn assumptions(file: &mut StudyFile, faults: &mut Faults) {
    let Some(map) = faults.get(&file.assumptions, "assumptions") else { return };
    let values = without_nulls(serde_json::to_value(&*file).unwrap_or_default());
    for path in map.keys() {
        let pointer = format!("/{}", path.replace('.', "/"));
        if values.pointer(&pointer).is_none() {
            faults.add(&format!("assumptions.{path}"), format!("there is no key '{path}' in this study"));
        }
    }
}

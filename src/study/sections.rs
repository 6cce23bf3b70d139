//! Checks of the sections that stand for themselves: oil, film, orbit, objective, gradient, optimiser, assumptions.

use super::Given;
use super::faults::{Faults, join, without_nulls};
use super::file::{
    CavitationName, FilmFile, FilmModelName, GradientFile, MethodName, ObjectiveFile, OilFile,
    OperatingPointFile, OptimiserFile, OrbitFile, SchemeName, StudyFile,
};
use super::machine::zero;
use super::plans::{FilmPlan, OperatingPoint};
use crate::gradient::EngineName;
use crate::laws::Viscosity;
use crate::optimise::SqpOptions;
use crate::orbit::{OrbitOptions, Scheme};

pub(super) fn oil(file: &mut StudyFile, faults: &mut Faults) -> Option<(Viscosity, f64, f64)> {
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
    let viscosity = if !oil.dynamic_viscosity.is_absent() {
        let eta = faults.get(&oil.dynamic_viscosity, "oil.dynamic_viscosity");
        let why = "dynamic_viscosity is given";
        faults.unused(&oil.kinematic_viscosity_40c, "oil.kinematic_viscosity_40c", why);
        faults.unused(&oil.kinematic_viscosity_100c, "oil.kinematic_viscosity_100c", why);
        faults.unused(&oil.density_15c, "oil.density_15c", why);
        let eta = eta.map(|eta| eta.si());
        faults.range(eta, "oil.dynamic_viscosity", |v| v > 0.0, "above zero");
        eta.map(|viscosity_pa_s| Viscosity::Constant { viscosity_pa_s })
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

pub(super) fn film(f: &mut FilmFile, faults: &mut Faults) -> Option<FilmPlan> {
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

pub(super) fn orbit_options(o: &mut OrbitFile, faults: &mut Faults) -> OrbitOptions {
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

pub(super) fn points(file: &mut StudyFile, faults: &mut Faults) -> Option<Vec<OperatingPoint>> {
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
        faults.range(speed, &at("speed"), |v| v > 0.0 && v <= 2e4, "above zero and at most 190000 rpm");
        faults.range(Some(weight), &at("weight"), |v| v > 0.0 && v <= 1e6, "above zero and at most 1e6");
        faults.range(
            Some(load_factor),
            &at("load_factor"),
            |v| v > 0.0 && v <= 100.0,
            "above zero and at most 100",
        );
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

pub(super) fn gradient(file: &mut StudyFile, faults: &mut Faults) -> Option<(EngineName, f64)> {
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

pub(super) fn optimiser(file: &mut StudyFile, faults: &mut Faults) -> Option<(SqpOptions, f64)> {
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
    faults.range(
        Some(options.max_iterations as f64),
        &at("max_iterations"),
        |v| (1.0..=100_000.0).contains(&v),
        "between 1 and 100000",
    );
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
pub(super) fn assumptions(file: &mut StudyFile, faults: &mut Faults) {
    let Some(map) = faults.get(&file.assumptions, "assumptions") else { return };
    let values = without_nulls(serde_json::to_value(&*file).unwrap_or_default());
    for path in map.keys() {
        let pointer = format!("/{}", path.replace('.', "/"));
        if values.pointer(&pointer).is_none() && faults.raw(path).is_none() {
            faults.add(&format!("assumptions.{path}"), format!("there is no key '{path}' in this study"));
        }
    }
}

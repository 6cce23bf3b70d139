//! From a checked study to a design problem: one case per bearing and operating point, one constraint row per limit and case.

use super::check::Study;
use super::file::{CavitationName, CavityShearName, FilmModelName};
use super::plans::{BearingPlan, LoadPlan, OperatingPoint};
use super::robust::RobustPlan;
use super::vocabulary::QuantityName;
use crate::cranktrain::{
    BearingLoad, BearingOutput, BearingParameter, BearingSetup, Cylinder, HeatBalance, JournalBearing,
    LoadTable, MainLoad, VeeEngine,
};
use crate::dae::InvalidParameters;
use crate::film::{Axial, Cavitation, CavityShear, FilmModel, Mesh, Reynolds, ShortFilm};
use crate::gradient::{EngineName, engine};
use crate::math::PeriodicSpline;
use crate::optimise::{Case, DesignProblem, Evaluated, Limit};
use crate::run::{Event, RunContext};
use std::sync::Arc;

/// Which bearing and operating point a case is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CaseLabel {
    /// Index of the bearing.
    pub bearing: usize,
    /// Index of the operating point.
    pub point: usize,
}

/// Which constraint of the study a row belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LimitLabel {
    /// Index of the constraint.
    pub constraint: usize,
    /// Index of the case.
    pub case: usize,
}

/// A design problem with the meaning of its parts.
pub struct Plan<'r> {
    /// The problem.
    pub problem: DesignProblem<'r, JournalBearing>,
    /// Meaning of its cases.
    pub cases: Vec<CaseLabel>,
    /// Meaning of its constraint rows.
    pub limits: Vec<LimitLabel>,
    /// Quantities of each case, in the order of its gradient rows.
    pub quantities: Vec<Vec<QuantityName>>,
    /// Start design, SI units.
    pub start: Vec<f64>,
}

/// Builds the problem of a study.
pub fn plan<'r>(
    study: &Study,
    engine_name: EngineName,
    run: RunContext<'r>,
) -> Result<Plan<'r>, InvalidParameters> {
    let films: Vec<Arc<dyn FilmModel>> = (0..study.bearings.len()).map(|b| film(study, b)).collect();
    let (mut labels, mut cases, mut quantities) = (Vec::new(), Vec::new(), Vec::new());
    for point in 0..study.points.len() {
        for (bearing, film) in films.iter().enumerate() {
            let names = quantities_of(study, bearing);
            cases.push(case(study, bearing, point, &names, film.clone())?);
            labels.push(CaseLabel { bearing, point });
            quantities.push(names);
        }
    }
    let (mut limits, mut limit_labels) = (Vec::new(), Vec::new());
    for (constraint, c) in study.constraints.iter().enumerate() {
        let affected = labels.iter().enumerate().filter(|(_, l)| c.bearing.is_none_or(|b| b == l.bearing));
        for (case, _) in affected {
            let quantity = quantities[case].iter().position(|q| *q == c.quantity);
            let quantity = quantity.expect("quantities_of lists every constrained quantity");
            limits.push(Limit { case, quantity, sense: c.sense, limit: c.limit });
            limit_labels.push(LimitLabel { constraint, case });
        }
    }
    let bounds = (
        study.parameters.iter().map(|p| p.lower).collect(),
        study.parameters.iter().map(|p| p.upper).collect(),
    );
    let linear = study.linear.iter().map(|l| l.row(study.parameters.len())).collect();
    let beside = study.robust.as_ref().map_or_else(Vec::new, RobustPlan::values);
    let engine = engine(engine_name, study.perturbation);
    let problem = DesignProblem::new(cases, limits, bounds, engine, run)
        .with_linear(linear)
        .beside(beside)
        .watched(thinnest);
    let start = study.parameters.iter().map(|p| p.start).collect();
    Ok(Plan { problem, cases: labels, limits: limit_labels, quantities, start })
}

/// How thin the films of a design become.
fn thinnest(at: &Evaluated) -> Event {
    let gap = BearingOutput::GapMin.index();
    let all = at.orbits.iter().flat_map(|orbit| orbit.outputs.iter().map(|y| y[gap]));
    Event::Film { min_thickness_um: 1e6 * all.fold(f64::INFINITY, f64::min) }
}

/// The loss and whatever is limited for a bearing.
fn quantities_of(study: &Study, bearing: usize) -> Vec<QuantityName> {
    let limited = |q: &QuantityName| {
        study.constraints.iter().any(|c| c.quantity == *q && c.bearing.is_none_or(|b| b == bearing))
    };
    QuantityName::ALL.into_iter().filter(|q| *q == QuantityName::MeanFrictionLoss || limited(q)).collect()
}

/// The film of a bearing.
fn film(study: &Study, bearing: usize) -> Arc<dyn FilmModel> {
    match study.film.model {
        FilmModelName::Mobility => Arc::new(ShortFilm::new(study.sharpness)),
        FilmModelName::Reynolds => Arc::new(reynolds(study, bearing)),
    }
}

/// The film of a bearing whose journal stands along 0 deg, if wanted at the pressure of the surroundings along its widest gap.
pub(super) fn characteristic_film(
    study: &Study,
    bearing: usize,
    ambient_at_widest_gap: bool,
) -> Arc<dyn FilmModel> {
    match study.film.model {
        FilmModelName::Reynolds if ambient_at_widest_gap => {
            let film = reynolds(study, bearing);
            Arc::new(Reynolds { held_columns: vec![(film.mesh.n_phi / 2, 0.0)], ..film })
        }
        _ => film(study, bearing),
    }
}

/// A bearing at a speed of its own, nothing varied.
pub(super) fn still_setup(
    study: &Study,
    bearing: usize,
    speed_rad_s: f64,
) -> Result<BearingSetup, InvalidParameters> {
    let plan = &study.bearings[bearing];
    let load = Arc::new(load(study, &plan.load, 1.0)?);
    Ok(BearingSetup { speed_rad_s, ..setup(study, plan, film(study, bearing), load) })
}

/// Reynolds' equation on half of the width if the mid-plane is a mirror.
fn reynolds(study: &Study, bearing: usize) -> Reynolds {
    let (plan, bearing_plan) = (&study.film, &study.bearings[bearing]);
    let (across, axial) = match study.half_suffices(bearing) {
        true => (plan.cells_across_half, Axial::Half),
        false => (2 * plan.cells_across_half, Axial::Full),
    };
    Reynolds {
        cavitation: match plan.cavitation {
            CavitationName::MassConserving => Cavitation::MassConserving,
            CavitationName::SwiftStieber => Cavitation::SwiftStieber,
            CavitationName::Guembel => Cavitation::Guembel,
            CavitationName::None => Cavitation::None,
        },
        cavity_shear: match plan.cavity_shear {
            CavityShearName::Fill => CavityShear::Fill,
            CavityShearName::Full => CavityShear::Full,
        },
        side_pressure_pa: plan.side_pressure_pa,
        cavitation_pressure_pa: plan.cavitation_pressure_pa,
        feeds: bearing_plan.supply.as_ref().map_or_else(Vec::new, |s| s.feeds.clone()),
        oil: study.oil.laws.clone(),
        rough: bearing_plan.roughness.as_ref().map(|r| r.film.clone()),
        sharpness: study.sharpness,
        ..Reynolds::new(Mesh::new(plan.cells_around, across, axial))
    }
}

fn case(
    study: &Study,
    bearing: usize,
    point: usize,
    names: &[QuantityName],
    film: Arc<dyn FilmModel>,
) -> Result<Case<JournalBearing>, InvalidParameters> {
    let at = &study.points[point];
    let (model, variables) = bearing_with(study, bearing, at, Own::default(), film)?;
    Ok(Case {
        model,
        variables,
        quantities: names.iter().map(|q| q.of_cycle(study.sharpness).0).collect(),
        options: study.orbit,
        objective: vec![(0, at.weight * f64::from(study.bearings[bearing].count))],
        part: point,
    })
}

/// What a stage of a running-in programme has of its own.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Own {
    /// Which stage it is.
    pub stage: Option<usize>,
    /// Temperature of its oil, K.
    pub inlet_k: Option<f64>,
}

/// A bearing at an operating point or at a stage of a programme, and which variables its parameters are.
pub(super) fn bearing_at(
    study: &Study,
    bearing: usize,
    at: &OperatingPoint,
    own: Own,
) -> Result<(JournalBearing, Vec<usize>), InvalidParameters> {
    bearing_with(study, bearing, at, own, film(study, bearing))
}

fn bearing_with(
    study: &Study,
    bearing: usize,
    at: &OperatingPoint,
    own: Own,
    film: Arc<dyn FilmModel>,
) -> Result<(JournalBearing, Vec<usize>), InvalidParameters> {
    let plan = &study.bearings[bearing];
    let oil = |p: &super::ParameterPlan| p.variable.parameter == Some(BearingParameter::InletTemperature);
    let of_stage = |p: &super::ParameterPlan| p.stage.is_some() && p.stage == own.stage;
    let cooled = own.inlet_k.is_some() || study.variables().any(|p| of_stage(p) && oil(p));
    let common = |p: &super::ParameterPlan| {
        p.stage.is_none() && p.bearing.is_none_or(|b| b == bearing) && !(cooled && oil(p))
    };
    let all = study.variables().enumerate().filter(|(_, p)| common(p) || of_stage(p));
    let (variables, parameters): (Vec<usize>, Vec<BearingParameter>) =
        all.filter_map(|(j, p)| p.variable.parameter.map(|parameter| (j, parameter))).unzip();
    let of_factor = |factor: f64| load(study, &plan.load, factor).map(Arc::new);
    let varies = parameters.contains(&BearingParameter::LoadFactor);
    let (full, idle) = if varies { (1.0, Some(of_factor(0.0)?)) } else { (at.load_factor, None) };
    let mut setup = BearingSetup {
        speed_rad_s: at.speed_rad_s,
        parameters,
        idle,
        load_factor: at.load_factor,
        ..setup(study, plan, film, of_factor(full)?)
    };
    setup.inlet_temperature_k = own.inlet_k.unwrap_or(setup.inlet_temperature_k);
    Ok((JournalBearing::new(setup)?, variables))
}

/// A bearing as it stands in the study.
fn setup(
    study: &Study,
    plan: &BearingPlan,
    film: Arc<dyn FilmModel>,
    load: Arc<BearingLoad>,
) -> BearingSetup {
    let oil = &study.oil;
    BearingSetup {
        film_rise_k: oil.film_rise_k,
        heat: plan.heat.map(|h| HeatBalance {
            volumetric_heat_j_m3_k: oil.volumetric_heat_j_m3_k,
            film_share: h.film_share,
            conductance_w_k: h.conductance_w_k,
            ambient_k: h.ambient_k,
        }),
        journal_mass_kg: plan.journal_mass_kg,
        width_m: plan.width_m,
        diameter_m: plan.diameter_m,
        diametral_clearance_m: plan.diametral_clearance_m,
        inlet_temperature_k: oil.inlet_temperature_k,
        journal_roughness_m: plan.roughness.as_ref().map_or(0.0, |r| r.journal_m),
        shell_roughness_m: plan.roughness.as_ref().map_or(0.0, |r| r.shell_m),
        wear_m3_per_j: plan.roughness.as_ref().map_or(0.0, |r| r.wear_m3_per_j),
        supply_pressure_pa: plan.supply.as_ref().map_or(0.0, |s| s.pressure_pa),
        tilt: plan.tilt,
        shapes: plan.shapes.clone(),
        smoothing: study
            .running_in
            .as_ref()
            .and_then(|r| plan.roughness.as_ref().and_then(|rough| r.smoothing(rough.shell_m))),
        ..BearingSetup::plain(film, load, oil.viscosity)
    }
}

fn load(study: &Study, plan: &LoadPlan, factor: f64) -> Result<BearingLoad, InvalidParameters> {
    let missing = || InvalidParameters("the study has no machine".to_owned());
    let fired = |c: &Cylinder| Cylinder { pressure: Arc::new(c.pressure.scaled(factor)), ..c.clone() };
    match plan {
        LoadPlan::BigEnd => Ok(BearingLoad::BigEnd(fired(study.cylinder.as_ref().ok_or_else(missing)?))),
        LoadPlan::Main(main) => {
            let engine = study.vee.as_ref().ok_or_else(missing)?;
            let engine = VeeEngine { cylinder: fired(&engine.cylinder), ..engine.clone() };
            Ok(BearingLoad::Main(MainLoad { engine, main: *main }))
        }
        LoadPlan::Table(table) => {
            let scaled = |curve: &PeriodicSpline| curve.scaled(factor);
            Ok(BearingLoad::Table(LoadTable { x: scaled(&table.x), y: scaled(&table.y) }))
        }
    }
}

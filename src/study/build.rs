//! From a checked study to a design problem: one case per bearing and operating point, one constraint row per limit and case.

use super::check::Study;
use super::file::{CavitationName, FilmModelName};
use super::plans::LoadPlan;
use super::vocabulary::QuantityName;
use crate::cranktrain::{
    BearingLoad, BearingParameter, BearingSetup, Cylinder, JournalBearing, LoadTable, MainLoad, VeeEngine,
};
use crate::dae::InvalidParameters;
use crate::film::{Axial, Cavitation, FilmModel, Mesh, Reynolds, ShortFilm};
use crate::gradient::{EngineName, engine};
use crate::math::PeriodicSpline;
use crate::optimise::{Case, DesignProblem, Limit};
use crate::run::RunContext;
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
    let film = film(study);
    let (mut labels, mut cases, mut quantities) = (Vec::new(), Vec::new(), Vec::new());
    for point in 0..study.points.len() {
        for bearing in 0..study.bearings.len() {
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
    let problem = DesignProblem::new(cases, limits, bounds, engine(engine_name, study.perturbation), run);
    let start = study.parameters.iter().map(|p| p.start).collect();
    Ok(Plan { problem, cases: labels, limits: limit_labels, quantities, start })
}

/// The loss and whatever is limited for a bearing.
fn quantities_of(study: &Study, bearing: usize) -> Vec<QuantityName> {
    let limited = |q: &QuantityName| {
        study.constraints.iter().any(|c| c.quantity == *q && c.bearing.is_none_or(|b| b == bearing))
    };
    QuantityName::ALL.into_iter().filter(|q| *q == QuantityName::MeanFrictionLoss || limited(q)).collect()
}

fn film(study: &Study) -> Arc<dyn FilmModel> {
    let plan = &study.film;
    match plan.model {
        FilmModelName::Mobility => Arc::new(ShortFilm::new(study.sharpness)),
        FilmModelName::Reynolds => Arc::new(Reynolds {
            cavitation: match plan.cavitation {
                CavitationName::SwiftStieber => Cavitation::SwiftStieber,
                CavitationName::None => Cavitation::None,
            },
            side_pressure_pa: plan.side_pressure_pa,
            cavitation_pressure_pa: plan.cavitation_pressure_pa,
            sharpness: study.sharpness,
            // The journal stays aligned, so one half of the width tells all.
            ..Reynolds::new(Mesh::new(plan.cells_around, plan.cells_across_half, Axial::Half))
        }),
    }
}

fn case(
    study: &Study,
    bearing: usize,
    point: usize,
    names: &[QuantityName],
    film: Arc<dyn FilmModel>,
) -> Result<Case<JournalBearing>, InvalidParameters> {
    let (plan, at) = (&study.bearings[bearing], &study.points[point]);
    let mine = |p: &super::ParameterPlan| p.bearing.is_none_or(|b| b == bearing);
    let variables: Vec<usize> = (0..study.parameters.len()).filter(|&j| mine(&study.parameters[j])).collect();
    let setup = BearingSetup {
        film,
        load: Arc::new(load(study, &plan.load, at.load_factor)?),
        speed_rad_s: at.speed_rad_s,
        viscosity: study.viscosity,
        film_rise_k: study.film_rise_k,
        journal_mass_kg: plan.journal_mass_kg,
        width_m: plan.width_m,
        diameter_m: plan.diameter_m,
        diametral_clearance_m: plan.diametral_clearance_m,
        inlet_temperature_k: study.inlet_temperature_k,
        parameters: variables
            .iter()
            .map(|&j| study.parameters[j].variable.parameter)
            .collect::<Vec<BearingParameter>>(),
    };
    Ok(Case {
        model: JournalBearing::new(setup)?,
        variables,
        quantities: names.iter().map(|q| q.of_cycle(study.sharpness).0).collect(),
        options: study.orbit,
        objective: vec![(0, at.weight * f64::from(plan.count))],
    })
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

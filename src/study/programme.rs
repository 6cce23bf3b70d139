//! The bearings of a design at the stages of its running-in programme.

use super::build::{Own, Plan, bearing_at};
use super::check::Study;
use super::plans::OperatingPoint;
use super::running_in::{RunningInPlan, StagePlan};
use crate::cranktrain::{BearingParameter, JournalBearing};
use crate::dae::{Dae, InvalidParameters};
use crate::running_in::{MarchOptions, Stage};

/// The stages of a bearing at a design; their variables are those of the study.
pub(super) fn stages(
    study: &Study,
    wanted: &RunningInPlan,
    plan: &Plan,
    bearing: usize,
    x: &[f64],
) -> Result<Vec<Stage>, InvalidParameters> {
    let of = |(k, s): (usize, &StagePlan)| {
        let own = Own { stage: Some(k), inlet_k: s.inlet_k };
        let (model, variables) = bearing_of(study, plan, (bearing, x), &s.point, own)?;
        let lasts = |p: &super::ParameterPlan| p.stage == Some(k) && p.variable.parameter.is_none();
        let duration_variable = study.parameters.iter().position(lasts);
        Ok(Stage { model, duration_s: s.duration_s, variables, duration_variable })
    };
    programme(study, wanted, x).iter().enumerate().map(of).collect()
}

/// The programme with what of it is a design parameter.
pub(super) fn programme(study: &Study, wanted: &RunningInPlan, x: &[f64]) -> Vec<StagePlan> {
    let mut stages = wanted.stages.clone();
    for (p, &value) in study.parameters.iter().zip(x) {
        let Some(stage) = p.stage.and_then(|k| stages.get_mut(k)) else { continue };
        match p.variable.parameter {
            Some(BearingParameter::Speed) => stage.point.speed_rad_s = value,
            Some(BearingParameter::LoadFactor) => stage.point.load_factor = value,
            Some(_) => stage.inlet_k = Some(value),
            None => stage.duration_s = value,
        }
    }
    stages
}

/// A bearing of a design at an operating point, and which variables its parameters are.
pub(super) fn bearing_of(
    study: &Study,
    plan: &Plan,
    (bearing, x): (usize, &[f64]),
    point: &OperatingPoint,
    own: Own,
) -> Result<(JournalBearing, Vec<usize>), InvalidParameters> {
    let (model, variables) = bearing_at(study, bearing, point, own)?;
    let whole = plan.problem.whole(x);
    let p: Vec<f64> = variables.iter().map(|&j| whole[j]).collect();
    Ok((model.with_parameters(&p)?, variables))
}

/// How a bearing is marched through its programme.
pub(super) fn march_options(study: &Study, wanted: &RunningInPlan, bearing: usize) -> MarchOptions {
    let rough = study.bearings[bearing].roughness.as_ref();
    MarchOptions {
        wear_m3_per_n_m: rough.map_or(0.0, |r| r.wear_m3_per_j * r.film.boundary_friction),
        journal_share: wanted.journal_share,
        tolerance_m: wanted.tolerance_m,
        max_blocks: wanted.max_blocks,
        settled: wanted.settled,
        orbit: study.orbit,
        memory_bytes: study.orbit.memory_bytes,
    }
}

//! Running-in: checks of the programme, and the bearings at its stages.

use super::Given;
use super::bearings::Bearings;
use super::build::{Plan, bearing_at};
use super::check::Study;
use super::faults::{Faults, join};
use super::file::{FilmModelName, RunningInFile, RunningInGoalName, StageFile, StudyFile};
use super::plans::{FilmPlan, OperatingPoint};
use super::sections::worst_case;
use crate::cranktrain::JournalBearing;
use crate::dae::{Dae, InvalidParameters};
use crate::gradient::EngineName;
use crate::running_in::{MarchOptions, RunningInQuantity, Stage};

const PATH: &str = "running_in";

/// A checked programme.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RunningInPlan {
    pub stages: Vec<StagePlan>,
    /// Error of the depth that a block may have, m.
    pub tolerance_m: f64,
    journal_share: f64,
    max_blocks: usize,
    /// What a running-in design minimises; none if the design is searched without regard to wear.
    pub minimise: Option<RunningInQuantity>,
    /// Largest wear depth of any shell, m.
    pub max_depth_m: Option<f64>,
    /// Largest worn volume of any bearing, m3.
    pub max_volume_m3: Option<f64>,
}

/// A checked stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StagePlan {
    pub point: OperatingPoint,
    pub duration_s: f64,
    /// Temperature of the oil at the inlet, K; none for that of the study.
    inlet_k: Option<f64>,
}

/// The programme a study asks for, if any.
pub(super) fn running_in(
    file: &mut StudyFile,
    bearings: &Bearings,
    film: Option<&FilmPlan>,
    faults: &mut Faults,
) -> Option<RunningInPlan> {
    faults.get(&file.running_in, PATH);
    let polish = file.optimiser.value().and_then(|o| o.polish.value()) == Some(&true);
    let engine = file.gradient.value().and_then(|g| g.engine.value());
    let others = [
        (worst_case(file), "objective.aggregate = \"worst-case\""),
        (!file.robust.is_absent(), "[robust]"),
        (!file.pareto.is_absent(), "[pareto]"),
        (polish, "optimiser.polish"),
        (engine.is_some_and(|e| *e != EngineName::Adj), "a gradient engine other than ADJ"),
    ];
    let Given::Value(r) = &mut file.running_in else { return None };
    faults.unknown::<RunningInFile>(&r.unknown, PATH);
    let at = |key: &str| join(PATH, key);
    if film.is_some_and(|f| f.model == FilmModelName::Mobility) {
        faults.add(PATH, "needs the film model \"reynolds\": the short bearing knows no contact");
    }
    for (name, _) in bearings.iter().filter(|(_, b)| b.as_ref().is_some_and(|b| !b.has_contact())) {
        faults.add(PATH, format!("bearing \"{name}\" cannot touch: give it a roughness with a contact"));
    }
    let tolerance = "0.02 um".parse().expect("a valid length");
    let tolerance_m = faults.or(&mut r.wear_depth_tolerance, &at("wear_depth_tolerance"), tolerance).si();
    let journal_share = faults.or(&mut r.journal_share, &at("journal_share"), 0.0);
    let max_blocks = faults.or(&mut r.max_blocks, &at("max_blocks"), 500);
    let sensible = |v: f64| v > 0.0 && v <= 1e-4;
    faults.range(Some(tolerance_m), &at("wear_depth_tolerance"), sensible, "above zero and at most 100 um");
    faults.range(Some(journal_share), &at("journal_share"), |v| (0.0..=1.0).contains(&v), "between 0 and 1");
    let counted = |v: f64| (1.0..=1e5).contains(&v);
    faults.range(Some(max_blocks as f64), &at("max_blocks"), counted, "between 1 and 100000");
    let goal = faults.get(&r.minimise, &at("minimise"));
    let minimise = goal.map(|goal| match goal {
        RunningInGoalName::MeanLoss => RunningInQuantity::MeanLoss,
        RunningInGoalName::FinalLoss => RunningInQuantity::FinalLoss,
    });
    let max_depth_m = faults.get(&r.max_wear_depth, &at("max_wear_depth")).map(|v| v.si());
    let max_volume_m3 = faults.get(&r.max_wear_volume, &at("max_wear_volume")).map(|v| v.si());
    faults.range(max_depth_m, &at("max_wear_depth"), |v| v > 0.0, "above zero");
    faults.range(max_volume_m3, &at("max_wear_volume"), |v| v > 0.0, "above zero");
    if r.minimise.is_absent() {
        let why = "only a running-in design is searched within wear limits; give running_in.minimise";
        faults.unused(&r.max_wear_depth, &at("max_wear_depth"), why);
        faults.unused(&r.max_wear_volume, &at("max_wear_volume"), why);
    } else {
        for (_, key) in others.into_iter().filter(|(given, _)| *given) {
            faults.add(&at("minimise"), format!("does not go together with {key}; remove one of them"));
        }
    }
    faults.need(&r.stages, &at("stages"));
    let Given::Value(list) = &mut r.stages else { return None };
    if list.is_empty() {
        faults.add(&at("stages"), "needs at least one [[running_in.stages]]");
    }
    let mut stages = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{}[{i}]", at("stages"));
        faults.get(given, &path);
        let Given::Value(s) = given else { continue };
        stages.extend(stage(s, &path, faults));
    }
    Some(RunningInPlan {
        stages,
        tolerance_m,
        journal_share,
        max_blocks,
        minimise,
        max_depth_m,
        max_volume_m3,
    })
}

fn stage(s: &mut StageFile, path: &str, faults: &mut Faults) -> Option<StagePlan> {
    faults.unknown::<StageFile>(&s.unknown, path);
    let at = |key: &str| join(path, key);
    let name = faults.need(&s.name, &at("name"));
    let duration_s = faults.need(&s.duration, &at("duration")).map(|d| d.si());
    let speed_rad_s = faults.need(&s.speed, &at("speed")).map(|v| v.si());
    let load_factor = faults.or(&mut s.load_factor, &at("load_factor"), 1.0);
    let inlet_k = faults.get(&s.oil_inlet_temperature, &at("oil_inlet_temperature")).map(|t| t.si());
    faults.range(duration_s, &at("duration"), |v| v > 0.0 && v <= 1e9, "above zero and at most 1e9 s");
    faults.range(speed_rad_s, &at("speed"), |v| v > 0.0 && v <= 2e4, "above zero and at most 190000 rpm");
    let factor = |v: f64| v > 0.0 && v <= 100.0;
    faults.range(Some(load_factor), &at("load_factor"), factor, "above zero and at most 100");
    let liquid = |v: f64| (223.15..=473.15).contains(&v);
    faults.range(inlet_k, &at("oil_inlet_temperature"), liquid, "between -50 degC and 200 degC");
    let point = OperatingPoint { name: name?, speed_rad_s: speed_rad_s?, weight: 1.0, load_factor };
    Some(StagePlan { point, duration_s: duration_s?, inlet_k })
}

/// The stages of a bearing at a design, and which variables the parameters of each are.
pub(super) fn stages(
    study: &Study,
    wanted: &RunningInPlan,
    plan: &Plan,
    bearing: usize,
    x: &[f64],
) -> Result<(Vec<Stage>, Vec<Vec<usize>>), InvalidParameters> {
    let of = |s: &StagePlan| {
        let (model, variables) = bearing_of(study, plan, (bearing, x), &s.point, s.inlet_k)?;
        Ok((Stage { model, duration_s: s.duration_s }, variables))
    };
    wanted.stages.iter().map(of).collect()
}

/// A bearing of a design at an operating point, and which variables its parameters are.
pub(super) fn bearing_of(
    study: &Study,
    plan: &Plan,
    (bearing, x): (usize, &[f64]),
    point: &OperatingPoint,
    inlet_k: Option<f64>,
) -> Result<(JournalBearing, Vec<usize>), InvalidParameters> {
    let (model, variables) = bearing_at(study, bearing, point, inlet_k)?;
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
        orbit: study.orbit,
    }
}

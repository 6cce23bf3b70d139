//! Running-in of the design that was found: checks of the programme, and the march of each bearing through it.

use super::Given;
use super::bearings::Bearings;
use super::build::{Plan, bearing_at};
use super::check::Study;
use super::faults::{Faults, join};
use super::file::{AggregateName, FilmModelName, RunningInFile, RunningInGoalName, StageFile, StudyFile};
use super::limits::{ACTIVE, ACTIVE_GAP, MET};
use super::plans::{BearingPlan, FilmPlan, OperatingPoint};
use super::searches::Searched;
use crate::cranktrain::{BearingOutput, JournalBearing, SurfaceField};
use crate::dae::{Dae, InvalidParameters};
use crate::film::Axial;
use crate::gradient::EngineName;
use crate::optimise::Minimum;
use crate::report::{
    BearingRunningIn, BeforeAfter, CycleState, MinimisedReport, RunningInBlock, RunningInReport, StageReport,
    WearLimitReport,
};
use crate::run::{Event, RunContext};
use crate::running_in::{
    Block, March, MarchError, MarchOptions, Rate, RunningInQuantity, Stage, march, settled_with_wear,
};

const PATH: &str = "running_in";
/// Seconds of an hour.
const HOUR_S: f64 = 3600.0;

/// A checked programme.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RunningInPlan {
    stages: Vec<StagePlan>,
    tolerance_m: f64,
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
struct StagePlan {
    point: OperatingPoint,
    duration_s: f64,
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
    let worst = file.objective.value().and_then(|o| o.aggregate.value()) == Some(&AggregateName::WorstCase);
    let polish = file.optimiser.value().and_then(|o| o.polish.value()) == Some(&true);
    let engine = file.gradient.value().and_then(|g| g.engine.value());
    let others = [
        (worst, "objective.aggregate = \"worst-case\""),
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

/// Runs in every bearing of a design; none if the study does not ask for it.
pub(super) fn report(study: &Study, found: &Searched, context: RunContext<'_>) -> Option<RunningInReport> {
    let wanted = study.running_in.as_ref()?;
    let (plan, x) = (&found.plan, found.minimum.x.as_slice());
    let stage = |s: &StagePlan| StageReport {
        name: s.point.name.clone(),
        duration_h: s.duration_s / HOUR_S,
        speed_rpm: s.point.speed_rad_s * 30.0 / std::f64::consts::PI,
        load_factor: s.point.load_factor,
    };
    let bearings = (0..study.bearings.len()).map(|b| bearing(study, wanted, plan, b, x, context));
    Some(RunningInReport {
        stages: wanted.stages.iter().map(stage).collect(),
        wear_depth_tolerance_um: wanted.tolerance_m * 1e6,
        minimised: minimised(wanted, &found.minimum),
        limits: limits(study, wanted, found),
        bearings: bearings.collect(),
    })
}

/// What a running-in design minimised.
fn minimised(wanted: &RunningInPlan, end: &Minimum) -> Option<MinimisedReport> {
    let quantity = match wanted.minimise? {
        RunningInQuantity::FinalLoss => "friction loss in the end, all bearings",
        _ => "friction loss meant over the programme, all bearings",
    };
    let (start_w, optimum_w) = (end.history.first()?.objective_w, end.values.as_ref()?.objective);
    let (quantity, saving_percent) = (quantity.to_owned(), 100.0 * (1.0 - optimum_w / start_w));
    Some(MinimisedReport { quantity, start_w, optimum_w, saving_percent })
}

/// The limits on wear of a running-in design: behind those of the study, per bearing.
fn limits(study: &Study, wanted: &RunningInPlan, found: &Searched) -> Vec<WearLimitReport> {
    let Some(values) = found.minimum.values.as_ref().filter(|_| wanted.minimise.is_some()) else {
        return Vec::new();
    };
    let kinds = [
        ("max-wear-depth", wanted.max_depth_m, 1e6, "um"),
        ("wear-volume", wanted.max_volume_m3, 1e9, "mm3"),
    ];
    let asked =
        || kinds.iter().filter_map(|(name, limit, scale, unit)| Some((*name, (*limit)?, *scale, *unit)));
    let all = study.bearings.iter().flat_map(|b| asked().map(move |a| (b, a)));
    let row = |((b, (name, limit, scale, unit)), k): ((&BearingPlan, (&str, f64, f64, &str)), usize)| {
        let excess = *values.inequalities.get(k)?;
        let multiplier = found.minimum.multipliers.inequalities.get(k).copied().unwrap_or(0.0);
        let active = excess > -ACTIVE_GAP && multiplier > ACTIVE * values.objective.abs();
        Some(WearLimitReport {
            quantity: name.to_owned(),
            bearing: b.name.clone(),
            value: (1.0 + excess) * limit * scale,
            limit: limit * scale,
            unit: unit.to_owned(),
            active,
            met: excess <= study.optimiser.options.settings.tolerance.max(MET),
            price_w_per_unit: if active { multiplier / (limit * scale) } else { 0.0 },
        })
    };
    all.zip(found.plan.limits.len()..).filter_map(row).collect()
}

/// The stages of a bearing at a design, and which variables the parameters of each are.
pub(super) fn stages(
    study: &Study,
    wanted: &RunningInPlan,
    plan: &Plan,
    bearing: usize,
    x: &[f64],
) -> Result<(Vec<Stage>, Vec<Vec<usize>>), InvalidParameters> {
    let whole = plan.problem.whole(x);
    let of = |s: &StagePlan| {
        let (model, variables) = bearing_at(study, bearing, &s.point, s.inlet_k)?;
        let p: Vec<f64> = variables.iter().map(|&j| whole[j]).collect();
        Ok((Stage { model: model.with_parameters(&p)?, duration_s: s.duration_s }, variables))
    };
    wanted.stages.iter().map(of).collect()
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

fn bearing(
    study: &Study,
    wanted: &RunningInPlan,
    plan: &Plan,
    bearing: usize,
    x: &[f64],
    context: RunContext<'_>,
) -> BearingRunningIn {
    let own = &study.bearings[bearing];
    let mut found = BearingRunningIn { bearing: own.name.clone(), ..BearingRunningIn::default() };
    let options = march_options(study, wanted, bearing);
    let stages = match stages(study, wanted, plan, bearing, x) {
        Ok((stages, _)) => stages,
        Err(e) => return BearingRunningIn { failure: Some(e.to_string()), ..found },
    };
    let total_s: f64 = stages.iter().map(|s| s.duration_s).sum();
    let mut tell = |block: &Block| {
        let done = crate::report::short((1e3 * (block.from_s + block.length_s) / total_s).round() / 10.0);
        let name = format!("running in {}: {done} % of the programme", own.name);
        context.progress.tell(&Event::Stage { name });
    };
    match march(&stages, &options, None, context.cancel, &mut tell) {
        Ok(march) => {
            fill(&mut found, wanted, &stages, &march);
            found.operating_points = before_after(study, plan, (bearing, x), &march, context);
        }
        Err(MarchError::Orbit(e)) => {
            found.failure = Some(format!("a cycle with worn surfaces could not be simulated: {e}"));
        }
        Err(e) => found.failure = Some(e.to_string()),
    }
    found
}

/// The whole width of a field of cells, rows around.
fn whole_width(model: &JournalBearing, field: &[f64], scale: f64) -> Vec<Vec<f64>> {
    let scaled = field.iter().map(|v| scale * v);
    model.film().mesh().map_or_else(Vec::new, |mesh| mesh.map(scaled))
}

fn fill(found: &mut BearingRunningIn, wanted: &RunningInPlan, stages: &[Stage], march: &March) {
    let Some(Stage { model, .. }) = stages.last() else { return };
    let value = |of: RunningInQuantity| of.value(march, model);
    let (first, last) = march.losses();
    found.energy_lost_kj = value(RunningInQuantity::EnergyLost) * 1e-3;
    found.mean_loss_w = value(RunningInQuantity::MeanLoss);
    (found.first_loss_w, found.final_loss_w) = (first, last);
    found.wear_volume_mm3 = value(RunningInQuantity::WearVolume) * 1e9;
    let deepest = |field: &[f64]| field.iter().copied().fold(0.0, f64::max);
    found.max_wear_depth_um = deepest(&march.worn_m.shell) * 1e6;
    found.time_to_run_in_h = (first > last).then(|| value(RunningInQuantity::TimeToRunIn) / HOUR_S);
    found.wear_depth_um = whole_width(model, &march.worn_m.shell, 1e6);
    found.journal_wear_depth_um = whole_width(model, &march.worn_m.journal, 1e6);
    found.refused_blocks = march.refused;
    found.simulations = march.cost.simulations;
    let mesh = model.film().mesh();
    let copies = mesh.map_or(1.0, |m| if m.axial == Axial::Half { 2.0 } else { 1.0 });
    let setup = model.setup();
    let cells = mesh.map_or(1, crate::film::Mesh::cells) as f64;
    let area_m2 = std::f64::consts::PI * setup.diameter_m * setup.width_m / (cells * copies);
    let row = |stage: usize, time_s: f64, worn: &SurfaceField, rate: &Rate| {
        let state = state(rate);
        let sum: f64 = worn.shell.iter().chain(&worn.journal).sum();
        RunningInBlock {
            stage: wanted.stages[stage].point.name.clone(),
            time_h: time_s / HOUR_S,
            loss_w: state.loss_w,
            contact_loss_w: state.contact_loss_w,
            contact_share: rate.contact_share(),
            min_film_thickness_um: state.min_film_thickness_um,
            max_contact_pressure_mpa: state.max_contact_pressure_mpa,
            max_wear_depth_um: deepest(&worn.shell) * 1e6,
            wear_volume_mm3: sum * area_m2 * copies * 1e9,
        }
    };
    for (k, end) in march.ends.iter().enumerate() {
        let mine = march.blocks.iter().filter(|b| b.stage == k);
        found.blocks.extend(mine.map(|b| row(k, b.from_s, &b.worn_m, &b.rates[0])));
        found.blocks.push(row(k, end.0, &end.1, &end.2));
    }
    let share =
        |block: Option<&Block>| block.map_or(march.last.contact_share(), |b| b.rates[0].contact_share());
    found.first_contact_share = share(march.blocks.iter().find(|b| b.stage + 1 == stages.len()));
    found.final_contact_share = march.last.contact_share();
    found.count = march.blocks.len();
    found.width_mm = setup.width_m * 1e3;
}

fn state(rate: &Rate) -> CycleState {
    let all = |o: BearingOutput| rate.orbit.outputs.iter().map(move |y| y[o.index()]);
    CycleState {
        loss_w: rate.loss_w(),
        contact_loss_w: rate.mean(BearingOutput::ContactLoss),
        min_film_thickness_um: all(BearingOutput::GapMin).fold(f64::INFINITY, f64::min) * 1e6,
        max_contact_pressure_mpa: all(BearingOutput::ContactPeak).fold(0.0, f64::max) * 1e-6,
    }
}

/// The operating points of the objective with new and with run-in surfaces.
fn before_after(
    study: &Study,
    plan: &Plan,
    (bearing, x): (usize, &[f64]),
    march: &March,
    context: RunContext<'_>,
) -> Vec<BeforeAfter> {
    let whole = plan.problem.whole(x);
    let one = |point: &OperatingPoint| -> Option<BeforeAfter> {
        let (model, variables) = bearing_at(study, bearing, point, None).ok()?;
        let p: Vec<f64> = variables.iter().map(|&j| whole[j]).collect();
        let model = model.with_parameters(&p).ok()?;
        let settled = |worn: &SurfaceField, near| {
            settled_with_wear(&model, worn, &study.orbit, near, context.cancel).ok()
        };
        // Zeros instead of nothing, so that both are judged by the same cells.
        let blank = SurfaceField { shell: model.blank_field().shell, journal: Vec::new() };
        let new = settled(&blank, None)?;
        let run_in = settled(&march.worn_m, Some(&new.orbit));
        Some(BeforeAfter {
            operating_point: point.name.clone(),
            new: state(&new),
            run_in: run_in.as_ref().map(state),
        })
    };
    study.points.iter().filter_map(one).collect()
}

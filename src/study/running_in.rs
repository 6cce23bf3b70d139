//! Running-in: checks of the programme and of what a design for it is asked.

use super::Given;
use super::bearings::Bearings;
use super::constraints::{constraint, needs_wear};
use super::faults::{Faults, join};
use super::file::{
    AccelerationName, FilmModelName, ParameterFile, RunningInFile, RunningInGoalName, StageFile, StudyFile,
};
use super::lexicon::{FASTEST_RAD_S, LARGEST_FACTOR, LONGEST_S};
use super::plans::{ConstraintPlan, FilmPlan, OperatingPoint};
use super::sections::worst_case;
use super::vocabulary::QuantityName;
use crate::cranktrain::Smoothing;
use crate::optimise::{Sense, relative_excess};
use crate::running_in::{RunningInQuantity, Settled};

const PATH: &str = "running_in";
/// Seconds of an hour.
const HOUR_S: f64 = 3600.0;
/// Sharpness of the smooth maximum of the wear depth.
const SHARPNESS: f64 = 100.0;

/// A checked programme.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RunningInPlan {
    pub stages: Vec<StagePlan>,
    /// Error of the depth that a block may have, m.
    pub tolerance_m: f64,
    pub journal_share: f64,
    pub max_blocks: usize,
    /// Share of the shell's roughness that is left after long wear, and the depth that takes it there, m (none: its roughness).
    roughness_left: f64,
    smoothing_depth_m: Option<f64>,
    /// When a stage ends before its time.
    pub settled: Option<Settled>,
    /// Whether cycles are predicted where that is good enough.
    pub predicted: bool,
    /// What a running-in design minimises; none if the design is searched without regard to wear.
    pub minimise: Option<RunningInQuantity>,
    /// Whether its search begins with the cheap approximation of the march.
    pub approximate_first: bool,
    /// Limits of a running-in design.
    pub limits: Vec<WearLimit>,
}

/// A limit of a running-in design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WearLimit {
    pub quantity: RunningInQuantity,
    /// Bearing; `None` for all.
    pub bearing: Option<usize>,
    /// Allowed side.
    pub sense: Sense,
    /// SI.
    pub limit: f64,
    /// How reports speak of it.
    pub words: LimitWords,
}

/// How reports speak of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LimitWords {
    /// Of the march: name, unit, and how many of them one SI unit is.
    March(&'static str, &'static str, f64),
    /// Of the cycle in the end.
    InTheEnd(QuantityName),
}

impl LimitWords {
    /// Name in reports.
    pub fn name(self) -> String {
        match self {
            Self::March(name, ..) => name.to_owned(),
            Self::InTheEnd(quantity) => format!("{}-run-in", quantity.key()),
        }
    }

    /// Unit in reports.
    pub fn unit(self) -> &'static str {
        match self {
            Self::March(_, unit, _) => unit,
            Self::InTheEnd(quantity) => quantity.unit().0,
        }
    }

    /// How many of them one SI unit is.
    pub fn per_si(self) -> f64 {
        match self {
            Self::March(.., per_si) => per_si,
            Self::InTheEnd(quantity) => 1.0 / quantity.unit().1,
        }
    }

    /// A value in that unit.
    pub fn shown(self, si: f64) -> f64 {
        match self {
            Self::March(.., per_si) => per_si * si,
            Self::InTheEnd(quantity) => quantity.shown(si),
        }
    }
}

impl WearLimit {
    /// The constraint `c <= 0` at a value, and its derivative by it.
    pub fn constraint(&self, value: f64) -> (f64, f64) {
        relative_excess(self.sense, self.limit, value)
    }
}

/// A checked stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StagePlan {
    pub point: OperatingPoint,
    pub duration_s: f64,
    /// Temperature of the oil at the inlet, K; none for that of the study.
    pub inlet_k: Option<f64>,
}

/// The programme a study asks for, if any.
pub(super) fn running_in(
    file: &mut StudyFile,
    bearings: &Bearings,
    film: Option<&FilmPlan>,
    sharpness: f64,
    faults: &mut Faults,
) -> Option<RunningInPlan> {
    faults.get(&file.running_in, PATH);
    let others = others(file);
    let durations = file.parameters.value().is_some_and(|list| {
        let name = |p: &Given<ParameterFile>| p.value().and_then(|p| p.name.value()).cloned();
        list.iter().filter_map(name).any(|n| n.starts_with("running_in.") && n.ends_with(".duration"))
    });
    let Given::Value(r) = &mut file.running_in else { return None };
    faults.unknown::<RunningInFile>(&r.unknown, PATH);
    if film.is_some_and(|f| f.model == FilmModelName::Mobility) {
        faults.add(PATH, "needs the film model \"reynolds\": the short bearing knows no contact");
    }
    for (name, _) in bearings.iter().filter(|(_, b)| b.as_ref().is_some_and(|b| !b.has_contact())) {
        faults.add(PATH, format!("bearing \"{name}\" cannot touch: give it a roughness with a contact"));
    }
    needs_wear(PATH, bearings, None, faults);
    let mut plan = march_plan(r, faults);
    plan.limits = limits(r, faults);
    plan.limits.extend(in_the_end(r, bearings, sharpness, faults));
    let at = |key: &str| join(PATH, key);
    let goal = faults.get(&r.minimise, &at("minimise"));
    plan.minimise = goal.map(|goal| match goal {
        RunningInGoalName::MeanLoss => RunningInQuantity::MeanLoss,
        RunningInGoalName::EnergyLost => RunningInQuantity::EnergyLost,
        RunningInGoalName::FinalLoss => RunningInQuantity::final_loss(),
    });
    if r.minimise.is_absent() {
        let why = "only a running-in design is searched within limits on wear, and running_in.minimise would ask for one";
        let why_limits = "only a running-in design is searched within limits on the surfaces in the end, and running_in.minimise would ask for one";
        let why_first =
            "only the search of a running-in design can begin so, and running_in.minimise would ask for one";
        faults.unused(&r.max_wear_depth, &at("max_wear_depth"), why);
        faults.unused(&r.max_wear_volume, &at("max_wear_volume"), why);
        faults.unused(&r.max_energy_lost, &at("max_energy_lost"), why);
        faults.unused(&r.max_final_loss, &at("max_final_loss"), why);
        faults.unused(&r.max_time_to_run_in, &at("max_time_to_run_in"), why);
        faults.unused(&r.constraints, &at("constraints"), why_limits);
        faults.unused(&r.approximate_first, &at("approximate_first"), why_first);
    } else {
        plan.approximate_first = faults.or(&mut r.approximate_first, &at("approximate_first"), false);
        for key in others {
            faults.add(&at("minimise"), format!("does not go together with {key}; remove one of them"));
        }
    }
    if plan.settled.is_some() && durations {
        let words = "a stage that may end early has no duration to design; remove it or the parameter ending in .duration";
        faults.add(&at("settled_loss_change_per_hour"), words);
    }
    faults.need(&r.stages, &at("stages"));
    let Given::Value(list) = &mut r.stages else { return None };
    if list.is_empty() {
        faults.add(&at("stages"), "needs at least one [[running_in.stages]]");
    }
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{}[{i}]", at("stages"));
        faults.get(given, &path);
        let Given::Value(s) = given else { continue };
        let Some(found) = stage(s, &path, faults) else { continue };
        if plan.stages.iter().any(|other| other.point.name == found.point.name) {
            faults.add(&join(&path, "name"), format!("\"{}\" stands twice", found.point.name));
        }
        plan.stages.push(found);
    }
    Some(plan)
}

impl RunningInPlan {
    /// Limits of a bearing.
    pub fn limits_of(&self, bearing: usize) -> impl Iterator<Item = &WearLimit> + Clone {
        self.limits.iter().filter(move |l| l.bearing.is_none_or(|only| only == bearing))
    }

    /// What makes watts of the minimised quantity: for an energy the length of the programme as written, s.
    pub fn objective_scale(&self) -> f64 {
        match self.minimise {
            Some(RunningInQuantity::EnergyLost) => self.stages.iter().map(|s| s.duration_s).sum(),
            _ => 1.0,
        }
    }

    /// How wear smooths a shell.
    pub fn smoothing(&self, shell_m: f64) -> Option<Smoothing> {
        let depth_m = self.smoothing_depth_m.unwrap_or(shell_m);
        let smooths = self.roughness_left < 1.0 && depth_m > 0.0;
        smooths.then_some(Smoothing { left: self.roughness_left, depth_m })
    }
}

/// What cannot stand beside a search for a running-in design.
fn others(file: &StudyFile) -> Vec<&'static str> {
    let polish = file.optimiser.value().and_then(|o| o.polish.value()) == Some(&true);
    let all = [
        (worst_case(file), "objective.aggregate = \"worst-case\""),
        (!file.robust.is_absent(), "[robust]"),
        (!file.pareto.is_absent(), "[pareto]"),
        (polish, "optimiser.polish"),
    ];
    all.into_iter().filter(|(given, _)| *given).map(|(_, key)| key).collect()
}

/// How the programme is gone through.
fn march_plan(r: &mut RunningInFile, faults: &mut Faults) -> RunningInPlan {
    let at = |key: &str| join(PATH, key);
    let tolerance = "0.02 um".parse().expect("a valid length");
    let tolerance_m = faults.or(&mut r.wear_depth_tolerance, &at("wear_depth_tolerance"), tolerance).si();
    let journal_share = faults.or(&mut r.journal_share, &at("journal_share"), 0.0);
    let max_blocks = faults.or(&mut r.max_blocks, &at("max_blocks"), 500);
    let acceleration = faults.or(&mut r.acceleration, &at("acceleration"), AccelerationName::Pod);
    let sensible = |v: f64| v > 0.0 && v <= 1e-4;
    faults.range(Some(tolerance_m), &at("wear_depth_tolerance"), sensible, "above zero and at most 100 um");
    faults.range(Some(journal_share), &at("journal_share"), |v| (0.0..=1.0).contains(&v), "between 0 and 1");
    let counted = |v: f64| (1.0..=1e5).contains(&v);
    faults.range(Some(max_blocks as f64), &at("max_blocks"), counted, "between 1 and 100000");
    let loss_share = faults.get(&r.settled_loss_change_per_hour, &at("settled_loss_change_per_hour"));
    let depth_m = faults.get(&r.settled_wear_per_hour, &at("settled_wear_per_hour")).map(|v| v.si());
    faults.range(
        loss_share,
        &at("settled_loss_change_per_hour"),
        |v| v > 0.0 && v < 1.0,
        "above 0 and below 1: a share of the loss",
    );
    faults.range(depth_m, &at("settled_wear_per_hour"), sensible, "above zero and at most 100 um");
    let roughness_left = faults.or(&mut r.roughness_left, &at("roughness_left"), 1.0);
    let smoothing_depth_m = faults.get(&r.smoothing_depth, &at("smoothing_depth")).map(|v| v.si());
    let words = "above 0 and at most 1: a share of the roughness";
    faults.range(Some(roughness_left), &at("roughness_left"), |v| v > 0.0 && v <= 1.0, words);
    faults.range(smoothing_depth_m, &at("smoothing_depth"), sensible, "above zero and at most 100 um");
    if roughness_left == 1.0 {
        let why = "has no effect while running_in.roughness_left is 1";
        faults.unused(&r.smoothing_depth, &at("smoothing_depth"), why);
    }
    if r.settled_loss_change_per_hour.is_absent() != r.settled_wear_per_hour.is_absent() {
        let words = "a stage ends early when loss and surfaces change little: give both settled_loss_change_per_hour and settled_wear_per_hour";
        faults.add(PATH, words);
    }
    RunningInPlan {
        stages: Vec::new(),
        tolerance_m,
        journal_share,
        max_blocks,
        roughness_left,
        smoothing_depth_m,
        settled: loss_share.zip(depth_m).map(|(share, depth)| Settled {
            loss_share_per_s: share / HOUR_S,
            depth_m_per_s: depth / HOUR_S,
        }),
        predicted: acceleration == AccelerationName::Pod,
        minimise: None,
        approximate_first: false,
        limits: Vec::new(),
    }
}

/// The limits of a running-in design.
fn limits(r: &RunningInFile, faults: &mut Faults) -> Vec<WearLimit> {
    let at = |key: &str| join(PATH, key);
    let depth = faults.get(&r.max_wear_depth, &at("max_wear_depth")).map(|v| v.si());
    let volume = faults.get(&r.max_wear_volume, &at("max_wear_volume")).map(|v| v.si());
    let energy = faults.get(&r.max_energy_lost, &at("max_energy_lost")).map(|v| v.si());
    let loss = faults.get(&r.max_final_loss, &at("max_final_loss")).map(|v| v.si());
    let time = faults.get(&r.max_time_to_run_in, &at("max_time_to_run_in")).map(|v| v.si());
    let all = [
        ("max_wear_depth", depth, "max-wear-depth", RunningInQuantity::MaxDepth(SHARPNESS), "um", 1e6),
        ("max_wear_volume", volume, "wear-volume", RunningInQuantity::WearVolume, "mm3", 1e9),
        ("max_energy_lost", energy, "energy-lost", RunningInQuantity::EnergyLost, "kJ", 1e-3),
        ("max_final_loss", loss, "final-loss", RunningInQuantity::final_loss(), "W", 1.0),
        ("max_time_to_run_in", time, "time-to-run-in", RunningInQuantity::TimeToRunIn, "h", 1.0 / HOUR_S),
    ];
    let mut found = Vec::new();
    for (key, limit, name, quantity, unit, per_si) in all {
        faults.range(limit, &at(key), |v| v > 0.0, "above zero");
        let words = LimitWords::March(name, unit, per_si);
        let (bearing, sense) = (None, Sense::AtMost);
        found.extend(limit.map(|limit| WearLimit { quantity, bearing, sense, limit, words }));
    }
    found
}

/// Limits on the cycle of the last stage with the surfaces in the end.
fn in_the_end(
    r: &mut RunningInFile,
    bearings: &Bearings,
    sharpness: f64,
    faults: &mut Faults,
) -> Vec<WearLimit> {
    let list = faults.get(&r.constraints, &join(PATH, "constraints")).unwrap_or_default();
    let mut found = Vec::new();
    for (i, given) in list.iter().enumerate() {
        let path = format!("{}[{i}]", join(PATH, "constraints"));
        let given = faults.get(given, &path);
        let Some(plan) = given.and_then(|c| constraint(&c, &path, bearings, faults)) else { continue };
        let quantity = RunningInQuantity::Final(plan.quantity.of_cycle(sharpness).0);
        let ConstraintPlan { bearing, sense, limit, quantity: name } = plan;
        found.push(WearLimit { quantity, bearing, sense, limit, words: LimitWords::InTheEnd(name) });
    }
    found
}

fn stage(s: &mut StageFile, path: &str, faults: &mut Faults) -> Option<StagePlan> {
    faults.unknown::<StageFile>(&s.unknown, path);
    let at = |key: &str| join(path, key);
    let name = faults.need(&s.name, &at("name"));
    if name.as_ref().is_some_and(|n| n.trim().is_empty()) {
        faults.add(&at("name"), "must not be empty");
    }
    let duration_s = faults.need(&s.duration, &at("duration")).map(|d| d.si());
    let speed_rad_s = faults.need(&s.speed, &at("speed")).map(|v| v.si());
    let load_factor = faults.or(&mut s.load_factor, &at("load_factor"), 1.0);
    let inlet_k = faults.get(&s.oil_inlet_temperature, &at("oil_inlet_temperature")).map(|t| t.si());
    let within = |most: f64| move |v: f64| v > 0.0 && v <= most;
    faults.range(duration_s, &at("duration"), within(LONGEST_S), "above zero and at most 1e9 s");
    faults.range(speed_rad_s, &at("speed"), within(FASTEST_RAD_S), "above zero and at most 190000 rpm");
    let words = "above zero and at most 100";
    faults.range(Some(load_factor), &at("load_factor"), within(LARGEST_FACTOR), words);
    let liquid = |v: f64| (223.15..=473.15).contains(&v);
    faults.range(inlet_k, &at("oil_inlet_temperature"), liquid, "between -50 degC and 200 degC");
    let point = OperatingPoint { name: name?, speed_rad_s: speed_rad_s?, weight: 1.0, load_factor };
    Some(StagePlan { point, duration_s: duration_s?, inlet_k })
}

//! The design that was found, run in: the march of each bearing through the programme, and the report of it.

use super::build::{Own, Plan};
use super::check::Study;
use super::limits::{ACTIVE, ACTIVE_GAP, MET};
use super::plans::OperatingPoint;
use super::programme::{bearing_of, march_options, programme, stages};
use super::run_in_curves::{profile, stribeck};
use super::running_in::{RunningInPlan, StagePlan};
use super::searches::Searched;
use crate::cranktrain::{BearingOutput, JournalBearing, SurfaceField};
use crate::optimise::Outcome;
use crate::report::{
    BearingRunningIn, BeforeAfter, CycleState, MinimisedReport, RunningInBlock, RunningInGradientReport,
    RunningInReport, StageReport, WearLimitReport,
};
use crate::run::{Event, RunContext};
use crate::running_in::{
    Block, Course, MarchError, Rate, RunningInQuantity, Stage, falls, largest, march, march_predicted,
    new_surfaces, settled_with_wear, worn_volume_m3,
};
use crate::units::tidy;

/// Seconds of an hour.
const HOUR_S: f64 = 3600.0;
/// A loss that falls along a straight line has a time constant of half the stage; one that settles has at most this share of it.
const SETTLED: f64 = 1.0 / 3.0;

/// Runs in every bearing of a design; none if the study does not ask for it.
pub(super) fn report(study: &Study, found: &Searched, context: RunContext<'_>) -> Option<RunningInReport> {
    let wanted = study.running_in.as_ref()?;
    let (plan, x) = (&found.plan, found.minimum.x.as_slice());
    let stage = |s: &StagePlan| StageReport {
        name: s.point.name.clone(),
        duration_h: s.duration_s / HOUR_S,
        speed_rpm: tidy(s.point.speed_rad_s * 30.0 / std::f64::consts::PI),
        load_factor: s.point.load_factor,
        oil_inlet_temperature_c: s.inlet_k.map(|t| tidy(t - 273.15)),
    };
    let bearings = (0..study.bearings.len()).map(|b| bearing(study, wanted, plan, b, x, context));
    Some(RunningInReport {
        stages: programme(study, wanted, x).iter().map(stage).collect(),
        wear_depth_tolerance_um: wanted.tolerance_m * 1e6,
        minimised: minimised(wanted, found),
        gradient: gradient(study, found),
        approximation: found.run_in.as_ref().and_then(|end| end.approximation.clone()),
        limits: limits(study, wanted, found),
        bearings: bearings.collect(),
    })
}

/// The gradient of what was minimised, with its check.
fn gradient(study: &Study, found: &Searched) -> Option<RunningInGradientReport> {
    let proof = found.run_in.as_ref()?.proof.as_ref()?;
    let [along_w, difference_w] = proof.along_w;
    Some(RunningInGradientReport {
        engine: study.engine.as_str().to_owned(),
        parameters: study.parameters.iter().map(|p| p.name.clone()).collect(),
        effect_w_per_percent: proof.over_box_w.iter().map(|g| 0.01 * g).collect(),
        along_w,
        difference_w,
        apart: (along_w - difference_w).abs() / along_w.abs().max(f64::MIN_POSITIVE),
    })
}

/// What a running-in design minimised.
fn minimised(wanted: &RunningInPlan, found: &Searched) -> Option<MinimisedReport> {
    let (quantity, scale, unit) = match wanted.minimise? {
        RunningInQuantity::Final(_) => ("friction loss in the end, all bearings", 1.0, "W"),
        RunningInQuantity::EnergyLost => {
            ("energy lost over the programme, all bearings", 1e-3 * wanted.objective_scale(), "kJ")
        }
        _ => ("mean friction loss over the programme, all bearings", 1.0, "W"),
    };
    let end = found.run_in.as_ref()?;
    let (start, optimum) = (scale * end.start, scale * found.minimum.values.as_ref()?.objective);
    let rough = end.approximation.as_ref().is_some_and(|a| !a.final_leg);
    let quantity = if rough { format!("{quantity}, approximated") } else { quantity.to_owned() };
    let saving_percent = Some(100.0 * (1.0 - optimum / start));
    let start_violation = end.start_violation;
    Some(MinimisedReport { quantity, start, optimum, unit: unit.to_owned(), saving_percent, start_violation })
}

/// The limits on wear of a running-in design: behind those of the study, per bearing.
fn limits(study: &Study, wanted: &RunningInPlan, found: &Searched) -> Vec<WearLimitReport> {
    let Some(values) = found.minimum.values.as_ref().filter(|_| wanted.minimise.is_some()) else {
        return Vec::new();
    };
    let tolerance = study.optimiser.options.settings.tolerance.max(MET);
    let optimal = matches!(found.minimum.outcome, Outcome::Converged | Outcome::AlmostConverged);
    let mut rows = Vec::new();
    for (b, bearing) in study.bearings.iter().enumerate() {
        for of in wanted.limits_of(b) {
            let k = found.plan.limits.len() + rows.len();
            let (words, (_, slope)) = (of.words, of.constraint(0.0));
            let Some(excess) = values.inequalities.get(k) else { continue };
            let multiplier = found.minimum.multipliers.inequalities.get(k).copied().unwrap_or(0.0);
            let active = *excess > -ACTIVE_GAP && multiplier > ACTIVE * values.objective.abs();
            rows.push(WearLimitReport {
                quantity: words.name(),
                bearing: bearing.name.clone(),
                value: words.shown(of.limit + excess / slope),
                sense: super::limits::words(of.sense).to_owned(),
                limit: tidy(words.shown(of.limit)),
                unit: words.unit().to_owned(),
                active,
                met: *excess <= tolerance,
                price_w_per_unit: if active && optimal {
                    multiplier * slope.abs() / words.per_si()
                } else {
                    0.0
                },
            });
        }
    }
    rows
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
        Ok(stages) => stages,
        Err(e) => return BearingRunningIn { failure: Some(e.to_string()), ..found },
    };
    let total_s: f64 = stages.iter().map(|s| s.duration_s).sum();
    let mut tell = |at_s: f64| {
        let done = crate::report::short((1e3 * at_s / total_s).round() / 10.0);
        let name = format!("running in {}: {done} % of the programme", own.name);
        context.progress.tell(&Event::Stage { name });
    };
    let went = match wanted.predicted {
        true => march_predicted(&stages, &options, context.cancel, &mut tell).map(|march| {
            found.count = march.windows;
            found.predicted_cycles = Some(march.windows);
            found.largest_error_um = march.error_m * 1e6;
            march.course
        }),
        false => {
            let mut tell = |block: &Block| tell(block.from_s + block.length_s);
            march(&stages, &options, context.cancel, &mut tell).map(|march| {
                found.count = march.blocks.len();
                found.largest_error_um = march.blocks.iter().fold(0.0, |m, b| b.error_m.max(m)) * 1e6;
                march.course
            })
        }
    };
    match went {
        Ok(course) => {
            fill(&mut found, wanted, &stages, &course);
            if let Some(last) = stages.last() {
                found.profile = profile(&last.model, &course.worn_m);
                found.stribeck = stribeck(last, &course.worn_m, &options.orbit, context.cancel);
            }
            found.operating_points = before_after(study, plan, (bearing, x), &course, context);
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

fn fill(found: &mut BearingRunningIn, wanted: &RunningInPlan, stages: &[Stage], course: &Course) {
    let Some(Stage { model, .. }) = stages.last() else { return };
    let value = |of: RunningInQuantity| of.value(course, model);
    let (first, last) = course.losses();
    found.duration_h = course.duration_s / HOUR_S;
    found.energy_lost_kj = value(RunningInQuantity::EnergyLost) * 1e-3;
    found.mean_loss_w = value(RunningInQuantity::MeanLoss);
    (found.first_loss_w, found.final_loss_w) = (first, last);
    found.wear_volume_mm3 = value(RunningInQuantity::WearVolume) * 1e9;
    found.max_wear_depth_um = largest(&course.worn_m) * 1e6;
    let time_s = value(RunningInQuantity::TimeToRunIn);
    let settles = falls(first, last) && time_s <= SETTLED * course.last_duration_s;
    found.time_to_run_in_h = settles.then_some(time_s / HOUR_S);
    found.wear_depth_um = whole_width(model, &course.worn_m.shell, 1e6);
    found.journal_wear_depth_um = whole_width(model, &course.worn_m.journal, 1e6);
    found.refused_blocks = course.refused;
    found.simulations = course.cost.simulations;
    let row = |stage: usize, time_s: f64, worn: &SurfaceField, rate: &Rate| {
        let state = state(rate);
        RunningInBlock {
            stage: wanted.stages[stage].point.name.clone(),
            time_h: time_s / HOUR_S,
            loss_w: state.loss_w,
            contact_loss_w: state.contact_loss_w,
            contact_share: rate.contact_share(),
            min_film_thickness_um: state.min_film_thickness_um,
            max_film_pressure_mpa: state.max_film_pressure_mpa,
            max_contact_pressure_mpa: state.max_contact_pressure_mpa,
            max_wear_depth_um: largest(worn) * 1e6,
            wear_volume_mm3: worn_volume_m3(worn, model) * 1e9,
        }
    };
    for (k, end) in course.ends.iter().enumerate() {
        let mine = course.moments.iter().filter(|m| m.stage == k);
        found.blocks.extend(mine.map(|m| row(k, m.at_s, &m.worn_m, &m.rate)));
        found.blocks.push(row(k, end.at_s, &end.worn_m, &end.rate));
    }
    let begins = course.moments.iter().find(|m| m.stage + 1 == stages.len());
    found.first_contact_share = begins.map_or(&course.last, |m| &m.rate).contact_share();
    found.final_contact_share = course.last.contact_share();
    found.width_mm = model.setup().width_m * 1e3;
}

fn state(rate: &Rate) -> CycleState {
    let all = |o: BearingOutput| rate.orbit.outputs.iter().map(move |y| y[o.index()]);
    CycleState {
        loss_w: rate.loss_w(),
        contact_loss_w: rate.mean(BearingOutput::ContactLoss),
        min_film_thickness_um: all(BearingOutput::GapMin).fold(f64::INFINITY, f64::min) * 1e6,
        max_film_pressure_mpa: all(BearingOutput::PressurePeak).fold(0.0, f64::max) * 1e-6,
        max_contact_pressure_mpa: all(BearingOutput::ContactPeak).fold(0.0, f64::max) * 1e-6,
    }
}

/// The operating points of the objective with new and with run-in surfaces.
fn before_after(
    study: &Study,
    plan: &Plan,
    (bearing, x): (usize, &[f64]),
    course: &Course,
    context: RunContext<'_>,
) -> Vec<BeforeAfter> {
    let one = |point: &OperatingPoint| -> Option<BeforeAfter> {
        let (model, _) = bearing_of(study, plan, (bearing, x), point, Own::default()).ok()?;
        let settled = |worn: &SurfaceField, near| {
            settled_with_wear(&model, worn, &study.orbit, near, context.cancel).ok()
        };
        let new = settled(&new_surfaces(&model, false), None)?;
        let run_in = settled(&course.worn_m, Some(&new.orbit));
        Some(BeforeAfter {
            operating_point: point.name.clone(),
            new: state(&new),
            run_in: run_in.as_ref().map(state),
        })
    };
    study.points.iter().filter_map(one).collect()
}

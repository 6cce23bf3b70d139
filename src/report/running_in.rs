//! Running-in: how losses and surfaces change over a programme.

use super::csv_file::{maybe, number, written};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The design that was found, run in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunningInReport {
    /// The programme.
    pub stages: Vec<StageReport>,
    /// Error of the wear depth that a block may have, um.
    pub wear_depth_tolerance_um: f64,
    /// What was minimised, if the design is one for running-in.
    pub minimised: Option<MinimisedReport>,
    /// The gradient of what was minimised at the design found, and a check of it.
    pub gradient: Option<RunningInGradientReport>,
    /// The first leg of its search, with the approximation of the march, if there was one.
    pub approximation: Option<ApproximationReport>,
    /// Limits on wear and on the cycle in the end, if the design is one for running-in.
    pub limits: Vec<WearLimitReport>,
    /// One entry per bearing.
    pub bearings: Vec<BearingRunningIn>,
}

/// What a running-in design minimises.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MinimisedReport {
    /// In words.
    pub quantity: String,
    /// At the start design.
    pub start: f64,
    /// At the design found.
    pub optimum: f64,
    /// Unit of both.
    pub unit: String,
    /// Saving, per cent; none where the design breaks its limits.
    pub saving_percent: Option<f64>,
    /// Largest relative excess of the start design over any limit, if known: what it loses is no measure then.
    pub start_violation: Option<f64>,
}

/// The leg of a search with `P_alpha`: a weighted mean over a few moments of the march in place of the march itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ApproximationReport {
    /// Blocks of the march of all bearings.
    pub blocks: usize,
    /// Groups of blocks that the approximation steps over.
    pub groups: usize,
    /// Weight of each group of the first bearing: with the losses at its beginning and its end they make the mean.
    pub alpha: Vec<f64>,
    /// Error of the approximation against the march at the start design, per cent.
    pub start_error_percent: f64,
    /// The same at the design found; none if the search ended before.
    pub design_error_percent: Option<f64>,
    /// Accepted designs of this leg, the first entries of the history.
    pub iterations: u64,
    /// Cycles simulated for it.
    pub simulations: u64,
    /// Cycles simulated for the marches themselves.
    pub march_simulations: u64,
    /// Whether the search went on with the march itself.
    pub final_leg: bool,
}

/// A gradient through the march at the design found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunningInGradientReport {
    /// Engine.
    pub engine: String,
    /// Parameters.
    pub parameters: Vec<String>,
    /// What one per cent of the box of each does, W.
    pub effect_w_per_percent: Vec<f64>,
    /// Derivative along a direction that takes all parameters, W per box, by the engine.
    pub along_w: f64,
    /// The same by a central difference of two marches with the same blocks.
    pub difference_w: f64,
    /// How far the two are apart, relative.
    pub apart: f64,
}

/// A limit on wear, or on the cycle of the last stage with the surfaces in the end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WearLimitReport {
    /// "max-wear-depth" (a smooth maximum on the safe side), "wear-volume", "min-film-thickness-run-in", ...
    pub quantity: String,
    /// Bearing.
    pub bearing: String,
    /// Value the optimiser saw.
    pub value: f64,
    /// "at least" or "at most".
    pub sense: String,
    /// Limit.
    pub limit: f64,
    /// Unit of both.
    pub unit: String,
    /// Whether it holds the design back.
    pub active: bool,
    /// Whether it is kept.
    pub met: bool,
    /// What one unit more of room would save, W.
    pub price_w_per_unit: f64,
}

/// A stage of the programme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StageReport {
    /// Its name.
    pub name: String,
    /// How long it lasts, h.
    pub duration_h: f64,
    /// Speed of the crankshaft, rpm.
    pub speed_rpm: f64,
    /// Factor on the load.
    pub load_factor: f64,
    /// Temperature of the oil at the inlet, degC; none for that of the design.
    pub oil_inlet_temperature_c: Option<f64>,
}

/// Running-in of one bearing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct BearingRunningIn {
    /// The bearing.
    pub bearing: String,
    /// Why there is none, if it failed.
    pub failure: Option<String>,
    /// Mean friction loss at the beginning of the last stage, W.
    pub first_loss_w: f64,
    /// Mean friction loss in its end, W.
    pub final_loss_w: f64,
    /// Share of contact in the first of these losses.
    pub first_contact_share: f64,
    /// Share of contact in the last.
    pub final_contact_share: f64,
    /// Mean over the programme, W: the friction loss that takes wear into account.
    pub mean_loss_w: f64,
    /// How long the programme took, h: less than its stages if some had nothing more to tell.
    pub duration_h: f64,
    /// Energy lost to friction over the programme, kJ.
    pub energy_lost_kj: f64,
    /// Volume worn off, mm3.
    pub wear_volume_mm3: f64,
    /// Largest depth worn off shell or journal, um.
    pub max_wear_depth_um: f64,
    /// Time constant with which the loss falls in the last stage, h; none if it does not, or still does when the stage ends: a straight fall
    /// has half the length of the stage, one that settles at most a third.
    pub time_to_run_in_h: Option<f64>,
    /// The operating points of the objective with new and with run-in surfaces.
    pub operating_points: Vec<BeforeAfter>,
    /// The programme in blocks: what stood at the beginning of each, and at the end of each stage.
    pub blocks: Vec<RunningInBlock>,
    /// Blocks of the march, or windows if cycles were predicted.
    pub count: usize,
    /// Cycles that were predicted instead of solved; none if the march predicts none.
    pub predicted_cycles: Option<usize>,
    /// Largest error of the depth that a block or window was let pass with, um.
    pub largest_error_um: f64,
    /// Blocks that were tried and found too long.
    pub refused_blocks: usize,
    /// Cycles simulated.
    pub simulations: u64,
    /// Depth worn off the shell in the end, um: rows around from 0 deg, columns from edge to edge.
    pub wear_depth_um: Vec<Vec<f64>>,
    /// Depth worn off the journal, um, on a grid that turns with it; empty if the shell takes all wear.
    pub journal_wear_depth_um: Vec<Vec<f64>>,
    /// Width of the bearing, mm.
    pub width_mm: f64,
    /// The shell across its width where it has worn most.
    pub profile: Option<ProfileReport>,
    /// Stribeck curves with new and with run-in surfaces.
    pub stribeck: Vec<StribeckPoint>,
}

/// A profile across the width: what shapes and wear add to the gap.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct ProfileReport {
    /// Where around the shell, deg.
    pub angle_deg: f64,
    /// Positions from the middle, mm.
    pub axial_mm: Vec<f64>,
    /// New, um.
    pub new_um: Vec<f64>,
    /// Run in, um.
    pub run_in_um: Vec<f64>,
}

/// A point of two Stribeck curves: friction coefficients of the cycle, none where it could not be simulated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StribeckPoint {
    /// Speed of the crankshaft, rpm.
    pub speed_rpm: f64,
    /// With new surfaces.
    pub new: Option<f64>,
    /// With run-in surfaces.
    pub run_in: Option<f64>,
}

/// An operating point with new and with run-in surfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BeforeAfter {
    /// Its name.
    pub operating_point: String,
    /// New.
    pub new: CycleState,
    /// Run in; none if it could not be simulated.
    pub run_in: Option<CycleState>,
}

/// A cycle in four numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CycleState {
    /// Mean friction loss, W.
    pub loss_w: f64,
    /// Its contact part, W.
    pub contact_loss_w: f64,
    /// Smallest film thickness, um.
    pub min_film_thickness_um: f64,
    /// Largest film pressure, MPa.
    pub max_film_pressure_mpa: f64,
    /// Largest contact pressure, MPa.
    pub max_contact_pressure_mpa: f64,
}

/// A moment of a programme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunningInBlock {
    /// Stage.
    pub stage: String,
    /// Time since the beginning, h.
    pub time_h: f64,
    /// Mean friction loss of the cycle, W.
    pub loss_w: f64,
    /// Its contact part, W.
    pub contact_loss_w: f64,
    /// Share of contact in the loss.
    pub contact_share: f64,
    /// Smallest film thickness of the cycle, um.
    pub min_film_thickness_um: f64,
    /// Largest film pressure of the cycle, MPa.
    pub max_film_pressure_mpa: f64,
    /// Largest contact pressure of the cycle, MPa.
    pub max_contact_pressure_mpa: f64,
    /// Largest depth worn off either surface until then, um.
    pub max_wear_depth_um: f64,
    /// Volume worn off until then, mm3.
    pub wear_volume_mm3: f64,
}

/// The blocks as text.
pub fn running_in_csv(report: &RunningInReport) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "bearing",
        "stage",
        "time_h",
        "loss_w",
        "contact_loss_w",
        "contact_share",
        "min_film_thickness_um",
        "max_film_pressure_mpa",
        "max_contact_pressure_mpa",
        "max_wear_depth_um",
        "wear_volume_mm3",
    ])?;
    for b in &report.bearings {
        for m in &b.blocks {
            let numbers = [
                m.time_h,
                m.loss_w,
                m.contact_loss_w,
                m.contact_share,
                m.min_film_thickness_um,
                m.max_film_pressure_mpa,
                m.max_contact_pressure_mpa,
                m.max_wear_depth_um,
                m.wear_volume_mm3,
            ];
            let labels = [b.bearing.clone(), m.stage.clone()];
            writer.write_record(labels.into_iter().chain(numbers.map(number)))?;
        }
    }
    written(writer)
}

/// The worn surfaces as text.
pub fn wear_csv(report: &RunningInReport) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["bearing", "surface", "angle_deg", "axial_mm", "wear_depth_um"])?;
    for b in &report.bearings {
        for (surface, field) in [("shell", &b.wear_depth_um), ("journal", &b.journal_wear_depth_um)] {
            for (i, row) in field.iter().enumerate() {
                let angle = 360.0 * i as f64 / field.len() as f64;
                for (j, depth) in row.iter().enumerate() {
                    let axial = b.width_mm * ((j as f64 + 0.5) / row.len() as f64 - 0.5);
                    let numbers = [format!("{angle:.4}"), format!("{axial:.4}"), number(*depth)];
                    let labels = [b.bearing.clone(), surface.to_owned()];
                    writer.write_record(labels.into_iter().chain(numbers))?;
                }
            }
        }
    }
    written(writer)
}

/// The Stribeck curves as text.
pub fn stribeck_csv(report: &RunningInReport) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["bearing", "speed_rpm", "friction_new", "friction_run_in"])?;
    for b in &report.bearings {
        for p in &b.stribeck {
            writer.write_record([
                b.bearing.clone(),
                format!("{:.4}", p.speed_rpm),
                maybe(p.new),
                maybe(p.run_in),
            ])?;
        }
    }
    written(writer)
}

//! Content of `report.json`. Every number that has a unit names it in its key or stands beside it.

use super::{
    ChoicesReport, LinearReport, ParetoReport, RivalRun, RobustReport, RunningInReport, StartsReport,
    WorstCaseReport,
};
use crate::gradient::{EngineName, TaylorRow};
use crate::optimise::{Curvature, Outcome};
use crate::orbit::Recording;
use crate::run::{Cost, IterationEvent};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the report format.
pub const REPORT_FORMAT: &str = "stribeck-report/1";

/// Everything a run found out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// Version of this format, "stribeck-report/1".
    pub schema_version: String,
    /// SHA-256 of all that decides on the answer: the study with every default and its tables, without its words.
    pub study_hash: String,
    /// Title of the study.
    pub title: String,
    /// Question of the study.
    pub question: Option<String>,
    /// How it ended.
    pub outcome: OutcomeReport,
    /// The answer in sentences: what the design loses and saves, what holds it back, what is not met.
    pub answer: Vec<String>,
    /// The design found.
    pub design: Vec<DesignValue>,
    /// The objective before and after.
    pub objective: ObjectiveReport,
    /// Every limit, one entry per bearing and operating point.
    pub constraints: Vec<ConstraintReport>,
    /// Limits on sums of parameters.
    pub linear_constraints: Vec<LinearReport>,
    /// Optimality.
    pub kkt: KktReport,
    /// Cylinder pressure at the first operating point; none if no bearing takes its load from the machine.
    pub cylinder_pressure: Option<PressureReport>,
    /// Gradient at the design, with its proof.
    pub gradient: Option<GradientReport>,
    /// Working cycle at the design, one entry per bearing and operating point.
    pub orbit: Vec<OrbitReport>,
    /// Accepted designs.
    pub history: Vec<IterationEvent>,
    /// All searches, if several were made from different starts.
    pub starts: Option<StartsReport>,
    /// The same search by other methods and gradient engines, if the study asks for them; its own is the first.
    pub rivals: Vec<RivalRun>,
    /// The least loss over a limit on another quantity, if the study asks for it.
    pub pareto: Option<ParetoReport>,
    /// Margins for what scatters, if the study asks for them.
    pub robust: Option<RobustReport>,
    /// Running-in of the design, if the study asks for it.
    pub running_in: Option<RunningInReport>,
    /// What was chosen from lists, if the study has any.
    pub choices: Option<ChoicesReport>,
    /// Work done.
    pub cost: CostReport,
    /// Figures the study expects, held against what was found.
    pub expected: Vec<ExpectedReport>,
    /// What depends on the machine and differs between reruns. Nothing else does.
    pub timing: ReportTiming,
    /// What is assumed and why.
    pub assumptions: Vec<Assumption>,
    /// What this rests on.
    pub provenance: Provenance,
}

/// A figure that a study expects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ExpectedReport {
    /// Its path in this report.
    pub figure: String,
    /// What is expected there.
    pub expected: serde_json::Value,
    /// How far a number may be away, in its unit; none for words.
    pub tolerance: Option<f64>,
    /// What was found; null if there is nothing.
    pub found: serde_json::Value,
    /// Whether it is near enough.
    pub met: bool,
}

/// Wall times.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct ReportTiming {
    /// The whole study, s.
    pub seconds: f64,
    /// The searches by other methods in the order of `rivals`, s; absent without.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rivals_s: Vec<f64>,
}

/// End of the search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutcomeReport {
    /// Status.
    pub status: Outcome,
    /// What to do with it.
    pub advice: String,
    /// Reasons of refused simulations, if any.
    pub refused: Vec<String>,
}

/// Which bound a parameter stands at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AtBound {
    /// Strictly inside its box.
    No,
    /// At the lower bound.
    Lower,
    /// At the upper bound.
    Upper,
}

/// One design parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DesignValue {
    /// Name as in the study.
    pub name: String,
    /// Value found.
    pub value: f64,
    /// Unit of value, start and bounds.
    pub unit: String,
    /// Value at the start.
    pub start: f64,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Bound it stands at.
    pub at_bound: AtBound,
    /// Change from the start, as a share of the box.
    pub moved: f64,
    /// What one per cent of the box more would do to the loss, W; limits aside.
    pub effect_w_per_percent: Option<f64>,
    /// What one unit more of room at the bound it stands at would save, limits kept, W per unit.
    pub bound_price_w_per_unit: Option<f64>,
}

/// Loss at one design.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Loss {
    /// Mean friction loss: power of the wall shear stress and of touching asperities, W.
    pub total_w: f64,
    /// Its hydrodynamic part, W.
    pub hydrodynamic_w: f64,
    /// Its asperity contact part, W; zero for smooth surfaces.
    pub contact_w: f64,
    /// Power dissipated in oil and contact: friction loss and squeeze power together, W.
    pub dissipation_w: f64,
}

/// Objective before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObjectiveReport {
    /// What is minimised.
    pub quantity: String,
    /// At the start design; none if it could not be simulated.
    pub start: Option<Loss>,
    /// At the design found.
    pub optimum: Option<Loss>,
    /// Largest relative violation of a limit by the start design, margins included.
    pub start_violation: Option<f64>,
    /// Saving relative to the start, percent.
    pub saving_percent: Option<f64>,
    /// Bearings and operating points.
    pub operating_points: Vec<CaseLoss>,
    /// Operating points by what they decide; empty unless the worst case counts.
    pub worst_case: Vec<WorstCaseReport>,
}

/// Loss of one bearing at one operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CaseLoss {
    /// Operating point.
    pub operating_point: String,
    /// Bearing.
    pub bearing: String,
    /// Number of such bearings.
    pub count: u32,
    /// Share of the operating point.
    pub weight: f64,
    /// At the start design, one bearing.
    pub start: Option<Loss>,
    /// At the design found, one bearing.
    pub optimum: Option<Loss>,
}

/// One limit at one bearing and operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConstraintReport {
    /// Limited quantity.
    pub quantity: String,
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// "at least" or "at most".
    pub sense: String,
    /// Value the optimiser sees: smooth, on the safe side of the exact one.
    pub value: Option<f64>,
    /// Exact extremum on the mesh.
    pub exact_value: Option<f64>,
    /// Bias of the smooth value: smooth less exact, in the same unit; zero for means.
    pub bias: Option<f64>,
    /// Margin that is kept for what scatters, in the same unit; none without.
    pub margin: Option<f64>,
    /// Limit.
    pub limit: f64,
    /// Unit of values and limit.
    pub unit: String,
    /// Whether the limit holds the design back.
    pub active: bool,
    /// Whether the limit is kept, within the tolerance of the optimiser.
    pub met: bool,
    /// Loss in watts that one unit of relaxation would save; none where no optimum was reached.
    pub price_w_per_unit: Option<f64>,
}

/// Optimality of the design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct KktReport {
    /// Largest of stationarity, complementarity and violation, scaled; none without a simulated design.
    pub residual: Option<f64>,
    /// Wanted residual.
    pub tolerance: f64,
    /// Gradients, met within the tolerance of the design, whose combination the residual is of: 1 where the loss is smooth,
    /// more where the optimum lies on a kink.
    pub combined: u64,
    /// Newton steps of the polish that were kept; none without polish.
    pub polish_steps: Option<u64>,
    /// Curvature along the directions that the limits leave free; none where no optimum was reached. Watts per box squared.
    pub curvature: Option<Curvature>,
    /// What it says.
    pub verdict: Option<String>,
}

/// Derivatives of one quantity of one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GradientRow {
    /// Quantity.
    pub quantity: String,
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Parameters, in the order of the values.
    pub parameters: Vec<String>,
    /// Derivatives.
    pub values: Vec<f64>,
    /// Units of the derivatives.
    pub units: Vec<String>,
    /// Taylor-remainder test along all parameters together.
    pub check: Vec<TaylorRow>,
    /// What the test says.
    pub verdict: String,
}

/// Gradient with proof.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GradientReport {
    /// Engine.
    pub engine: EngineName,
    /// One row per quantity, bearing and operating point.
    pub rows: Vec<GradientRow>,
    /// Share of the orbit's memory left when the engine stopped sweeping.
    pub closure: f64,
    /// Sweeps over the cycle, the most of any bearing and operating point.
    pub sweeps: f64,
    /// Cells at which the film has a kink, over all steps.
    pub weakly_active_cells: usize,
    /// Where a micrometre of gap matters, one entry per bearing and operating point with a film of cells.
    pub gap_sensitivity: Vec<GapSensitivityReport>,
}

/// Derivative of the mean friction loss by the local gap, in short; the maps stand in `sensitivity.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GapSensitivityReport {
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Change of the loss if the gap widens everywhere, W/um.
    pub everywhere_w_per_um: f64,
    /// On the shell.
    pub shell: MapRange,
    /// On the journal, in a frame that turns with it.
    pub journal: MapRange,
}

/// Ends of a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapRange {
    /// Where a wider gap saves most.
    pub saves_most: MapExtremum,
    /// Where a wider gap costs most.
    pub costs_most: MapExtremum,
}

/// A place on a surface and the value of the map there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapExtremum {
    /// Change of the loss per gap and area, W/(um cm2).
    pub w_per_um_cm2: f64,
    /// Angle around the surface, degrees.
    pub angle_deg: f64,
    /// Axial position from the middle of the bearing, mm.
    pub axial_mm: f64,
}

/// An extreme value and where in the cycle it occurs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Extremum {
    /// Value, in the unit of its key.
    pub value: f64,
    /// Crank angle after firing top dead centre, degrees.
    pub crank_angle_deg: f64,
}

/// Cylinder pressure over the cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PressureReport {
    /// Indicated mean effective pressure, MPa.
    pub imep_mpa: f64,
    /// Largest pressure, absolute.
    pub peak_mpa: Extremum,
}

/// Working cycle of one bearing at one operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OrbitReport {
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Smallest film thickness.
    pub min_film_thickness_um: Extremum,
    /// Largest gap.
    pub max_gap_um: Extremum,
    /// Largest film pressure.
    pub max_film_pressure_mpa: Extremum,
    /// Largest specific load.
    pub max_specific_load_mpa: Extremum,
    /// Largest momentary friction loss.
    pub max_friction_loss_w: Extremum,
    /// Largest pressure of touching asperities; zero for smooth surfaces.
    pub max_contact_pressure_mpa: Extremum,
    /// Mean friction loss of touching asperities, W.
    pub mean_contact_loss_w: f64,
    /// Mean side flow, l/min.
    pub mean_side_flow_l_min: f64,
    /// Temperature of the film, degrees Celsius: given, or the result of the heat balance.
    pub film_temperature_c: f64,
    /// Dynamic viscosity of the film, mPa s.
    pub viscosity_mpa_s: f64,
    /// Steps per cycle.
    pub steps: usize,
    /// Cycles marched until settled.
    pub cycles: f64,
    /// Difference of the last two passes, relative to the clearance.
    pub periodicity: f64,
    /// Corrections by Newton's method on the period map while settling.
    pub corrections: usize,
    /// What is kept of the cycle for the backward sweep.
    pub recording: Recording,
    /// Memory it takes per step, bytes.
    pub bytes_per_step: usize,
}

/// Work done.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CostReport {
    /// Everything together.
    #[serde(flatten)]
    pub total: Cost,
    /// Part of it spent on gradients.
    pub gradients: Cost,
    /// Gradient calls.
    pub gradient_calls: u64,
}

/// Something that is not known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Assumption {
    /// Key of the study.
    pub key: String,
    /// Its value.
    pub value: String,
    /// Reason.
    pub reason: String,
}

/// What the report rests on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Program.
    pub program: String,
    /// Version.
    pub version: String,
    /// Laws and methods used, with their sources.
    pub methods: Vec<String>,
    /// Where they are published.
    pub references: Vec<String>,
    /// Whether the study's coarse setting was used.
    pub coarse: bool,
    /// Hash of the study in whose report the starts were found; none if they are the study's own.
    pub started_from: Option<String>,
    /// The study with every default written out.
    pub study: serde_json::Value,
}

/// One working cycle as curves, one value per step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curves {
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Crank angle after firing top dead centre, degrees.
    pub crank_angle_deg: Vec<f64>,
    /// Position of the journal over the radial clearance.
    pub eccentricity: Vec<[f64; 2]>,
    /// The same at the start design; empty if it could not be simulated or is the same.
    pub start_eccentricity: Vec<[f64; 2]>,
    /// Smallest film thickness, um.
    pub film_min_um: Vec<f64>,
    /// The same at the start design.
    pub start_film_min_um: Vec<f64>,
    /// Largest gap, um.
    pub gap_max_um: Vec<f64>,
    /// Largest film pressure, MPa.
    pub pressure_max_mpa: Vec<f64>,
    /// The same at the start design.
    pub start_pressure_max_mpa: Vec<f64>,
    /// Largest contact pressure, MPa.
    pub contact_max_mpa: Vec<f64>,
    /// Friction loss: power of the wall shear stress and of touching asperities, W.
    pub loss_w: Vec<f64>,
    /// Its asperity contact part, W.
    pub contact_loss_w: Vec<f64>,
    /// The same at the start design.
    pub start_loss_w: Vec<f64>,
    /// Power dissipated in oil and contact, W.
    pub dissipation_w: Vec<f64>,
    /// Side flow, l/min.
    pub side_flow_l_min: Vec<f64>,
    /// Load of the journal on the shell, kN.
    pub load_kn: Vec<[f64; 2]>,
    /// Film pressure (MPa) at the instant of its maximum: rows around, columns across.
    pub pressure_map_mpa: Vec<Vec<f64>>,
    /// Share of the gap filled with oil at the same instant; empty unless the film keeps account of its oil.
    pub fill_map: Vec<Vec<f64>>,
    /// What the shapes of shell and journal add to the gap at the start of the cycle, um: rows around, columns across; empty without shapes.
    pub shape_um: Vec<Vec<f64>>,
    /// Derivative of the mean loss by the local gap; none for a film without cells.
    pub sensitivity: Option<SensitivityMaps>,
    /// Width of the bearing, mm.
    pub width_mm: f64,
    /// Diameter of the bearing, mm.
    pub diameter_mm: f64,
}

/// Derivative of the mean friction loss by the local gap, W per um and cm2 of surface: rows around, columns from edge to
/// edge. Where it is negative, a wider gap saves.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityMaps {
    /// On the shell.
    pub shell_w_per_um_cm2: Vec<Vec<f64>>,
    /// On the journal, in a frame that turns with it.
    pub journal_w_per_um_cm2: Vec<Vec<f64>>,
}

/// Contact pressure below which pages do not speak of contact, MPa.
pub(super) const TOUCH_MPA: f64 = 1e-3;

impl Curves {
    /// Whether the surfaces touch anywhere in the cycle.
    pub fn touches(&self) -> bool {
        self.contact_max_mpa.iter().any(|p| *p > TOUCH_MPA)
    }
}

/// Report and curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// The report.
    pub report: Report,
    /// Cycles at the design found.
    pub curves: Vec<Curves>,
    /// Cylinder pressure at the first operating point, (degrees, MPa); empty without a machine.
    pub cylinder: Vec<(f64, f64)>,
}

//! Comparisons of the gradient engines: content of `report.json` of a study that compares, its CSV files and its page.
//!
//! Everything here is the same on every run but [`Timing`], which holds all that depends on the machine.

mod figures;
mod page;
mod tables;

pub use page::{comparison_files, comparison_html};
pub use tables::{comparison_csv, timing_csv};

use super::{Assumption, ExpectedReport, Provenance};
use crate::gradient::{EngineName, Finding, TaylorRow};
use crate::run::Cost;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the format.
pub const COMPARISON_FORMAT: &str = "stribeck-comparison/1";

/// How a comparison ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ComparisonStatus {
    /// Everything was computed.
    Complete,
    /// Something could not be computed; the reasons are listed.
    Incomplete,
    /// Stopped from outside.
    Cancelled,
}

/// A study that compares the gradient engines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Comparison {
    /// Version of this format, "stribeck-comparison/1".
    pub schema_version: String,
    /// SHA-256 of all that decides on the answer: the study with every default and its tables, without its words.
    pub study_hash: String,
    /// Title of the study.
    pub title: String,
    /// Question of the study.
    pub question: Option<String>,
    /// How it ended.
    pub status: ComparisonStatus,
    /// The answer in sentences.
    pub answer: Vec<String>,
    /// What could not be computed, and why.
    pub failures: Vec<String>,
    /// Engines compared.
    pub engines: Vec<EngineName>,
    /// Relative perturbation of the differences whose cost was measured.
    pub perturbation: f64,
    /// One entry per bearing and operating point.
    pub cases: Vec<ComparedCase>,
    /// Figures the study expects, held against what was found.
    pub expected: Vec<ExpectedReport>,
    /// What depends on the machine and differs between reruns: wall times. Nothing else does.
    pub timing: Timing,
    /// What is assumed and why.
    pub assumptions: Vec<Assumption>,
    /// What this rests on.
    pub provenance: Provenance,
}

/// The engines on one bearing at one operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedCase {
    /// The gradients and their proof.
    #[serde(flatten)]
    pub proof: ProvenCase,
    /// Work of the simulation at the point, from a cold start; costs are relative to it.
    pub simulation: Cost,
    /// Cost of each engine for each number of parameters.
    pub costs: Vec<EngineCost>,
    /// How many times cheaper ADJ and TRA are than CEN, by factorisations.
    pub speed_ups: Vec<SpeedUp>,
}

/// Gradients of one bearing at one operating point, with their proof.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProvenCase {
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Parameters, in the order of all lists of values.
    pub parameters: Vec<String>,
    /// Cells at which the film has a kink, over all steps; a derivative holds to one side there.
    pub weakly_active_cells: usize,
    /// Share of the orbit's memory left when ADJ and TRA stopped sweeping, the larger of both.
    pub closure: f64,
    /// Perturbations at which cycles failed, with the reason.
    pub failures: Vec<String>,
    /// Work of all the differences together.
    pub difference_cost: Cost,
    /// One entry per quantity.
    pub quantities: Vec<ProvenQuantity>,
}

/// Gradient of one quantity by all engines, with its proof.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProvenQuantity {
    /// Quantity.
    pub quantity: String,
    /// Its value at the point.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
    /// What the proof says.
    pub finding: Finding,
    /// The same in a sentence with its reason.
    pub verdict: String,
    /// Parameter that shows a kink or an error most.
    pub most_by: Option<String>,
    /// Largest difference of TRA and ADJ, relative to the largest elasticity of the row, like all errors here.
    pub mismatch: f64,
    /// Units of the derivatives.
    pub units: Vec<String>,
    /// Derivatives by ADJ.
    pub adj: Vec<f64>,
    /// Derivatives by TRA.
    pub tra: Vec<f64>,
    /// Derivatives by the differences, engine by engine and perturbation by perturbation.
    pub differences: Vec<DifferenceRow>,
    /// Smallest error of each engine and where it stands.
    pub best: Vec<BestError>,
    /// Taylor-remainder test along the direction.
    pub taylor_ahead: Vec<TaylorRow>,
    /// Taylor-remainder test against the direction.
    pub taylor_behind: Vec<TaylorRow>,
    /// One-sided slopes along the direction, found ahead and behind, over that of ADJ; other than 1 and 1 at a kink. None if
    /// that of ADJ is zero.
    pub slope_ratios: Option<[f64; 2]>,
}

/// Derivatives of one quantity by one engine at one perturbation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DifferenceRow {
    /// FW, BW or CEN.
    pub engine: EngineName,
    /// Relative perturbation.
    pub perturbation: f64,
    /// Error against ADJ.
    pub error: f64,
    /// Derivatives.
    pub values: Vec<f64>,
}

/// The perturbation at which an engine comes closest to ADJ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BestError {
    /// FW, BW or CEN.
    pub engine: EngineName,
    /// Relative perturbation.
    pub perturbation: f64,
    /// Error against ADJ.
    pub error: f64,
}

/// What the gradient of all quantities by the first parameters costs with one engine.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EngineCost {
    /// Engine.
    pub engine: EngineName,
    /// Number of parameters.
    pub parameters: usize,
    /// Sweeps over the cycle (settled cycles for the differences).
    pub sweeps: f64,
    /// Work done.
    pub cost: Cost,
    /// Newton iterations over those of the simulation; each factorises once. 0 for TRA and ADJ.
    pub newton_iterations_ratio: f64,
    /// Factorisations over those of the simulation.
    pub factorisations_ratio: f64,
    /// Solves over those of the simulation.
    pub solves_ratio: f64,
}

/// Cost of CEN over that of the exact engines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SpeedUp {
    /// Number of parameters.
    pub parameters: usize,
    /// CEN over ADJ.
    pub adj: Option<f64>,
    /// CEN over TRA.
    pub tra: Option<f64>,
}

/// Wall times.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Timing {
    /// The whole study, s.
    pub seconds: f64,
    /// One entry per bearing and operating point, in the order of the cases.
    pub cases: Vec<CaseTiming>,
}

/// Wall times of one bearing at one operating point, all on one thread.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CaseTiming {
    /// The simulation at the point, from a cold start, s.
    pub simulation_s: f64,
    /// Each engine for each number of parameters, in the order of the costs.
    pub engines: Vec<EngineTime>,
    /// How many times faster ADJ and TRA are than CEN.
    pub speed_ups: Vec<SpeedUp>,
}

/// Wall time of one engine.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EngineTime {
    /// Engine.
    pub engine: EngineName,
    /// Number of parameters.
    pub parameters: usize,
    /// Wall time, s.
    pub seconds: f64,
    /// Wall time over that of the simulation.
    pub simulations: f64,
}

impl SpeedUp {
    /// The ratios for each number of parameters, given the price of an engine.
    pub fn list(counts: &[usize], price: impl Fn(EngineName, usize) -> Option<f64>) -> Vec<Self> {
        let over = |engine, k| Some(price(EngineName::Cen, k)? / price(engine, k)?);
        let one =
            |&k: &usize| Self { parameters: k, adj: over(EngineName::Adj, k), tra: over(EngineName::Tra, k) };
        counts.iter().map(one).filter(|s| s.adj.is_some() || s.tra.is_some()).collect()
    }
}

impl Comparison {
    /// Whether a gradient is wrong.
    pub fn any_wrong(&self) -> bool {
        self.cases.iter().any(|c| c.proof.any_wrong())
    }
}

impl ProvenCase {
    /// Whether a gradient is wrong.
    pub fn any_wrong(&self) -> bool {
        self.quantities.iter().any(|q| q.finding == Finding::Wrong)
    }
}

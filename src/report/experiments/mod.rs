//! Experiments: what a study does over levels of its keys. Content of `report.json` of such a study, its CSV and its page.
//!
//! Rows are runs, columns are factors and responses. What follows from the rows is told beside them: the best run, a straight fit
//! through all of them (how much each factor moves each response), and for factors that refine a discretisation the observed
//! order and what is to be expected without it.

mod analysis;
mod figures;
mod page;

pub use analysis::{effects, refinements};
pub use page::{experiments_csv, experiments_files, experiments_html};

use super::{Assumption, ExpectedReport, Provenance, ReportTiming};
use crate::optimise::Outcome;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the format.
pub const EXPERIMENTS_FORMAT: &str = "stribeck-experiments/1";

/// How experiments ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExperimentsStatus {
    /// Every run has its numbers.
    Complete,
    /// Some runs could not be computed; the reasons stand with them.
    Incomplete,
    /// Stopped from outside.
    Cancelled,
}

/// A study with experiments.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Experiments {
    /// Version of this format, "stribeck-experiments/1".
    pub schema_version: String,
    /// SHA-256 of all that decides on the answer: the study with every default and its tables, without its words.
    pub study_hash: String,
    /// Title of the study.
    pub title: String,
    /// Question of the study.
    pub question: Option<String>,
    /// How it ended.
    pub status: ExperimentsStatus,
    /// The answer in sentences.
    pub answer: Vec<String>,
    /// Layout in words: "grid", "latin-hypercube", "sobol".
    pub plan: String,
    /// What was done with every study: "simulate" or "search".
    pub each: String,
    /// What was varied.
    pub factors: Vec<FactorReport>,
    /// What was looked at.
    pub responses: Vec<ResponseReport>,
    /// One entry per run.
    pub runs: Vec<ExperimentRun>,
    /// Number of the run with the least loss among those that keep all limits; none if there is none.
    pub best: Option<usize>,
    /// Straight fits through the runs, one per response; empty with too few runs or no factor of numbers.
    pub effects: Vec<EffectReport>,
    /// What refinement tells, one entry per refining factor, response and combination of the other factors.
    pub refinements: Vec<RefinementReport>,
    /// Figures the study expects, held against what was found.
    pub expected: Vec<ExpectedReport>,
    /// What depends on the machine and differs between reruns. Nothing else does.
    pub timing: ReportTiming,
    /// What is assumed and why.
    pub assumptions: Vec<Assumption>,
    /// What this rests on.
    pub provenance: Provenance,
}

/// Something that was varied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FactorReport {
    /// Name: the key of the study, or what its options are called together.
    pub name: String,
    /// Unit of its numbers; empty for plain numbers and words.
    pub unit: String,
    /// Ratio by which every level refines the one before; none unless it does.
    pub refinement_ratio: Option<f64>,
}

/// Something that was looked at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ResponseReport {
    /// Name in CSV files; ends with the unit.
    pub key: String,
    /// Name in words.
    pub title: String,
    /// Unit; "1" for a pure number.
    pub unit: String,
}

/// One study of the experiments.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ExperimentRun {
    /// Number, from 1.
    pub number: usize,
    /// Levels in words, in the order of the factors.
    pub levels: Vec<String>,
    /// Levels as numbers in the units of the factors; none for words.
    pub numbers: Vec<Option<f64>>,
    /// SHA-256 of its study.
    pub study_hash: String,
    /// How it ended; none if it was not begun.
    pub status: Option<Outcome>,
    /// Why there are no numbers, if there are none.
    pub failure: Option<String>,
    /// Whether every limit is kept; none if not known.
    pub feasible: Option<bool>,
    /// Responses, in the order of the list.
    pub responses: Vec<Option<f64>>,
}

/// A straight fit of a response over all factors of numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EffectReport {
    /// Key of the response.
    pub response: String,
    /// Share of the response's variance the fit explains.
    pub explained: f64,
    /// Change of the response from the lowest to the highest level of each factor, in its unit; of words the largest difference of two
    /// levels. None for a factor that does not vary.
    pub changes: Vec<Option<f64>>,
}

/// What refinement tells of a response (Richardson 1911; Roache 1994).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RefinementReport {
    /// The refining factor.
    pub factor: String,
    /// Key of the response.
    pub response: String,
    /// Levels of the other factors, in their order.
    pub others: Vec<String>,
    /// The response over the levels, from coarse to fine.
    pub values: Vec<f64>,
    /// Observed order by the three finest levels; none where they do not approach a value.
    pub order: Option<f64>,
    /// The value expected without discretisation, by that order.
    pub extrapolated: Option<f64>,
    /// How far the finest level is from it, per cent of it.
    pub error_percent: Option<f64>,
}

/// Size in its unit below which nobody looks at a response: a trace of contact.
const TRACE: f64 = 1e-3;

impl Experiments {
    /// Responses that are more than a trace in any run, by their number; the loss in any case.
    pub fn shown(&self) -> Vec<usize> {
        let seen = |k: &usize| {
            let all = self.runs.iter().filter_map(|r| r.responses.get(*k).copied().flatten());
            *k == 0 || all.fold(0.0f64, |m, v| m.max(v.abs())) >= TRACE
        };
        (0..self.responses.len()).filter(seen).collect()
    }
}

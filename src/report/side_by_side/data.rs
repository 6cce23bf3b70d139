//! Content of `compare.json`. Every number that has a unit stands beside it.

use super::{LeafComparison, TablePair};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Version of the format.
pub const SIDE_BY_SIDE_FORMAT: &str = "stribeck-side-by-side/1";

/// Units in which a share of a value means nothing: their zero is a convention, or they are shares themselves.
const WITHOUT_SHARE: [&str; 3] = ["degC", "deg", "%"];

/// A report to compare, with what stands beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// What the reader knows it by: a file or folder.
    pub label: String,
    /// Content of its `report.json`.
    pub report: Value,
    /// Content of the `orbit.csv` beside it, if there is one.
    pub orbit_csv: Option<String>,
}

/// Two reports side by side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SideBySide {
    /// Version of this format, "stribeck-side-by-side/1".
    pub schema_version: String,
    /// Format of both reports, "stribeck-report/1" for designs.
    pub format: String,
    /// The first report.
    pub a: ReportHead,
    /// The second report.
    pub b: ReportHead,
    /// The answer, sentence by sentence.
    pub answer: Vec<String>,
    /// What to mind when reading it, sentence by sentence.
    pub notes: Vec<String>,
    /// Two designs; none for reports of other kinds.
    pub design: Option<DesignPair>,
    /// Tables of two characteristics, paired by name; empty for reports of other kinds.
    pub tables: Vec<TablePair>,
    /// Content of reports that are no designs, the largest relative differences first; none for designs.
    pub content: Option<LeafComparison>,
    /// Inputs: all leaves that differ of the studies with every default written out.
    pub inputs: LeafComparison,
}

/// What one knows a report by.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ReportHead {
    /// File or folder.
    pub label: String,
    /// Title of its study.
    pub title: String,
    /// How it ended.
    pub status: Option<String>,
    /// Version of the program that wrote it.
    pub version: Option<String>,
    /// SHA-256 of its study with every default written out and its tables.
    pub study_hash: Option<String>,
    /// Whether the study's coarse setting was used.
    pub coarse: bool,
}

/// Two designs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DesignPair {
    /// How the searches ended, what they minimised, what they chose.
    pub outcome: Vec<TextPair>,
    /// The objective at start and design, and its parts.
    pub objective: Vec<NumberPair>,
    /// Design parameters, by name.
    pub parameters: Vec<NumberPair>,
    /// Limits on quantities, on sums of parameters and on running-in.
    pub limits: Vec<LimitPair>,
    /// Loss, extrema and means of the working cycle, one entry per bearing and operating point.
    pub cycles: Vec<CasePair>,
    /// Running-in in short, one entry per bearing; empty if neither design is run in.
    pub running_in: Vec<CasePair>,
    /// Work done.
    pub work: Vec<NumberPair>,
}

/// A text of each report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct TextPair {
    /// What it is.
    pub name: String,
    /// In A; none if A has none.
    pub a: Option<String>,
    /// In B; none if B has none.
    pub b: Option<String>,
}

/// A number of each report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NumberPair {
    /// What it is.
    pub name: String,
    /// Unit of the values and their difference; "1" for a count.
    pub unit: String,
    /// In A; none if A has none.
    pub a: Option<f64>,
    /// In B; none if B has none.
    pub b: Option<f64>,
    /// B less A.
    pub difference: Option<f64>,
    /// The same relative to A, per cent; none where that means nothing.
    pub difference_percent: Option<f64>,
}

/// A limit of each report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LimitPair {
    /// Limited quantity, or sum of parameters in words.
    pub quantity: String,
    /// Bearing; empty for a sum of parameters.
    pub bearing: String,
    /// Operating point, "running-in" for a limit of that; empty for a sum of parameters.
    pub operating_point: String,
    /// "at least", "at most" or "equals".
    pub sense: String,
    /// Unit of values and limits.
    pub unit: String,
    /// In A; none if A does not have the limit.
    pub a: Option<LimitSide>,
    /// In B; none if B does not have the limit.
    pub b: Option<LimitSide>,
    /// Value of B less that of A.
    pub difference: Option<f64>,
}

/// A limit in one report.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LimitSide {
    /// Value the optimiser sees.
    pub value: Option<f64>,
    /// Limit.
    pub limit: f64,
    /// Whether it is kept, and whether it holds the design back.
    pub state: LimitState,
    /// Loss that one unit of relaxation would save, W per unit; none unless the limit is active.
    pub price_w_per_unit: Option<f64>,
}

/// State of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LimitState {
    /// Kept with room.
    Inactive,
    /// Kept, and holds the design back.
    Active,
    /// Broken.
    Violated,
    /// The value is not known.
    NotKnown,
}

/// Numbers of one bearing, at one operating point where they belong to one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CasePair {
    /// Bearing.
    pub bearing: String,
    /// Operating point; none for what concerns all of them.
    pub operating_point: Option<String>,
    /// The numbers.
    pub numbers: Vec<NumberPair>,
}

impl NumberPair {
    /// Two numbers and their difference.
    pub(super) fn new(name: impl Into<String>, unit: &str, a: Option<f64>, b: Option<f64>) -> Self {
        let both = a.zip(b);
        let shared = both.filter(|(a, _)| *a != 0.0 && !WITHOUT_SHARE.contains(&unit));
        Self {
            name: name.into(),
            unit: unit.to_owned(),
            a,
            b,
            difference: both.map(|(a, b)| b - a),
            difference_percent: shared.map(|(a, b)| 100.0 * (b - a) / a.abs()),
        }
    }
}

impl CasePair {
    /// Bearing and operating point, as one reads them.
    pub fn name(&self) -> String {
        self.operating_point
            .as_ref()
            .map_or_else(|| self.bearing.clone(), |p| format!("{}, {p}", self.bearing))
    }
}

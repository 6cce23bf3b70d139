//! The study file as it is written: every key, its meaning and its default. The JSON Schema is made from these types.

/// A section of the file: keys that may be absent or wrong, and keys nobody knows.
macro_rules! section {
    ($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $kind:ty,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(default)]
        #[schemars(deny_unknown_fields)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $crate::study::Given<$kind>,)*
            /// Keys that are not part of the format.
            #[serde(flatten)]
            #[schemars(skip)]
            pub unknown: $crate::study::given::Unknown,
        }
    };
}

/// The words of a key that is one of a few.
macro_rules! words {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(rename_all = "kebab-case")]
        pub enum $name { $($(#[$variant_doc])* $variant,)* }
    };
}

mod bearing;
mod characteristic;
mod comparison;
mod experiments;
mod film;
mod machine;
mod oil;
mod search;
mod surface;

pub use bearing::{BearingFile, BearingKind, HeatBalanceFile, OpeningFile, OpeningKind, SupplyFile};
pub use characteristic::{CharacteristicFile, VaryName};
pub use comparison::ComparisonFile;
pub use experiments::{EachName, ExpectedFile, ExperimentsFile, FactorFile, PlanName, SpacingName};
pub use film::{CavitationName, CavityShearName, FilmFile, FilmModelName, OrbitFile, SchemeName};
pub use machine::{CylinderPressureFile, MachineFile, PressureSource};
pub use oil::{
    CompressibilityName, GradeFile, OilFile, PiezoviscosityName, ShearThinningName, ViscosityLawName,
    ViscosityPointFile,
};
pub use search::{
    AccelerationName, AggregateName, ChoiceFile, ConstraintFile, GradientFile, LinearConstraintFile,
    ObjectiveFile, OperatingPointFile, OptimiserFile, OptionFile, ParameterFile, ParetoFile, RobustFile,
    RunningInFile, RunningInGoalName, StageFile, TermFile, ToleranceFile,
};
pub use surface::{ContactIntegralName, ContactName, RoughnessFile, ShapeFile, ShapeKind, SurfaceName};

use super::Given;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// A quantity whose kind depends on another key: text with a number and a unit.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct QuantityText(pub String);

impl<'de> Deserialize<'de> for QuantityText {
    fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        match Value::deserialize(d)? {
            Value::String(text) => Ok(Self(text)),
            _ => Err(serde::de::Error::custom("expected a quantity with its unit in quotes, like \"65 mm\"")),
        }
    }
}

section! {
    /// A stribeck study: which bearings, under which load, varied how, judged by what.
    StudyFile {
        /// Version of the format: "stribeck-study/1".
        format: String,
        /// Title of the report.
        title: String,
        /// The question this study answers, for its readers. Default: none.
        question: String,
        /// Figures the report must show, by their path there, like "objective.optimum.total_w" or "design[name=big_end.width].value". Held against the answer of a run.
        expected: BTreeMap<String, Given<ExpectedFile>>,
        /// A coarse setting, to see quickly whether all is well: keys of the study by their path, with the values they take with --coarse.
        coarse: BTreeMap<String, Value>,
        /// What is not known but assumed: path of a key and the reason for its value. Listed in the report.
        assumptions: BTreeMap<String, String>,
        /// The machine: needed unless every bearing has its load as a table.
        machine: MachineFile,
        /// Cylinder pressure: needed with the machine.
        cylinder_pressure: CylinderPressureFile,
        /// Bearings by name.
        bearings: BTreeMap<String, Given<BearingFile>>,
        /// The oil of all bearings.
        oil: OilFile,
        /// Oils by name, for oil.grade; needed only if the name is not among the known grades.
        grades: BTreeMap<String, Given<GradeFile>>,
        /// Film model.
        film: FilmFile,
        /// How the working cycle is computed.
        orbit: OrbitFile,
        /// Tabulate what the bearings do over a varied quantity instead of searching a design.
        characteristic: CharacteristicFile,
        /// Compare the gradient engines at the start design instead of searching a better one.
        comparison: ComparisonFile,
        /// The study many times over with other values of its keys, instead of once.
        experiments: ExperimentsFile,
        /// What is minimised, at which operating points. Like all below not with a characteristic.
        objective: ObjectiveFile,
        /// Design parameters with their box.
        parameters: Vec<Given<ParameterFile>>,
        /// Limits of a safe design.
        constraints: Vec<Given<ConstraintFile>>,
        /// Limits on sums of design parameters.
        linear_constraints: Vec<Given<LinearConstraintFile>>,
        /// Margins for what scatters.
        robust: RobustFile,
        /// Running-in of the design that is found.
        running_in: RunningInFile,
        /// What is chosen from lists.
        choices: Vec<Given<ChoiceFile>>,
        /// The least loss for each of a list of limits on another quantity.
        pareto: ParetoFile,
        /// How gradients are computed.
        gradient: GradientFile,
        /// How the design is searched.
        optimiser: OptimiserFile,
    }
}

//! What was asked: the study file, its checks, and the run that answers it. The single door for CLI and service.
//!
//! ```text
//! text (TOML or JSON) --document--> values with places --file--> StudyFile --check--> Study (SI, defaults written in)
//! Study --build--> DesignProblem --run--> Report          (or --compare--> Comparison, --characterise--> Characteristic)
//! ```
//!
//! Reading never stops at the first mistake: every value that does not fit is kept as [`Given::Wrong`], and the check
//! reports all of them with their places.

mod answer;
mod bearings;
mod build;
pub mod catalogue;
mod characterise;
mod characteristic;
mod check;
mod choices;
mod compare;
mod comparison;
mod constraints;
mod document;
mod engines;
mod estimate;
mod evidence;
mod expected;
mod experiment;
mod factors;
mod faults;
mod file;
mod film;
mod fit;
mod given;
mod hash;
mod heat;
mod keep;
mod layout;
mod lexicon;
mod limits;
mod linear;
mod loads;
mod machine;
mod methods;
mod model;
mod observe;
mod oil;
mod parameters;
mod pareto;
mod place;
mod plans;
mod programme;
mod prove;
mod read;
mod rheology;
mod robust;
mod roughness;
mod run;
mod run_in;
mod run_in_curves;
mod run_in_search;
mod running_in;
mod running_in_design;
mod schema;
mod searches;
mod sections;
mod seek;
mod sensitivity;
mod shapes;
mod supply;
mod table;
mod task;
mod variables;
mod variant;
mod viscosity;
mod vocabulary;
mod warm_start;

pub use build::{CaseLabel, LimitLabel, Plan, plan};
pub use characterise::characterise;
pub use check::Study;
pub use compare::compare;
pub use document::Format;
pub use engines::{EngineComparison, EngineRow, Sweep, compare_engines};

pub use estimate::{Estimate, estimate};
pub use experiment::experiment;
pub use faults::{Fault, StudyErrors};
pub use file::StudyFile;
pub use given::Given;
pub use hash::{hex, sha256};
pub use model::{ModelInput, ModelOutput, StudyModel};
pub use plans::{
    BearingPlan, ConstraintPlan, FilmPlan, HeatPlan, OilPlan, OperatingPoint, ParameterPlan, RoughnessPlan,
    SupplyPlan,
};
pub use prove::prove;
pub use read::{Reading, setting};
pub use run::{run, run_saved, simulate};
pub use schema::schema;
pub use searches::SearchPlan;
pub use task::{Answer, Task, answer};

pub use variables::Variable;
pub use vocabulary::QuantityName;

/// Version of the study format this program reads.
pub const FORMAT: &str = "stribeck-study/1";

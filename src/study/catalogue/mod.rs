//! What the program knows, as lists: laws and methods with their sources, gradient engines, search methods, quantities,
//! parameters.
//!
//! Laws stand here once, and the report takes its sentences from the same table. Everything else comes from where the code has it:
//! meanings from the doc comments of the study file (through its schema), names and units of parameters from the variables of
//! a study. Deliberately not here: how lists are shown, and what the laws compute.

mod docs;
mod engines;
pub(super) mod entry;
pub(super) mod experiments;
pub(super) mod film;
mod laws;
pub(super) mod machine;
mod methods;
pub(super) mod numerics;
pub(super) mod oil;
mod parameters;
mod quantities;
pub(super) mod search;
pub(super) mod shapes;
pub(super) mod sources;
pub(super) mod surfaces;
pub(super) mod wear;

pub use engines::{EngineEntry, engines};
pub use laws::{Law, laws, laws_in_use, references};
pub use methods::{MethodEntry, methods};
pub use parameters::{ParameterEntry, parameters};
pub use quantities::{QuantityEntry, quantities};

/// A study that has every kind of parameter there is.
const EVERY_PARAMETER: &str = include_str!("every_parameter.toml");

#[cfg(test)]
pub(super) mod example {
    //! The study with every parameter, changed as text: what the tests of lists and sentences read.

    use super::EVERY_PARAMETER;
    use crate::study::{Format, Study};

    /// That study; each change must find its text.
    pub(in crate::study) fn study(changes: &[(&str, &str)]) -> Study {
        let mut text = EVERY_PARAMETER.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        Study::read(&text, Format::Toml, None).unwrap_or_else(|e| panic!("{:#?}", e.faults))
    }
}

//! What can be wrong with a profile.

use thiserror::Error;

/// A profile that makes no sense, in words for whoever gave it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ShapeError {
    /// A number is infinite or not a number.
    #[error("{what} has to be a finite number, not {value}")]
    NotFinite {
        /// The name of the number.
        what: String,
        /// The number.
        value: f64,
    },
    /// A number outside of its range.
    #[error("{what} has to be {range}, not {value}")]
    OutOfRange {
        /// The name of the number.
        what: &'static str,
        /// The range in words.
        range: &'static str,
        /// The number.
        value: f64,
    },
    /// Too many or too few numbers.
    #[error("{what}: {range} needed, {found} given")]
    Count {
        /// What the numbers are.
        what: &'static str,
        /// How many are needed, in words.
        range: String,
        /// How many were given.
        found: usize,
    },
    /// Grid lines that do not increase strictly.
    #[error("{what} have to increase strictly: {after} follows {before}")]
    Order {
        /// The name of the grid lines.
        what: &'static str,
        /// One grid line.
        before: f64,
        /// The next one.
        after: f64,
    },
}

/// Refuses an infinite number and what is not a number.
pub(super) fn finite(what: impl Into<String>, value: f64) -> Result<(), ShapeError> {
    if value.is_finite() { Ok(()) } else { Err(ShapeError::NotFinite { what: what.into(), value }) }
}

/// Refuses infinite numbers and names the first one by its index.
pub(super) fn all_finite(what: &str, values: &[f64]) -> Result<(), ShapeError> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(at) => finite(format!("{what}[{at}]"), values[at]),
        None => Ok(()),
    }
}

/// Refuses any number of values but `wanted`.
pub(super) fn count(what: &'static str, found: usize, wanted: usize) -> Result<(), ShapeError> {
    if found == wanted { Ok(()) } else { Err(ShapeError::Count { what, range: wanted.to_string(), found }) }
}

//! What a design problem is made of: models with what is asked of them, and limits.

use crate::orbit::{Orbit, OrbitOptions, Quantity};
use serde::{Deserialize, Serialize};

/// One model with what is asked of it.
pub struct Case<M> {
    /// The model at the start design.
    pub model: M,
    /// For each parameter of the model, which design variable it is.
    pub variables: Vec<usize>,
    /// Quantities evaluated and differentiated; weights and limits refer to them.
    pub quantities: Vec<Quantity>,
    /// How its cycle is computed.
    pub options: OrbitOptions,
    /// Share of each quantity in the objective, `(quantity, weight)`.
    pub objective: Vec<(usize, f64)>,
    /// Which objective that is a part of, where objectives are taken apart.
    pub part: usize,
}

/// Which side of a limit is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// The quantity must not fall below the limit.
    AtLeast,
    /// The quantity must not exceed the limit.
    AtMost,
}

/// A limit on a quantity of a case; the constraint is the relative excess over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Case it belongs to.
    pub case: usize,
    /// Quantity of that case.
    pub quantity: usize,
    /// Allowed side.
    pub sense: Sense,
    /// Limit in SI units, above zero.
    pub limit: f64,
}

impl Limit {
    /// The constraint `c <= 0` and its derivative by the quantity.
    pub(super) fn constraint(&self, value: f64) -> (f64, f64) {
        relative_excess(self.sense, self.limit, value)
    }
}

/// The relative excess `c <= 0` of a value over a limit, and its derivative by the value.
pub fn relative_excess(sense: Sense, limit: f64, value: f64) -> (f64, f64) {
    match sense {
        Sense::AtLeast => (1.0 - value / limit, -1.0 / limit),
        Sense::AtMost => (value / limit - 1.0, 1.0 / limit),
    }
}

/// A simulated design.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Evaluated {
    /// Settled cycle of each case.
    pub orbits: Vec<Orbit>,
}

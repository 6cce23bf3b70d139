//! What is minimised, varied and limited, and how, as written.

use super::QuantityText;
use crate::gradient::EngineName;
use crate::optimise::Method;
use crate::study::{Given, QuantityName};
use crate::units::{Rotation, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

section! {
    /// One operating point of the duty cycle.
    OperatingPointFile {
        /// Name in reports.
        name: String,
        /// Speed of the crankshaft.
        speed: Rotation,
        /// Share of this point in the objective. Default 1; shares are normalised to the sum 1.
        weight: f64,
        /// Factor on the cylinder pressure (or on the tabulated load). Default 1.
        load_factor: f64,
    }
}

section! {
    /// Objective: the weighted mean friction loss of all bearings over the operating points.
    ObjectiveFile {
        /// Operating points with their weights.
        operating_points: Vec<Given<OperatingPointFile>>,
    }
}

section! {
    /// One design parameter.
    ParameterFile {
        /// "<bearing>.width", ".diameter", ".diametral_clearance", ".tilt_x", ".tilt_y", ".roughness.journal", ".roughness.shell", ".supply.pressure", ".shapes.<shape>.<key>" (all coefficients of a spline: "coefficients[*]"), or "oil.inlet_temperature".
        name: String,
        /// Smallest allowed value, with unit; a share is a number in quotes, like "0.2".
        lower: QuantityText,
        /// Largest allowed value, with unit.
        upper: QuantityText,
        /// Value the search starts from, with unit. Default: the value of that key in the study.
        start: QuantityText,
    }
}

section! {
    /// One limit; give either at_least or at_most.
    ConstraintFile {
        /// Limited quantity.
        quantity: QuantityName,
        /// Bearing it applies to. Default: every bearing.
        bearing: String,
        /// Smallest allowed value, with unit.
        at_least: QuantityText,
        /// Largest allowed value, with unit.
        at_most: QuantityText,
    }
}

section! {
    /// A front: the least loss for each of a list of limits on another quantity, beside the search itself.
    ParetoFile {
        /// The quantity. A limit of [[constraints]] on the same one gives way to the list.
        quantity: QuantityName,
        /// Name of the bearing; all of them if absent.
        bearing: String,
        /// Smallest values allowed, one search each, with unit.
        at_least: Vec<QuantityText>,
        /// Largest values allowed, one search each, with unit.
        at_most: Vec<QuantityText>,
    }
}

section! {
    /// Gradient engine.
    GradientFile {
        /// "ADJ" (default), "TRA", "CEN", "FW" or "BW".
        engine: EngineName,
        /// Relative perturbation of the finite differences. Default 1e-6.
        perturbation: f64,
    }
}

/// Another search for comparison.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RivalFile {
    /// Method.
    pub method: Method,
    /// Gradient engine. Default "ADJ".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub engine: Option<EngineName>,
}

section! {
    /// Optimiser.
    OptimiserFile {
        /// "sqp" (default), "augmented-lagrangian" or, without gradients, "cobyla".
        method: Method,
        /// Searches: the first from the start, the others from a Latin hypercube over the box. Default 1.
        starts: u64,
        /// Seed of the Latin hypercube. Default 1.
        seed: u64,
        /// Designs one search may simulate. No limit by default.
        max_simulations: u64,
        /// Wall time one search may take, like "600 s"; a search that ends by it gives other numbers on a rerun. No limit by default.
        max_time: Time,
        /// Methods and gradient engines that search from the same start too, for comparison in the report. None by default.
        rivals: Vec<RivalFile>,
        /// Scaled KKT residual at which a design counts as optimal. Default 1e-6.
        tolerance: f64,
        /// Iterations at most. Default 60.
        max_iterations: u64,
        /// Longest change of a parameter in one iteration, as a share of its box. Default 0.4.
        step_limit: f64,
        /// Sharpness of the smooth extrema of film thickness and pressure: larger is closer to the exact extremum and harder to optimise. Default 200.
        aggregate_sharpness: f64,
    }
}

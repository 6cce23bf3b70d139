//! Several searches side by side: from different starts, by different methods.

use crate::gradient::EngineName;
use crate::optimise::{Method, Outcome};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Searches from different starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartsReport {
    /// Seed of the Latin hypercube all starts but the first belong to.
    pub seed: u64,
    /// Names of the parameters, in the order of starts and designs.
    pub parameters: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// One entry per start; the first is that of the study.
    pub runs: Vec<StartRun>,
    /// Median of the designs simulated by the searches that converged.
    pub median_simulations: Option<u64>,
    /// Distinct ends, the best first.
    pub optima: Vec<LocalOptimum>,
}

/// A search from one start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartRun {
    /// The start.
    pub start: Vec<f64>,
    /// How it ended.
    pub status: Outcome,
    /// Objective at its best design, W.
    pub loss_w: Option<f64>,
    /// Largest relative violation of a limit there.
    pub violation: Option<f64>,
    /// Scaled KKT residual there.
    pub kkt: Option<f64>,
    /// Designs simulated.
    pub simulations: u64,
    /// Designs differentiated.
    pub gradient_calls: u64,
    /// Which of the optima it found, counted from 1; none if it did not converge.
    pub optimum: Option<usize>,
}

/// An end that several searches may share: losses within 1e-4, designs within a hundredth of the box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LocalOptimum {
    /// Objective, W.
    pub loss_w: f64,
    /// The design.
    pub design: Vec<f64>,
    /// Searches that ended here.
    pub found: u64,
}

/// A search by one method with one gradient engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RivalRun {
    /// Method.
    pub method: Method,
    /// Gradient engine; COBYLA only judges its end with it.
    pub engine: EngineName,
    /// How it ended.
    pub status: Outcome,
    /// Objective at its best design, W.
    pub loss_w: Option<f64>,
    /// Largest relative violation of a limit there.
    pub violation: Option<f64>,
    /// Scaled KKT residual there.
    pub kkt: Option<f64>,
    /// Designs simulated.
    pub simulations: f64,
    /// Designs differentiated.
    pub gradient_calls: u64,
    /// Work of the gradients in units of a simulation, by factorisations.
    pub gradient_simulations: f64,
    /// Wall time, s.
    pub seconds: f64,
}

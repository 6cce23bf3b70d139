//! The settled cycle and how it is found.

use super::balance::settle_balanced;
use super::march::March;
use super::{Quantity, Recording, Scheme};
use crate::dae::{Dae, InvalidParameters, LinearisedDae};
use crate::run::{Cancel, Cancelled, Cost};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How a cycle is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitOptions {
    /// Steps per period, at least 3.
    pub steps: usize,
    /// Difference formula.
    pub scheme: Scheme,
    /// Largest difference between two cycles, in the model's own units of change, that counts as settled.
    pub periodicity_tolerance: f64,
    /// Cycles after which settling is given up.
    pub max_cycles: usize,
    /// Memory that the recording of a cycle may take, bytes. With room for factors, slow settling is accelerated and
    /// gradients factorise each step once; see [`Recording`] for what happens with less.
    pub memory_bytes: usize,
}

/// Why there is no settled cycle.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OrbitError {
    /// Newton's method failed.
    #[error("the step at {at_share:.4} of cycle {cycle} did not converge; try more steps per cycle")]
    StepFailed {
        /// Position in the period, 0 to 1.
        at_share: f64,
        /// Cycle, counted from 1.
        cycle: usize,
    },
    /// The cycle keeps changing.
    #[error(
        "the orbit did not become periodic within {cycles} cycles: two cycles still differ by {residual:.2e}"
    )]
    NotPeriodic {
        /// Cycles marched.
        cycles: usize,
        /// Difference of the last two.
        residual: f64,
    },
    /// The cycle unknowns do not settle.
    #[error(
        "the balance over the cycle (film temperature) did not close within {rounds} rounds: {residual:.2e} left"
    )]
    NotBalanced {
        /// Cycles settled.
        rounds: usize,
        /// Last change of the unknowns, in units of their scale.
        residual: f64,
    },
    /// The cycle unknowns ran to values at which the model does not exist.
    #[error("the balance over the cycle (film temperature) has no solution: {0}")]
    Parameters(#[from] InvalidParameters),
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A settled cycle.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Orbit {
    /// Difference formula.
    pub scheme: Scheme,
    /// Step length, s.
    pub dt_s: f64,
    /// Parameters of the model that was settled, its cycle unknowns at the end.
    pub parameters: Vec<f64>,
    /// What is kept of it.
    pub recording: Recording,
    /// States at `t = n dt`; empty where they are not kept.
    pub states: Vec<Vec<f64>>,
    /// Outputs at the same times.
    pub outputs: Vec<Vec<f64>>,
    /// Difference between the last two passes where marching stopped.
    pub periodicity: f64,
    /// Last change of the cycle unknowns in units of their scale; 0 without any.
    pub balance: f64,
    /// Derivatives of the equations of the cycle unknowns by the unknowns, one row each, as the search learned them.
    pub response: Vec<Vec<f64>>,
    /// Cycles marched, a fraction.
    pub cycles: f64,
    /// Corrections of the period map by Newton's method on the way.
    pub corrections: usize,
    /// Work done.
    pub cost: Cost,
}

impl Orbit {
    /// Number of steps per period.
    pub fn steps(&self) -> usize {
        self.states.len()
    }

    /// The same with other states; those of this one are not copied.
    pub fn with_states(&self, states: Vec<Vec<f64>>) -> Self {
        Self {
            states,
            parameters: self.parameters.clone(),
            outputs: self.outputs.clone(),
            response: self.response.clone(),
            ..*self
        }
    }

    /// Time of step `n`.
    pub fn time_s(&self, n: usize) -> f64 {
        n as f64 * self.dt_s
    }

    /// State of step `n`; empty if it is not kept.
    pub fn state(&self, n: usize) -> &[f64] {
        &self.states[n]
    }

    /// Value of a quantity.
    pub fn value(&self, quantity: &Quantity) -> f64 {
        quantity.value(&self.outputs)
    }

    /// Mean of an output over the cycle.
    pub fn mean(&self, output: usize) -> f64 {
        self.outputs.iter().map(|y| y[output]).sum::<f64>() / self.steps() as f64
    }

    /// The model that this is the cycle of: `model` with the cycle unknowns that were found.
    pub fn model<M: Dae>(&self, model: &M) -> Result<M, InvalidParameters> {
        model.with_parameters(&self.parameters)
    }
}

/// Marches `model` until its cycle repeats, from a cold start or from the cycle of a similar model, and finds its cycle
/// unknowns, if it has any.
pub fn settle<M: LinearisedDae>(
    model: &M,
    options: &OrbitOptions,
    start: Option<&Orbit>,
    cancel: &Cancel,
) -> Result<Orbit, OrbitError> {
    match model.cycle() {
        Some(equations) => settle_balanced(model, equations, options, start, cancel),
        None => settle_fixed(model, options, start, cancel),
    }
}

/// The settled cycle at given cycle unknowns.
pub(super) fn settle_fixed<M: LinearisedDae>(
    model: &M,
    options: &OrbitOptions,
    start: Option<&Orbit>,
    cancel: &Cancel,
) -> Result<Orbit, OrbitError> {
    let mut march = March::new(model, options, start);
    march.run(cancel)?;
    march.finish()
}

//! The ladder of abilities of a periodic, parameter-dependent, implicit differential-algebraic system.
//!
//! ```text
//! F(t, z, z'; p) = 0,   z(t + T) = z(t),        outputs  y = g(t, z, z'; p)
//! ```
//!
//! A model climbs as far as it needs: [`Dae`] can be evaluated, [`LinearisedDae`] can be stepped implicitly,
//! [`SensitiveDae`] can be differentiated forwards and backwards. The orbit and gradient floors work on these traits
//! and know no state by name, so a bearing, a train of bearings or a user's own model get the same treatment.
//!
//! Derivatives leave as products with vectors, never as full matrices: `F_p` may have hundreds of columns.
//! Deliberately not here: how `z'` is discretised (see [`crate::orbit`]).

use crate::math::Singular;
use thiserror::Error;

/// A parameter vector for which the model does not exist (say, a clearance below zero).
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{0}")]
pub struct InvalidParameters(pub String);

/// A periodic implicit system that can be evaluated.
pub trait Dae: Send + Sync {
    /// Length of `z`.
    fn states(&self) -> usize;
    /// Indices of the states that enter `F` with their rate. The rest has no memory.
    fn memory(&self) -> &[usize];
    /// The parameters `p` at which this model stands, SI units.
    fn parameters(&self) -> &[f64];
    /// Length of the period in seconds.
    fn period_s(&self) -> f64;
    /// Number of outputs.
    fn outputs(&self) -> usize;
    /// A state to start the transient from.
    fn cold_start(&self) -> Vec<f64>;
    /// Writes `F(t, z, z')` to `residual`.
    fn residual(&self, at: At, residual: &mut [f64]);
    /// Writes the outputs to `y`.
    fn output(&self, at: At, y: &mut [f64]);
    /// Size of a change `dz` of the state in units in which 1 is a change of order one.
    fn change(&self, z: &[f64], dz: &[f64]) -> f64;
    /// The same model at other parameters.
    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters>
    where
        Self: Sized;
}

/// A system whose steps can be solved by Newton's method.
pub trait LinearisedDae: Dae {
    /// Factors of `F_z + alpha F_z'`, with their workspace.
    type Factors: Send;
    /// Room for factors.
    fn factors(&self) -> Self::Factors;
    /// Factorises `F_z + alpha F_z'` at the given point.
    fn factor(&self, at: At, alpha: f64, into: &mut Self::Factors) -> Result<(), Singular>;
    /// Replaces each column of `rhs` by the solution with the factorised matrix.
    fn solve(&self, factors: &Self::Factors, rhs: &mut [f64]);
    /// Whether the model is defined at a state.
    fn contains(&self, z: &[f64]) -> bool;
    /// Largest fraction of the Newton step `dz` that stays where the model is defined, at most 1.
    fn admissible(&self, z: &[f64], dz: &[f64]) -> f64;
}

/// A system that can be differentiated by states, rates and parameters, in both directions.
pub trait SensitiveDae: LinearisedDae {
    /// Replaces each column of `rhs` by the solution with the transposed matrix.
    fn solve_transposed(&self, factors: &Self::Factors, rhs: &mut [f64]);
    /// `out += F_z' rate + F_p dp`.
    fn times(&self, at: At, rate: &[f64], dp: &[f64], out: &mut [f64]);
    /// `rate += F_z'^T v` and `p += F_p^T v`.
    fn transposed_times(&self, at: At, v: &[f64], rate: &mut [f64], p: &mut [f64]);
    /// Writes `dy = g_z dz + g_z' drate + g_p dp`.
    fn output_tangent(&self, at: At, direction: Direction, dy: &mut [f64]);
    /// Adds `g_z^T w`, `g_z'^T w` and `g_p^T w` to the three parts of `out`.
    fn output_cotangent(&self, at: At, w: &[f64], out: Cotangent);
}

/// A point of a trajectory.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// Time in seconds.
    pub t_s: f64,
    /// State.
    pub z: &'a [f64],
    /// Rate of the state.
    pub rate: &'a [f64],
}

/// A direction in states, rates and parameters.
#[derive(Debug, Clone, Copy)]
pub struct Direction<'a> {
    /// Change of the state.
    pub z: &'a [f64],
    /// Change of the rate.
    pub rate: &'a [f64],
    /// Change of the parameters.
    pub p: &'a [f64],
}

/// Where the transposed derivatives of outputs are added up.
#[derive(Debug)]
pub struct Cotangent<'a> {
    /// By states.
    pub z: &'a mut [f64],
    /// By rates.
    pub rate: &'a mut [f64],
    /// By parameters.
    pub p: &'a mut [f64],
}

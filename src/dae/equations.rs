//! What a user writes of a model: its equations once, for any kind of number.
//!
//! ```text
//! F(t, z, m'; p) = 0,   m = M(t, z; p),   y = g(t, z, m'; p)
//! ```
//!
//! The same functions are evaluated with plain numbers and with dual numbers, so that a derivative can neither be
//! forgotten nor be wrong. Deliberately not here: what is made of them (see [`super::Dense`]).

use super::InvalidParameters;
use num_dual::DualNum;

/// A real number or one that carries its derivative along.
///
/// It adds, multiplies and compares with its like and, from the right, with `f64` (`x * 2.0`, not `2.0 * x`), and knows
/// `sin`, `sqrt`, `powi`, `exp` and so on. A constant enters as `T::from(2.0)`. Comparisons look at the value alone: each
/// branch of an `if` is differentiated as it stands.
pub trait Number: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Number for T {}

/// How much of what a model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// States, and as many equations.
    pub states: usize,
    /// Memories.
    pub memories: usize,
    /// Outputs.
    pub outputs: usize,
}

/// Where equations are evaluated.
#[derive(Debug, Clone, Copy)]
pub struct Instant<'a, T> {
    /// Time in seconds.
    pub t_s: f64,
    /// States.
    pub z: &'a [T],
    /// Rates of the memories; empty where the memory itself is asked for.
    pub rate: &'a [T],
    /// Parameters, cycle unknowns last.
    pub p: &'a [T],
}

impl<T: Copy> Instant<'_, T> {
    /// States, rates and parameters by name: `let ([x, v], [dx, dv], [mass, stiffness]) = at.parts();`
    ///
    /// # Panics
    ///
    /// If there are more or fewer of them than names.
    pub fn parts<const N: usize, const M: usize, const P: usize>(&self) -> ([T; N], [T; M], [T; P]) {
        (named("states", self.z), named("rates", self.rate), named("parameters", self.p))
    }
}

fn named<T: Copy, const N: usize>(what: &str, all: &[T]) -> [T; N] {
    all.try_into().unwrap_or_else(|_| panic!("{} {what} were given {N} names", all.len()))
}

/// The equations of a small periodic model.
///
/// A value of the type holds what is constant; what may vary comes as parameters `p`. The system may be a differential-algebraic
/// one of index 2 at most, as a mechanism is with its constraints on positions and velocities (Gear, Gupta and Leimkuhler
/// 1985). The period must not depend on the parameters.
pub trait Equations: Clone + Send + Sync {
    /// How many states, memories and outputs there are.
    fn sizes(&self) -> Sizes;
    /// Length of the period in seconds.
    fn period_s(&self) -> f64;
    /// Size of a change of each state that counts as order one, in the units of the state: convergence is judged by it.
    fn state_scale(&self) -> Vec<f64>;
    /// Writes the memory `M(t, z; p)`.
    fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]);
    /// Writes the residual `F(t, z, m'; p)`, one entry per state. Rows may be of any size: they are balanced before elimination.
    fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]);
    /// Writes the outputs `g(t, z, m'; p)`.
    fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]);
    /// Size of a change of each memory that counts as order one. By default (empty) what a change of all states by their
    /// scale does to it at the cold start.
    fn memory_scale(&self) -> Vec<f64> {
        Vec::new()
    }
    /// A state to start the transient from; it need not satisfy the equations. By default zero.
    fn cold_start(&self, _p: &[f64]) -> Vec<f64> {
        vec![0.0; self.sizes().states]
    }
    /// Whether the equations are defined at a state: steps are shortened until they are. By default everywhere.
    fn contains(&self, _z: &[f64], _p: &[f64]) -> bool {
        true
    }
    /// Refuses parameters at which the model does not exist. By default all are welcome.
    fn check(&self, _p: &[f64]) -> Result<(), InvalidParameters> {
        Ok(())
    }
    /// Size of a change of parameter `j` that counts as order one where its value is zero, SI units.
    fn parameter_scale(&self, _j: usize) -> f64 {
        1.0
    }
    /// Number of cycle unknowns, the last of the parameters. By default none.
    fn cycle_unknowns(&self) -> usize {
        0
    }
    /// Outputs whose cycle means stand in the equations of the cycle unknowns.
    fn cycle_outputs(&self) -> Vec<usize> {
        Vec::new()
    }
    /// Writes the equations `R(means, p)` of the cycle unknowns, one entry each; the means in the order of
    /// [`Self::cycle_outputs`].
    fn cycle_residual<T: Number>(&self, _means: &[T], _p: &[T], _residual: &mut [T]) {}
    /// A first guess of the derivatives of `R` by the unknowns in total, the answer of the means included, one row per
    /// equation. By default (`None`) the means are taken to be constant, which needs an `R` that names its unknowns.
    fn cycle_guess(&self, _means: &[f64], _p: &[f64]) -> Option<Vec<Vec<f64>>> {
        None
    }
}

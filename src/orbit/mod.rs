//! The periodic orbit of a [`crate::dae::Dae`]: implicit steps of equal length, marched until the cycle repeats.
//!
//! With `N` steps per period the rate is a backward difference of the last states,
//!
//! ```text
//! z'_n = (a_0 z_n + a_1 z_{n-1} + a_2 z_{n-2}) / dt        BDF1: 1, -1, 0      BDF2: 3/2, -2, 1/2
//! F(t_n, z_n, z'_n; p) = 0,   n = 0 .. N - 1,   indices modulo N
//! ```
//!
//! These `N` equations, not the transient that led to them, are the discrete model: it has no beginning, and gradients
//! are exact for it. BDF2 (Gear 1971) is of second order, stiffly stable, and needs one solve a step.
//!
//! Marching stops as soon as the states that have memory meet those of the cycle before: the rest of the cycle would
//! repeat it. Deliberately not here: acceleration of slow settling, step size control (gradients want frozen steps).

mod quantity;
mod settle;
mod step;

pub use quantity::{Quantity, Reduction};
pub use settle::{Orbit, OrbitError, OrbitOptions, settle};

use crate::dae::Dae;

/// Backward difference formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Implicit Euler, first order, strongly damping.
    Bdf1,
    /// Second order.
    Bdf2,
}

impl Scheme {
    /// Weights of the newest and the two older states.
    pub fn weights(self) -> [f64; 3] {
        match self {
            Self::Bdf1 => [1.0, -1.0, 0.0],
            Self::Bdf2 => [1.5, -2.0, 0.5],
        }
    }

    /// Writes the rate of the states with memory.
    pub fn rate(self, model: &impl Dae, dt_s: f64, newest: [&[f64]; 3], rate: &mut [f64]) {
        let a = self.weights();
        for &i in model.memory() {
            rate[i] = (a[0] * newest[0][i] + a[1] * newest[1][i] + a[2] * newest[2][i]) / dt_s;
        }
    }
}

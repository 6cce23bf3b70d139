//! The periodic orbit of a [`crate::dae::Dae`]: implicit steps of equal length, marched until the cycle repeats.
//!
//! With `N` steps per period the rate of the memory is a backward difference of the last memories,
//!
//! ```text
//! m'_n = (a_0 m_n + a_1 m_{n-1} + a_2 m_{n-2}) / dt,   m_n = M(t_n, z_n; p)       BDF1: 1, -1, 0      BDF2: 3/2, -2, 1/2
//! F(t_n, z_n, m'_n; p) = 0,   n = 0 .. N - 1,   indices modulo N
//! ```
//!
//! These `N` equations, not the transient that led to them, are the discrete model: it has no beginning, and gradients
//! are exact for it. BDF2 (Gear 1971) is of second order, stiffly stable, and needs one solve a step.
//!
//! Marching stops as soon as the memory meets that of the cycle before: the rest of the cycle would
//! repeat it. Deliberately not here: acceleration of slow settling, step size control (gradients want frozen steps).

mod accelerate;
mod balance;
mod carry;
mod march;
mod quantity;
mod settle;
mod step;
mod window;

pub(crate) use carry::{Carry, GONE, Heads};
pub use quantity::{Quantity, Reduction};
pub use settle::{Orbit, OrbitError, OrbitOptions, settle};
pub(crate) use window::BLOCK;
pub use window::{Recording, Window};

use serde::{Deserialize, Serialize};

/// Backward difference formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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

    /// The weights over the step length: share of the newest memory in its rate, and of the two older ones.
    pub fn rates(self, dt_s: f64) -> [f64; 3] {
        self.weights().map(|a| a / dt_s)
    }
}

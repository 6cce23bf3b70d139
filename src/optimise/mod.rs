//! Which design next: constrained optimisation driven by exact gradients.
//!
//! ```text
//! minimise f(x)   subject to   c(x) <= 0,   g(x) = 0,   lower <= x <= upper
//! ```
//!
//! [`Sqp`] is an argmin solver (sequential quadratic programming, Nocedal and Wright 2006, ch. 18) whose sub-problem
//! Clarabel solves. [`DesignProblem`] makes such a problem of bearings: it simulates every case, remembers what it
//! simulated and asks a gradient engine for all rows at once. [`minimise`] joins the two; [`search`] is the door to all methods.
//!
//! Ending is data, not an error: see [`Outcome`]. Deliberately not here: units, files, words for reports.

mod cobyla;
mod curvature;
mod design;
mod lagrangian;
mod methods;
mod outcome;
mod problem;
mod qp;
mod record;
mod sqp;
#[cfg(test)]
mod sqp_tests;
mod starts;
mod state;

pub use curvature::{Curvature, curvature};
pub use design::{Case, DesignProblem, Evaluated, Limit, Sense};
pub use methods::{Budget, Method, SearchOptions, search};
pub use outcome::Outcome;
pub use problem::{ConstrainedProblem, EvaluationError, Slopes, Values};
pub use sqp::{Minimum, Sqp, SqpOptions, minimise};
pub use starts::latin_hypercube;
pub use state::{Multipliers, SqpState};

//! Which design next: constrained optimisation driven by exact gradients.
//!
//! ```text
//! minimise f(x)   subject to   c(x) <= 0,   g(x) = 0,   A x <= b,   lower <= x <= upper
//! ```
//!
//! [`Sqp`] is an argmin solver (sequential quadratic programming, Nocedal and Wright 2006, ch. 18) whose sub-problem
//! Clarabel solves. [`DesignProblem`] makes such a problem of bearings: it simulates every case, remembers what it
//! simulated and asks a gradient engine for all rows at once. [`minimise`] joins the two; [`search`] is the door to all methods.
//!
//! Ending is data, not an error: see [`Outcome`]. Deliberately not here: units, files, words for reports.
//!
//! # A problem of your own
//!
//! Anything with values and gradients can be searched; the example is compiled and held against its closed form in `tests/own_problem.rs`.
//!
//! ```no_run
//! use stribeck::optimise::{
//!     ConstrainedProblem, EvaluationError, Method, Minimum, SearchOptions, Slopes, Values, search,
//! };
//!
//! /// Radius and height of a can, m, that holds a litre with the least sheet and is at most 15 cm high.
//! struct Can;
//!
//! const PI: f64 = std::f64::consts::PI;
//! const LITRE_M3: f64 = 1e-3;
//!
//! impl ConstrainedProblem for Can {
//!     fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
//!         (vec![0.01, 0.01], vec![0.2, f64::INFINITY])
//!     }
//!
//!     /// Sheet in square decimetres; height and volume relative to what is wanted, so that one tolerance judges both.
//!     fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
//!         let (r, h) = (x[0], x[1]);
//!         Ok(Values {
//!             objective: 100.0 * 2.0 * PI * r * (r + h),
//!             inequalities: vec![h / 0.15 - 1.0],
//!             equalities: vec![PI * r * r * h / LITRE_M3 - 1.0],
//!         })
//!     }
//!
//!     fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
//!         let (r, h) = (x[0], x[1]);
//!         Ok(Slopes {
//!             objective: vec![100.0 * 2.0 * PI * (2.0 * r + h), 100.0 * 2.0 * PI * r],
//!             inequalities: vec![vec![0.0, 1.0 / 0.15]],
//!             equalities: vec![vec![2.0 * PI * r * h / LITRE_M3, PI * r * r / LITRE_M3]],
//!         })
//!     }
//! }
//!
//! fn least_sheet(method: Method) -> Minimum {
//!     let options = SearchOptions { method, ..SearchOptions::default() };
//!     let end = search(&Can, &[0.1, 0.05], &options).expect("argmin runs");
//!     println!(
//!         "{:?}: {:?} after {} evaluations, {}",
//!         end.outcome,
//!         end.x,
//!         end.evaluations,
//!         end.outcome.advice()
//!     );
//!     end
//! }
//! ```

mod bundle;
mod case;
mod cobyla;
mod curvature;
mod descent;
mod design;
mod kkt;
mod lagrangian;
mod linear;
#[cfg(test)]
mod linear_tests;
mod memory;
mod methods;
mod minimum;
mod outcome;
mod polish;
mod problem;
mod qp;
mod quasi_newton;
mod record;
mod robust;
mod spread;
mod sqp;
#[cfg(test)]
mod sqp_tests;

mod state;
mod worst;

pub use case::{Case, Evaluated, Limit, Sense, relative_excess};
pub use curvature::{Curvature, curvature};
pub use design::DesignProblem;
pub use linear::{LinearConstraint, Relation};
pub use methods::{Budget, Method, SearchOptions, search};
pub use minimum::Minimum;
pub use outcome::Outcome;
pub use polish::{Polished, polish};
pub use problem::{ConstrainedProblem, Curved, EvaluationError, ManyObjectives, Slopes, Values};
pub use robust::{Margins, Robust};
pub use spread::{latin_hypercube, sobol};
pub use sqp::{Sqp, SqpOptions, minimise};
pub use state::{Multipliers, SqpState};
pub use worst::search_worst;

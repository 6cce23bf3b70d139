//! Algebra that every floor above needs: a periodic spline, the cyclic band solver of the film, fixed points of linear maps, smooth
//! extrema, elementwise work in vectors.
//!
//! Deliberately not here: anything that knows what a bearing is. Small dense systems use nalgebra directly.

mod band;
mod bordered;
mod krylov;
mod power_mean;
mod spline;
mod sweep;
mod vector;

pub use band::{CyclicBand, Singular, Stencil};
pub use bordered::Bordered;
pub use krylov::{FixedPoints, fixed_points};
pub use power_mean::PowerMean;
pub use spline::{PeriodicSpline, SplineError};
pub(crate) use sweep::{Lane, sweep};
pub(crate) use vector::dot;

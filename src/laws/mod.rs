//! Pointwise physics: each law is a small value with its equation, range and source, and gives its value together with
//! its partial derivatives.
//!
//! Deliberately not here: fields, meshes, integrals.

mod combustion;
mod viscosity;

pub use combustion::{Wiebe, heat_capacity_ratio};
pub use viscosity::{OilDataError, Viscosity};

/// 0 degrees Celsius in kelvin.
pub const ZERO_CELSIUS_K: f64 = 273.15;

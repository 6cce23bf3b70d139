//! Pointwise physics: each law is a small value with its equation, range and source, and gives its value together with
//! its partial derivatives.
//!
//! Deliberately not here: fields, meshes, integrals.

mod combustion;
mod contact;
mod contact_integral;
mod density;
mod flow_factors;
mod grades;
mod height_table;
mod normal;
mod partials;
mod patir_cheng;
mod piezoviscosity;
mod roughness_functions;
mod shear_thinning;
#[cfg(test)]
mod taylor;
mod viscosity;

pub use combustion::{Wiebe, heat_capacity_ratio};
pub use contact::{GreenwoodTripp, SummitDataError};
pub use contact_integral::ContactIntegral;
pub use density::Compressibility;
pub use flow_factors::{RoughFilm, RoughSurfaces};
pub use grades::{GRADES, Grade};
pub use partials::Partials;
pub use patir_cheng::RoughnessError;
pub use piezoviscosity::{PiezoFactor, Piezoviscosity};
pub use roughness_functions::{BLEND_WIDTH, FLOW_GAP_FLOOR};
pub use shear_thinning::ShearThinning;
pub use viscosity::{OilDataError, Viscosity};

/// 0 degrees Celsius in kelvin.
pub const ZERO_CELSIUS_K: f64 = 273.15;

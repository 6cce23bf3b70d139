//! From cylinder pressure to the bearing's equations of motion.
//!
//! Slider-crank kinematics and rigid-body statics give the load of big-end and main bearings over the working cycle
//! (inverse dynamics: the crank turns at constant speed). [`JournalBearing`] joins a load, a film and an oil to a
//! periodic system the orbit floor can settle and differentiate.
//!
//! Angles: crank angle in radians after firing top dead centre of the (first) cylinder; a four-stroke cycle is `4 pi`.
//! Deliberately not here: elastic bodies, torsional vibration, speed fluctuation.

mod bearing;
mod load;
mod pressure;
mod rod;
mod slider_crank;
mod vee;
mod working_cycle;

pub use bearing::{
    BearingFactors, BearingOutput, BearingParameter, BearingPoint, BearingRoom, BearingSetup, BearingShape,
    GapSensitivity, HeatBalance, JournalBearing, Smoothing, SurfaceField, Tilt,
};
pub use load::{BearingLoad, Drive, LoadTable};
pub use pressure::CylinderPressure;
pub use rod::{Cylinder, RodForces};
pub use slider_crank::{Kinematics, SliderCrank};
pub use vee::{Bank, CylinderName, FiringError, MainLoad, Throw, VeeEngine};
pub use working_cycle::{WorkingCycle, WorkingCycleError};

/// Crank angle of a four-stroke working cycle.
pub const WORKING_CYCLE_RAD: f64 = 4.0 * std::f64::consts::PI;

//! Cylinder pressure over the working cycle.

use super::{SliderCrank, WORKING_CYCLE_RAD};
use crate::math::{PeriodicSpline, SplineError};

/// Points of the integral for the indicated mean effective pressure.
const IMEP_POINTS: usize = 7200;

/// Pressure in the cylinder as a smooth periodic curve over the crank angle after firing top dead centre.
#[derive(Debug, Clone)]
pub struct CylinderPressure {
    curve: PeriodicSpline,
}

impl CylinderPressure {
    /// Periodic cubic spline through an indicator diagram; crank angles in radians, one cycle without its end point.
    pub fn from_table(crank_angle_rad: Vec<f64>, pressure_pa: Vec<f64>) -> Result<Self, SplineError> {
        Ok(Self { curve: PeriodicSpline::new(crank_angle_rad, pressure_pa, WORKING_CYCLE_RAD)? })
    }

    /// The same diagram with every pressure multiplied, for another operating point.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { curve: self.curve.scaled(factor) }
    }

    /// Absolute pressure in Pa.
    pub fn at(&self, crank_angle_rad: f64) -> f64 {
        self.curve.value(crank_angle_rad)
    }

    /// Indicated mean effective pressure: the work of the cycle per swept volume, Pa.
    pub fn imep_pa(&self, crank: &SliderCrank) -> f64 {
        let step = WORKING_CYCLE_RAD / IMEP_POINTS as f64;
        let work: f64 = (0..IMEP_POINTS)
            .map(|k| k as f64 * step)
            .map(|a| -self.at(a) * crank.at(a).piston_m[1] * step)
            .sum();
        work / crank.stroke_m()
    }

    /// Largest pressure (Pa) and its crank angle (rad), on a grid of a tenth of a degree.
    pub fn peak(&self) -> (f64, f64) {
        (0..7200)
            .map(|k| k as f64 * WORKING_CYCLE_RAD / 7200.0)
            .map(|a| (self.at(a), a))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("the grid has points")
    }
}

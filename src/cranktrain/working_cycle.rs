//! Cylinder pressure of an engine without an indicator diagram: single-zone cycle with Wiebe heat release.
//!
//! Between closing of the inlet and opening of the exhaust, with the charge an ideal gas (first law, Heywood 1988, ch. 9),
//!
//! ```text
//! dp/da = ((gamma - 1) dQ/da - gamma p dV/da) / V,      T = T_1 p V / (p_1 V_1),    gamma = gamma(T)
//! ```
//!
//! `Q` is the net heat release: wall losses are already taken off it. During gas exchange the pressure falls from the one
//! at exhaust opening to the exhaust pressure within about 60 degrees and changes over to the charge pressure around
//! gas-exchange top dead centre; that part only has to be plausible, for it carries no load worth the name.

use super::{CylinderPressure, SliderCrank, WORKING_CYCLE_RAD};
use crate::laws::{Wiebe, heat_capacity_ratio};
use std::f64::consts::PI;
use thiserror::Error;

/// Points of the resulting diagram: one per half degree.
const POINTS: usize = 1440;
/// Width of the bell curve along which the pressure difference at exhaust opening falls.
const BLOWDOWN_RAD: f64 = 15.0 * PI / 180.0;
/// Half of the crank angle of the change-over around gas-exchange top dead centre.
const CHANGE_OVER_RAD: f64 = 20.0 * PI / 180.0;

/// What the cycle is computed from. Angles after firing top dead centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkingCycle {
    /// Cylinder bore, m.
    pub bore_m: f64,
    /// Volume at bottom over volume at top dead centre.
    pub compression_ratio: f64,
    /// Pressure at inlet closing, Pa.
    pub charge_pressure_pa: f64,
    /// Temperature at inlet closing, K.
    pub charge_temperature_k: f64,
    /// Net heat released per cycle and cylinder, J.
    pub heat_release_j: f64,
    /// Timing of the heat release.
    pub wiebe: Wiebe,
    /// Closing of the inlet (before firing top dead centre, so negative), rad.
    pub inlet_closes_rad: f64,
    /// Opening of the exhaust, rad.
    pub exhaust_opens_rad: f64,
    /// Pressure in the exhaust, Pa.
    pub exhaust_pressure_pa: f64,
}

/// A cycle that cannot be computed.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the working cycle cannot be computed: {0}")]
pub struct WorkingCycleError(pub String);

impl WorkingCycle {
    /// Integrates the cycle with the fourth-order Runge-Kutta method on the grid of the diagram.
    pub fn pressure(&self, crank: &SliderCrank) -> Result<CylinderPressure, WorkingCycleError> {
        let step = WORKING_CYCLE_RAD / POINTS as f64;
        let first = (self.inlet_closes_rad / step).ceil() as i64;
        let last = (self.exhaust_opens_rad / step).floor() as i64;
        let mut table = vec![0.0; POINTS];
        // The short way from inlet closing to the first grid point is one step of its own.
        let mut angle = self.inlet_closes_rad;
        let mut p = self.charge_pressure_pa;
        for k in first..=last {
            let next = k as f64 * step;
            p = self.runge_kutta(crank, angle, p, next - angle);
            angle = next;
            table[k.rem_euclid(POINTS as i64) as usize] = p;
        }
        for k in last + 1..first + POINTS as i64 {
            let a = k as f64 * step;
            table[k.rem_euclid(POINTS as i64) as usize] = self.gas_exchange(a, p, last as f64 * step);
        }
        if table.iter().any(|p| !p.is_finite() || *p <= 0.0) {
            return Err(WorkingCycleError("a pressure is not a positive number".into()));
        }
        let angles = (0..POINTS).map(|k| k as f64 * step).collect();
        CylinderPressure::from_table(angles, table).map_err(|e| WorkingCycleError(e.to_string()))
    }

    /// Cylinder volume and its derivative by crank angle.
    fn volume(&self, crank: &SliderCrank, angle: f64) -> (f64, f64) {
        let area = PI / 4.0 * self.bore_m * self.bore_m;
        let dead = area * crank.stroke_m() / (self.compression_ratio - 1.0);
        let [top, ..] = crank.at(0.0).piston_m;
        let [s, slope, _] = crank.at(angle).piston_m;
        (dead + area * (top - s), -area * slope)
    }

    fn slope(&self, crank: &SliderCrank, angle: f64, p: f64) -> f64 {
        let (v, dv) = self.volume(crank, angle);
        let (v1, _) = self.volume(crank, self.inlet_closes_rad);
        let temperature = self.charge_temperature_k * p * v / (self.charge_pressure_pa * v1);
        let (gamma, _) = heat_capacity_ratio(temperature);
        ((gamma - 1.0) * self.heat_release_j * self.wiebe.at(angle).1 - gamma * p * dv) / v
    }

    fn runge_kutta(&self, crank: &SliderCrank, angle: f64, p: f64, step: f64) -> f64 {
        let f = |a: f64, p: f64| self.slope(crank, a, p);
        let k1 = f(angle, p);
        let k2 = f(angle + step / 2.0, p + step / 2.0 * k1);
        let k3 = f(angle + step / 2.0, p + step / 2.0 * k2);
        let k4 = f(angle + step, p + step * k3);
        p + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    }

    fn gas_exchange(&self, angle: f64, opening_pressure: f64, opening: f64) -> f64 {
        let exhaust = self.exhaust_pressure_pa
            + (opening_pressure - self.exhaust_pressure_pa)
                * (-((angle - opening) / BLOWDOWN_RAD).powi(2) / 2.0).exp();
        let y = ((angle - 2.0 * PI) / CHANGE_OVER_RAD).clamp(-1.0, 1.0);
        let share = (1.0 + (y * PI / 2.0).sin()) / 2.0;
        exhaust * (1.0 - share) + self.charge_pressure_pa * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CRANK: SliderCrank = SliderCrank { throw_m: 0.165, rod_m: 0.64, offset_m: 0.0 };

    fn cycle() -> WorkingCycle {
        WorkingCycle {
            bore_m: 0.28,
            compression_ratio: 15.0,
            charge_pressure_pa: 4.0e5,
            charge_temperature_k: 330.0,
            heat_release_j: 1.0e5,
            wiebe: Wiebe { start_rad: -0.05, duration_rad: 1.2, shape: 0.8 },
            inlet_closes_rad: -2.6,
            exhaust_opens_rad: 2.2,
            exhaust_pressure_pa: 3.0e5,
        }
    }

    #[test]
    fn energy_is_conserved_over_the_closed_part() {
        let cycle = cycle();
        let diagram = cycle.pressure(&CRANK).unwrap();
        let (n, low, high) = (40_000, -2.5, 2.1);
        let step = (high - low) / n as f64;
        let (v1, _) = cycle.volume(&CRANK, cycle.inlet_closes_rad);
        let mass_r = cycle.charge_pressure_pa * v1 / cycle.charge_temperature_k;
        let temperature = |a: f64| diagram.at(a) * cycle.volume(&CRANK, a).0 / mass_r;
        let (mut work, mut heat) = (0.0, 0.0);
        for k in 0..n {
            let a = low + (k as f64 + 0.5) * step;
            work += diagram.at(a) * cycle.volume(&CRANK, a).1 * step;
            heat += cycle.heat_release_j * cycle.wiebe.at(a).1 * step;
        }
        let inner: f64 = (0..n)
            .map(|k| low + (k as f64 + 0.5) * step)
            .map(|a| {
                let dt = temperature(a + step / 2.0) - temperature(a - step / 2.0);
                mass_r / (heat_capacity_ratio(temperature(a)).0 - 1.0) * dt
            })
            .sum();
        assert!((heat - work - inner).abs() < 1e-4 * heat, "{heat} {work} {inner}");
    }

    #[test]
    fn motored_cycle_returns_to_its_start_without_work() {
        let motored = WorkingCycle { heat_release_j: 0.0, ..cycle() };
        let diagram = motored.pressure(&CRANK).unwrap();
        for a in [0.3, 1.0, 1.9] {
            assert!((diagram.at(a) / diagram.at(-a) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_fired_cycle_does_work_and_its_pressure_is_smooth() {
        let diagram = cycle().pressure(&CRANK).unwrap();
        let (peak, at) = diagram.peak();
        assert!(diagram.imep_pa(&CRANK) > 1.5e6 && peak > 1.2e7 && at < 0.4, "{peak} at {at}");
        let jump = (0..720)
            .map(|k| k as f64 * WORKING_CYCLE_RAD / 720.0)
            .map(|a| (diagram.at(a + 0.004) - diagram.at(a)).abs())
            .fold(0.0, f64::max);
        assert!(jump < 0.03 * peak);
    }
}

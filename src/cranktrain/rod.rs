//! Forces of one cylinder: piston, connecting rod, crankpin.
//!
//! The rod is replaced by a mass at the piston pin (counted with the oscillating mass) and one at the crankpin; the gas
//! force presses the piston towards the crank. With the rod's direction `u = (cos psi, sin psi)` from big end to small end,
//!
//! ```text
//! S    = ((p - p_crankcase) A + m_osc s'') / cos psi        compression of the rod
//! pin  = -S u + m_rot r omega^2 (cos theta, sin theta)      force of the rod on the crankpin
//! ```

use super::{CylinderPressure, Kinematics, SliderCrank};
use std::f64::consts::PI;
use std::sync::Arc;

/// One cylinder with its running gear.
#[derive(Debug, Clone)]
pub struct Cylinder {
    /// Slider-crank geometry.
    pub crank: SliderCrank,
    /// Bore, m.
    pub bore_m: f64,
    /// Piston, pin, rings and the oscillating share of the rod, kg.
    pub oscillating_mass_kg: f64,
    /// Rotating share of the rod at the crankpin, kg.
    pub rotating_mass_kg: f64,
    /// Absolute pressure below the piston, Pa.
    pub crankcase_pressure_pa: f64,
    /// Absolute pressure above the piston.
    pub pressure: Arc<CylinderPressure>,
}

/// Forces at one crank angle, in the frame of the cylinder (see [`SliderCrank`]), N.
#[derive(Debug, Clone, Copy)]
pub struct RodForces {
    /// Where the mechanism stands.
    pub kinematics: Kinematics,
    /// Gas force on the piston towards the crank.
    pub gas_n: f64,
    /// Compression of the rod.
    pub rod_n: f64,
    /// Force of the liner on the piston, along `y`.
    pub liner_n: f64,
    /// Force of the rod on the crankpin.
    pub pin_n: [f64; 2],
}

impl Cylinder {
    /// Forces at a crank angle after firing top dead centre of this cylinder, at constant speed.
    pub fn forces(&self, crank_angle_rad: f64, speed_rad_s: f64) -> RodForces {
        let kinematics = self.crank.at(crank_angle_rad);
        let area = PI / 4.0 * self.bore_m * self.bore_m;
        let gas_n = (self.pressure.at(crank_angle_rad) - self.crankcase_pressure_pa) * area;
        let acceleration = kinematics.piston_m[2] * speed_rad_s * speed_rad_s;
        let (sin, cos) = kinematics.rod_rad[0].sin_cos();
        let rod_n = (gas_n + self.oscillating_mass_kg * acceleration) / cos;
        let centrifugal = self.rotating_mass_kg * self.crank.throw_m * speed_rad_s * speed_rad_s;
        let (crank_sin, crank_cos) = kinematics.crank_rad.sin_cos();
        RodForces {
            kinematics,
            gas_n,
            rod_n,
            liner_n: -rod_n * sin,
            pin_n: [-rod_n * cos + centrifugal * crank_cos, -rod_n * sin + centrifugal * crank_sin],
        }
    }
}

/// `v` turned by an angle.
pub(super) fn turned(v: [f64; 2], angle_rad: f64) -> [f64; 2] {
    let (s, c) = angle_rad.sin_cos();
    [c * v[0] - s * v[1], s * v[0] + c * v[1]]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in super::super) fn cylinder() -> Cylinder {
        let angles = (0..360).map(|k| k as f64 * super::super::WORKING_CYCLE_RAD / 360.0);
        let pressure =
            angles.clone().map(|a| 3e5 + 1.5e7 * (-(2.0 * a / 2.0).sin().powi(2) * 9.0).exp()).collect();
        Cylinder {
            crank: SliderCrank { throw_m: 0.1075, rod_m: 0.3923, offset_m: 0.004 },
            bore_m: 0.17,
            oscillating_mass_kg: 9.0,
            rotating_mass_kg: 7.0,
            crankcase_pressure_pa: 1e5,
            pressure: Arc::new(CylinderPressure::from_table(angles.collect(), pressure).unwrap()),
        }
    }

    #[test]
    fn forces_on_piston_and_rod_add_up_to_mass_times_acceleration() {
        let (cylinder, omega) = (cylinder(), 157.0);
        for k in 0..360 {
            let a = k as f64 * super::super::WORKING_CYCLE_RAD / 360.0;
            let f = cylinder.forces(a, omega);
            let k = &f.kinematics;
            let pin_acceleration =
                [k.crank_rad.cos(), k.crank_rad.sin()].map(|c| -cylinder.crank.throw_m * omega * omega * c);
            let x = -f.gas_n
                - f.pin_n[0]
                - cylinder.oscillating_mass_kg * k.piston_m[2] * omega * omega
                - cylinder.rotating_mass_kg * pin_acceleration[0];
            let y = f.liner_n - f.pin_n[1] - cylinder.rotating_mass_kg * pin_acceleration[1];
            assert!(x.abs().max(y.abs()) < 1e-8, "{x} {y}");
        }
    }

    #[test]
    fn a_static_piston_puts_the_gas_force_on_the_pin() {
        let f = cylinder().forces(0.0, 0.0);
        assert!((f.pin_n[0] + f.gas_n).abs() < 1e-9 * f.gas_n && f.gas_n > 3e5);
    }
}

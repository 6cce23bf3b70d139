//! What drives a bearing over the working cycle: load in the frame of its shell, and speeds.

use super::rod::turned;
use super::{Cylinder, MainLoad, WORKING_CYCLE_RAD};
use crate::math::PeriodicSpline;

/// State of the drive at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Drive {
    /// Load of the journal on the shell, in the frame of the shell, N. The journal gives way in this direction.
    pub load_n: [f64; 2],
    /// Angular speed of the journal relative to the shell, rad/s.
    pub relative_speed_rad_s: f64,
    /// Angular speed of the shell, rad/s.
    pub shell_speed_rad_s: f64,
    /// Angular acceleration of the shell, rad/s2.
    pub shell_acceleration_rad_s2: f64,
    /// How far the journal has turned in the frame of the shell since firing top dead centre, rad.
    pub journal_angle_rad: f64,
}

/// A load given over the crank angle, in the frame of a shell at rest.
#[derive(Debug, Clone)]
pub struct LoadTable {
    /// Load of the journal on the shell along `x` over the crank angle in rad, N.
    pub x: PeriodicSpline,
    /// The same along `y`.
    pub y: PeriodicSpline,
}

/// Where the load of a bearing comes from.
#[derive(Debug, Clone)]
pub enum BearingLoad {
    /// Big end of a connecting rod. The shell turns with the rod; its `x` axis points to the small end, so `phi = 0` is the
    /// rod's half of the shell and `phi = 180 deg` the cap.
    BigEnd(Cylinder),
    /// Main bearing, shell at rest in the crankcase (`x` axis on the symmetry plane of the banks, pointing up).
    Main(MainLoad),
    /// A table.
    Table(LoadTable),
}

impl BearingLoad {
    /// Crank angle after which the load repeats.
    pub fn cycle_rad(&self) -> f64 {
        match self {
            Self::Table(table) => table.x.period(),
            _ => WORKING_CYCLE_RAD,
        }
    }

    /// The drive at a crank angle, the crank turning at constant speed.
    pub fn at(&self, crank_angle_rad: f64, speed_rad_s: f64) -> Drive {
        match self {
            Self::BigEnd(cylinder) => {
                let forces = cylinder.forces(crank_angle_rad, speed_rad_s);
                let [rod, d1, d2] = forces.kinematics.rod_rad;
                Drive {
                    // The pin pushes back on the shell.
                    load_n: turned(forces.pin_n.map(|f| -f), -rod),
                    relative_speed_rad_s: speed_rad_s * (1.0 - d1),
                    shell_speed_rad_s: speed_rad_s * d1,
                    shell_acceleration_rad_s2: speed_rad_s * speed_rad_s * d2,
                    journal_angle_rad: crank_angle_rad - rod,
                }
            }
            Self::Main(main) => Drive {
                load_n: main.engine.main_load_n(main.main, crank_angle_rad, speed_rad_s),
                relative_speed_rad_s: speed_rad_s,
                journal_angle_rad: crank_angle_rad,
                ..Default::default()
            },
            Self::Table(table) => Drive {
                load_n: [table.x.value(crank_angle_rad), table.y.value(crank_angle_rad)],
                relative_speed_rad_s: speed_rad_s,
                journal_angle_rad: crank_angle_rad,
                ..Default::default()
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::rod::tests::cylinder;
    use super::*;

    #[test]
    fn big_end_load_has_the_size_of_the_pin_load_and_its_shell_turns_with_the_rod() {
        let load = BearingLoad::BigEnd(cylinder());
        let mut turn = 0.0;
        let n = 720;
        for k in 0..n {
            let a = k as f64 * WORKING_CYCLE_RAD / n as f64;
            let drive = load.at(a, 157.0);
            let pin = cylinder().forces(a, 157.0).pin_n;
            let (size, expected) = (drive.load_n[0].hypot(drive.load_n[1]), pin[0].hypot(pin[1]));
            assert!((size - expected).abs() < 1e-9 * expected);
            assert!((drive.relative_speed_rad_s + drive.shell_speed_rad_s - 157.0).abs() < 1e-12);
            let later =
                load.at(a + 1e-6, 157.0).journal_angle_rad - load.at(a - 1e-6, 157.0).journal_angle_rad;
            assert!(
                (later / 2e-6 * 157.0 - drive.relative_speed_rad_s).abs() < 1e-5,
                "angle and speed belong together"
            );
            turn += drive.shell_speed_rad_s / n as f64;
        }
        assert!(turn.abs() < 1e-9, "the rod swings back: {turn}");
    }

    #[test]
    fn at_firing_the_pin_is_pressed_into_the_rod_half_of_the_shell() {
        let drive = BearingLoad::BigEnd(cylinder()).at(0.0, 50.0);
        assert!(drive.load_n[0] > 1e5 && drive.load_n[1].abs() < 0.1 * drive.load_n[0]);
    }
}

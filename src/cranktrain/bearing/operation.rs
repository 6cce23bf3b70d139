//! How a bearing answers to its operating point: load factor and speed of the crankshaft as parameters.
//!
//! The load is linear in its factor, `L = L_0 + f (L_1 - L_0)` with the load `L_0` of a machine that is not fired. At a given crank
//! angle, and only that is asked for, since steps are shares of the cycle,
//!
//! ```text
//! dL/dw = 2 (L(w) - L(0)) / w,    dm'/dw = m'/w,    dW/dw = W/w (angular speeds),    dW'/dw = 2 W'/w (accelerations)
//! ```
//!
//! because inertia grows with the square of the speed and every rate of the memory with the speed itself.

use super::fields::{LOAD_FACTOR, SPEED};
use super::{BearingParameter, JournalBearing, Layout};
use crate::cranktrain::Drive;
use crate::dae::At;
use crate::film::{FilmCotangent, FilmInput};

/// Derivatives at a point of a trajectory, by load factor or by speed.
pub(super) struct Answer {
    /// Of the load, N.
    pub load_n: [f64; 2],
    /// Of the relative speed, 1.
    pub relative_speed: f64,
    /// Rates of the memory change by this share of themselves.
    pub rate_share: f64,
}

impl JournalBearing {
    /// Whether load factor or speed are parameters.
    pub(super) fn operation_varies(&self) -> bool {
        let varies =
            |p: &BearingParameter| matches!(p, BearingParameter::LoadFactor | BearingParameter::Speed);
        self.setup.parameters.iter().any(varies)
    }

    /// Derivatives by the load factor.
    pub(super) fn by_load_factor(&self, t_s: f64) -> Answer {
        let (s, angle) = (&self.setup, t_s * self.setup.speed_rad_s);
        let full = s.load.at(angle, s.speed_rad_s).load_n;
        let none = s.idle.as_ref().map_or(full, |idle| idle.at(angle, s.speed_rad_s).load_n);
        Answer { load_n: [0, 1].map(|a| full[a] - none[a]), relative_speed: 0.0, rate_share: 0.0 }
    }

    /// Derivatives by the speed of the crankshaft.
    pub(super) fn by_speed(&self, t_s: f64) -> Answer {
        let speed = self.setup.speed_rad_s;
        let (now, still) = (self.drive(t_s), self.drive_at(t_s * speed, 0.0));
        Answer {
            load_n: [0, 1].map(|a| 2.0 * (now.load_n[a] - still.load_n[a]) / speed),
            relative_speed: now.relative_speed_rad_s / speed,
            rate_share: 1.0 / speed,
        }
    }

    /// The drive at a crank angle and speed.
    pub(super) fn drive_at(&self, angle_rad: f64, speed_rad_s: f64) -> Drive {
        let s = &self.setup;
        let mut drive = s.load.at(angle_rad, speed_rad_s);
        if let Some(idle) = &s.idle {
            let none = idle.at(angle_rad, speed_rad_s).load_n;
            for (load, none) in drive.load_n.iter_mut().zip(none) {
                *load = none + s.load_factor * (*load - none);
            }
        }
        drive
    }

    /// Derivative of the border rows (those below the film's), without the film's loads.
    pub(super) fn border_by(&self, at: At, answer: &Answer) -> Vec<f64> {
        let l: Layout = self.layout;
        let (sign, row) = l.force_row();
        let mut out = vec![0.0; l.border()];
        for a in 0..2 {
            out[row + a] = sign * answer.load_n[a];
        }
        if l.mass && answer.rate_share != 0.0 {
            let (drive, share) = (self.drive(at.t_s), answer.rate_share);
            let (e, v) = (self.pair(at.z, 0), self.pair(at.z, 1));
            let dv = [at.rate[l.n + 2], at.rate[l.n + 3]];
            let m = self.setup.journal_mass_kg;
            let (o, o1) = (drive.shell_speed_rad_s, drive.shell_acceleration_rad_s2);
            let by = [
                dv[0] - 2.0 * o * v[1] - 2.0 * (o1 * e[1] + o * o * e[0]),
                dv[1] + 2.0 * o * v[0] + 2.0 * (o1 * e[0] - o * o * e[1]),
            ];
            for a in 0..2 {
                out[a] = at.rate[l.n + a] * share;
                out[row + a] += m * by[a] * share;
            }
        }
        out
    }

    /// Adds to the rows of the border what changes of load factor and speed do to them.
    pub(super) fn push_operation(&self, at: At, du: &[f64], border: &mut [f64]) {
        let changes = [(du[LOAD_FACTOR], true), (du[SPEED], false)];
        for (d, of_load) in changes.into_iter().filter(|(d, _)| *d != 0.0) {
            let answer = if of_load { self.by_load_factor(at.t_s) } else { self.by_speed(at.t_s) };
            border.iter_mut().zip(self.border_by(at, &answer)).for_each(|(b, by)| *b += d * by);
        }
    }

    /// Adds a change of the speed to what the film sees; returns the change of the rates of its contents, empty for none.
    pub(super) fn faster(&self, at: At, d: f64, input: &mut FilmInput) -> Vec<f64> {
        if d == 0.0 {
            return Vec::new();
        }
        let (n, by) = (self.layout.n, self.by_speed(at.t_s));
        input.speed_rad_s += d * by.relative_speed;
        for a in 0..2 {
            input.velocity_m_s[a] += d * by.rate_share * at.rate[n + a];
        }
        at.rate[..n].iter().map(|r| d * by.rate_share * r).collect()
    }

    /// The derivative by the speed in derivatives by what the film sees: the transpose of [`Self::faster`].
    pub(super) fn faster_back(&self, at: At, bar: &FilmCotangent) -> f64 {
        let (n, by) = (self.layout.n, self.by_speed(at.t_s));
        let velocity: f64 = (0..2).map(|a| bar.input.velocity_m_s[a] * at.rate[n + a]).sum();
        let contents: f64 = bar.rate.iter().zip(at.rate).map(|(b, r)| b * r).sum();
        bar.input.speed_rad_s * by.relative_speed + by.rate_share * (velocity + contents)
    }

    /// Derivatives of the specific load by load factor and speed.
    pub(super) fn specific_load_by(&self, t_s: f64) -> [f64; 2] {
        let [x, y] = self.drive(t_s).load_n;
        let per_force = 1.0 / (x.hypot(y) * self.setup.width_m * self.setup.diameter_m);
        [self.by_load_factor(t_s), self.by_speed(t_s)]
            .map(|by| (x * by.load_n[0] + y * by.load_n[1]) * per_force)
    }
}

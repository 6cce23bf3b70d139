//! A better guess for a step at which Newton's method on everything together fails.
//!
//! At a fixed motion the film alone is a well-behaved problem, and what is left are two (with tilt four) equations for the
//! motion, solved here on the outside: the film is settled at every trial, the motion takes Newton steps with the film
//! eliminated, shortened until the unbalanced load falls, and never longer than a share of the gap. A film that carries
//! nothing at all (ruptured everywhere) tells no direction: then the journal gives way along its load.
//!
//! What is found is only a guess: the step itself is solved by the stepper.

use super::JournalBearing;
use super::model::inertia;
use crate::dae::Step;
use crate::film::{FilmLinear, up_to_the_switch};
use crate::math::CyclicBand;
use nalgebra::{DMatrix, DVector};

/// Motions tried.
const MOTIONS: usize = 60;
/// Newton iterations of the film at a fixed motion.
const FILM: usize = 40;
/// Film iterations that are taken in full.
const FREE: usize = 8;
/// A change below this is good enough for a guess.
const CLOSE: f64 = 1e-7;
/// Share of every gap that one motion leaves.
const KEEP: f64 = 0.5;
/// Trials of one motion, each more damped.
const TRIALS: usize = 14;
/// Damping of the second trial, as a share of the slope.
const FIRST_DAMPING: f64 = 1e-4;

struct Search<'a> {
    bearing: &'a JournalBearing,
    step: Step<'a>,
    linear: FilmLinear,
    solver: CyclicBand,
}

/// A motion with the film settled at it.
#[derive(Clone)]
struct Trial {
    z: Vec<f64>,
    /// Unbalanced load.
    unbalance: DVector<f64>,
    /// Its derivative by the motion.
    slope: DMatrix<f64>,
}

/// Improves the guess `z` of a step; whether that worked.
pub(super) fn rescue(bearing: &JournalBearing, step: Step, z: &mut [f64]) -> bool {
    let (blocks, b) = bearing.setup.film.shape();
    if blocks == 0 {
        return false;
    }
    let linear = FilmLinear::new(bearing.layout.n, bearing.layout.motions);
    let mut search = Search { bearing, step, linear, solver: CyclicBand::new(blocks, b) };
    let Some(mut now) = search.settle(z.to_vec()) else { return false };
    for _ in 0..MOTIONS {
        let Some((next, size)) = search.advance(&now) else { break };
        now = next;
        if size < CLOSE {
            z.copy_from_slice(&now.z);
            return true;
        }
    }
    z.copy_from_slice(&now.z);
    false
}

impl Search<'_> {
    /// Settles the film at the motion of `z`.
    fn settle(&mut self, mut z: Vec<f64>) -> Option<Trial> {
        let (n, film) = (self.bearing.layout.n, &self.bearing.setup.film);
        let (mut room, mut last, mut share) = (Vec::new(), f64::INFINITY, 1.0f64);
        for iteration in 0..FILM {
            let input = self.bearing.input(self.step.t_s, &z, [0.0; 2]);
            let site = self.bearing.site(self.step.t_s, input, &mut room);
            film.linearise(&site, &z[..n], self.step.alpha, &self.step.past[..n], &mut self.linear);
            self.solver.factor(&self.linear.stencil).ok()?;
            self.solver.solve(&mut self.linear.residual);
            let change = film.change(&z[..n], &self.linear.residual);
            if !change.is_finite() {
                return None;
            }
            let stuck = iteration > FREE && change > 0.7 * last;
            share = if stuck { (share / 2.0).max(0.05) } else { (2.0 * share).min(1.0) };
            last = change;
            let step = z.iter_mut().zip(&self.linear.residual);
            step.for_each(|(q, d)| *q = up_to_the_switch(*q, *q - share * d));
            if change < CLOSE {
                return Some(self.trial(z));
            }
        }
        None
    }

    /// Unbalanced load and its slope, the film eliminated.
    fn trial(&mut self, mut z: Vec<f64>) -> Trial {
        let (l, n, step) = (self.bearing.layout, self.bearing.layout.n, self.step);
        let (d, drive) = (l.motions, self.bearing.drive(step.t_s));
        self.solver.solve(&mut self.linear.columns);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut slope = DMatrix::from_fn(d, d, |i, j| {
            let row = &self.linear.rows[i * n..(i + 1) * n];
            dot(row, &self.linear.columns[j * n..(j + 1) * n]) - self.linear.corner[i][j]
        });
        let mut unbalance =
            DVector::from_fn(d, |i, _| -self.linear.loads[i] - if i < 2 { drive.load_n[i] } else { 0.0 });
        if l.mass {
            let m = self.bearing.setup.journal_mass_kg;
            let e = [z[n], z[n + 1]];
            let v = [0, 1].map(|a| step.alpha * e[a] + step.past[n + a]);
            let dv = [0, 1].map(|a| step.alpha * v[a] + step.past[n + 2 + a]);
            let force = inertia(&drive, m, e, v, dv);
            let (o, o1) = (drive.shell_speed_rad_s, drive.shell_acceleration_rad_s2);
            for a in 0..2 {
                let turn = if a == 0 { -1.0 } else { 1.0 };
                unbalance[a] += force[a];
                slope[(a, a)] += m * (step.alpha * step.alpha - o * o);
                slope[(a, 1 - a)] += turn * m * (2.0 * o * step.alpha + o1);
                z[n + d + a] = v[a];
            }
        }
        Trial { z, unbalance, slope }
    }

    /// One motion that lowers the unbalanced load; returns it and its size against the clearance.
    fn advance(&mut self, now: &Trial) -> Option<(Trial, f64)> {
        let (n, d) = (self.bearing.layout.n, self.bearing.layout.motions);
        let clearance = self.bearing.setup.diametral_clearance_m / 2.0;
        let empty = now.slope.iter().all(|s| *s == 0.0);
        for k in 0..TRIALS {
            let motion = self.direction(now, k);
            let share = self.bearing.motion_share(&now.z, motion, KEEP);
            let mut z = now.z.clone();
            (0..d).for_each(|a| z[n + a] += share * motion[a]);
            let Some(trial) = self.settle(z) else { continue };
            let size = share * motion[0].hypot(motion[1]) / clearance;
            let better = trial.unbalance.norm() < now.unbalance.norm();
            // A film that carries nothing does not answer until the journal has come near enough.
            if better || size < CLOSE || empty && trial.unbalance.norm() <= now.unbalance.norm() {
                return Some((trial, if k == 0 && share == 1.0 { size } else { size.max(2.0 * CLOSE) }));
            }
        }
        None
    }

    /// Newton's motion, damped after Levenberg and Marquardt from the second trial on; the way the load pushes where
    /// the film gives no answer.
    fn direction(&self, now: &Trial, trial: usize) -> [f64; 4] {
        let clearance = self.bearing.setup.diametral_clearance_m / 2.0;
        let mut motion = [0.0; 4];
        let damping =
            if trial == 0 { 0.0 } else { now.slope.norm() * FIRST_DAMPING * 4f64.powi(trial as i32) };
        let square = now.slope.transpose() * &now.slope
            + DMatrix::identity(now.slope.nrows(), now.slope.nrows()) * (damping * damping);
        let step = square.cholesky().map(|c| c.solve(&-(now.slope.transpose() * &now.unbalance)));
        match step.filter(|s| s.iter().all(|v| v.is_finite())) {
            Some(step) => step.iter().enumerate().for_each(|(a, v)| motion[a] = *v),
            None => {
                // Unbalance is (inertia - force - load): what is missing points along the load.
                let push = -now.unbalance.rows(0, 2);
                let reach = clearance / 2f64.powi(trial as i32) / push.norm().max(f64::MIN_POSITIVE);
                (0..2).for_each(|a| motion[a] = push[a] * reach);
            }
        }
        motion
    }
}

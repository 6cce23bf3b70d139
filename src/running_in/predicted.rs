//! The march with predictions: most cycles come from a basis of earlier ones, and one solved cycle per window checks them.
//!
//! ```text
//! predict:   dw/dt = k^(w),  dE/dt = P^(w)  over a window h,   k^, P^ from the basis, Runge and Kutta's method in small steps
//! check:     solve the cycle with the surfaces reached, enter it into the basis,   error = h/2 max |k - k^|
//! correct:   over the window once more, with the basis as it is now
//! ```
//!
//! The error supposes that the prediction errs in proportion to time, as it does where the basis is left behind. The corrected
//! window errs by about half of it, a block of Heun's method by far less than its own estimate; to give the same surfaces a window
//! may therefore err by a share of the tolerance only. Windows that err by more are refused and shortened, but what was solved for
//! them stays in the basis. Solved cycles start from predicted ones.

use super::basis::Basis;
use super::field::{flat, largest, moved, split};
use super::march::{Course, SHORTEST, first_guess_s, follows_s, wanted_s};
use super::stage::{MarchError, MarchOptions, Stage};
use super::walk::Walk;
use crate::cranktrain::SurfaceField;
use crate::run::Cancel;

/// Share of the tolerance that a window may err by.
const SHARE: f64 = 0.5;
/// Steps of a window in the reduced space.
const STEPS: usize = 32;

/// A programme gone through with predictions.
#[derive(Debug, Clone)]
pub struct PredictedMarch {
    /// How it went.
    pub course: Course,
    /// Windows: each has one solved cycle, and a predicted one at its corrected end.
    pub windows: usize,
    /// Largest error of the depth of any window, m.
    pub error_m: f64,
}

/// Surfaces and energy at the end of a window.
struct Reached {
    worn_m: SurfaceField,
    energy_j: f64,
}

/// Goes through a programme with predictions, `tell` is called with the time after every window, s.
pub fn march_predicted(
    stages: &[Stage],
    options: &MarchOptions,
    cancel: &Cancel,
    tell: &mut dyn FnMut(f64),
) -> Result<PredictedMarch, MarchError> {
    let mut walk = Walk::new(stages, options, None, cancel)?;
    let (mut windows, mut error_m) = (0, 0.0f64);
    let tolerance_m = SHARE * options.tolerance_m;
    let mut length_s = None;
    for (stage, at) in stages.iter().enumerate() {
        let mut basis = Basis::default();
        let first = walk.begin(stage)?;
        basis.add(&walk.worn_m, &options.depths(&first), first.clone());
        let guess = first_guess_s(&options.depths(&first), options.tolerance_m);
        let (mut gone_s, mut loss_w) = (0.0, first.loss_w());
        while gone_s < at.duration_s * (1.0 - SHORTEST) {
            let rest_s = at.duration_s - gone_s;
            let mut h: f64 = length_s.unwrap_or(guess).min(rest_s);
            let (checked, wanted) = loop {
                let reached = over(&basis, &walk.worn_m, h);
                let k = split(&basis.predict(&flat(&reached.worn_m)).speed, &reached.worn_m);
                let near = basis.guess(&reached.worn_m);
                let solved = walk.rate_from(stage, Some(&reached.worn_m), near.as_ref())?;
                let depths = options.depths(&solved);
                let error = 0.5 * h * largest(&moved(&depths, -1.0, &k));
                basis.add(&reached.worn_m, &depths, solved.clone());
                let wanted = wanted_s(h, error, tolerance_m);
                if error <= tolerance_m || h <= SHORTEST * at.duration_s {
                    error_m = error_m.max(error);
                    break (solved, wanted);
                }
                walk.refused += 1;
                h = wanted;
            };
            length_s = Some(follows_s(h, rest_s, wanted, length_s));
            let before = walk.worn_m.clone();
            let corrected = over(&basis, &walk.worn_m, h);
            gone_s += h;
            walk.pass(stage, corrected.worn_m, corrected.energy_j, h, &checked)?;
            windows += 1;
            tell(walk.from_s);
            if options.nothing_new(h, (loss_w, &before), (checked.loss_w(), &walk.worn_m)) {
                break;
            }
            loss_w = checked.loss_w();
        }
        let start = basis.guess(&walk.worn_m);
        let end = walk.rate_from(stage, None, start.as_ref())?;
        walk.end(end);
    }
    Ok(PredictedMarch { course: walk.finish()?.course, windows, error_m })
}

/// Over a window with what the basis predicts (Runge and Kutta's method of fourth order).
fn over(basis: &Basis, from: &SurfaceField, length_s: f64) -> Reached {
    let mut w = flat(from);
    let (dt, mut energy_j) = (length_s / STEPS as f64, 0.0);
    let along =
        |w: &[f64], h: f64, k: &[f64]| -> Vec<f64> { w.iter().zip(k).map(|(w, k)| w + h * k).collect() };
    for _ in 0..STEPS {
        let one = basis.predict(&w);
        let two = basis.predict(&along(&w, 0.5 * dt, &one.speed));
        let three = basis.predict(&along(&w, 0.5 * dt, &two.speed));
        let four = basis.predict(&along(&w, dt, &three.speed));
        for (i, w) in w.iter_mut().enumerate() {
            let mean = (one.speed[i] + 2.0 * (two.speed[i] + three.speed[i]) + four.speed[i]) / 6.0;
            *w += dt * mean;
        }
        energy_j += dt * (one.loss_w + 2.0 * (two.loss_w + three.loss_w) + four.loss_w) / 6.0;
    }
    Reached { worn_m: split(&w, from), energy_j }
}

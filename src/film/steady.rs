//! The film at a given journal position and velocity: pressure, force and the classical dimensionless numbers.

use super::{FilmInput, FilmModel, FilmOutput};
use crate::math::{CyclicBand, Singular, Stencil};
use thiserror::Error;

/// Iterations after which the active set is declared not to settle.
const MOST_ITERATIONS: usize = 200;

/// A film solved at one instant.
#[derive(Debug, Clone)]
pub struct SteadyState {
    /// The film's unknowns.
    pub q: Vec<f64>,
    /// What the film answers.
    pub output: FilmOutput,
    /// Newton iterations, one factorisation each.
    pub iterations: usize,
}

/// Why a film could not be solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SteadyError {
    /// The matrix collapsed.
    #[error(transparent)]
    Singular(#[from] Singular),
    /// The cavitated region did not settle.
    #[error("the cavitated region did not settle within {MOST_ITERATIONS} iterations")]
    NotSettled,
}

/// Solves `r(q, u) = 0` for `q` from `q = 0`.
pub fn steady(film: &dyn FilmModel, u: &FilmInput) -> Result<SteadyState, SteadyError> {
    let (blocks, b) = film.shape();
    let n = blocks * b;
    let mut q = vec![0.0; n];
    if n == 0 {
        return Ok(SteadyState { output: film.output(u, &q), q, iterations: 0 });
    }
    let (mut stencil, mut solver) = (Stencil::zeros(n), CyclicBand::new(blocks, b));
    let mut step = vec![0.0; n];
    for iterations in 1..=MOST_ITERATIONS {
        film.residual(u, &q, &mut step);
        film.stencil(u, &q, &mut stencil);
        solver.factor(&stencil)?;
        solver.solve(&mut step);
        let largest = q.iter().fold(0.0f64, |a, q| a.max(q.abs()));
        let change = step.iter().fold(0.0f64, |a, s| a.max(s.abs()));
        q.iter_mut().zip(&step).for_each(|(q, s)| *q -= s);
        if step.iter().any(|s| !s.is_finite()) {
            return Err(SteadyError::NotSettled);
        }
        if change <= 1e-11 * largest {
            return Ok(SteadyState { output: film.output(u, &q), q, iterations });
        }
    }
    Err(SteadyError::NotSettled)
}

impl FilmInput {
    /// A journal at eccentricity ratio `eps` in the direction `(1, 0)`, turning at `speed_rad_s`, at rest otherwise.
    pub fn at_rest(
        eps: f64,
        width_m: f64,
        diameter_m: f64,
        clearance_m: f64,
        viscosity_pa_s: f64,
        speed_rad_s: f64,
    ) -> Self {
        Self {
            eccentricity_m: [eps * clearance_m, 0.0],
            velocity_m_s: [0.0; 2],
            speed_rad_s,
            width_m,
            diameter_m,
            clearance_m,
            viscosity_pa_s,
        }
    }

    /// Sommerfeld number `F Psi^2 / (B D eta omega)` of a force, with `Psi = 2 C / D`.
    pub fn sommerfeld(&self, force_n: f64, rate_rad_s: f64) -> f64 {
        let psi = 2.0 * self.clearance_m / self.diameter_m;
        force_n * psi * psi / (self.width_m * self.diameter_m * self.viscosity_pa_s * rate_rad_s.abs())
    }
}

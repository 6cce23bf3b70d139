//! The film at a given journal position and velocity: pressure, force and the classical dimensionless numbers.
//!
//! Newton's method from an empty start. Where it does not settle (a starved cavity can make the active set go in
//! circles), the film is marched in pseudo-time instead: the content's storage, `alpha (c - c_last)`, makes every row
//! dominant; `alpha` falls from step to step until it is gone. What is solved in the end is the same equation.

use super::cavitation::up_to_the_switch;
use super::{FilmChange, FilmInput, FilmLinear, FilmModel, FilmOutput, FilmSite};
use crate::math::{CyclicBand, Singular};
use thiserror::Error;

/// Newton iterations before pseudo-time is tried, and in each of its steps.
const NEWTON: usize = 40;
/// Steps in pseudo-time.
const PSEUDO_STEPS: usize = 400;
/// A relative change below this is convergence: what is left is its square.
const SETTLED: f64 = 1e-11;

/// A fill below zero by more than this is no rounding.
const DRY: f64 = 1e-9;

/// A film solved at one instant.
#[derive(Debug, Clone)]
pub struct SteadyState {
    /// The film's unknowns.
    pub q: Vec<f64>,
    /// Rate of the content that belongs to the velocity, m/s.
    pub rate: Vec<f64>,
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
    #[error("the cavitated region did not settle; refine the mesh or check the oil supply")]
    NotSettled,
    /// More oil leaves than is offered: there is no steady film.
    #[error("the bearing runs dry: no oil is offered; give it a supply or a pressure at the edges")]
    Dry,
    /// A cavity that changes with time has no steady state.
    #[error("a mass-conserving film has no steady state while the journal moves; march it in time")]
    Moving,
}

/// Solves a cylindrical, aligned film at `u`.
pub fn steady(film: &dyn FilmModel, u: &FilmInput) -> Result<SteadyState, SteadyError> {
    steady_at(film, &FilmSite::from(*u), None)
}

/// Solves `r(q, site) = 0` for `q`, from the unknowns of a similar film or from an empty start.
pub fn steady_at(
    film: &dyn FilmModel,
    site: &FilmSite,
    start: Option<&[f64]>,
) -> Result<SteadyState, SteadyError> {
    let (blocks, b) = film.shape();
    let n = blocks * b;
    let q = start.map_or_else(|| vec![0.0; n], <[f64]>::to_vec);
    if n == 0 {
        return Ok(SteadyState { output: film.output(site, &q), q, rate: Vec::new(), iterations: 0 });
    }
    if film.conserves_mass() && site.input.velocity_m_s != [0.0; 2] {
        return Err(SteadyError::Moving);
    }
    let mut search = Search {
        film,
        site,
        linear: FilmLinear::new(n, 2),
        solver: CyclicBand::new(blocks, b),
        rate: vec![0.0; n],
        iterations: 0,
    };
    let mut found = q.clone();
    if !search.newton(&mut found, 0.0, None)? {
        // Only a content that remembers its fill gives pseudo-time something to hold on to.
        if !film.conserves_mass() {
            return Err(SteadyError::NotSettled);
        }
        found = q;
        search.march(&mut found)?;
    }
    if film.conserves_mass() && film.least_fill(&found) < -DRY {
        return Err(SteadyError::Dry);
    }
    let Search { rate, iterations, .. } = search;
    Ok(SteadyState { output: film.output(site, &found), q: found, rate, iterations })
}

struct Search<'a> {
    film: &'a dyn FilmModel,
    site: &'a FilmSite<'a>,
    linear: FilmLinear,
    solver: CyclicBand,
    rate: Vec<f64>,
    iterations: usize,
}

impl Search<'_> {
    /// Content's rate that belongs to the journal's velocity at fixed fill.
    fn squeeze(&mut self, q: &[f64]) {
        let velocity = self.site.input.velocity_m_s;
        if velocity != [0.0; 2] {
            let input = FilmInput { eccentricity_m: velocity, ..Default::default() };
            let change = FilmChange { q: &[], rate: &[], input, shape_m: &[], shell_left: &[] };
            self.rate = self.film.tangent(self.site, q, &self.rate, &change).content;
        }
    }

    /// Newton's method with storage `alpha (c - last)`; whether it settled.
    fn newton(&mut self, q: &mut [f64], alpha: f64, last: Option<&[f64]>) -> Result<bool, SteadyError> {
        let mut past = vec![0.0; q.len()];
        // The edge of a Swift-Stieber film moves by a column an iteration, around half the bearing at most.
        let most = if last.is_none() { NEWTON.max(self.film.shape().0) } else { NEWTON };
        for _ in 0..most {
            self.squeeze(q);
            for (k, past) in past.iter_mut().enumerate() {
                *past = self.rate[k] - last.map_or(0.0, |c| alpha * c[k]);
            }
            self.film.linearise(self.site, q, alpha, &past, &mut self.linear);
            self.iterations += 1;
            if self.solver.factor(&self.linear.stencil).is_err() {
                return Ok(false);
            }
            let step = &mut self.linear.residual;
            self.solver.solve(step);
            if step.iter().any(|s| !s.is_finite()) {
                return Ok(false);
            }
            let change = self.film.change(q, step);
            q.iter_mut().zip(&*step).for_each(|(q, s)| *q = up_to_the_switch(*q, *q - s));
            if change <= SETTLED {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn march(&mut self, q: &mut [f64]) -> Result<(), SteadyError> {
        let mut alpha = self.site.input.speed_rad_s.abs().max(1.0);
        let mut content = vec![0.0; q.len()];
        for _ in 0..PSEUDO_STEPS {
            self.film.content(self.site, q, &mut content);
            let before = q.to_vec();
            if !self.newton(q, alpha, Some(&content))? {
                q.copy_from_slice(&before);
                alpha *= 4.0;
                continue;
            }
            alpha *= 0.5;
            let mut last = q.to_vec();
            if alpha < 0.05 * self.site.input.speed_rad_s.abs().max(1.0)
                && self.newton(&mut last, 0.0, None)?
            {
                q.copy_from_slice(&last);
                return Ok(());
            }
        }
        Err(SteadyError::NotSettled)
    }
}

//! One implicit step: Newton's method on `F(t_n, z_n, z'_n) = 0`.
//!
//! The step is damped only as far as the model needs to stay defined. If Newton fails from the guess, the way from the
//! last state to the new one is walked in short implicit Euler steps to find a better one; the equation that is solved in
//! the end stays the same, so the result does not depend on how it was found.

use super::Scheme;
use crate::dae::{At, LinearisedDae};
use crate::run::Cost;

/// A change below this ends the iteration; convergence is quadratic, so the error left is about its square.
const TOLERANCE: f64 = 1e-8;
/// Iterations of one attempt.
const MOST_ITERATIONS: usize = 40;
/// Implicit Euler steps of the rescue.
const SHORT_STEPS: usize = 16;

/// Workspace and counters of a march.
pub(super) struct Stepper<'m, M: LinearisedDae> {
    model: &'m M,
    scheme: Scheme,
    dt_s: f64,
    factors: M::Factors,
    rate: Vec<f64>,
    step: Vec<f64>,
    pub cost: Cost,
}

impl<'m, M: LinearisedDae> Stepper<'m, M> {
    pub fn new(model: &'m M, scheme: Scheme, dt_s: f64) -> Self {
        let n = model.states();
        Self {
            model,
            scheme,
            dt_s,
            factors: model.factors(),
            rate: vec![0.0; n],
            step: vec![0.0; n],
            cost: Cost::default(),
        }
    }

    /// Solves the step at `t_s` after `last` and `before`, from the guess in `z`; `None` if no iteration converged.
    pub fn step(&mut self, t_s: f64, z: &mut [f64], last: &[f64], before: &[f64]) -> Option<()> {
        self.cost.steps += 1;
        let guess = z.to_vec();
        if self.newton(self.scheme, self.dt_s, t_s, z, last, before) {
            return Some(());
        }
        z.copy_from_slice(last);
        if self.newton(self.scheme, self.dt_s, t_s, z, last, before) {
            return Some(());
        }
        self.walk(t_s, z, last).then_some(())?;
        let found = self.newton(self.scheme, self.dt_s, t_s, z, last, before);
        if !found {
            z.copy_from_slice(&guess);
        }
        found.then_some(())
    }

    /// Short implicit Euler steps from `last` at `t_s - dt` to `t_s`.
    fn walk(&mut self, t_s: f64, z: &mut [f64], last: &[f64]) -> bool {
        let short = self.dt_s / SHORT_STEPS as f64;
        let mut from = last.to_vec();
        z.copy_from_slice(last);
        for k in 1..=SHORT_STEPS {
            let t = t_s - self.dt_s + k as f64 * short;
            if !self.newton(Scheme::Bdf1, short, t, z, &from, &from.clone()) {
                return false;
            }
            from.copy_from_slice(z);
        }
        true
    }

    fn newton(
        &mut self,
        scheme: Scheme,
        dt_s: f64,
        t_s: f64,
        z: &mut [f64],
        last: &[f64],
        before: &[f64],
    ) -> bool {
        let alpha = scheme.weights()[0] / dt_s;
        for _ in 0..MOST_ITERATIONS {
            scheme.rate(self.model, dt_s, [z, last, before], &mut self.rate);
            let at = At { t_s, z, rate: &self.rate };
            self.model.residual(at, &mut self.step);
            if self.model.factor(at, alpha, &mut self.factors).is_err() {
                return false;
            }
            self.step.iter_mut().for_each(|v| *v = -*v);
            self.model.solve(&self.factors, &mut self.step);
            self.cost.newton_iterations += 1;
            self.cost.factorisations += 1;
            self.cost.solves += 1;
            let change = self.model.change(z, &self.step);
            if !change.is_finite() {
                return false;
            }
            let share = self.model.admissible(z, &self.step);
            z.iter_mut().zip(&self.step).for_each(|(z, s)| *z += share * s);
            if share == 1.0 && change < TOLERANCE {
                return true;
            }
        }
        false
    }
}

//! ADJ, the discrete adjoint of the very steps taken.
//!
//! With the memory `c_n = F_z'^T l_n + w_n g_z'` that a step hands to the two before it, the adjoint states solve
//!
//! ```text
//! (F_z + a_0/dt F_z')^T l_n = -w_n (g_z + a_0/dt g_z') - (a_1 c_{n+1} + a_2 c_{n+2}) / dt,    indices modulo N
//! dQ/dp = sum_n (w_n g_p + F_p^T l_n)
//! ```
//!
//! backwards in `n`, with one transposed solve per quantity and step and no work per parameter but the final product.
//! The first sweep starts without memory behind the end of the cycle; as everything is linear, further sweeps carry only
//! the memory left at its beginning, until it has faded. That closes the period exactly. Unlike a one-cycle adjoint on a
//! frozen start state, this sees the start state move with the design.

use super::{EngineName, GradientEngine, GradientError, GradientTable, Sweep, sweep_until_closed};
use crate::dae::{At, Cotangent, SensitiveDae};
use crate::orbit::{Orbit, OrbitOptions, Quantity};
use crate::run::{Cancel, Cost};

/// Discrete adjoint engine.
#[derive(Debug, Clone, Copy)]
pub struct Adjoint;

impl<M: SensitiveDae> GradientEngine<M> for Adjoint {
    fn name(&self) -> EngineName {
        EngineName::Adj
    }

    fn gradient(
        &self,
        model: &M,
        at: &Orbit,
        options: &OrbitOptions,
        of: &[Quantity],
        cancel: &Cancel,
    ) -> Result<GradientTable, GradientError> {
        sweep_until_closed(Backward::new(model, at, of), (0..at.steps()).rev(), options, cancel)
    }
}

struct Backward<'a, M: SensitiveDae> {
    model: &'a M,
    orbit: &'a Orbit,
    of: &'a [Quantity],
    weights: Vec<Vec<f64>>,
    factors: M::Factors,
    rate: Vec<f64>,
    /// Memory of the two later steps, nearest first, one column per quantity.
    memory: [Vec<f64>; 2],
    /// Adjoint states, one column per quantity.
    lambda: Vec<f64>,
    /// Sizes of the first memories, to which later ones are compared.
    scale: Vec<f64>,
    rows: Vec<Vec<f64>>,
    cost: Cost,
}

impl<'a, M: SensitiveDae> Backward<'a, M> {
    fn new(model: &'a M, orbit: &'a Orbit, of: &'a [Quantity]) -> Self {
        let n = model.states();
        let columns = || vec![0.0; n * of.len()];
        Self {
            model,
            orbit,
            of,
            weights: of.iter().map(|q| q.weights(&orbit.outputs)).collect(),
            factors: model.factors(),
            rate: vec![0.0; n],
            memory: [columns(), columns()],
            lambda: columns(),
            scale: vec![0.0; of.len()],
            rows: vec![vec![0.0; model.parameters().len()]; of.len()],
            cost: Cost::default(),
        }
    }

    /// Adds the products with the new adjoint states, completes the memory and measures it.
    fn hand_on(&mut self, n: usize) -> f64 {
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rate };
        let size = self.model.states();
        let mut largest = 0.0f64;
        for r in 0..self.of.len() {
            let column = r * size..(r + 1) * size;
            let lambda = &self.lambda[column.clone()];
            let memory = &mut self.memory[0][column.clone()];
            self.model.transposed_times(at, lambda, memory, &mut self.rows[r]);
            let now = memory.iter().fold(0.0f64, |a, c| a.max(c.abs()));
            self.scale[r] = self.scale[r].max(now);
            if self.scale[r] > 0.0 {
                largest = largest.max(now / self.scale[r]);
            }
            // The film's adjoint unknowns are not needed again: the next step starts from memory alone.
            self.lambda[column].fill(0.0);
        }
        largest
    }
}

impl<M: SensitiveDae> Sweep for Backward<'_, M> {
    /// Steps back to `n` and adds its share; returns the relative size of the memory.
    fn step(&mut self, n: usize, forced: bool) -> Result<f64, GradientError> {
        let (model, size) = (self.model, self.model.states());
        let a = self.orbit.scheme.weights().map(|a| a / self.orbit.dt_s);
        self.orbit.rate(model, n, &mut self.rate);
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rate };
        model.factor(at, a[0], &mut self.factors)?;
        let [next, later] = &self.memory;
        for &i in model.memory() {
            for r in 0..self.of.len() {
                let k = r * size + i;
                self.lambda[k] = -a[1] * next[k] - a[2] * later[k];
            }
        }
        self.memory.rotate_right(1);
        self.memory[0].fill(0.0);
        for r in 0..self.of.len() {
            let column = r * size..(r + 1) * size;
            let lambda = &mut self.lambda[column.clone()];
            let w = if forced { self.weights[r][n] } else { 0.0 };
            if w != 0.0 {
                let mut weights = vec![0.0; model.outputs()];
                weights[self.of[r].output] = w;
                let (mut z, mut rate) = (vec![0.0; size], vec![0.0; size]);
                model.output_cotangent(
                    at,
                    &weights,
                    Cotangent { z: &mut z, rate: &mut rate, p: &mut self.rows[r] },
                );
                for (i, l) in lambda.iter_mut().enumerate() {
                    *l -= z[i] + a[0] * rate[i];
                }
                self.memory[0][column].copy_from_slice(&rate);
            }
        }
        model.solve_transposed(&self.factors, &mut self.lambda);
        self.cost.factorisations += 1;
        self.cost.solves += self.of.len() as u64;
        self.cost.steps += 1;
        Ok(self.hand_on(n))
    }

    fn result(self) -> (Vec<Vec<f64>>, Cost) {
        (self.rows, self.cost)
    }
}

//! ADJ, the discrete adjoint of the very steps taken.
//!
//! With the weight `c_n = F_m'^T l_n + w_n g_m'` on the rate of step `n`, which is also a weight on the memories before it,
//! the adjoint states solve
//!
//! ```text
//! (F_z + a_0/dt F_m' M_z)^T l_n = -w_n (g_z + a_0/dt M_z^T g_m') - M_z^T (a_1 c_{n+1} + a_2 c_{n+2}) / dt,    indices modulo N
//! dQ/dp = sum_n (w_n g_p + F_p^T l_n + M_p^T (a_0 c_n + a_1 c_{n+1} + a_2 c_{n+2}) / dt)
//! ```
//!
//! backwards in `n`, with one transposed solve per quantity and step and no work per parameter but the final product.
//! The first sweep starts without weights behind the end of the cycle; as everything is linear, further sweeps carry only
//! the weights left at its beginning, until they have faded. That closes the period exactly. Unlike a one-cycle adjoint
//! on a frozen start state, this sees the start state move with the design.

use super::{Closure, GradientError, GradientTable, Sweep, sweep_until_closed};
use crate::dae::{At, Cotangent, SensitiveDae};
use crate::orbit::{Orbit, OrbitOptions, Quantity};
use crate::run::{Cancel, Cost};

/// Derivatives by all parameters, cycle unknowns held.
pub(super) fn adjoint<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    cancel: &Cancel,
) -> Result<GradientTable, GradientError> {
    sweep_until_closed(Backward::new(model, at, of), (0..at.steps()).rev(), options, cancel)
}

struct Backward<'a, M: SensitiveDae> {
    model: &'a M,
    orbit: &'a Orbit,
    of: &'a [Quantity],
    weights: Vec<Vec<f64>>,
    rates: Vec<Vec<f64>>,
    factors: M::Factors,
    point: M::Point,
    /// Weights on the rates of this and the two later steps, one column per quantity.
    carried: [Vec<f64>; 3],
    /// Adjoint states, one column per quantity.
    lambda: Vec<f64>,
    /// Sizes of the first weights, to which later ones are compared.
    scale: Vec<f64>,
    rows: Vec<Vec<f64>>,
    cost: Cost,
    scratch: Scratch,
}

/// Vectors that every step needs and none keeps.
struct Scratch {
    on_memory: Vec<f64>,
    z: Vec<f64>,
    p: Vec<f64>,
}

impl<'a, M: SensitiveDae> Backward<'a, M> {
    fn new(model: &'a M, orbit: &'a Orbit, of: &'a [Quantity]) -> Self {
        let (n, m, np) = (model.states(), model.memories(), model.parameters().len());
        let columns = || vec![0.0; m * of.len()];
        Self {
            model,
            orbit,
            of,
            weights: of.iter().map(|q| q.weights(&orbit.outputs)).collect(),
            rates: orbit.rates(model),
            factors: model.factors(),
            point: model.point(),
            carried: [columns(), columns(), columns()],
            lambda: vec![0.0; n * of.len()],
            scale: vec![0.0; of.len()],
            rows: vec![vec![0.0; np]; of.len()],
            cost: Cost::default(),
            scratch: Scratch { on_memory: vec![0.0; m], z: vec![0.0; n], p: vec![0.0; np] },
        }
    }

    fn at(&self, n: usize) -> At<'a> {
        At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &[] }
    }

    /// Weights of one quantity on the memory of a step, from those on the rates of this and the two later steps.
    fn weigh_memory(&mut self, r: usize) {
        let (m, a) = (self.model.memories(), self.orbit.scheme.rates(self.orbit.dt_s));
        let [now, next, later] = &self.carried;
        for (i, c) in self.scratch.on_memory.iter_mut().enumerate() {
            let k = r * m + i;
            *c = a[0] * now[k] + a[1] * next[k] + a[2] * later[k];
        }
    }

    /// Right-hand side of one quantity; starts the weights on the rate of this step.
    fn force(&mut self, n: usize, r: usize, forced: bool) {
        let (model, size, m) = (self.model, self.model.states(), self.model.memories());
        self.carried[0][r * m..(r + 1) * m].fill(0.0);
        self.scratch.z.fill(0.0);
        let w = if forced { self.weights[r][n] } else { 0.0 };
        if w != 0.0 {
            let mut weights = vec![0.0; model.outputs()];
            weights[self.of[r].output] = w;
            let rate = &mut self.carried[0][r * m..(r + 1) * m];
            let out = Cotangent { z: &mut self.scratch.z, rate, p: &mut self.rows[r] };
            let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
            model.output_cotangent(&self.point, at, &weights, out);
        }
        self.weigh_memory(r);
        self.scratch.p.fill(0.0);
        let (at, Scratch { on_memory, z, p }) = (self.at(n), &mut self.scratch);
        model.memory_cotangent(&self.point, at, on_memory, z, p);
        let lambda = &mut self.lambda[r * size..(r + 1) * size];
        lambda.iter_mut().zip(&*z).for_each(|(l, z)| *l = -z);
    }

    /// Adds the products with the new adjoint state, completes the weights on the rate and measures them.
    fn hand_on(&mut self, n: usize, r: usize) -> f64 {
        let (model, size, m) = (self.model, self.model.states(), self.model.memories());
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        let lambda = &self.lambda[r * size..(r + 1) * size];
        let now = &mut self.carried[0][r * m..(r + 1) * m];
        model.transposed_times(&self.point, at, lambda, now, &mut self.rows[r]);
        let size = now.iter().fold(0.0f64, |a, c| a.max(c.abs()));
        self.weigh_memory(r);
        let (at, Scratch { on_memory, z, .. }) = (self.at(n), &mut self.scratch);
        z.fill(0.0);
        model.memory_cotangent(&self.point, at, on_memory, z, &mut self.rows[r]);
        self.scale[r] = self.scale[r].max(size);
        if self.scale[r] > 0.0 { size / self.scale[r] } else { 0.0 }
    }
}

impl<M: SensitiveDae> Sweep for Backward<'_, M> {
    /// Steps back to `n` and adds its share; returns the relative size of the weights handed on.
    fn step(&mut self, n: usize, forced: bool) -> Result<f64, GradientError> {
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        self.model.fix(at, &mut self.point);
        self.model.factor(at, self.orbit.scheme.rates(self.orbit.dt_s)[0], &mut self.factors)?;
        self.cost.factorisations += 1;
        self.carried.rotate_right(1);
        (0..self.of.len()).for_each(|r| self.force(n, r, forced));
        self.model.solve_transposed(&mut self.factors, &mut self.lambda);
        self.cost.solves += self.of.len() as u64;
        self.cost.steps += 1;
        Ok((0..self.of.len()).map(|r| self.hand_on(n, r)).fold(0.0, f64::max))
    }

    fn result(self, closure: &Closure, sweeps: f64) -> GradientTable {
        GradientTable { rows: self.rows, sweeps, closure: closure.left(), cost: self.cost }
    }
}

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

    /// Right-hand side of one quantity; starts the weights on the rate of this step.
    fn force(&mut self, n: usize, r: usize, forced: bool) {
        let (model, a) = (self.model, self.orbit.scheme.rates(self.orbit.dt_s));
        let (size, m) = (model.states(), model.memories());
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        let [now, next, later] = &mut self.carried;
        let column = r * m..(r + 1) * m;
        let now = &mut now[column.clone()];
        now.fill(0.0);
        self.scratch.z.fill(0.0);
        let w = if forced { self.weights[r][n] } else { 0.0 };
        if w != 0.0 {
            let mut weights = vec![0.0; model.outputs()];
            weights[self.of[r].output] = w;
            let out = Cotangent { z: &mut self.scratch.z, rate: now, p: &mut self.rows[r] };
            model.output_cotangent(&self.point, at, &weights, out);
        }
        let on_memory = &mut self.scratch.on_memory;
        for ((c, now), (next, later)) in
            on_memory.iter_mut().zip(&*now).zip(next[column.clone()].iter().zip(&later[column]))
        {
            *c = a[0] * now + a[1] * next + a[2] * later;
        }
        self.scratch.p.fill(0.0);
        model.memory_cotangent(&self.point, at, on_memory, &mut self.scratch.z, &mut self.scratch.p);
        let lambda = &mut self.lambda[r * size..(r + 1) * size];
        lambda.iter_mut().zip(&self.scratch.z).for_each(|(l, z)| *l = -z);
    }

    /// Adds the products with the new adjoint state, completes the weights on the rate and measures them.
    fn hand_on(&mut self, n: usize, r: usize) -> f64 {
        let (model, a) = (self.model, self.orbit.scheme.rates(self.orbit.dt_s));
        let (size, m) = (model.states(), model.memories());
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        let column = r * m..(r + 1) * m;
        let lambda = &self.lambda[r * size..(r + 1) * size];
        let [now, next, later] = &mut self.carried;
        let now = &mut now[column.clone()];
        model.transposed_times(&self.point, at, lambda, now, &mut self.rows[r]);
        let on_memory = &mut self.scratch.on_memory;
        for ((c, now), (next, later)) in
            on_memory.iter_mut().zip(&*now).zip(next[column.clone()].iter().zip(&later[column]))
        {
            *c = a[0] * now + a[1] * next + a[2] * later;
        }
        self.scratch.z.fill(0.0);
        model.memory_cotangent(&self.point, at, on_memory, &mut self.scratch.z, &mut self.rows[r]);
        let size = now.iter().fold(0.0f64, |a, c| a.max(c.abs()));
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

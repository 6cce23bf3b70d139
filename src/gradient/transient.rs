//! TRA, the transient approach: the tangent equations marched along the orbit.
//!
//! The sensitivities `s_n = dz_n/dp` of all parameters solve, with the matrix of the step itself,
//!
//! ```text
//! (F_z + a_0/dt F_z') s_n = -F_p - F_z' (a_1 s_{n-1} + a_2 s_{n-2}) / dt,       indices modulo N
//! dQ/dp = sum_n w_n (g_z s_n + g_z' s'_n + g_p)
//! ```
//!
//! The first sweep starts from `s = 0` before the cycle. As everything is linear, what the wrong start left out is the
//! response to the memory at the end of the sweep; further sweeps carry that memory alone, until it has faded.

use super::{EngineName, GradientEngine, GradientError, GradientTable, Sweep, sweep_until_closed};
use crate::dae::{At, Direction, SensitiveDae};
use crate::orbit::{Orbit, OrbitOptions, Quantity};
use crate::run::{Cancel, Cost};

/// Forward sensitivity engine.
#[derive(Debug, Clone, Copy)]
pub struct Transient;

impl<M: SensitiveDae> GradientEngine<M> for Transient {
    fn name(&self) -> EngineName {
        EngineName::Tra
    }

    fn gradient(
        &self,
        model: &M,
        at: &Orbit,
        options: &OrbitOptions,
        of: &[Quantity],
        cancel: &Cancel,
    ) -> Result<GradientTable, GradientError> {
        sweep_until_closed(Forward::new(model, at, of), 0..at.steps(), options, cancel)
    }
}

struct Forward<'a, M: SensitiveDae> {
    model: &'a M,
    orbit: &'a Orbit,
    of: &'a [Quantity],
    weights: Vec<Vec<f64>>,
    factors: M::Factors,
    rate: Vec<f64>,
    /// Sensitivities of the newest and the two older steps, one column per parameter.
    s: [Vec<f64>; 3],
    rows: Vec<Vec<f64>>,
    cost: Cost,
}

impl<'a, M: SensitiveDae> Forward<'a, M> {
    fn new(model: &'a M, orbit: &'a Orbit, of: &'a [Quantity]) -> Self {
        let (n, np) = (model.states(), model.parameters().len());
        let column = || vec![0.0; n * np];
        Self {
            model,
            orbit,
            of,
            weights: of.iter().map(|q| q.weights(&orbit.outputs)).collect(),
            factors: model.factors(),
            rate: vec![0.0; n],
            s: [column(), column(), column()],
            rows: vec![vec![0.0; np]; of.len()],
            cost: Cost::default(),
        }
    }

    fn memory_size(&self, z: &[f64], j: usize) -> f64 {
        let size = self.model.states();
        let mut change = vec![0.0; size];
        for &i in self.model.memory() {
            change[i] = self.s[0][j * size + i];
        }
        self.model.change(z, &change)
    }

    fn add_share(&mut self, n: usize, forced: bool) {
        let (model, size) = (self.model, self.model.states());
        let np = model.parameters().len();
        let a = self.orbit.scheme.weights().map(|a| a / self.orbit.dt_s);
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rate };
        let (mut rate, mut dy) = (vec![0.0; size], vec![0.0; model.outputs()]);
        for j in 0..np {
            let s = |k: usize| &self.s[k][j * size..(j + 1) * size];
            for &i in model.memory() {
                rate[i] = a[0] * s(0)[i] + a[1] * s(1)[i] + a[2] * s(2)[i];
            }
            let mut p = vec![0.0; np];
            p[j] = if forced { 1.0 } else { 0.0 };
            model.output_tangent(at, Direction { z: s(0), rate: &rate, p: &p }, &mut dy);
            for ((row, quantity), weights) in self.rows.iter_mut().zip(self.of).zip(&self.weights) {
                row[j] += weights[n] * dy[quantity.output];
            }
        }
    }
}

impl<M: SensitiveDae> Sweep for Forward<'_, M> {
    /// Advances all sensitivities to step `n` and adds their share; returns the size of the memory.
    fn step(&mut self, n: usize, forced: bool) -> Result<f64, GradientError> {
        let (model, size) = (self.model, self.model.states());
        let np = model.parameters().len();
        let a = self.orbit.scheme.weights().map(|a| a / self.orbit.dt_s);
        self.orbit.rate(model, n, &mut self.rate);
        let z = self.orbit.state(n, 0);
        let at = At { t_s: self.orbit.time_s(n), z, rate: &self.rate };
        model.factor(at, a[0], &mut self.factors)?;
        self.s.rotate_right(1);
        let [new, last, before] = &mut self.s;
        new.fill(0.0);
        let (mut history, mut direction) = (vec![0.0; size], vec![0.0; np]);
        for j in 0..np {
            let column = j * size..(j + 1) * size;
            for &i in model.memory() {
                history[i] = a[1] * last[j * size + i] + a[2] * before[j * size + i];
            }
            let rhs = &mut new[column];
            direction.fill(0.0);
            direction[j] = if forced { 1.0 } else { 0.0 };
            model.times(at, &history, &direction, rhs);
            rhs.iter_mut().for_each(|v| *v = -*v);
        }
        model.solve(&self.factors, new);
        self.cost.factorisations += 1;
        self.cost.solves += np as u64;
        self.cost.steps += 1;
        self.add_share(n, forced);
        let p = model.parameters();
        Ok((0..np).map(|j| p[j].abs() * self.memory_size(z, j)).fold(0.0, f64::max))
    }

    fn result(self) -> (Vec<Vec<f64>>, Cost) {
        (self.rows, self.cost)
    }
}

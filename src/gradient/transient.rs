//! TRA, the transient approach: the tangent equations marched along the orbit.
//!
//! The sensitivities `s_n = dz_n/dp` of all parameters and those of the memory, `d_n = M_z s_n + M_p`, solve with the
//! matrix of the step itself
//!
//! ```text
//! (F_z + a_0/dt F_m' M_z) s_n = -F_p - F_m' (a_0 M_p + a_1 d_{n-1} + a_2 d_{n-2}) / dt,       indices modulo N
//! dQ/dp = sum_n w_n (g_z s_n + g_m' d'_n + g_p)
//! ```
//!
//! The first sweep starts from `d = 0` before the cycle. As everything is linear, what the wrong start left out is the
//! response to the memory at the end of the sweep; further sweeps carry that memory alone, until it has faded.

use super::{Closure, GradientError, GradientTable, Sweep, sweep_until_closed};
use crate::dae::{At, Direction, SensitiveDae};
use crate::orbit::{Orbit, OrbitOptions, Quantity};
use crate::run::{Cancel, Cost};

/// Derivatives by all parameters, cycle unknowns held.
pub(super) fn transient<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    cancel: &Cancel,
) -> Result<GradientTable, GradientError> {
    sweep_until_closed(Forward::new(model, at, of), 0..at.steps(), options, cancel)
}

struct Forward<'a, M: SensitiveDae> {
    model: &'a M,
    orbit: &'a Orbit,
    of: &'a [Quantity],
    weights: Vec<Vec<f64>>,
    rates: Vec<Vec<f64>>,
    factors: M::Factors,
    point: M::Point,
    /// Sensitivities of the state, one column per parameter.
    s: Vec<f64>,
    /// Sensitivities of the memory at this and the two earlier steps, one column per parameter.
    d: [Vec<f64>; 3],
    rows: Vec<Vec<f64>>,
    cost: Cost,
}

impl<'a, M: SensitiveDae> Forward<'a, M> {
    fn new(model: &'a M, orbit: &'a Orbit, of: &'a [Quantity]) -> Self {
        let (n, m, np) = (model.states(), model.memories(), model.parameters().len());
        let column = || vec![0.0; m * np];
        Self {
            model,
            orbit,
            of,
            weights: of.iter().map(|q| q.weights(&orbit.outputs)).collect(),
            rates: orbit.rates(model),
            factors: model.factors(),
            point: model.point(),
            s: vec![0.0; n * np],
            d: [column(), column(), column()],
            rows: vec![vec![0.0; np]; of.len()],
            cost: Cost::default(),
        }
    }

    /// Unit vector of a parameter, or nothing on a sweep that only carries memory.
    fn direction(&self, j: usize, forced: bool) -> Vec<f64> {
        let mut p = vec![0.0; self.model.parameters().len()];
        p[j] = if forced { 1.0 } else { 0.0 };
        p
    }

    /// Rate that the memory of parameter `j` has, its newest part apart.
    fn past(&self, j: usize) -> Vec<f64> {
        let (m, a) = (self.model.memories(), self.orbit.scheme.rates(self.orbit.dt_s));
        let column = |k: usize| &self.d[k][j * m..(j + 1) * m];
        column(1).iter().zip(column(2)).map(|(last, before)| a[1] * last + a[2] * before).collect()
    }

    fn right_hand_side(&mut self, n: usize, j: usize, forced: bool) {
        let (model, size) = (self.model, self.model.states());
        let a = self.orbit.scheme.rates(self.orbit.dt_s);
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        let (p, mut rate) = (self.direction(j, forced), self.past(j));
        if forced {
            let mut by_p = vec![0.0; model.memories()];
            model.memory_tangent(&self.point, at, &vec![0.0; size], &p, &mut by_p);
            rate.iter_mut().zip(&by_p).for_each(|(r, d)| *r += a[0] * d);
        }
        let rhs = &mut self.s[j * size..(j + 1) * size];
        rhs.fill(0.0);
        model.times(&self.point, at, &rate, &p, rhs);
        rhs.iter_mut().for_each(|v| *v = -*v);
    }

    /// Memory of the new sensitivity, and its share in the quantities; returns the size of the memory.
    fn hand_on(&mut self, n: usize, j: usize, forced: bool) -> f64 {
        let (model, size, m) = (self.model, self.model.states(), self.model.memories());
        let a = self.orbit.scheme.rates(self.orbit.dt_s);
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        let (p, past) = (self.direction(j, forced), self.past(j));
        let s = &self.s[j * size..(j + 1) * size];
        let new = &mut self.d[0][j * m..(j + 1) * m];
        model.memory_tangent(&self.point, at, s, &p, new);
        let rate: Vec<f64> = past.iter().zip(&*new).map(|(past, new)| past + a[0] * new).collect();
        let mut dy = vec![0.0; model.outputs()];
        model.output_tangent(&self.point, at, Direction { z: s, rate: &rate, p: &p }, &mut dy);
        for ((row, quantity), weights) in self.rows.iter_mut().zip(self.of).zip(&self.weights) {
            row[j] += weights[n] * dy[quantity.output];
        }
        model.parameter_scale(j) * model.memory_change(new)
    }
}

impl<M: SensitiveDae> Sweep for Forward<'_, M> {
    /// Advances all sensitivities to step `n` and adds their share; returns the size of the memory.
    fn step(&mut self, n: usize, forced: bool) -> Result<f64, GradientError> {
        let np = self.model.parameters().len();
        let at = At { t_s: self.orbit.time_s(n), z: self.orbit.state(n, 0), rate: &self.rates[n] };
        self.model.fix(at, &mut self.point);
        self.model.factor(at, self.orbit.scheme.rates(self.orbit.dt_s)[0], &mut self.factors)?;
        self.cost.factorisations += 1;
        self.d.rotate_right(1);
        (0..np).for_each(|j| self.right_hand_side(n, j, forced));
        self.model.solve(&mut self.factors, &mut self.s);
        self.cost.solves += np as u64;
        self.cost.steps += 1;
        Ok((0..np).map(|j| self.hand_on(n, j, forced)).fold(0.0, f64::max))
    }

    fn result(self, closure: &Closure, sweeps: f64) -> GradientTable {
        GradientTable { rows: self.rows, sweeps, closure: closure.left(), cost: self.cost }
    }
}

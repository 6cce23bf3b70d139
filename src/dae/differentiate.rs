//! The equations of a [`Dense`] model differentiated by dual numbers: one direction at a time, whole matrices kept.
//!
//! ```text
//! f(x + eps e_j) = f(x) + eps df/dx_j      with eps^2 = 0
//! ```
//!
//! Deliberately not here: a reverse mode. Transposed products use the kept matrices, which are small.

use super::lu::Lu;
use super::{At, Cotangent, Dense, Direction, Equations, Instant, LinearisedDae, SensitiveDae, Step};
use crate::math::Singular;
use nalgebra::DMatrix;
use num_dual::Dual64;

/// Halvings of a step that leaves where the equations are defined.
const HALVINGS: usize = 20;

/// Dual numbers for all arguments and results.
pub(super) struct Duals {
    t_s: f64,
    z: Vec<Dual64>,
    rate: Vec<Dual64>,
    p: Vec<Dual64>,
    memory: Vec<Dual64>,
    residual: Vec<Dual64>,
    output: Vec<Dual64>,
}

impl Duals {
    pub fn new<E>(model: &Dense<E>) -> Self {
        let (zero, sizes) = (|n: usize| vec![Dual64::from_re(0.0); n], model.sizes);
        Self {
            t_s: 0.0,
            z: zero(sizes.states),
            rate: zero(sizes.memories),
            p: zero(model.p.len()),
            memory: zero(sizes.memories),
            residual: zero(sizes.states),
            output: zero(sizes.outputs),
        }
    }

    /// Goes to a point, without a direction. Rates may be left out.
    pub fn place(&mut self, at: At, p: &[f64]) {
        self.t_s = at.t_s;
        let put = |to: &mut [Dual64], from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = Dual64::from_re(*from));
        };
        put(&mut self.z, at.z);
        put(&mut self.rate, at.rate);
        put(&mut self.p, p);
    }

    fn memory(&mut self, equations: &impl Equations) -> &[Dual64] {
        let at = Instant { t_s: self.t_s, z: &self.z, rate: &[], p: &self.p };
        equations.memory(at, &mut self.memory);
        &self.memory
    }

    fn residual(&mut self, equations: &impl Equations) -> &[Dual64] {
        let at = Instant { t_s: self.t_s, z: &self.z, rate: &self.rate, p: &self.p };
        equations.residual(at, &mut self.residual);
        &self.residual
    }

    fn output(&mut self, equations: &impl Equations) -> &[Dual64] {
        let at = Instant { t_s: self.t_s, z: &self.z, rate: &self.rate, p: &self.p };
        equations.output(at, &mut self.output);
        &self.output
    }
}

/// Hands the derivative of each result and its index on.
fn slopes(results: &[Dual64], mut to: impl FnMut(usize, f64)) {
    results.iter().enumerate().for_each(|(i, v)| to(i, v.eps));
}

/// `out += A x`.
fn add_times(a: &DMatrix<f64>, x: &[f64], out: &mut [f64]) {
    for (column, x) in a.column_iter().zip(x) {
        out.iter_mut().zip(column.iter()).for_each(|(o, a)| *o += a * x);
    }
}

/// `out += A^T v`.
fn add_transposed(a: &DMatrix<f64>, v: &[f64], out: &mut [f64]) {
    for (column, o) in a.column_iter().zip(out) {
        *o += column.iter().zip(v).map(|(a, v)| a * v).sum::<f64>();
    }
}

impl<E: Equations> Dense<E> {
    /// Derivatives of the memories by state `j`: hands on the index of each memory and its slope.
    pub(super) fn memory_by_state(&self, duals: &mut Duals, j: usize, to: impl FnMut(usize, f64)) {
        duals.z[j].eps = 1.0;
        slopes(duals.memory(&self.equations), to);
        duals.z[j].eps = 0.0;
    }

    /// Matrices of a step at the point where the duals are placed, factorised.
    fn assemble(&self, duals: &mut Duals, alpha: f64, into: &mut DenseFactors) -> Result<(), Singular> {
        let (n, m) = (self.sizes.states, self.sizes.memories);
        let DenseFactors { lu, by_rate, memory_by_state } = into;
        for j in 0..n {
            self.memory_by_state(duals, j, |i, slope| memory_by_state[(i, j)] = slope);
            duals.z[j].eps = 1.0;
            slopes(duals.residual(&self.equations), |i, slope| lu.matrix[i * n + j] = slope);
            duals.z[j].eps = 0.0;
        }
        for k in 0..m {
            duals.rate[k].eps = 1.0;
            slopes(duals.residual(&self.equations), |i, slope| by_rate[(i, k)] = slope);
            duals.rate[k].eps = 0.0;
        }
        for i in 0..n {
            for j in 0..n {
                let through: f64 = (0..m).map(|k| by_rate[(i, k)] * memory_by_state[(k, j)]).sum();
                lu.matrix[i * n + j] += alpha * through;
            }
        }
        lu.factor()
    }
}

/// Factors of one step of a [`Dense`] model.
pub struct DenseFactors {
    lu: Lu,
    by_rate: DMatrix<f64>,
    memory_by_state: DMatrix<f64>,
}

/// Workspace of a linearisation of a [`Dense`] model.
pub struct DenseRoom {
    duals: Duals,
    rate: Vec<f64>,
}

impl<E: Equations> LinearisedDae for Dense<E> {
    type Factors = DenseFactors;
    type Room = DenseRoom;

    fn factors(&self) -> DenseFactors {
        let (n, m) = (self.sizes.states, self.sizes.memories);
        DenseFactors { lu: Lu::new(n), by_rate: DMatrix::zeros(n, m), memory_by_state: DMatrix::zeros(m, n) }
    }

    fn factor_bytes(&self) -> usize {
        let (n, m) = (self.sizes.states, self.sizes.memories);
        Lu::bytes(n) + 2 * n * m * size_of::<f64>()
    }

    fn room(&self) -> DenseRoom {
        DenseRoom { duals: Duals::new(self), rate: vec![0.0; self.sizes.memories] }
    }

    fn linearise(
        &self,
        step: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        room: &mut DenseRoom,
        into: &mut DenseFactors,
    ) -> Result<(), Singular> {
        let DenseRoom { duals, rate } = room;
        let at = At { t_s: step.t_s, z: step.z, rate: &[] };
        self.equations.memory(self.instant(at), memory);
        for ((rate, m), past) in rate.iter_mut().zip(&*memory).zip(step.past) {
            *rate = step.alpha * m + past;
        }
        let at = At { rate, ..at };
        self.equations.residual(self.instant(at), residual);
        duals.place(at, &self.p);
        self.assemble(duals, step.alpha, into)
    }

    fn solve(&self, factors: &DenseFactors, rhs: &mut [f64]) {
        factors.lu.solve(rhs);
    }

    fn rate_times(&self, factors: &DenseFactors, rate: &[f64], out: &mut [f64]) {
        add_times(&factors.by_rate, rate, out);
    }

    fn memory_times(&self, factors: &DenseFactors, dz: &[f64], dm: &mut [f64]) {
        add_times(&factors.memory_by_state, dz, dm);
    }

    fn contains(&self, z: &[f64]) -> bool {
        self.equations.contains(z, &self.p)
    }

    fn admissible(&self, z: &[f64], dz: &[f64]) -> f64 {
        let inside = |share: &f64| {
            let there: Vec<f64> = z.iter().zip(dz).map(|(z, d)| z + share * d).collect();
            self.contains(&there)
        };
        let shares = (0..HALVINGS as i32).map(|k| 0.5f64.powi(k));
        shares.into_iter().find(inside).unwrap_or(0.0)
    }
}

/// Derivatives of a [`Dense`] model at one point of a trajectory.
pub struct DensePoint {
    duals: Duals,
    residual_by_p: DMatrix<f64>,
    memory_by_p: DMatrix<f64>,
    output_by_state: DMatrix<f64>,
    output_by_rate: DMatrix<f64>,
    output_by_p: DMatrix<f64>,
}

impl<E: Equations> SensitiveDae for Dense<E> {
    type Point = DensePoint;

    fn point(&self) -> DensePoint {
        let (n, m, o, p) = (self.sizes.states, self.sizes.memories, self.sizes.outputs, self.p.len());
        DensePoint {
            duals: Duals::new(self),
            residual_by_p: DMatrix::zeros(n, p),
            memory_by_p: DMatrix::zeros(m, p),
            output_by_state: DMatrix::zeros(o, n),
            output_by_rate: DMatrix::zeros(o, m),
            output_by_p: DMatrix::zeros(o, p),
        }
    }

    fn fix(&self, at: At, into: &mut DensePoint) {
        let (duals, equations) = (&mut into.duals, &self.equations);
        duals.place(at, &self.p);
        for j in 0..self.sizes.states {
            duals.z[j].eps = 1.0;
            slopes(duals.output(equations), |i, slope| into.output_by_state[(i, j)] = slope);
            duals.z[j].eps = 0.0;
        }
        for j in 0..self.sizes.memories {
            duals.rate[j].eps = 1.0;
            slopes(duals.output(equations), |i, slope| into.output_by_rate[(i, j)] = slope);
            duals.rate[j].eps = 0.0;
        }
        for j in 0..self.p.len() {
            duals.p[j].eps = 1.0;
            slopes(duals.memory(equations), |i, slope| into.memory_by_p[(i, j)] = slope);
            slopes(duals.residual(equations), |i, slope| into.residual_by_p[(i, j)] = slope);
            slopes(duals.output(equations), |i, slope| into.output_by_p[(i, j)] = slope);
            duals.p[j].eps = 0.0;
        }
    }

    fn factor(
        &self,
        at: At,
        alpha: f64,
        room: &mut DenseRoom,
        into: &mut DenseFactors,
    ) -> Result<(), Singular> {
        room.duals.place(at, &self.p);
        self.assemble(&mut room.duals, alpha, into)
    }

    fn solve_transposed(&self, factors: &DenseFactors, rhs: &mut [f64]) {
        factors.lu.solve_transposed(rhs);
    }

    fn rate_cotangent(&self, factors: &DenseFactors, v: &[f64], rate: &mut [f64]) {
        add_transposed(&factors.by_rate, v, rate);
    }

    fn memory_cotangent(&self, factors: &DenseFactors, w: &[f64], z: &mut [f64]) {
        add_transposed(&factors.memory_by_state, w, z);
    }

    fn push(&self, point: &DensePoint, _: At, du: &[f64], residual: &mut [f64], memory: &mut [f64]) {
        residual.fill(0.0);
        memory.fill(0.0);
        add_times(&point.residual_by_p, du, residual);
        add_times(&point.memory_by_p, du, memory);
    }

    fn pull(&self, point: &DensePoint, _: At, v: &[f64], w: &[f64], u: &mut [f64]) {
        add_transposed(&point.residual_by_p, v, u);
        add_transposed(&point.memory_by_p, w, u);
    }

    fn output_tangent(&self, point: &DensePoint, _: At, direction: Direction, dy: &mut [f64]) {
        dy.fill(0.0);
        add_times(&point.output_by_state, direction.z, dy);
        add_times(&point.output_by_rate, direction.rate, dy);
        add_times(&point.output_by_p, direction.u, dy);
    }

    fn output_cotangent(&self, point: &DensePoint, _: At, w: &[f64], out: Cotangent) {
        add_transposed(&point.output_by_state, w, out.z);
        add_transposed(&point.output_by_rate, w, out.rate);
        add_transposed(&point.output_by_p, w, out.u);
    }
}

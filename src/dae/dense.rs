//! A user's [`Equations`] as a model that can be evaluated, with cycle unknowns if it has any.
//!
//! Changes are judged by the scales the equations name: a change of a state relative to its scale or, if that is larger,
//! to the state itself. Deliberately not here: derivatives of the equations (see [`super::differentiate`]).

use super::differentiate::Duals;
use super::{At, CycleEquations, Dae, Equations, Instant, InvalidParameters, Sizes};
use num_dual::Dual64;

/// Equations at given parameters, climbing the whole ladder with dense matrices: for up to some dozens of states.
///
/// Every derivative is exact: forward-mode dual numbers, one evaluation per state, memory and parameter.
#[derive(Debug, Clone)]
pub struct Dense<E> {
    pub(super) equations: E,
    pub(super) sizes: Sizes,
    pub(super) p: Vec<f64>,
    pub(super) state_scale: Vec<f64>,
    memory_scale: Vec<f64>,
}

impl<E: Equations> Dense<E> {
    /// The model at given parameters (SI units, cycle unknowns last), if it exists there.
    ///
    /// # Panics
    ///
    /// If the equations give a scale or a start of the wrong length, or a scale that is not above zero.
    pub fn new(equations: E, parameters: &[f64]) -> Result<Self, InvalidParameters> {
        equations.check(parameters)?;
        let (sizes, state_scale) = (equations.sizes(), equations.state_scale());
        assert_eq!(state_scale.len(), sizes.states, "one scale per state");
        assert!(state_scale.iter().all(|s| *s > 0.0), "scales of states are above zero");
        let mut model = Self {
            p: parameters.to_vec(),
            memory_scale: equations.memory_scale(),
            equations,
            sizes,
            state_scale,
        };
        if model.memory_scale.is_empty() {
            model.memory_scale = model.learned_memory_scale();
        }
        assert_eq!(model.memory_scale.len(), sizes.memories, "one scale per memory");
        assert!(model.memory_scale.iter().all(|s| *s > 0.0), "scales of memories are above zero");
        Ok(model)
    }

    /// The equations.
    pub fn equations(&self) -> &E {
        &self.equations
    }

    /// What a change of all states by their scale does to each memory at the cold start.
    fn learned_memory_scale(&self) -> Vec<f64> {
        let (mut duals, z) = (Duals::new(self), self.cold_start());
        assert_eq!(z.len(), self.sizes.states, "a start for every state");
        duals.place(At { t_s: 0.0, z: &z, rate: &[] }, &self.p);
        let mut scale = vec![0.0; self.sizes.memories];
        for (j, by) in self.state_scale.iter().enumerate() {
            self.memory_by_state(&mut duals, j, |i, slope| scale[i] += slope.abs() * by);
        }
        scale.iter().map(|s| if *s > 0.0 && s.is_finite() { *s } else { 1.0 }).collect()
    }

    pub(super) fn instant<'a>(&'a self, at: At<'a>) -> Instant<'a, f64> {
        Instant { t_s: at.t_s, z: at.z, rate: at.rate, p: &self.p }
    }
}

/// Largest share of a scale; no number if any entry is none.
fn largest(shares: impl Iterator<Item = f64>) -> f64 {
    shares.fold(0.0, |a, s| if s.is_nan() || a.is_nan() { f64::NAN } else { a.max(s.abs()) })
}

impl<E: Equations> Dae for Dense<E> {
    fn states(&self) -> usize {
        self.sizes.states
    }

    fn memories(&self) -> usize {
        self.sizes.memories
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn parameter_scale(&self, j: usize) -> f64 {
        let size = self.p[j].abs();
        if size > 0.0 { size } else { self.equations.parameter_scale(j) }
    }

    fn period_s(&self) -> f64 {
        self.equations.period_s()
    }

    fn outputs(&self) -> usize {
        self.sizes.outputs
    }

    fn cold_start(&self) -> Vec<f64> {
        self.equations.cold_start(&self.p)
    }

    fn memory(&self, t_s: f64, z: &[f64], m: &mut [f64]) {
        self.equations.memory(self.instant(At { t_s, z, rate: &[] }), m);
    }

    fn residual(&self, at: At, residual: &mut [f64]) {
        self.equations.residual(self.instant(at), residual);
    }

    fn output(&self, at: At, y: &mut [f64]) {
        self.equations.output(self.instant(at), y);
    }

    fn change(&self, z: &[f64], dz: &[f64]) -> f64 {
        largest(dz.iter().zip(z).zip(&self.state_scale).map(|((d, z), s)| d / s.max(z.abs())))
    }

    fn memory_change(&self, dm: &[f64]) -> f64 {
        largest(dm.iter().zip(&self.memory_scale).map(|(d, s)| d / s))
    }

    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters> {
        Self::new(self.equations.clone(), p)
    }

    fn cycle(&self) -> Option<&dyn CycleEquations> {
        (self.equations.cycle_unknowns() > 0).then_some(self as &dyn CycleEquations)
    }
}

impl<E: Equations> CycleEquations for Dense<E> {
    fn unknowns(&self) -> usize {
        self.equations.cycle_unknowns()
    }

    fn outputs(&self) -> Vec<usize> {
        self.equations.cycle_outputs()
    }

    fn residual(&self, means: &[f64], p: &[f64]) -> Vec<f64> {
        let mut residual = vec![0.0; self.unknowns()];
        self.equations.cycle_residual(means, p, &mut residual);
        residual
    }

    fn slopes(&self, means: &[f64], p: &[f64]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let k = self.unknowns();
        let dual = |v: &[f64]| -> Vec<Dual64> { v.iter().map(|v| Dual64::from_re(*v)).collect() };
        let (mut y, mut q, mut r) = (dual(means), dual(p), vec![Dual64::from_re(0.0); k]);
        let (mut by_mean, mut by_p) = (vec![vec![0.0; y.len()]; k], vec![vec![0.0; q.len()]; k]);
        for j in 0..y.len() {
            y[j].eps = 1.0;
            self.equations.cycle_residual(&y, &q, &mut r);
            by_mean.iter_mut().zip(&r).for_each(|(row, r)| row[j] = r.eps);
            y[j].eps = 0.0;
        }
        for j in 0..q.len() {
            q[j].eps = 1.0;
            self.equations.cycle_residual(&y, &q, &mut r);
            by_p.iter_mut().zip(&r).for_each(|(row, r)| row[j] = r.eps);
            q[j].eps = 0.0;
        }
        (by_mean, by_p)
    }

    fn guess(&self, means: &[f64], p: &[f64]) -> Vec<Vec<f64>> {
        let first = p.len() - self.unknowns();
        let alone = || self.slopes(means, p).1.into_iter().map(|row| row[first..].to_vec()).collect();
        self.equations.cycle_guess(means, p).unwrap_or_else(alone)
    }

    fn scale(&self) -> Vec<f64> {
        let first = self.p.len() - self.unknowns();
        (first..self.p.len()).map(|j| self.parameter_scale(j)).collect()
    }
}

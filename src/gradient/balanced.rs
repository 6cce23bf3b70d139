//! Gradients past the cycle unknowns, by the implicit function theorem.
//!
//! TRA and ADJ treat the cycle unknowns `u` as further parameters and give the derivatives of every quantity `Q` and of
//! the cycle means `Y` that stand in the equations `R(Y, p, u) = 0`. The unknowns answer to the parameters with
//!
//! ```text
//! (R_Y Y_u + R_u) du/dp = -(R_Y Y_p + R_p),      dQ/dp = Q_p + Q_u du/dp
//! ```
//!
//! exact, for one more row per mean and one more column per unknown.

use super::adjoint::adjoint;
use super::transient::transient;
use super::{EngineName, GradientEngine, GradientError, GradientTable};
use crate::dae::{CycleEquations, SensitiveDae};
use crate::orbit::{Orbit, OrbitOptions, Quantity, Reduction};
use crate::run::Cancel;
use nalgebra::DMatrix;

/// Forward sensitivity engine.
#[derive(Debug, Clone, Copy)]
pub struct Transient;

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
        balanced(model, at, of, |model, of| adjoint(model, at, options, of, cancel))
    }
}

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
        balanced(model, at, of, |model, of| transient(model, at, options, of, cancel))
    }
}

/// Derivatives with the cycle unknowns eliminated; `inner` gives them with the unknowns as parameters.
fn balanced<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    of: &[Quantity],
    inner: impl Fn(&M, &[Quantity]) -> Result<GradientTable, GradientError>,
) -> Result<GradientTable, GradientError> {
    let model = at.model(model)?;
    let Some(equations) = model.cycle() else { return inner(&model, of) };
    let mean = |&output: &usize| Quantity { output, reduction: Reduction::Mean };
    let means: Vec<Quantity> = equations.outputs().iter().map(mean).collect();
    let asked: Vec<Quantity> = of.iter().chain(&means).copied().collect();
    let mut table = inner(&model, &asked)?;
    let by_mean = table.rows.split_off(of.len());
    let values: Vec<f64> = means.iter().map(|q| at.value(q)).collect();
    let answer = answer(equations, &values, &at.parameters, &by_mean)?;
    let first = at.parameters.len() - equations.unknowns();
    for row in &mut table.rows {
        let by_unknown = row.split_off(first);
        for (j, slope) in row.iter_mut().enumerate() {
            *slope += by_unknown.iter().enumerate().map(|(u, g)| g * answer[(u, j)]).sum::<f64>();
        }
    }
    Ok(table)
}

/// `du/dp`, unknowns by parameters.
fn answer(
    equations: &dyn CycleEquations,
    means: &[f64],
    p: &[f64],
    by_mean: &[Vec<f64>],
) -> Result<DMatrix<f64>, GradientError> {
    let (k, first) = (equations.unknowns(), p.len() - equations.unknowns());
    let (r_y, r_p) = equations.slopes(means, p);
    let total =
        |i: usize, j: usize| r_p[i][j] + r_y[i].iter().zip(by_mean).map(|(r, row)| r * row[j]).sum::<f64>();
    let by_unknown = DMatrix::from_fn(k, k, |i, j| total(i, first + j));
    let by_parameter = DMatrix::from_fn(k, first, |i, j| -total(i, j));
    by_unknown.lu().solve(&by_parameter).ok_or(GradientError::Unbalanced)
}

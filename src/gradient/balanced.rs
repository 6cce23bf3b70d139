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
use super::along::{Along, along_with};
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
        let n = super::varied(model, at);
        let unit = |j: usize| Along {
            parameters: (0..n).map(|k| if k == j { 1.0 } else { 0.0 }).collect(),
            fields: Vec::new(),
        };
        let directions: Vec<Along> = (0..n).map(unit).collect();
        Ok(along_with(model, at, options, of, &directions, false, cancel)?.table)
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
    let first = at.parameters.len() - equations.unknowns();
    let answer = answer(equations, &values, &at.parameters, &by_mean, |by_p, j| by_p[j])?;
    let means_by_field = table.fields.split_off(of.len().min(table.fields.len()));
    for (r, row) in table.rows.iter_mut().enumerate() {
        let by_unknown = row.split_off(first);
        answer.add(&by_unknown, row);
        // Fields stand in the equations through the means only.
        for (y, by_field) in means_by_field.iter().enumerate() {
            let weight: f64 = by_unknown.iter().enumerate().map(|(u, g)| g * answer.by_mean[(u, y)]).sum();
            table.fields[r].iter_mut().zip(by_field).for_each(|(f, m)| *f += weight * m);
        }
    }
    Ok(table)
}

/// How the unknowns answer.
pub(super) struct Answer {
    /// To the parameters, or along directions: `du/dp`, means included.
    pub by_direction: DMatrix<f64>,
    /// To a change of the means at fixed unknowns.
    by_mean: DMatrix<f64>,
}

impl Answer {
    /// Adds to a row what the unknowns do to it.
    pub fn add(&self, by_unknown: &[f64], row: &mut [f64]) {
        for (j, slope) in row.iter_mut().enumerate() {
            *slope += by_unknown.iter().enumerate().map(|(u, g)| g * self.by_direction[(u, j)]).sum::<f64>();
        }
    }
}

/// Answers from the derivatives of the means, unknowns last; `direct` is what direction `j` does to an equation by itself, given
/// its derivatives by the parameters.
pub(super) fn answer(
    equations: &dyn CycleEquations,
    means: &[f64],
    p: &[f64],
    by_mean: &[Vec<f64>],
    direct: impl Fn(&[f64], usize) -> f64,
) -> Result<Answer, GradientError> {
    let (k, known) = (equations.unknowns(), p.len() - equations.unknowns());
    let (r_y, r_p) = equations.slopes(means, p);
    let columns = by_mean.first().map_or(known, |row| row.len() - k);
    let through = |i: usize, j: usize| r_y[i].iter().zip(by_mean).map(|(r, row)| r * row[j]).sum::<f64>();
    let by_unknown = DMatrix::from_fn(k, k, |i, u| r_p[i][known + u] + through(i, columns + u));
    let by_direction = DMatrix::from_fn(k, columns, |i, j| -(direct(&r_p[i], j) + through(i, j)));
    let means_alone = DMatrix::from_fn(k, means.len(), |i, y| -r_y[i][y]);
    let lu = by_unknown.lu();
    let solve = |rhs: &DMatrix<f64>| lu.solve(rhs).ok_or(GradientError::Unbalanced);
    Ok(Answer { by_direction: solve(&by_direction)?, by_mean: solve(&means_alone)? })
}

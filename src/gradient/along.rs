//! Tangents along any change of parameters and fields together: what TRA computes for single parameters, for directions a model
//! has no parameter for (a surface that wears), and for local outputs as well.
//!
//! Cycle unknowns answer as in [`super::Transient`]: with the equations `R(Y, p, u) = 0` of the means `Y`,
//! `du = -(R_Y Y_u + R_u)^-1 (R_Y dY + R_p dp)` along every direction.

use super::GradientError;
use super::balanced::answer;
use super::chain::Chain;
use super::transient::{Tangents, by_parameter, transient};
use crate::dae::{CycleEquations, SensitiveDae};
use crate::orbit::{Orbit, OrbitOptions, Quantity, Reduction};
use crate::run::{Cancel, Cost};

/// Values of local outputs along some directions, and rows of quantities, with the cycle unknowns answering.
pub struct AlongTable {
    /// One row per quantity, one entry per direction.
    pub rows: Vec<Vec<f64>>,
    /// Changes of the means of all local outputs, one row per direction.
    pub locals: Vec<Vec<f64>>,
    /// Work done.
    pub cost: Cost,
}

/// A change of a model: of its parameters (cycle unknowns left out), and of its fields beyond what the parameters do to them.
#[derive(Debug, Clone, Default)]
pub struct Along {
    /// Change of each parameter.
    pub parameters: Vec<f64>,
    /// Further change of each field; empty for none.
    pub fields: Vec<f64>,
}

/// Derivatives of quantities and of local outputs along changes of parameters and fields, by the tangent equations (TRA).
pub fn along<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    directions: &[Along],
    cancel: &Cancel,
) -> Result<AlongTable, GradientError> {
    let found = along_with(model, at, options, of, directions, true, cancel)?;
    Ok(AlongTable { rows: found.table.rows, locals: found.locals, cost: found.table.cost })
}

/// The same with or without local outputs: what TRA is made of.
pub(super) fn along_with<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    directions: &[Along],
    locals: bool,
    cancel: &Cancel,
) -> Result<Tangents, GradientError> {
    let model = at.model(model)?;
    let np = model.parameters().len();
    let column = |direction: &Along| {
        let (mut dp, mut du) = (direction.parameters.clone(), vec![0.0; model.fields()]);
        dp.resize(np, 0.0);
        model.field_tangent(&dp, &mut du);
        du.iter_mut().zip(&direction.fields).for_each(|(u, d)| *u += d);
        du
    };
    let mut columns: Vec<Vec<f64>> = directions.iter().map(column).collect();
    let equations = model.cycle();
    let unknowns = equations.map_or(0, CycleEquations::unknowns);
    columns.extend(by_parameter(&model).split_off(np - unknowns));
    let outputs = equations.map_or_else(Vec::new, CycleEquations::outputs);
    let means: Vec<Quantity> =
        outputs.iter().map(|&output| Quantity { output, reduction: Reduction::Mean }).collect();
    let asked: Vec<Quantity> = of.iter().chain(&means).copied().collect();
    let mut found = transient(Chain::new(&model, at, options, cancel), &asked, &columns, locals)?;
    let by_mean = found.table.rows.split_off(of.len());
    let locals_by_unknown = found.locals.split_off(directions.len().min(found.locals.len()));
    if let Some(equations) = equations {
        let values: Vec<f64> = means.iter().map(|q| at.value(q)).collect();
        let direct = |by_p: &[f64], j: usize| crate::math::dot(&directions[j].parameters, by_p);
        let answer = answer(equations, &values, &at.parameters, &by_mean, direct)?;
        for row in &mut found.table.rows {
            let by_unknown = row.split_off(directions.len());
            answer.add(&by_unknown, row);
        }
        for (j, row) in found.locals.iter_mut().enumerate() {
            for (u, by_unknown) in locals_by_unknown.iter().enumerate() {
                let moves = answer.by_direction[(u, j)];
                row.iter_mut().zip(by_unknown).for_each(|(r, g)| *r += moves * g);
            }
        }
    }
    Ok(found)
}

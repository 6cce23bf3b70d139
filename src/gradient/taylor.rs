//! Taylor-remainder test: the proof of a gradient that any user can run on any model.
//!
//! Along a direction `d`, `|Q(p + h d) - Q(p)|` falls like `h` and `|Q(p + h d) - Q(p) - h dQ/dp d|` like `h^2` if, and
//! only if, the gradient is right. A quantity linear along `d` has no remainder but rounding: it counts as passed.

use super::{GradientError, GradientTable};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitOptions, Quantity, settle};
use crate::run::Cancel;
use serde::{Deserialize, Serialize};

/// One step length of a Taylor test of one quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TaylorRow {
    /// Step length relative to the parameters.
    pub step: f64,
    /// `|Q(p + h d) - Q(p)|` relative to `|Q(p)|`.
    pub change: f64,
    /// `|Q(p + h d) - Q(p) - h dQ/dp d|` relative to `|Q(p)|`.
    pub remainder: f64,
    /// Observed order of the remainder against the row before.
    pub order: Option<f64>,
}

/// Taylor table of each quantity for step lengths `first, first / 2, ...` along `d_j = p_j direction_j`.
#[allow(clippy::too_many_arguments)] // A proof names everything it rests on.
pub fn taylor_table<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    gradient: &GradientTable,
    direction: &[f64],
    (first, count): (f64, usize),
    cancel: &Cancel,
) -> Result<Vec<Vec<TaylorRow>>, GradientError> {
    let p = model.parameters();
    let d: Vec<f64> = p.iter().zip(direction).map(|(p, d)| p * d).collect();
    let mut tables: Vec<Vec<TaylorRow>> = vec![Vec::new(); of.len()];
    for k in 0..count {
        let step = first / (1u64 << k) as f64;
        let shifted: Vec<f64> = p.iter().zip(&d).map(|(p, d)| p + step * d).collect();
        let orbit = settle(&model.with_parameters(&shifted)?, options, Some(at), cancel)?;
        for ((table, quantity), row) in tables.iter_mut().zip(of).zip(&gradient.rows) {
            let here = at.value(quantity);
            let change = orbit.value(quantity) - here;
            let slope: f64 = row.iter().zip(&d).map(|(g, d)| g * d).sum();
            let remainder = (change - step * slope).abs() / here.abs();
            let order = table.last().map(|last: &TaylorRow| (last.remainder / remainder).log2());
            table.push(TaylorRow { step, change: change.abs() / here.abs(), remainder, order });
        }
    }
    Ok(tables)
}

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

/// Change below this (relative) is rounding.
const ROUNDING: f64 = 1e-11;

/// What a Taylor table says, in words.
pub fn verdict(table: &[TaylorRow]) -> String {
    let orders: Vec<f64> =
        table.iter().filter(|r| r.remainder > 10.0 * ROUNDING).filter_map(|r| r.order).collect();
    let linear =
        !table.is_empty() && table.iter().all(|r| r.remainder <= 100.0 * ROUNDING.max(1e-4 * r.change));
    let worst = orders.iter().copied().fold(f64::INFINITY, f64::min);
    match table.len() {
        0 => "not checked".to_owned(),
        _ if linear && orders.iter().all(|o| *o < 1.5) => {
            "exact: linear along this direction up to rounding".to_owned()
        }
        _ if orders.is_empty() => "exact: the remainder is rounding".to_owned(),
        _ if worst >= 1.8 => format!("exact: the remainder falls with order {worst:.2} or better"),
        _ => kink(table, &orders),
    }
}

/// Order two between first and last step, but not at every step: pieces of the cavitation boundary are crossed on the way.
fn kink(table: &[TaylorRow], orders: &[f64]) -> String {
    let (first, last) = (table[0], table[table.len() - 1]);
    let overall = (first.remainder / last.remainder).log2() / (first.step / last.step).log2();
    if overall >= 1.7 {
        return format!(
            "exact: order {overall:.2} over all steps; single steps cross a kink of the cavitation boundary"
        );
    }
    let listed: Vec<String> = orders.iter().map(|o| format!("{o:.1}")).collect();
    format!("kink or error: the remainder falls with orders {}", listed.join(", "))
}

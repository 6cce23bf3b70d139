//! Taylor-remainder test: the proof of a gradient that any user can run on any model.
//!
//! Along a direction `d`, `|Q(p + h d) - Q(p)|` falls like `h` and `|Q(p + h d) - Q(p) - h dQ/dp d|` like `h^2` if, and
//! only if, the gradient is right. A quantity linear along `d` has no remainder but rounding: it counts as passed.

use super::finite::{neighbour, tight};
use super::{GradientError, GradientTable};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitOptions, Quantity, settle};
use crate::run::Cancel;
use serde::{Deserialize, Serialize};

/// Change below this (relative) is rounding.
const ROUNDING: f64 = 1e-11;

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

/// Taylor table of each quantity for step lengths `first, first / 2, ...` along `d_j = scale_j direction_j` (the parameter's own size, unless it is zero).
#[allow(clippy::too_many_arguments)] // A proof names everything it rests on.
pub fn taylor_table<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    gradient: &GradientTable,
    direction: &[f64],
    lengths: (f64, usize),
    cancel: &Cancel,
) -> Result<Vec<Vec<TaylorRow>>, GradientError> {
    let sides = walk(model, at, options, of, gradient, direction, lengths, cancel)?;
    Ok(sides.into_iter().map(|side| side.table).collect())
}

/// What was found along a direction.
pub(super) struct Walk {
    /// Taylor table.
    pub table: Vec<TaylorRow>,
    /// Change of the quantity over the step, by the gradient.
    pub expected: f64,
    /// The same, found with the finest step.
    pub found: f64,
}

/// Walks along a direction; one [`Walk`] per quantity.
#[allow(clippy::too_many_arguments)] // As above.
pub(super) fn walk<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    gradient: &GradientTable,
    direction: &[f64],
    (first, count): (f64, usize),
    cancel: &Cancel,
) -> Result<Vec<Walk>, GradientError> {
    let smallest = first / (1u64 << count.max(1)) as f64;
    let options = &tight(options, smallest);
    let base = settle(model, options, Some(at), cancel)?;
    let d: Vec<f64> = direction.iter().enumerate().map(|(j, d)| model.parameter_scale(j) * d).collect();
    let slope = |row: &Vec<f64>| row.iter().zip(&d).map(|(g, d)| g * d).sum::<f64>();
    let start = |row| Walk { table: Vec::new(), expected: slope(row), found: 0.0 };
    let mut walks: Vec<Walk> = gradient.rows.iter().map(start).collect();
    for k in 0..count {
        let step = first / (1u64 << k) as f64;
        let along = |j: usize| d.get(j).map_or(0.0, |d| step * d);
        let (_, orbit) = neighbour(model, at, options, along, cancel)?;
        for (walk, quantity) in walks.iter_mut().zip(of) {
            let here = base.value(quantity);
            let change = orbit.value(quantity) - here;
            // What is zero and stays so has no size to be measured by.
            let size = if here == 0.0 { 1.0 } else { here.abs() };
            let remainder = (change - step * walk.expected).abs() / size;
            let order = walk.table.last().map(|last| (last.remainder / remainder).log2());
            let order = order.filter(|o| o.is_finite());
            walk.table.push(TaylorRow { step, change: change.abs() / size, remainder, order });
            walk.found = change / step;
        }
    }
    Ok(walks)
}

/// What a Taylor table says, in words. The finest steps decide: larger ones may cross a kink on their way. Remainders near
/// rounding count only where they go on falling.
pub fn verdict(table: &[TaylorRow]) -> String {
    let telling: Vec<&TaylorRow> = table.iter().filter(|r| r.remainder > 10.0 * ROUNDING).collect();
    if table.is_empty() {
        return "not checked".to_owned();
    }
    if telling.len() < 2 {
        return "exact: linear along this direction, the remainder is rounding".to_owned();
    }
    let above = words(&telling);
    let all: Vec<&TaylorRow> = table.iter().collect();
    match (above.starts_with("exact"), telling.len() < all.len()) {
        (true, true) => format!("{above}; what lies below {:.0e} is rounding", 10.0 * ROUNDING),
        (false, true) => Some(words(&all)).filter(|w| w.starts_with("exact")).unwrap_or(above),
        _ => above,
    }
}

fn words(telling: &[&TaylorRow]) -> String {
    let orders: Vec<f64> = telling.iter().filter_map(|r| r.order).collect();
    let good = orders.iter().rev().take_while(|o| **o >= 1.7).count();
    let worst = orders.iter().rev().take(good).copied().fold(f64::INFINITY, f64::min);
    if good == orders.len() {
        return format!("exact: the remainder falls with order {worst:.2} or better");
    }
    if good >= 2 {
        let below = telling[telling.len() - good].step;
        return format!(
            "exact: order {worst:.2} or better from step {below:.0e} down; a larger step crosses a kink"
        );
    }
    let listed: Vec<String> = orders.iter().map(|o| format!("{o:.1}")).collect();
    format!("kink or error: the remainder falls with orders {}", listed.join(", "))
}

/// Whether the remainders fall as those of a right gradient.
pub(super) fn falls(table: &[TaylorRow]) -> bool {
    verdict(table).starts_with("exact")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(remainders: &[f64]) -> Vec<TaylorRow> {
        let row = |(k, r): (usize, &f64)| TaylorRow {
            step: 1e-3 / (1u64 << k) as f64,
            change: 1e-3,
            remainder: *r,
            order: (k > 0).then(|| (remainders[k - 1] / r).log2()),
        };
        remainders.iter().enumerate().map(row).collect()
    }

    #[test]
    fn verdicts_tell_right_from_wrong() {
        assert!(verdict(&table(&[1.6e-5, 4e-6, 1e-6, 2.5e-7])).starts_with("exact: the remainder falls"));
        assert!(verdict(&table(&[2e-7, 4e-6, 1e-6, 2.5e-7])).contains("a larger step crosses a kink"));
        assert!(verdict(&table(&[8e-6, 4e-6, 2e-6, 1e-6])).starts_with("kink or error"));
        assert!(verdict(&table(&[1e-15, 3e-16, 2e-15])).starts_with("exact: linear"));
        assert_eq!(verdict(&[]), "not checked");
    }
}

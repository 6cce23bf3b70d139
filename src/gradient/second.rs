//! Hessian-vector products: how gradients change along a direction.
//!
//! ```text
//! H d = (g(p + e d) - g(p - e d)) / 2e + O(e^2),      g the adjoint gradient of a settled cycle
//! ```
//!
//! Differences of adjoints, because an adjoint is exact: the error is that of one central difference, not of two, and one
//! product costs two settled cycles (from the known one, so less than two simulations) and two adjoints, whatever the number
//! of parameters. Where the direction crosses a kink within `e`, so does the product; a larger step shows it. Deliberately not here: what is
//! done with the curvature.

use super::balanced::Adjoint;
use super::finite::{neighbour, tight};
use super::{GradientEngine, GradientError};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitOptions, Quantity};
use crate::run::{Cancel, Cost};
use rayon::prelude::*;

/// Hessians of several quantities times one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct HessianProduct {
    /// One row per quantity, one entry per parameter, SI units.
    pub rows: Vec<Vec<f64>>,
    /// Work done.
    pub cost: Cost,
}

/// `H d` of each quantity at the settled cycle `at`, by central differences of adjoints over `p -+ step * d`.
///
/// `direction` has one entry per parameter (cycle unknowns left out), in the parameters' units; `step` should move them by
/// about 1e-4 of their size: less drowns in what settling leaves, more in the third derivative.
pub fn hessian_times<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    direction: &[f64],
    step: f64,
    cancel: &Cancel,
) -> Result<HessianProduct, GradientError> {
    let options = &tight(options, step);
    let side = |sign: f64| -> Result<HessianProduct, GradientError> {
        let along = |j: usize| direction.get(j).map_or(0.0, |d| sign * step * d);
        let (model, orbit) = neighbour(model, at, options, along, cancel)?;
        let table = Adjoint.gradient(&model, &orbit, options, of, cancel)?;
        Ok(HessianProduct { rows: table.rows, cost: orbit.cost + table.cost })
    };
    let sides: Result<Vec<HessianProduct>, GradientError> = [1.0, -1.0].into_par_iter().map(side).collect();
    let sides = sides?;
    let row = |(above, below): (&Vec<f64>, &Vec<f64>)| {
        above.iter().zip(below).map(|(a, b)| (a - b) / (2.0 * step)).collect()
    };
    Ok(HessianProduct {
        rows: sides[0].rows.iter().zip(&sides[1].rows).map(row).collect(),
        cost: sides[0].cost + sides[1].cost,
    })
}

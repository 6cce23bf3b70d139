//! One-sided differences at many perturbations: the same settled cycles serve FW, BW and CEN.
//!
//! Cycles that share nothing run in parallel; each starts from the settled cycle at the point. Deliberately not here:
//! what the differences say about a gradient (see [`super::check_gradient`]).

use super::finite::{Difference, neighbour, tight};
use super::{GradientError, GradientTable};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitError, OrbitOptions, Quantity, settle};
use crate::run::{Cancel, Cost};
use rayon::prelude::*;

/// Share of the largest momentary value below which the derivatives of a quantity are small.
const CANCELLED: f64 = 1e-4;

/// Forward and backward differences of all quantities by all parameters at one perturbation.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferenceStep {
    /// Relative perturbation.
    pub perturbation: f64,
    /// Forward differences: one row per quantity, one entry per parameter; empty if a cycle failed.
    pub forward: Vec<Vec<f64>>,
    /// Backward differences.
    pub backward: Vec<Vec<f64>>,
    /// Work of the cycles ahead and behind.
    pub cost: [Cost; 2],
    /// Why there are no differences, if so.
    pub failure: Option<String>,
}

impl DifferenceStep {
    /// The differences of one kind.
    pub fn rows(&self, difference: Difference) -> Vec<Vec<f64>> {
        match difference {
            Difference::Forward => self.forward.clone(),
            Difference::Backward => self.backward.clone(),
            Difference::Central => {
                let mean =
                    |(f, b): (&Vec<f64>, &Vec<f64>)| f.iter().zip(b).map(|(f, b)| 0.5 * (f + b)).collect();
                self.forward.iter().zip(&self.backward).map(mean).collect()
            }
        }
    }
}

/// A side of a parameter, settled.
type Side = Result<(Vec<f64>, Cost), GradientError>;

/// Differences at each perturbation around `at`, which is settled as sharply as its neighbours.
pub(super) fn differences<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    perturbations: &[f64],
    cancel: &Cancel,
) -> Result<Vec<DifferenceStep>, GradientError> {
    let varied = super::varied(model, at);
    // As sharp as rounding allows, for all perturbations: what settling leaves then shrinks like noise towards the large ones,
    // and cannot be taken for a kink.
    let options = &tight(options, 0.0);
    let sharp = settle(model, options, Some(at), cancel)?;
    let here: Vec<f64> = of.iter().map(|q| sharp.value(q)).collect();
    let settled = |job: usize| -> Side {
        let (k, j, sign) =
            (job / (2 * varied), job / 2 % varied, if job.is_multiple_of(2) { 1.0 } else { -1.0 });
        let only = |i: usize| if i == j { sign * perturbations[k] * model.parameter_scale(j) } else { 0.0 };
        let (_, orbit) = neighbour(model, at, options, only, cancel)?;
        Ok((of.iter().map(|q| orbit.value(q)).collect(), orbit.cost))
    };
    let sides: Vec<Side> = (0..2 * varied * perturbations.len()).into_par_iter().map(settled).collect();
    let scales: Vec<f64> = (0..varied).map(|j| model.parameter_scale(j)).collect();
    let steps = perturbations.iter().zip(sides.chunks(2 * varied));
    steps.map(|(eps, sides)| step(*eps, &here, &scales, sides)).collect()
}

/// The differences at one perturbation from its cycles, the ones ahead and behind in turn.
fn step(eps: f64, here: &[f64], scales: &[f64], sides: &[Side]) -> Result<DifferenceStep, GradientError> {
    let none = vec![vec![0.0; scales.len()]; here.len()];
    let mut found = DifferenceStep {
        perturbation: eps,
        forward: none.clone(),
        backward: none,
        cost: [Cost::default(); 2],
        failure: None,
    };
    for (k, side) in sides.iter().enumerate() {
        let (j, behind) = (k / 2, k % 2);
        match side {
            Ok((values, cost)) => {
                let sign = [1.0, -1.0][behind];
                let rows = if behind == 0 { &mut found.forward } else { &mut found.backward };
                for ((row, value), here) in rows.iter_mut().zip(values).zip(here) {
                    row[j] = sign * (value - here) / (eps * scales[j]);
                }
                found.cost[behind] += *cost;
            }
            Err(e @ (GradientError::Cancelled(_) | GradientError::Orbit(OrbitError::Cancelled(_)))) => {
                return Err(e.clone());
            }
            Err(e) => found.failure = Some(e.to_string()),
        }
    }
    if found.failure.is_some() {
        (found.forward, found.backward) = (Vec::new(), Vec::new());
    }
    Ok(found)
}

/// Largest difference of two rows in elasticities, relative to `size`, and the parameter it belongs to.
pub(super) fn miss(a: &[f64], b: &[f64], scales: &[f64], size: f64) -> (f64, usize) {
    let each = a.iter().zip(b).zip(scales).map(|((a, b), s)| ((a - b) * s).abs() / size);
    each.enumerate().fold((0.0, 0), |worst, (j, e)| if e > worst.0 || e.is_nan() { (e, j) } else { worst })
}

/// Largest elasticity of a row, but no less than a share of the largest momentary value: a mean that cancels to nothing (the
/// net flow of a film without supply) has derivatives of rounding only, which are to be told from errors.
pub(super) fn row_size(table: &GradientTable, quantity: usize, scales: &[f64], largest: f64) -> f64 {
    let row = table.rows[quantity].iter().zip(scales);
    let size = row.fold(CANCELLED * largest, |m, (g, s)| m.max((g * s).abs()));
    if size > 0.0 { size } else { 1.0 }
}

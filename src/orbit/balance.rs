//! Cycle unknowns: Broyden's method around the settled cycle, `R(mean y(u), u) = 0`.
//!
//! Each round settles the cycle at the unknowns of the moment, from the cycle of the round before, only as sharply as the
//! round deserves; the Jacobian starts from the model's guess and learns from every round (Broyden 1965). The last
//! round is settled to the full tolerance, so the result does not depend on the way.

use super::settle::settle_fixed;
use super::{Orbit, OrbitError, OrbitOptions};
use crate::dae::{CycleEquations, LinearisedDae};
use crate::run::{Cancel, Cost};
use nalgebra::{DMatrix, DVector};

/// Rounds granted.
const MOST_ROUNDS: usize = 40;
/// A round is settled to this share of the change of the unknowns that led to it.
const SHARE: f64 = 1e-1;
/// Tolerance of the first round.
const FIRST: f64 = 1e-2;
/// Largest change of an unknown in one round, in units of its scale.
const LONGEST: f64 = 2.0;
/// The unknowns are settled to this multiple of the tolerance of the cycle.
const MULTIPLE: f64 = 10.0;

pub(super) fn settle_balanced<M: LinearisedDae>(
    model: &M,
    equations: &dyn CycleEquations,
    options: &OrbitOptions,
    start: Option<&Orbit>,
    cancel: &Cancel,
) -> Result<Orbit, OrbitError> {
    let mut p = model.parameters().to_vec();
    let (k, wanted) = (equations.unknowns(), MULTIPLE * options.periodicity_tolerance);
    let first = p.len() - k;
    if let Some(known) = start.filter(|o| o.parameters.len() == p.len()) {
        p[first..].copy_from_slice(&known.parameters[first..]);
    }
    let scale = equations.scale();
    let mut near = start.cloned();
    let mut sharpness = if start.is_some() { FIRST * 1e-2 } else { FIRST };
    let mut jacobian: Option<DMatrix<f64>> = None;
    let mut before: Option<(DVector<f64>, DVector<f64>)> = None;
    let (mut cost, mut cycles, mut residual) = (Cost::default(), 0.0, f64::INFINITY);
    for _ in 0..MOST_ROUNDS {
        let tolerance = sharpness.max(options.periodicity_tolerance);
        let now = OrbitOptions { periodicity_tolerance: tolerance, ..*options };
        let orbit = settle_fixed(&model.with_parameters(&p)?, &now, near.as_ref(), cancel)?;
        cost += orbit.cost;
        cycles += orbit.cycles;
        let (r, means) = residual_of(equations, &orbit, &p);
        let b = jacobian.get_or_insert_with(|| rows(&equations.guess(&means, &p)));
        if let Some((step, old)) = &before {
            // Broyden's update: what the last step taught about the Jacobian.
            let miss = &r - old - &*b * step;
            *b += miss * step.transpose() / step.dot(step);
        }
        let Some(mut step) = b.clone().lu().solve(&(-&r)) else { break };
        residual = step.iter().zip(&scale).map(|(d, s)| (d / s).abs()).fold(0.0, f64::max);
        if residual <= wanted && tolerance <= options.periodicity_tolerance {
            let cost = Cost { simulations: 1, ..cost };
            return Ok(Orbit { balance: residual, cycles, cost, ..orbit });
        }
        if !residual.is_finite() {
            break;
        }
        if residual > LONGEST {
            step *= LONGEST / residual;
        }
        sharpness = SHARE * residual.min(LONGEST);
        if residual > wanted {
            p[first..].iter_mut().zip(step.iter()).for_each(|(u, d)| *u += d);
            before = Some((step, r));
        }
        near = Some(orbit);
    }
    Err(OrbitError::NotBalanced { rounds: MOST_ROUNDS, residual })
}

fn residual_of(equations: &dyn CycleEquations, orbit: &Orbit, p: &[f64]) -> (DVector<f64>, Vec<f64>) {
    let means: Vec<f64> = equations.outputs().iter().map(|&o| orbit.mean(o)).collect();
    (DVector::from_vec(equations.residual(&means, p)), means)
}

fn rows(list: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(list.len(), list.len(), |i, j| list[i][j])
}

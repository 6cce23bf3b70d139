//! Cycle unknowns: Broyden's method around the settled cycle, `R(mean y(u), u) = 0`.
//!
//! Each round settles the cycle at the unknowns of the moment, from the cycle of the round before, only as sharply as the
//! round deserves; the Jacobian starts from the model's guess (or from that of a similar cycle) and learns from every
//! round (Broyden 1965). From the third round on the states are continued along the change of the unknowns, so that one pass
//! a round is enough. The last round is settled to the full tolerance, so the result does not depend on the way.

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
    let known = start.filter(|o| o.parameters.len() == p.len());
    if let Some(known) = known {
        p[first..].copy_from_slice(&known.parameters[first..]);
    }
    let mut jacobian = known.filter(|o| o.response.len() == k).map(|o| rows(&o.response));
    let scale = equations.scale();
    let (mut near, mut older): (Option<Orbit>, Option<Orbit>) = (start.cloned(), None);
    let mut sharpness = if start.is_some() { FIRST * 1e-2 } else { FIRST };
    let mut before: Option<(DVector<f64>, DVector<f64>)> = None;
    let (mut cost, mut cycles, mut corrections) = (Cost::default(), 0.0, 0);
    let mut residual = f64::INFINITY;
    for _ in 0..MOST_ROUNDS {
        let tolerance = sharpness.max(options.periodicity_tolerance);
        let now = OrbitOptions { periodicity_tolerance: tolerance, ..*options };
        let orbit = settle_fixed(&model.with_parameters(&p)?, &now, near.as_ref(), cancel)?;
        cost += orbit.cost;
        cycles += orbit.cycles;
        corrections += orbit.corrections;
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
            let response = b.row_iter().map(|r| r.iter().copied().collect()).collect();
            return Ok(Orbit { balance: residual, cycles, corrections, response, cost, ..orbit });
        }
        if !residual.is_finite() {
            break;
        }
        if residual > LONGEST {
            step *= LONGEST / residual;
        }
        sharpness = SHARE * residual.min(LONGEST);
        let mut share = 0.0;
        if residual > wanted {
            p[first..].iter_mut().zip(step.iter()).for_each(|(u, d)| *u += d);
            share = before.as_ref().map_or(0.0, |(last, _)| step.dot(last) / last.dot(last));
            before = Some((step, r));
        }
        let next = continued(&model.with_parameters(&p)?, &orbit, older.as_ref(), share);
        older = Some(orbit);
        near = Some(next);
    }
    Err(OrbitError::NotBalanced { rounds: MOST_ROUNDS, residual })
}

/// The cycle of the next round, guessed from the last two: `share` is the next change of the unknowns over the last one.
fn continued<M: LinearisedDae>(model: &M, now: &Orbit, older: Option<&Orbit>, share: f64) -> Orbit {
    let mut next = now.clone();
    let Some(older) = older.filter(|_| share != 0.0 && share.abs() <= 1.0) else { return next };
    let kept = next.states.iter_mut().zip(&older.states).filter(|(z, old)| !z.is_empty() && !old.is_empty());
    for (z, old) in kept {
        let change: Vec<f64> = z.iter().zip(old).map(|(z, old)| share * (z - old)).collect();
        let admissible = model.admissible(z, &change);
        model.advance(z, &change, admissible);
    }
    next
}

fn residual_of(equations: &dyn CycleEquations, orbit: &Orbit, p: &[f64]) -> (DVector<f64>, Vec<f64>) {
    let means: Vec<f64> = equations.outputs().iter().map(|&o| orbit.mean(o)).collect();
    (DVector::from_vec(equations.residual(&means, p)), means)
}

fn rows(list: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(list.len(), list.len(), |i, j| list[i][j])
}

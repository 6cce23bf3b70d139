//! A sub-problem at a kink: all gradients met within the tolerance of a point count at once.
//!
//! ```text
//! minimise t + d'Bd/2   subject to   g_i d <= t,   c + C_i d <= 0,   G_i d + g = 0 at the point itself,   lower <= d <= upper
//! ```
//!
//! The objective of a film with a moving cavity edge is smooth but for kinks. Where the optimum lies on one, no single gradient
//! vanishes; a convex combination of those on its sides does (Goldstein 1977, Clarke 1983). The multipliers of `g_i d <= t` are its
//! shares, and the residual of the combined conditions is what [`super::Sqp`] judges optimality by.

use super::kkt::kkt_residual;
use super::qp::{Qp, QpSolution};
use super::state::Iterate;
use super::{LinearConstraint, Multipliers, Slopes, Values};
use nalgebra::DMatrix;

/// Points whose gradients are kept.
pub(super) const KEPT: usize = 6;

/// Step, multipliers and KKT residual with the gradients of `near` beside those of `now`; `None` if Clarabel gives up.
pub(super) fn solve(
    now: &Iterate,
    near: &[&Iterate],
    hessian: &DMatrix<f64>,
    linear: &[LinearConstraint],
    (lower, upper): (&[f64], &[f64]),
) -> Option<(QpSolution, f64)> {
    let (n, m) = (now.x.len(), now.values.inequalities.len());
    let all: Vec<&Slopes> = std::iter::once(&now.slopes).chain(near.iter().map(|i| &i.slopes)).collect();
    let wider = |row: &[f64], t: f64| -> Vec<f64> { row.iter().copied().chain([t]).collect() };
    let mut values =
        Values { objective: 0.0, inequalities: Vec::new(), equalities: now.values.equalities.clone() };
    let mut slopes = Slopes {
        objective: wider(&vec![0.0; n], 1.0),
        inequalities: Vec::new(),
        equalities: now.slopes.equalities.iter().map(|row| wider(row, 0.0)).collect(),
    };
    for s in &all {
        values.inequalities.push(0.0);
        slopes.inequalities.push(wider(&s.objective, -1.0));
        values.inequalities.extend(&now.values.inequalities);
        slopes.inequalities.extend(s.inequalities.iter().map(|row| wider(row, 0.0)));
    }
    let wide = hessian.clone().resize(n + 1, n + 1, 0.0);
    let (lower, upper) = (wider(lower, f64::NEG_INFINITY), wider(upper, f64::INFINITY));
    let wider_row = |r: &LinearConstraint| LinearConstraint { factors: wider(&r.factors, 0.0), ..r.clone() };
    let rows: Vec<LinearConstraint> = linear.iter().map(wider_row).collect();
    let model =
        Qp { hessian: &wide, values: &values, slopes: &slopes, linear: &rows, lower: &lower, upper: &upper };
    let found = model.solve()?;
    let multipliers = &found.multipliers.inequalities;
    let (mut combined, mut prices) = (vec![0.0; n], vec![0.0; m]);
    for (s, shares) in all.iter().zip(multipliers.chunks_exact(m + 1)) {
        let rows = std::iter::once(&s.objective).chain(&s.inequalities);
        for (row, share) in rows.zip(shares) {
            combined.iter_mut().zip(row).for_each(|(c, v)| *c += share * v);
        }
        prices.iter_mut().zip(&shares[1..]).for_each(|(p, share)| *p += share);
    }
    let cut = |v: &[f64]| v[..n].to_vec();
    let solution = QpSolution {
        step: cut(&found.step),
        multipliers: Multipliers {
            inequalities: prices,
            equalities: found.multipliers.equalities.clone(),
            lower: cut(&found.multipliers.lower),
            upper: cut(&found.multipliers.upper),
            linear: found.multipliers.linear.clone(),
        },
        elastic: found.elastic,
    };
    // The combination already holds the constraints' shares.
    let zero = vec![vec![0.0; n]; m];
    let combination =
        Slopes { objective: combined, inequalities: zero, equalities: now.slopes.equalities.clone() };
    let residual = kkt_residual(&now.values, &combination, linear, &solution);
    Some((solution, residual))
}

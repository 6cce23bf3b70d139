//! How far a point is from the conditions of Karush, Kuhn and Tucker.

use super::qp::QpSolution;
use super::{LinearConstraint, Multipliers, Slopes, Values};
use nalgebra::DVector;

/// Gradient of the Lagrangian without the bounds.
pub(super) fn lagrangian(slopes: &Slopes, multipliers: &Multipliers) -> DVector<f64> {
    let mut g = DVector::from_column_slice(&slopes.objective);
    let rows = slopes.inequalities.iter().zip(&multipliers.inequalities);
    for (row, m) in rows.chain(slopes.equalities.iter().zip(&multipliers.equalities)) {
        g += DVector::from_column_slice(row) * *m;
    }
    g
}

/// Largest of stationarity, complementarity and violation at a point, with the multipliers of its sub-problem. A bound's
/// multiplier counts against the step that is left: it must vanish unless the point stands on the bound. Linear constraints are
/// given for steps from the point; what room they leave counts likewise.
pub(super) fn kkt_residual(
    values: &Values,
    slopes: &Slopes,
    linear: &[LinearConstraint],
    qp: &QpSolution,
) -> f64 {
    let m = &qp.multipliers;
    let mut gradient = lagrangian(slopes, m);
    for (row, m) in linear.iter().zip(&m.linear) {
        gradient += DVector::from_column_slice(&row.factors) * *m;
    }
    let room = linear.iter().zip(&m.linear).fold(0.0f64, |a, (row, m)| a.max((row.bound * m).abs()));
    let stationarity =
        (0..gradient.len()).fold(0.0f64, |a, j| a.max((gradient[j] - m.lower[j] + m.upper[j]).abs()));
    let complementarity =
        values.inequalities.iter().zip(&m.inequalities).fold(0.0f64, |a, (c, m)| a.max((c * m).abs()));
    let bounds = (m.lower.iter().zip(&qp.step))
        .chain(m.upper.iter().zip(&qp.step))
        .fold(0.0f64, |a, (m, d)| a.max((m * d).abs()));
    stationarity.max(complementarity).max(bounds).max(room).max(values.violation())
}

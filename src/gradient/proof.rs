//! The check of a gradient from all sides: TRA against ADJ, differences over the perturbation, Taylor remainders both ways.
//!
//! Works for any [`SensitiveDae`]. A kink is named, not passed over: it shows as one-sided slopes that differ.
//! Deliberately not here: what only a certain model knows about its kinks (a film counts its weakly active cells).

use super::finding::{Evidence, Seen, Verdict};
use super::sweep::{DifferenceStep, differences, miss, row_size};
use super::taylor::walk;
use super::{
    Adjoint, Difference, GradientEngine, GradientError, GradientTable, TaylorRow, Transient, varied,
};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitOptions, Quantity};
use crate::run::Cancel;

/// What a check is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckPlan {
    /// Quantities whose gradient is checked.
    pub quantities: Vec<Quantity>,
    /// Relative perturbations of the differences; none for a check without differences.
    pub perturbations: Vec<f64>,
    /// Direction of the Taylor test, one entry per parameter in units of the parameter's scale.
    pub direction: Vec<f64>,
    /// First step (relative) and number of halved steps of the Taylor test.
    pub lengths: (f64, usize),
    /// Names of the parameters for verdicts; those without one are counted from 1.
    pub names: Vec<String>,
}

impl CheckPlan {
    /// Perturbations from 1e-3 to 1e-8 and a direction without symmetry, so that errors of single parameters cannot cancel.
    pub fn usual(quantities: Vec<Quantity>, names: Vec<String>) -> Self {
        let direction = (0..names.len()).map(|j| [0.6, -0.8, 1.0, 0.4][j % 4]).collect();
        let perturbations = (3..=8).map(|k| 10f64.powi(-k)).collect();
        Self { quantities, perturbations, direction, lengths: (1e-4, 6), names }
    }
}

/// The checked gradient of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantityCheck {
    /// Value at the point.
    pub value: f64,
    /// Largest difference of TRA and ADJ, relative to the largest elasticity of the row, like all errors here.
    pub mismatch: f64,
    /// Error of FW, BW and CEN against ADJ at each perturbation; none where a cycle failed.
    pub errors: Vec<Option<[f64; 3]>>,
    /// Taylor table along the direction.
    pub ahead: Vec<TaylorRow>,
    /// Taylor table against it.
    pub behind: Vec<TaylorRow>,
    /// Slope along the direction: found ahead, found behind, by ADJ; per unit of the relative step.
    pub slopes: [f64; 3],
    /// What all of it says.
    pub verdict: Verdict,
}

/// A checked gradient.
#[derive(Debug, Clone, PartialEq)]
pub struct GradientCheck {
    /// Gradient by ADJ.
    pub adj: GradientTable,
    /// Gradient by TRA.
    pub tra: GradientTable,
    /// Differences, in the order of the perturbations.
    pub steps: Vec<DifferenceStep>,
    /// One entry per quantity.
    pub quantities: Vec<QuantityCheck>,
}

/// Checks the gradient of a model at its settled cycle.
pub fn check_gradient<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    plan: &CheckPlan,
    cancel: &Cancel,
) -> Result<GradientCheck, GradientError> {
    let adj = Adjoint.gradient(model, at, options, &plan.quantities, cancel)?;
    let tra = Transient.gradient(model, at, options, &plan.quantities, cancel)?;
    check_tables(model, at, options, plan, (adj, tra), cancel)
}

/// Checks gradients of your own making, in place of those of ADJ and TRA.
pub fn check_tables<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    plan: &CheckPlan,
    (adj, tra): (GradientTable, GradientTable),
    cancel: &Cancel,
) -> Result<GradientCheck, GradientError> {
    let of = &plan.quantities;
    let steps = differences(model, at, options, of, &plan.perturbations, cancel)?;
    let along = |sign: f64| {
        let direction: Vec<f64> = plan.direction.iter().map(|d| sign * d).collect();
        walk(model, at, options, of, &adj, &direction, plan.lengths, cancel)
    };
    let scales: Vec<f64> = (0..varied(model, at)).map(|j| model.parameter_scale(j)).collect();
    let quantities = along(1.0)?.into_iter().zip(along(-1.0)?).enumerate().map(|(k, (ahead, behind))| {
        let (value, walks) = (at.value(&of[k]), [ahead, behind]);
        let largest = at.outputs.iter().map(|y| y[of[k].output].abs()).fold(0.0, f64::max);
        let size = row_size(&adj, k, &scales, largest);
        let mut seen: Vec<Seen> =
            steps.iter().filter_map(|s| seen(s, k, &adj.rows[k], &scales, size)).collect();
        seen.sort_by(|a, b| b.perturbation.total_cmp(&a.perturbation));
        let (tra, adj, names) = (&tra.rows[k], &adj.rows[k], &plan.names);
        let verdict = Evidence { tra, adj, scales: &scales, size, seen, walks: &walks, names }.verdict();
        let error = |step: &DifferenceStep, kind| miss(&step.rows(kind)[k], adj, &scales, size).0;
        let errors = |step: &DifferenceStep| {
            let all = [Difference::Forward, Difference::Backward, Difference::Central];
            step.failure.is_none().then(|| all.map(|kind| error(step, kind)))
        };
        let [ahead, behind] = walks;
        QuantityCheck {
            value,
            mismatch: miss(tra, adj, &scales, size).0,
            errors: steps.iter().map(errors).collect(),
            slopes: [ahead.found, -behind.found, ahead.expected],
            ahead: ahead.table,
            behind: behind.table,
            verdict,
        }
    });
    let quantities = quantities.collect();
    Ok(GradientCheck { adj, tra, steps, quantities })
}

/// One quantity at one perturbation against ADJ.
fn seen(step: &DifferenceStep, quantity: usize, adj: &[f64], scales: &[f64], size: f64) -> Option<Seen> {
    let off = |kind| -> Option<Vec<f64>> {
        let rows = step.rows(kind);
        let row = rows.get(quantity)?;
        Some(row.iter().zip(adj).zip(scales).map(|((a, b), s)| (a - b) * s / size).collect())
    };
    let off = [off(Difference::Forward)?, off(Difference::Backward)?, off(Difference::Central)?];
    Some(Seen { perturbation: step.perturbation, off })
}

//! Gradients of a running-in by the five engines, all with the blocks of the march frozen.
//!
//! FW, BW, CEN replay the programme at moved variables; TRA carries tangents of the surfaces forward, ADJ worths of them back.
//! They see the same discrete march, so TRA and ADJ agree to what the cycles agree to, and differences to what their step allows.

use super::adjoint::march_adjoint;
use super::march::{March, replay};
use super::quantity::RunningInQuantity;
use super::stage::{MarchError, MarchOptions, Stage, variable_count};
use super::tangent::march_tangent;
use crate::gradient::{EngineName, tight};
use crate::run::{Cancel, Cost};
use rayon::prelude::*;

/// Derivatives of quantities of a running-in.
#[derive(Debug, Clone, PartialEq)]
pub struct RunningInGradient {
    /// One row per quantity, one entry per variable of the programme.
    pub rows: Vec<Vec<f64>>,
    /// Work done, the march itself not included.
    pub cost: Cost,
}

/// How the engines of a running-in are asked.
#[derive(Debug, Clone, Copy)]
pub struct MarchEngine<'a> {
    /// Which one.
    pub name: EngineName,
    /// Step of every variable for the differences, in its own unit.
    pub steps: &'a [f64],
}

/// Gradients of quantities by everything a programme depends on.
pub fn march_gradient(
    engine: MarchEngine<'_>,
    stages: &[Stage],
    march: &March,
    options: &MarchOptions,
    of: &[RunningInQuantity],
    cancel: &Cancel,
) -> Result<RunningInGradient, MarchError> {
    let last = stages.last().ok_or_else(|| MarchError::Parameters("no stages".to_owned()))?;
    let asked = Asked { stages, last, march, options, of, cancel };
    match engine.name {
        EngineName::Adj => march_adjoint(asked),
        EngineName::Tra => march_tangent(asked),
        EngineName::Fw => differences(engine.steps, (0.0, 1.0), asked),
        EngineName::Bw => differences(engine.steps, (-1.0, 0.0), asked),
        EngineName::Cen => differences(engine.steps, (-1.0, 1.0), asked),
    }
}

/// What every engine is asked: gradients of these quantities of this march.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub stages: &'a [Stage],
    pub last: &'a Stage,
    pub march: &'a March,
    pub options: &'a MarchOptions,
    pub of: &'a [RunningInQuantity],
    pub cancel: &'a Cancel,
}

/// Differences between two sides, in steps from the variables; side 0 is the march itself.
fn differences(
    steps: &[f64],
    sides: (f64, f64),
    Asked { stages, march, options, of, cancel, .. }: Asked<'_>,
) -> Result<RunningInGradient, MarchError> {
    let (shares, variables) = (march.shares(stages), variable_count(stages));
    // As sharp as rounding allows: what settling leaves must be small against what a step changes.
    let options = &MarchOptions { orbit: tight(&options.orbit, 0.0), ..*options };
    let mut found = RunningInGradient { rows: vec![vec![0.0; variables]; of.len()], cost: Cost::default() };
    let values = |stages: &[Stage], march: &March| -> Vec<f64> {
        let model = stages.last().map(|s| &s.model);
        model.map_or_else(Vec::new, |model| of.iter().map(|q| q.value(&march.course, model)).collect())
    };
    let here = if sides.0 * sides.1 == 0.0 {
        let sharp = replay(stages, &shares, options, Some(march), cancel)?;
        found.cost += sharp.course.cost;
        values(stages, &sharp)
    } else {
        Vec::new()
    };
    // Every replay starts from the march itself, so their order and number of threads change nothing.
    let column = |v: usize| -> Result<(Vec<f64>, Cost), MarchError> {
        let step = steps.get(v).copied().filter(|s| *s > 0.0);
        let step = step.ok_or_else(|| MarchError::Parameters(format!("variable {v} has no step")))?;
        let side = |sign: f64| -> Result<(Vec<f64>, Cost), MarchError> {
            if sign == 0.0 {
                return Ok((here.clone(), Cost::default()));
            }
            let moved: Result<Vec<Stage>, MarchError> =
                stages.iter().map(|s| s.moved(v, sign * step)).collect();
            let moved = moved?;
            let there = replay(&moved, &shares, options, Some(march), cancel)?;
            Ok((values(&moved, &there), there.course.cost))
        };
        let ((low, down), (high, up)) = (side(sides.0)?, side(sides.1)?);
        let slope = |(high, low): (&f64, &f64)| (high - low) / ((sides.1 - sides.0) * step);
        Ok((high.iter().zip(&low).map(slope).collect(), down + up))
    };
    let columns: Result<Vec<_>, MarchError> = (0..variables).into_par_iter().map(column).collect();
    for (v, (column, cost)) in columns?.into_iter().enumerate() {
        found.rows.iter_mut().zip(column).for_each(|(row, g)| row[v] = g);
        found.cost += cost;
    }
    Ok(found)
}

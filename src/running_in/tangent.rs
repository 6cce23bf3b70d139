//! TRA through a running-in: tangents of the surfaces by all variables, carried forward from block to block.
//!
//! With `S = dw/dx` before a block and `h' = dh/dx` of its length,
//!
//! ```text
//! k1' = K/H share dr(x, S),   k2' = K/H share dr(x, S + h k1' + h' k1),   P1', P2' likewise            dr: one tangent of a cycle
//! S+ = S + h (k1' + k2') / 2 + h' (k1 + k2) / 2,      E+' = E' + h (P1' + P2') / 2 + h' (P1 + P2) / 2
//! ```
//!
//! Each cycle is differentiated along all variables at once, for the loss and for the rubbing of every cell (the local outputs of
//! a bearing). Cost: a solve per step, cycle and variable.

use super::field::{moved, product, zeros};
use super::gradient::RunningInGradient;
use super::march::March;
use super::quantity::{RunningInQuantity, Worth, area_slope};
use super::rate::{Rate, worn};
use super::stage::{MarchError, MarchOptions, Stage, variable_count};
use crate::cranktrain::{BearingOutput, SurfaceField};
use crate::dae::Dae;
use crate::gradient::{Along, along};
use crate::orbit::{Quantity, Reduction};
use crate::run::{Cancel, Cost};
use std::sync::Arc;

/// Tangents of one cycle by all variables.
struct CycleTangent {
    loss_w: Vec<f64>,
    depths: Vec<SurfaceField>,
}

/// Gradients of quantities by all variables of a programme.
pub(super) fn march_tangent(
    stages: &[Stage],
    march: &March,
    options: &MarchOptions,
    of: &[RunningInQuantity],
    cancel: &Cancel,
) -> Result<RunningInGradient, MarchError> {
    let last = stages.last().ok_or_else(|| MarchError::Parameters("no stages".to_owned()))?;
    let n = variable_count(stages);
    let mut forward = Forward { stages, options, cancel, n, cost: Cost::default() };
    let worths: Vec<Worth> = of.iter().map(|q| q.worth(&march.course, &last.model)).collect();
    let area = area_slope(last, n);
    let mut rows: Vec<Vec<f64>> = worths.iter().map(|w| area.iter().map(|a| w.area * a).collect()).collect();
    let mut surfaces = vec![zeros(&march.course.worn_m); n];
    let mut near = None;
    for (k, block) in march.blocks.iter().enumerate() {
        let (h, in_last) = (block.length_s, block.stage + 1 == stages.len());
        let share = h / stages[block.stage].duration_s;
        let longer = |v: usize| if stages[block.stage].duration_variable == Some(v) { share } else { 0.0 };
        let [k1, k2] = [0, 1].map(|r| options.depths(&block.rates[r]));
        let [p1, p2] = [0, 1].map(|r| block.rates[r].loss_w());
        let first = forward.cycle((block.stage, &block.worn_m), &block.rates[0], &surfaces, &mut near)?;
        let reached: Vec<SurfaceField> =
            (0..n).map(|v| moved(&moved(&surfaces[v], h, &first.depths[v]), longer(v), &k1)).collect();
        let second = forward.cycle((block.stage, &block.reached_m), &block.rates[1], &reached, &mut near)?;
        let begins = in_last && (k == 0 || march.blocks[k - 1].stage != block.stage);
        for v in 0..n {
            let energy = 0.5 * (h * (first.loss_w[v] + second.loss_w[v]) + longer(v) * (p1 + p2));
            for (row, worth) in rows.iter_mut().zip(&worths) {
                let of_last = if in_last { (worth.last_energy, worth.last_duration) } else { (0.0, 0.0) };
                row[v] += (worth.energy + of_last.0) * energy + (worth.duration + of_last.1) * longer(v);
                row[v] += if begins { worth.first_loss * first.loss_w[v] } else { 0.0 };
            }
            let s = moved(&moved(&surfaces[v], 0.5 * h, &first.depths[v]), 0.5 * h, &second.depths[v]);
            surfaces[v] = moved(&moved(&s, 0.5 * longer(v), &k1), 0.5 * longer(v), &k2);
        }
    }
    if worths.iter().any(|w| w.last_loss != 0.0) {
        let end = forward.cycle(
            (stages.len() - 1, &march.course.worn_m),
            &march.course.last,
            &surfaces,
            &mut near,
        )?;
        for (row, worth) in rows.iter_mut().zip(&worths) {
            row.iter_mut().zip(&end.loss_w).for_each(|(g, p)| *g += worth.last_loss * p);
        }
    }
    for (row, worth) in rows.iter_mut().zip(&worths) {
        row.iter_mut().zip(&surfaces).for_each(|(g, s)| *g += product(&worth.worn, s));
    }
    Ok(RunningInGradient { rows, cost: forward.cost })
}

struct Forward<'a> {
    stages: &'a [Stage],
    options: &'a MarchOptions,
    cancel: &'a Cancel,
    n: usize,
    cost: Cost,
}

impl Forward<'_> {
    /// Loss and wear of a cycle along all variables, whose surfaces have the given tangents.
    fn cycle(
        &mut self,
        (stage, worn_m): (usize, &SurfaceField),
        rate: &Arc<Rate>,
        surfaces: &[SurfaceField],
        near: &mut Option<Arc<Rate>>,
    ) -> Result<CycleTangent, MarchError> {
        self.cancel.check().map_err(|_| MarchError::Cancelled)?;
        let of = &self.stages[stage];
        let rate = rate.complete((&of.model, worn_m), self.options, near, self.cancel, &mut self.cost)?;
        let model = worn(&of.model, worn_m, SurfaceField::default())?;
        let direction = |v: usize| {
            let mut parameters = vec![0.0; model.parameters().len()];
            for (p, variable) in parameters.iter_mut().zip(&of.variables) {
                *p = if *variable == v { 1.0 } else { 0.0 };
            }
            Along { parameters, fields: model.wear_along(&surfaces[v]) }
        };
        let directions: Vec<Along> = (0..self.n).map(direction).collect();
        let loss = [Quantity { output: BearingOutput::Loss.index(), reduction: Reduction::Mean }];
        let found = along(&model, &rate.orbit, &self.options.orbit, &loss, &directions, self.cancel)?;
        self.cost += found.cost;
        let depths = |locals: &Vec<f64>| {
            let (shell, journal) = locals.split_at(locals.len() / 2);
            self.options.depths_of(&SurfaceField { shell: shell.to_vec(), journal: journal.to_vec() })
        };
        let depths = found.locals.iter().map(depths).collect();
        Ok(CycleTangent { loss_w: found.rows.into_iter().next().unwrap_or_default(), depths })
    }
}

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
use super::gradient::{Asked, RunningInGradient};
use super::quantity::{Worth, area_slope, mean_of};
use super::rate::{Rate, worn};
use super::stage::{MarchError, variable_count};
use crate::cranktrain::{BearingOutput, SurfaceField};
use crate::dae::Dae;
use crate::gradient::{Along, along};
use crate::orbit::Quantity;
use crate::run::Cost;
use std::sync::Arc;

/// Tangents of one cycle by all variables.
struct CycleTangent {
    /// Of every quantity.
    rows: Vec<Vec<f64>>,
    depths: Vec<SurfaceField>,
}

/// Gradients of quantities by all variables of a programme.
pub(super) fn march_tangent(asked: Asked<'_>) -> Result<RunningInGradient, MarchError> {
    let Asked { stages, last, march, options, of, .. } = asked;
    let n = variable_count(stages);
    let mut forward = Forward { asked, n, near: None, cost: Cost::default() };
    let worths: Vec<Worth> = of.iter().map(|q| q.worth(&march.course, &last.model)).collect();
    let area = area_slope(last, n);
    let mut rows: Vec<Vec<f64>> = worths.iter().map(|w| area.iter().map(|a| w.area * a).collect()).collect();
    let mut surfaces = vec![zeros(&march.course.worn_m); n];
    let loss = [mean_of(BearingOutput::Loss)];
    for (k, block) in march.blocks.iter().enumerate() {
        let h = block.length_s;
        let share = h / stages[block.stage].duration_s;
        let longer = |v: usize| if stages[block.stage].duration_variable == Some(v) { share } else { 0.0 };
        let [k1, k2] = [0, 1].map(|r| options.depths(&block.rates[r]));
        let [p1, p2] = [0, 1].map(|r| block.rates[r].loss_w());
        let at = (block.stage, &block.worn_m);
        let first = forward.cycle(at, &block.rates[0], &loss, &surfaces)?;
        let reached: Vec<SurfaceField> =
            (0..n).map(|v| moved(&moved(&surfaces[v], h, &first.depths[v]), longer(v), &k1)).collect();
        let at = (block.stage, &block.reached_m);
        let second = forward.cycle(at, &block.rates[1], &loss, &reached)?;
        for v in 0..n {
            let energy = 0.5 * (h * (first.rows[0][v] + second.rows[0][v]) + longer(v) * (p1 + p2));
            for (row, worth) in rows.iter_mut().zip(&worths) {
                let worth = worth.of_block(march, k, stages.len());
                row[v] += worth.energy * energy + worth.duration * longer(v);
                row[v] += worth.first_loss * first.rows[0][v];
            }
            let s = moved(&moved(&surfaces[v], 0.5 * h, &first.depths[v]), 0.5 * h, &second.depths[v]);
            surfaces[v] = moved(&moved(&s, 0.5 * longer(v), &k1), 0.5 * longer(v), &k2);
        }
    }
    let in_the_end = rows.iter_mut().zip(&worths).filter_map(|(row, w)| w.last.map(|last| (row, last)));
    let (of, in_the_end): (Vec<Quantity>, Vec<_>) =
        in_the_end.map(|(row, (quantity, weight))| (quantity, (row, weight))).unzip();
    if !of.is_empty() {
        let at = (stages.len() - 1, &march.course.worn_m);
        let end = forward.cycle(at, &march.course.last, &of, &surfaces)?;
        for ((row, weight), slopes) in in_the_end.into_iter().zip(&end.rows) {
            row.iter_mut().zip(slopes).for_each(|(g, p)| *g += weight * p);
        }
    }
    for (row, worth) in rows.iter_mut().zip(&worths) {
        row.iter_mut().zip(&surfaces).for_each(|(g, s)| *g += product(&worth.worn, s));
    }
    Ok(RunningInGradient { rows, cost: forward.cost })
}

struct Forward<'a> {
    asked: Asked<'a>,
    n: usize,
    /// The cycle looked at last.
    near: Option<Arc<Rate>>,
    cost: Cost,
}

impl Forward<'_> {
    /// Quantities and wear of a cycle along all variables, whose surfaces have the given tangents.
    fn cycle(
        &mut self,
        (stage, worn_m): (usize, &SurfaceField),
        rate: &Arc<Rate>,
        of: &[Quantity],
        surfaces: &[SurfaceField],
    ) -> Result<CycleTangent, MarchError> {
        let Asked { stages, options, cancel, .. } = self.asked;
        cancel.check().map_err(|_| MarchError::Cancelled)?;
        let stage = &stages[stage];
        let at = (&stage.model, worn_m);
        let rate = rate.complete(at, options, &mut self.near, cancel, &mut self.cost)?;
        let model = worn(&stage.model, worn_m, SurfaceField::default())?;
        let direction = |v: usize| {
            let mut parameters = vec![0.0; model.parameters().len()];
            for (p, variable) in parameters.iter_mut().zip(&stage.variables) {
                *p = if *variable == v { 1.0 } else { 0.0 };
            }
            Along { parameters, fields: model.wear_along(&surfaces[v]) }
        };
        let directions: Vec<Along> = (0..self.n).map(direction).collect();
        let found = along(&model, &rate.orbit, &options.orbit, of, &directions, cancel)?;
        self.cost += found.cost;
        let depths = |locals: &Vec<f64>| {
            let (shell, journal) = locals.split_at(locals.len() / 2);
            options.depths_of(&SurfaceField { shell: shell.to_vec(), journal: journal.to_vec() })
        };
        let depths = found.locals.iter().map(depths).collect();
        Ok(CycleTangent { rows: found.rows, depths })
    }
}

//! ADJ through a running-in: what surfaces and energy are worth, carried backwards from block to block.
//!
//! With `l` the worth of the surfaces after a block and `e` that of its energy,
//!
//! ```text
//! second cycle:   weights h/2 l on k2, e h/2 on P2          ->  g2 by its surfaces w + h k1
//! first cycle:    weights h/2 l + h g2 on k1, e h/2 on P1   ->  g1 by its surfaces w
//! before:         l + g1 + g2                               by the length:  e (P1 + P2)/2 + l (k1 + k2)/2 + g2 k1
//! ```
//!
//! Each cycle is differentiated once by its adjoint, for two rows: a quantity (the loss), and the rubbing of all cells with their weights as marks.
//! Derivatives by the surfaces are those by the gap, which the adjoint has anyway.

use super::field::{moved, product, zeros};
use super::gradient::{Asked, RunningInGradient};
use super::march::Block;
use super::quantity::{BlockWorth, Worth, area_slope, mean_of};
use super::rate::{Rate, worn};
use super::stage::{MarchError, variable_count};
use crate::cranktrain::{BearingOutput, JournalBearing, SurfaceField};
use crate::gradient::{EngineName, engine};
use crate::orbit::Quantity;
use crate::run::Cost;
use std::sync::Arc;

/// Gradients of quantities by everything a programme depends on, a backward sweep over the programme for each.
pub(super) fn march_adjoint(asked: Asked<'_>) -> Result<RunningInGradient, MarchError> {
    let mut found = RunningInGradient { rows: Vec::new(), cost: Cost::default() };
    let area = area_slope(asked.last, variable_count(asked.stages));
    for quantity in asked.of {
        let worth = quantity.worth(&asked.march.course, &asked.last.model);
        let row = area.iter().map(|a| worth.area * a).collect();
        let mut back = Back { asked, row, near: None, cost: Cost::default() };
        back.run(&worth)?;
        found.rows.push(back.row);
        found.cost += back.cost;
    }
    Ok(found)
}

struct Back<'a> {
    asked: Asked<'a>,
    /// Derivatives by the variables.
    row: Vec<f64>,
    /// The cycle looked at last.
    near: Option<Arc<Rate>>,
    cost: Cost,
}

impl Back<'_> {
    fn run(&mut self, worth: &Worth) -> Result<(), MarchError> {
        let Asked { march, stages, .. } = self.asked;
        let mut later = worth.worn.clone();
        if let Some(on) = worth.last {
            let at = (stages.len() - 1, &march.course.worn_m);
            let by = self.cycle(at, &march.course.last, on, &SurfaceField::default())?;
            later = moved(&later, 1.0, &by);
        }
        for (k, block) in march.blocks.iter().enumerate().rev() {
            later = self.block(block, worth.of_block(march, k, stages.len()), &later)?;
        }
        Ok(())
    }

    /// Over a block: the worth of the surfaces before it, given that behind it.
    fn block(
        &mut self,
        block: &Block,
        worth: BlockWorth,
        later: &SurfaceField,
    ) -> Result<SurfaceField, MarchError> {
        let (h, e) = (block.length_s, worth.energy);
        let [k1, k2] = [0, 1].map(|r| self.asked.options.depths(&block.rates[r]));
        let half = moved(&zeros(later), 0.5 * h, later);
        let loss = |weight: f64| (mean_of(BearingOutput::Loss), weight);
        let at = (block.stage, &block.reached_m);
        let second = self.cycle(at, &block.rates[1], loss(0.5 * e * h), &half)?;
        let on_first = moved(&half, h, &second);
        let at = (block.stage, &block.worn_m);
        let first = self.cycle(at, &block.rates[0], loss(0.5 * e * h + worth.first_loss), &on_first)?;
        let losses = block.rates[0].loss_w() + block.rates[1].loss_w();
        let by_length = worth.duration
            + 0.5 * e * losses
            + 0.5 * (product(later, &k1) + product(later, &k2))
            + product(&second, &k1);
        let stage = &self.asked.stages[block.stage];
        if let Some(v) = stage.duration_variable {
            self.row[v] += by_length * h / stage.duration_s;
        }
        Ok(moved(&moved(later, 1.0, &first), 1.0, &second))
    }

    /// Pulls weights on a quantity and on the wear of a cycle back to the variables, which are added up, and to its surfaces.
    fn cycle(
        &mut self,
        (stage, worn_m): (usize, &SurfaceField),
        rate: &Arc<Rate>,
        on: (Quantity, f64),
        on_depth: &SurfaceField,
    ) -> Result<SurfaceField, MarchError> {
        let Asked { stages, options, cancel, .. } = self.asked;
        cancel.check().map_err(|_| MarchError::Cancelled)?;
        let [shell, journal] = options.depth_rates();
        let times = |by: f64, v: &[f64]| -> Vec<f64> { v.iter().map(|w| by * w).collect() };
        let marks =
            SurfaceField { shell: times(shell, &on_depth.shell), journal: times(journal, &on_depth.journal) };
        let wears = marks.shell.iter().chain(&marks.journal).any(|m| *m != 0.0);
        let rubbing = (mean_of(BearingOutput::Rubbing), if wears { 1.0 } else { 0.0 });
        let (of, weights): (Vec<Quantity>, Vec<f64>) =
            [on, rubbing].into_iter().filter(|(_, weight)| *weight != 0.0).unzip();
        let mut by = zeros(worn_m);
        if of.is_empty() {
            return Ok(by);
        }
        let stage = &stages[stage];
        let at = (&stage.model, worn_m);
        let rate = rate.complete(at, options, &mut self.near, cancel, &mut self.cost)?;
        let model = worn(&stage.model, worn_m, marks)?;
        let adjoint = engine::<JournalBearing>(EngineName::Adj, 0.0);
        let table = adjoint.gradient(&model, &rate.orbit, &options.orbit, &of, cancel)?;
        self.cost += table.cost;
        for ((row, fields), w) in table.rows.iter().zip(&table.fields).zip(&weights) {
            for (g, v) in row.iter().zip(&stage.variables) {
                self.row[*v] += w * g;
            }
            by = moved(&by, *w, &model.by_wear(fields));
        }
        Ok(by)
    }
}

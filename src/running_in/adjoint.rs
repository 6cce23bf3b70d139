//! Derivatives of a running-in, backwards through its blocks.
//!
//! With `l` the worth of the surfaces after a block and `e` that of its energy,
//!
//! ```text
//! second cycle:   weights h/2 l on k2, e h/2 on P2          ->  g2 by its surfaces w + h k1
//! first cycle:    weights h/2 l + h g2 on k1, e h/2 on P1   ->  g1 by its surfaces w
//! before:         l + g1 + g2                               by the length:  e (P1 + P2)/2 + l (k1 + k2)/2 + g2 k1
//! ```
//!
//! Each cycle is differentiated once by its adjoint, for two rows: the loss, and the rubbing of all cells with their weights as marks.
//! Derivatives by the surfaces are those by the gap, which the adjoint has anyway.

use super::march::{moved, product};
use super::quantity::{Worth, cell_area_m2};
use super::rate::{Rate, worn};
use super::{March, MarchError, MarchOptions, RunningInQuantity, Stage};
use crate::cranktrain::{BearingOutput, BearingParameter, JournalBearing, SurfaceField};
use crate::gradient::{EngineName, engine};
use crate::orbit::{Quantity, Reduction};
use crate::run::{Cancel, Cost};

/// Derivatives of one quantity of a running-in.
#[derive(Debug, Clone, PartialEq)]
pub struct RunningInGradient {
    /// By the parameters of each stage's bearing; a parameter common to all stages has their sum.
    pub by_stage: Vec<Vec<f64>>,
    /// By the duration of each stage.
    pub by_duration: Vec<f64>,
    /// Work done.
    pub cost: Cost,
}

/// Gradient of a quantity by everything a programme depends on.
pub fn march_adjoint(
    stages: &[Stage],
    march: &March,
    options: &MarchOptions,
    of: RunningInQuantity,
    cancel: &Cancel,
) -> Result<RunningInGradient, MarchError> {
    let last = stages.last().ok_or_else(|| MarchError::Parameters("no stages".to_owned()))?;
    let worth = of.worth(march, &last.model);
    let varied = |s: &Stage| {
        let all = &s.model.setup().parameters;
        all.iter().filter(|p| **p != BearingParameter::FilmTemperature).count()
    };
    let mut back = Back {
        stages,
        options,
        cancel,
        gradient: RunningInGradient {
            by_stage: stages.iter().map(|s| vec![0.0; varied(s)]).collect(),
            by_duration: (0..stages.len())
                .map(|s| worth.duration + if s + 1 == stages.len() { worth.last_duration } else { 0.0 })
                .collect(),
            cost: Cost::default(),
        },
    };
    back.area(&worth, &last.model);
    let mut later = worth.worn.clone();
    if worth.last_loss != 0.0 {
        let at = (stages.len() - 1, &march.worn_m);
        let by = back.cycle(at, &march.last, worth.last_loss, &SurfaceField::default())?;
        later = moved(&later, 1.0, &by);
    }
    for (k, block) in march.blocks.iter().enumerate().rev() {
        let in_last = block.stage + 1 == stages.len();
        let (h, e) = (block.length_s, worth.energy + if in_last { worth.last_energy } else { 0.0 });
        let [k1, k2] = [0, 1].map(|r| options.depths(&block.rates[r]));
        let half = moved(&zeros(&later), 0.5 * h, &later);
        let second = back.cycle((block.stage, &block.reached_m), &block.rates[1], 0.5 * e * h, &half)?;
        let begins = in_last && (k == 0 || march.blocks[k - 1].stage != block.stage);
        let first_loss = if begins { worth.first_loss } else { 0.0 };
        let on_first = moved(&half, h, &second);
        let at = (block.stage, &block.worn_m);
        let first = back.cycle(at, &block.rates[0], 0.5 * e * h + first_loss, &on_first)?;
        let losses = block.rates[0].loss_w() + block.rates[1].loss_w();
        let by_length =
            0.5 * e * losses + 0.5 * (product(&later, &k1) + product(&later, &k2)) + product(&second, &k1);
        back.gradient.by_duration[block.stage] += by_length * h / stages[block.stage].duration_s;
        later = moved(&moved(&later, 1.0, &first), 1.0, &second);
    }
    Ok(back.gradient)
}

fn zeros(like: &SurfaceField) -> SurfaceField {
    SurfaceField { shell: vec![0.0; like.shell.len()], journal: vec![0.0; like.journal.len()] }
}

struct Back<'a> {
    stages: &'a [Stage],
    options: &'a MarchOptions,
    cancel: &'a Cancel,
    gradient: RunningInGradient,
}

impl Back<'_> {
    /// What the area of a cell is worth, by width and diameter.
    fn area(&mut self, worth: &Worth, model: &JournalBearing) {
        let (setup, area) = (model.setup(), cell_area_m2(model));
        let stage = self.stages.len() - 1;
        for (p, bar) in setup.parameters.iter().zip(&mut self.gradient.by_stage[stage]) {
            match p {
                BearingParameter::Width => *bar += worth.area * area / setup.width_m,
                BearingParameter::Diameter => *bar += worth.area * area / setup.diameter_m,
                _ => {}
            }
        }
    }

    /// Pulls weights on the loss and on the wear of a cycle back to the parameters, which are added up, and to its surfaces.
    fn cycle(
        &mut self,
        (stage, worn_m): (usize, &SurfaceField),
        rate: &Rate,
        on_loss: f64,
        on_depth: &SurfaceField,
    ) -> Result<SurfaceField, MarchError> {
        self.cancel.check().map_err(|_| MarchError::Cancelled)?;
        let [shell, journal] = self.options.depth_rates();
        let times = |by: f64, v: &[f64]| -> Vec<f64> { v.iter().map(|w| by * w).collect() };
        let marks =
            SurfaceField { shell: times(shell, &on_depth.shell), journal: times(journal, &on_depth.journal) };
        let wears = marks.shell.iter().chain(&marks.journal).any(|m| *m != 0.0);
        let model = worn(&self.stages[stage].model, worn_m, marks)?;
        let mean = |o: BearingOutput| Quantity { output: o.index(), reduction: Reduction::Mean };
        let mut of = Vec::new();
        let mut weights = Vec::new();
        if on_loss != 0.0 {
            of.push(mean(BearingOutput::Loss));
            weights.push(on_loss);
        }
        if wears {
            of.push(mean(BearingOutput::Rubbing));
            weights.push(1.0);
        }
        let mut by = zeros(worn_m);
        if of.is_empty() {
            return Ok(by);
        }
        let adjoint = engine::<JournalBearing>(EngineName::Adj, 0.0);
        let table = adjoint.gradient(&model, &rate.orbit, &self.options.orbit, &of, self.cancel)?;
        self.gradient.cost += table.cost;
        for ((row, fields), w) in table.rows.iter().zip(&table.fields).zip(&weights) {
            self.gradient.by_stage[stage].iter_mut().zip(row).for_each(|(sum, g)| *sum += w * g);
            by = moved(&by, *w, &model.by_gap(fields));
        }
        Ok(by)
    }
}

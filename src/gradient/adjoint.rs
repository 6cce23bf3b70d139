//! ADJ, the discrete adjoint of the very steps taken.
//!
//! With the weight `c_n = F_m'^T l_n + w_n g_m'` on the rate of step `n`, which is also a weight on the memories before it,
//! the adjoint states solve
//!
//! ```text
//! (F_z + a_0/dt F_m' M_z)^T l_n = -w_n (g_z + a_0/dt M_z^T g_m') - M_z^T (a_1 c_{n+1} + a_2 c_{n+2}) / dt,    indices modulo N
//! dQ/du = sum_n (w_n g_u + F_u^T l_n + M_u^T (a_0 c_n + a_1 c_{n+1} + a_2 c_{n+2}) / dt),       dQ/dp = u_p^T dQ/du
//! ```
//!
//! backwards in `n`, with one transposed solve per quantity and step and no work per parameter but the final product.
//! The first sweep starts without weights behind the end of the cycle. The weights it leaves at the beginning are carried
//! on to their fixed point (GMRES over sweeps that only solve), and a last sweep adds the share of what was missing. That
//! closes the period exactly. Unlike a one-cycle adjoint on a frozen start state, this sees the start state move with the design.

use super::chain::{COLUMNS, Carrier, Chain, FADED, Way};
use super::{GradientError, GradientTable};
use crate::dae::{Cotangent, SensitiveDae};
use crate::orbit::{BLOCK, Heads, Orbit, OrbitOptions, Quantity};
use crate::run::Cancel;
use rayon::prelude::*;
use std::ops::Range;

/// Derivatives by all parameters, cycle unknowns held.
pub(super) fn adjoint<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
    cancel: &Cancel,
) -> Result<GradientTable, GradientError> {
    let mut sweep = Backward::new(Chain::new(model, at, options, cancel), of);
    sweep.run(true)?;
    let mut packed = vec![0.0; 2 * model.memories() * of.len()];
    sweep.back.heads.pack(&mut packed);
    let group = |start: usize| CarryBack::new(model, sweep.chain.weights(), COLUMNS.min(of.len() - start));
    let mut carriers: Vec<CarryBack<M>> = (0..of.len()).step_by(COLUMNS).map(group).collect();
    let closure = sweep.chain.close(Way::Backward, &mut carriers, &mut packed)?;
    sweep.back.heads.unpack(&packed);
    sweep.run(false)?;
    sweep.finish()?;
    Ok(sweep.result(closure.residual))
}

/// A backward sweep of weights on the rates, several columns side by side.
struct CarryBack<'a, M: SensitiveDae> {
    model: &'a M,
    rates: [f64; 3],
    heads: Heads,
    /// Adjoint states, one column per quantity.
    lambda: Vec<f64>,
    on_memory: Vec<f64>,
}

impl<'a, M: SensitiveDae> CarryBack<'a, M> {
    fn new(model: &'a M, rates: [f64; 3], columns: usize) -> Self {
        let (n, m) = (model.states(), model.memories());
        Self {
            model,
            rates,
            heads: Heads::new(m, columns),
            lambda: vec![0.0; n * columns],
            on_memory: vec![0.0; m],
        }
    }

    /// Weights of a column on the memory of a step, from those on the rates of this and the two later steps.
    fn weigh_memory(&mut self, column: usize) {
        let (m, a) = (self.heads.m, self.rates);
        let [now, next, later] = &self.heads.at;
        for (i, w) in self.on_memory.iter_mut().enumerate() {
            let k = column * m + i;
            *w = a[0] * now[k] + a[1] * next[k] + a[2] * later[k];
        }
    }

    /// Over one step with right-hand sides and weights on its rate of its own (`forces`: by state, by rate; empty for none).
    fn forced_step(&mut self, factors: &M::Factors, by_z: &[f64], by_rate: &[f64]) {
        let (model, n, m) = (self.model, self.model.states(), self.heads.m);
        self.heads.shift();
        match by_rate.is_empty() {
            true => self.heads.at[0].fill(0.0),
            false => self.heads.at[0].copy_from_slice(by_rate),
        }
        match by_z.is_empty() {
            true => self.lambda.fill(0.0),
            false => self.lambda.copy_from_slice(by_z),
        }
        for c in 0..self.lambda.len() / n {
            self.weigh_memory(c);
            let z = &mut self.lambda[c * n..(c + 1) * n];
            model.memory_cotangent(factors, &self.on_memory, z);
            z.iter_mut().for_each(|z| *z = -*z);
        }
        model.solve_transposed(factors, &mut self.lambda);
        for (lambda, now) in self.lambda.chunks_exact(n).zip(self.heads.at[0].chunks_exact_mut(m)) {
            model.rate_cotangent(factors, lambda, now);
        }
    }
}

impl<M: SensitiveDae> Carrier<M> for CarryBack<'_, M> {
    fn heads(&mut self) -> &mut Heads {
        &mut self.heads
    }

    fn step(&mut self, factors: &M::Factors) {
        self.forced_step(factors, &[], &[]);
    }
}

/// What one step of a block holds.
struct Slot<M: SensitiveDae> {
    point: M::Point,
    /// Derivatives of the weighted outputs, one column per quantity.
    by_z: Vec<f64>,
    by_rate: Vec<f64>,
    by_u: Vec<f64>,
}

/// Adjoint states of one step and weights on its memory, one column per quantity.
#[derive(Clone)]
struct Found {
    lambda: Vec<f64>,
    on_memory: Vec<f64>,
}

struct Backward<'a, M: SensitiveDae> {
    chain: Chain<'a, M>,
    of: &'a [Quantity],
    weights: Vec<Vec<f64>>,
    back: CarryBack<'a, M>,
    slots: Vec<Slot<M>>,
    /// What was found for every step, if the memory granted allows; products with it are then taken once, after the last
    /// sweep. Otherwise for the steps of a block.
    found: Vec<Found>,
    /// Derivatives by the fields, one row per quantity.
    fields: Vec<Vec<f64>>,
    largest: f64,
}

impl<'a, M: SensitiveDae> Backward<'a, M> {
    fn new(chain: Chain<'a, M>, of: &'a [Quantity]) -> Self {
        let (model, columns) = (chain.model, of.len());
        let (n, m, u) = (model.states(), model.memories(), model.fields());
        let slot = |_| Slot {
            point: model.point(),
            by_z: vec![0.0; n * columns],
            by_rate: vec![0.0; m * columns],
            by_u: vec![0.0; u * columns],
        };
        let none = Found { lambda: vec![0.0; n * columns], on_memory: vec![0.0; m * columns] };
        let steps = chain.orbit.steps();
        Self {
            of,
            weights: of.iter().map(|q| q.weights(&chain.orbit.outputs)).collect(),
            back: CarryBack::new(model, chain.weights(), columns),
            slots: (0..BLOCK.min(steps)).map(slot).collect(),
            found: vec![none; if chain.keeps() { steps } else { BLOCK.min(steps) }],
            fields: vec![vec![0.0; u]; columns],
            largest: 0.0,
            chain,
        }
    }

    /// Once around the cycle; a sweep that is not forced only carries what the heads hold, until it has faded.
    fn run(&mut self, forced: bool) -> Result<(), GradientError> {
        let keeps = self.chain.keeps();
        for block in Way::Backward.blocks(self.chain.orbit.steps()) {
            if !forced && self.back.heads.size() <= FADED * self.largest {
                break;
            }
            if forced || !keeps {
                self.chain.look(block.clone())?;
                self.prepare(block.clone(), forced);
            }
            self.chain.ready(block.clone())?;
            self.march(block.clone(), forced);
            if forced {
                self.gather_outputs(block.clone());
            }
            if !keeps {
                self.gather(block.clone());
            }
            self.chain.cost.steps += block.len() as u64;
            self.chain.cost.solves += (block.len() * self.of.len()) as u64;
        }
        Ok(())
    }

    /// Products with what all sweeps together found, if they were left for the end.
    fn finish(&mut self) -> Result<(), GradientError> {
        if self.chain.keeps() {
            for block in Way::Backward.blocks(self.chain.orbit.steps()) {
                self.chain.look(block.clone())?;
                self.prepare(block.clone(), false);
                self.gather(block);
            }
        }
        Ok(())
    }

    /// Evaluates the points of a block and, if forced, the derivatives of the outputs.
    fn prepare(&mut self, block: Range<usize>, forced: bool) {
        let Self { chain, of, weights, slots, .. } = self;
        let (model, chain, of, weights) = (chain.model, &*chain, *of, &*weights);
        slots[..block.len()].par_iter_mut().zip(block).for_each(|(slot, n)| {
            let at = chain.at(n);
            if forced {
                model.fix(at, &mut slot.point);
                [&mut slot.by_z, &mut slot.by_rate, &mut slot.by_u].into_iter().for_each(|v| v.fill(0.0));
                for (r, quantity) in of.iter().enumerate() {
                    slot.weigh(model, at, r, quantity.output, weights[r][n]);
                }
            } else {
                model.fix_balance(at, &mut slot.point);
            }
        });
    }

    /// Where what is found for step `n` of a block stands.
    fn place(&self, block: &Range<usize>, n: usize) -> usize {
        if self.chain.keeps() { n } else { n - block.start }
    }

    /// The adjoint states of a block, one after the other.
    fn march(&mut self, block: Range<usize>, forced: bool) {
        let (m, keeps) = (self.chain.model.memories(), self.chain.keeps());
        for n in block.clone().rev() {
            let place = self.place(&block, n);
            let (slot, found) = (&self.slots[n - block.start], &mut self.found[place]);
            let (by_z, by_rate): (&[f64], &[f64]) =
                if forced { (&slot.by_z, &slot.by_rate) } else { (&[], &[]) };
            self.back.forced_step(self.chain.factors(n), by_z, by_rate);
            if !keeps {
                found.lambda.fill(0.0);
                found.on_memory.fill(0.0);
            }
            found.lambda.iter_mut().zip(&self.back.lambda).for_each(|(a, b)| *a += b);
            for (c, w) in found.on_memory.chunks_exact_mut(m).enumerate() {
                self.back.weigh_memory(c);
                w.iter_mut().zip(&self.back.on_memory).for_each(|(a, b)| *a += b);
            }
            if forced {
                self.largest = self.largest.max(self.back.heads.size());
            }
        }
    }

    /// Derivatives of the outputs of a block by the fields.
    fn gather_outputs(&mut self, block: Range<usize>) {
        let (u, slots) = (self.chain.model.fields(), &self.slots);
        self.fields.par_iter_mut().enumerate().for_each(|(r, row)| {
            for slot in slots[..block.len()].iter().rev() {
                row.iter_mut().zip(&slot.by_u[r * u..(r + 1) * u]).for_each(|(a, b)| *a += b);
            }
        });
    }

    /// Products of what was found for a block with the derivatives by the fields.
    fn gather(&mut self, block: Range<usize>) {
        let mut fields = std::mem::take(&mut self.fields);
        let place = |n: usize| self.place(&block, n);
        let (model, chain, slots, found) = (self.chain.model, &self.chain, &self.slots, &self.found);
        let (n_z, m) = (model.states(), model.memories());
        fields.par_iter_mut().enumerate().for_each(|(r, row)| {
            for n in block.clone().rev() {
                let (slot, found) = (&slots[n - block.start], &found[place(n)]);
                let lambda = &found.lambda[r * n_z..(r + 1) * n_z];
                let on_memory = &found.on_memory[r * m..(r + 1) * m];
                model.pull(&slot.point, chain.at(n), lambda, on_memory, row);
            }
        });
        self.fields = fields;
    }

    fn result(self, closure: f64) -> GradientTable {
        let model = self.chain.model;
        let row = |u: &Vec<f64>| {
            let mut p = vec![0.0; model.parameters().len()];
            model.field_cotangent(u, &mut p);
            p
        };
        let cost = self.chain.cost;
        let sweeps = cost.steps as f64 / self.chain.orbit.steps() as f64;
        GradientTable {
            rows: self.fields.iter().map(row).collect(),
            fields: self.fields,
            sweeps,
            closure,
            cost,
        }
    }
}

impl<M: SensitiveDae> Slot<M> {
    /// Derivatives of the weighted output `o` for quantity `r`.
    fn weigh(&mut self, model: &M, at: crate::dae::At, r: usize, o: usize, weight: f64) {
        if weight == 0.0 {
            return;
        }
        let (n, m, u) = (model.states(), model.memories(), model.fields());
        let mut weights = vec![0.0; model.outputs()];
        weights[o] = weight;
        let out = Cotangent {
            z: &mut self.by_z[r * n..(r + 1) * n],
            rate: &mut self.by_rate[r * m..(r + 1) * m],
            u: &mut self.by_u[r * u..(r + 1) * u],
        };
        model.output_cotangent(&self.point, at, &weights, out);
    }
}

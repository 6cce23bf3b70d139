//! TRA, the transient approach: the tangent equations marched along the orbit.
//!
//! The sensitivities `s_n = dz_n/dp` of all parameters and those of the memory, `d_n = M_z s_n + M_u u_p`, solve with the
//! matrix of the step itself
//!
//! ```text
//! (F_z + a_0/dt F_m' M_z) s_n = -F_u u_p - F_m' (a_0 M_u u_p + a_1 d_{n-1} + a_2 d_{n-2}) / dt,       indices modulo N
//! dQ/dp = sum_n w_n (g_z s_n + g_m' d'_n + g_u u_p)
//! ```
//!
//! The first sweep starts from `d = 0` before the cycle. The memory it leaves at the end is carried on to its fixed point
//! (GMRES over sweeps that only solve), and a last sweep adds the response to what was missing.

use super::chain::{COLUMNS, Carrier, Chain, FADED, Way};
use super::{GradientError, GradientTable};
use crate::dae::{At, Direction, SensitiveDae};
use crate::orbit::{BLOCK, Carry, Heads, Quantity};
use rayon::prelude::*;

/// Derivatives of quantities (rows), and of the means of all local outputs if they are wanted, along changes of the fields.
pub(super) struct Tangents {
    pub table: GradientTable,
    /// One row per direction; empty if not wanted.
    pub locals: Vec<Vec<f64>>,
}

/// Changes of the fields for a unit of every parameter.
pub(super) fn by_parameter<M: SensitiveDae>(model: &M) -> Vec<Vec<f64>> {
    let np = model.parameters().len();
    let column = |j: usize| {
        let (mut dp, mut du) = (vec![0.0; np], vec![0.0; model.fields()]);
        dp[j] = 1.0;
        model.field_tangent(&dp, &mut du);
        du
    };
    (0..np).map(column).collect()
}

/// Derivatives along changes of the fields, cycle unknowns held.
pub(super) fn transient<M: SensitiveDae>(
    chain: Chain<'_, M>,
    of: &[Quantity],
    directions: &[Vec<f64>],
    locals: bool,
) -> Result<Tangents, GradientError> {
    let (model, pair) = (chain.model, 2 * chain.model.memories());
    let mut sweep = Forward::new(chain, of, directions, locals);
    sweep.run(true)?;
    let mut packed = vec![0.0; pair * directions.len()];
    for (group, part) in sweep.groups.iter().zip(packed.chunks_mut((COLUMNS * pair).max(1))) {
        group.carry.heads.pack(part);
    }
    let rates = sweep.chain.weights();
    let mut carriers: Vec<Carry<M>> =
        sweep.groups.iter().map(|g| Carry::new(model, rates, g.count)).collect();
    let closure = sweep.chain.close(Way::Forward, &mut carriers, &mut packed)?;
    for (group, part) in sweep.groups.iter_mut().zip(packed.chunks((COLUMNS * pair).max(1))) {
        group.carry.heads.unpack(part);
    }
    sweep.run(false)?;
    Ok(sweep.result(closure.residual))
}

impl<M: SensitiveDae> Carrier<M> for Carry<'_, M> {
    fn heads(&mut self) -> &mut Heads {
        &mut self.heads
    }

    fn step(&mut self, factors: &M::Factors) {
        Carry::step(self, factors);
    }
}

/// Some directions whose sensitivities advance side by side.
struct Group<'a, M: SensitiveDae> {
    first: usize,
    count: usize,
    /// The change of the fields of each.
    fields: Vec<f64>,
    carry: Carry<'a, M>,
    /// `F_u du` and `M_u du` of the step at hand.
    by_u: Vec<f64>,
    memory_by_u: Vec<f64>,
    /// One row per quantity.
    rows: Vec<Vec<f64>>,
    /// Means of the local outputs, one row per direction; empty if not wanted.
    locals: Vec<Vec<f64>>,
    largest: f64,
}

struct Forward<'a, M: SensitiveDae> {
    chain: Chain<'a, M>,
    of: &'a [Quantity],
    weights: Vec<Vec<f64>>,
    points: Vec<M::Point>,
    groups: Vec<Group<'a, M>>,
}

impl<'a, M: SensitiveDae> Forward<'a, M> {
    fn new(chain: Chain<'a, M>, of: &'a [Quantity], directions: &[Vec<f64>], locals: bool) -> Self {
        let (model, rates, all) = (chain.model, chain.weights(), directions.len());
        let (n, m) = (model.states(), model.memories());
        let group = |first: usize| {
            let count = COLUMNS.min(all - first);
            Group {
                first,
                count,
                fields: directions[first..first + count].concat(),
                carry: Carry::new(model, rates, count),
                by_u: vec![0.0; n * count],
                memory_by_u: vec![0.0; m * count],
                rows: vec![vec![0.0; count]; of.len()],
                locals: vec![vec![0.0; model.locals()]; if locals { count } else { 0 }],
                largest: 0.0,
            }
        };
        Self {
            of,
            weights: of.iter().map(|q| q.weights(&chain.orbit.outputs)).collect(),
            points: (0..BLOCK.min(chain.orbit.steps())).map(|_| model.point()).collect(),
            groups: (0..all).step_by(COLUMNS).map(group).collect(),
            chain,
        }
    }

    /// Once around the cycle; a sweep that is not forced only carries what the heads hold, until it has faded.
    fn run(&mut self, forced: bool) -> Result<(), GradientError> {
        for block in Way::Forward.blocks(self.chain.orbit.steps()) {
            let open = |g: &Group<M>| forced || g.carry.heads.size() > FADED * g.largest;
            if !self.groups.iter().any(open) {
                break;
            }
            self.chain.look(block.clone())?;
            self.chain.ready(block.clone())?;
            let share = 1.0 / self.chain.orbit.steps() as f64;
            let Self { chain, of, weights, points, groups } = self;
            let (chain_now, of, weights) = (&*chain, *of, &*weights);
            points[..block.len()].par_iter_mut().zip(block.clone()).for_each(|(point, n)| {
                chain_now.model.fix(chain_now.at(n), point);
            });
            let points = &*points;
            groups.par_iter_mut().for_each(|group| {
                for n in block.clone() {
                    let weight: Vec<(usize, f64)> =
                        of.iter().zip(weights).map(|(q, w)| (q.output, w[n])).collect();
                    let (point, at) = (&points[n - block.start], chain_now.at(n));
                    group.advance(chain_now.factors(n), point, at, (&weight, share), forced);
                }
            });
            let columns: usize = groups.iter().map(|g| g.count).sum();
            chain.cost.steps += block.len() as u64;
            chain.cost.solves += (block.len() * columns) as u64;
        }
        Ok(())
    }

    fn result(self, closure: f64) -> Tangents {
        let row = |r: usize| self.groups.iter().flat_map(|g| g.rows[r].iter().copied()).collect();
        let cost = self.chain.cost;
        let sweeps = cost.steps as f64 / self.chain.orbit.steps() as f64;
        debug_assert!(self.groups.iter().enumerate().all(|(k, g)| g.first == k * COLUMNS));
        let rows = (0..self.of.len()).map(row).collect();
        let table = GradientTable { rows, fields: Vec::new(), sweeps, closure, cost };
        Tangents { table, locals: self.groups.into_iter().flat_map(|g| g.locals).collect() }
    }
}

impl<M: SensitiveDae> Group<'_, M> {
    /// Over one step, and its share in the quantities (`weight`: output and weight of each) and in the local means.
    fn advance(
        &mut self,
        factors: &M::Factors,
        point: &M::Point,
        at: At,
        (weight, share): (&[(usize, f64)], f64),
        forced: bool,
    ) {
        let Self { fields, carry, by_u, memory_by_u, .. } = self;
        let (model, a) = (carry.model, carry.rates);
        let (n, m, u) = (model.states(), model.memories(), model.fields());
        if forced {
            for (k, du) in fields.chunks_exact(u).enumerate() {
                let (residual, memory) =
                    (&mut by_u[k * n..(k + 1) * n], &mut memory_by_u[k * m..(k + 1) * m]);
                model.push(point, at, du, residual, memory);
            }
            carry.forced_step(factors, by_u, memory_by_u);
        } else {
            carry.forced_step(factors, &[], &[]);
        }
        let none = vec![0.0; u];
        let wanted = !self.locals.is_empty() || weight.iter().any(|(_, w)| *w != 0.0);
        let mut dy = vec![0.0; model.outputs()];
        for k in (0..self.count).filter(|_| wanted) {
            let [now, last, before] = self.carry.heads.at.each_ref().map(|v| &v[k * m..(k + 1) * m]);
            let rate: Vec<f64> = (0..m).map(|i| a[0] * now[i] + a[1] * last[i] + a[2] * before[i]).collect();
            let u = if forced { &self.fields[k * u..(k + 1) * u] } else { &none };
            let z = &self.carry.z[k * n..(k + 1) * n];
            let direction = Direction { z, rate: &rate, u };
            model.output_tangent(point, at, direction, &mut dy);
            if let Some(sums) = self.locals.get_mut(k) {
                model.add_local_tangent(point, at, direction, share, sums);
            }
            for (row, (output, w)) in self.rows.iter_mut().zip(weight) {
                row[k] += w * dy[*output];
            }
        }
        if forced {
            self.largest = self.largest.max(self.carry.heads.size());
        }
    }
}

//! Changes of the memory carried along a cycle of factorised steps: the linear part of the period map.
//!
//! ```text
//! dz_n = -(F_z + a_0/dt F_m' M_z)^-1 F_m' (a_1 dm_{n-1} + a_2 dm_{n-2}) / dt,      dm_n = M_z dz_n
//! ```
//!
//! What a map of a whole period does is known by its action: no monodromy matrix is ever formed.

use crate::dae::LinearisedDae;

/// A memory below this share of what the sweep began with is gone for all purposes.
pub(crate) const GONE: f64 = 1e-17;

/// Changes of the last memories, several columns side by side.
pub(crate) struct Heads {
    /// Length of one memory.
    pub m: usize,
    /// Changes at this and the two earlier steps (later ones in a backward sweep), column by column.
    pub at: [Vec<f64>; 3],
}

impl Heads {
    pub fn new(m: usize, columns: usize) -> Self {
        Self { m, at: [vec![0.0; m * columns], vec![0.0; m * columns], vec![0.0; m * columns]] }
    }

    /// Two memories per column, one behind the other, as one vector: where a period begins.
    pub fn unpack(&mut self, packed: &[f64]) {
        for (c, pair) in packed.chunks_exact(2 * self.m).enumerate() {
            let at = c * self.m..(c + 1) * self.m;
            self.at[0][at.clone()].copy_from_slice(&pair[..self.m]);
            self.at[1][at].copy_from_slice(&pair[self.m..]);
        }
    }

    /// The reverse of [`Self::unpack`].
    pub fn pack(&self, packed: &mut [f64]) {
        for (c, pair) in packed.chunks_exact_mut(2 * self.m).enumerate() {
            let at = c * self.m..(c + 1) * self.m;
            pair[..self.m].copy_from_slice(&self.at[0][at.clone()]);
            pair[self.m..].copy_from_slice(&self.at[1][at]);
        }
    }

    /// Makes room for the next step: what was newest is now the last.
    pub fn shift(&mut self) {
        self.at.rotate_right(1);
    }

    /// Largest entry of the newest two.
    pub fn size(&self) -> f64 {
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        largest(&self.at[0]).max(largest(&self.at[1]))
    }
}

/// A forward sweep of changes.
pub(crate) struct Carry<'a, M: LinearisedDae> {
    pub model: &'a M,
    pub rates: [f64; 3],
    pub heads: Heads,
    /// Changes of the state at the step taken last.
    pub z: Vec<f64>,
    rate: Vec<f64>,
}

impl<'a, M: LinearisedDae> Carry<'a, M> {
    /// `rates` are those of the difference formula.
    pub fn new(model: &'a M, rates: [f64; 3], columns: usize) -> Self {
        let (n, m) = (model.states(), model.memories());
        Self { model, rates, heads: Heads::new(m, columns), z: vec![0.0; n * columns], rate: vec![0.0; m] }
    }

    /// Over one step.
    pub fn step(&mut self, factors: &M::Factors) {
        self.forced_step(factors, &[], &[]);
    }

    /// Over one step with a residual and a change of the memory of its own at fixed state, column by column (empty for none).
    pub fn forced_step(&mut self, factors: &M::Factors, residual: &[f64], memory: &[f64]) {
        let (model, [a0, a1, a2], n, m) = (self.model, self.rates, self.model.states(), self.heads.m);
        self.heads.shift();
        let [new, last, before] = &mut self.heads.at;
        match memory.is_empty() {
            true => new.fill(0.0),
            false => new.copy_from_slice(memory),
        }
        match residual.is_empty() {
            true => self.z.fill(0.0),
            false => self.z.iter_mut().zip(residual).for_each(|(z, r)| *z = -r),
        }
        for (c, z) in self.z.chunks_exact_mut(n).enumerate() {
            for (i, rate) in self.rate.iter_mut().enumerate() {
                let k = c * m + i;
                *rate = -(a0 * new[k] + a1 * last[k] + a2 * before[k]);
            }
            model.rate_times(factors, &self.rate, z);
        }
        model.solve(factors, &mut self.z);
        for (z, new) in self.z.chunks_exact(n).zip(new.chunks_exact_mut(m)) {
            model.memory_times(factors, z, new);
        }
    }

    /// Once around a cycle whose steps come in the order given; returns the steps taken, fewer if the memory fades.
    pub fn around<'f>(&mut self, cycle: impl Iterator<Item = &'f M::Factors>, packed: &mut [f64]) -> usize
    where
        M::Factors: 'f,
    {
        self.heads.unpack(packed);
        let (first, mut taken) = (self.heads.size(), 0);
        for factors in cycle {
            if self.heads.size() <= GONE * first {
                packed.fill(0.0);
                return taken;
            }
            self.step(factors);
            taken += 1;
        }
        self.heads.pack(packed);
        taken
    }
}

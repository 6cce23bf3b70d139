//! A number with its partial derivatives by the local quantities of a cell (forward mode, fixed length, on the stack).
//!
//! Laws hand out values with their partials; a jet carries them through the few products and quotients that make up a
//! cell. Newton's steps need two slots (gap, pressure), gradients need [`SLOTS`]; the length is a constant of the type,
//! so that the short form costs no more than hand-written derivatives.

use std::ops::{Add, Mul};

/// Slots: gap, pressure, viscosity, roughness of journal and of shell, surface speed.
pub(super) const SLOTS: usize = 6;
/// Slot of the gap.
pub(super) const GAP: usize = 0;
/// Slot of the pressure.
pub(super) const PRESSURE: usize = 1;
/// Slot of the viscosity.
pub(super) const VISCOSITY: usize = 2;
/// Slot of the journal's roughness.
pub(super) const JOURNAL: usize = 3;
/// Slot of the shell's roughness.
pub(super) const SHELL: usize = 4;
/// Slot of the surface speed.
pub(super) const SPEED: usize = 5;

/// Value and partial derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet<const N: usize> {
    /// Value.
    pub v: f64,
    /// Derivatives by the slots.
    pub d: [f64; N],
}

impl<const N: usize> Default for Jet<N> {
    fn default() -> Self {
        Self::constant(0.0)
    }
}

impl<const N: usize> Jet<N> {
    /// A number that depends on nothing.
    pub fn constant(v: f64) -> Self {
        Self { v, d: [0.0; N] }
    }

    /// The local quantity of a slot; slots beyond the length are constants.
    pub fn variable(v: f64, slot: usize) -> Self {
        let mut jet = Self::constant(v);
        if slot < N {
            jet.d[slot] = 1.0;
        }
        jet
    }

    /// A function of jets from its value and partials.
    pub fn chain<const K: usize>(v: f64, parts: [(f64, &Self); K]) -> Self {
        let mut d = [0.0; N];
        for (slope, jet) in parts {
            for (d, j) in d.iter_mut().zip(&jet.d) {
                *d += slope * j;
            }
        }
        Self { v, d }
    }

    /// `1 / x`.
    pub fn recip(self) -> Self {
        let r = 1.0 / self.v;
        Self::chain(r, [(-r * r, &self)])
    }

    /// `x` times a number.
    pub fn times(self, a: f64) -> Self {
        Self { v: a * self.v, d: self.d.map(|d| a * d) }
    }

    /// Change along a direction in the slots.
    pub fn along(&self, direction: &[f64; N]) -> f64 {
        self.d.iter().zip(direction).map(|(a, b)| a * b).sum()
    }

    /// Adds `weight` times the derivatives to `bar`.
    pub fn pull(&self, weight: f64, bar: &mut [f64; N]) {
        if weight != 0.0 {
            bar.iter_mut().zip(&self.d).for_each(|(b, d)| *b += weight * d);
        }
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::chain(self.v * o.v, [(o.v, &self), (self.v, &o)])
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::chain(self.v + o.v, [(1.0, &self), (1.0, &o)])
    }
}

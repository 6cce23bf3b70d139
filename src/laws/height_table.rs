//! Functions of one variable, tabulated: values and slopes on an even grid, cubic Hermite in between.
//!
//! The interpolant is once continuously differentiable and its slope is its own derivative, so gradients stay exact for
//! what is computed. With a grid of `1/64` the error of smooth functions of order one is below 1e-8. One look-up gives
//! all functions together, at a fraction of the exponentials they are made of.
//!
//! Deliberately not here: what the functions are; outside the grid the caller has to compute them.

use super::partials::Slope;

/// `K` functions on an even grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HeightTable<const K: usize> {
    low: f64,
    per_unit: f64,
    nodes: Vec<[Slope; K]>,
}

impl<const K: usize> HeightTable<K> {
    /// A table of nothing.
    pub fn empty() -> Self {
        Self { low: 0.0, per_unit: 1.0, nodes: Vec::new() }
    }

    /// Tabulates `functions` from `low` to `high` with `per_unit` intervals per unit.
    pub fn new(low: f64, high: f64, per_unit: usize, functions: impl Fn(f64) -> [Slope; K]) -> Self {
        let step = 1.0 / per_unit as f64;
        let count = ((high - low) * per_unit as f64).round() as usize;
        let nodes = (0..=count).map(|i| functions(low + i as f64 * step)).collect();
        Self { low, per_unit: per_unit as f64, nodes }
    }

    /// All functions at `x`, or nothing outside the grid.
    #[inline(always)]
    pub fn at(&self, x: f64) -> Option<[Slope; K]> {
        let place = (x - self.low) * self.per_unit;
        let inside = place >= 0.0 && place + 1.0 < self.nodes.len() as f64;
        if !inside {
            return None;
        }
        let i = place as usize;
        let t = place - i as f64;
        let h = 1.0 / self.per_unit;
        let (a, b) = (&self.nodes[i], &self.nodes[i + 1]);
        let (rise, bend) = (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) * self.per_unit);
        let (left, right) = (h * t * (1.0 - t) * (1.0 - t), h * t * t * (t - 1.0));
        let (left_slope, right_slope) = ((1.0 - t) * (1.0 - 3.0 * t), t * (3.0 * t - 2.0));
        Some(std::array::from_fn(|k| {
            let ((va, sa), (vb, sb)) = (a[k], b[k]);
            let value = va + rise * (vb - va) + left * sa + right * sb;
            (value, bend * (vb - va) + left_slope * sa + right_slope * sb)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

    fn table() -> HeightTable<2> {
        HeightTable::new(-1.0, 3.0, 64, |x| [(x.sin(), x.cos()), ((-x).exp(), -(-x).exp())])
    }

    #[test]
    fn values_are_close_and_slopes_are_those_of_the_interpolant() {
        for x in [-1.0f64, -0.503, 0.0, 0.7777, 1.5, 2.99] {
            let [(sine, slope), (decay, fall)] = table().at(x).unwrap();
            assert!((sine - x.sin()).abs() < 1e-9 && (decay - (-x).exp()).abs() < 1e-9);
            assert!((slope - x.cos()).abs() < 1e-6 && (fall + (-x).exp()).abs() < 1e-6);
        }
        assert_slope(|x| table().at(x).unwrap()[0].0, 0.7777, table().at(0.7777).unwrap()[0].1, 1e-3);
    }

    #[test]
    fn nothing_is_said_outside_the_grid() {
        assert!(table().at(-1.01).is_none() && table().at(3.0).is_none() && table().at(f64::NAN).is_none());
    }
}

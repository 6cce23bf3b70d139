//! Smooth extremum of positive numbers by a power norm.
//!
//! `max_k(g) = (sum g_i^k)^(1/k)` lies above the largest `g_i`, and `min_k(g) = (sum g_i^-k)^(-1/k)` below the smallest:
//! both err to the safe side, by at most `ln(m)/k` relative when `m` values are close to the extremum. They are smooth
//! wherever the `g_i` are, which the exact extremum is not. The norm of norms is the norm of all, so a sharpness used per
//! step over cells and again over steps gives the aggregate over both.

/// A power norm of sharpness `k > 0` (largest value) or `k < 0` (smallest value) over values that arrive one by one.
#[derive(Debug, Clone, Copy)]
pub struct PowerMean {
    exponent: f64,
    extremum: f64,
    sum: f64,
    /// Share of a largest value (a smallest one over it) below which a value is lost in the rounding of the sum.
    lost: f64,
}

/// Logarithm of what is lost in the rounding of a sum of at least one.
const LOST: f64 = -40.0;

impl PowerMean {
    /// Aggregates towards the largest value.
    pub fn maximum(sharpness: f64) -> Self {
        let exponent = sharpness.abs();
        Self { exponent, extremum: 0.0, sum: 0.0, lost: (LOST / exponent).exp() }
    }

    /// Aggregates towards the smallest value.
    pub fn minimum(sharpness: f64) -> Self {
        let exponent = -sharpness.abs();
        Self { exponent, extremum: f64::INFINITY, sum: 0.0, lost: (-LOST / exponent).exp() }
    }

    /// Adds a value. Values that are not positive count as zero for a maximum and make a minimum zero.
    pub fn add(&mut self, value: f64) {
        let value = value.max(0.0);
        let further = if self.exponent > 0.0 { value > self.extremum } else { value < self.extremum };
        if further {
            self.sum =
                if self.sum == 0.0 { 0.0 } else { self.sum * (self.extremum / value).powf(self.exponent) };
            self.extremum = value;
        }
        if self.extremum > 0.0 && self.extremum.is_finite() && !self.is_lost(value) {
            self.sum += (value / self.extremum).powf(self.exponent);
        }
    }

    /// Whether a value is so far from the extremum that it has no weight.
    pub fn is_lost(&self, value: f64) -> bool {
        match self.exponent > 0.0 {
            true => value < self.lost * self.extremum,
            false => self.lost * value > self.extremum,
        }
    }

    /// Adds all values of a sequence and returns the aggregate.
    pub fn of(mut self, values: impl IntoIterator<Item = f64>) -> Self {
        values.into_iter().for_each(|v| self.add(v));
        self
    }

    /// The exact extremum of the values added.
    pub fn exact(&self) -> f64 {
        self.extremum
    }

    /// The smooth extremum.
    pub fn value(&self) -> f64 {
        if self.sum > 0.0 { self.extremum * self.sum.powf(1.0 / self.exponent) } else { self.extremum }
    }

    /// Derivative of the smooth extremum by one of the values added.
    pub fn derivative(&self, value: f64) -> f64 {
        if self.sum > 0.0 && value > 0.0 { (value / self.value()).powf(self.exponent - 1.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn brackets_the_extremum_on_the_safe_side(values in prop::collection::vec(0.1f64..10.0, 1..40)) {
            let (top, low) = (values.iter().copied().fold(0.0, f64::max), values.iter().copied().fold(f64::MAX, f64::min));
            let max = PowerMean::maximum(60.0).of(values.iter().copied());
            let min = PowerMean::minimum(60.0).of(values.iter().copied());
            let bias = ((values.len() as f64).ln() / 60.0).exp() * (1.0 + 1e-12);
            prop_assert_eq!(max.exact(), top);
            prop_assert_eq!(min.exact(), low);
            prop_assert!(max.value() >= top && max.value() <= top * bias);
            prop_assert!(min.value() <= low && min.value() >= low / bias);
        }
    }

    #[test]
    fn derivative_agrees_with_a_central_difference() {
        let values = [1.0, 0.97, 0.5, 1.01];
        for build in [PowerMean::maximum as fn(f64) -> PowerMean, PowerMean::minimum] {
            let at = build(20.0).of(values);
            for i in 0..values.len() {
                let shifted = |d: f64| {
                    let mut v = values;
                    v[i] += d;
                    build(20.0).of(v).value()
                };
                let difference = (shifted(1e-6) - shifted(-1e-6)) / 2e-6;
                assert!((at.derivative(values[i]) - difference).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn an_empty_or_zero_set_has_no_slope() {
        let zero = PowerMean::maximum(50.0).of([0.0, 0.0]);
        assert_eq!((zero.value(), zero.derivative(0.0)), (0.0, 0.0));
        assert_eq!(PowerMean::minimum(50.0).of([0.0, 1.0]).value(), 0.0);
    }
}

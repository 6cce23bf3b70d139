//! One number from a cycle: a reduction of an output over the steps, with its derivative by each step's output.

use crate::math::PowerMean;

/// How an output becomes one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reduction {
    /// Mean over the period (trapezoidal rule, which on a periodic grid is the plain mean).
    Mean,
    /// Largest value at a step. Has a kink where two steps share it.
    Max,
    /// Smallest value at a step.
    Min,
    /// Smooth maximum of the given sharpness: at or above the largest value, see [`PowerMean`].
    SmoothMax(f64),
    /// Smooth minimum: at or below the smallest value.
    SmoothMin(f64),
}

/// A number wanted from a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Index of the output.
    pub output: usize,
    /// What is made of it.
    pub reduction: Reduction,
}

impl Quantity {
    /// Value over the given outputs of all steps.
    pub fn value(&self, outputs: &[Vec<f64>]) -> f64 {
        let series = outputs.iter().map(|y| y[self.output]);
        match self.reduction {
            Reduction::Mean => series.sum::<f64>() / outputs.len() as f64,
            Reduction::Max => series.fold(f64::NEG_INFINITY, f64::max),
            Reduction::Min => series.fold(f64::INFINITY, f64::min),
            Reduction::SmoothMax(k) => PowerMean::maximum(k).of(series).value(),
            Reduction::SmoothMin(k) => PowerMean::minimum(k).of(series).value(),
        }
    }

    /// Derivative of the value by the output of each step.
    pub fn weights(&self, outputs: &[Vec<f64>]) -> Vec<f64> {
        let series = || outputs.iter().map(|y| y[self.output]);
        match self.reduction {
            Reduction::Mean => vec![1.0 / outputs.len() as f64; outputs.len()],
            Reduction::Max | Reduction::Min => {
                let value = self.value(outputs);
                let at = series().position(|v| v == value);
                (0..outputs.len()).map(|n| if Some(n) == at { 1.0 } else { 0.0 }).collect()
            }
            Reduction::SmoothMax(k) => {
                let mean = PowerMean::maximum(k).of(series());
                series().map(|v| mean.derivative(v)).collect()
            }
            Reduction::SmoothMin(k) => {
                let mean = PowerMean::minimum(k).of(series());
                series().map(|v| mean.derivative(v)).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_the_derivatives_of_the_value() {
        let outputs: Vec<Vec<f64>> = (0..12).map(|n| vec![0.0, 2.0 + (n as f64 * 0.9).sin()]).collect();
        let all = [
            Reduction::Mean,
            Reduction::Max,
            Reduction::Min,
            Reduction::SmoothMax(30.0),
            Reduction::SmoothMin(30.0),
        ];
        for reduction in all {
            let quantity = Quantity { output: 1, reduction };
            let weights = quantity.weights(&outputs);
            for n in 0..12 {
                let shifted = |d: f64| {
                    let mut o = outputs.clone();
                    o[n][1] += d;
                    quantity.value(&o)
                };
                let difference = (shifted(1e-6) - shifted(-1e-6)) / 2e-6;
                assert!((weights[n] - difference).abs() < 1e-7, "{reduction:?} at {n}");
            }
        }
    }
}

//! Periodic cubic spline through given points.
//!
//! On each interval the spline is `a + b s + c s^2 + d s^3`; value, first and second derivative are continuous
//! everywhere, the joint from the last point to the first included. The second derivatives `m_i` at the knots solve the
//! cyclic tridiagonal system (de Boor, *A Practical Guide to Splines*, 1978, ch. IV)
//! `h_{i-1} m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_i m_{i+1} = 6 (s_i - s_{i-1})` with the slopes `s_i`.

use thiserror::Error;

/// Why a set of points cannot carry a periodic spline.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SplineError {
    /// Fewer than three points.
    #[error("a periodic curve needs at least 3 points, found {0}")]
    TooFew(usize),
    /// Abscissae not strictly increasing within one period.
    #[error("point {index} at {x} does not lie after the point before it and within one period")]
    NotIncreasing {
        /// Zero-based position in the list.
        index: usize,
        /// The offending abscissa.
        x: f64,
    },
    /// A coordinate is not a finite number.
    #[error("point {0} is not a finite number")]
    NotFinite(usize),
}

/// A twice continuously differentiable periodic curve.
#[derive(Debug, Clone)]
pub struct PeriodicSpline {
    period: f64,
    knots: Vec<f64>,
    values: Vec<f64>,
    /// Second derivatives at the knots.
    bends: Vec<f64>,
}

impl PeriodicSpline {
    /// Spline through `(knots[i], values[i])` with the given period; the first point must not be repeated at the end.
    pub fn new(knots: Vec<f64>, values: Vec<f64>, period: f64) -> Result<Self, SplineError> {
        let n = knots.len().min(values.len());
        if n < 3 {
            return Err(SplineError::TooFew(n));
        }
        if let Some(i) = (0..n).find(|&i| !knots[i].is_finite() || !values[i].is_finite()) {
            return Err(SplineError::NotFinite(i));
        }
        let bad = (1..n)
            .find(|&i| knots[i] <= knots[i - 1])
            .or_else(|| (knots[n - 1] >= knots[0] + period).then_some(n - 1));
        if let Some(index) = bad {
            return Err(SplineError::NotIncreasing { index, x: knots[index] });
        }
        let bends = bends(&knots, &values, period);
        Ok(Self { period, knots, values, bends })
    }

    /// The same curve with every value multiplied.
    pub fn scaled(&self, factor: f64) -> Self {
        let times = |v: &[f64]| v.iter().map(|v| v * factor).collect();
        Self { values: times(&self.values), bends: times(&self.bends), ..self.clone() }
    }

    /// Length of one period.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.value_and_slope(x).0
    }

    /// Value and first derivative at `x`.
    pub fn value_and_slope(&self, x: f64) -> (f64, f64) {
        let n = self.knots.len();
        let x = self.knots[0] + (x - self.knots[0]).rem_euclid(self.period);
        let i = self.knots.partition_point(|&k| k <= x).max(1) - 1;
        let j = (i + 1) % n;
        let right = if j == 0 { self.knots[0] + self.period } else { self.knots[j] };
        let h = right - self.knots[i];
        let (a, b) = ((right - x) / h, (x - self.knots[i]) / h);
        let (ma, mb) = (self.bends[i], self.bends[j]);
        let (ya, yb) = (self.values[i], self.values[j]);
        let value = a * ya + b * yb + h * h / 6.0 * ((a * a * a - a) * ma + (b * b * b - b) * mb);
        let slope = (yb - ya) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * ma + (3.0 * b * b - 1.0) * mb);
        (value, slope)
    }
}

/// Second derivatives at the knots: cyclic tridiagonal system, solved by the Sherman-Morrison formula.
fn bends(knots: &[f64], values: &[f64], period: f64) -> Vec<f64> {
    let n = knots.len();
    let width = |i: usize| {
        if i + 1 < n { knots[i + 1] - knots[i] } else { knots[0] + period - knots[n - 1] }
    };
    let h: Vec<f64> = (0..n).map(width).collect();
    let slope = |i: usize| (values[(i + 1) % n] - values[i]) / h[i];
    let before = |i: usize| (i + n - 1) % n;
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (h[before(i)] + h[i])).collect();
    let rhs: Vec<f64> = (0..n).map(|i| 6.0 * (slope(i) - slope(before(i)))).collect();
    let corner = h[n - 1];
    let gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    let mut u = vec![0.0; n];
    u[0] = gamma;
    u[n - 1] = corner;
    let y = tridiagonal(&h[..n - 1], &diagonal, rhs);
    let z = tridiagonal(&h[..n - 1], &diagonal, u);
    let ratio = corner / gamma;
    let factor = (y[0] + ratio * y[n - 1]) / (1.0 + z[0] + ratio * z[n - 1]);
    y.iter().zip(&z).map(|(y, z)| y - factor * z).collect()
}

/// Solves a symmetric, diagonally dominant tridiagonal system.
fn tridiagonal(off: &[f64], diagonal: &[f64], mut rhs: Vec<f64>) -> Vec<f64> {
    let n = diagonal.len();
    let mut pivots = diagonal.to_vec();
    for i in 1..n {
        let m = off[i - 1] / pivots[i - 1];
        pivots[i] -= m * off[i - 1];
        rhs[i] -= m * rhs[i - 1];
    }
    rhs[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        rhs[i] = (rhs[i] - off[i] * rhs[i + 1]) / pivots[i];
    }
    rhs
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn sine(n: usize) -> PeriodicSpline {
        let x: Vec<f64> = (0..n).map(|i| TAU * i as f64 / n as f64).collect();
        let y = x.iter().map(|x| x.sin()).collect();
        PeriodicSpline::new(x, y, TAU).unwrap()
    }

    #[test]
    fn fourth_order_on_a_sine_and_periodic() {
        let error = |n| {
            let s = sine(n);
            (0..997)
                .map(|k| 0.0137 * k as f64 - 3.0)
                .map(|x| (s.value(x) - x.sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(20) / error(40)).log2();
        assert!((order - 4.0).abs() < 0.2, "order {order}");
    }

    #[test]
    fn slope_is_the_derivative_of_value() {
        let s = PeriodicSpline::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.0, 3.0, -1.0, 0.5], 5.0).unwrap();
        for x in [0.0, 0.3, 1.0, 2.2, 4.7, 5.0, -0.4] {
            let e = 1e-5;
            let difference = (s.value(x + e) - s.value(x - e)) / (2.0 * e);
            assert!((s.value_and_slope(x).1 - difference).abs() < 1e-8);
        }
    }

    #[test]
    fn refuses_bad_points() {
        assert_eq!(
            PeriodicSpline::new(vec![0.0, 1.0], vec![0.0, 1.0], 2.0).unwrap_err(),
            SplineError::TooFew(2)
        );
        assert!(PeriodicSpline::new(vec![0.0, 1.0, 1.0], vec![0.0; 3], 2.0).is_err());
        assert!(PeriodicSpline::new(vec![0.0, 1.0, 2.0], vec![0.0; 3], 2.0).is_err());
        assert!(PeriodicSpline::new(vec![0.0, f64::NAN, 2.0], vec![0.0; 3], 3.0).is_err());
    }
}

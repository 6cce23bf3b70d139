//! The height integrals of rough contact, `F_n(u) = (2 pi)^(-1/2) Int_u^inf (s - u)^n exp(-s^2/2) ds`, exact and as the fits
//! in use elsewhere.
//!
//! Deliberately not here: pressures, moduli, lengths.

use super::normal;

/// How `F_5/2` (load) and `F_2` (real area) are evaluated.
///
/// | u | `F_5/2` | `PowerFit` | `PolynomialFit` | `ExponentialFit` |
/// |---|---|---|---|---|
/// | 0 | 0.61663 | -10.7 % | +0.01 % | +0.4 % |
/// | 2 | 5.4237e-3 | -9.2 % | -28 % | +121 % |
/// | 3 | 1.7087e-4 | -74 % | none left | ten times |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactIntegral {
    /// The integrals themselves. `F_5/2`: the exponential of a polynomial, within 3e-6 on `-1 <= u <= 5`; below -1 a power
    /// `A (b - u)^q` of the same value, slope and curvature (1 % above at -2, 6 % at -3, twice at -10; the integral tends to
    /// `|u|^2.5`); brought to exactly zero over `5 <= u <= 6`, twice continuously differentiable. `F_2`: closed form.
    Exact,
    /// `F_5/2 = 4.4086e-5 (4 - u)^6.804`, `F_2 = 3.5e-5 (4 - u)^6.9`, zero from 4 (the load fit of Hu, Cheng, Arai, Kobayashi and Aoyama
    /// 1994); the common fit of other programs, for comparison.
    PowerFit,
    /// Polynomials of degree five, for 0 to 2; cut to zero past their root near 2.25, with a kink there.
    PolynomialFit,
    /// `F_5/2 = 0.6189 exp(-1.973 u)`, `F_2 = 0.5025 exp(-1.844 u)`, for 0 to 1.
    ExponentialFit,
}

/// `ln F_5/2` on -1 to 6.
const LOG_LOAD: [f64; 9] = [
    -0.48348008,
    -1.74340619,
    -0.26974677,
    -0.02298248,
    7.0619428e-4,
    2.2495929e-4,
    -4.2868605e-5,
    3.4101114e-6,
    -1.0913088e-7,
];
/// Below, the power takes over from the polynomial.
const POWER_BELOW: f64 = -1.0;
/// From here to one more, the load integral is brought to zero.
const CUT_FROM: f64 = 5.0;
const LOAD_POLYNOMIAL: [f64; 6] = [0.6167, -1.0776, 0.7844, -0.2958, 0.0574, -0.0046];
const AREA_POLYNOMIAL: [f64; 6] = [0.5003, -0.8043, 0.5258, -0.1728, 0.0281, -0.0018];

impl ContactIntegral {
    /// `F_5/2(u)` and its slope.
    pub fn at(self, u: f64) -> (f64, f64) {
        match self {
            Self::Exact => exact_load(u),
            Self::PowerFit => power(4.4086e-5, 6.804, u),
            Self::PolynomialFit => positive(&LOAD_POLYNOMIAL, u),
            Self::ExponentialFit => exponential(0.6189, -1.973, u),
        }
    }

    /// `F_2(u)` and its slope; exact `F_2 = (1 + u^2) Q - u phi` with `phi` the normal density and `Q` its upper tail.
    pub fn area_integral(self, u: f64) -> (f64, f64) {
        match self {
            Self::Exact => {
                let (density, tail) = (normal::density(u), normal::upper_tail(u));
                ((1.0 + u * u) * tail - u * density, -2.0 * (density - u * tail))
            }
            Self::PowerFit => power(3.5e-5, 6.9, u),
            Self::PolynomialFit => positive(&AREA_POLYNOMIAL, u),
            Self::ExponentialFit => exponential(0.5025, -1.844, u),
        }
    }
}

fn exact_load(u: f64) -> (f64, f64) {
    if u >= CUT_FROM + 1.0 {
        return (0.0, 0.0);
    }
    let [log, rate, bend] = jet(&LOG_LOAD, u.max(POWER_BELOW));
    let value = log.exp();
    if u < POWER_BELOW {
        // ln F = q ln(b - u) + const has the slope -q/(b - u) and the second slope -q/(b - u)^2.
        let exponent = -rate * rate / bend;
        let reach = -exponent / rate;
        let now = reach + POWER_BELOW - u;
        let grown = value * (now / reach).powf(exponent);
        return (grown, -exponent * grown / now);
    }
    let t = (u - CUT_FROM).max(0.0);
    let kept = 1.0 - t.powi(3) * (10.0 + t * (6.0 * t - 15.0));
    let kept_slope = -30.0 * (t * (1.0 - t)).powi(2);
    (kept * value, kept * rate * value + kept_slope * value)
}

/// Value, first and second derivative of a polynomial, lowest power first.
fn jet<const N: usize>(coefficients: &[f64; N], u: f64) -> [f64; 3] {
    let mut jet = [0.0; 3];
    for c in coefficients.iter().rev() {
        jet = [jet[0] * u + c, jet[1] * u + jet[0], jet[2] * u + 2.0 * jet[1]];
    }
    jet
}

fn power(scale: f64, exponent: f64, u: f64) -> (f64, f64) {
    let left = 4.0 - u;
    if left <= 0.0 {
        return (0.0, 0.0);
    }
    let value = scale * left.powf(exponent);
    (value, -exponent * value / left)
}

fn positive(coefficients: &[f64; 6], u: f64) -> (f64, f64) {
    let [value, slope, _] = jet(coefficients, u);
    if value > 0.0 { (value, slope) } else { (0.0, 0.0) }
}

fn exponential(scale: f64, rate: f64, u: f64) -> (f64, f64) {
    let value = scale * (rate * u).exp();
    (value, rate * value)
}

#[cfg(test)]
mod tests;

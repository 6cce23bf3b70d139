//! Fall of viscosity with shear rate.
//!
//! Deliberately not here: limiting shear stress, elasticity of the oil, permanent shear loss.

/// Relative to the critical rate: below it Cross's law is rounded off.
const ROUNDING: f64 = 1e-6;

/// How viscosity follows the shear rate; `r` is the second Newtonian viscosity over the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShearThinning {
    /// The same viscosity at every rate.
    Newtonian,
    /// `r + (1 - r) / (1 + x^m)`, `x = rate/critical_rate` (Cross 1965). For `m < 1` the slope at rest is infinite;
    /// `x^m` is replaced by `(x^2 + e^2)^(m/2) - e^m` with `e = 1e-6`: 1 at rest, even and smooth, and less than `e^m`
    /// off.
    Cross {
        /// Second over first Newtonian viscosity, in `[0, 1]`.
        second_newtonian_ratio: f64,
        /// Rate at which half of the fall is done.
        critical_rate_per_s: f64,
        /// Exponent `m`, above 0.
        exponent: f64,
    },
    /// `r + (1 - r) [1 + (time rate)^2]^((n - 1)/2)` (Carreau 1972).
    Carreau {
        /// Second over first Newtonian viscosity, in `[0, 1]`.
        second_newtonian_ratio: f64,
        /// Inverse of the rate at which thinning sets in.
        time_s: f64,
        /// Power-law exponent `n`, in `(0, 1]`.
        exponent: f64,
    },
}

impl ShearThinning {
    /// Viscosity over low-shear viscosity at a rate of either sign, and its derivative by the rate in s.
    pub fn at(&self, rate_per_s: f64) -> (f64, f64) {
        match *self {
            Self::Newtonian => (1.0, 0.0),
            Self::Cross { second_newtonian_ratio: r, critical_rate_per_s, exponent: m } => {
                let x = rate_per_s / critical_rate_per_s;
                let square = x * x + ROUNDING * ROUNDING;
                let power = square.powf(0.5 * m);
                let below = 1.0 + power - ROUNDING.powf(m);
                let slope = -(1.0 - r) / (below * below) * m * power / square * x / critical_rate_per_s;
                (r + (1.0 - r) / below, slope)
            }
            Self::Carreau { second_newtonian_ratio: r, time_s, exponent: n } => {
                let x = time_s * rate_per_s;
                let fall = (1.0 - r) * (0.5 * (n - 1.0) * (x * x).ln_1p()).exp();
                (r + fall, fall * (n - 1.0) * x * time_s / (1.0 + x * x))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

    const LAWS: [ShearThinning; 4] = [
        ShearThinning::Newtonian,
        ShearThinning::Cross { second_newtonian_ratio: 0.4, critical_rate_per_s: 1e6, exponent: 0.7 },
        ShearThinning::Cross { second_newtonian_ratio: 0.4, critical_rate_per_s: 1e6, exponent: 1.3 },
        ShearThinning::Carreau { second_newtonian_ratio: 0.3, time_s: 2e-6, exponent: 0.6 },
    ];

    #[test]
    fn slope_passes_the_taylor_test() {
        for law in LAWS {
            for (rate, step) in [(0.0, 1e-2), (0.5, 1e-2), (-3e3, 10.0), (1e6, 1e3), (2e7, 1e4)] {
                assert_slope(|x| law.at(x).0, rate, law.at(rate).1, step);
            }
        }
    }

    #[test]
    fn even_falling_and_bounded_by_both_newtonian_viscosities() {
        for law in LAWS {
            assert_eq!(law.at(0.0), (1.0, 0.0));
            let mut last = 1.0;
            for rate in [1e3, 1e5, 1e6, 1e7, 1e9] {
                let (factor, slope) = law.at(rate);
                assert_eq!(law.at(-rate), (factor, -slope));
                assert!(factor <= last && factor >= 0.3 && slope <= 0.0);
                last = factor;
            }
        }
        assert!((LAWS[1].at(1e6).0 - 0.7).abs() < 1e-4);
    }
}

//! Rise of viscosity with pressure.
//!
//! Deliberately not here: temperature (the ambient viscosity carries it) and shear rate.

/// How viscosity follows pressure, `eta = eta_0 * factor`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piezoviscosity {
    /// The same viscosity at every pressure.
    None,
    /// `exp(alpha p)` (Barus 1893); fair below about 0.1 GPa, too steep above.
    Barus {
        /// Pressure-viscosity coefficient `alpha`.
        coefficient_per_pa: f64,
    },
    /// `exp{(ln eta_0 + 9.67) [(1 + p/p_0)^Z - 1]}` with `1/p_0 = 5.1e-9 1/Pa` and `Z = alpha p_0 / (ln eta_0 + 9.67)`
    /// (Roelands 1966), so that `alpha` is the slope of `ln eta` at ambient pressure; eta_0 above 1e-4 Pa s, pressures
    /// from -0.1 GPa (smooth through zero) to about 1 GPa.
    Roelands {
        /// Pressure-viscosity coefficient `alpha` at ambient pressure.
        coefficient_per_pa: f64,
    },
}

/// Viscosity over ambient viscosity, with its partial derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PiezoFactor {
    /// `eta / eta_0`.
    pub factor: f64,
    /// Derivative of the factor by the pressure in 1/Pa.
    pub by_pressure: f64,
    /// Derivative of the factor by the ambient viscosity in 1/(Pa s).
    pub by_viscosity: f64,
}

impl Piezoviscosity {
    /// Factor at a pressure above ambient for an oil of this viscosity at ambient pressure.
    pub fn at(&self, pressure_pa: f64, viscosity_pa_s: f64) -> PiezoFactor {
        match *self {
            Self::None => PiezoFactor { factor: 1.0, by_pressure: 0.0, by_viscosity: 0.0 },
            Self::Barus { coefficient_per_pa } => {
                let factor = (coefficient_per_pa * pressure_pa).exp();
                PiezoFactor { factor, by_pressure: coefficient_per_pa * factor, by_viscosity: 0.0 }
            }
            Self::Roelands { coefficient_per_pa } => {
                roelands(coefficient_per_pa, pressure_pa, viscosity_pa_s)
            }
        }
    }
}

fn roelands(alpha_per_pa: f64, pressure_pa: f64, viscosity_pa_s: f64) -> PiezoFactor {
    /// Roelands' reference pressure.
    const P0_PA: f64 = 1.0 / 5.1e-9;
    /// Minus the logarithm of the viscosity (Pa s) at which all oils would meet.
    const POLE: f64 = 9.67;
    let n = viscosity_pa_s.ln() + POLE;
    let z = alpha_per_pa * P0_PA / n;
    let log_base = (pressure_pa / P0_PA).ln_1p();
    let lift = (z * log_base).exp_m1();
    let factor = (n * lift).exp();
    let by_n = lift - (lift + 1.0) * z * log_base;
    PiezoFactor {
        factor,
        by_pressure: factor * alpha_per_pa * ((z - 1.0) * log_base).exp(),
        by_viscosity: factor * by_n / viscosity_pa_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

    const LAWS: [Piezoviscosity; 3] = [
        Piezoviscosity::None,
        Piezoviscosity::Barus { coefficient_per_pa: 2e-8 },
        Piezoviscosity::Roelands { coefficient_per_pa: 2e-8 },
    ];

    #[test]
    fn slopes_pass_the_taylor_test() {
        for law in LAWS {
            for (p, eta) in [(-1e5, 0.01), (0.0, 0.03), (5e7, 0.08), (3e8, 0.005)] {
                let found = law.at(p, eta);
                assert_slope(|p| law.at(p, eta).factor, p, found.by_pressure, 1e6);
                assert_slope(|eta| law.at(p, eta).factor, eta, found.by_viscosity, 1e-3);
            }
        }
    }

    #[test]
    fn all_laws_are_one_at_ambient_pressure_and_share_the_slope_there() {
        for law in LAWS {
            assert_eq!(law.at(0.0, 0.02).factor, 1.0);
        }
        let slope = LAWS[2].at(0.0, 0.02).by_pressure;
        assert!((slope / 2e-8 - 1.0).abs() < 1e-12);
        let (barus, roelands) = (LAWS[1].at(5e8, 0.02).factor, LAWS[2].at(5e8, 0.02).factor);
        assert!(roelands < barus / 5.0, "{roelands} {barus}");
    }

    #[test]
    fn roelands_meets_its_formula_written_out() {
        let (eta, p): (f64, f64) = (0.04, 2e8);
        let n = eta.ln() + 9.67;
        let z = 2e-8 / 5.1e-9 / n;
        let expected = (n * ((1.0 + 5.1e-9 * p).powf(z) - 1.0)).exp();
        assert!((LAWS[2].at(p, eta).factor / expected - 1.0).abs() < 1e-13);
    }
}

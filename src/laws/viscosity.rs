//! Dynamic viscosity of a lubricating oil over temperature.

use super::ZERO_CELSIUS_K;
use thiserror::Error;

/// Added to the kinematic viscosity in mm2/s by ASTM D341 (valid for more than 2 mm2/s).
const WALTHER_SHIFT: f64 = 0.7;
/// Temperature to which data sheets refer the density.
const DATASHEET_DENSITY_K: f64 = ZERO_CELSIUS_K + 15.0;
/// Relative loss of density of a mineral oil per kelvin (ISO 91, oils of about 890 kg/m3 at 15 degC).
const EXPANSION_PER_K: f64 = 7.0e-4;

/// Why data-sheet values describe no oil.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum OilDataError {
    /// Viscosity must fall with temperature and stay in the range of the chart.
    #[error(
        "the viscosity must fall from 40 degC to 100 degC and stay above 2 mm2/s (found {0} and {1} mm2/s)"
    )]
    NotAnOil(f64, f64),
}

/// Viscosity law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viscosity {
    /// The same at every temperature.
    Constant {
        /// Dynamic viscosity.
        viscosity_pa_s: f64,
    },
    /// ASTM D341 (Walther 1931): `lg lg (nu + 0.7) = a - b lg T` with nu in mm2/s and T in kelvin, times the density
    /// `rho_15 (1 - 7e-4 (T - 288.15 K))`.
    Walther {
        /// Intercept.
        a: f64,
        /// Slope.
        b: f64,
        /// Density at 15 degC.
        density_15c_kg_m3: f64,
    },
}

impl Viscosity {
    /// Walther's law through the kinematic viscosities (mm2/s) at 40 and 100 degC of a data sheet.
    pub fn from_data_sheet(
        nu_40c_mm2_s: f64,
        nu_100c_mm2_s: f64,
        density_15c_kg_m3: f64,
    ) -> Result<Self, OilDataError> {
        let falls = nu_40c_mm2_s > nu_100c_mm2_s && nu_100c_mm2_s >= 2.0;
        if !falls || !nu_40c_mm2_s.is_finite() {
            return Err(OilDataError::NotAnOil(nu_40c_mm2_s, nu_100c_mm2_s));
        }
        let w = |nu: f64| (nu + WALTHER_SHIFT).log10().log10();
        let (t40, t100) = ((ZERO_CELSIUS_K + 40.0).log10(), (ZERO_CELSIUS_K + 100.0).log10());
        let b = (w(nu_40c_mm2_s) - w(nu_100c_mm2_s)) / (t100 - t40);
        Ok(Self::Walther { a: w(nu_40c_mm2_s) + b * t40, b, density_15c_kg_m3 })
    }

    /// Dynamic viscosity in Pa s at a temperature, and its derivative by the temperature.
    pub fn at(&self, temperature_k: f64) -> (f64, f64) {
        match *self {
            Self::Constant { viscosity_pa_s } => (viscosity_pa_s, 0.0),
            Self::Walther { a, b, density_15c_kg_m3 } => {
                let w = 10f64.powf(a - b * temperature_k.log10());
                let shifted = 10f64.powf(w);
                let nu = (shifted - WALTHER_SHIFT) * 1e-6;
                let slope_nu = -shifted * std::f64::consts::LN_10 * w * b / temperature_k * 1e-6;
                let rho = density_15c_kg_m3 * (1.0 - EXPANSION_PER_K * (temperature_k - DATASHEET_DENSITY_K));
                let slope_rho = -density_15c_kg_m3 * EXPANSION_PER_K;
                (nu * rho, slope_nu * rho + nu * slope_rho)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walther_passes_through_both_points_of_the_data_sheet() {
        for (nu_40, nu_100) in [(139.0, 14.0), (32.0, 5.4), (68.0, 8.7)] {
            let oil = Viscosity::from_data_sheet(nu_40, nu_100, 895.0).unwrap();
            for (celsius, nu) in [(40.0, nu_40), (100.0, nu_100)] {
                let rho = 895.0 * (1.0 - EXPANSION_PER_K * (celsius - 15.0));
                let found = oil.at(ZERO_CELSIUS_K + celsius).0 / rho * 1e6;
                assert!((found / nu - 1.0).abs() < 1e-10, "{found} for {nu}");
            }
        }
    }

    #[test]
    fn slope_passes_the_taylor_test() {
        let oil = Viscosity::from_data_sheet(139.0, 14.0, 895.0).unwrap();
        for t in [300.0, 350.0, 420.0] {
            let (value, slope) = oil.at(t);
            let remainder = |d: f64| (oil.at(t + d).0 - value - slope * d).abs();
            let order = (remainder(1e-1) / remainder(5e-2)).log2();
            assert!((order - 2.0).abs() < 0.01, "order {order} at {t} K");
        }
    }

    #[test]
    fn refuses_an_oil_that_thickens() {
        assert!(Viscosity::from_data_sheet(14.0, 139.0, 895.0).is_err());
        assert!(Viscosity::from_data_sheet(139.0, 1.0, 895.0).is_err());
        assert!(Viscosity::from_data_sheet(f64::INFINITY, 5.0, 895.0).is_err());
    }
}

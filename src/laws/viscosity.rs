//! Dynamic viscosity of a lubricating oil over temperature.
//!
//! Deliberately not here: pressure and shear rate (laws of their own), products by name (the grades).

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
    /// Measured points must lie at different temperatures, with positive viscosities that fall.
    #[error("the viscosities must be positive and fall from point to point of rising temperature")]
    NotFalling,
    /// Vogel's curve falls ever more slowly on the logarithmic scale.
    #[error(
        "no Vogel curve passes: the logarithm of the viscosity must fall ever more slowly with temperature"
    )]
    NotVogel,
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
    /// `eta = A exp(B / (T + C))` with T in kelvin above `-C` (Vogel 1921); good between and near the points it was
    /// drawn through.
    Vogel {
        /// Viscosity the curve tends to at very high temperature.
        a_pa_s: f64,
        /// Steepness.
        b_k: f64,
        /// Minus the temperature at which the curve goes to infinity.
        c_k: f64,
    },
}

/// Vogel's `C` for mineral engine oils, `eta = A exp(B / (t + 95))` with t in degC: what two points leave open.
const USUAL_VOGEL_C_K: f64 = 95.0 - ZERO_CELSIUS_K;

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

    /// Vogel's law through three points `(temperature_k, viscosity_pa_s)` in any order.
    pub fn vogel_from_points(mut points: [(f64, f64); 3]) -> Result<Self, OilDataError> {
        points.sort_by(|p, q| p.0.total_cmp(&q.0));
        let [p1, p2, p3] = points;
        let (first, second) = (log_fall_per_k(p1, p2)?, log_fall_per_k(p2, p3)?);
        // first / second = (T3 + C) / (T1 + C)
        let bend = first / second;
        let pole_distance = (p3.0 - p1.0) / (bend - 1.0);
        if bend <= 1.0 || pole_distance > 1e6 {
            return Err(OilDataError::NotVogel);
        }
        vogel_through(p1, p2, pole_distance - p1.0)
    }

    /// Vogel's law through two points `(temperature_k, viscosity_pa_s)` in any order, with the `C` usual for mineral
    /// engine oils: `eta = A exp(B / (t + 95))`, t in degC above -95.
    pub fn vogel_from_two_points(mut points: [(f64, f64); 2]) -> Result<Self, OilDataError> {
        points.sort_by(|p, q| p.0.total_cmp(&q.0));
        vogel_through(points[0], points[1], USUAL_VOGEL_C_K)
    }

    /// Dynamic viscosity in Pa s at a temperature, and its derivative by the temperature.
    pub fn at(&self, temperature_k: f64) -> (f64, f64) {
        match *self {
            Self::Constant { viscosity_pa_s } => (viscosity_pa_s, 0.0),
            Self::Vogel { a_pa_s, b_k, c_k } => {
                let above_pole = temperature_k + c_k;
                let viscosity = a_pa_s * (b_k / above_pole).exp();
                (viscosity, -viscosity * b_k / (above_pole * above_pole))
            }
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

/// Mean fall of the logarithm of the viscosity from the colder to the warmer point.
fn log_fall_per_k(colder: (f64, f64), warmer: (f64, f64)) -> Result<f64, OilDataError> {
    let fall = (colder.1 / warmer.1).ln() / (warmer.0 - colder.0);
    let sound = warmer.0 > colder.0 && warmer.1 > 0.0 && fall > 0.0 && fall.is_finite();
    if sound { Ok(fall) } else { Err(OilDataError::NotFalling) }
}

fn vogel_through(colder: (f64, f64), warmer: (f64, f64), c_k: f64) -> Result<Viscosity, OilDataError> {
    let fall = log_fall_per_k(colder, warmer)?;
    let above_pole = colder.0 + c_k;
    if above_pole <= 0.0 {
        return Err(OilDataError::NotVogel);
    }
    let b_k = fall * above_pole * (warmer.0 + c_k);
    Ok(Viscosity::Vogel { a_pa_s: colder.1 * (-b_k / above_pole).exp(), b_k, c_k })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

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
        let oils = [
            Viscosity::Constant { viscosity_pa_s: 0.02 },
            Viscosity::from_data_sheet(139.0, 14.0, 895.0).unwrap(),
            Viscosity::vogel_from_two_points([(313.15, 0.12), (373.15, 0.012)]).unwrap(),
        ];
        for (oil, t) in oils.iter().flat_map(|oil| [300.0, 350.0, 420.0].map(|t| (oil, t))) {
            assert_slope(|t| oil.at(t).0, t, oil.at(t).1, 1e-1);
        }
    }

    #[test]
    fn vogel_passes_through_its_points() {
        // ISO VG 32, 46, 68 of the lubricant table of the program ross, and a Walther oil.
        for (eta_40, eta_100) in [
            (0.0279678922948, 0.00466713685563),
            (0.03969339831222, 0.006074815741696),
            (0.0570722, 0.00766498),
        ] {
            let points = [(373.15, eta_100), (313.15, eta_40)];
            let oil = Viscosity::vogel_from_two_points(points).unwrap();
            for (t, eta) in points {
                assert!((oil.at(t).0 / eta - 1.0).abs() < 1e-10);
            }
        }
        let walther = Viscosity::from_data_sheet(139.0, 14.0, 895.0).unwrap();
        let points = [313.15, 373.15, 343.15].map(|t| (t, walther.at(t).0));
        let oil = Viscosity::vogel_from_points(points).unwrap();
        for (t, eta) in points {
            assert!((oil.at(t).0 / eta - 1.0).abs() < 1e-10);
        }
        assert!((oil.at(328.15).0 / walther.at(328.15).0 - 1.0).abs() < 5e-3);
    }

    #[test]
    fn vogel_constants_come_back_and_impossible_points_are_refused() {
        let law = Viscosity::Vogel { a_pa_s: 4e-5, b_k: 1100.0, c_k: -170.0 };
        let points = [300.0, 340.0, 380.0].map(|t| (t, law.at(t).0));
        let Ok(Viscosity::Vogel { a_pa_s, b_k, c_k }) = Viscosity::vogel_from_points(points) else {
            panic!("no Vogel law")
        };
        for (found, expected) in [(a_pa_s, 4e-5), (b_k, 1100.0), (c_k, -170.0)] {
            assert!((found / expected - 1.0f64).abs() < 1e-9);
        }
        let three = Viscosity::vogel_from_points;
        let exponential = [300.0, 340.0, 380.0].map(|t: f64| (t, (-0.05 * t).exp()));
        assert_eq!(three(exponential), Err(OilDataError::NotVogel));
        assert_eq!(three([(300.0, 0.1), (340.0, 0.2), (380.0, 0.01)]), Err(OilDataError::NotFalling));
        assert_eq!(three([(300.0, 0.1), (300.0, 0.1), (380.0, 0.01)]), Err(OilDataError::NotFalling));
        assert_eq!(three([(300.0, 0.1), (340.0, f64::NAN), (380.0, 0.01)]), Err(OilDataError::NotFalling));
        let two = Viscosity::vogel_from_two_points;
        assert_eq!(two([(170.0, 0.1), (340.0, 0.02)]), Err(OilDataError::NotVogel));
        assert_eq!(two([(300.0, -0.1), (340.0, -0.02)]), Err(OilDataError::NotFalling));
    }

    #[test]
    fn refuses_an_oil_that_thickens() {
        assert!(Viscosity::from_data_sheet(14.0, 139.0, 895.0).is_err());
        assert!(Viscosity::from_data_sheet(139.0, 1.0, 895.0).is_err());
        assert!(Viscosity::from_data_sheet(f64::INFINITY, 5.0, 895.0).is_err());
    }
}

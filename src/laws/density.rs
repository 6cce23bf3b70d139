//! Density of the oil over pressure.
//!
//! Deliberately not here: thermal expansion (part of the viscosity law), vapour and dissolved gas (the cavity fraction).

/// How density follows pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Compressibility {
    /// The same density at every pressure.
    Incompressible,
    /// `rho/rho_0 = (5.9e8 + 1.34 p) / (5.9e8 + p)`, p in Pa (Dowson and Higginson 1966); mineral oils, -0.1 MPa to
    /// about 1 GPa.
    DowsonHigginson,
}

impl Compressibility {
    /// Density over ambient density at a pressure, and its derivative by the pressure.
    pub fn at(&self, pressure_pa: f64) -> (f64, f64) {
        const STIFFNESS_PA: f64 = 5.9e8;
        const LIMIT: f64 = 1.34;
        match self {
            Self::Incompressible => (1.0, 0.0),
            Self::DowsonHigginson => {
                let below = STIFFNESS_PA + pressure_pa;
                let ratio = (STIFFNESS_PA + LIMIT * pressure_pa) / below;
                (ratio, (LIMIT - 1.0) * STIFFNESS_PA / (below * below))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

    #[test]
    fn slope_passes_the_taylor_test() {
        for law in [Compressibility::Incompressible, Compressibility::DowsonHigginson] {
            for p in [-1e5, 0.0, 1e7, 3e8] {
                assert_slope(|p| law.at(p).0, p, law.at(p).1, 1e7);
            }
        }
    }

    #[test]
    fn meets_the_other_way_of_writing_it() {
        for p in [-1e5, 1e6, 1e8, 1e9] {
            // 1 + 0.6e-9 p / (1 + 1.7e-9 p): the same law with coefficients rounded to one or two digits.
            let other = 1.0 + 0.6e-9 * p / (1.0 + 1.7e-9 * p);
            assert!((Compressibility::DowsonHigginson.at(p).0 - other).abs() < 5e-2 * (other - 1.0).abs());
        }
        assert_eq!(Compressibility::DowsonHigginson.at(0.0).0, 1.0);
    }
}

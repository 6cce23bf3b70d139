//! Pressure of touching asperities (Greenwood and Tripp, Proc. Instn Mech. Engrs 185 (1971) 625).
//!
//! Deliberately not here: friction of the contact, wear, plastic flow (no cap on the pressure), bulk deformation.

use super::partials::Place;
use super::{ContactIntegral, Partials};
use thiserror::Error;

/// Why measured surfaces carry no Greenwood-Tripp contact.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SummitDataError {
    /// A profile has three positive moments.
    #[error("the spectral moments of a profile must be positive (found {0:?})")]
    Moments([f64; 3]),
    /// Both numbers of a surface pair are positive.
    #[error("eta beta sigma and sigma/beta must be positive (found {0} and {1})")]
    Summits(f64, f64),
}

/// `p = K E F_5/2(u)`, real over nominal area `pi^2 (eta beta sigma)^2 F_2(u)`, with
/// `u = (gap - delta_s)/sigma_s`, `sigma_s = summit_sigma_ratio sigma`, `delta_s = summit_height_ratio sigma` and the combined
/// roughness `sigma^2 = sigma_journal^2 + sigma_shell^2`. Elastic summits of Gaussian heights; sound while the real area is
/// a small share. `K` and `eta beta sigma` are held while the roughnesses vary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GreenwoodTripp {
    /// How the height integrals are evaluated.
    pub integral: ContactIntegral,
    /// Elastic factor `K`, often 1e-4 to 3e-3.
    pub elastic_factor: f64,
    /// Composite modulus `E = 1 / [(1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2]`.
    pub modulus_pa: f64,
    /// Spread of the summit heights over sigma; 1 where summits are taken for all heights.
    pub summit_sigma_ratio: f64,
    /// Mean height of the summits above the mean plane over sigma; 0 where summits are taken for all heights.
    pub summit_height_ratio: f64,
    /// `eta beta sigma`: summit density, summit radius and roughness; measured 0.03 to 0.05.
    pub asperity_product: f64,
}

impl GreenwoodTripp {
    /// From `eta beta sigma` (0.03 to 0.05) and `sigma/beta` (1e-4 to 1e-2) of the pair:
    /// `K = (16 sqrt 2/15) pi (eta beta sigma)^2 sqrt(sigma/beta)`; summits spread like all heights about the mean plane.
    pub fn from_summits(
        integral: ContactIntegral,
        modulus_pa: f64,
        asperity_product: f64,
        sigma_over_beta: f64,
    ) -> Result<Self, SummitDataError> {
        let sound = |x: f64| x > 0.0 && x.is_finite();
        if !sound(asperity_product) || !sound(sigma_over_beta) {
            return Err(SummitDataError::Summits(asperity_product, sigma_over_beta));
        }
        let front = 16.0 * std::f64::consts::SQRT_2 / 15.0 * std::f64::consts::PI;
        Ok(Self {
            integral,
            elastic_factor: front * asperity_product.powi(2) * sigma_over_beta.sqrt(),
            modulus_pa,
            summit_sigma_ratio: 1.0,
            summit_height_ratio: 0.0,
            asperity_product,
        })
    }

    /// From the spectral moments of the combined profile: mean squares `[m0 (m2), m2 (1), m4 (1/m2)]` of height, slope and
    /// curvature, `sigma = sqrt m0`, `eta = m4/(6 pi sqrt 3 m2)`, `beta = 3 sqrt pi/(8 sqrt m4)` (Nayak 1971).
    pub fn from_spectral_moments(
        integral: ContactIntegral,
        modulus_pa: f64,
        moments: [f64; 3],
    ) -> Result<Self, SummitDataError> {
        if moments.iter().any(|m| !(*m > 0.0 && m.is_finite())) {
            return Err(SummitDataError::Moments(moments));
        }
        let [m0, m2, m4] = moments;
        let pi = std::f64::consts::PI;
        let sigma = m0.sqrt();
        let eta = m4 / (6.0 * pi * 3f64.sqrt() * m2);
        let beta = 3.0 * pi.sqrt() / (8.0 * m4.sqrt());
        Self::from_summits(integral, modulus_pa, eta * beta * sigma, sigma / beta)
    }

    /// Composite modulus of two materials `(Young's modulus in Pa, Poisson's ratio)`.
    pub fn composite_modulus_pa(materials: [(f64, f64); 2]) -> f64 {
        1.0 / materials.map(|(modulus_pa, nu)| (1.0 - nu * nu) / modulus_pa).iter().sum::<f64>()
    }

    /// Mean contact pressure in Pa at a nominal gap (any sign) and two roughnesses, not both zero.
    pub fn at(&self, gap_m: f64, sigma_journal_m: f64, sigma_shell_m: f64) -> Partials {
        let place = Place::new(gap_m, sigma_journal_m, sigma_shell_m);
        let integral = self.integral.at(self.summit_height(&place));
        self.turned(&place, self.elastic_factor * self.modulus_pa, integral)
    }

    /// Real over nominal contact area at a nominal gap (any sign) and two roughnesses, not both zero.
    pub fn area_share(&self, gap_m: f64, sigma_journal_m: f64, sigma_shell_m: f64) -> Partials {
        let place = Place::new(gap_m, sigma_journal_m, sigma_shell_m);
        let integral = self.integral.area_integral(self.summit_height(&place));
        self.turned(&place, (std::f64::consts::PI * self.asperity_product).powi(2), integral)
    }

    /// `u`, the gap over the summits in units of their spread.
    fn summit_height(&self, place: &Place) -> f64 {
        (place.height - self.summit_height_ratio) / self.summit_sigma_ratio
    }

    fn turned(&self, place: &Place, scale: f64, (value, slope): (f64, f64)) -> Partials {
        place.scaled(0, (scale * value, scale * slope / self.summit_sigma_ratio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

    const SIGMAS: [f64; 2] = [0.3e-6, 0.4e-6];

    fn pair(integral: ContactIntegral) -> GreenwoodTripp {
        let modulus = GreenwoodTripp::composite_modulus_pa([(2.1e11, 0.3), (6e10, 0.33)]);
        let flat = GreenwoodTripp::from_summits(integral, modulus, 0.04, 1e-3).unwrap();
        GreenwoodTripp { summit_sigma_ratio: 0.7, summit_height_ratio: 0.9, ..flat }
    }

    #[test]
    fn every_slope_passes_the_taylor_test() {
        for integral in [ContactIntegral::Exact, ContactIntegral::PowerFit] {
            let law = pair(integral);
            for height in [-1.0, 0.1, 0.8, 2.2, 3.6] {
                let at = [height * 0.5e-6, SIGMAS[0], SIGMAS[1]];
                for evaluate in [GreenwoodTripp::at, GreenwoodTripp::area_share] {
                    let found = evaluate(&law, at[0], at[1], at[2]);
                    for k in 0..3 {
                        let along = |x: f64| {
                            let mut moved = at;
                            moved[k] = x;
                            evaluate(&law, moved[0], moved[1], moved[2]).value
                        };
                        assert_slope(along, at[k], found.by[k], 2e-10);
                    }
                }
            }
        }
    }

    #[test]
    fn pressure_and_area_are_the_formulas_written_out() {
        let law = pair(ContactIntegral::Exact);
        assert!((law.modulus_pa / 5.2124e10 - 1.0).abs() < 1e-4, "{}", law.modulus_pa);
        assert!((law.elastic_factor / 2.39776e-4 - 1.0).abs() < 1e-4, "{}", law.elastic_factor);
        // sigma = 0.5 um, sigma_s = 0.35 um, delta_s = 0.45 um: u = 1 at 0.8 um.
        let found = law.at(0.8e-6, SIGMAS[0], SIGMAS[1]).value;
        assert!((found / (law.elastic_factor * law.modulus_pa * 0.080_562_335_6) - 1.0).abs() < 1e-5);
        let area = law.area_share(0.8e-6, SIGMAS[0], SIGMAS[1]).value;
        assert!((area / (9.869_604_401 * 0.0016 * 0.075_339_783_3) - 1.0).abs() < 1e-8);
        assert_eq!(law.at(3e-6, SIGMAS[0], SIGMAS[1]).value, 0.0);
    }

    #[test]
    fn moments_of_a_profile_give_the_same_law_as_its_summits() {
        let (m0, m2, m4) = (0.25e-12f64, 4e-3, 2.4e8f64);
        let made = |moments| GreenwoodTripp::from_spectral_moments(ContactIntegral::Exact, 1e11, moments);
        let law = made([m0, m2, m4]).unwrap();
        let beta = 0.375 * std::f64::consts::PI.sqrt() / m4.sqrt();
        let eta = m4 / (32.648_388_6 * m2);
        assert!((law.asperity_product / (eta * beta * m0.sqrt()) - 1.0).abs() < 1e-8);
        let same =
            GreenwoodTripp::from_summits(law.integral, 1e11, law.asperity_product, m0.sqrt() / beta).unwrap();
        assert!((law.elastic_factor / same.elastic_factor - 1.0).abs() < 1e-12);
        assert!(made([0.0, m2, m4]).is_err());
        assert!(GreenwoodTripp::from_summits(ContactIntegral::Exact, 1e11, 0.04, f64::NAN).is_err());
    }
}

//! Average flow between two rough surfaces (Patir and Cheng, ASME J. Lubr. Technol. 100 (1978) 12 and 101 (1979) 220).
//!
//! Surface 1 is the journal, surface 2 the shell; `y` runs from journal to shell, `u` are their speeds. With the fields
//! of [`RoughFilm`]
//!
//! ```text
//! flow/width  = -phi_x flow_gap^3/(12 eta) dp/dx + (u1 + u2)/2 average_gap + (u1 - u2)/2 shear_thickness
//! tau_journal = eta (u2 - u1) couette_journal_per_m - pressure_stress flow_gap/2 dp/dx
//! tau_shell   = eta (u2 - u1) couette_shell_per_m   + pressure_stress flow_gap/2 dp/dx
//! power/area  = tau_shell u2 - tau_journal u1
//! ```
//!
//! Deliberately not here: deformation of asperities, wear of the heights, and gradients by the Peklenik numbers.

use super::Partials;
use super::height_table::HeightTable;
use super::partials::{Place, Slope};
use super::patir_cheng::{RoughnessError, log_peklenik};
use super::roughness_functions::{
    Pressure, PressureStress, Shear, ShearStress, average_gap, couette, flow_gap,
};
use std::sync::Arc;

/// Two rough surfaces of given lay, ready to be evaluated: the coefficients of the tables are interpolated once.
///
/// A Peklenik number is the ratio of the correlation lengths along and across the sliding direction: 1/9 (ridges across)
/// to 9 (ridges along), 1 isotropic. The pressure factors belong to the combined roughness; its number is the
/// variance-weighted mean of the two logarithms (a choice: the source is silent; the mean of logarithms keeps
/// `phi_z(gamma) = phi_x(1/gamma)`), fixed at construction so that roughness gradients are at constant lay.
#[derive(Debug, Clone, PartialEq)]
pub struct RoughSurfaces {
    log_gamma_combined: f64,
    around: Pressure,
    across: Pressure,
    shear: [Shear; 2],
    shear_stress: [ShearStress; 2],
    pressure_stress: PressureStress,
    tables: [Arc<HeightTable<FUNCTIONS>>; 2],
}

/// Functions of `H` that the factors are made of.
const FUNCTIONS: usize = 10;
/// Ranges of `H` that are tabulated, and intervals per unit: fine where surfaces nearly touch, coarse beyond.
const TABLES: [(f64, f64, usize); 2] = [(-2.0, 16.0, 128), (16.0, 512.0, 4)];

/// Everything the film needs of its two rough surfaces at one point.
///
/// All values are finite and once continuously differentiable for every gap, also below zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughFilm {
    /// `phi_x`: pressure flow factor along the sliding direction, above zero.
    pub pressure_around: Partials,
    /// `phi_z = phi_x(H, 1/gamma)`: pressure flow factor across it, above zero.
    pub pressure_across: Partials,
    /// The gap for pressure flow in m: the nominal gap down to half a sigma, then smoothly to a tenth of a sigma.
    pub flow_gap: Partials,
    /// Mean gap of Gaussian surfaces in m; its slope by the gap is the contact factor.
    pub average_gap: Partials,
    /// `sigma phi_s` in m, above zero where the journal is the rougher surface (of equal lay).
    pub shear_thickness: Partials,
    /// `(phi_f - phi_fs)/gap` in 1/m: the rougher wall is sheared less (its valleys hold slow oil) ...
    pub couette_journal_per_m: Partials,
    /// `(phi_f + phi_fs)/gap` in 1/m: ... and the smoother one more.
    pub couette_shell_per_m: Partials,
    /// `(phi_f + share_1 Phi_fs1 + share_2 Phi_fs2)/gap` in 1/m: wall shear **and** pressure on the flanks of the
    /// asperities, equal and opposite on both bodies. The two wall stresses above, like their source, leave the flanks
    /// out and so balance only for equal surfaces.
    pub drag_per_m: Partials,
    /// `phi_fp`: factor on the pressure part of the wall stress; may fall below zero for gaps under one sigma.
    pub pressure_stress: Partials,
}

impl RoughSurfaces {
    /// From the lay of both surfaces and their nominal roughnesses (standard deviations of the heights).
    pub fn new(
        gamma_journal: f64,
        gamma_shell: f64,
        sigma_journal_m: f64,
        sigma_shell_m: f64,
    ) -> Result<Self, RoughnessError> {
        let logs = [log_peklenik(gamma_journal)?, log_peklenik(gamma_shell)?];
        let squares = [sigma_journal_m.powi(2), sigma_shell_m.powi(2)];
        let total = squares[0] + squares[1];
        let sound = sigma_journal_m >= 0.0 && sigma_shell_m >= 0.0 && total > 0.0 && total.is_finite();
        if !sound {
            return Err(RoughnessError::Sigma(sigma_journal_m, sigma_shell_m));
        }
        let combined = (squares[0] * logs[0] + squares[1] * logs[1]) / total;
        let (around, across) = (Pressure::new(combined), Pressure::new(-combined));
        let (shear, shear_stress) = (logs.map(Shear::new), logs.map(ShearStress::new));
        let pressure_stress = PressureStress::new(combined);
        let mut surfaces = Self {
            log_gamma_combined: combined,
            around,
            across,
            shear,
            shear_stress,
            pressure_stress,
            tables: TABLES.map(|_| Arc::new(HeightTable::empty())),
        };
        let made = |(low, high, per_unit)| HeightTable::new(low, high, per_unit, |h| surfaces.functions(h));
        surfaces.tables = TABLES.map(|range| Arc::new(made(range)));
        Ok(surfaces)
    }

    /// Peklenik number of the combined roughness.
    pub fn gamma_combined(&self) -> f64 {
        self.log_gamma_combined.exp()
    }

    /// All factors at a nominal gap (distance of the mean planes, any sign) and two roughnesses, not both zero.
    pub fn at(&self, gap_m: f64, sigma_journal_m: f64, sigma_shell_m: f64) -> RoughFilm {
        let place = Place::new(gap_m, sigma_journal_m, sigma_shell_m);
        RoughFilm::of(&place, self.functions(place.height))
    }

    /// The same from a table, within 1e-8 and several times faster: for the cells of a film.
    /// Slopes by the roughnesses are zero unless they are wanted. Inlined, so that what a caller leaves is not computed.
    #[inline(always)]
    pub fn tabulated(
        &self,
        gap_m: f64,
        [sigma_journal_m, sigma_shell_m]: [f64; 2],
        by_roughness: bool,
    ) -> RoughFilm {
        let place = Place::new(gap_m, sigma_journal_m, sigma_shell_m);
        let place = if by_roughness { place } else { place.by_gap_only() };
        let h = place.height;
        let [near, far] = &self.tables;
        if let Some(found) = near.at(h) {
            return RoughFilm::of(&place, found);
        }
        RoughFilm::of(&place, far.at(h).unwrap_or_else(|| self.functions(h)))
    }

    #[cold]
    fn functions(&self, h: f64) -> [Slope; FUNCTIONS] {
        let [shear_1, shear_2] = self.shear.map(|law| law.at(h));
        let [stress_1, stress_2] = self.shear_stress.map(|law| law.at(h));
        let (around, across, pressure) = (self.around.at(h), self.across.at(h), self.pressure_stress.at(h));
        let (average, flow) = (average_gap(h), flow_gap(h));
        [around, across, flow, average, shear_1, shear_2, couette(h), stress_1, stress_2, pressure]
    }
}

impl RoughFilm {
    /// The factors from the functions of `H`.
    #[inline(always)]
    fn of(place: &Place, functions: [Slope; FUNCTIONS]) -> Self {
        let [around, across, flow, average, shear_1, shear_2, mean, stress_1, stress_2, pressure] = functions;
        let minus = |(value, slope): Slope| (-value, -slope);
        Self {
            pressure_around: place.scaled(0, around),
            pressure_across: place.scaled(0, across),
            flow_gap: place.scaled(1, flow),
            average_gap: place.scaled(1, average),
            shear_thickness: place.shared(1, (0.0, 0.0), shear_1, minus(shear_2)),
            couette_journal_per_m: place.shared(-1, mean, minus(stress_1), stress_2),
            couette_shell_per_m: place.shared(-1, mean, stress_1, minus(stress_2)),
            drag_per_m: place.shared(-1, mean, stress_1, stress_2),
            pressure_stress: place.scaled(0, pressure),
        }
    }
}

#[cfg(test)]
mod tests;

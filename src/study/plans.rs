//! Checked pieces of a study, in SI units: what the checks hand on.

use super::file::{CavitationName, CavityShearName, FilmModelName};
use super::variables::Variable;
use super::vocabulary::QuantityName;
use crate::cranktrain::{BearingParameter, BearingShape, LoadTable, Tilt};
use crate::film::{Feed, Oil, Roughness, all_symmetric};
use crate::laws::Viscosity;
use crate::optimise::Sense;

/// Where the load of a planned bearing comes from.
#[derive(Debug, Clone)]
pub(super) enum LoadPlan {
    BigEnd,
    Main(usize),
    Table(LoadTable),
}

/// A checked bearing.
#[derive(Debug, Clone)]
pub struct BearingPlan {
    /// Name in the study.
    pub name: String,
    /// Width, m.
    pub width_m: f64,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Diametral clearance, m.
    pub diametral_clearance_m: f64,
    /// Mass that moves with the journal, kg.
    pub journal_mass_kg: f64,
    /// How many there are.
    pub count: u32,
    /// How the journal stands to the shell's axis.
    pub tilt: Tilt,
    /// Oil supply.
    pub supply: Option<SupplyPlan>,
    /// Rough surfaces.
    pub roughness: Option<RoughnessPlan>,
    /// Heat balance over the cycle.
    pub heat: Option<HeatPlan>,
    /// Shapes of the surfaces.
    pub shapes: Vec<BearingShape>,
    pub(super) load: LoadPlan,
}

impl BearingPlan {
    /// Value of what can be varied; none for what belongs to the oil or to a stage.
    pub(super) fn value(&self, parameter: BearingParameter) -> Option<f64> {
        let rough = self.roughness.as_ref();
        match parameter {
            BearingParameter::Width => Some(self.width_m),
            BearingParameter::Diameter => Some(self.diameter_m),
            BearingParameter::DiametralClearance => Some(self.diametral_clearance_m),
            BearingParameter::InletTemperature
            | BearingParameter::FilmTemperature
            | BearingParameter::LoadFactor
            | BearingParameter::Speed => None,
            BearingParameter::JournalRoughness => rough.map(|r| r.journal_m),
            BearingParameter::ShellRoughness => rough.map(|r| r.shell_m),
            BearingParameter::SupplyPressure => self.supply.as_ref().map(|s| s.pressure_pa),
            BearingParameter::Tilt(axis) => match self.tilt {
                Tilt::Given(tilt) => Some(tilt[axis]),
                Tilt::Free => None,
            },
            BearingParameter::Shape(shape, k) => {
                self.shapes.get(shape).and_then(|s| s.profile.coefficients().get(k).copied())
            }
        }
    }

    /// Whether bearing and film are symmetric about the mid-plane, whatever the values of the parameters that vary.
    pub(super) fn symmetric(&self, tilt_varies: bool) -> bool {
        self.tilt == Tilt::Given([0.0; 2])
            && !tilt_varies
            && self.supply.as_ref().is_none_or(|s| all_symmetric(&s.feeds))
            && self.shapes.iter().all(|s| s.profile.symmetric())
    }

    /// Whether asperities may touch.
    pub(super) fn has_contact(&self) -> bool {
        self.roughness.as_ref().is_some_and(|r| r.film.contact.is_some())
    }
}

/// A checked oil supply.
#[derive(Debug, Clone, PartialEq)]
pub struct SupplyPlan {
    /// Supply pressure above that of the surroundings, Pa.
    pub pressure_pa: f64,
    /// Openings.
    pub feeds: Vec<Feed>,
}

/// Checked rough surfaces.
#[derive(Debug, Clone)]
pub struct RoughnessPlan {
    /// Root mean square roughness of the journal, m.
    pub journal_m: f64,
    /// Root mean square roughness of the shell, m.
    pub shell_m: f64,
    /// Volume worn off per work of contact friction, m3/J.
    pub wear_m3_per_j: f64,
    /// What the film makes of them.
    pub film: Roughness,
}

/// A checked heat balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatPlan {
    /// Film temperature between inlet (0) and outlet (1) of the oil.
    pub film_share: f64,
    /// Heat conducted away per kelvin above the surroundings, W/K.
    pub conductance_w_k: f64,
    /// Temperature of the surroundings, K.
    pub ambient_k: f64,
}

/// A checked oil.
#[derive(Debug, Clone)]
pub struct OilPlan {
    /// Viscosity over temperature.
    pub viscosity: Viscosity,
    /// Temperature at the inlet, K.
    pub inlet_temperature_k: f64,
    /// Film less inlet temperature, K: given, or where a heat balance starts.
    pub film_rise_k: f64,
    /// Pressure and shear.
    pub laws: Oil,
    /// Density times heat capacity, J/(m3 K); zero without a heat balance.
    pub volumetric_heat_j_m3_k: f64,
    /// Where its viscosity comes from, in words for the report.
    pub(super) source: String,
}

/// A checked operating point.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatingPoint {
    /// Name in reports.
    pub name: String,
    /// Speed of the crankshaft, rad/s.
    pub speed_rad_s: f64,
    /// Share in the objective; all shares add up to 1.
    pub weight: f64,
    /// Factor on cylinder pressure or load.
    pub load_factor: f64,
}

/// A checked design parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterPlan {
    /// Name in the study.
    pub name: String,
    /// Bearing it belongs to; `None` for the oil.
    pub bearing: Option<usize>,
    /// Stage of the running-in programme it belongs to, if any.
    pub stage: Option<usize>,
    /// Which property.
    pub variable: Variable,
    /// Lower bound, SI units.
    pub lower: f64,
    /// Upper bound, SI units.
    pub upper: f64,
    /// Start of the search, SI units.
    pub start: f64,
}

/// A checked limit.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstraintPlan {
    /// Limited quantity.
    pub quantity: QuantityName,
    /// Bearing; `None` for all.
    pub bearing: Option<usize>,
    /// Allowed side.
    pub sense: Sense,
    /// Limit, SI units.
    pub limit: f64,
}

/// A checked film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmPlan {
    /// Model.
    pub model: FilmModelName,
    /// Rupture.
    pub cavitation: CavitationName,
    /// Shear in the cavity.
    pub cavity_shear: CavityShearName,
    /// Columns.
    pub cells_around: usize,
    /// Cells across half of the width.
    pub cells_across_half: usize,
    /// Pressure at both edges above that of the surroundings, Pa.
    pub side_pressure_pa: f64,
    /// Cavitation pressure above that of the surroundings (usually below zero), Pa.
    pub cavitation_pressure_pa: f64,
}

impl FilmPlan {
    /// Whether oil is kept account of, but none comes in over the edges.
    pub(super) fn runs_dry(&self) -> bool {
        self.model == FilmModelName::Reynolds
            && self.cavitation == CavitationName::MassConserving
            && self.side_pressure_pa <= self.cavitation_pressure_pa
    }
}

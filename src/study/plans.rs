//! Checked pieces of a study, in SI units: what the checks hand on.

use super::file::{CavitationName, FilmModelName};
use super::vocabulary::{QuantityName, Variable};
use crate::cranktrain::LoadTable;
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
    pub(super) load: LoadPlan,
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
    /// Columns.
    pub cells_around: usize,
    /// Cells across half of the width.
    pub cells_across_half: usize,
    /// Pressure at both edges above that of the surroundings, Pa.
    pub side_pressure_pa: f64,
    /// Cavitation pressure above that of the surroundings (usually below zero), Pa.
    pub cavitation_pressure_pa: f64,
}

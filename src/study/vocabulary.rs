//! The words of a study: quantities.

use crate::cranktrain::BearingOutput;
use crate::laws::ZERO_CELSIUS_K;
use crate::orbit::{Quantity, Reduction};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number a cycle is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum QuantityName {
    /// Mean friction loss over the working cycle (wall power).
    MeanFrictionLoss,
    /// Smallest film thickness in the cycle.
    MinFilmThickness,
    /// Largest film pressure in the cycle.
    MaxFilmPressure,
    /// Largest load over projected area in the cycle.
    SpecificLoad,
    /// Mean oil flow out of both edges.
    SideFlow,
    /// Largest pressure of touching asperities in the cycle, a mean over summits and valleys.
    MaxContactPressure,
    /// Mean friction loss of touching asperities: the wear that is to be expected.
    ContactLoss,
    /// Mean friction loss of the oil film alone.
    HydrodynamicLoss,
    /// Effective temperature of the film: given, or the result of the heat balance.
    FilmTemperature,
    /// Mean volume worn off per time after Archard, by roughness.wear_coefficient.
    WearRate,
}

impl QuantityName {
    /// Whether it is about touching asperities.
    pub(super) fn is_of_contact(self) -> bool {
        matches!(self, Self::MaxContactPressure | Self::ContactLoss | Self::WearRate)
    }

    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::MeanFrictionLoss,
        Self::MinFilmThickness,
        Self::MaxFilmPressure,
        Self::SpecificLoad,
        Self::SideFlow,
        Self::MaxContactPressure,
        Self::ContactLoss,
        Self::HydrodynamicLoss,
        Self::FilmTemperature,
        Self::WearRate,
    ];

    /// Unit in reports, and its size in SI units.
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            Self::MeanFrictionLoss | Self::ContactLoss | Self::HydrodynamicLoss => ("W", 1.0),
            Self::FilmTemperature => ("degC", 1.0),
            Self::WearRate => ("mm3/h", 1e-9 / 3600.0),
            Self::MinFilmThickness => ("um", 1e-6),
            Self::MaxFilmPressure | Self::SpecificLoad | Self::MaxContactPressure => ("MPa", 1e6),
            Self::SideFlow => ("l/min", 1e-3 / 60.0),
        }
    }

    /// A value in the unit of reports.
    pub fn shown(self, si: f64) -> f64 {
        match self {
            Self::FilmTemperature => si - ZERO_CELSIUS_K,
            _ => si / self.unit().1,
        }
    }

    /// Name in reports.
    pub fn title(self) -> &'static str {
        match self {
            Self::MeanFrictionLoss => "mean friction loss",
            Self::MinFilmThickness => "minimum film thickness",
            Self::MaxFilmPressure => "maximum film pressure",
            Self::SpecificLoad => "specific load",
            Self::SideFlow => "side flow",
            Self::MaxContactPressure => "maximum contact pressure",
            Self::ContactLoss => "contact loss",
            Self::HydrodynamicLoss => "hydrodynamic loss",
            Self::FilmTemperature => "film temperature",
            Self::WearRate => "wear rate",
        }
    }

    /// The name as written in a study.
    pub fn key(self) -> &'static str {
        match self {
            Self::MeanFrictionLoss => "mean-friction-loss",
            Self::MinFilmThickness => "min-film-thickness",
            Self::MaxFilmPressure => "max-film-pressure",
            Self::SpecificLoad => "specific-load",
            Self::SideFlow => "side-flow",
            Self::MaxContactPressure => "max-contact-pressure",
            Self::ContactLoss => "contact-loss",
            Self::HydrodynamicLoss => "hydrodynamic-loss",
            Self::FilmTemperature => "film-temperature",
            Self::WearRate => "wear-rate",
        }
    }

    /// The smooth quantity that is optimised, and the exact one that is reported beside it.
    pub fn of_cycle(self, sharpness: f64) -> (Quantity, Quantity) {
        let both = |output: BearingOutput, smooth, exact| {
            let output = output.index();
            (Quantity { output, reduction: smooth }, Quantity { output, reduction: exact })
        };
        match self {
            Self::MeanFrictionLoss => both(BearingOutput::Loss, Reduction::Mean, Reduction::Mean),
            Self::MinFilmThickness => {
                both(BearingOutput::GapMin, Reduction::SmoothMin(sharpness), Reduction::Min)
            }
            Self::MaxFilmPressure => {
                both(BearingOutput::PressurePeak, Reduction::SmoothMax(sharpness), Reduction::Max)
            }
            // The load does not depend on the design, so its largest step does not move: no smoothing needed.
            Self::SpecificLoad => both(BearingOutput::SpecificLoad, Reduction::Max, Reduction::Max),
            Self::SideFlow => both(BearingOutput::SideFlow, Reduction::Mean, Reduction::Mean),
            Self::MaxContactPressure => {
                both(BearingOutput::ContactPeak, Reduction::SmoothMax(sharpness), Reduction::Max)
            }
            Self::ContactLoss => both(BearingOutput::ContactLoss, Reduction::Mean, Reduction::Mean),
            Self::HydrodynamicLoss => both(BearingOutput::HydrodynamicLoss, Reduction::Mean, Reduction::Mean),
            Self::FilmTemperature => both(BearingOutput::FilmTemperature, Reduction::Mean, Reduction::Mean),
            Self::WearRate => both(BearingOutput::WearRate, Reduction::Mean, Reduction::Mean),
        }
    }
}

//! The words of a study: quantities and design variables.

use crate::cranktrain::{BearingOutput, BearingParameter};
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
}

impl QuantityName {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::MeanFrictionLoss,
        Self::MinFilmThickness,
        Self::MaxFilmPressure,
        Self::SpecificLoad,
        Self::SideFlow,
    ];

    /// Unit in reports, and its size in SI units.
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            Self::MeanFrictionLoss => ("W", 1.0),
            Self::MinFilmThickness => ("um", 1e-6),
            Self::MaxFilmPressure | Self::SpecificLoad => ("MPa", 1e6),
            Self::SideFlow => ("l/min", 1e-3 / 60.0),
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
        }
    }
}

/// A property of a bearing or its oil that can be a design parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// Name within its section of the study.
    pub key: &'static str,
    /// What it is in the model.
    pub parameter: BearingParameter,
    /// Unit in reports.
    pub unit: &'static str,
    /// Size of that unit, and its zero, in SI units.
    pub scale: (f64, f64),
}

impl Variable {
    /// Variables of a bearing, written `<bearing>.<key>`.
    pub const BEARING: [Self; 3] = [
        Self { key: "width", parameter: BearingParameter::Width, unit: "mm", scale: (1e-3, 0.0) },
        Self { key: "diameter", parameter: BearingParameter::Diameter, unit: "mm", scale: (1e-3, 0.0) },
        Self {
            key: "diametral_clearance",
            parameter: BearingParameter::DiametralClearance,
            unit: "um",
            scale: (1e-6, 0.0),
        },
    ];
    /// Variables of the oil, written `oil.<key>`, shared by all bearings.
    pub const OIL: [Self; 1] = [Self {
        key: "inlet_temperature",
        parameter: BearingParameter::InletTemperature,
        unit: "degC",
        scale: (1.0, 273.15),
    }];

    /// A value in the unit of reports.
    pub fn shown(&self, si: f64) -> f64 {
        (si - self.scale.1) / self.scale.0
    }
}

//! The study file as it is written: every key, its meaning and its default. The JSON Schema is made from these types.

use super::given::Unknown;
use super::vocabulary::QuantityName;
use super::{Given, table::TableFile};
use crate::gradient::EngineName;
use crate::units::{
    Angle, Density, DynamicViscosity, Heat, KinematicViscosity, Length, Mass, Pressure, Rotation,
    Temperature, TemperatureRise,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// A quantity whose kind depends on another key: text with a number and a unit.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct QuantityText(pub String);

impl<'de> Deserialize<'de> for QuantityText {
    fn deserialize<D: serde::Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        match Value::deserialize(d)? {
            Value::String(text) => Ok(Self(text)),
            _ => Err(serde::de::Error::custom("expected a quantity with its unit in quotes, like \"65 mm\"")),
        }
    }
}

macro_rules! section {
    ($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $kind:ty,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
        #[serde(default)]
        #[schemars(deny_unknown_fields)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: Given<$kind>,)*
            /// Keys that are not part of the format.
            #[serde(flatten)]
            #[schemars(skip)]
            pub unknown: Unknown,
        }
    };
}

section! {
    /// A stribeck study: which bearings, under which load, varied how, judged by what.
    StudyFile {
        /// Version of the format: "stribeck-study/1".
        format: String,
        /// Title of the report.
        title: String,
        /// The question this study answers, for its readers. Default: none.
        question: String,
        /// What is not known but assumed: path of a key and the reason for its value. Listed in the report.
        assumptions: BTreeMap<String, String>,
        /// The machine: needed unless every bearing has its load as a table.
        machine: MachineFile,
        /// Cylinder pressure: needed with the machine.
        cylinder_pressure: CylinderPressureFile,
        /// Bearings by name.
        bearings: BTreeMap<String, Given<BearingFile>>,
        /// The oil of all bearings.
        oil: OilFile,
        /// Film model.
        film: FilmFile,
        /// How the working cycle is computed.
        orbit: OrbitFile,
        /// What is minimised, at which operating points.
        objective: ObjectiveFile,
        /// Design parameters with their box.
        parameters: Vec<Given<ParameterFile>>,
        /// Limits of a safe design.
        constraints: Vec<Given<ConstraintFile>>,
        /// How gradients are computed.
        gradient: GradientFile,
        /// How the design is searched.
        optimiser: OptimiserFile,
    }
}

section! {
    /// Slider-crank, masses, and for main bearings the crankshaft.
    MachineFile {
        /// Cylinder bore.
        bore: Length,
        /// Crank radius.
        throw: Length,
        /// Length of the connecting rod; or give throw_over_rod.
        rod_length: Length,
        /// Crank radius over rod length; or give rod_length.
        throw_over_rod: f64,
        /// Distance of the cylinder axis from the crank's centre, positive towards the side the crank turns to after top dead centre. Default "0 mm".
        piston_pin_offset: Length,
        /// Piston, pin, rings and the oscillating share of the rod.
        oscillating_mass: Mass,
        /// Rotating share of the rod.
        rotating_mass: Mass,
        /// Absolute pressure below the piston. Default "1 bar".
        crankcase_pressure: Pressure,
        /// Angle between the banks, 0 for an in-line engine; bank A stands ahead of bank B in the sense of rotation (negative: behind). Default "0 deg". For main bearings.
        vee_angle: Angle,
        /// Angle of each throw ahead of the first. For main bearings.
        throw_angles: Vec<Given<Angle>>,
        /// All cylinders in the order they fire, like "A1" (bank and throw, counted from the free end). For main bearings.
        firing_order: Vec<String>,
        /// Unbalanced mass of one throw at the crank radius (pin and webs less counterweights). Default "0 kg". For main bearings.
        throw_mass: Mass,
        /// Distance of the two rods on one pin over the distance of the main bearings; bank A nearer to the free end. Default 0. For main bearings.
        rod_spacing_ratio: f64,
    }
}

/// Where the cylinder pressure comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PressureSource {
    /// An indicator diagram, columns crank_angle_deg and pressure_mpa (or _bar, _pa), absolute pressure over one cycle from firing top dead centre.
    Table,
    /// A computed single-zone cycle with Wiebe heat release.
    Wiebe,
}

section! {
    /// Pressure above the piston over the working cycle.
    CylinderPressureFile {
        /// "table" or "wiebe".
        source: PressureSource,
        /// The indicator diagram, for source = "table".
        table: TableFile,
        /// Volume at bottom over volume at top dead centre. For source = "wiebe", like all below.
        compression_ratio: f64,
        /// Absolute pressure at inlet closing.
        charge_pressure: Pressure,
        /// Temperature at inlet closing.
        charge_temperature: Temperature,
        /// Net heat released per cylinder and cycle (wall losses taken off).
        heat_release: Heat,
        /// Start of combustion after firing top dead centre (negative: before).
        combustion_start: Angle,
        /// Duration of combustion, to 99.9 % burnt.
        combustion_duration: Angle,
        /// Shape exponent of the Wiebe function. Default 1.
        combustion_shape: f64,
        /// Inlet closes, after firing top dead centre (so negative). Default "-150 deg".
        inlet_closes: Angle,
        /// Exhaust opens. Default "125 deg".
        exhaust_opens: Angle,
        /// Absolute pressure in the exhaust. Default: the charge pressure.
        exhaust_pressure: Pressure,
    }
}

/// Which bearing it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BearingKind {
    /// Big end of a connecting rod; the frame turns with the rod, 0 deg points to the small end.
    BigEnd,
    /// Main bearing of the crankshaft; frame at rest, 0 deg points up along the symmetry plane of the banks.
    Main,
    /// Load from a table, frame at rest.
    Table,
}

section! {
    /// One journal bearing.
    BearingFile {
        /// "big-end", "main" or "table".
        kind: BearingKind,
        /// Width.
        width: Length,
        /// Diameter.
        diameter: Length,
        /// Difference of the diameters of shell and journal.
        diametral_clearance: Length,
        /// Mass that moves with the journal. Default "0 kg": inertia of the journal's small motion neglected.
        journal_mass: Mass,
        /// Number of such bearings in the machine; multiplies the loss in the objective. Default 1.
        count: u32,
        /// Position from the free end, 0 to the number of throws. For kind = "main".
        main_bearing: usize,
        /// Load of the journal on the shell over one cycle. For kind = "table": columns crank_angle_deg, force_x_n (or _kn), force_y_n.
        load: TableFile,
        /// Crank angle after which the load repeats. Default "720 deg". For kind = "table".
        cycle: Angle,
    }
}

section! {
    /// Lubricating oil: a data sheet (Walther's law) or a constant viscosity.
    OilFile {
        /// Kinematic viscosity at 40 degC.
        kinematic_viscosity_40c: KinematicViscosity,
        /// Kinematic viscosity at 100 degC.
        kinematic_viscosity_100c: KinematicViscosity,
        /// Density at 15 degC.
        density_15c: Density,
        /// Instead of the data sheet: the same dynamic viscosity at every temperature.
        dynamic_viscosity: DynamicViscosity,
        /// Temperature at the inlet of the bearings.
        inlet_temperature: Temperature,
        /// Temperature of the film less that of the inlet. Default "0 K".
        film_temperature_rise: TemperatureRise,
    }
}

/// Film model, in order of fidelity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FilmModelName {
    /// Booker's short-bearing film in closed form: instant, good for narrow bearings.
    Mobility,
    /// Reynolds' equation on a mesh.
    Reynolds,
}

/// What a film does that would pull.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CavitationName {
    /// It ruptures at the cavitation pressure.
    SwiftStieber,
    /// It holds any tension; for comparison with closed forms. Many loads have no stable orbit in such a film.
    None,
}

section! {
    /// Lubricating film.
    FilmFile {
        /// "reynolds" (default) or "mobility".
        model: FilmModelName,
        /// "swift-stieber" (default) or "none". For model = "reynolds", like all below.
        cavitation: CavitationName,
        /// Cells around the circumference, at least 16. Default 72.
        cells_around: usize,
        /// Cells across half of the width. Default 8.
        cells_across_half: usize,
        /// Pressure at both edges above the surroundings. Default "0 bar".
        side_pressure: Pressure,
        /// Cavitation pressure above the surroundings, at or below the side pressure. Default "0 bar".
        cavitation_pressure: Pressure,
    }
}

/// Difference formula of the time steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SchemeName {
    /// Implicit Euler, first order.
    Bdf1,
    /// Second order.
    Bdf2,
}

section! {
    /// Periodic orbit of the journal.
    OrbitFile {
        /// Steps per cycle, at least 36. Default 720.
        steps_per_cycle: usize,
        /// "bdf2" (default) or "bdf1".
        scheme: SchemeName,
        /// Difference of two cycles (relative to the clearance) that counts as settled. Default 1e-12.
        periodicity_tolerance: f64,
        /// Cycles after which settling is given up. Default 30.
        max_cycles: usize,
    }
}

section! {
    /// One operating point of the duty cycle.
    OperatingPointFile {
        /// Name in reports.
        name: String,
        /// Speed of the crankshaft.
        speed: Rotation,
        /// Share of this point in the objective. Default 1; shares are normalised to the sum 1.
        weight: f64,
        /// Factor on the cylinder pressure (or on the tabulated load). Default 1.
        load_factor: f64,
    }
}

section! {
    /// Objective: the weighted mean friction loss of all bearings over the operating points.
    ObjectiveFile {
        /// Operating points with their weights.
        operating_points: Vec<Given<OperatingPointFile>>,
    }
}

section! {
    /// One design parameter.
    ParameterFile {
        /// "<bearing>.width", "<bearing>.diameter", "<bearing>.diametral_clearance" or "oil.inlet_temperature".
        name: String,
        /// Smallest allowed value, with unit.
        lower: QuantityText,
        /// Largest allowed value, with unit.
        upper: QuantityText,
        /// Value the search starts from, with unit. Default: the value of that key in the study.
        start: QuantityText,
    }
}

section! {
    /// One limit; give either at_least or at_most.
    ConstraintFile {
        /// Limited quantity.
        quantity: QuantityName,
        /// Bearing it applies to. Default: every bearing.
        bearing: String,
        /// Smallest allowed value, with unit.
        at_least: QuantityText,
        /// Largest allowed value, with unit.
        at_most: QuantityText,
    }
}

section! {
    /// Gradient engine.
    GradientFile {
        /// "ADJ" (default), "TRA", "CEN", "FW" or "BW".
        engine: EngineName,
        /// Relative perturbation of the finite differences. Default 1e-6.
        perturbation: f64,
    }
}

/// Search method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MethodName {
    /// Sequential quadratic programming.
    Sqp,
}

section! {
    /// Optimiser.
    OptimiserFile {
        /// "sqp" (default).
        method: MethodName,
        /// Scaled KKT residual at which a design counts as optimal. Default 1e-6.
        tolerance: f64,
        /// Iterations at most. Default 60.
        max_iterations: u64,
        /// Longest change of a parameter in one iteration, as a share of its box. Default 0.4.
        step_limit: f64,
        /// Sharpness of the smooth extrema of film thickness and pressure: larger is closer to the exact extremum and harder to optimise. Default 200.
        aggregate_sharpness: f64,
    }
}

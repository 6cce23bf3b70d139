//! What defines a bearing: values, what of them can vary, what it reports.

use super::HeatBalance;
use crate::cranktrain::BearingLoad;
use crate::dae::InvalidParameters;
use crate::film::{Axial, FilmModel, Profile};
use crate::laws::Viscosity;
use std::sync::Arc;

/// What can be varied about a bearing; all values in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BearingParameter {
    /// Width, m.
    Width,
    /// Diameter, m.
    Diameter,
    /// Diametral clearance, m.
    DiametralClearance,
    /// Temperature of the oil at the inlet, K.
    InletTemperature,
    /// Temperature of the film, K: the cycle unknown of a heat balance.
    FilmTemperature,
    /// Root mean square roughness of the journal, m.
    JournalRoughness,
    /// Root mean square roughness of the shell, m.
    ShellRoughness,
    /// Pressure of the oil supply above the surroundings, Pa.
    SupplyPressure,
    /// Given tilt of the journal in the shell frame, rad; 0 along x, 1 along y.
    Tilt(usize),
    /// A coefficient of a shape: which shape, which coefficient.
    Shape(usize, usize),
    /// Factor on the load of combustion (or on a load given as a table).
    LoadFactor,
    /// Speed of the crankshaft, rad/s.
    Speed,
}

/// What a bearing reports at every instant, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BearingOutput {
    /// Friction loss: power of wall shear stress and contact friction, W.
    Loss,
    /// Its part from asperity contact, W.
    ContactLoss,
    /// Power dissipated in oil and contact, W.
    Dissipation,
    /// Smallest gap, m.
    GapMin,
    /// Smooth maximum of the film pressure, Pa.
    PressurePeak,
    /// Smooth maximum of the contact pressure, Pa.
    ContactPeak,
    /// Load over projected area, Pa.
    SpecificLoad,
    /// Net flow of oil out of both edges, m3/s.
    SideFlow,
    /// Hydrodynamic part of the friction loss, W.
    HydrodynamicLoss,
    /// Effective temperature of the film, K; constant over the cycle.
    FilmTemperature,
    /// Volume worn off per time, m3/s (Archard).
    WearRate,
    /// Contact pressure times sliding speed, W/m2, summed over the cells with [`BearingSetup::marks`] as weights.
    Rubbing,
}

impl BearingOutput {
    /// All outputs in their order.
    pub const ALL: [Self; 12] = [
        Self::Loss,
        Self::ContactLoss,
        Self::Dissipation,
        Self::GapMin,
        Self::PressurePeak,
        Self::ContactPeak,
        Self::SpecificLoad,
        Self::SideFlow,
        Self::HydrodynamicLoss,
        Self::FilmTemperature,
        Self::WearRate,
        Self::Rubbing,
    ];

    /// Position in the output vector.
    pub fn index(self) -> usize {
        Self::ALL.iter().position(|o| *o == self).expect("ALL holds every output")
    }
}

/// How the journal stands to the shell's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tilt {
    /// At a given inclination about both directions of the shell frame, rad.
    Given([f64; 2]),
    /// As the film's moment lets it.
    Free,
}

/// The shape of one surface.
#[derive(Debug, Clone)]
pub struct BearingShape {
    /// Name in reports.
    pub name: String,
    /// What it adds to the gap.
    pub profile: Profile,
    /// Whether it belongs to the journal and turns with it.
    pub on_journal: bool,
}

/// A number for every cell of the film on both surfaces: rows around, columns across, like the film's own cells. Empty for zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceField {
    /// Where the shell stands.
    pub shell: Vec<f64>,
    /// On a grid that turns with the journal and meets the shell's at angle zero; between its columns it is linear.
    pub journal: Vec<f64>,
}

/// How wear smooths a surface: of its roughness the share `r + (1 - r) exp(-w / l)` is left where the depth `w` was worn off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    /// What is left after long wear, `r`, 0 to 1.
    pub left: f64,
    /// Depth that takes the surface most of the way, `l`, m.
    pub depth_m: f64,
}

impl Smoothing {
    /// The share that is left at a depth, and its derivative by the depth, 1/m.
    pub fn at(&self, depth_m: f64) -> (f64, f64) {
        let gone = (1.0 - self.left) * (-depth_m / self.depth_m).exp();
        (self.left + gone, -gone / self.depth_m)
    }
}

/// Everything that defines a bearing apart from what is varied.
#[derive(Clone)]
pub struct BearingSetup {
    /// Film model.
    pub film: Arc<dyn FilmModel>,
    /// Load over the cycle.
    pub load: Arc<BearingLoad>,
    /// The load where nothing is fired; needed where the load factor is a parameter.
    pub idle: Option<Arc<BearingLoad>>,
    /// Factor on the difference between the two.
    pub load_factor: f64,
    /// Speed of the crankshaft, rad/s.
    pub speed_rad_s: f64,
    /// Viscosity of the oil over temperature.
    pub viscosity: Viscosity,
    /// Film temperature less inlet temperature, K: given, or where the heat balance starts.
    pub film_rise_k: f64,
    /// Makes the film temperature a result.
    pub heat: Option<HeatBalance>,
    /// Mass that moves with the journal, kg; 0 for a massless journal.
    pub journal_mass_kg: f64,
    /// Width, m.
    pub width_m: f64,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Diametral clearance, m.
    pub diametral_clearance_m: f64,
    /// Temperature of the oil at the inlet, K.
    pub inlet_temperature_k: f64,
    /// Root mean square roughness of the journal, m.
    pub journal_roughness_m: f64,
    /// Root mean square roughness of the shell, m.
    pub shell_roughness_m: f64,
    /// Volume worn off per work of contact friction, m3/J: Archard's `K / H` over the friction coefficient.
    pub wear_m3_per_j: f64,
    /// Pressure of the oil supply above the surroundings, Pa.
    pub supply_pressure_pa: f64,
    /// Inclination of the journal.
    pub tilt: Tilt,
    /// Shapes of journal and shell.
    pub shapes: Vec<BearingShape>,
    /// Material worn off, m: what wear adds to the gap.
    pub worn_m: Arc<SurfaceField>,
    /// Weights in [`BearingOutput::Rubbing`].
    pub marks: Arc<SurfaceField>,
    /// How wear smooths the shell; none if its roughness stays.
    pub smoothing: Option<Smoothing>,
    /// Which of the above are the parameters `p`, in order.
    pub parameters: Vec<BearingParameter>,
}

impl BearingSetup {
    /// A smooth, aligned, cylindrical bearing with a massless journal and a given film temperature.
    pub fn plain(film: Arc<dyn FilmModel>, load: Arc<BearingLoad>, viscosity: Viscosity) -> Self {
        Self {
            film,
            load,
            idle: None,
            load_factor: 1.0,
            speed_rad_s: 100.0,
            viscosity,
            film_rise_k: 0.0,
            heat: None,
            journal_mass_kg: 0.0,
            width_m: 0.05,
            diameter_m: 0.1,
            diametral_clearance_m: 100e-6,
            inlet_temperature_k: 350.0,
            journal_roughness_m: 0.0,
            shell_roughness_m: 0.0,
            wear_m3_per_j: 0.0,
            supply_pressure_pa: 0.0,
            tilt: Tilt::Given([0.0; 2]),
            shapes: Vec::new(),
            worn_m: Arc::default(),
            marks: Arc::default(),
            smoothing: None,
            parameters: Vec::new(),
        }
    }

    /// Film temperature at which the oil is taken.
    pub fn film_temperature_k(&self) -> f64 {
        self.inlet_temperature_k + self.film_rise_k
    }

    /// Value of a parameter.
    pub fn value(&self, parameter: BearingParameter) -> f64 {
        match parameter {
            BearingParameter::Width => self.width_m,
            BearingParameter::Diameter => self.diameter_m,
            BearingParameter::DiametralClearance => self.diametral_clearance_m,
            BearingParameter::InletTemperature => self.inlet_temperature_k,
            BearingParameter::FilmTemperature => self.film_temperature_k(),
            BearingParameter::JournalRoughness => self.journal_roughness_m,
            BearingParameter::ShellRoughness => self.shell_roughness_m,
            BearingParameter::SupplyPressure => self.supply_pressure_pa,
            BearingParameter::Tilt(axis) => match self.tilt {
                Tilt::Given(tilt) => tilt[axis],
                Tilt::Free => 0.0,
            },
            BearingParameter::Shape(shape, k) => self.shapes[shape].profile.coefficients()[k],
            BearingParameter::LoadFactor => self.load_factor,
            BearingParameter::Speed => self.speed_rad_s,
        }
    }

    /// The same setup with other values of its first parameters.
    pub(super) fn with(&self, p: &[f64]) -> Result<Self, InvalidParameters> {
        let mut setup = self.clone();
        let mut coefficients: Vec<Option<Vec<f64>>> = vec![None; setup.shapes.len()];
        let mut film_temperature_k = None;
        for (kind, &value) in self.parameters.iter().zip(p) {
            match *kind {
                BearingParameter::Width => setup.width_m = value,
                BearingParameter::Diameter => setup.diameter_m = value,
                BearingParameter::DiametralClearance => setup.diametral_clearance_m = value,
                BearingParameter::InletTemperature => setup.inlet_temperature_k = value,
                BearingParameter::FilmTemperature => film_temperature_k = Some(value),
                BearingParameter::JournalRoughness => setup.journal_roughness_m = value,
                BearingParameter::ShellRoughness => setup.shell_roughness_m = value,
                BearingParameter::SupplyPressure => setup.supply_pressure_pa = value,
                BearingParameter::Tilt(axis) => {
                    if let Tilt::Given(tilt) = &mut setup.tilt {
                        tilt[axis] = value;
                    }
                }
                BearingParameter::Shape(shape, k) => {
                    let profile = &self.shapes[shape].profile;
                    coefficients[shape].get_or_insert_with(|| profile.coefficients())[k] = value;
                }
                BearingParameter::LoadFactor => setup.load_factor = value,
                BearingParameter::Speed => setup.speed_rad_s = value,
            }
        }
        for (shape, new) in setup.shapes.iter_mut().zip(coefficients) {
            if let Some(new) = new {
                let named = |e| InvalidParameters(format!("shape \"{}\": {e}", shape.name));
                shape.profile = shape.profile.with_coefficients(&new).map_err(named)?;
            }
        }
        if let Some(t) = film_temperature_k {
            setup.film_rise_k = t - setup.inlet_temperature_k;
        }
        Ok(setup)
    }

    /// Whether the values can belong to a bearing.
    pub(super) fn check(&self) -> Result<(), InvalidParameters> {
        let positive = [
            ("width", self.width_m),
            ("diameter", self.diameter_m),
            ("diametral clearance", self.diametral_clearance_m),
            ("speed", self.speed_rad_s),
            ("inlet temperature", self.inlet_temperature_k),
            ("film temperature", self.film_temperature_k()),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(InvalidParameters(format!("{name} must be a positive number, found {value}")));
            }
        }
        let half = self.film.mesh().is_none_or(|m| m.axial == Axial::Half);
        let tilted = self.tilt != Tilt::Given([0.0; 2])
            || self.parameters.iter().any(|p| matches!(p, BearingParameter::Tilt(_)));
        if half && tilted {
            return Err(InvalidParameters("a tilting journal needs a film over the whole width".to_owned()));
        }
        let cells = self.film.mesh().map_or(0, crate::film::Mesh::cells);
        for field in [&self.worn_m.shell, &self.worn_m.journal, &self.marks.shell, &self.marks.journal] {
            if !field.is_empty() && field.len() != cells {
                let found = field.len();
                return Err(InvalidParameters(format!(
                    "a surface field has {found} values for {cells} cells"
                )));
            }
        }
        let rough = [("journal", self.journal_roughness_m), ("shell", self.shell_roughness_m)];
        for (name, value) in rough {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(InvalidParameters(format!(
                    "roughness of the {name} must not be negative, found {value}"
                )));
            }
        }
        Ok(())
    }
}

//! What can be a design parameter: properties of bearings, oil and running-in programme, with their names and units.

use super::plans::BearingPlan;
use crate::cranktrain::{BearingParameter, BearingShape, Tilt};
use crate::report::short;
use crate::units::{Angle, Duration, Length, Pressure, Rotation, Temperature, tidy};

/// Size of a degree.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// A property of a bearing or its oil that can be a design parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// What it is in the model of a bearing; none for the duration of a stage, which no bearing sees.
    pub parameter: Option<BearingParameter>,
    /// Unit in reports; "1" for numbers without one.
    pub unit: &'static str,
    /// Size of that unit, and its zero, in SI units.
    pub scale: (f64, f64),
}

impl Variable {
    fn new(parameter: impl Into<Option<BearingParameter>>, unit: &'static str) -> Self {
        let scale = match unit {
            "mm" => (1e-3, 0.0),
            "um" => (1e-6, 0.0),
            "bar" => (1e5, 0.0),
            "deg" => (DEGREE, 0.0),
            "degC" => (1.0, 273.15),
            "h" => (3600.0, 0.0),
            "rpm" => (std::f64::consts::PI / 30.0, 0.0),
            _ => (1.0, 0.0),
        };
        Self { parameter: parameter.into(), unit, scale }
    }

    /// Variables of the oil, written `oil.<key>`, shared by all bearings.
    pub(super) fn of_oil() -> Vec<(String, Self)> {
        vec![("inlet_temperature".to_owned(), Self::new(BearingParameter::InletTemperature, "degC"))]
    }

    /// Variables of a stage of a running-in programme, written `running_in.<stage>.<key>`.
    pub(super) fn of_stage() -> Vec<(String, Self)> {
        let new = |key: &str, parameter: Option<BearingParameter>, unit| {
            (key.to_owned(), Self::new(parameter, unit))
        };
        vec![
            new("duration", None, "h"),
            new("speed", Some(BearingParameter::Speed), "rpm"),
            new("load_factor", Some(BearingParameter::LoadFactor), "1"),
            new("oil_inlet_temperature", Some(BearingParameter::InletTemperature), "degC"),
        ]
    }

    /// Variables that every bearing has, written `<bearing>.<key>`.
    pub(super) fn of_any_bearing() -> Vec<(String, Self)> {
        let all = [
            ("width", BearingParameter::Width, "mm"),
            ("diameter", BearingParameter::Diameter, "mm"),
            ("diametral_clearance", BearingParameter::DiametralClearance, "um"),
        ];
        all.into_iter().map(|(key, parameter, unit)| (key.to_owned(), Self::new(parameter, unit))).collect()
    }

    /// All variables of a bearing; `tilts`: its film knows tilt.
    pub(super) fn of_bearing(plan: &BearingPlan, tilts: bool) -> Vec<(String, Self)> {
        let mut list = Self::of_any_bearing();
        let mut add = |key: &str, parameter, unit| list.push((key.to_owned(), Self::new(parameter, unit)));
        if tilts && plan.tilt != Tilt::Free {
            add("tilt_x", BearingParameter::Tilt(0), "deg");
            add("tilt_y", BearingParameter::Tilt(1), "deg");
        }
        if plan.roughness.is_some() {
            add("roughness.journal", BearingParameter::JournalRoughness, "um");
            add("roughness.shell", BearingParameter::ShellRoughness, "um");
        }
        if plan.supply.is_some() {
            add("supply.pressure", BearingParameter::SupplyPressure, "bar");
        }
        list.extend(plan.shapes.iter().enumerate().flat_map(|(index, shape)| of_shape(index, shape)));
        list
    }

    /// What is measured: values of one kind can be added.
    pub(super) fn kind(&self) -> &'static str {
        if self.unit == "um" { "mm" } else { self.unit }
    }

    /// A value in the unit of reports.
    pub fn shown(&self, si: f64) -> f64 {
        (si - self.scale.1) / self.scale.0
    }

    /// A value as a study writes it.
    pub(super) fn text(&self, si: f64) -> String {
        let value = tidy(self.shown(si));
        if self.unit == "1" { value.to_string() } else { format!("{value} {}", self.unit) }
    }

    /// A value as a message shows it, without its unit.
    pub(super) fn short(&self, si: f64) -> String {
        short(self.shown(si))
    }

    /// The unit behind a value in a message.
    pub(super) fn unit_words(&self) -> String {
        if self.unit == "1" { String::new() } else { format!(" {}", self.unit) }
    }

    /// Unit of the derivative of a quantity by this variable.
    pub(super) fn slope_unit(&self, quantity: &str) -> String {
        let quantity = quantity.replace("degC", "K");
        match self.unit {
            "1" => quantity,
            unit => format!("{quantity}/{}", unit.replace("degC", "K")),
        }
    }

    /// The value of a text, SI units.
    pub(super) fn si(&self, text: &str) -> Result<f64, String> {
        match self.unit {
            "degC" => text.parse::<Temperature>().map(|v| v.si()).map_err(|e| e.to_string()),
            "deg" => text.parse::<Angle>().map(|v| v.si()).map_err(|e| e.to_string()),
            "h" => text.parse::<Duration>().map(|v| v.si()).map_err(|e| e.to_string()),
            "rpm" => text.parse::<Rotation>().map(|v| v.si()).map_err(|e| e.to_string()),
            "bar" => text.parse::<Pressure>().map(|v| v.si()).map_err(|e| e.to_string()),
            "1" => {
                let number = text.trim().parse().ok().filter(|v: &f64| v.is_finite());
                number.ok_or_else(|| "expected a number in quotes like \"0.2\"".to_owned())
            }
            _ => text.parse::<Length>().map(|v| v.si()).map_err(|e| e.to_string()),
        }
    }
}

/// Coefficients of a shape by the keys of its section.
fn of_shape(index: usize, shape: &BearingShape) -> impl Iterator<Item = (String, Variable)> {
    shape.profile.coefficient_names().into_iter().enumerate().map(move |(k, name)| {
        let (key, unit) = match name.as_str() {
            "angle" => (name, "deg"),
            "length" => ("length_share".to_owned(), "1"),
            "scale" => (name, "1"),
            _ => (name, "um"),
        };
        (format!("shapes.{}.{key}", shape.name), Variable::new(BearingParameter::Shape(index, k), unit))
    })
}

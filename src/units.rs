//! Quantities as text with a unit, at the boundary; SI inside.
//!
//! A study writes `"75 um"`, the code works with `75e-6` metres. The set of units is closed and small on purpose: the error
//! message can list all of them. (General unit libraries parse more, but cannot say what would have been accepted.)

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;
use thiserror::Error;

/// A number without the noise of unit conversion: eleven digits.
pub fn tidy(value: f64) -> f64 {
    format!("{value:.10e}").parse().unwrap_or(value)
}

/// A text that begins with a number, cut behind it: `"75 um"` into `"75"` and `"um"`. Whether the first part is a number is left open.
pub fn split(text: &str) -> (&str, &str) {
    let text = text.trim();
    let is_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'e' | 'E');
    let mut end = text.find(|c| !is_number(c)).unwrap_or(text.len());
    // An exponent needs digits: the 'e' of no unit is eaten.
    while end > 0 && !text[..end].ends_with(|c: char| c.is_ascii_digit() || c == '.') {
        end -= 1;
    }
    (&text[..end], text[end..].trim())
}

/// A unit: name, size in SI units, and offset in SI units (temperatures).
pub type Unit = (&'static str, f64, f64);

/// Kind of a physical quantity.
pub trait Dimension: Clone + fmt::Debug + PartialEq + Default + 'static {
    /// Name for messages, with its article.
    const NAME: &'static str;
    /// A valid example.
    const EXAMPLE: &'static str;
    /// Accepted units.
    const UNITS: &'static [Unit];
}

/// Text that is no quantity of the wanted kind.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("expected {kind} like \"{example}\" (units: {units}){hint}")]
pub struct UnitError {
    kind: &'static str,
    example: &'static str,
    units: String,
    hint: String,
}

/// A quantity as it was written, with its value in SI units.
#[derive(Clone, PartialEq, Default)]
pub struct Measure<D> {
    si: f64,
    text: String,
    kind: PhantomData<D>,
}

impl<D: Dimension> Measure<D> {
    /// Value in SI units.
    pub fn si(&self) -> f64 {
        self.si
    }

    /// The text it was written as.
    pub fn text(&self) -> &str {
        &self.text
    }

    fn error(hint: impl Into<String>) -> UnitError {
        let units: Vec<&str> = D::UNITS.iter().map(|u| u.0).collect();
        UnitError { kind: D::NAME, example: D::EXAMPLE, units: units.join(", "), hint: hint.into() }
    }
}

impl<D: Dimension> FromStr for Measure<D> {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let trimmed = text.trim();
        let (number, unit) = split(trimmed);
        let value: f64 = number.parse().map_err(|_| Self::error(""))?;
        if unit.is_empty() {
            return Err(Self::error(format!("; \"{trimmed}\" has no unit")));
        }
        let unit = unit
            .replace(['µ', 'μ'], "u")
            .replace('°', "deg")
            .replace('²', "2")
            .replace('³', "3")
            .replace('·', " ");
        let (_, size, offset) = D::UNITS
            .iter()
            .find(|u| u.0 == unit)
            .ok_or_else(|| Self::error(format!("; \"{unit}\" is not one of them")))?;
        let si = value * size + offset;
        if !si.is_finite() {
            return Err(Self::error("; the number is too large"));
        }
        Ok(Self { si, text: trimmed.to_owned(), kind: PhantomData })
    }
}

impl<D: Dimension> fmt::Debug for Measure<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl<D: Dimension> serde::Serialize for Measure<D> {
    fn serialize<S: serde::Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&self.text)
    }
}

impl<'de, D: Dimension> serde::Deserialize<'de> for Measure<D> {
    fn deserialize<R: serde::Deserializer<'de>>(r: R) -> Result<Self, R::Error> {
        use serde::de::Error as _;
        match serde_json::Value::deserialize(r)? {
            serde_json::Value::String(text) => text.parse().map_err(R::Error::custom),
            serde_json::Value::Number(n) => {
                Err(R::Error::custom(Self::error(format!("; the bare number {n} has no unit"))))
            }
            _ => Err(R::Error::custom(Self::error(""))),
        }
    }
}

impl<D: Dimension> schemars::JsonSchema for Measure<D> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        let words = D::NAME.split(' ').skip(1);
        words.map(|w| w[..1].to_uppercase() + &w[1..]).collect::<String>().into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let units: Vec<&str> = D::UNITS.iter().map(|u| u.0).collect();
        let spelled = units.join("|").replace('(', "\\(").replace(')', "\\)");
        let spelled = spelled.replace('u', "[uµμ]").replace("deg", "(deg|°)").replace('/', "\\/");
        schemars::json_schema!({
            "type": "string",
            "description": format!("Text: {} with its unit ({})", D::NAME, units.join(", ")),
            "pattern": format!("^\\s*[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?\\s*({spelled})\\s*$"),
            "examples": [D::EXAMPLE],
        })
    }
}

macro_rules! dimensions {
    ($($(#[$doc:meta])* $tag:ident, $alias:ident, $name:literal, $example:literal, $units:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct $tag;
        impl Dimension for $tag {
            const NAME: &'static str = $name;
            const EXAMPLE: &'static str = $example;
            const UNITS: &'static [Unit] = $units;
        }
        $(#[$doc])*
        pub type $alias = Measure<$tag>;
    )*};
}

dimensions! {
    /// A length.
    LengthKind, Length, "a length", "75 um", &[("m", 1.0, 0.0), ("mm", 1e-3, 0.0), ("um", 1e-6, 0.0)];
    /// A mass.
    MassKind, Mass, "a mass", "9.5 kg", &[("kg", 1.0, 0.0), ("g", 1e-3, 0.0), ("t", 1e3, 0.0)];
    /// A pressure.
    PressureKind, Pressure, "a pressure", "3.5 bar",
        &[("Pa", 1.0, 0.0), ("kPa", 1e3, 0.0), ("MPa", 1e6, 0.0), ("GPa", 1e9, 0.0), ("bar", 1e5, 0.0)];
    /// A temperature.
    TemperatureKind, Temperature, "a temperature", "75 degC", &[("degC", 1.0, 273.15), ("K", 1.0, 0.0)];
    /// A temperature difference.
    TemperatureRiseKind, TemperatureRise, "a temperature difference", "15 K", &[("K", 1.0, 0.0)];
    /// An angle.
    AngleKind, Angle, "an angle", "90 deg",
        &[("deg", std::f64::consts::PI / 180.0, 0.0), ("rad", 1.0, 0.0), ("mrad", 1e-3, 0.0)];
    /// A rotational speed.
    RotationKind, Rotation, "a rotational speed", "1500 rpm",
        &[("rpm", std::f64::consts::PI / 30.0, 0.0), ("rad/s", 1.0, 0.0), ("Hz", 2.0 * std::f64::consts::PI, 0.0)];
    /// A kinematic viscosity.
    KinematicViscosityKind, KinematicViscosity, "a kinematic viscosity", "139 mm2/s",
        &[("mm2/s", 1e-6, 0.0), ("cSt", 1e-6, 0.0), ("m2/s", 1.0, 0.0)];
    /// A dynamic viscosity.
    DynamicViscosityKind, DynamicViscosity, "a dynamic viscosity", "10 mPa s",
        &[("mPa s", 1e-3, 0.0), ("Pa s", 1.0, 0.0)];
    /// A density.
    DensityKind, Density, "a density", "895 kg/m3", &[("kg/m3", 1.0, 0.0)];
    /// An amount of heat.
    HeatKind, Heat, "an amount of heat", "95 kJ", &[("J", 1.0, 0.0), ("kJ", 1e3, 0.0), ("MJ", 1e6, 0.0)];
    /// A force.
    ForceKind, Force, "a force", "8 kN", &[("N", 1.0, 0.0), ("kN", 1e3, 0.0), ("MN", 1e6, 0.0)];
    /// A volume flow.
    VolumeFlowKind, VolumeFlow, "a volume flow", "1.5 l/min",
        &[("l/min", 1e-3 / 60.0, 0.0), ("l/s", 1e-3, 0.0), ("m3/s", 1.0, 0.0)];
    /// A power.
    PowerKind, Power, "a power", "120 W", &[("W", 1.0, 0.0), ("kW", 1e3, 0.0)];
    /// A specific heat capacity.
    HeatCapacityKind, HeatCapacity, "a heat capacity", "2000 J/(kg K)",
        &[("J/(kg K)", 1.0, 0.0), ("kJ/(kg K)", 1e3, 0.0)];
    /// A heat flow per temperature difference.
    ConductanceKind, Conductance, "a heat conductance", "20 W/K", &[("W/K", 1.0, 0.0), ("kW/K", 1e3, 0.0)];
    /// A pressure-viscosity coefficient.
    PressureViscosityKind, PressureViscosity, "a pressure viscosity coefficient", "20 1/GPa",
        &[("1/GPa", 1e-9, 0.0), ("1/MPa", 1e-6, 0.0), ("1/Pa", 1.0, 0.0)];
    /// A shear rate.
    ShearRateKind, ShearRate, "a shear rate", "1e6 1/s", &[("1/s", 1.0, 0.0)];
    /// A volume worn off per time.
    WearRateKind, WearRate, "a wear rate", "5 mm3/h",
        &[("mm3/h", 1e-9 / 3600.0, 0.0), ("mm3/s", 1e-9, 0.0), ("m3/s", 1.0, 0.0)];
    /// A volume worn off per load and way: hardness in the denominator.
    WearCoefficientKind, WearCoefficient, "a wear coefficient", "1e-8 mm3/(N m)",
        &[("mm3/(N m)", 1e-9, 0.0), ("m3/(N m)", 1.0, 0.0), ("1/Pa", 1.0, 0.0)];
    /// A volume.
    VolumeKind, Volume, "a volume", "2 mm3", &[("mm3", 1e-9, 0.0), ("cm3", 1e-6, 0.0), ("m3", 1.0, 0.0)];
    /// An amount of memory.
    InformationKind, Information, "an amount of memory", "1 GB",
        &[("GB", 1e9, 0.0), ("MB", 1e6, 0.0), ("kB", 1e3, 0.0), ("B", 1.0, 0.0)];
    /// A time.
    TimeKind, Time, "a time", "2 us", &[("s", 1.0, 0.0), ("ms", 1e-3, 0.0), ("us", 1e-6, 0.0)];
    /// How long something takes.
    DurationKind, Duration, "a duration", "10 min", &[("s", 1.0, 0.0), ("min", 60.0, 0.0), ("h", 3600.0, 0.0)];
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn reads_quantities() {
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
        assert!(close("75 um".parse::<Length>().unwrap().si(), 75e-6));
        assert!(close(" 7.5e-5m ".parse::<Length>().unwrap().si(), 75e-6));
        assert!(close("75µm".parse::<Length>().unwrap().si(), 75e-6));
        assert!(close("95 °C".parse::<Temperature>().unwrap().si(), 368.15));
        assert!(close("1500 rpm".parse::<Rotation>().unwrap().si(), 157.079_632_679_489_66));
        assert!(close("10 mPa s".parse::<DynamicViscosity>().unwrap().si(), 0.01));
        assert!(close("20 1/GPa".parse::<PressureViscosity>().unwrap().si(), 2e-8));
        assert!(close("2 kJ/(kg K)".parse::<HeatCapacity>().unwrap().si(), 2000.0));
        assert!(close("0.5 mrad".parse::<Angle>().unwrap().si(), 5e-4));
    }

    #[test]
    fn refuses_what_is_no_quantity_and_says_what_would_be() {
        for text in ["75", "", "um", "75 kg", "75 u m", "1e999 m", "--3 m", "3 4 m", "NaN m", "1e m"] {
            let error = text.parse::<Length>().unwrap_err().to_string();
            assert!(error.contains("75 um") && error.contains("m, mm, um"), "{text}: {error}");
        }
    }

    proptest! {
        #[test]
        fn never_panics(text in "\\PC*") {
            let _ = text.parse::<Temperature>();
        }

        #[test]
        fn a_number_with_any_unit_keeps_its_value(value in -1e6f64..1e6, unit in 0usize..5) {
            let (name, size, _) = PressureKind::UNITS[unit];
            let measure: Pressure = format!("{value} {name}").parse().unwrap();
            prop_assert!((measure.si() - value * size).abs() <= 1e-9 * value.abs() * size);
        }
    }
}

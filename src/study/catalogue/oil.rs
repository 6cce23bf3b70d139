//! Laws of the oil: viscosity over temperature, pressure and shear rate, density over pressure.
//!
//! Deliberately not here: oils by name, which the grades know.

use super::entry::{Choice, Entry};

const TEMPERATURE: &str = "viscosity over temperature";
const PRESSURE: &str = "viscosity over pressure";
const SHEAR: &str = "viscosity over shear rate";
const DENSITY: &str = "density over pressure";
const PIEZOVISCOSITY: &str = "oil.piezoviscosity";
const COMPRESSIBILITY: &str = "oil.compressibility";
const SHEAR_THINNING: &str = "oil.shear_thinning";

/// Walther.
pub(in crate::study) static WALTHER: Entry = Entry {
    topic: TEMPERATURE,
    name: "Walther",
    equation: "lg lg (nu + 0.7) = a - b lg T, eta = nu rho_15 (1 - 7e-4 (T - 288.15 K)), nu in mm2/s, T in K",
    words: "Walther (1931), ASTM D341",
    sources: &["Walther 1931", "ASTM D341"],
    chosen: Choice::Key("oil.viscosity_law", "walther"),
    default: true,
    remark: "through the viscosities at 40 and 100 degC of a grade or a data sheet; nu above 2 mm2/s",
};

/// Vogel through two points.
pub(in crate::study) static VOGEL: Entry = Entry {
    topic: TEMPERATURE,
    name: "Vogel through two points",
    equation: "eta = A exp(B/(t + 95)), t in degC",
    words: "Vogel (1921)",
    sources: &["Vogel 1921"],
    chosen: Choice::Key("oil.viscosity_law", "vogel"),
    remark: "the pole is that usual for mineral engine oils; good between and near 40 and 100 degC",
    ..Entry::PLAIN
};

/// Vogel through three points.
pub(in crate::study) static VOGEL_OF_POINTS: Entry = Entry {
    topic: TEMPERATURE,
    name: "Vogel through three points",
    equation: "eta = A exp(B/(T + C))",
    words: "Vogel (1921) through three points",
    sources: &["Vogel 1921"],
    chosen: Choice::Given("oil.viscosity_points"),
    remark: "good between and near the points",
    ..Entry::PLAIN
};

/// One viscosity.
pub(in crate::study) static CONSTANT: Entry = Entry {
    topic: TEMPERATURE,
    name: "constant viscosity",
    equation: "eta = constant",
    words: "the same at every temperature",
    chosen: Choice::Given("oil.dynamic_viscosity"),
    ..Entry::PLAIN
};

/// No rise with pressure.
static NOT_PIEZOVISCOUS: Entry = Entry {
    topic: PRESSURE,
    name: "the same at every pressure",
    equation: "eta = eta_0",
    chosen: Choice::Key(PIEZOVISCOSITY, "none"),
    default: true,
    ..Entry::PLAIN
};

/// Barus.
pub(in crate::study) static BARUS: Entry = Entry {
    topic: PRESSURE,
    name: "Barus",
    equation: "eta = eta_0 exp(alpha p)",
    words: "viscosity over pressure after Barus (1893)",
    sources: &["Barus 1893"],
    chosen: Choice::Key(PIEZOVISCOSITY, "barus"),
    remark: "fair below about 0.1 GPa, too steep above",
    ..Entry::PLAIN
};

/// Roelands.
pub(in crate::study) static ROELANDS: Entry = Entry {
    topic: PRESSURE,
    name: "Roelands",
    equation: "eta = eta_0 exp{(ln eta_0 + 9.67) [(1 + p/p_0)^Z - 1]}, 1/p_0 = 5.1e-9 1/Pa, \
               Z = alpha p_0/(ln eta_0 + 9.67)",
    words: "viscosity over pressure after Roelands (1966)",
    sources: &["Roelands 1966"],
    chosen: Choice::Key(PIEZOVISCOSITY, "roelands"),
    remark: "eta_0 above 1e-4 Pa s, to about 1 GPa",
    ..Entry::PLAIN
};

/// No change of density.
static INCOMPRESSIBLE: Entry = Entry {
    topic: DENSITY,
    name: "incompressible",
    equation: "rho = rho_0",
    chosen: Choice::Key(COMPRESSIBILITY, "incompressible"),
    default: true,
    ..Entry::PLAIN
};

/// Dowson and Higginson.
pub(in crate::study) static DOWSON_HIGGINSON: Entry = Entry {
    topic: DENSITY,
    name: "Dowson and Higginson",
    equation: "rho/rho_0 = (5.9e8 + 1.34 p)/(5.9e8 + p), p in Pa",
    words: "density over pressure after Dowson and Higginson (1966)",
    sources: &["Dowson and Higginson 1966"],
    chosen: Choice::Key(COMPRESSIBILITY, "dowson-higginson"),
    remark: "mineral oils, -0.1 MPa to about 1 GPa",
    ..Entry::PLAIN
};

/// No fall with the shear rate.
static NEWTONIAN: Entry = Entry {
    topic: SHEAR,
    name: "Newtonian",
    equation: "eta = eta_0",
    chosen: Choice::Key(SHEAR_THINNING, "newtonian"),
    default: true,
    ..Entry::PLAIN
};

/// Cross.
pub(in crate::study) static CROSS: Entry = Entry {
    topic: SHEAR,
    name: "Cross",
    equation: "eta/eta_0 = r + (1 - r)/(1 + x^m), x = rate/critical rate",
    words: "viscosity over shear rate after Cross (1965)",
    sources: &["Cross 1965"],
    chosen: Choice::Key(SHEAR_THINNING, "cross"),
    remark: "multigrade oils; r: second over first Newtonian viscosity",
    ..Entry::PLAIN
};

/// Carreau.
pub(in crate::study) static CARREAU: Entry = Entry {
    topic: SHEAR,
    name: "Carreau",
    equation: "eta/eta_0 = r + (1 - r) [1 + (time rate)^2]^((n - 1)/2)",
    words: "viscosity over shear rate after Carreau (1972)",
    sources: &["Carreau 1972"],
    chosen: Choice::Key(SHEAR_THINNING, "carreau"),
    remark: "multigrade oils; r: second over first Newtonian viscosity",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[
    &WALTHER,
    &VOGEL,
    &VOGEL_OF_POINTS,
    &CONSTANT,
    &NOT_PIEZOVISCOUS,
    &BARUS,
    &ROELANDS,
    &NEWTONIAN,
    &CROSS,
    &CARREAU,
    &INCOMPRESSIBLE,
    &DOWSON_HIGGINSON,
];

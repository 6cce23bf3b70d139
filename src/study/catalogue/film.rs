//! Laws of the film: equation, rupture, supply, tilt, heat.
//!
//! Deliberately not here: shapes of the surfaces, what the oil is, rough surfaces.

use super::entry::{Choice, Entry};

const FILM: &str = "film";
const RUPTURE: &str = "rupture";
const CAVITATION: &str = "film.cavitation";

/// Reynolds' equation.
pub(in crate::study) static REYNOLDS: Entry = Entry {
    topic: FILM,
    name: "Reynolds' equation by finite volumes",
    equation: "div(U/2 fill rho h - rho h^3/(12 eta) grad p) + d(fill rho h)/dt = 0",
    words: "Reynolds (1886) equation by finite volumes",
    sources: &["Reynolds 1886"],
    chosen: Choice::Key("film.model", "reynolds"),
    default: true,
    remark: "laminar, no inertia of the oil; second order in smooth gaps, steps of the gap on faces of cells \
             are met exactly, void is carried from upstream with first order",
};

/// Booker's short-bearing film.
pub(in crate::study) static SHORT_BEARING: Entry = Entry {
    topic: FILM,
    name: "short bearing in closed form",
    equation: "p = 6 eta (V.n)/h^3 (L^2/4 - z^2) where V.n > 0, else 0",
    words: "short bearing, Ocvirk (1952), Booker's mobility method (1965)",
    sources: &["Ocvirk 1952", "Booker 1965"],
    chosen: Choice::Key("film.model", "mobility"),
    remark: "widths up to about half the diameter at moderate eccentricity; smooth, aligned, cylindrical, \
             full of oil, no more than a viscosity",
    ..Entry::PLAIN
};

/// The gap.
static GAP: Entry = Entry {
    topic: FILM,
    name: "gap between rigid surfaces",
    equation: "h = C - (e + z tilt).n + shape",
    remark: "of rough surfaces the distance of the mean planes; no elastic deformation",
    ..Entry::PLAIN
};

/// Jakobsson, Floberg and Olsson.
pub(in crate::study) static MASS_CONSERVING: Entry = Entry {
    topic: RUPTURE,
    name: "mass-conserving rupture and reformation",
    equation: "p - p_cav >= 0, 1 - fill >= 0, (p - p_cav) (1 - fill) = 0",
    words: "mass-conserving rupture and reformation after Jakobsson and Floberg (1957) and Olsson (1965), as \
            a complementarity problem after Giacopini et al. (2010)",
    sources: &["Jakobsson and Floberg 1957", "Olsson 1965", "Giacopini et al. 2010"],
    chosen: Choice::Key(CAVITATION, "mass-conserving"),
    default: true,
    remark: "for a bearing as it is fed: starvation, oil flow, temperature; needs oil: a supply, or a side \
             pressure above the cavitation pressure",
};

/// Swift and Stieber.
pub(in crate::study) static SWIFT_STIEBER: Entry = Entry {
    topic: RUPTURE,
    name: "Swift-Stieber rupture",
    equation: "p >= p_cav, dp/dn = 0 where the film ruptures",
    words: "rupture after Swift (1932) and Stieber (1933)",
    sources: &["Swift 1932", "Stieber 1933", "Brugnano and Casulli 2008"],
    chosen: Choice::Key(CAVITATION, "swift-stieber"),
    remark: "if the supply is not known, or to meet classical tables; the cavity refills from nowhere, its \
             fill is not known",
    ..Entry::PLAIN
};

/// Half-Sommerfeld film.
pub(in crate::study) static GUEMBEL: Entry = Entry {
    topic: RUPTURE,
    name: "Guembel's half film",
    equation: "force = Int max(p - p_cav, 0) n dA",
    words: "tension left out after Guembel (1914)",
    sources: &["Guembel 1914"],
    chosen: Choice::Key(CAVITATION, "guembel"),
    remark: "for comparison: no oil is conserved at the edge of the cavity",
    ..Entry::PLAIN
};

/// Full Sommerfeld film.
pub(in crate::study) static NO_RUPTURE: Entry = Entry {
    topic: RUPTURE,
    name: "no rupture",
    equation: "p may fall to any tension",
    words: "no rupture (Sommerfeld 1904)",
    sources: &["Sommerfeld 1904"],
    chosen: Choice::Key(CAVITATION, "none"),
    remark: "for comparison with closed forms; many loads have no stable orbit in such a film",
    ..Entry::PLAIN
};

/// Shear of the oil that is there.
pub(in crate::study) static SHEAR_OF_FILL: Entry = Entry {
    topic: RUPTURE,
    name: "shear of the oil in the cavity",
    equation: "tau = fill eta U/h",
    words: "in the ruptured part as much oil is sheared as there is",
    chosen: Choice::Key("film.cavity_shear", "fill"),
    default: true,
    remark: "default of a mass-conserving film, the only one that knows the fill",
    ..Entry::PLAIN
};

/// Shear of the whole gap.
pub(in crate::study) static SHEAR_ALL_AROUND: Entry = Entry {
    topic: RUPTURE,
    name: "shear of the whole gap",
    equation: "tau = eta U/h in the cavity too",
    words: "shear all around, in the ruptured part too",
    chosen: Choice::Key("film.cavity_shear", "full"),
    remark: "default of every film that is not mass-conserving; on the safe side",
    ..Entry::PLAIN
};

/// Openings.
pub(in crate::study) static SUPPLY: Entry = Entry {
    topic: "supply",
    name: "openings as smooth masks",
    equation: "(1 - m) balance + m g (p - p_supply) = 0, m: share of a cell that openings cover",
    words: "openings at the supply pressure as smooth masks on the mesh",
    chosen: Choice::Given("[bearings.NAME.supply]"),
    remark: "no pressure is lost on the way; the area of an opening is kept, wherever it stands on the mesh",
    ..Entry::PLAIN
};

/// Free tilt.
pub(in crate::study) static FREE_TILT: Entry = Entry {
    topic: "tilt",
    name: "free tilt",
    equation: "0 = M(q, e, tilt)",
    words: "the journal tilts until the film's moment vanishes",
    chosen: Choice::Given("bearings.NAME.free_tilt = true"),
    remark: "moments of film and contact about the middle of the bearing; no stiffness of the shaft",
    ..Entry::PLAIN
};

/// Temperature from a balance.
pub(in crate::study) static HEAT_BALANCE: Entry = Entry {
    topic: "heat",
    name: "heat balance over the cycle",
    equation: "mean loss = rho c_p side flow (T_out - T_in) + UA (T_film - T_amb), T_film = T_in + share \
               (T_out - T_in)",
    words: "one film temperature per bearing from the balance over the cycle, by Broyden's method (1965)",
    sources: &["Broyden 1965"],
    chosen: Choice::Given("[bearings.NAME.heat_balance]"),
    remark: "one temperature for the whole film, constant over the cycle; share = 1 is on the safe side",
    ..Entry::PLAIN
};

/// Temperature as given.
static GIVEN_TEMPERATURE: Entry = Entry {
    topic: "heat",
    name: "given film temperature",
    equation: "T_film = T_in + rise",
    chosen: Choice::Given("oil.film_temperature_rise"),
    default: true,
    remark: "the loss is that of an assumed temperature",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[
    &REYNOLDS,
    &SHORT_BEARING,
    &GAP,
    &MASS_CONSERVING,
    &SWIFT_STIEBER,
    &GUEMBEL,
    &NO_RUPTURE,
    &SHEAR_OF_FILL,
    &SHEAR_ALL_AROUND,
    &SUPPLY,
    &FREE_TILT,
    &HEAT_BALANCE,
    &GIVEN_TEMPERATURE,
];

//! Laws and methods a study uses, with their sources: sentences of its report, and their references.
//!
//! What is said of each stands in the catalogue. Deliberately not here: laws that no study asked for.

use super::BearingPlan;
use super::catalogue::entry::Entry;
use super::catalogue::{experiments, film, machine, numerics, oil, search, shapes, sources, surfaces, wear};
use super::characteristic::Vary;
use super::check::Study;
use super::file::{CavitationName, CavityShearName, FilmModelName, PlanName, PressureSource};
use super::plans::LoadPlan;
use crate::cranktrain::Tilt;
use crate::film::Profile;
use crate::gradient::EngineName;
use crate::laws::{
    Compressibility, ContactIntegral, GreenwoodTripp, Piezoviscosity, ShearThinning, Viscosity,
};
use crate::optimise::Method;
use crate::orbit::Scheme;

/// A sentence of the report: what it is about, and what it says of entries of the catalogue.
struct Sentence {
    head: &'static str,
    parts: Vec<&'static Entry>,
    /// Said instead of the words of the entries, where they are only its beginning.
    said: Option<String>,
}

impl Sentence {
    fn new(head: &'static str, parts: impl IntoIterator<Item = &'static Entry>) -> Self {
        Self { head, parts: parts.into_iter().collect(), said: None }
    }

    fn text(&self) -> String {
        let words: Vec<&str> = self.parts.iter().map(|e| e.words).collect();
        let said = self.said.clone().unwrap_or_else(|| words.join("; "));
        format!("{}: {said}", self.head)
    }
}

/// Laws and methods in use, one line each.
pub(super) fn methods(study: &Study) -> Vec<String> {
    sentences(study).iter().map(Sentence::text).collect()
}

/// Full references of what is in use, each once, in the order of the sentences.
pub(super) fn references(study: &Study) -> Vec<String> {
    let mut found: Vec<&str> = Vec::new();
    for text in in_use(study).iter().flat_map(|e| e.sources).filter_map(|key| sources::full(key)) {
        if !found.contains(&text) {
            found.push(text);
        }
    }
    found.into_iter().map(str::to_owned).collect()
}

/// Entries of the catalogue in use: those of the sentences, then those the report has no sentence for.
pub(super) fn in_use(study: &Study) -> Vec<&'static Entry> {
    let told = sentences(study);
    told.iter().flat_map(|s| s.parts.iter().copied()).chain(untold(study)).collect()
}

fn sentences(study: &Study) -> Vec<Sentence> {
    let mut list = vec![film_sentence(study), viscosity(study)];
    list.extend(rheology(study).into_iter().map(|entry| Sentence::new("Oil", [entry])));
    list.extend(bearings(study).into_iter().map(|(head, entry)| Sentence::new(head, [entry])));
    let driven = |b: &BearingPlan| matches!(b.load, LoadPlan::BigEnd | LoadPlan::Main(_));
    let (searched, judged) = (study.searches(), !study.points.is_empty());
    let at_rest = matches!(&study.characteristic, Some(c) if matches!(c.vary, Vary::Eccentricity { .. }));
    let optimiser = match study.optimiser.options.method {
        Method::Sqp => &search::SQP,
        Method::AugmentedLagrangian => &search::AUGMENTED_LAGRANGIAN,
        Method::Cobyla => &search::COBYLA,
    };
    list.extend(used([
        (study.bearings.iter().any(driven), Sentence::new("Load", [&machine::SLIDER_CRANK])),
        (!at_rest, Sentence::new("Orbit", [scheme(study.orbit.scheme)])),
        (searched || study.comparison.is_some(), Sentence::new("Gradient", [engine(study.engine)])),
        (searched, Sentence::new("Optimiser", [optimiser])),
        (judged, Sentence::new("Smooth extrema", [&numerics::EXTREMA])),
    ]));
    if let Some(r) = &study.running_in {
        let how = if r.predicted { &wear::POD } else { &wear::HEUN };
        list.push(Sentence::new("Running-in", [&wear::ARCHARD, how]));
    }
    list
}

fn film_sentence(study: &Study) -> Sentence {
    if study.film.model == FilmModelName::Mobility {
        return Sentence::new("Film", [&film::SHORT_BEARING]);
    }
    let rupture = match study.film.cavitation {
        CavitationName::MassConserving => &film::MASS_CONSERVING,
        CavitationName::SwiftStieber => &film::SWIFT_STIEBER,
        CavitationName::Guembel => &film::GUEMBEL,
        CavitationName::None => &film::NO_RUPTURE,
    };
    let shear = match study.film.cavity_shear {
        CavityShearName::Fill => &film::SHEAR_OF_FILL,
        CavityShearName::Full => &film::SHEAR_ALL_AROUND,
    };
    Sentence::new("Film", [&film::REYNOLDS, rupture, shear])
}

fn viscosity(study: &Study) -> Sentence {
    let of_points = study.file.oil.value().is_some_and(|o| !o.viscosity_points.is_absent());
    let law = match study.oil.viscosity {
        Viscosity::Constant { .. } => &oil::CONSTANT,
        Viscosity::Walther { .. } => &oil::WALTHER,
        Viscosity::Vogel { .. } if of_points => &oil::VOGEL_OF_POINTS,
        Viscosity::Vogel { .. } => &oil::VOGEL,
    };
    let said = Some(format!("viscosity {}", study.oil.source));
    Sentence { head: "Oil", parts: vec![law], said }
}

fn rheology(study: &Study) -> Vec<&'static Entry> {
    let laws = &study.oil.laws;
    let piezoviscosity = match laws.piezoviscosity {
        Piezoviscosity::None => None,
        Piezoviscosity::Barus { .. } => Some(&oil::BARUS),
        Piezoviscosity::Roelands { .. } => Some(&oil::ROELANDS),
    };
    let compressibility = match laws.compressibility {
        Compressibility::Incompressible => None,
        Compressibility::DowsonHigginson => Some(&oil::DOWSON_HIGGINSON),
    };
    let shear_thinning = match laws.shear_thinning {
        ShearThinning::Newtonian => None,
        ShearThinning::Cross { .. } => Some(&oil::CROSS),
        ShearThinning::Carreau { .. } => Some(&oil::CARREAU),
    };
    [piezoviscosity, compressibility, shear_thinning].into_iter().flatten().collect()
}

/// Those of a list that are used.
fn used<T>(list: impl IntoIterator<Item = (bool, T)>) -> Vec<T> {
    list.into_iter().filter(|(used, _)| *used).map(|(_, what)| what).collect()
}

fn any_shape(study: &Study, found: fn(&Profile) -> bool) -> bool {
    study.bearings.iter().any(|b| b.shapes.iter().any(|s| found(&s.profile)))
}

fn contacts(study: &Study) -> impl Iterator<Item = &GreenwoodTripp> {
    study.bearings.iter().filter_map(|b| b.roughness.as_ref()?.film.contact.as_ref())
}

fn bearings(study: &Study) -> Vec<(&'static str, &'static Entry)> {
    let any = |found: fn(&BearingPlan) -> bool| study.bearings.iter().any(found);
    let fits = |fit: ContactIntegral| contacts(study).any(|c| c.integral == fit);
    let (supplied, rough) = (any(|b| b.supply.is_some()), any(|b| b.roughness.is_some()));
    let touching = contacts(study).next().is_some();
    let (heated, tilts) = (any(|b| b.heat.is_some()), any(|b| b.tilt == Tilt::Free));
    let spline = any_shape(study, |p| matches!(p, Profile::Spline(_)));
    let measured = any_shape(study, |p| matches!(p, Profile::Table(_)));
    used([
        (supplied, ("Supply", &film::SUPPLY)),
        (rough, ("Roughness", &surfaces::PATIR_CHENG)),
        (touching, ("Contact", &surfaces::GREENWOOD_TRIPP)),
        (fits(ContactIntegral::PowerFit), ("Contact", &surfaces::POWER_FIT)),
        (fits(ContactIntegral::PolynomialFit), ("Contact", &surfaces::POLYNOMIAL_FIT)),
        (fits(ContactIntegral::ExponentialFit), ("Contact", &surfaces::EXPONENTIAL_FIT)),
        (heated, ("Heat", &film::HEAT_BALANCE)),
        (tilts, ("Tilt", &film::FREE_TILT)),
        (spline, ("Shape", &shapes::SPLINE)),
        (measured, ("Shape", &shapes::MEASURED)),
    ])
}

fn scheme(scheme: Scheme) -> &'static Entry {
    match scheme {
        Scheme::Bdf1 => &numerics::BDF1,
        Scheme::Bdf2 => &numerics::BDF2,
    }
}

fn engine(name: EngineName) -> &'static Entry {
    match name {
        EngineName::Fw => &numerics::FW,
        EngineName::Bw => &numerics::BW,
        EngineName::Cen => &numerics::CEN,
        EngineName::Tra => &numerics::TRA,
        EngineName::Adj => &numerics::ADJ,
    }
}

/// What is in use without a sentence in the report.
fn untold(study: &Study) -> Vec<&'static Entry> {
    let exact = contacts(study).any(|c| c.integral == ContactIntegral::Exact);
    let source = study.file.cylinder_pressure.value().and_then(|c| c.source.value());
    let crankshaft = study.bearings.iter().any(|b| matches!(b.load, LoadPlan::Main(_)));
    let smooths = study.running_in.as_ref().is_some_and(|r| r.smoothing(1e-6).is_some());
    let approximated = study.running_in.as_ref().is_some_and(|r| r.approximate_first);
    let shape = |found: fn(&Profile) -> bool| any_shape(study, found);
    let search = if study.searches() { searching(study) } else { Vec::new() };
    let plan = study.experiments.as_ref().map(|e| match e.plan {
        PlanName::Grid => &experiments::GRID,
        PlanName::LatinHypercube => &experiments::LATIN_HYPERCUBE,
        PlanName::Sobol => &experiments::SOBOL,
    });
    let mut list = used([
        (shape(|p| matches!(p, Profile::LemonBore { .. })), &shapes::LEMON),
        (shape(|p| matches!(p, Profile::OffsetBore { .. })), &shapes::OFFSET),
        (shape(|p| matches!(p, Profile::Barrel { .. })), &shapes::BARREL),
        (shape(|p| matches!(p, Profile::Cone { .. })), &shapes::CONE),
        (shape(|p| matches!(p, Profile::EdgeRelief { .. })), &shapes::EDGE_RELIEF),
        (exact, &surfaces::EXACT_INTEGRAL),
        (crankshaft, &machine::MAIN_BEARINGS),
        (source == Some(&PressureSource::Table), &machine::INDICATOR),
        (source == Some(&PressureSource::Wiebe), &machine::WIEBE),
        (true, &numerics::PERIOD_MAP),
        (smooths, &wear::SMOOTHING),
        (approximated, &wear::P_ALPHA),
    ]);
    list.extend(search);
    list.extend(plan);
    list
}

/// How the design is searched, beyond the sentence about it.
fn searching(study: &Study) -> Vec<&'static Entry> {
    let method = study.optimiser.options.method;
    used([
        (!study.worst_case, &search::WEIGHTED_MEAN),
        (study.worst_case, &search::WORST_CASE),
        (method == Method::Sqp, &search::KINKS),
        (study.optimiser.starts > 1, &search::STARTS),
        (study.optimiser.polish, &search::POLISH),
        (study.robust.is_some(), &search::MARGINS),
    ])
}

#[cfg(test)]
mod tests;

//! Laws and methods a study uses, with their sources.

use super::check::Study;
use super::file::{CavitationName, CavityShearName, FilmModelName};
use crate::film::Profile;
use crate::laws::{Compressibility, ContactIntegral, GreenwoodTripp, Piezoviscosity, ShearThinning};

/// Laws and methods in use, one line each.
pub(super) fn methods(study: &Study) -> Vec<String> {
    let mut list = film(study);
    list.push(format!("Oil: viscosity {}", study.oil.source));
    list.extend(oil(study).into_iter().map(str::to_owned));
    list.extend(bearings(study));
    let always = [
        "Load: rigid slider-crank at constant speed, two-mass connecting rod",
        "Orbit: backward differences (Gear 1971) with constant steps, closed periodically",
        "Gradient: discrete adjoint of the periodic orbit or its alternatives FW, BW, CEN, TRA",
        "Optimiser: sequential quadratic programming (Nocedal and Wright 2006), damped BFGS (Powell 1978), sub-problem by \
         Clarabel, framework argmin",
        "Smooth extrema: power norm, on the safe side of the exact extremum",
    ];
    list.extend(always.map(str::to_owned));
    if let Some(r) = &study.running_in {
        let how = if r.predicted {
            "cycles predicted by proper orthogonal decomposition (method of snapshots, Sirovich 1987) and checked"
        } else {
            "blocks by Heun's method"
        };
        list.push(format!("Running-in: wear after Archard (1953), a settled cycle stands for many; {how}"));
    }
    list
}

fn film(study: &Study) -> Vec<String> {
    if study.film.model == FilmModelName::Mobility {
        return vec!["Film: short bearing, Ocvirk (1952), Booker's mobility method (1965)".to_owned()];
    }
    let rupture = match study.film.cavitation {
        CavitationName::MassConserving => {
            "mass-conserving rupture and reformation after Jakobsson and Floberg (1957) and Olsson (1965), as a \
             complementarity problem after Giacopini et al. (2010)"
        }
        CavitationName::SwiftStieber => "rupture after Swift (1932) and Stieber (1933)",
        CavitationName::Guembel => "tension left out after Guembel (1914)",
        CavitationName::None => "no rupture (Sommerfeld 1904)",
    };
    let shear = match study.film.cavity_shear {
        CavityShearName::Fill => "in the ruptured part as much oil is sheared as there is",
        CavityShearName::Full => "shear all around, in the ruptured part too",
    };
    vec![format!("Film: Reynolds (1886) equation by finite volumes; {rupture}; {shear}")]
}

fn oil(study: &Study) -> Vec<&'static str> {
    let laws = &study.oil.laws;
    let piezoviscosity = match laws.piezoviscosity {
        Piezoviscosity::None => None,
        Piezoviscosity::Barus { .. } => Some("Oil: viscosity over pressure after Barus (1893)"),
        Piezoviscosity::Roelands { .. } => Some("Oil: viscosity over pressure after Roelands (1966)"),
    };
    let compressibility = match laws.compressibility {
        Compressibility::Incompressible => None,
        Compressibility::DowsonHigginson => {
            Some("Oil: density over pressure after Dowson and Higginson (1966)")
        }
    };
    let shear_thinning = match laws.shear_thinning {
        ShearThinning::Newtonian => None,
        ShearThinning::Cross { .. } => Some("Oil: viscosity over shear rate after Cross (1965)"),
        ShearThinning::Carreau { .. } => Some("Oil: viscosity over shear rate after Carreau (1972)"),
    };
    [piezoviscosity, compressibility, shear_thinning].into_iter().flatten().collect()
}

fn bearings(study: &Study) -> Vec<String> {
    let any = |found: &dyn Fn(&super::BearingPlan) -> bool| study.bearings.iter().any(found);
    let mut list = Vec::new();
    let mut note = |used: bool, words: &str| {
        if used {
            list.push(words.to_owned());
        }
    };
    note(any(&|b| b.supply.is_some()), "Supply: openings at the supply pressure as smooth masks on the mesh");
    note(
        any(&|b| b.roughness.is_some()),
        "Roughness: flow and shear factors of Patir and Cheng (1978, 1979), average gap after Wu and Zheng (1989)",
    );
    let contacts = || study.bearings.iter().filter_map(|b| b.roughness.as_ref()?.film.contact.as_ref());
    let fits = |fit: ContactIntegral| contacts().any(|c: &GreenwoodTripp| c.integral == fit);
    note(
        contacts().next().is_some(),
        "Contact: Greenwood and Tripp (1971), elastic summits; constant boundary friction coefficient",
    );
    note(
        fits(ContactIntegral::PowerFit),
        "Contact: integral by the power fit of Hu, Cheng, Arai, Kobayashi and Aoyama (1994)",
    );
    note(fits(ContactIntegral::PolynomialFit), "Contact: integral by a polynomial fit");
    note(fits(ContactIntegral::ExponentialFit), "Contact: integral by an exponential fit");
    note(
        any(&|b| b.heat.is_some()),
        "Heat: one film temperature per bearing from the balance over the cycle, by Broyden's method (1965)",
    );
    note(
        any(&|b| b.tilt == crate::cranktrain::Tilt::Free),
        "Tilt: the journal tilts until the film's moment vanishes",
    );
    let shape = |found: fn(&Profile) -> bool| any(&|b| b.shapes.iter().any(|s| found(&s.profile)));
    note(
        shape(|p| matches!(p, Profile::Spline(_))),
        "Shape: tensor product of cubic B-splines (de Boor 1972, Cox 1972; Piegl and Tiller 1997)",
    );
    note(
        shape(|p| matches!(p, Profile::Table(_))),
        "Shape: measured surface, cubic Hermite polynomials between the points",
    );
    list
}

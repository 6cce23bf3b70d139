//! Checks of what pressure and shear do to the oil.

use super::faults::{Faults, refuse_others};
use super::file::{CompressibilityName, OilFile, PiezoviscosityName, ShearThinningName};
use super::oil::coefficient_range;
use super::viscosity::Sheet;
use crate::film::Oil;
use crate::laws::{Compressibility, Piezoviscosity, ShearThinning};

/// What pressure and shear do to the oil.
pub(super) fn laws(
    oil: &mut OilFile,
    grade: Option<&Sheet>,
    mobility: bool,
    faults: &mut Faults,
) -> Option<Oil> {
    if mobility {
        let why = "film.model \"mobility\" knows only a viscosity";
        refuse_others!(
            faults,
            oil,
            "oil",
            why,
            [],
            [
                piezoviscosity,
                pressure_viscosity_coefficient,
                compressibility,
                shear_thinning,
                second_newtonian_ratio,
                critical_shear_rate,
                relaxation_time,
                shear_exponent,
            ]
        );
        return Some(Oil::plain());
    }
    let piezoviscosity = piezoviscosity(oil, grade, faults);
    let name =
        faults.or(&mut oil.compressibility, "oil.compressibility", CompressibilityName::Incompressible);
    let compressibility = match name {
        CompressibilityName::Incompressible => Compressibility::Incompressible,
        CompressibilityName::DowsonHigginson => Compressibility::DowsonHigginson,
    };
    let shear_thinning = shear_thinning(oil, faults);
    Some(Oil { piezoviscosity: piezoviscosity?, compressibility, shear_thinning: shear_thinning? })
}

fn piezoviscosity(oil: &mut OilFile, grade: Option<&Sheet>, faults: &mut Faults) -> Option<Piezoviscosity> {
    let name = faults.or(&mut oil.piezoviscosity, "oil.piezoviscosity", PiezoviscosityName::None);
    let path = "oil.pressure_viscosity_coefficient";
    let given = &mut oil.pressure_viscosity_coefficient;
    if name == PiezoviscosityName::None {
        faults.unused(given, path, "oil.piezoviscosity is \"none\"");
        return Some(Piezoviscosity::None);
    }
    let coefficient = match grade.and_then(|g| g.pressure_viscosity.clone()) {
        Some(default) => Some(faults.or(given, path, default)),
        None => faults.need(given, path),
    };
    let coefficient_per_pa = coefficient?.si();
    coefficient_range(Some(coefficient_per_pa), path, faults);
    Some(match name {
        PiezoviscosityName::Roelands => Piezoviscosity::Roelands { coefficient_per_pa },
        _ => Piezoviscosity::Barus { coefficient_per_pa },
    })
}

fn shear_thinning(oil: &mut OilFile, faults: &mut Faults) -> Option<ShearThinning> {
    let name = faults.or(&mut oil.shear_thinning, "oil.shear_thinning", ShearThinningName::Newtonian);
    let (words, used): (&str, &[&str]) = match name {
        ShearThinningName::Newtonian => ("newtonian", &[]),
        ShearThinningName::Cross => {
            ("cross", &["second_newtonian_ratio", "critical_shear_rate", "shear_exponent"])
        }
        ShearThinningName::Carreau => {
            ("carreau", &["second_newtonian_ratio", "relaxation_time", "shear_exponent"])
        }
    };
    let why = format!("oil.shear_thinning is \"{words}\"");
    refuse_others!(
        faults,
        oil,
        "oil",
        &why,
        used,
        [second_newtonian_ratio, critical_shear_rate, relaxation_time, shear_exponent,]
    );
    if name == ShearThinningName::Newtonian {
        return Some(ShearThinning::Newtonian);
    }
    let ratio = faults.need(&oil.second_newtonian_ratio, "oil.second_newtonian_ratio");
    faults.range(ratio, "oil.second_newtonian_ratio", |v| (0.0..=1.0).contains(&v), "between 0 and 1");
    let exponent = faults.need(&oil.shear_exponent, "oil.shear_exponent");
    if name == ShearThinningName::Cross {
        faults.range(exponent, "oil.shear_exponent", |v| v > 0.0 && v <= 10.0, "above 0 and at most 10");
        let rate = faults.need(&oil.critical_shear_rate, "oil.critical_shear_rate").map(|v| v.si());
        faults.range(rate, "oil.critical_shear_rate", |v| v > 0.0, "above zero");
        let (second_newtonian_ratio, critical_rate_per_s, exponent) = (ratio?, rate?, exponent?);
        return Some(ShearThinning::Cross { second_newtonian_ratio, critical_rate_per_s, exponent });
    }
    faults.range(exponent, "oil.shear_exponent", |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
    let time = faults.need(&oil.relaxation_time, "oil.relaxation_time").map(|v| v.si());
    faults.range(time, "oil.relaxation_time", |v| v > 0.0, "above zero");
    let (second_newtonian_ratio, time_s, exponent) = (ratio?, time?, exponent?);
    Some(ShearThinning::Carreau { second_newtonian_ratio, time_s, exponent })
}

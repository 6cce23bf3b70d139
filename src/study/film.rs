//! Checks of the film.

use super::faults::{Faults, refuse_others};
use super::file::{CavitationName, CavityShearName, FilmFile, FilmModelName};
use super::machine::zero;
use super::plans::FilmPlan;

pub(super) fn film(f: &mut FilmFile, faults: &mut Faults) -> Option<FilmPlan> {
    faults.unknown::<FilmFile>(&f.unknown, "film");
    let model = faults.or(&mut f.model, "film.model", FilmModelName::Reynolds);
    if model == FilmModelName::Mobility {
        let why = "film.model is \"mobility\"";
        refuse_others!(
            faults,
            f,
            "film",
            why,
            [],
            [cavitation, cavity_shear, cells_around, cells_across_half, side_pressure, cavitation_pressure,]
        );
        return Some(FilmPlan {
            model,
            cavitation: CavitationName::Guembel,
            cavity_shear: CavityShearName::Full,
            cells_around: 0,
            cells_across_half: 0,
            side_pressure_pa: 0.0,
            cavitation_pressure_pa: 0.0,
        });
    }
    let cavitation = faults.or(&mut f.cavitation, "film.cavitation", CavitationName::MassConserving);
    let cavity_shear = cavity_shear(f, cavitation, faults);
    let around = faults.or(&mut f.cells_around, "film.cells_around", 72);
    let across = faults.or(&mut f.cells_across_half, "film.cells_across_half", 8);
    let side = faults.or(&mut f.side_pressure, "film.side_pressure", zero("0 bar")).si();
    let cavity = faults.or(&mut f.cavitation_pressure, "film.cavitation_pressure", zero("0 bar")).si();
    let words = "between 16 and 2000";
    faults.range(Some(around as f64), "film.cells_around", |v| (16.0..=2000.0).contains(&v), words);
    let words = "between 1 and 200";
    faults.range(Some(across as f64), "film.cells_across_half", |v| (1.0..=200.0).contains(&v), words);
    faults.range(Some(cavity), "film.cavitation_pressure", |v| v <= side, "at or below the side pressure");
    Some(FilmPlan {
        model,
        cavitation,
        cavity_shear,
        cells_around: around,
        cells_across_half: across,
        side_pressure_pa: side,
        cavitation_pressure_pa: cavity,
    })
}

fn cavity_shear(f: &mut FilmFile, cavitation: CavitationName, faults: &mut Faults) -> CavityShearName {
    let (conserving, path) = (cavitation == CavitationName::MassConserving, "film.cavity_shear");
    let default = if conserving { CavityShearName::Fill } else { CavityShearName::Full };
    let shear = faults.or(&mut f.cavity_shear, path, default);
    if shear == CavityShearName::Fill && !conserving {
        faults.add(
            path,
            "must be \"full\": only film.cavitation = \"mass-conserving\" knows the fill of the cavity",
        );
    }
    shear
}

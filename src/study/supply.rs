//! Checks of the oil supply: pressure and openings.

use super::Given;
use super::faults::{Faults, join, refuse_others};
use super::file::{OpeningFile, OpeningKind, SupplyFile, SurfaceName};
use super::machine::zero;
use super::plans::{FilmPlan, SupplyPlan};
use crate::film::{Feed, Opening, OpeningError};
use crate::report::short;
use crate::units::Angle;
use std::f64::consts::TAU;

/// Width and diameter of the bearing as given, m.
pub(super) type Size = Option<[f64; 2]>;

pub(super) fn supply(
    file: &mut SupplyFile,
    path: &str,
    size: Size,
    film: Option<&FilmPlan>,
    faults: &mut Faults,
) -> Option<SupplyPlan> {
    faults.unknown::<SupplyFile>(&file.unknown, path);
    let at = |key: &str| join(path, key);
    let pressure = faults.need(&file.pressure, &at("pressure")).map(|v| v.si());
    let least = film.map_or(f64::NEG_INFINITY, |f| f.cavitation_pressure_pa);
    faults.range(
        pressure,
        &at("pressure"),
        |v| v >= least && v <= 1e8,
        "at or above the cavitation pressure and at most 1000 bar",
    );
    faults.need(&file.openings, &at("openings"));
    let Given::Value(list) = &mut file.openings else { return None };
    if list.is_empty() {
        faults.add(&at("openings"), format!("needs at least one opening, like [[{path}.openings]]"));
    }
    let mut feeds = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{path}.openings[{i}]");
        faults.get(given, &path);
        if let Given::Value(opening) = given {
            feeds.extend(feed(opening, &path, size, faults));
        }
    }
    Some(SupplyPlan { pressure_pa: pressure?, feeds })
}

fn feed(file: &mut OpeningFile, path: &str, size: Size, faults: &mut Faults) -> Option<Feed> {
    faults.unknown::<OpeningFile>(&file.unknown, path);
    let on = faults.or(&mut file.on, &join(path, "on"), SurfaceName::Shell);
    let kind = faults.need(&file.kind, &join(path, "kind"))?;
    let (words, used): (&str, &[&str]) = match kind {
        OpeningKind::AxialGroove => ("axial-groove", &["angle", "extent", "length_share"]),
        OpeningKind::CircumferentialGroove => {
            ("circumferential-groove", &["extent", "start", "centre", "width_share"])
        }
        OpeningKind::Pocket => ("pocket", &["angle", "extent", "centre", "width_share"]),
        OpeningKind::Hole => ("hole", &["angle", "centre", "diameter"]),
    };
    let why = format!("kind is \"{words}\"");
    refuse_others!(
        faults,
        file,
        path,
        &why,
        used,
        [angle, extent, start, centre, width_share, length_share, diameter]
    );
    let before = faults.count();
    let opening = match kind {
        OpeningKind::AxialGroove => axial_groove(file, path, faults),
        OpeningKind::CircumferentialGroove => circumferential_groove(file, path, faults),
        OpeningKind::Pocket => pocket(file, path, faults),
        OpeningKind::Hole => hole(file, path, size, faults),
    };
    let opening = opening.filter(|_| faults.count() == before)?;
    opening.validate().map_err(|e| faults.add(path, words_of(e))).ok()?;
    Some(Feed { opening, on_journal: on == SurfaceName::Journal })
}

fn words_of(error: OpeningError) -> String {
    match error {
        OpeningError::BeyondEdge { low, high } => {
            let (low, high) = (short(low), short(high));
            format!(
                "reaches from {low} to {high} across the width, beyond the edges of the bearing at -1 and 1"
            )
        }
        other => other.to_string(),
    }
}

fn axial_groove(file: &OpeningFile, path: &str, faults: &mut Faults) -> Option<Opening> {
    let angle = angle(&file.angle, path, faults);
    let extent = extent(faults.need(&file.extent, &join(path, "extent")), path, faults);
    let length = share(&file.length_share, path, "length_share", faults);
    Some(Opening::AxialGroove { angle_rad: angle?, extent_rad: extent?, length_share: length? })
}

fn circumferential_groove(file: &mut OpeningFile, path: &str, faults: &mut Faults) -> Option<Opening> {
    let extent_given = faults.or(&mut file.extent, &join(path, "extent"), zero("360 deg"));
    let extent = extent(Some(extent_given), path, faults)?;
    let start_at = join(path, "start");
    let start = if extent > TAU - 1e-9 {
        faults.unused(&file.start, &start_at, "the groove goes all around");
        0.0
    } else {
        faults.or(&mut file.start, &start_at, zero("0 deg")).si()
    };
    let centre = centre(file, path, faults);
    let width = share(&file.width_share, path, "width_share", faults);
    let (centre_zeta, width_share) = (centre, width?);
    // Rounding must not open a closed groove.
    Some(Opening::CircumferentialGroove {
        centre_zeta,
        width_share,
        start_rad: start,
        extent_rad: extent.min(TAU),
    })
}

fn pocket(file: &mut OpeningFile, path: &str, faults: &mut Faults) -> Option<Opening> {
    let angle = angle(&file.angle, path, faults);
    let extent = extent(faults.need(&file.extent, &join(path, "extent")), path, faults);
    let centre_zeta = centre(file, path, faults);
    let width = share(&file.width_share, path, "width_share", faults);
    Some(Opening::Pocket { angle_rad: angle?, extent_rad: extent?, centre_zeta, width_share: width? })
}

fn hole(file: &mut OpeningFile, path: &str, size: Size, faults: &mut Faults) -> Option<Opening> {
    let angle = angle(&file.angle, path, faults);
    let centre_zeta = centre(file, path, faults);
    let hole = faults.need(&file.diameter, &join(path, "diameter")).map(|v| v.si());
    let most = size.map_or(f64::INFINITY, |[width, diameter]| width.min(diameter));
    faults.range(hole, &join(path, "diameter"), |v| v > 0.0 && v <= most, "above zero and at most the width");
    let (hole, [width, diameter]) = (hole?, size?);
    Some(Opening::Hole {
        angle_rad: angle?,
        centre_zeta,
        radius_rad: hole / diameter,
        radius_zeta: hole / width,
    })
}

fn angle(given: &Given<Angle>, path: &str, faults: &mut Faults) -> Option<f64> {
    let angle = faults.need(given, &join(path, "angle")).map(|v| v.si());
    faults.range(angle, &join(path, "angle"), |v| v.abs() <= 2.0 * TAU, "between -720 deg and 720 deg");
    angle
}

fn extent(given: Option<Angle>, path: &str, faults: &mut Faults) -> Option<f64> {
    let extent = given.map(|v| v.si());
    faults.range(
        extent,
        &join(path, "extent"),
        |v| v > 0.0 && v < TAU + 1e-9,
        "above 0 deg and at most 360 deg",
    );
    extent
}

fn centre(file: &mut OpeningFile, path: &str, faults: &mut Faults) -> f64 {
    let centre = faults.or(&mut file.centre, &join(path, "centre"), 0.0);
    faults.range(Some(centre), &join(path, "centre"), |v| v.abs() <= 1.0, "between -1 and 1");
    centre
}

fn share(given: &Given<f64>, path: &str, key: &str, faults: &mut Faults) -> Option<f64> {
    let share = faults.need(given, &join(path, key));
    faults.range(share, &join(path, key), |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
    share
}

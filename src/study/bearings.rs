//! Checks of the bearings.

use super::Given;
use super::faults::{Faults, join, refuse_others};
use super::file::{BearingFile, FilmModelName, StudyFile};
use super::machine::zero;
use super::plans::{BearingPlan, FilmPlan, RoughnessPlan, SupplyPlan};
use super::{fit, heat, loads, roughness, shapes, supply};
use crate::cranktrain::{BearingShape, Tilt};
use crate::units::Length;
use std::path::Path;

/// Bearings by name, with what the checks made of them.
pub(super) type Bearings = Vec<(String, Option<BearingPlan>)>;

/// What the bearings of a study share.
pub(super) struct Frame<'a> {
    pub film: Option<&'a FilmPlan>,
    pub base: Option<&'a Path>,
}

impl Frame<'_> {
    /// Whether the film knows more than smooth aligned cylinders.
    fn detailed(&self) -> bool {
        self.film.is_none_or(|f| f.model == FilmModelName::Reynolds)
    }
}

pub(super) fn bearings(
    file: &mut StudyFile,
    frame: &Frame,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<Bearings> {
    faults.need(&file.bearings, "bearings")?;
    let Given::Value(map) = &mut file.bearings else { return None };
    if map.is_empty() {
        faults.add("bearings", "needs at least one bearing, like [bearings.big_end]");
    }
    let mut found = Vec::new();
    for (name, given) in map.iter_mut() {
        let path = join("bearings", name);
        if !is_name(name) || name == "oil" {
            faults.add(&path, "a bearing's name is made of letters, digits, '_' and '-', and is not 'oil'");
        }
        faults.get(given, &path);
        let plan = match given {
            Given::Value(bearing) => bearing_plan(name, bearing, &path, frame, faults, fingerprint),
            _ => None,
        };
        found.push((name.clone(), plan));
    }
    Some(found)
}

/// Whether a name can stand in the name of a parameter.
pub(super) fn is_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

fn bearing_plan(
    name: &str,
    b: &mut BearingFile,
    path: &str,
    frame: &Frame,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<BearingPlan> {
    faults.unknown::<BearingFile>(&b.unknown, path);
    let at = |key: &str| join(path, key);
    let mut positive = |given: &Given<Length>, key: &str| {
        let value = faults.need(given, &at(key)).map(|v| v.si());
        faults.range(value, &at(key), |v| v > 0.0, "above zero");
        value
    };
    let width = positive(&b.width, "width");
    let diameter = positive(&b.diameter, "diameter");
    let clearance = positive(&b.diametral_clearance, "diametral_clearance");
    if let (Some(d), Some(c)) = (diameter, clearance)
        && c > 0.02 * d
    {
        faults.add(&at("diametral_clearance"), "must be less than 2 % of the diameter");
    }
    let mass = faults.or(&mut b.journal_mass, &at("journal_mass"), zero("0 kg")).si();
    faults.range(Some(mass), &at("journal_mass"), |v| v >= 0.0, "at or above zero");
    let count = faults.or(&mut b.count, &at("count"), 1);
    faults.range(Some(f64::from(count)), &at("count"), |v| v >= 1.0, "at least 1");
    let size = width.zip(diameter).map(|(w, d)| [w, d]);
    let before = faults.count();
    let details = details(b, path, frame, size, faults, fingerprint);
    let heat = heat::heat_balance(&mut b.heat_balance, &at("heat_balance"), faults);
    let whole = faults.count() == before;
    let load = loads::load(b, path, frame.base, faults, fingerprint);
    let plan = BearingPlan {
        name: name.to_owned(),
        width_m: width?,
        diameter_m: diameter?,
        diametral_clearance_m: clearance?,
        journal_mass_kg: mass,
        count,
        tilt: details.tilt,
        supply: details.supply,
        roughness: details.roughness,
        heat,
        shapes: details.shapes,
        load: load?,
    };
    if !whole {
        return None;
    }
    fit::leave_a_gap(&plan, path, faults);
    fit::come_back(&plan, path, faults);
    Some(plan)
}

/// What only a film on a mesh knows.
struct Details {
    tilt: Tilt,
    supply: Option<SupplyPlan>,
    roughness: Option<RoughnessPlan>,
    shapes: Vec<BearingShape>,
}

fn details(
    b: &mut BearingFile,
    path: &str,
    frame: &Frame,
    size: supply::Size,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Details {
    let at = |key: &str| join(path, key);
    let mut found =
        Details { tilt: Tilt::Given([0.0; 2]), supply: None, roughness: None, shapes: Vec::new() };
    if !frame.detailed() {
        let why = "film.model \"mobility\" knows only smooth, aligned, cylindrical bearings full of oil";
        refuse_others!(faults, b, path, why, [], [tilt_x, tilt_y, free_tilt, supply, roughness, shapes]);
        return found;
    }
    found.tilt = tilt(b, path, faults);
    faults.get(&b.supply, &at("supply"));
    if let Given::Value(file) = &mut b.supply {
        found.supply = supply::supply(file, &at("supply"), size, frame.film, faults);
    } else if b.supply.is_absent() && frame.film.is_some_and(FilmPlan::runs_dry) {
        let words = "is missing: a mass-conserving film needs oil; give it, or a film.side_pressure above the cavitation \
                     pressure, or choose film.cavitation = \"swift-stieber\"";
        faults.add(&at("supply"), words);
    }
    faults.get(&b.roughness, &at("roughness"));
    if let Given::Value(file) = &mut b.roughness {
        found.roughness = roughness::roughness(file, &at("roughness"), faults);
    }
    faults.get(&b.shapes, &at("shapes"));
    if let Given::Value(list) = &mut b.shapes {
        found.shapes = shapes::shapes(list, &at("shapes"), frame.base, faults, fingerprint);
    }
    found
}

fn tilt(b: &mut BearingFile, path: &str, faults: &mut Faults) -> Tilt {
    if faults.or(&mut b.free_tilt, &join(path, "free_tilt"), false) {
        refuse_others!(
            faults,
            b,
            path,
            "free_tilt lets the journal tilt as the film's moment does",
            [],
            [tilt_x, tilt_y]
        );
        return Tilt::Free;
    }
    let x = faults.or(&mut b.tilt_x, &join(path, "tilt_x"), zero("0 deg")).si();
    let y = faults.or(&mut b.tilt_y, &join(path, "tilt_y"), zero("0 deg")).si();
    Tilt::Given([x, y])
}

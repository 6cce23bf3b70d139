//! Checks of the bearings and of the machine that loads them.

use super::Given;
use super::faults::{Faults, join};
use super::file::{BearingFile, BearingKind, MachineFile, StudyFile};
use super::machine::{self, zero};
use super::plans::{BearingPlan, LoadPlan};
use super::table::{TableFile, periodic};
use crate::cranktrain::{Cylinder, LoadTable, VeeEngine};
use crate::math::PeriodicSpline;
use crate::units::Length;
use std::collections::BTreeMap;
use std::path::Path;

pub(super) fn machine_of(
    file: &mut StudyFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> (Option<Cylinder>, Option<VeeEngine>) {
    let kinds: Vec<BearingKind> = file
        .bearings
        .value()
        .into_iter()
        .flat_map(|b| b.values())
        .filter_map(|b| b.value().and_then(|b| b.kind.value().copied()))
        .collect();
    let needs_vee = kinds.contains(&BearingKind::Main);
    if !kinds.is_empty() && !needs_vee && !kinds.contains(&BearingKind::BigEnd) {
        let why = "no bearing takes its load from the machine";
        faults.unused(&file.machine, "machine", why);
        faults.unused(&file.cylinder_pressure, "cylinder_pressure", why);
        return (None, None);
    }
    faults.need(&file.machine, "machine");
    faults.need(&file.cylinder_pressure, "cylinder_pressure");
    let (Given::Value(machine), Given::Value(pressure)) = (&mut file.machine, &mut file.cylinder_pressure)
    else {
        return (None, None);
    };
    let cylinder = machine::cylinder(machine, pressure, base, faults, fingerprint);
    last_main(file.bearings.value(), machine, faults);
    if needs_vee || !machine.firing_order.is_absent() {
        let vee = machine::vee(machine, cylinder.as_ref(), faults);
        return (cylinder, vee);
    }
    let why = "there is no main bearing and no firing_order";
    faults.unused(&machine.vee_angle, "machine.vee_angle", why);
    faults.unused(&machine.throw_angles, "machine.throw_angles", why);
    faults.unused(&machine.throw_mass, "machine.throw_mass", why);
    faults.unused(&machine.rod_spacing_ratio, "machine.rod_spacing_ratio", why);
    (cylinder, None)
}

/// Main bearings are counted from 0 to the number of throws.
fn last_main(
    bearings: Option<&BTreeMap<String, Given<BearingFile>>>,
    machine: &MachineFile,
    faults: &mut Faults,
) {
    let Some(throws) = machine.throw_angles.value().map(Vec::len) else { return };
    for (name, bearing) in bearings.into_iter().flatten() {
        let main = bearing.value().and_then(|b| b.main_bearing.value());
        if let Some(main) = main.filter(|m| **m > throws) {
            let path = format!("bearings.{name}.main_bearing");
            faults.add(&path, format!("must be at most {throws}, the number of throws, found {main}"));
        }
    }
}

pub(super) fn bearings(
    file: &mut StudyFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<Vec<BearingPlan>> {
    faults.need(&file.bearings, "bearings")?;
    let Given::Value(map) = &mut file.bearings else { return None };
    if map.is_empty() {
        faults.add("bearings", "needs at least one bearing, like [bearings.big_end]");
    }
    let mut plans = Vec::new();
    let mut complete = true;
    for (name, given) in map.iter_mut() {
        let path = join("bearings", name);
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') || name == "oil" {
            faults.add(&path, "a bearing's name is made of letters, digits, '_' and '-', and is not 'oil'");
        }
        faults.get(given, &path);
        let plan = match given {
            Given::Value(bearing) => bearing_plan(name, bearing, &path, base, faults, fingerprint),
            _ => None,
        };
        complete &= plan.is_some();
        plans.extend(plan);
    }
    complete.then_some(plans)
}

fn bearing_plan(
    name: &str,
    b: &mut BearingFile,
    path: &str,
    base: Option<&Path>,
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
    let Some(kind) = faults.need(&b.kind, &at("kind")) else {
        faults.get(&b.load, &at("load"));
        faults.get(&b.cycle, &at("cycle"));
        faults.get(&b.main_bearing, &at("main_bearing"));
        return None;
    };
    if kind != BearingKind::Main {
        faults.unused(&b.main_bearing, &at("main_bearing"), "the bearing is no main bearing");
    }
    if kind != BearingKind::Table {
        faults.unused(&b.load, &at("load"), "kind is not \"table\"");
        faults.unused(&b.cycle, &at("cycle"), "kind is not \"table\"");
    }
    let load = match kind {
        BearingKind::BigEnd => LoadPlan::BigEnd,
        BearingKind::Main => LoadPlan::Main(faults.need(&b.main_bearing, &at("main_bearing"))?),
        BearingKind::Table => {
            let cycle = faults.or(&mut b.cycle, &at("cycle"), zero("720 deg")).si();
            faults.range(Some(cycle), &at("cycle"), |v| v > 0.0, "above zero");
            faults.need(&b.load, &at("load"));
            let Given::Value(table) = &mut b.load else { return None };
            LoadPlan::Table(load_table(table, cycle, &at("load"), base, faults, fingerprint)?)
        }
    };
    Some(BearingPlan {
        name: name.to_owned(),
        width_m: width?,
        diameter_m: diameter?,
        diametral_clearance_m: clearance?,
        journal_mass_kg: mass,
        count,
        load,
    })
}

fn load_table(
    file: &mut TableFile,
    cycle: f64,
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<LoadTable> {
    let table = file.load(base, path, faults)?;
    fingerprint.push_str(&table.fingerprint());
    let x: &[(&str, f64)] = &[("force_x_n", 1.0), ("force_x_kn", 1e3)];
    let y: &[(&str, f64)] = &[("force_y_n", 1.0), ("force_y_kn", 1e3)];
    let curves = periodic(&table, cycle, &[x, y]).and_then(|(angles, mut columns)| {
        let y = columns.remove(1);
        let spline = |v| PeriodicSpline::new(angles.clone(), v, cycle).map_err(|e| e.to_string());
        Ok(LoadTable { x: spline(columns.remove(0))?, y: spline(y)? })
    });
    curves.map_err(|e| faults.add(path, e)).ok()
}

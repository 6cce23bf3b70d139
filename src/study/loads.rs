//! Checks of where the loads come from: the machine, or a table.

use super::Given;
use super::faults::{Faults, join, refuse_others};
use super::file::{BearingFile, BearingKind, MachineFile, StudyFile};
use super::machine::{self, zero};
use super::plans::LoadPlan;
use super::table::{TableFile, periodic};
use crate::cranktrain::{Cylinder, LoadTable, VeeEngine};
use crate::math::PeriodicSpline;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
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

/// The load of a bearing, from the keys that go with its kind.
pub(super) fn load(
    b: &mut BearingFile,
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<LoadPlan> {
    let at = |key: &str| join(path, key);
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
        refuse_others!(faults, b, path, "kind is not \"table\"", [], [load, cycle]);
    }
    if kind != BearingKind::Constant {
        refuse_others!(faults, b, path, "kind is not \"constant\"", [], [force, force_angle]);
    }
    match kind {
        BearingKind::Position => Some(LoadPlan::Table(constant(0.0, 0.0))),
        BearingKind::Constant => {
            let force = faults.need(&b.force, &at("force")).map(|v| v.si());
            faults.range(force, &at("force"), |v| v > 0.0, "above zero");
            let angle = faults.or(&mut b.force_angle, &at("force_angle"), zero("0 deg")).si();
            Some(LoadPlan::Table(constant(force?, angle)))
        }
        BearingKind::BigEnd => Some(LoadPlan::BigEnd),
        BearingKind::Main => faults.need(&b.main_bearing, &at("main_bearing")).map(LoadPlan::Main),
        BearingKind::Table => {
            let cycle = faults.or(&mut b.cycle, &at("cycle"), zero("720 deg")).si();
            faults.range(Some(cycle), &at("cycle"), |v| v > 0.0, "above zero");
            faults.need(&b.load, &at("load"));
            let Given::Value(table) = &mut b.load else { return None };
            load_table(table, cycle, &at("load"), base, faults, fingerprint).map(LoadPlan::Table)
        }
    }
}

impl LoadPlan {
    /// Whether the journal has come back after a cycle, so that what turns with it repeats.
    pub(super) fn journal_returns(&self) -> bool {
        match self {
            Self::Table(table) => {
                let turns = table.x.period() / TAU;
                (turns - turns.round()).abs() < 1e-9
            }
            _ => true,
        }
    }
}

/// A load that does not change; it repeats with every turn.
fn constant(force_n: f64, angle_rad: f64) -> LoadTable {
    let spline = |v: f64| {
        let knots = vec![0.0, TAU / 3.0, 2.0 * TAU / 3.0];
        PeriodicSpline::new(knots, vec![v; 3], TAU).expect("three points around a turn carry a spline")
    };
    LoadTable { x: spline(force_n * angle_rad.cos()), y: spline(force_n * angle_rad.sin()) }
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

//! Checks of the machine: slider-crank, cylinder pressure, crankshaft, loads.

use super::faults::{Faults, join};
use super::file::{CylinderPressureFile, MachineFile, PressureSource};
use super::table::periodic;
use crate::cranktrain::{
    Cylinder, CylinderName, CylinderPressure, SliderCrank, VeeEngine, WORKING_CYCLE_RAD, WorkingCycle,
};
use crate::laws::Wiebe;
use std::path::Path;
use std::sync::Arc;

const MACHINE: &str = "machine";
const PRESSURE: &str = "cylinder_pressure";

fn at(key: &str) -> String {
    join(MACHINE, key)
}

/// Slider-crank of the machine.
fn crank(file: &mut MachineFile, faults: &mut Faults) -> Option<SliderCrank> {
    let throw = faults.need(&file.throw, &at("throw")).map(|v| v.si());
    faults.range(throw, &at("throw"), |v| v > 0.0, "above zero");
    let rod = faults.get(&file.rod_length, &at("rod_length")).map(|v| v.si());
    let ratio = faults.get(&file.throw_over_rod, &at("throw_over_rod"));
    let offset = faults.or(&mut file.piston_pin_offset, &at("piston_pin_offset"), zero("0 mm")).si();
    faults.range(ratio, &at("throw_over_rod"), |v| v > 0.0 && v < 1.0, "between 0 and 1");
    if file.rod_length.is_absent() == file.throw_over_rod.is_absent() {
        faults.add(&at("rod_length"), "give either rod_length or throw_over_rod");
        return None;
    }
    let crank = SliderCrank {
        throw_m: throw?,
        rod_m: rod.or(ratio.map(|r| throw.unwrap_or(0.0) / r))?,
        offset_m: offset,
    };
    if !crank.turns() {
        faults.add(&at("rod_length"), "the rod must be longer than crank radius and offset together");
        return None;
    }
    Some(crank)
}

/// One cylinder with its running gear.
pub(super) fn cylinder(
    file: &mut MachineFile,
    pressure: &mut CylinderPressureFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<Cylinder> {
    faults.unknown::<MachineFile>(&file.unknown, MACHINE);
    let crank = crank(file, faults);
    let bore = faults.need(&file.bore, &at("bore")).map(|v| v.si());
    faults.range(bore, &at("bore"), |v| v > 0.0, "above zero");
    let oscillating = faults.need(&file.oscillating_mass, &at("oscillating_mass")).map(|v| v.si());
    let rotating = faults.need(&file.rotating_mass, &at("rotating_mass")).map(|v| v.si());
    faults.range(oscillating, &at("oscillating_mass"), |v| v >= 0.0, "at or above zero");
    faults.range(rotating, &at("rotating_mass"), |v| v >= 0.0, "at or above zero");
    let below = faults.or(&mut file.crankcase_pressure, &at("crankcase_pressure"), zero("1 bar")).si();
    let diagram = diagram(pressure, crank, bore, base, faults, fingerprint);
    Some(Cylinder {
        crank: crank?,
        bore_m: bore?,
        oscillating_mass_kg: oscillating?,
        rotating_mass_kg: rotating?,
        crankcase_pressure_pa: below,
        pressure: Arc::new(diagram?),
    })
}

fn diagram(
    file: &mut CylinderPressureFile,
    crank: Option<SliderCrank>,
    bore: Option<f64>,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<CylinderPressure> {
    faults.unknown::<CylinderPressureFile>(&file.unknown, PRESSURE);
    match faults.need(&file.source, &join(PRESSURE, "source"))? {
        PressureSource::Table => indicated(file, base, faults, fingerprint),
        PressureSource::Wiebe => computed(file, crank, bore, faults),
    }
}

fn indicated(
    file: &mut CylinderPressureFile,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<CylinderPressure> {
    let why = "cylinder_pressure.source is \"table\"";
    faults.unused(&file.compression_ratio, &join(PRESSURE, "compression_ratio"), why);
    faults.unused(&file.charge_pressure, &join(PRESSURE, "charge_pressure"), why);
    faults.unused(&file.charge_temperature, &join(PRESSURE, "charge_temperature"), why);
    faults.unused(&file.heat_release, &join(PRESSURE, "heat_release"), why);
    faults.unused(&file.combustion_start, &join(PRESSURE, "combustion_start"), why);
    faults.unused(&file.combustion_duration, &join(PRESSURE, "combustion_duration"), why);
    faults.unused(&file.combustion_shape, &join(PRESSURE, "combustion_shape"), why);
    faults.unused(&file.inlet_closes, &join(PRESSURE, "inlet_closes"), why);
    faults.unused(&file.exhaust_opens, &join(PRESSURE, "exhaust_opens"), why);
    faults.unused(&file.exhaust_pressure, &join(PRESSURE, "exhaust_pressure"), why);
    let path = join(PRESSURE, "table");
    let table = faults.section(&mut file.table, &path)?.load(base, &path, faults)?;
    fingerprint.push_str(&table.fingerprint());
    let names: &[(&str, f64)] = &[("pressure_mpa", 1e6), ("pressure_bar", 1e5), ("pressure_pa", 1.0)];
    let result = periodic(&table, WORKING_CYCLE_RAD, &[names]).and_then(|(angles, mut columns)| {
        let pressure = columns.remove(0);
        if let Some(p) = pressure.iter().find(|p| !(0.0..=1e8).contains(*p) || **p == 0.0) {
            let found = crate::report::short(*p * 1e-6);
            return Err(format!(
                "pressures must be absolute, above zero and at most 100 MPa, found {found} MPa"
            ));
        }
        CylinderPressure::from_table(angles, pressure).map_err(|e| e.to_string())
    });
    result.map_err(|e| faults.add(&path, e)).ok()
}

fn computed(
    file: &mut CylinderPressureFile,
    crank: Option<SliderCrank>,
    bore: Option<f64>,
    faults: &mut Faults,
) -> Option<CylinderPressure> {
    let at = |key: &str| join(PRESSURE, key);
    faults.unused(&file.table, &at("table"), "cylinder_pressure.source is \"wiebe\"");
    let ratio = faults.need(&file.compression_ratio, &at("compression_ratio"));
    faults.range(ratio, &at("compression_ratio"), |v| v > 1.0 && v <= 40.0, "above 1 and at most 40");
    let charge = faults.need(&file.charge_pressure, &at("charge_pressure"));
    faults.range(charge.as_ref().map(|v| v.si()), &at("charge_pressure"), |v| v > 0.0, "above zero");
    let temperature = faults.need(&file.charge_temperature, &at("charge_temperature")).map(|v| v.si());
    faults.range(
        temperature,
        &at("charge_temperature"),
        |v| (200.0..=600.0).contains(&v),
        "between 200 K and 600 K",
    );
    let heat = faults.need(&file.heat_release, &at("heat_release")).map(|v| v.si());
    faults.range(heat, &at("heat_release"), |v| v >= 0.0, "at or above zero");
    let start = faults.need(&file.combustion_start, &at("combustion_start")).map(|v| v.si());
    let duration = faults.need(&file.combustion_duration, &at("combustion_duration")).map(|v| v.si());
    let shortest = 5f64.to_radians();
    faults.range(duration, &at("combustion_duration"), |v| v >= shortest, "at least 5 deg");
    let shape = faults.or(&mut file.combustion_shape, &at("combustion_shape"), 1.0);
    faults.range(Some(shape), &at("combustion_shape"), |v| (0.0..=10.0).contains(&v), "between 0 and 10");
    let closes = faults.or(&mut file.inlet_closes, &at("inlet_closes"), zero("-150 deg")).si();
    let opens = faults.or(&mut file.exhaust_opens, &at("exhaust_opens"), zero("125 deg")).si();
    faults.range(
        Some(closes),
        &at("inlet_closes"),
        |v| (-3.6..-1.0).contains(&v),
        "between -206 deg and -57 deg",
    );
    faults.range(
        Some(opens),
        &at("exhaust_opens"),
        |v| (1.0..3.6).contains(&v),
        "between 57 deg and 206 deg",
    );
    let exhaust = match &charge {
        Some(charge) => faults.or(&mut file.exhaust_pressure, &at("exhaust_pressure"), charge.clone()).si(),
        None => faults.get(&file.exhaust_pressure, &at("exhaust_pressure")).map_or(1.0, |p| p.si()),
    };
    faults.range(Some(exhaust), &at("exhaust_pressure"), |v| v > 0.0, "above zero");
    let wiebe = Wiebe { start_rad: start?, duration_rad: duration?, shape };
    if wiebe.start_rad <= closes || wiebe.start_rad + wiebe.duration_rad > opens {
        faults.add(
            &at("combustion_start"),
            "combustion must lie between closing of the inlet and opening of the exhaust",
        );
    }
    let cycle = WorkingCycle {
        bore_m: bore?,
        compression_ratio: ratio?,
        charge_pressure_pa: charge?.si(),
        charge_temperature_k: temperature?,
        heat_release_j: heat?,
        wiebe,
        inlet_closes_rad: closes,
        exhaust_opens_rad: opens,
        exhaust_pressure_pa: exhaust,
    };
    if faults.any() {
        return None;
    }
    cycle.pressure(&crank?).map_err(|e| faults.add(PRESSURE, e.to_string())).ok()
}

/// The whole engine, for main bearings.
pub(super) fn vee(
    file: &mut MachineFile,
    cylinder: Option<&Cylinder>,
    faults: &mut Faults,
) -> Option<VeeEngine> {
    let vee = faults.or(&mut file.vee_angle, &at("vee_angle"), zero("0 deg")).si();
    let mass = faults.or(&mut file.throw_mass, &at("throw_mass"), zero("0 kg")).si();
    let spacing = faults.or(&mut file.rod_spacing_ratio, &at("rod_spacing_ratio"), 0.0);
    faults.range(
        Some(spacing),
        &at("rod_spacing_ratio"),
        |v| (0.0..1.0).contains(&v),
        "at least 0 and below 1",
    );
    let given = faults.need(&file.throw_angles, &at("throw_angles"));
    let order = faults.need(&file.firing_order, &at("firing_order"));
    let (given, order) = (given?, order?);
    let angles: Vec<f64> = given
        .iter()
        .enumerate()
        .filter_map(|(i, a)| faults.need(a, &format!("{}[{i}]", at("throw_angles"))))
        .map(|a| a.si())
        .collect();
    let names: Vec<CylinderName> = order
        .iter()
        .enumerate()
        .filter_map(|(i, n)| {
            n.parse().map_err(|e| faults.add(&format!("{}[{i}]", at("firing_order")), format!("{e}"))).ok()
        })
        .collect();
    if names.len() != order.len() || angles.len() != given.len() {
        return None;
    }
    let engine = VeeEngine::new(cylinder?.clone(), vee, &angles, &names);
    let engine = engine.map_err(|e| faults.add(&at("firing_order"), e.to_string())).ok()?;
    Some(VeeEngine { throw_mass_kg: mass, rod_spacing_ratio: spacing, ..engine })
}

/// A default that is known to be well written.
pub(super) fn zero<D: crate::units::Dimension>(text: &str) -> crate::units::Measure<D> {
    text.parse().expect("defaults are quantities")
}

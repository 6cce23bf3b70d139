//! Every law that a study can choose: read, written out, read again, simulated and differentiated.

use crate::common::{here, merged, quietly};
use stribeck::gradient::EngineName;
use stribeck::study::{EngineComparison, Format, Study, Sweep, compare_engines, run, schema};

/// The main study with other sections; a section that stands there already is replaced key by key.
fn study(sections: &str) -> Study {
    let main = std::fs::read_to_string(here(crate::common::SMOOTH)).unwrap();
    let text = merged(&format!("{}\n{COARSEST}\n{sections}", without_search(&main)));
    Study::read(&text, Format::Toml, Some(&here("studies")))
        .unwrap_or_else(|e| panic!("{e}: {:#?}", e.faults))
}

/// The main study without its oil, assumptions, parameters and constraints.
fn without_search(main: &str) -> String {
    let mut kept = String::new();
    let mut keep = true;
    for line in main.lines() {
        if line.starts_with('[') {
            let dropped = ["[oil", "[assumptions", "[[parameters", "[[constraints", "[film"];
            keep = !dropped.iter().any(|d| line.starts_with(d));
        }
        if keep {
            kept += &format!("{line}\n");
        }
    }
    // A mesh as coarse as this one bears no full load.
    kept.replace("speed = \"1500 rpm\"", "speed = \"1500 rpm\"\nload_factor = 0.4")
}

const COARSEST: &str = r#"
[film]
cells_around = 24
cells_across_half = 4
[orbit]
steps_per_cycle = 120
[oil]
inlet_temperature = "75 degC"
film_temperature_rise = "18 K"
"#;

fn compared(study: &Study) -> Vec<EngineComparison> {
    quietly(|run| compare_engines(study, &[EngineName::Tra], &Sweep(Vec::new()), run)).unwrap()
}

/// Printed with its defaults, the study is the same study; TRA and ADJ agree on it.
fn assert_sound(name: &str, study: &Study) {
    let printed = study.to_toml();
    let again = Study::read(&printed, Format::Toml, Some(&here("studies")))
        .unwrap_or_else(|e| panic!("{name}: {:#?}\n{printed}", e.faults));
    assert_eq!(again.to_toml(), printed, "{name}");
    assert_eq!(again.hash, study.hash, "{name}");
    let json = Study::read(&study.to_json().to_string(), Format::Json, Some(&here("studies"))).unwrap();
    assert_eq!(json.hash, study.hash, "{name}");
    let validator = jsonschema::validator_for(&schema()).unwrap();
    let value = study.to_json();
    let mistakes: Vec<String> =
        validator.iter_errors(&value).map(|e| format!("{e} at {}", e.instance_path)).collect();
    assert!(mistakes.is_empty(), "{name}: {mistakes:?}");
    for c in compared(study) {
        let row = &c.rows[0];
        assert!(row.failure.is_none(), "{name}: {:?}", row.failure);
        for (quantity, error) in c.quantities.iter().zip(&row.error) {
            assert!(*error <= 1e-9, "{name}: TRA of {quantity} is off by {error:.1e}");
        }
        assert!(row.values.iter().all(|r| r.iter().all(|v| v.is_finite())), "{name}");
    }
}

/// Every section and nearly every key that is new with a mass-conserving film on rough surfaces.
const EVERYTHING: &str = r#"
[bearings.big_end]
tilt_x = "0.001 deg"

[bearings.big_end.supply]
pressure = "4 bar"
openings = [
    { kind = "hole", on = "journal", angle = "60 deg", diameter = "12 mm" },
    { kind = "axial-groove", angle = "90 deg", extent = "30 deg", length_share = 0.6 },
    { kind = "pocket", angle = "270 deg", extent = "30 deg", width_share = 0.5, centre = 0.1 },
    { kind = "circumferential-groove", start = "70 deg", extent = "60 deg", width_share = 0.1 },
]

[bearings.big_end.roughness]
journal = "0.3 um"
shell = "0.5 um"
shell_peklenik = 3
summit_height_ratio = 0.5

[bearings.big_end.heat_balance]
conductance = "20 W/K"

[[bearings.big_end.shapes]]
name = "relief"
kind = "edge-relief"
depth = "8 um"
length_share = 0.2

[[bearings.big_end.shapes]]
name = "free"
kind = "spline"
around = 4
across = 3

[[bearings.big_end.shapes]]
name = "pin"
kind = "barrel"
on = "journal"
height = "2 um"

[[bearings.big_end.shapes]]
name = "lemon"
kind = "lemon"
offset = "3 um"

[oil]
grade = "mine"
piezoviscosity = "roelands"
compressibility = "dowson-higginson"
shear_thinning = "cross"
second_newtonian_ratio = 0.5
critical_shear_rate = "2e6 1/s"
shear_exponent = 0.8

[grades.mine]
kinematic_viscosity_40c = "139 mm2/s"
kinematic_viscosity_100c = "14 mm2/s"
density_15c = "895 kg/m3"
pressure_viscosity_coefficient = "2 1/GPa"

[[parameters]]
name = "big_end.diameter"
lower = "112 mm"
upper = "128 mm"
[[parameters]]
name = "big_end.roughness.shell"
lower = "0.2 um"
upper = "1 um"
[[parameters]]
name = "big_end.supply.pressure"
lower = "2 bar"
upper = "6 bar"
[[parameters]]
name = "big_end.tilt_y"
lower = "-0.01 deg"
upper = "0.01 deg"
[[parameters]]
name = "big_end.shapes.relief.length_share"
lower = "0.1"
upper = "0.4"
[[parameters]]
name = "big_end.shapes.lemon.angle"
lower = "-30 deg"
upper = "30 deg"
[[parameters]]
name = "big_end.shapes.free.coefficients[*]"
lower = "-2 um"
upper = "10 um"
[[parameters]]
name = "oil.inlet_temperature"
lower = "60 degC"
upper = "90 degC"

[[constraints]]
quantity = "max-contact-pressure"
at_most = "200 MPa"
[[constraints]]
quantity = "contact-loss"
at_most = "500 W"
[[constraints]]
quantity = "min-film-thickness"
at_least = "1 um"
[[constraints]]
quantity = "hydrodynamic-loss"
at_most = "5 kW"
[[constraints]]
quantity = "film-temperature"
at_most = "120 degC"
[[constraints]]
quantity = "wear-rate"
at_most = "1 mm3/h"
[[constraints]]
quantity = "side-flow"
at_least = "1 l/min"
"#;

#[test]
fn a_study_of_everything_is_read_printed_simulated_and_differentiated() {
    let study = study(EVERYTHING);
    assert_eq!(study.parameters.len(), 7 + 12);
    assert_eq!(study.bearings[0].shapes.len(), 4);
    assert_sound("everything", &study);
    let printed = study.to_toml();
    for default in [
        "cavitation = \"mass-conserving\"",
        "cavity_shear = \"fill\"",
        "modulus = \"58.61 GPa\"",
        "boundary_friction = 0.08",
        "wear_coefficient = \"1e-8 mm3/(N m)\"",
        "film_share = 0.5",
        "ambient_temperature = \"60 degC\"",
        "heat_capacity = \"2000 J/(kg K)\"",
        "viscosity_law = \"walther\"",
        "start = \"0.2\"",
        "start = \"4 bar\"",
        "asperity_product = 0.04",
    ] {
        assert!(printed.contains(default), "{default} in\n{printed}");
    }
}

/// One width parameter, so that a study has something to vary.
const WIDTH: &str = "[[parameters]]\nname = \"big_end.width\"\nlower = \"45 mm\"\nupper = \"65 mm\"\n";
const SUPPLY: &str = "[bearings.big_end.supply]\npressure = \"4 bar\"\nopenings = [{ kind = \"axial-groove\", angle = \"90 deg\", extent = \"20 deg\", length_share = 0.6 }]\n";

#[test]
fn every_other_choice_is_sound_too() {
    let cases = [
        ("points and Guembel", "[film]\ncavitation = \"guembel\"\n[oil]\nviscosity_points = [{ temperature = \"40 degC\", dynamic_viscosity = \"0.12 Pa s\" }, { temperature = \"70 degC\", dynamic_viscosity = \"32 mPa s\" }, { temperature = \"100 degC\", dynamic_viscosity = \"12 mPa s\" }]\n".to_owned()),
        ("constant and Carreau", format!("{SUPPLY}[oil]\ndynamic_viscosity = \"11 mPa s\"\nshear_thinning = \"carreau\"\nrelaxation_time = \"1 us\"\nsecond_newtonian_ratio = 0.4\nshear_exponent = 0.6\n")),
        ("grade and Barus", format!("{SUPPLY}[oil]\ngrade = \"SAE 40\"\nviscosity_law = \"vogel\"\npiezoviscosity = \"barus\"\npressure_viscosity_coefficient = \"2 1/GPa\"\n[film]\ncavity_shear = \"full\"\n")),
        ("free tilt, rough without contact", format!("{SUPPLY}[oil]\ngrade = \"SAE 40\"\n[bearings.big_end]\nfree_tilt = true\nroughness = {{ journal = \"0.2 um\", shell = \"0.4 um\", contact = \"none\" }}\n")),
        ("side pressure feeds", "[film]\nside_pressure = \"1 bar\"\n[oil]\ngrade = \"SAE 40\"\n".to_owned()),
        ("offset, cone, table", format!("{SUPPLY}[oil]\ngrade = \"SAE 30\"\n[bearings.big_end]\nroughness = {{ journal = \"0.2 um\", shell = \"0.4 um\", contact_integral = \"power-fit\", elastic_factor = 0.003 }}\nshapes = [{{ name = \"o\", kind = \"offset\", offset = \"2 um\", angle = \"80 deg\" }}, {{ name = \"c\", kind = \"cone\", on = \"journal\", height = \"2 um\" }}, {{ name = \"t\", kind = \"table\", on = \"journal\", table = {{ columns = [\"angle_deg\", \"zeta\", \"height_um\"], rows = [[0, -1, 0], [0, 1, 1], [120, -1, 0.5], [120, 1, 0], [240, 1, 0], [240, -1, 1]] }} }}]\n[[parameters]]\nname = \"big_end.shapes.t.scale\"\nlower = \"0.5\"\nupper = \"2\"\n")),
    ];
    for (name, sections) in cases {
        assert_sound(name, &study(&format!("{sections}{WIDTH}")));
    }
}

#[test]
fn a_film_without_cells_knows_heat_too() {
    let main = std::fs::read_to_string(here(crate::common::SMOOTH)).unwrap();
    let sections = "[film]\nmodel = \"mobility\"\n[orbit]\nsteps_per_cycle = 120\n[bearings.big_end.heat_balance]\n\
                    [oil]\ngrade = \"SAE 40\"\ninlet_temperature = \"75 degC\"\n";
    let text = merged(&format!("{}\n{sections}{WIDTH}", without_search(&main)));
    let study = Study::read(&text, Format::Toml, None);
    let faults = study.expect_err("files are not read without a folder").faults;
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_sound("mobility", &Study::read(&text, Format::Toml, Some(&here("studies"))).unwrap());
}

#[test]
fn the_report_names_the_laws_and_shows_contact_and_temperature() {
    let search = "[optimiser]\nmax_iterations = 1\n";
    let study = study(&format!("{EVERYTHING}{search}"));
    let findings = quietly(|context| run(&study, context));
    let report = &findings.report;
    let methods = report.provenance.methods.join("\n");
    for source in [
        "Jakobsson and Floberg (1957)",
        "Walther (1931)",
        "Roelands (1966)",
        "Dowson and Higginson (1966)",
        "Cross (1965)",
        "Patir and Cheng (1978, 1979)",
        "Greenwood and Tripp (1971)",
        "Broyden's method (1965)",
        "B-splines",
    ] {
        assert!(methods.contains(source), "{source} in {methods}");
    }
    let orbit = &report.orbit[0];
    assert!(
        orbit.film_temperature_c > 75.0 && orbit.film_temperature_c < 150.0,
        "{}",
        orbit.film_temperature_c
    );
    assert!(orbit.max_contact_pressure_mpa.value >= 0.0 && orbit.mean_contact_loss_w >= 0.0);
    let exact = report.constraints.iter().find(|c| c.quantity == "min-film-thickness").unwrap();
    assert!((exact.exact_value.unwrap() - orbit.min_film_thickness_um.value).abs() < 1e-12);
    assert!(exact.value.unwrap() < exact.exact_value.unwrap(), "the smooth minimum is on the safe side");
    assert!(exact.bias.unwrap() < 0.0 && exact.bias.unwrap() > -0.05 * exact.exact_value.unwrap());
}

const SMALL_SHAFT: &str = r#"
format = "stribeck-study/1"
title = "A shaft"
[bearings.one]
kind = "constant"
count = 2
force = "2 kN"
width = "25 mm"
diameter = "50 mm"
diametral_clearance = "60 um"
[bearings.one.supply]
pressure = "1 bar"
[[bearings.one.supply.openings]]
kind = "axial-groove"
angle = "180 deg"
extent = "20 deg"
length_share = 0.8
[oil]
grade = "ISO VG 46"
inlet_temperature = "50 degC"
[film]
cells_around = 36
cells_across_half = 4
[orbit]
steps_per_cycle = 72
scheme = "bdf1"
periodicity_tolerance = 1e-9
[characteristic]
vary = "speed"
speeds = ["1000 rpm", "500 rpm"]
reference.columns = ["speed_rpm", "torque_nm"]
reference.rows = [[1000, 1.0]]
"#;

#[test]
fn a_characteristic_over_the_speed_adds_the_torques_of_its_bearings() {
    let study = Study::read(SMALL_SHAFT, Format::Toml, None).unwrap_or_else(|e| panic!("{:#?}", e.faults));
    let found = quietly(|run| stribeck::study::characterise(&study, run)).unwrap();
    assert_eq!(found.status, stribeck::report::CharacteristicStatus::Complete, "{:?}", found.failures);
    let (shaft, one) = (&found.tables[0], &found.tables[1]);
    for n in 0..2 {
        let (all, each) = (shaft.columns[0].values[n].unwrap(), one.columns[0].values[n].unwrap());
        assert!((all / (2.0 * each) - 1.0).abs() < 1e-12);
    }
    assert!(shaft.columns[0].values[0] > shaft.columns[0].values[1], "a full film drags more at speed");
    assert_eq!(shaft.columns[0].reference, vec![Some(1.0), None]);
    assert!(stribeck::report::characteristic_html(&found).unwrap().contains("friction torque"));
}

#[test]
fn a_characteristic_refuses_what_does_not_belong_to_it() {
    for (from, to, words) in [
        ("[characteristic]", "[gradient]\nengine = \"ADJ\"\n[characteristic]", "tabulates a characteristic"),
        ("vary = \"speed\"", "vary = \"eccentricity-ratio\"", "is missing"),
        ("\"speed_rpm\"", "\"speed\"", "speed_rpm"),
        ("speeds = [\"1000 rpm\", \"500 rpm\"]", "speeds = []", "at least one"),
        ("kind = \"constant\"\ncount = 2\nforce = \"2 kN\"", "kind = \"position\"", "constant loads"),
    ] {
        assert!(SMALL_SHAFT.contains(from), "{from}");
        let faults = Study::read(&SMALL_SHAFT.replace(from, to), Format::Toml, None).err().unwrap().faults;
        assert!(faults.iter().any(|f| f.message.contains(words)), "{to}: {faults:?}");
    }
}

#[test]
fn the_steady_studies_meet_their_tables() {
    for (name, most) in [("steady-tables", [0.5, 0.15]), ("steady-raimondi-boyd", [1.5, 0.6])] {
        let text = std::fs::read_to_string(here(&format!("studies/{name}.toml"))).unwrap();
        let study = Study::read(&text, Format::Toml, Some(&here("studies"))).unwrap();
        let found = quietly(|run| stribeck::study::characterise(&study, run)).unwrap();
        for (column, most) in found.tables[0].columns.iter().zip(most) {
            let miss = column.largest_difference.unwrap();
            assert!(miss <= most, "{name}, {}: {miss} > {most}", column.title);
        }
    }
}

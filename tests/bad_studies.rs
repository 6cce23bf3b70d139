//! Study files with mistakes: every one is reported, at its place, in words; nothing panics.

use crate::common::here;
use proptest::prelude::*;
use stribeck::study::{Format, Study, StudyErrors};

fn main_text() -> String {
    std::fs::read_to_string(here("studies/operational-170x215.toml")).unwrap()
}

fn errors(text: &str) -> StudyErrors {
    Study::read(text, Format::Toml, Some(&here("studies"))).expect_err("the study has mistakes")
}

#[test]
fn all_mistakes_of_a_file_are_reported_at_once_with_their_lines() {
    let mut text = main_text();
    for (from, to) in [
        ("bore = \"170 mm\"", "bore = 170"),
        ("throw = \"107.5 mm\"", "throw = \"107.5 kg\""),
        ("oscillating_mass = \"11.5 kg\"", "oscilating_mass = \"11.5 kg\""),
        ("density_15c = \"895 kg/m3\"\n", ""),
        ("speed = \"1500 rpm\"", "speed = \"1500\""),
        ("upper = \"65 mm\"", "upper = \"40 mm\""),
        ("name = \"big_end.diameter\"", "name = \"bigend.diameter\""),
        ("at_most = \"300 MPa\"", "at_least = \"300 MPa\""),
        ("quantity = \"specific-load\"", "quantity = \"specific-weight\""),
        ("kind = \"big-end\"", "kind = \"big-end\"\nmain_bearing = 2"),
        ("\"oil.inlet_temperature\" =", "\"oil.outlet_temperature\" ="),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let found = errors(&text);
    let list: Vec<String> = found
        .faults
        .iter()
        .map(|f| format!("line {}: {}: {}", f.line.unwrap_or(0), f.path, f.message))
        .collect();
    insta::assert_snapshot!(list.join("\n"));
}

#[test]
fn each_kind_of_mistake_has_its_words() {
    let one = |from: &str, to: &str| {
        let text = main_text();
        assert!(text.contains(from), "{from}");
        let list = errors(&text.replacen(from, to, 1)).faults;
        list.iter().map(|f| format!("{}: {}", f.path, f.message)).collect::<Vec<_>>().join(" | ")
    };
    let cases = [
        ("format = \"stribeck-study/1\"", "format = \"stribeck-study/9\""),
        ("[[parameters]]\nname = \"big_end.width\"", "[[parameters]]\nname = \"big_end.depth\""),
        ("[bearings.big_end]", "[bearings.\"big end\"]"),
        ("table.file = \"data/engine_pressure_170x215_digitised.csv\"", "table.file = \"data/none.csv\""),
        (
            "table.file = \"data/engine_pressure_170x215_digitised.csv\"",
            "table.columns = [\"a\"]\ntable.rows = [[1.0], [2.0]]",
        ),
        ("throw_over_rod = 0.274", "throw_over_rod = 1.4"),
        ("throw_over_rod = 0.274", "throw_over_rod = 0.274\nrod_length = \"0.4 m\""),
        ("kinematic_viscosity_100c = \"14 mm2/s\"", "kinematic_viscosity_100c = \"140 mm2/s\""),
        ("diametral_clearance = \"110 um\"", "diametral_clearance = \"11 mm\""),
        ("diametral_clearance = \"110 um\"", "diametral_clearance = \"-110 um\""),
        ("[oil]", "[film]\ncells_around = 4\nmodel = \"jfo\"\n[oil]"),
        ("[oil]", "[film]\nmodel = \"mobility\"\ncells_around = 72\n[oil]"),
        ("[oil]", "[gradient]\nengine = \"FD\"\n[oil]"),
        ("upper = \"90 degC\"", "upper = \"74 degC\""),
        ("at_least = \"3 um\"", "at_least = \"3 um\"\nat_most = \"4 um\""),
        ("quantity = \"min-film-thickness\"", "quantity = \"min-film-thickness\"\nbearing = \"main\""),
        ("kind = \"big-end\"", "kind = \"main\"\nmain_bearing = 1"),
        ("bore = \"170 mm\"", "bore = \"170 mm\"\nthrow_angles = [\"0 deg\", 5]"),
        (
            "table.file = \"data/engine_pressure_170x215_digitised.csv\"",
            "table.file = \"../operational-170x215.toml\"",
        ),
        (
            "table.file = \"data/engine_pressure_170x215_digitised.csv\"",
            "table.columns = [\"crank_angle_deg\", \"pressure_mpa\"]\ntable.rows = [[0.0, 1.0], [20.0, 2.0], [340.0, 1.0]]",
        ),
        (
            "[oil]",
            "[film]\ncells_around = 2000\ncells_across_half = 200\n[orbit]\nsteps_per_cycle = 100000\n[oil]",
        ),
        ("speed = \"1500 rpm\"", "speed = \"-1500 rpm\""),
        ("upper = \"180 um\"", "upper = \"180 mm\""),
        ("upper = \"65 mm\"", "upper = 65"),
        ("density_15c = \"895 kg/m3\"", "density_15c = nan"),
        ("kind = \"big-end\"", "kind = \"main\"\nmain_bearing = 9"),
        (
            "throw = \"107.5 mm\"",
            "throw = \"107.5 mm\"\nthrow_angles = [\"0 deg\", \"90 deg\"]\nfiring_order = [\"A1\", \"B1\"]",
        ),
        ("title = ", "title = \"twice\"\ntitle = "),
    ];
    let list: Vec<String> = cases.iter().map(|(from, to)| format!("{to:?}\n    {}", one(from, to))).collect();
    insta::assert_snapshot!(list.join("\n"));
}

#[test]
fn json_is_read_as_strictly_as_toml() {
    let read = |text: &str| Study::read(text, Format::Json, None).err().unwrap();
    for (text, words) in [
        ("", "empty"),
        ("{ \"format\": 1e999 }", "out of range"),
        ("{ \"format\": \"a\", \"format\": \"b\" }", "twice"),
        ("{ // comment\n }", "omment"),
        ("[1, 2]", "table of sections"),
        ("{}", "is missing"),
    ] {
        let faults = read(text).faults;
        assert!(faults.iter().any(|f| f.message.contains(words)), "{text}: {faults:?}");
    }
}

#[test]
fn a_study_from_the_network_reads_no_files() {
    let faults = Study::read(&main_text(), Format::Toml, None).err().unwrap().faults;
    assert!(
        faults
            .iter()
            .any(|f| f.path == "cylinder_pressure.table.file" && f.message.contains("cannot be read here"))
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn mutated_studies_never_panic(cut in 0usize..4000, length in 0usize..40, insert in "\\PC{0,12}") {
        let text = main_text();
        let chars: Vec<char> = text.chars().collect();
        let (from, to) = (cut.min(chars.len()), (cut + length).min(chars.len()));
        let mutated: String = chars[..from].iter().copied().chain(insert.chars()).chain(chars[to..].iter().copied()).collect();
        let _ = Study::read(&mutated, Format::Toml, Some(&here("studies")));
    }

    #[test]
    fn any_text_is_refused_without_panic(text in "\\PC{0,200}") {
        prop_assert!(Study::read(&text, Format::Toml, None).is_err());
        prop_assert!(Study::read(&text, Format::Json, None).is_err());
    }

    #[test]
    fn swapped_values_never_panic(pick in 0usize..200, value in prop_oneof![
        Just("0"), Just("-1"), Just("\"\""), Just("\"1e308 m\""), Just("[]"), Just("{}"), Just("true"), Just("\"nan mm\""), Just("1e300"),
    ]) {
        let text = main_text();
        let lines: Vec<&str> = text.lines().collect();
        let keyed: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ") && !lines[i].starts_with('#')).collect();
        let line = keyed[pick % keyed.len()];
        let key = lines[line].split(" = ").next().unwrap();
        let mut changed: Vec<String> = lines.iter().map(|l| (*l).to_owned()).collect();
        changed[line] = format!("{key} = {value}");
        let _ = Study::read(&changed.join("\n"), Format::Toml, Some(&here("studies")));
    }
}

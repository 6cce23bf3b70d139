//! `stribeck describe` as people and programs meet it: nothing the program knows is left out.

use crate::common::here;
use assert_cmd::Command;
use serde_json::Value;
use std::time::Duration;
use stribeck::gradient::EngineName;
use stribeck::study::{Format, QuantityName, Study};

fn stribeck(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("stribeck").unwrap();
    command.timeout(Duration::from_secs(60)).env("NO_COLOR", "1").arg("describe").args(arguments);
    command
}

fn printed(arguments: &[&str]) -> String {
    let run = stribeck(arguments).assert().success();
    String::from_utf8(run.get_output().stdout.clone()).unwrap()
}

fn listed(arguments: &[&str]) -> Vec<Value> {
    let json = stribeck(arguments).arg("--json").assert().success().get_output().stdout.clone();
    serde_json::from_slice(&json).unwrap()
}

fn texts(list: &[Value], key: &str) -> Vec<String> {
    list.iter().map(|entry| entry[key].as_str().unwrap().to_owned()).collect()
}

fn path(name: &str) -> String {
    here(name).to_str().unwrap().to_owned()
}

fn study(name: &str) -> Study {
    let text = std::fs::read_to_string(here(name)).unwrap();
    Study::read(&text, Format::Toml, Some(&here("studies"))).unwrap()
}

#[test]
fn every_engine_quantity_and_method_is_listed() {
    let engines = EngineName::ALL.map(EngineName::as_str);
    let quantities = QuantityName::ALL.map(QuantityName::key);
    let methods = ["sqp", "augmented-lagrangian", "cobyla"];
    for (topic, keys) in
        [("engines", &engines[..]), ("quantities", &quantities[..]), ("methods", &methods[..])]
    {
        assert_eq!(texts(&listed(&[topic]), "key"), keys, "{topic}");
        let text = printed(&[topic]);
        for key in keys {
            assert!(text.contains(key), "{key} in {text}");
        }
    }
    let adjoint = &listed(&["engines"])[4];
    assert_eq!((adjoint["default"].as_bool(), adjoint["exact"].as_bool()), (Some(true), Some(true)));
    assert!(adjoint["cost"].as_str().unwrap().contains("independent of n_p"));
    let film = &listed(&["quantities"])[1];
    assert_eq!((film["unit"].as_str(), film["at_most"].as_bool()), (Some("um"), Some(false)));
}

#[test]
fn every_word_of_the_study_file_that_chooses_a_law_is_listed() {
    let schema = stribeck::study::schema();
    let chosen = texts(&listed(&["laws"]), "chosen_by");
    for (key, words) in [
        ("film.model", "FilmModelName"),
        ("film.cavitation", "CavitationName"),
        ("film.cavity_shear", "CavityShearName"),
        ("oil.viscosity_law", "ViscosityLawName"),
        ("oil.piezoviscosity", "PiezoviscosityName"),
        ("oil.compressibility", "CompressibilityName"),
        ("oil.shear_thinning", "ShearThinningName"),
        ("bearings.NAME.roughness.contact", "ContactName"),
        ("bearings.NAME.roughness.contact_integral", "ContactIntegralName"),
        ("bearings.NAME.shapes[*].kind", "ShapeKind"),
        ("orbit.scheme", "SchemeName"),
        ("experiments.plan", "PlanName"),
    ] {
        let list = schema["$defs"][words]["oneOf"].as_array().unwrap();
        assert!(list.len() > 1, "{words}");
        for word in texts(list, "const") {
            let wanted = format!("{key} = \"{word}\"");
            assert!(chosen.contains(&wanted), "{wanted}");
        }
    }
    for grade in stribeck::laws::GRADES {
        assert!(chosen.contains(&format!("oil.grade = \"{}\"", grade.name)), "{}", grade.name);
    }
}

#[test]
fn laws_of_a_study_are_those_of_its_report_with_full_references() {
    let file = path("studies/operational-170x215.toml");
    let used = listed(&["laws", &file]);
    let names = texts(&used, "name");
    for name in ["mass-conserving rupture and reformation", "Walther", "ADJ, discrete adjoint"] {
        assert!(names.iter().any(|n| n == name), "{name} in {names:?}");
    }
    assert!(!names.iter().any(|n| n == "Carreau"), "{names:?}");
    assert!(used.len() < listed(&["laws"]).len());
    let text = printed(&["laws", &file]);
    for words in
        ["film.cavitation = \"mass-conserving\"", "O. Reynolds: On the theory of lubrication", "reference"]
    {
        assert!(text.contains(words), "{words} in {text}");
    }
    let reynolds = used.iter().find(|law| law["source"] == "Reynolds 1886").unwrap();
    assert!(
        reynolds["references"][0].as_str().unwrap().starts_with("O. Reynolds: On the theory of lubrication")
    );
}

#[test]
fn parameters_of_a_study_are_listed_with_their_values_and_boxes() {
    for name in
        ["studies/operational-170x215.toml", "studies/gradient-engines.toml", "studies/running-in-28-33.toml"]
    {
        let (study, list) = (study(name), listed(&["parameters", &path(name)]));
        let of = |wanted: &str| {
            let found = list.iter().find(|entry| entry["name"] == wanted);
            found.unwrap_or_else(|| panic!("{name}: {wanted} is not listed"))
        };
        for p in &study.parameters {
            let (entry, v) = (of(&p.name), p.variable);
            assert_eq!(entry["unit"], v.unit, "{}", p.name);
            for (found, si) in
                [(&entry["bounds"][0], p.lower), (&entry["bounds"][1], p.upper), (&entry["start"], p.start)]
            {
                let expected = v.shown(si);
                assert!(
                    (found.as_f64().unwrap() - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                    "{entry}"
                );
            }
        }
        for given in study.file.parameters.value().unwrap() {
            let entry = of(given.value().unwrap().name.value().unwrap());
            assert!(entry["bounds"].is_array() && entry["allowed"].is_array(), "{entry}");
        }
        let others = list.iter().any(|entry| entry.get("bounds").is_none());
        assert!(others, "{name}: what is no parameter yet is listed too");
    }
    let text = printed(&["parameters", &path("studies/gradient-engines.toml")]);
    assert!(
        text.contains("big_end.shapes.free.coefficients[*]") && !text.contains("coefficients[0]"),
        "{text}"
    );
}

#[test]
fn patterns_of_parameters_need_no_study() {
    let names = texts(&listed(&["parameters"]), "name");
    for name in [
        "<bearing>.width",
        "<bearing>.roughness.journal",
        "<bearing>.supply.pressure",
        "<bearing>.shapes.<shape>.coefficients[*]",
        "oil.inlet_temperature",
        "running_in.<stage>.duration",
    ] {
        assert!(names.iter().any(|n| n == name), "{name} in {names:?}");
    }
    assert!(printed(&["parameters"]).contains("<bearing>.diametral_clearance"));
}

#[test]
fn tables_stay_readable_in_a_pipe() {
    for topic in ["laws", "engines", "quantities", "parameters", "methods"] {
        let text = printed(&[topic]);
        assert!(!text.contains('\u{1b}'), "no colours into a pipe");
        for line in text.lines() {
            assert!(line.chars().count() <= 120 && line == line.trim_end(), "{topic}: {line:?}");
        }
    }
}

#[test]
fn what_cannot_be_described_has_its_exit_code() {
    let file = path("studies/operational-170x215.toml");
    stribeck(&["engines", &file]).assert().code(2);
    stribeck(&["parameters", "no-such-file.toml"]).assert().code(1);
    stribeck(&["weather"]).assert().code(2);
    let folder = tempfile::tempdir().unwrap();
    let wrong = folder.path().join("study.toml");
    std::fs::write(&wrong, "format = \"stribeck-study/1\"\n").unwrap();
    let refused = stribeck(&["laws", wrong.to_str().unwrap(), "--json"]).assert().code(2);
    let faults: Vec<Value> = serde_json::from_slice(&refused.get_output().stdout).unwrap();
    assert!(!faults.is_empty());
}

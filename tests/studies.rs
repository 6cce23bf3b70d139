//! The gallery: every study says what it asks, how it is run and which figures it must reproduce, and reproduces them on its coarse
//! setting. `STRIBECK_FULL_GALLERY=1` runs the full settings instead (a quarter of an hour).

use crate::common::here;
use assert_cmd::Command;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Duration;

/// Studies every gallery must have.
const WANTED: [&str; 12] = [
    "operational-170x215",
    "operational-28-33",
    "operational-35-44",
    "running-in-28-33",
    "gradient-engines",
    "stribeck-curve",
    "profile-200",
    "pareto",
    "robust",
    "convergence",
    "steady-tables",
    "mobility-quick",
];

fn studies() -> Vec<PathBuf> {
    let files = std::fs::read_dir(here("studies")).unwrap().map(|e| e.unwrap().path());
    let mut all: Vec<PathBuf> = files.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    all.sort();
    all
}

/// The reports of the whole gallery, made once.
pub fn gallery() -> &'static tempfile::TempDir {
    static DONE: OnceLock<tempfile::TempDir> = OnceLock::new();
    DONE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let mut run = Command::cargo_bin("stribeck").unwrap();
        run.timeout(Duration::from_secs(3000))
            .arg("run")
            .arg(here("studies"))
            .arg("--out")
            .arg(folder.path());
        if std::env::var_os("STRIBECK_FULL_GALLERY").is_none() {
            run.arg("--coarse");
        }
        let run = run.assert();
        let out = run.get_output();
        println!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
        run.success();
        folder
    })
}

#[test]
fn every_study_opens_with_its_question_its_command_and_its_figures() {
    let names: BTreeSet<String> =
        studies().iter().map(|p| p.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    for wanted in WANTED {
        assert!(names.contains(wanted), "{wanted}");
    }
    for path in studies() {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy();
        let head: Vec<&str> = text.lines().take_while(|l| l.starts_with('#')).collect();
        assert!(head[0].contains('?'), "{name} asks nothing: {}", head[0]);
        let command = format!("cargo run --release -- run studies/{name}.toml");
        assert!(head.iter().any(|l| l.contains(&command)), "{name} does not say: {command}");
        let sections: Vec<&str> = text.lines().filter(|l| l.starts_with('[')).collect();
        assert_eq!(sections[0], "[expected]", "{name} does not open with its figures");
        let figures =
            text.lines().skip_while(|l| *l != "[expected]").skip(1).take_while(|l| l.starts_with('"'));
        assert!(figures.count() >= 2, "{name} reproduces too little");
        assert!(sections.contains(&"[coarse]"), "{name} has no coarse setting");
    }
}

#[test]
fn every_study_reproduces_its_figures() {
    let folder = gallery().path();
    for path in studies() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(folder.join(&name).join("report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        let expected = report["expected"].as_array().unwrap();
        assert!(!expected.is_empty(), "{name}");
        for e in expected {
            assert_eq!(e["met"], true, "{name}: {e}");
        }
    }
}

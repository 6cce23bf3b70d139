//! The command line as users meet it.

use crate::common::{COARSE, SMOOTH, copied_study, here, stribeck};
use std::path::PathBuf;
use std::time::Duration;

/// A copy of the smooth study, changed as text, in a folder of its own with its data.
fn study(folder: &tempfile::TempDir, changes: &[(&str, &str)]) -> PathBuf {
    copied_study(folder.path(), SMOOTH, changes)
}

const QUICK: (&str, &str) = ("[oil]", COARSE);

#[test]
fn run_writes_its_folder_and_ends_with_zero_for_a_converged_design() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("answer");
    let file = study(&folder, &[QUICK]);
    let run = stribeck().arg("run").arg(&file).arg("--out").arg(&out).assert().success();
    let text = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    for words in ["converged", "big_end.width", "mean friction loss", "min-film-thickness", "report.html"] {
        assert!(text.contains(words), "{words} in {text}");
    }
    assert!(!text.contains('\u{1b}'), "no colours into a pipe");
    assert!(run.get_output().stderr.is_empty(), "no progress into a pipe");
    for name in ["report.html", "report.json", "orbit.csv"] {
        assert!(out.join(name).metadata().unwrap().len() > 1000, "{name}");
    }
    let orbit = std::fs::read_to_string(out.join("orbit.csv")).unwrap();
    assert_eq!(orbit.lines().count(), 1 + 240);
    let json = stribeck().arg("run").arg(&file).arg("--json").arg("--out").arg(&out).assert().success();
    let printed: serde_json::Value = serde_json::from_slice(&json.get_output().stdout).unwrap();
    assert_eq!(printed["outcome"]["status"], "converged");
}

#[test]
fn outcomes_have_their_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("answer");
    let infeasible = study(&folder, &[QUICK, ("at_least = \"3 um\"", "at_least = \"30 um\"")]);
    stribeck().arg("run").arg(infeasible).arg("--out").arg(&out).assert().code(6);
    let short = study(&folder, &[QUICK, ("[oil]", "[optimiser]\nmax_iterations = 1\n[oil]")]);
    stribeck().arg("run").arg(short).arg("--out").arg(&out).assert().code(4);
    let impossible = study(
        &folder,
        &[
            QUICK,
            ("steps_per_cycle = 240", "steps_per_cycle = 240\nmax_cycles = 2\nperiodicity_tolerance = 1e-14"),
        ],
    );
    stribeck().arg("run").arg(impossible).arg("--out").arg(&out).assert().code(7);
    assert!(out.join("report.html").exists(), "a failed start is reported too");
    stribeck().arg("run").arg("no-such-file.toml").assert().code(1);
    stribeck().arg("walk").assert().code(2);
}

#[test]
fn a_checked_study_is_complete_and_checks_again_with_the_same_hash() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(&folder, &[]);
    let first = stribeck().arg("check").arg(&file).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(first).unwrap();
    for default in [
        "cells_around = 72",
        "scheme = \"bdf2\"",
        "start = \"55 mm\"",
        "engine = \"ADJ\"",
        "piston_pin_offset = \"0 mm\"",
    ] {
        assert!(text.contains(default), "{default}");
    }
    std::fs::write(&file, &text).unwrap();
    let second = stribeck().arg("check").arg(&file).assert().success().get_output().stdout.clone();
    assert_eq!(text, String::from_utf8(second).unwrap());
    let json =
        stribeck().arg("check").arg("--json").arg(&file).assert().success().get_output().stdout.clone();
    let as_json = folder.path().join("study.json");
    std::fs::write(&as_json, json).unwrap();
    let third = stribeck().arg("check").arg(&as_json).assert().success().get_output().stdout.clone();
    assert_eq!(text, String::from_utf8(third).unwrap());
}

#[test]
fn the_schema_accepts_the_study_and_refuses_what_the_check_refuses() {
    let schema = stribeck().arg("schema").assert().success().get_output().stdout.clone();
    let validator = jsonschema::validator_for(&serde_json::from_slice(&schema).unwrap()).unwrap();
    let file = here("studies/operational-170x215.toml");
    let json = stribeck().arg("check").arg("--json").arg(file).assert().success().get_output().stdout.clone();
    let mut study: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let mistakes: Vec<String> =
        validator.iter_errors(&study).map(|e| format!("{e} at {}", e.instance_path)).collect();
    assert!(mistakes.is_empty(), "{mistakes:?}");
    study["machine"]["bore"] = 170.into();
    assert!(!validator.is_valid(&study), "a bare number");
    study["machine"]["bore"] = "170 mm".into();
    study["machine"]["bores"] = "170 mm".into();
    assert!(!validator.is_valid(&study), "an unknown key");
}

#[test]
fn gradient_prints_the_engines_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(&folder, &[QUICK]);
    let all = stribeck().arg("gradient").arg(&file).args(["--engine", "all"]).assert().success();
    let text = String::from_utf8_lossy(&all.get_output().stdout).into_owned();
    for words in
        ["FW", "BW", "CEN", "TRA", "ADJ", "error against ADJ", "factorisations", "d mean-friction-loss"]
    {
        assert!(text.contains(words), "{words}");
    }
    let one =
        stribeck().arg("gradient").arg(&file).arg("--json").assert().success().get_output().stdout.clone();
    let json: serde_json::Value = serde_json::from_slice(&one).unwrap();
    assert_eq!(json[0]["rows"][0]["engine"], "ADJ");
}

/// Starts a run, interrupts it after a while, and returns its report.
#[cfg(unix)]
fn interrupted(file: &std::path::Path, out: &std::path::Path, after: Duration) -> serde_json::Value {
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("stribeck"))
        .arg("run")
        .arg(file)
        .arg("--out")
        .arg(out)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(after);
    assert_eq!(child.try_wait().unwrap(), None, "the run takes longer than {after:?}");
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(out.join("report.html").exists() && out.join("orbit.csv").exists());
    serde_json::from_slice(&std::fs::read(out.join("report.json")).unwrap()).unwrap()
}

#[cfg(unix)]
#[test]
fn ctrl_c_writes_what_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (study(&folder, &[]), folder.path().join("answer"));
    // How long the start design takes depends on the machine: wait longer until it is among what is known.
    for seconds in [2, 4, 8, 16, 32] {
        let report = interrupted(&file, &out, Duration::from_secs(seconds));
        assert_eq!(report["outcome"]["status"], "cancelled");
        assert_eq!(report["design"].as_array().unwrap().len(), 4);
        if report["objective"]["optimum"]["total_w"].as_f64().is_some_and(|w| w > 0.0) {
            return;
        }
        assert!(report["history"].as_array().unwrap().is_empty(), "an accepted design is reported");
    }
    panic!("the best design so far is never reported");
}

#[test]
fn gradient_check_says_what_it_found_and_counts_weakly_active_cells() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(&folder, &[QUICK]);
    let check = stribeck().arg("gradient").arg(&file).arg("--check").assert().code(0);
    let text = String::from_utf8_lossy(&check.get_output().stdout).into_owned();
    for words in [
        "TRA against ADJ",
        "best CEN",
        "mean-friction-loss: exact: TRA = ADJ",
        "weakly active cells: ",
        "change behind",
        "error against ADJ over the perturbation",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
    let out = folder.path().join("check.json");
    let json =
        stribeck().arg("gradient").arg(&file).args(["--check", "--json", "--out"]).arg(&out).assert().code(0);
    let json: serde_json::Value = serde_json::from_slice(&json.get_output().stdout).unwrap();
    assert_eq!(json, serde_json::from_slice::<serde_json::Value>(&std::fs::read(&out).unwrap()).unwrap());
    assert!(json[0]["weakly_active_cells"].is_u64());
    assert_eq!(json[0]["quantities"][0]["finding"], "exact");
    assert_eq!(json[0]["quantities"][0]["differences"].as_array().unwrap().len(), 3 * 6);
    let plain =
        stribeck().arg("gradient").arg(&file).arg("--json").assert().success().get_output().stdout.clone();
    let plain: serde_json::Value = serde_json::from_slice(&plain).unwrap();
    assert_eq!(plain[0]["weakly_active_cells"], json[0]["weakly_active_cells"]);
    stribeck().arg("gradient").arg(&file).args(["--check", "--engine", "all"]).assert().code(2);
    let help = stribeck().arg("--help").assert().success().get_output().stdout.clone();
    assert!(String::from_utf8_lossy(&help).contains("9 a checked gradient is wrong"));
}

#[test]
fn run_compares_engines_if_the_study_asks_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("answer");
    let comparison = "[comparison]\nperturbations = [1e-5, 1e-6]\nparameter_counts = [2]\n[oil]";
    let file = study(&folder, &[QUICK, ("[oil]", comparison)]);
    let run = stribeck().arg("run").arg(&file).arg("--out").arg(&out).assert().code(0);
    let text = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    for words in ["exact: TRA = ADJ", "2 parameters: CEN / ADJ:", "time / simulation", "report.html"] {
        assert!(text.contains(words), "{words} in {text}");
    }
    for name in
        ["report.html", "report.json", "gradients.csv", "errors.csv", "taylor.csv", "cost.csv", "timing.csv"]
    {
        assert!(out.join(name).metadata().unwrap().len() > 100, "{name}");
    }
}

#[test]
fn several_starts_and_rivals_are_reported_and_a_budget_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("answer");
    let many = "[optimiser]\nstarts = 4\nrivals = [{ method = \"augmented-lagrangian\" }, { method = \"cobyla\" }]\n[oil]";
    let file = study(&folder, &[QUICK, ("[oil]", many)]);
    let run = stribeck().arg("run").arg(&file).arg("--json").arg("--out").arg(&out).assert().success();
    let report: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let optima = report["starts"]["optima"].as_array().unwrap();
    assert_eq!(report["starts"]["same_loss"], optima.len() == 1);
    assert_eq!(optima.iter().map(|o| o["found"].as_u64().unwrap()).sum::<u64>(), 4, "{optima:#?}");
    let best = report["objective"]["optimum"]["total_w"].as_f64().unwrap();
    assert!((optima[0]["loss_w"].as_f64().unwrap() / best - 1.0).abs() < 1e-9);
    let rivals = report["rivals"].as_array().unwrap();
    assert_eq!(rivals.len(), 3, "its own search is the first");
    for rival in rivals {
        let loss = rival["loss_w"].as_f64().unwrap();
        assert!((loss / best - 1.0).abs() < 1e-3 && rival["violation"].as_f64().unwrap() < 1e-4, "{rival}");
    }
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Searches from 4 starts") && page.contains("The same search by other methods"));
    let short = study(&folder, &[QUICK, ("[oil]", "[optimiser]\nmax_simulations = 3\n[oil]")]);
    stribeck().arg("run").arg(short).arg("--out").arg(&out).assert().code(10);
}

#[test]
fn a_front_is_reported_as_table_page_and_csv() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("answer");
    let front =
        "[pareto]\nquantity = \"min-film-thickness\"\nat_least = [\"3 um\", \"2 um\", \"90 um\"]\n[oil]";
    let file = study(&folder, &[QUICK, ("[oil]", front)]);
    let run = stribeck().arg("run").arg(&file).arg("--json").arg("--out").arg(&out).assert().success();
    let report: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let points = report["pareto"]["points"].as_array().unwrap();
    let number = |k: usize, key: &str| points[k][key].as_f64();
    assert_eq!([0, 1, 2].map(|k| number(k, "limit").unwrap()), [2.0, 3.0, 90.0]);
    assert!(number(0, "loss_w").unwrap() < number(1, "loss_w").unwrap());
    assert!(number(2, "loss_w").is_none() && points[2]["status"] == "infeasible");
    // The study's own limit is one of the points, and its price the slope of the front there.
    let best = report["objective"]["optimum"]["total_w"].as_f64().unwrap();
    assert!((number(1, "loss_w").unwrap() / best - 1.0).abs() < 1e-6);
    assert!(number(1, "price_w_per_unit").unwrap() > 0.0);
    let csv = std::fs::read_to_string(out.join("pareto.csv")).unwrap();
    assert!(
        csv.starts_with("min_film_thickness_um,loss_w,price_w_per_um,status,") && csv.lines().count() == 4
    );
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Loss over min film thickness"));
    let wrong =
        "[pareto]\nquantity = \"min-film-thickness\"\nat_least = [\"3 um\", \"3 um\", \"3 bar\"]\n[oil]";
    let wrong = study(&folder, &[QUICK, ("[oil]", wrong)]);
    let refused = stribeck().arg("check").arg(wrong).assert().code(2);
    let text = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(text.contains("pareto.at_least[1]") && text.contains("pareto.at_least[2]"), "{text}");
}

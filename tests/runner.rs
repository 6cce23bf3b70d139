//! The runner: folders, what was computed before, experiments that are killed, keys that are set, work that is estimated.

use crate::common::{COARSE, SMOOTH, copied_study, here, stribeck};
use assert_cmd::Command;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

fn out_of(command: &mut Command) -> String {
    String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap()
}

/// A small study of a bearing under a constant load, with more at its end.
fn drive(folder: &Path, name: &str, more: &str) -> PathBuf {
    let page = std::fs::read_to_string(here("api.md")).unwrap();
    let mut blocks = page.split("```toml\n").skip(1).filter_map(|b| b.split("```").next());
    let text = blocks.find(|b| b.starts_with("format")).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, format!("{text}\n{more}")).unwrap();
    path
}

const GRID: &str = "[experiments]
[[experiments.factors]]
key = \"bearings.drive.diametral_clearance\"
values = [\"80 um\", \"100 um\", \"120 um\"]
[[experiments.factors]]
key = \"oil.grade\"
values = [\"ISO VG 32\", \"ISO VG 46\"]
";

fn report(folder: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("report.json")).unwrap()).unwrap()
}

#[test]
fn a_grid_holds_every_combination_and_finds_the_best_that_is_safe() {
    let folder = tempfile::tempdir().unwrap();
    let file = drive(folder.path(), "grid.toml", GRID);
    let out = folder.path().join("out");
    let text = out_of(stribeck().arg("run").arg(&file).arg("--out").arg(&out));
    assert!(text.contains("The least loss with all limits kept"), "{text}");
    let found = report(&out);
    assert_eq!(found["status"], "complete");
    let runs = found["runs"].as_array().unwrap();
    let levels: Vec<String> = runs.iter().map(|r| r["levels"].to_string()).collect();
    assert_eq!(levels[0], "[\"80\",\"ISO VG 32\"]");
    assert_eq!(levels[5], "[\"120\",\"ISO VG 46\"]");
    // Every run is what the study itself gives with the keys set.
    let one = folder.path().join("one");
    let plain = drive(folder.path(), "plain.toml", "");
    let set = ["--set", "bearings.drive.diametral_clearance=100 um", "--set", "oil.grade=ISO VG 32"];
    stribeck().arg("run").arg(&plain).args(set).arg("--simulate").arg("--out").arg(&one).assert().success();
    let alone = report(&one);
    assert_eq!(alone["objective"]["optimum"]["total_w"], runs[2]["responses"][0]);
    assert_eq!(alone["study_hash"], runs[2]["study_hash"]);
    // The best keeps all limits and no other that does loses less.
    let loss = |r: &Value| r["responses"][0].as_f64().unwrap();
    let safe = runs.iter().filter(|r| r["feasible"] == true);
    let least = safe.min_by(|a, b| loss(a).total_cmp(&loss(b))).unwrap();
    assert_eq!(found["best"], least["number"]);
    assert_eq!(std::fs::read_to_string(out.join("experiments.csv")).unwrap().lines().count(), 7);
}

#[test]
fn drawn_experiments_lie_within_their_bounds_and_searches_find_a_design_each() {
    let folder = tempfile::tempdir().unwrap();
    for plan in ["latin-hypercube", "sobol"] {
        let more = format!(
            "[experiments]\nplan = \"{plan}\"\nruns = 4\neach = \"search\"\n[[experiments.factors]]\n\
             key = \"bearings.drive.force\"\nlower = \"15 kN\"\nupper = \"25 kN\"\n[[experiments.factors]]\n\
             key = \"film.cells_around\"\nlower = 44\nupper = 52\n"
        );
        let file = drive(folder.path(), &format!("{plan}.toml"), &more);
        let out = folder.path().join(plan);
        stribeck().arg("run").arg(&file).arg("--out").arg(&out).assert().success();
        let found = report(&out);
        let key = |k: &Value| k["key"].as_str().unwrap().to_owned();
        let responses: Vec<String> = found["responses"].as_array().unwrap().iter().map(key).collect();
        let width = responses.iter().position(|k| k == "drive.width").unwrap();
        for run in found["runs"].as_array().unwrap() {
            assert_eq!(run["status"], "converged", "{run}");
            let [force, cells] = [0, 1].map(|j| run["numbers"][j].as_f64().unwrap());
            assert!((15.0..=25.0).contains(&force) && (44.0..=52.0).contains(&cells) && cells.fract() == 0.0);
            assert!((30.0..=60.0).contains(&run["responses"][width].as_f64().unwrap()));
        }
    }
}

#[test]
fn a_rerun_computes_only_what_changed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let file = drive(folder.path(), "study.toml", GRID);
    let run = |file: &Path| out_of(stribeck().arg("run").arg(file).arg("--out").arg(&out));
    let first = run(&file);
    let again = run(&file);
    assert!(again.contains("computed before") && !first.contains("computed before"));
    assert_eq!(first.lines().take(12).collect::<Vec<_>>(), again.lines().take(12).collect::<Vec<_>>());
    // One level more: six runs are known, two are new; the old ones are the same to the last bit.
    let old = report(&out);
    let wider = GRID.replace("\"120 um\"", "\"120 um\", \"140 um\"");
    let file = drive(folder.path(), "study.toml", &wider);
    let plan = out_of(stribeck().arg("run").arg(&file).arg("--out").arg(&out).args(["--dry-run", "--json"]));
    let plan: Value = serde_json::from_str(&plan).unwrap();
    assert_eq!(
        (plan[0]["estimate"]["kept"].as_u64(), plan[0]["estimate"]["cycles"].as_f64()),
        (Some(6), Some(2.0))
    );
    assert!(!run(&file).contains("computed before"));
    let new = report(&out);
    for (a, b) in old["runs"].as_array().unwrap().iter().zip(new["runs"].as_array().unwrap()) {
        assert_eq!(a, b);
    }
    assert_eq!(new["runs"].as_array().unwrap().len(), 8);
    // Changed by hand, the report is made again.
    std::fs::write(out.join("experiments.csv"), "nothing").unwrap();
    assert!(!run(&file).contains("computed before"));
    assert!(std::fs::read_to_string(out.join("experiments.csv")).unwrap().lines().count() == 9);
    // And on demand.
    let fresh = out_of(stribeck().arg("run").arg(&file).arg("--out").arg(&out).arg("--fresh"));
    assert!(!fresh.contains("computed before"));
}

#[test]
fn killed_experiments_go_on_to_the_same_report() {
    let folder = tempfile::tempdir().unwrap();
    let more = "[experiments]\nplan = \"latin-hypercube\"\nruns = 6\neach = \"search\"\n\
        [[experiments.factors]]\nkey = \"bearings.drive.force\"\nlower = \"15 kN\"\nupper = \"25 kN\"\n";
    let file = drive(folder.path(), "study.toml", more);
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    stribeck().arg("run").arg(&file).arg("--out").arg(&whole).assert().success();
    let mut process = std::process::Command::new(env!("CARGO_BIN_EXE_stribeck"))
        .arg("run")
        .arg(&file)
        .arg("--out")
        .arg(&killed)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let kept = || std::fs::read_dir(killed.join("kept")).map_or(0, Iterator::count);
    while kept() < 3 && process.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(2));
    }
    process.kill().unwrap();
    process.wait().unwrap();
    assert!(!killed.join("report.json").exists(), "it was over before it could be killed");
    let before = kept();
    stribeck().arg("run").arg(&file).arg("--out").arg(&killed).assert().success();
    assert!(before >= 3 && kept() > before);
    let strip = |folder: &Path| {
        let mut report = report(folder);
        report["timing"] = Value::Null;
        report
    };
    assert_eq!(strip(&whole), strip(&killed));
    let left = std::fs::read_dir(&killed).unwrap().filter(|e| {
        e.as_ref().unwrap().path().extension().is_some_and(|e| e == "checkpoint" || e == "unfinished")
    });
    assert_eq!(left.count(), 0, "a finished run leaves no checkpoint");
}

#[test]
fn a_folder_is_run_with_an_index_and_the_first_bad_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let studies = folder.path().join("studies");
    std::fs::create_dir_all(&studies).unwrap();
    drive(&studies, "a.toml", "[expected]\n\"outcome.status\" = { value = \"converged\" }\n");
    drive(&studies, "b.toml", "[expected]\n\"objective.optimum.total_w\" = { value = 1.0 }\n");
    std::fs::write(studies.join("notes.txt"), "no study").unwrap();
    let out = folder.path().join("out");
    let run = stribeck().arg("run").arg(&studies).arg("--out").arg(&out).assert().code(11);
    let text = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    assert!(text.contains("1 of 1") && text.contains("0 of 1"), "{text}");
    for name in ["index.html", "a/report.html", "b/report.json"] {
        assert!(out.join(name).exists(), "{name}");
    }
    let alone =
        stribeck().arg("run").arg(studies.join("b.toml")).arg("--out").arg(out.join("b")).assert().code(11);
    let text = String::from_utf8_lossy(&alone.get_output().stdout).into_owned();
    assert!(text.contains("objective.optimum.total_w: found"), "{text}");
    // Mistakes of all files are told before anything runs.
    std::fs::write(studies.join("c.toml"), "format = 1").unwrap();
    std::fs::write(studies.join("d.toml"), "bad").unwrap();
    let empty = folder.path().join("none");
    let run = stribeck().arg("run").arg(&studies).arg("--out").arg(&empty).assert().code(2);
    let text = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(text.contains("c.toml") && text.contains("d.toml"), "{text}");
    assert!(!empty.exists());
    std::fs::create_dir_all(&empty).unwrap();
    stribeck().arg("run").arg(&empty).assert().code(1);
}

#[test]
fn keys_are_set_and_the_coarse_setting_counts_where_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let more = "[coarse]\n\"film.cells_around\" = 40\n[expected]\n\
        \"provenance.study.film.cells_around\" = { value = 44, coarse = 40, absolute = 0 }\n";
    let file = drive(folder.path(), "study.toml", more);
    let run = |out: &str, with: &[&str]| {
        let out = folder.path().join(out);
        stribeck().arg("run").arg(&file).args(with).arg("--out").arg(&out).assert().success();
        report(&out)
    };
    let set = run("set", &["--set", "film.cells_around=44"]);
    assert_eq!(set["provenance"]["study"]["film"]["cells_around"], 44);
    let coarse = run("coarse", &["--coarse"]);
    assert_eq!(coarse["provenance"]["study"]["film"]["cells_around"], 40);
    assert_eq!(
        (&coarse["provenance"]["coarse"], &set["provenance"]["coarse"]),
        (&Value::Bool(true), &Value::Bool(false))
    );
    let page = std::fs::read_to_string(folder.path().join("coarse/report.html")).unwrap();
    assert!(page.contains("Coarse setting"));
    let plain = drive(folder.path(), "plain.toml", "");
    let refused = stribeck().arg("run").arg(&plain).arg("--coarse").assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("no coarse setting"));
    for (set, words) in [
        ("film.cells=40", "is not a key of this section"),
        ("bearings.drive.width=40 kg", "expected a length"),
        ("parameters[7].lower=1", "there is no place"),
        ("cells", "expected KEY=VALUE"),
    ] {
        let refused = stribeck().arg("run").arg(&plain).args(["--set", set]).assert().code(2);
        let text = String::from_utf8_lossy(&refused.get_output().stderr).replace('\n', " ");
        assert!(text.contains(words), "{set}: {text}");
    }
}

#[test]
fn programs_get_lines_of_json_and_pipes_get_no_progress() {
    let folder = tempfile::tempdir().unwrap();
    let file = drive(folder.path(), "study.toml", "");
    let out = folder.path().join("out");
    let text = out_of(stribeck().arg("run").arg(&file).arg("--out").arg(&out).arg("--json-lines"));
    let lines: Vec<Value> = text.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let events: Vec<&str> = lines.iter().map(|l| l["event"].as_str().unwrap()).collect();
    for kind in ["stage", "simulated", "film", "iteration"] {
        assert!(events.contains(&kind), "{kind} in {events:?}");
    }
    assert!(lines.iter().all(|l| l["study"] == "study"));
    let iteration = lines.iter().rfind(|l| l["event"] == "iteration").unwrap();
    assert!(iteration["objective_w"].is_f64() && iteration["seconds_left"].is_f64(), "{iteration}");
    let end = lines.last().unwrap();
    assert_eq!(
        (&end["event"], &end["status"], &end["exit_code"]),
        (&"end".into(), &"converged".into(), &0.into())
    );
    assert!(Path::new(end["report"].as_str().unwrap()).exists());
    let quiet = stribeck().arg("run").arg(&file).arg("--out").arg(&out).arg("--fresh").assert().success();
    assert!(quiet.get_output().stderr.is_empty());
}

#[test]
fn work_is_estimated_within_a_factor_of_what_it_becomes() {
    let folder = tempfile::tempdir().unwrap();
    let file = copied_study(folder.path(), SMOOTH, &[("[oil]", COARSE)]);
    let out = folder.path().join("out");
    let plan = out_of(stribeck().arg("run").arg(&file).arg("--out").arg(&out).args(["--dry-run", "--json"]));
    assert!(!out.exists(), "nothing is written");
    let plan: Value = serde_json::from_str(&plan).unwrap();
    let estimate = &plan[0]["estimate"];
    assert_eq!((estimate["cases"].as_u64(), estimate["steps"].as_u64()), (Some(1), Some(240)));
    stribeck().arg("run").arg(&file).arg("--out").arg(&out).assert().success();
    let found = report(&out);
    let count = |part: &Value| part["factorisations"].as_f64().unwrap();
    let per_cycle = (count(&found["cost"]) - count(&found["cost"]["gradients"]))
        / (found["cost"]["simulations"].as_f64().unwrap());
    let cycles = count(&found["cost"]) / per_cycle;
    let ratio = estimate["cycles"].as_f64().unwrap() / cycles;
    assert!((0.3..=4.0).contains(&ratio), "{ratio}: {estimate} against {cycles}");
    let table = out_of(stribeck().arg("run").arg(&file).arg("--out").arg(&out).arg("--dry-run"));
    assert!(
        table.contains("a search over 4 parameters") && table.contains("nothing was computed"),
        "{table}"
    );
}

//! A run that is killed goes on where it was and ends with the same report.

use crate::common::{COARSE, MAIN, copied_study};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, SystemTime};

/// A process that is killed when the test that started it fails.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(file: &Path, out: &Path) -> Running {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stribeck"));
    command.arg("run").arg(file).arg("--out").arg(out).stdout(Stdio::null()).stderr(Stdio::null());
    Running(command.spawn().unwrap())
}

/// The report but for its timing.
fn report(out: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(out.join("report.json")).unwrap();
    let mut report: serde_json::Value = serde_json::from_str(&text).unwrap();
    report["timing"]["seconds"] = serde_json::Value::Null;
    report
}

/// The main study on a coarse mesh, from a corner of its box far from the optimum.
fn study(folder: &Path) -> std::path::PathBuf {
    let changes = [
        ("[oil]", COARSE),
        ("name = \"big_end.width\"", "name = \"big_end.width\"\nstart = \"50 mm\""),
        (
            "name = \"big_end.diametral_clearance\"",
            "name = \"big_end.diametral_clearance\"\nstart = \"90 um\"",
        ),
    ];
    copied_study(folder, MAIN, &changes)
}

#[test]
fn a_killed_run_goes_on_to_the_same_report() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let whole = folder.path().join("whole");
    assert!(start(&file, &whole).0.wait().unwrap().success());
    let wanted = report(&whole);
    let seed = SystemTime::UNIX_EPOCH.elapsed().unwrap().subsec_nanos() as u64;
    println!("seed {seed}");
    for round in 0..3u64 {
        let out = folder.path().join(format!("killed-{round}"));
        let checkpoint = out.join("search.checkpoint");
        let mut killed = 0;
        // Killed twice: at a random moment after the first checkpoint, and again after it has gone on.
        for attempt in 0..2u64 {
            let mut run = start(&file, &out);
            let changed = |since: Option<SystemTime>| {
                checkpoint.metadata().and_then(|m| m.modified()).ok().filter(|t| Some(*t) != since)
            };
            let before = changed(None);
            while changed(before).is_none() && run.0.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_millis(1));
            }
            std::thread::sleep(Duration::from_millis((seed >> (8 * (2 * round + attempt) % 32)) % 97));
            killed += u64::from(run.0.try_wait().unwrap().is_none());
        }
        if round == 0 && checkpoint.exists() {
            // A look at the start in the same folder costs the stopped search nothing.
            let mut simulate = Command::new(env!("CARGO_BIN_EXE_stribeck"));
            simulate.arg("run").arg(&file).arg("--out").arg(&out).arg("--simulate").stdout(Stdio::null());
            assert!(simulate.status().unwrap().success());
            assert!(checkpoint.exists());
        }
        assert!(killed >= 1, "the runs were over before they could be killed");
        assert!(checkpoint.exists() || out.join("report.json").exists());
        assert!(start(&file, &out).0.wait().unwrap().success());
        assert_eq!(report(&out), wanted, "round {round}, seed {seed}");
        assert!(!checkpoint.exists(), "a finished run leaves no checkpoint");
    }
}

#[test]
fn a_checkpoint_of_another_study_or_a_broken_one_is_not_used() {
    let folder = tempfile::tempdir().unwrap();
    let file = study(folder.path());
    let out = folder.path().join("answer");
    std::fs::create_dir_all(&out).unwrap();
    std::fs::write(out.join("search.checkpoint"), b"0.1.0 0123 search\nnothing of use").unwrap();
    assert!(start(&file, &out).0.wait().unwrap().success());
    let first = report(&out);
    let hash = first["study_hash"].as_str().unwrap();
    let head = format!("{} {hash} search\n", env!("CARGO_PKG_VERSION"));
    for broken in [vec![0xff; 400], vec![1, 2, 3], Vec::new()] {
        let all = [head.as_bytes(), &broken].concat();
        std::fs::write(out.join("search.checkpoint"), all).unwrap();
        assert!(start(&file, &out).0.wait().unwrap().success());
        assert_eq!(report(&out), first);
    }
}

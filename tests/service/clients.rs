//! Programs of others against the service: a client of UM-Bridge, a tester of interfaces, a browser. Each where it is installed.

use super::common::{EXAMPLE, Service, tiny};
use crate::common::here;
use serde_json::json;
use std::path::PathBuf;
use std::process::{Command, Output};
use stribeck::service::Limits;

/// The Python of an environment with `umbridge` and `schemathesis`.
fn python() -> Option<PathBuf> {
    let found = std::env::var("STRIBECK_TEST_PYTHON").ok().map(PathBuf::from);
    if found.is_none() {
        println!("skipped: STRIBECK_TEST_PYTHON names no Python with umbridge and schemathesis");
    }
    found
}

fn assert_works(found: &Output) {
    let (out, err) = (String::from_utf8_lossy(&found.stdout), String::from_utf8_lossy(&found.stderr));
    assert!(found.status.success(), "{out}\n{err}");
    println!("{out}");
}

#[test]
fn the_client_of_um_bridge_evaluates_and_differentiates() {
    let Some(python) = python() else { return };
    let service = Service::start(0);
    let job = service.submit(&json!({ "study": tiny() }));
    let script = here("tests/umbridge_client.py");
    assert_works(&Command::new(python).arg(script).args([service.url(""), job]).output().unwrap());
}

#[test]
fn the_interface_keeps_what_its_description_promises() {
    let Some(python) = python() else { return };
    let service = Service::start(1);
    let id = service.submit(&json!({ "study": tiny() }));
    service.ended(&id);
    let folder = tempfile::tempdir().unwrap();
    let found = Command::new(python.with_file_name("schemathesis"))
        .args(["--config-file".into(), here("tests/schemathesis.toml")])
        .args(["run", &service.url("/openapi.json"), "--checks", "all"])
        .args(["--max-examples", "25", "--seed", "1", "--no-color"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_works(&found);
}

/// What a browser shows of a page of the service when it has come to rest.
fn shown(chromium: &str, service: &Service, at: &str, picture: Option<&std::path::Path>) -> String {
    let profile = tempfile::tempdir().unwrap();
    let mut command = Command::new(chromium);
    command.args(["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1280,2000"]);
    command.args(["--virtual-time-budget=15000", "--run-all-compositor-stages-before-draw"]);
    command.arg(format!("--user-data-dir={}", profile.path().display()));
    match picture {
        Some(file) => command.arg(format!("--screenshot={}", file.display())),
        None => command.arg("--dump-dom"),
    };
    let found = command.arg(service.url(&format!("/#/{at}"))).output().unwrap();
    assert!(found.status.success(), "{}", String::from_utf8_lossy(&found.stderr));
    String::from_utf8_lossy(&found.stdout).into_owned()
}

#[test]
fn the_page_works_in_a_browser() {
    let chromium = std::env::var("STRIBECK_TEST_CHROMIUM").unwrap_or_else(|_| "chromium".to_owned());
    if Command::new(&chromium).arg("--version").output().is_err() {
        println!("skipped: there is no {chromium}");
        return;
    }
    let service = Service::with(1, Limits { requests_per_s: None, ..Limits::default() }, false);
    let a = service.submit(&json!({ "kind": "operational", "study": EXAMPLE }));
    let b = service.submit(&json!({ "kind": "operational", "study": tiny() }));
    let (first, second) = (service.ended(&a), service.ended(&b));
    assert_eq!((&first["outcome"], &second["outcome"]), (&json!("converged"), &json!("converged")));
    let report = service.get(&format!("/v1/jobs/{a}/result")).ok(200);
    let loss = report["objective"]["optimum"]["total_w"].as_f64().unwrap();

    let form = shown(&chromium, &service, "new", None);
    for words in ["<fieldset", "diametral_clearance", "<label", "wiebe", "operational"] {
        assert!(form.contains(words), "{words} in {form}");
    }
    let list = shown(&chromium, &service, "jobs", None);
    assert_eq!(list.matches(&format!("#/jobs/{a}")).count().min(1), 1, "{list}");
    let job = shown(&chromium, &service, &format!("jobs/{a}"), None);
    for words in
        [format!("{loss:.0}&nbsp;W"), "converged".to_owned(), "blob:".to_owned(), "orbit.csv".to_owned()]
    {
        assert!(job.contains(&words), "{words} in {job}");
    }
    let both = shown(&chromium, &service, &format!("compare/{a}/{b}"), None);
    assert!(both.contains("side by side") && both.contains("<svg"), "{both}");
    // Something is drawn.
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("job.png");
    shown(&chromium, &service, &format!("jobs/{a}"), Some(&picture));
    assert!(std::fs::metadata(&picture).unwrap().len() > 60_000);
}

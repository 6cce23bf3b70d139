//! Jobs in, designs out.

use super::common::{EXAMPLE, Service, check_job, tiny};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};

/// Events of a stream until it ends: kind and data.
fn events(service: &Service, id: &str, after: Option<u32>) -> Vec<(String, Value)> {
    let mut request = ureq::get(service.url(&format!("/v1/jobs/{id}/events")));
    if let Some(last) = after {
        request = request.header("last-event-id", last.to_string());
    }
    let answer = request.call().unwrap();
    assert_eq!(answer.headers()["content-type"], "text/event-stream");
    let (mut all, mut kind) = (Vec::new(), String::new());
    for line in BufReader::new(answer.into_body().into_reader()).lines().map(Result::unwrap) {
        if let Some(word) = line.strip_prefix("event: ") {
            kind = word.to_owned();
        } else if let Some(data) = line.strip_prefix("data: ") {
            all.push((kind.clone(), serde_json::from_str(data).unwrap()));
        }
    }
    all
}

#[test]
fn a_job_goes_in_and_its_design_comes_out() {
    let service = Service::start(1);
    let answer = service.post("/v1/jobs", &json!({ "kind": "operational", "study": EXAMPLE }));
    let place = answer.headers["location"].to_str().unwrap().to_owned();
    let job = answer.ok(202);
    assert_eq!(place, job["links"]["self"]);
    let id = job["id"].as_str().unwrap();

    // Followed until it ends: stages, accepted designs with film and residual, the end.
    let told = events(&service, id, None);
    let kinds: Vec<&str> = told.iter().map(|(kind, _)| kind.as_str()).collect();
    assert_eq!((kinds[0], kinds[kinds.len() - 1]), ("stage", "end"), "{kinds:?}");
    let iterations: Vec<&Value> = told.iter().filter(|(k, _)| k == "iteration").map(|(_, v)| v).collect();
    assert!(iterations.len() > 2);
    for i in &iterations {
        assert!(
            i["objective_w"].as_f64().unwrap() > 0.0 && i["min_film_thickness_um"].as_f64().unwrap() > 0.0
        );
        assert!(i["violation"].is_number() && i["simulations"].as_u64().unwrap() > 0);
    }
    assert!(iterations.iter().any(|i| i["seconds_left"].is_number()), "{iterations:?}");
    let end = &told[told.len() - 1].1;
    assert_eq!((&end["state"], &end["outcome"]), (&json!("succeeded"), &json!("converged")), "{end}");
    // One who lost the connection hears the rest only.
    let rest = events(&service, id, Some(2));
    assert!(rest.len() < told.len() && rest[rest.len() - 1].0 == "end");

    // The same design as the command line's.
    let report = service.get(&format!("/v1/jobs/{id}/result")).ok(200);
    let study = stribeck::study::Study::read(EXAMPLE, stribeck::study::Format::Toml, None).unwrap();
    let own = crate::common::quietly(|context| stribeck::study::run(&study, context)).report;
    let mut own = serde_json::to_value(&own).unwrap();
    let mut theirs = report.clone();
    for report in [&mut own, &mut theirs] {
        report["timing"]["seconds"] = Value::Null;
    }
    assert_eq!(own["design"], theirs["design"]);
    assert_eq!(own, theirs);

    let page = service.get(&format!("/v1/jobs/{id}/report"));
    assert!(page.status == 200 && page.text.starts_with("<!doctype html>"));
    assert!(page.headers["content-security-policy"].to_str().unwrap().contains("sandbox"));
    let files = service.get(&format!("/v1/jobs/{id}/files")).ok(200);
    let names: Vec<&str> =
        files["files"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    for name in
        ["orbit.csv", "orbit-1.svg", "pressure-map-1.svg", "sensitivity.csv", "shell-1.vts", "study.toml"]
    {
        assert!(names.contains(&name), "{name} in {names:?}");
        let file = service.get(&format!("/v1/jobs/{id}/files/{name}"));
        assert!(file.status == 200 && !file.text.is_empty());
    }
    let toml = service.get(&format!("/v1/jobs/{id}/study?format=toml")).text;
    assert_eq!(
        stribeck::study::Study::read(&toml, stribeck::study::Format::Toml, None).unwrap().hash,
        study.hash
    );
    let wire = service.get(&format!("/v1/jobs/{id}/study")).ok(200);
    assert_eq!(wire, study.to_json());

    assert_eq!(service.delete(&format!("/v1/jobs/{id}")).status, 204);
    service.get(&format!("/v1/jobs/{id}")).problem(404, "not-found");
    service.get(&format!("/v1/jobs/{id}/files/orbit.csv")).problem(404, "not-found");
}

#[test]
fn every_kind_of_job_has_its_answer() {
    let service = Service::start(2);
    let wiebe = tiny();
    let object = service.post("/v1/check", &json!({ "study": wiebe })).ok(200)["study"].clone();
    let runs_in = format!(
        "{}\n[running_in]\nminimise = \"mean-loss\"\nmax_wear_depth = \"5 um\"\nwear_depth_tolerance = \"0.5 um\"\n\
         [[running_in.stages]]\nname = \"rated\"\nduration = \"1 h\"\nspeed = \"1000 rpm\"\n",
        wiebe.replace("min-film-thickness\"\nat_least = \"2 um", "min-film-thickness\"\nat_least = \"0.1 um")
    );
    let varied = format!(
        "{wiebe}\n[experiments]\nplan = \"sobol\"\nruns = 3\n[[experiments.factors]]\nkey = \"orbit.steps_per_cycle\"\n\
         lower = 120\nupper = 160\n"
    );
    let jobs = [
        ("study", json!(wiebe), "converged"),
        ("study", json!(varied), "complete"),
        ("operational", object, "converged"),
        ("running-in", json!(runs_in), ""),
        ("simulation", json!(wiebe), "simulated"),
        ("gradient", json!(wiebe), "complete"),
        ("check", json!(wiebe), "complete"),
    ];
    let ids: Vec<String> = jobs
        .iter()
        .map(|(kind, study, _)| service.submit(&json!({ "kind": kind, "study": study })))
        .collect();
    for ((kind, _, outcome), id) in jobs.iter().zip(&ids) {
        let job = service.ended(id);
        assert_eq!((&job["kind"], &job["state"]), (&json!(kind), &json!("succeeded")), "{job}");
        assert!(outcome.is_empty() || job["outcome"] == *outcome, "{job}");
        let result = service.get(&format!("/v1/jobs/{id}/result")).ok(200);
        match *kind {
            "gradient" => assert!(result[0]["rows"][0]["values"][0][0].is_number(), "{result}"),
            "check" => assert_eq!(result["format"], "stribeck-study/1"),
            "running-in" => assert!(result["running_in"]["minimised"]["optimum"].is_number(), "{result}"),
            "study" if *outcome == "complete" => {
                assert_eq!(result["schema_version"], "stribeck-experiments/1");
                assert_eq!(result["runs"].as_array().unwrap().len(), 3);
                service.get(&format!("/v1/jobs/{id}/files/experiments.csv"));
            }
            _ => assert!(result["design"].is_array(), "{result}"),
        }
    }
    let many = varied.replace("runs = 3", "runs = 201");
    let problem = service.post("/v1/jobs", &json!({ "study": many })).problem(422, "invalid-study");
    assert_eq!(problem["errors"][0]["path"], "study.experiments");
    let body = json!({ "kind": "operational", "study": varied });
    assert_eq!(service.post("/v1/jobs", &body).problem(422, "invalid-study")["errors"][0]["path"], "kind");
}

#[test]
fn a_repeated_request_makes_no_second_job() {
    let service = Service::start(0);
    let send = |key: &str, body: &Value| {
        let headers = [("content-type", "application/json"), ("idempotency-key", key)];
        service.send("POST", "/v1/jobs", &headers, body.to_string().as_bytes())
    };
    let other = json!({ "kind": "simulation", "study": tiny() });
    let first = send("a-1", &check_job()).ok(202);
    let again = send("a-1", &check_job()).ok(200);
    assert_eq!(first["id"], again["id"]);
    send("a-1", &other).problem(409, "idempotency-key-reused");
    assert_ne!(send("a-2", &check_job()).ok(202)["id"], first["id"]);
    send("with blanks", &check_job()).problem(400, "unreadable");
    assert_eq!(service.get("/v1/jobs").ok(200)["jobs"].as_array().unwrap().len(), 2);
    let batch = |key: &str, jobs: &[Value]| {
        let headers = [("content-type", "application/json"), ("idempotency-key", key)];
        service.send("POST", "/v1/jobs/batch", &headers, json!({ "jobs": jobs }).to_string().as_bytes())
    };
    let ids = |found: Value| -> Vec<Value> {
        found["jobs"].as_array().unwrap().iter().map(|j| j["id"].clone()).collect()
    };
    let first = ids(batch("b", &[check_job(), other.clone()]).ok(202));
    assert_eq!(ids(batch("b", &[check_job(), other.clone()]).ok(202)), first);
    batch("b", &[other, check_job()]).problem(409, "idempotency-key-reused");
    assert_eq!(service.get("/v1/jobs").ok(200)["jobs"].as_array().unwrap().len(), 4);
}

#[test]
fn a_batch_is_kept_as_a_whole_or_not_at_all() {
    let service = Service::start(0);
    let wrong =
        json!({ "jobs": [check_job(), { "kind": "dance", "study": tiny() }, 7, { "study": "format = 1" }] });
    let problem = service.post("/v1/jobs/batch", &wrong).problem(422, "invalid-study");
    let paths: Vec<&str> =
        problem["errors"].as_array().unwrap().iter().map(|e| e["path"].as_str().unwrap()).collect();
    assert!(paths.contains(&"jobs[1].kind") && paths.contains(&"jobs[2]"), "{paths:?}");
    assert!(paths.contains(&"jobs[3].study.format") && paths.contains(&"jobs[3].study.title"), "{paths:?}");
    assert_eq!(service.get("/v1/jobs").ok(200)["jobs"], json!([]));
    let right = json!({ "jobs": vec![check_job(); 120] });
    assert_eq!(service.post("/v1/jobs/batch", &right).ok(202)["jobs"].as_array().unwrap().len(), 120);
    service.post("/v1/jobs/batch", &json!({ "jobs": [] })).problem(422, "invalid-study");
    service.post("/v1/jobs/batch", &json!({})).problem(422, "invalid-study");

    // Read page by page, newest first, each once.
    let (mut after, mut seen) = (String::new(), Vec::new());
    loop {
        let page = service.get(&format!("/v1/jobs?limit=50&state=queued&kind=check{after}")).ok(200);
        seen.extend(page["jobs"].as_array().unwrap().iter().map(|j| j["id"].as_str().unwrap().to_owned()));
        let Some(next) = page["next"].as_str() else { break };
        after = format!("&after={next}");
    }
    assert_eq!(seen.len(), 120);
    assert!(seen.windows(2).all(|w| w[0] > w[1]));
    let found =
        |query: &str| service.get(&format!("/v1/jobs?{query}")).ok(200)["jobs"].as_array().unwrap().len();
    assert_eq!((found("state=running"), found("title=DIESEL&limit=7"), found("title=50%25")), (0, 7, 0));
}

#[test]
fn jobs_are_cancelled_waiting_or_running() {
    let waiting = Service::start(0);
    let id = waiting.submit(&check_job());
    waiting.delete(&format!("/v1/jobs/{id}")).problem(409, "not-over");
    waiting.get(&format!("/v1/jobs/{id}/result")).problem(409, "not-over");
    let job = waiting.post(&format!("/v1/jobs/{id}/cancel"), &json!({})).ok(202);
    assert_eq!(job["state"], "cancelled");
    assert_eq!(waiting.post(&format!("/v1/jobs/{id}/cancel"), &json!({})).ok(202)["state"], "cancelled");

    let running = Service::start(1);
    let long = EXAMPLE
        .replace("steps_per_cycle = 180", "steps_per_cycle = 1440")
        .replace("cells_around = 36", "cells_around = 120");
    let id = running.submit(&json!({ "kind": "study", "study": long }));
    while running.get(&format!("/v1/jobs/{id}")).ok(200)["state"] == "queued" {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let job = running.post(&format!("/v1/jobs/{id}/cancel"), &json!({})).ok(202);
    assert_eq!(job["cancel_requested"], true);
    assert_eq!(running.ended(&id)["state"], "cancelled");
}

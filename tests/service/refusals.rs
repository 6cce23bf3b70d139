//! What is not let in, and how it is told.

use super::common::{Service, check_job, tiny};
use serde_json::{Value, json};
use stribeck::service::{Limits, ServeOptions, WorkerOptions, serve};

fn paths(problem: &Value) -> Vec<String> {
    let errors = problem["errors"].as_array().unwrap();
    errors.iter().map(|e| e["path"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn all_mistakes_of_a_study_are_told_at_once_with_their_paths() {
    let service = Service::start(0);
    let mut study = service.post("/v1/check", &json!({ "study": tiny() })).ok(200)["study"].clone();
    study["parameters"][0]["lower"] = json!("75 kg");
    study["bearings"]["big_end"]["width"] = json!("-4 mm");
    study["oil"]["grade"] = json!("SAE 4000");
    study["film"]["cells"] = json!(5);
    let body = json!({ "kind": "gradients", "study": study, "colour": "red" });
    let problem = service.post("/v1/jobs", &body).problem(422, "invalid-study");
    let found = paths(&problem);
    for path in [
        "kind",
        "colour",
        "study.parameters[0].lower",
        "study.bearings.big_end.width",
        "study.oil.grade",
        "study.film.cells",
    ] {
        assert!(found.iter().any(|p| p == path), "{path} in {found:?}");
    }
    let same = service.post("/v1/check", &json!({ "study": study })).problem(422, "invalid-study");
    assert_eq!(paths(&same).len(), 4, "{same}");
    // Toml has lines.
    let problem = service.post("/v1/jobs", &json!({ "study": "a = \n" })).problem(422, "invalid-study");
    assert!(problem["errors"][0]["message"].as_str().unwrap().contains("line 1"), "{problem}");
    // What does not suit the study.
    let body = json!({ "kind": "running-in", "study": tiny() });
    assert_eq!(paths(&service.post("/v1/jobs", &body).problem(422, "invalid-study")), ["kind"]);
    let compares = tiny() + "\n[comparison]\nengines = [\"ADJ\", \"TRA\"]\n";
    for kind in ["operational", "simulation"] {
        let problem = service
            .post("/v1/jobs", &json!({ "kind": kind, "study": compares }))
            .problem(422, "invalid-study");
        assert!(paths(&problem).contains(&"kind".to_owned()), "{problem}");
    }
    let tabulates =
        std::fs::read_to_string(crate::common::here("studies/steady-raimondi-boyd.toml")).unwrap();
    let body = json!({ "kind": "gradient", "study": tabulates });
    assert_eq!(paths(&service.post("/v1/jobs", &body).problem(422, "invalid-study")), ["kind"]);
    // No text has a NUL, and no database takes one.
    let nul = tiny().replace("title = \"Big", "title = \"\\u0000Big");
    assert_eq!(
        paths(&service.post("/v1/jobs", &json!({ "study": nul })).problem(422, "invalid-study")),
        ["study"]
    );
    let greedy = tiny().replace("[orbit]", "[orbit]\nmemory = \"500 GB\"");
    let problem = service.post("/v1/jobs", &json!({ "study": greedy })).problem(422, "invalid-study");
    assert_eq!(paths(&problem), ["study.orbit.memory"]);
    service.post("/v1/jobs", &json!({})).problem(422, "invalid-study");
    service.post("/v1/jobs", &json!({ "study": 7 })).problem(422, "invalid-study");
    assert_eq!(service.get("/v1/jobs").ok(200)["jobs"], json!([]));
}

#[test]
fn no_file_is_read_for_a_request() {
    let service = Service::start(0);
    let study = tiny().replace("source = \"wiebe\"", "source = \"table\"\nfile = \"/etc/passwd\"");
    let problem = service.post("/v1/check", &json!({ "study": study })).problem(422, "invalid-study");
    assert!(!problem.to_string().contains("root:"), "{problem}");
    assert!(paths(&problem).iter().any(|p| p.starts_with("study.cylinder_pressure")), "{problem}");
}

#[test]
fn requests_that_cannot_be_read_are_told_so() {
    let service =
        Service::with(0, Limits { body_bytes: 4000, requests_per_s: None, ..Limits::default() }, false);
    let json_type = [("content-type", "application/json")];
    let post = |headers: &[(&str, &str)], body: &[u8]| service.send("POST", "/v1/jobs", headers, body);
    post(&json_type, b"{").problem(400, "unreadable");
    post(&json_type, b"[]").problem(400, "unreadable");
    post(&json_type, b"\xff\xfe").problem(400, "unreadable");
    post(&[("content-type", "text/plain")], b"{}").problem(415, "wrong-media-type");
    post(&json_type, &vec![b' '; 5000]).problem(413, "too-large");
    service.get("/v1/nothing").problem(404, "not-found");
    service.get("/v1/jobs/none").problem(404, "not-found");
    service.get("/v1/jobs/%FF").problem(404, "not-found");
    service.send("PUT", "/v1/jobs", &json_type, b"{}").problem(405, "method-not-allowed");
    for query in [
        "limit=0",
        "limit=201",
        "limit=x",
        "state=asleep",
        "kind=dance",
        "knd=check",
        "title=%00",
        "after=zz",
    ] {
        service.get(&format!("/v1/jobs?{query}")).problem(400, "unreadable");
    }
    let answer = service.get("/v1/jobs");
    for (name, value) in
        [("x-content-type-options", "nosniff"), ("x-frame-options", "DENY"), ("cache-control", "no-store")]
    {
        assert_eq!(answer.headers[name], value);
    }
    assert!(
        answer.headers.contains_key("x-request-id") && answer.headers.contains_key("content-security-policy")
    );
}

#[test]
fn a_study_beyond_the_limits_is_refused_with_the_key_to_change() {
    let limits = Limits {
        cells: 100,
        steps: 50,
        cycles: 5,
        parameters: 1,
        cases: 0,
        open_jobs: 2,
        requests_per_s: None,
        ..Limits::default()
    };
    let service = Service::with(0, limits, false);
    let problem = service.post("/v1/jobs", &check_job()).problem(422, "invalid-study");
    assert_eq!(
        paths(&problem),
        [
            "study.film.cells_around",
            "study.orbit.steps_per_cycle",
            "study.orbit.max_cycles",
            "study.parameters",
            "study.objective.operating_points"
        ]
    );
    let service = Service::with(0, Limits { open_jobs: 2, requests_per_s: None, ..Limits::default() }, false);
    service.submit(&check_job());
    service.post("/v1/jobs/batch", &json!({ "jobs": [check_job(), check_job()] })).problem(429, "queue-full");
    service.submit(&check_job());
    let full = service.post("/v1/jobs", &check_job());
    assert!(full.headers.contains_key("retry-after"));
    full.problem(429, "queue-full");
}

#[test]
fn a_job_that_takes_too_long_ends_with_what_is_known() {
    use std::time::Duration;
    use stribeck::service::work;
    let service = Service::start(0);
    let long = super::common::EXAMPLE.replace("steps_per_cycle = 180", "steps_per_cycle = 1440");
    let id = service.submit(&json!({ "study": long }));
    let (_stop, stopped) = tokio::sync::watch::channel(false);
    let options = WorkerOptions { wall_time: Duration::from_millis(600), ..WorkerOptions::default() };
    let store = service.store.clone();
    service.spawn(work(store, options, Default::default(), stopped));
    let job = service.ended(&id);
    assert_eq!((&job["state"], &job["problem"]["code"]), (&json!("failed"), &json!("time-limit")), "{job}");
    assert_eq!(service.get(&format!("/v1/jobs/{id}/result")).status, 200);
}

#[test]
fn a_key_opens_its_own_jobs_only() {
    let mut service = Service::with(0, Limits::default(), true);
    let (a, b) = service.wait(async {
        (service.store.new_key("a").await.unwrap(), service.store.new_key("b").await.unwrap())
    });
    let nobody = service.get("/v1/jobs");
    assert!(nobody.headers.contains_key("www-authenticate"));
    nobody.problem(401, "no-valid-key");
    for path in ["/Info", "/metrics", "/v1/jobs/x"] {
        service.get(path).problem(401, "no-valid-key");
    }
    for path in ["/", "/health/live", "/health/ready", "/openapi.json", "/v1/schema/study", "/v1/example"] {
        assert_eq!(service.get(path).status, 200, "{path}");
    }
    service.key = Some("stribeck_x_y".to_owned());
    service.get("/v1/jobs").problem(401, "no-valid-key");
    service.key = Some(a.secret.replace(|c: char| c.is_ascii_digit(), "0"));
    service.get("/v1/jobs").problem(401, "no-valid-key");
    service.key = Some(a.secret.clone());
    let id = service.submit(&check_job());
    assert_eq!(service.get("/v1/jobs").ok(200)["jobs"].as_array().unwrap().len(), 1);
    service.key = Some(b.secret.clone());
    assert_eq!(service.get("/v1/jobs").ok(200)["jobs"], json!([]));
    for path in ["", "/events", "/result", "/report", "/files", "/files/orbit.csv", "/study"] {
        service.get(&format!("/v1/jobs/{id}{path}")).problem(404, "not-found");
    }
    service.post(&format!("/v1/jobs/{id}/cancel"), &json!({})).problem(404, "not-found");
    service.delete(&format!("/v1/jobs/{id}")).problem(404, "not-found");
    // Hashes only are kept, and what was done is logged.
    let kept = service.wait(service.store.keys()).unwrap();
    assert_eq!(kept.iter().map(|k| k.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    let log = service.wait(service.store.audited(10)).unwrap();
    assert!(
        log.iter().any(|(_, who, what, job)| *who == a.id && what == "submit" && job.as_deref() == Some(&id))
    );
    service.wait(service.store.revoke_key(&a.id)).unwrap();
    service.key = Some(a.secret);
    service.get("/v1/jobs").problem(401, "no-valid-key");
}

#[test]
fn too_many_requests_are_told_to_wait() {
    let service = Service::with(0, Limits { requests_per_s: Some(5), ..Limits::default() }, false);
    let all: Vec<u16> = (0..20).map(|_| service.get("/v1/jobs").status).collect();
    assert!(all[..5].iter().all(|s| *s == 200) && all.contains(&429), "{all:?}");
    let refused = (0..20).map(|_| service.get("/v1/jobs")).find(|a| a.status == 429).unwrap();
    assert!(refused.headers.contains_key("retry-after"));
    refused.problem(429, "too-many-requests");
}

#[test]
fn nobody_serves_beyond_this_machine_without_keys() {
    let folder = tempfile::tempdir().unwrap();
    let database = format!("sqlite:{}", folder.path().join("jobs.db").display());
    for keys in [None, Some(true), Some(false)] {
        let options = ServeOptions {
            address: "0.0.0.0:0".parse().unwrap(),
            database: database.clone(),
            keys,
            workers: WorkerOptions { slots: 0, ..WorkerOptions::default() },
            limits: Limits::default(),
        };
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let refused = runtime.block_on(serve(options, |_| panic!("it serves"))).unwrap_err();
        assert!(refused.to_string().contains("stribeck key create"), "{refused}");
    }
}

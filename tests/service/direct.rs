//! Answers while the caller waits; descriptions; operation.

use super::common::{EXAMPLE, Service, check_job, tiny};
use serde_json::{Value, json};
use stribeck::service::Limits;

#[test]
fn a_gradient_is_that_of_differences_of_the_same_service() {
    let service = Service::start(0);
    let at = |um: f64, mm: f64| {
        let point = json!({ "big_end.diametral_clearance": um, "big_end.width": mm });
        service.post("/v1/gradient", &json!({ "study": tiny(), "point": point })).ok(200)
    };
    let here = at(210.0, 92.0);
    assert_eq!(here["engine"], "ADJ");
    let names: Vec<&str> =
        here["quantities"].as_array().unwrap().iter().map(|q| q["quantity"].as_str().unwrap()).collect();
    assert_eq!(names, ["mean-friction-loss", "min-film-thickness", "specific-load"]);
    let value = |answer: &Value, q: usize| answer["quantities"][q]["value"].as_f64().unwrap();
    for (j, (low, high, step)) in
        [(at(209.99, 92.0), at(210.01, 92.0), 0.02), (at(210.0, 91.998), at(210.0, 92.002), 0.004)]
            .iter()
            .enumerate()
    {
        for q in 0..3 {
            let slope = here["quantities"][q]["gradient"][j]["slope"].as_f64().unwrap();
            let difference = (value(high, q) - value(low, q)) / step;
            let size = slope.abs().max(1e-6 * value(&here, q));
            assert!((slope - difference).abs() < 1e-4 * size, "{} by {j}: {slope} {difference}", names[q]);
        }
    }
    assert_eq!(here["quantities"][0]["gradient"][0]["unit"], "um");
}

#[test]
fn what_is_too_large_or_too_slow_is_one_for_a_job() {
    let service = Service::start(0);
    let wrong = json!({ "study": tiny(), "point": { "big_end.width": 1000.0, "big_end.colour": 1.0 } });
    let problem = service.post("/v1/gradient", &wrong).problem(422, "invalid-study");
    assert_eq!(problem["errors"].as_array().unwrap().len(), 2, "{problem}");
    let small = Service::with(0, Limits { direct_work: 10.0, ..Limits::default() }, false);
    small.post("/v1/gradient", &json!({ "study": tiny() })).problem(422, "invalid-study");
    let slow = Service::with(0, Limits { direct_s: 0, ..Limits::default() }, false);
    slow.post("/v1/gradient", &json!({ "study": EXAMPLE })).problem(504, "too-slow");
}

#[test]
fn the_interface_is_described_as_it_was() {
    let service = Service::start(0);
    let text = service.get("/openapi.json").ok(200);
    assert_eq!(text["openapi"], "3.1.0");
    insta::assert_json_snapshot!("openapi", text);
    let docs = service.get("/docs/");
    assert!(docs.status == 200 && docs.text.contains("swagger-ui"), "{}", docs.text);
    assert_eq!(service.get("/docs/swagger-ui-bundle.js").status, 200);
    assert!(service.get("/v1/schema/study").ok(200)["$schema"].is_string());
    assert!(service.get("/v1/schema/report").ok(200)["$schema"].is_string());
    assert!(service.get("/v1/example").text.contains("stribeck-study/1"));
}

#[test]
fn those_who_run_it_see_what_it_does() {
    let service = Service::start(1);
    assert_eq!(service.get("/health/live").ok(200)["status"], "ok");
    assert_eq!(service.get("/health/ready").ok(200)["status"], "ok");
    let id = service.submit(&check_job());
    service.ended(&id);
    let text = service.get("/metrics").text;
    for line in [
        "stribeck_jobs{state=\"succeeded\"} 1",
        "stribeck_jobs{state=\"queued\"} 0",
        "stribeck_requests_total",
        "stribeck_job_seconds",
    ] {
        assert!(text.contains(line), "{line} in\n{text}");
    }
}

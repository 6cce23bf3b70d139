//! Random and mutated bodies: every one is answered by a documented status, none by an error of the service.
//!
//! `STRIBECK_FUZZ_CASES` says how many (20 000 if it says nothing).

use super::common::{EXAMPLE, tiny};
use axum::body::Body;
use axum::http::Request;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::{Value, json};
use stribeck::service::store::Store;
use stribeck::service::{Limits, app, router};
use tower::ServiceExt;

const ROUTES: [&str; 10] = [
    "/v1/jobs",
    "/v1/jobs/batch",
    "/v1/check",
    "/v1/gradient",
    "/Evaluate",
    "/Gradient",
    "/ApplyJacobian",
    "/ApplyHessian",
    "/ModelInfo",
    "/v1/jobs?kind=check",
];

/// A value out of nowhere.
fn wild(random: &mut Pcg64Mcg, depth: u32) -> Value {
    match random.random_range(0..if depth == 0 { 9 } else { 11 }) {
        0 => Value::Null,
        1 => json!(random.random::<bool>()),
        2 => json!(random.random_range(-3..4)),
        3 => json!(random.random::<f64>() * 10f64.powi(random.random_range(-320..308))),
        4 => json!(i64::MIN),
        5 => json!("75 um"),
        6 => json!("\u{0}\u{202e}\u{1F600} \n"),
        7 => json!("-1e999 kg"),
        8 => json!("x".repeat(random.random_range(0..300))),
        9 => (0..random.random_range(0..4)).map(|_| wild(random, depth - 1)).collect(),
        _ => {
            let names = ["name", "kind", "study", "lower", "", "big_end", "\u{0}"];
            let pairs = (0..random.random_range(0..4))
                .map(|_| (names[random.random_range(0..names.len())].to_owned(), wild(random, depth - 1)));
            Value::Object(pairs.collect())
        }
    }
}

/// Changes something somewhere in a value.
fn mutate(value: &mut Value, random: &mut Pcg64Mcg) {
    match value {
        Value::Object(fields) if !fields.is_empty() && random.random_range(0..8) > 0 => {
            let key = fields.keys().nth(random.random_range(0..fields.len())).unwrap().clone();
            match random.random_range(0..8) {
                0 => {
                    fields.remove(&key);
                }
                1 => {
                    let taken = fields.remove(&key).unwrap();
                    fields.insert(format!("{key}s"), taken);
                }
                _ => mutate(fields.get_mut(&key).unwrap(), random),
            }
        }
        Value::Array(list) if !list.is_empty() && random.random_range(0..8) > 0 => {
            let k = random.random_range(0..list.len());
            match random.random_range(0..8) {
                0 => {
                    list.remove(k);
                }
                1 => list.push(list[k].clone()),
                _ => mutate(&mut list[k], random),
            }
        }
        Value::String(text) if random.random_range(0..3) > 0 => {
            let mut bytes: Vec<char> = text.chars().collect();
            let at = random.random_range(0..=bytes.len());
            match random.random_range(0..3) {
                0 => bytes.insert(at, ['9', '-', 'e', '.', ' ', '\u{0}', 'µ'][random.random_range(0..7)]),
                1 => bytes.truncate(at),
                _ => bytes.rotate_left(at),
            }
            *text = bytes.into_iter().collect();
        }
        other => *other = wild(random, 2),
    }
}

/// Text with some bytes changed.
fn garbled(text: &str, random: &mut Pcg64Mcg) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..random.random_range(1..6) {
        let at = random.random_range(0..bytes.len());
        match random.random_range(0..4) {
            0 => bytes[at] = random.random(),
            1 => bytes.truncate(at.max(1)),
            2 => bytes.insert(at, b"{}[]\",:\\0e-\xff"[random.random_range(0..12)]),
            _ => {
                bytes.remove(at);
                if bytes.is_empty() {
                    bytes.push(b'{');
                }
            }
        }
    }
    bytes
}

#[test]
fn no_body_makes_the_service_fail() {
    let cases: u64 = std::env::var("STRIBECK_FUZZ_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(20_000);
    let folder = tempfile::tempdir().unwrap();
    let database = format!("sqlite:{}", folder.path().join("jobs.db").display());
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
    // Nothing is computed here: what a study may come to is shown elsewhere.
    let limits =
        Limits { requests_per_s: None, open_jobs: i64::MAX / 2, direct_work: 0.0, ..Limits::default() };
    let service =
        runtime.block_on(async { router(app(Store::open(&database).await.unwrap(), limits, false)) });
    let study: Value = runtime.block_on(async {
        let (status, body) = ask(&service, "/v1/check", "application/toml", EXAMPLE.into()).await;
        assert_eq!(status, 200);
        serde_json::from_slice::<Value>(&body).unwrap()["study"].clone()
    });
    let seeds = [
        json!({ "kind": "check", "study": study }),
        json!({ "kind": "operational", "study": tiny() }),
        json!({ "jobs": [{ "kind": "check", "study": study }] }),
        json!({ "study": study, "point": { "big_end.width": 92.0 } }),
        json!({ "name": "x", "input": [[1.0, 2.0]], "sens": [1.0], "vec": [1.0], "outWrt": 0, "inWrt": 0 }),
    ];
    let mut counts = std::collections::BTreeMap::<u16, u64>::new();
    for case in 0..cases {
        let mut random = Pcg64Mcg::seed_from_u64(case);
        let mut value = seeds[random.random_range(0..seeds.len())].clone();
        for _ in 0..random.random_range(1..4) {
            mutate(&mut value, &mut random);
        }
        let (kind, body) = match random.random_range(0..6) {
            0 => ("application/json", garbled(&value.to_string(), &mut random)),
            1 => ("application/toml", garbled(EXAMPLE, &mut random)),
            2 => ("application/json", wild(&mut random, 4).to_string().into_bytes()),
            _ => ("application/json", value.to_string().into_bytes()),
        };
        let path = ROUTES[random.random_range(0..ROUTES.len())];
        let (status, answer) = runtime.block_on(ask(&service, path, kind, body.clone()));
        let documented = [200, 202, 400, 404, 409, 413, 415, 422, 429];
        let shown = || {
            format!(
                "case {case}: {path} {status}\n{}\n{}",
                String::from_utf8_lossy(&body),
                String::from_utf8_lossy(&answer)
            )
        };
        assert!(documented.contains(&status), "{}", shown());
        assert!(serde_json::from_slice::<Value>(&answer).is_ok(), "{}", shown());
        *counts.entry(status).or_default() += 1;
    }
    println!("{cases} bodies: {counts:?}");
    assert!(
        counts[&422] > cases / 10 && counts[&400] > cases / 20 && counts.contains_key(&202),
        "{counts:?}"
    );
}

async fn ask(service: &axum::Router, path: &str, kind: &str, body: Vec<u8>) -> (u16, Vec<u8>) {
    let request = Request::post(path).header("content-type", kind).body(Body::from(body)).unwrap();
    let answer = service.clone().oneshot(request).await.unwrap();
    let status = answer.status().as_u16();
    (status, axum::body::to_bytes(answer.into_body(), usize::MAX).await.unwrap().to_vec())
}

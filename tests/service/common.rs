//! A service of its own for every test: on a socket, with a database in a folder that goes away.

use serde_json::{Value, json};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant};
use stribeck::service::store::Store;
use stribeck::service::{Limits, WorkerOptions, app, router, work};
use tokio::sync::watch;

/// The example of the page, and the same so coarse that it is simulated within milliseconds.
pub const EXAMPLE: &str = include_str!("../../src/service/page/example.toml");

pub fn tiny() -> String {
    let coarse = EXAMPLE.replace("cells_across_half = 4", "cells_across_half = 3");
    assert_ne!(coarse, EXAMPLE);
    coarse
}

/// The least that can be asked: the check of a study.
pub fn check_job() -> Value {
    json!({ "kind": "check", "study": tiny() })
}

pub struct Service {
    pub address: SocketAddr,
    pub store: Store,
    runtime: Option<tokio::runtime::Runtime>,
    stop: watch::Sender<bool>,
    _folder: tempfile::TempDir,
    agent: ureq::Agent,
    /// Sent with every request.
    pub key: Option<String>,
}

/// An answer: status, headers, body.
pub struct Answer {
    pub status: u16,
    pub headers: ureq::http::HeaderMap,
    pub text: String,
}

impl Answer {
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.text).unwrap_or_else(|e| panic!("{e}: {}", self.text))
    }

    /// The body, if the status is the one expected.
    pub fn ok(self, status: u16) -> Value {
        assert_eq!(self.status, status, "{}", self.text);
        self.json()
    }

    /// The problem of a status, checked to be one.
    pub fn problem(self, status: u16, code: &str) -> Value {
        assert_eq!(self.status, status, "{}", self.text);
        assert_eq!(self.headers["content-type"], "application/problem+json", "{}", self.text);
        let problem = self.json();
        assert_eq!(problem["code"], code, "{problem}");
        assert_eq!(problem["status"], status);
        assert_eq!(problem["type"], format!("urn:stribeck:problem:{code}"));
        problem
    }
}

impl Service {
    pub fn start(slots: usize) -> Self {
        Self::with(slots, Limits { requests_per_s: None, ..Limits::default() }, false)
    }

    pub fn with(slots: usize, limits: Limits, keys: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let database = format!("sqlite:{}", folder.path().join("jobs.db").display());
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
        let (stop, stopped) = watch::channel(false);
        let (address, store) = runtime.block_on(async {
            let store = Store::open(&database).await.unwrap();
            let app = app(store.clone(), limits, keys);
            let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
            let address = listener.local_addr().unwrap();
            if slots > 0 {
                let options =
                    WorkerOptions { slots, grace: Duration::from_secs(5), ..WorkerOptions::default() };
                tokio::spawn(work(store.clone(), options, Arc::clone(&app.wake), stopped));
            }
            let service = router(app).into_make_service_with_connect_info::<SocketAddr>();
            tokio::spawn(async move { axum::serve(listener, service).await });
            (address, store)
        });
        let config = ureq::Agent::config_builder().http_status_as_error(false).build();
        Self {
            address,
            store,
            runtime: Some(runtime),
            stop,
            _folder: folder,
            agent: config.into(),
            key: None,
        }
    }

    pub fn wait<T>(&self, work: impl Future<Output = T>) -> T {
        self.runtime.as_ref().unwrap().block_on(work)
    }

    pub fn spawn(&self, work: impl Future<Output = ()> + Send + 'static) {
        self.runtime.as_ref().unwrap().spawn(work);
    }

    pub fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.address)
    }

    pub fn send(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Answer {
        send(&self.agent, &self.url(path), method, headers, self.key.as_deref(), body)
    }

    pub fn get(&self, path: &str) -> Answer {
        self.send("GET", path, &[], b"")
    }

    pub fn delete(&self, path: &str) -> Answer {
        self.send("DELETE", path, &[], b"")
    }

    pub fn post(&self, path: &str, body: &Value) -> Answer {
        self.send("POST", path, &[("content-type", "application/json")], body.to_string().as_bytes())
    }

    /// Submits a job that has no mistakes; its id.
    pub fn submit(&self, body: &Value) -> String {
        let job = self.post("/v1/jobs", body).ok(202);
        job["id"].as_str().unwrap().to_owned()
    }

    /// The job when it is over.
    pub fn ended(&self, id: &str) -> Value {
        let began = Instant::now();
        loop {
            let job = self.get(&format!("/v1/jobs/{id}")).ok(200);
            if !["queued", "running"].contains(&job["state"].as_str().unwrap()) {
                return job;
            }
            assert!(began.elapsed() < Duration::from_secs(120), "{job}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        let _ = self.stop.send(true);
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_timeout(Duration::from_secs(1));
        }
    }
}

pub fn send(
    agent: &ureq::Agent,
    url: &str,
    method: &str,
    headers: &[(&str, &str)],
    key: Option<&str>,
    body: &[u8],
) -> Answer {
    let mut request = ureq::http::Request::builder().method(method).uri(url);
    for (name, value) in headers {
        request = request.header(*name, *value);
    }
    if let Some(key) = key {
        request = request.header("authorization", format!("Bearer {key}"));
    }
    let found = match (method, body.is_empty()) {
        ("GET" | "DELETE", true) => agent.run(request.body(()).unwrap()),
        _ => agent.run(request.body(body.to_vec()).unwrap()),
    };
    let mut found = found.unwrap_or_else(|e| panic!("{method} {url}: {e}"));
    let (status, headers) = (found.status().as_u16(), found.headers().clone());
    let text = found.body_mut().with_config().limit(64 << 20).read_to_string().unwrap();
    Answer { status, headers, text }
}

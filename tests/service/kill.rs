//! Processes that are killed in the middle of jobs: every job ends exactly once, searches go on where they were.

use super::common::{EXAMPLE, send, tiny};
use super::queue::postgres;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A process of the service that is killed when its test ends.
struct Process {
    child: Child,
    address: String,
    agent: ureq::Agent,
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn stribeck(arguments: &[&str], database: &str, log: &Path) -> Command {
    let log = std::fs::OpenOptions::new().create(true).append(true).open(log).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_stribeck"));
    command.args(arguments).args(["--database", database]).stderr(log);
    command
}

impl Process {
    fn serve(database: &str, slots: &str, log: &Path) -> Self {
        let arguments = ["serve", "--address", "127.0.0.1:0", "--slots", slots, "--lease", "2"];
        let mut child = stribeck(&arguments, database, log).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().rsplit(' ').next().unwrap().trim_end_matches('/').to_owned();
        assert!(address.starts_with("http://"), "{line}");
        let config = ureq::Agent::config_builder().http_status_as_error(false).build();
        Self { child, address, agent: config.into() }
    }

    fn get(&self, path: &str) -> Value {
        send(&self.agent, &format!("{}{path}", self.address), "GET", &[], None, b"").ok(200)
    }

    fn submit(&self, jobs: &[Value]) -> Vec<String> {
        let body = json!({ "jobs": jobs }).to_string();
        let headers = [("content-type", "application/json")];
        let url = format!("{}/v1/jobs/batch", self.address);
        let found = send(&self.agent, &url, "POST", &headers, None, body.as_bytes()).ok(202);
        found["jobs"].as_array().unwrap().iter().map(|j| j["id"].as_str().unwrap().to_owned()).collect()
    }

    fn jobs(&self) -> Vec<Value> {
        self.get("/v1/jobs?limit=200")["jobs"].as_array().unwrap().clone()
    }

    fn count(&self, states: &[&str]) -> usize {
        self.jobs().iter().filter(|j| states.contains(&j["state"].as_str().unwrap())).count()
    }

    /// Waits until something is true of the jobs.
    fn until(&self, what: &str, of: impl Fn(&Self) -> bool) {
        let began = Instant::now();
        while !of(self) {
            assert!(began.elapsed() < Duration::from_secs(240), "{what}: {:?}", self.jobs());
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    #[cfg(unix)]
    fn terminate(&mut self) -> i32 {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
        self.child.wait().unwrap().code().unwrap()
    }
}

/// Searches that take seconds, and small jobs around them.
fn fifty() -> Vec<Value> {
    let long = EXAMPLE.replace("steps_per_cycle = 180", "steps_per_cycle = 720");
    let long = long.replace("cells_around = 36", "cells_around = 60");
    let long = |k: usize| {
        let start = format!("name = \"big_end.width\"\nstart = \"{} mm\"\n", 90 + k);
        json!({ "kind": "operational", "study": long.replace("name = \"big_end.width\"\n", &start) })
    };
    let small = |k: usize| json!({ "kind": if k.is_multiple_of(2) { "simulation" } else { "check" }, "study": tiny() });
    (0..2).map(long).chain((0..48).map(small)).collect()
}

/// Every job ended once, as if nothing had happened.
fn assert_all_ended(service: &Process, ids: &[String]) {
    service.until("all end", |s| s.count(&["queued", "running"]) == 0);
    let jobs = service.jobs();
    assert_eq!(jobs.len(), ids.len());
    for job in &jobs {
        assert_eq!(job["state"], "succeeded", "{job}");
        assert!(job["attempts"].as_i64().unwrap() <= 3, "{job}");
        let result = service.get(&format!("/v1/jobs/{}/result", job["id"].as_str().unwrap()));
        assert!(result.is_object());
    }
    for job in jobs.iter().filter(|j| j["kind"] == "operational") {
        assert_eq!(job["outcome"], "converged", "{job}");
    }
}

/// What a job told of itself, in all attempts.
fn stages(service: &Process, id: &str) -> Vec<String> {
    let url = format!("{}/v1/jobs/{id}/events", service.address);
    let text = send(&service.agent, &url, "GET", &[], None, b"").text;
    let data = text.lines().filter_map(|l| l.strip_prefix("data: "));
    data.map(|d| serde_json::from_str::<Value>(d).unwrap()["stage"].as_str().unwrap_or("").to_owned())
        .collect()
}

#[test]
fn a_server_is_killed_in_the_middle_of_fifty_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let (database, log) =
        (format!("sqlite:{}", folder.path().join("jobs.db").display()), folder.path().join("log"));
    let mut service = Process::serve(&database, "2", &log);
    let ids = service.submit(&fifty());
    // In the middle of both searches: each has accepted designs behind it.
    for kills in 0..2 {
        service.until("searches are on their way", |s| {
            let on_the_way = |id: &String| {
                let job = s.get(&format!("/v1/jobs/{id}"));
                job["progress"]["iteration"].as_u64().unwrap_or(0) > kills || job["state"] == "succeeded"
            };
            ids[..2].iter().all(on_the_way)
        });
        service.child.kill().unwrap();
        service.child.wait().unwrap();
        service = Process::serve(&database, "2", &log);
    }
    assert_all_ended(&service, &ids);
    let resumed =
        ids[..2].iter().flat_map(|id| stages(&service, id)).filter(|s| s.contains("going on where"));
    assert!(resumed.count() >= 1, "a search went on from its checkpoint: {:?}", stages(&service, &ids[0]));
    let once = ids.iter().all(|id| stages(&service, id).len() < 200);
    assert!(once);
}

#[test]
#[cfg(unix)]
fn a_server_that_is_asked_to_stop_hands_its_jobs_back() {
    let folder = tempfile::tempdir().unwrap();
    let (database, log) =
        (format!("sqlite:{}", folder.path().join("jobs.db").display()), folder.path().join("log"));
    let mut service = Process::serve(&database, "2", &log);
    let ids = service.submit(&fifty()[..2]);
    service.until("both run", |s| s.count(&["running"]) == 2);
    service
        .until("a design is accepted", |s| s.jobs().iter().all(|j| j["progress"]["iteration"].is_number()));
    assert_eq!(service.terminate(), 0);
    let idle = Process::serve(&database, "0", &log);
    for job in idle.jobs() {
        assert_eq!((&job["state"], &job["attempts"]), (&json!("queued"), &json!(0)), "{job}");
    }
    drop(idle);
    let service = Process::serve(&database, "2", &log);
    assert_all_ended(&service, &ids);
}

#[test]
fn two_workers_share_a_server_and_one_of_them_is_killed() {
    let Some(database) = postgres("stribeck_kill") else {
        println!("skipped: STRIBECK_TEST_POSTGRES names no server");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    let service = Process::serve(&database, "0", &log);
    let worker = || stribeck(&["worker", "--slots", "1", "--lease", "2"], &database, &log).spawn().unwrap();
    let mut workers = [worker(), worker()];
    let ids = service.submit(&fifty());
    service.until("both searches run", |s| {
        ids[..2]
            .iter()
            .all(|id| s.get(&format!("/v1/jobs/{id}"))["progress"]["iteration"].as_u64().unwrap_or(0) >= 1)
    });
    workers[0].kill().unwrap();
    workers[0].wait().unwrap();
    assert_all_ended(&service, &ids);
    let attempts: Vec<i64> = service.jobs().iter().map(|j| j["attempts"].as_i64().unwrap()).collect();
    assert!(attempts.contains(&2) && attempts.iter().filter(|a| **a > 1).count() <= 2, "{attempts:?}");
    workers[1].kill().unwrap();
    workers[1].wait().unwrap();
}

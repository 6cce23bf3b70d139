//! The service under load: 10 000 small jobs in its queue, workers busy, 200 readers that ask for the state of jobs. Run it with
//! `cargo bench --bench service`; `-- --test` is a short run.
//!
//! Told are jobs lost and doubled (none may be), and how long requests for the state of a job took.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A shaft bearing of which a cycle takes milliseconds.
const STUDY: &str = r#"
format = "stribeck-study/1"
title = "A small bearing"

[machine]
bore = "280 mm"
throw = "165 mm"
throw_over_rod = 0.25
oscillating_mass = "80 kg"
rotating_mass = "50 kg"

[cylinder_pressure]
source = "wiebe"
compression_ratio = 15.5
charge_pressure = "4.6 bar"
charge_temperature = "325 K"
heat_release = "119.5 kJ"
combustion_start = "-7 deg"
combustion_duration = "70 deg"

[bearings.big_end]
kind = "big-end"
width = "95 mm"
diameter = "210 mm"
diametral_clearance = "200 um"

[film]
model = "mobility"

[orbit]
steps_per_cycle = 120

[oil]
dynamic_viscosity = "11 mPa s"
inlet_temperature = "65 degC"

[[objective.operating_points]]
name = "rated"
speed = "1000 rpm"

[[parameters]]
name = "big_end.width"
lower = "80 mm"
upper = "100 mm"
"#;

/// Each reader asks so often.
const EVERY: Duration = Duration::from_millis(100);

struct Server(std::process::Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn get(agent: &ureq::Agent, url: &str) -> String {
    agent.get(url).call().unwrap().body_mut().with_config().limit(64 << 20).read_to_string().unwrap()
}

fn main() {
    let short = std::env::args().any(|a| a == "--test");
    let (batches, readers) = if short { (1, 20) } else { (10, 200) };
    let folder = tempfile::tempdir().unwrap();
    let database = format!("sqlite:{}", folder.path().join("jobs.db").display());
    let mut command = Command::new(env!("CARGO_BIN_EXE_stribeck"));
    command.args(["serve", "--address", "127.0.0.1:0", "--log", "warn", "--database", &database]);
    let mut server = Server(command.stdout(Stdio::piped()).spawn().unwrap());
    let mut line = String::new();
    BufReader::new(server.0.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    let base = line.trim().rsplit(' ').next().unwrap().trim_end_matches('/').to_owned();
    let agent = ureq::agent();

    let job = serde_json::json!({ "kind": "simulation", "study": STUDY });
    let body = serde_json::json!({ "jobs": vec![job; 1000] });
    let began = Instant::now();
    let mut ids = Vec::new();
    for _ in 0..batches {
        let text = agent.post(format!("{base}/v1/jobs/batch")).send_json(&body).unwrap();
        let found: serde_json::Value = text.into_body().with_config().limit(64 << 20).read_json().unwrap();
        ids.extend(found["jobs"].as_array().unwrap().iter().map(|j| j["id"].as_str().unwrap().to_owned()));
    }
    println!("{} jobs submitted in {:.1} s", ids.len(), began.elapsed().as_secs_f64());

    let (over, began) = (AtomicBool::new(false), Instant::now());
    let mut times: Vec<f64> = std::thread::scope(|scope| {
        let readers: Vec<_> = (0..readers)
            .map(|r| {
                let (base, ids, over) = (&base, &ids, &over);
                scope.spawn(move || read(base, ids, r, over))
            })
            .collect();
        let done = format!("{base}/v1/jobs?limit=1&state=");
        while ["queued", "running"]
            .iter()
            .any(|s| !get(&agent, &format!("{done}{s}")).contains("\"jobs\":[]"))
        {
            std::thread::sleep(Duration::from_millis(500));
        }
        over.store(true, Ordering::Relaxed);
        readers.into_iter().flat_map(|r| r.join().unwrap()).collect()
    });
    let seconds = began.elapsed().as_secs_f64();
    println!("done in {seconds:.1} s, {:.0} jobs a second", ids.len() as f64 / seconds);

    let (mut lost, mut doubled) = (0, 0);
    for id in &ids {
        let job: serde_json::Value =
            serde_json::from_str(&get(&agent, &format!("{base}/v1/jobs/{id}"))).unwrap();
        lost += u32::from(job["state"] != "succeeded" || job["outcome"] != "simulated");
        doubled += u32::from(job["attempts"] != 1);
    }
    let metrics = get(&agent, &format!("{base}/metrics"));
    let ended =
        metrics.lines().find(|l| l.starts_with("stribeck_jobs_finished_total")).unwrap_or("none ended");
    println!("{lost} lost, {doubled} doubled; {ended}");
    times.sort_by(f64::total_cmp);
    let at = |share: f64| 1e3 * times[((times.len() - 1) as f64 * share) as usize];
    println!(
        "{} requests for a state by {readers} readers: median {:.1} ms, 90 % {:.1} ms, 99 % {:.1} ms, longest {:.1} ms",
        times.len(),
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0)
    );
    assert_eq!((lost, doubled), (0, 0));
    assert!(ended.ends_with(&format!(" {}", ids.len())), "{ended}");
}

/// One reader's requests, s each.
fn read(base: &str, ids: &[String], reader: usize, over: &AtomicBool) -> Vec<f64> {
    let agent = ureq::agent();
    let mut times = Vec::new();
    // Not all at the same moment.
    std::thread::sleep(EVERY * reader as u32 / 200);
    for k in 0.. {
        if over.load(Ordering::Relaxed) {
            break;
        }
        let id = &ids[(reader * 7919 + k * 104_729) % ids.len()];
        let began = Instant::now();
        let text = get(&agent, &format!("{base}/v1/jobs/{id}"));
        times.push(began.elapsed().as_secs_f64());
        assert!(text.contains(id.as_str()));
        std::thread::sleep(EVERY.saturating_sub(began.elapsed()));
    }
    times
}

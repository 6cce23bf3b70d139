//! What a request may ask for. A study beyond a limit is refused with the key to change, before anything is computed.

use crate::study::Study;

/// The limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// Size of a request's body, bytes.
    pub body_bytes: usize,
    /// Cells of a film, both halves.
    pub cells: usize,
    /// Steps of a cycle.
    pub steps: usize,
    /// Cycles until an orbit must have settled.
    pub cycles: usize,
    /// Memory for the recording of a cycle, bytes.
    pub memory_bytes: usize,
    /// Design parameters.
    pub parameters: usize,
    /// Bearings times operating points.
    pub cases: usize,
    /// Runs of experiments.
    pub experiments: usize,
    /// Jobs of one key that wait or run.
    pub open_jobs: i64,
    /// Jobs in one batch.
    pub batch: usize,
    /// Requests per second and key, and how many may come at once; none for any number.
    pub requests_per_s: Option<u32>,
    /// How long a request that computes may take, s.
    pub direct_s: u64,
    /// Cells times steps, cases and parameters of a request that computes, on the safe side.
    pub direct_work: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            body_bytes: 2 << 20,
            cells: 40_000,
            steps: 7200,
            cycles: 1000,
            memory_bytes: 1_000_000_000,
            parameters: 1000,
            cases: 64,
            experiments: 200,
            open_jobs: 20_000,
            batch: 1000,
            requests_per_s: Some(200),
            direct_s: 30,
            direct_work: 5e6,
        }
    }
}

impl Limits {
    /// What of a study exceeds them: key and words.
    pub fn exceeded_by(&self, study: &Study) -> Vec<(String, String)> {
        let mut all = Vec::new();
        let mut most = |found: usize, most: usize, key: &str, what: &str| {
            if found > most {
                let words = format!("found {found} {what}: this service computes at most {most}");
                all.push((key.to_owned(), words));
            }
        };
        most(cells(study), self.cells, "film.cells_around", "cells");
        most(study.orbit.steps, self.steps, "orbit.steps_per_cycle", "steps per cycle");
        most(study.orbit.max_cycles, self.cycles, "orbit.max_cycles", "cycles");
        let megabytes = |bytes: usize| bytes / 1_000_000;
        most(
            megabytes(study.orbit.memory_bytes),
            megabytes(self.memory_bytes),
            "orbit.memory",
            "MB of memory",
        );
        most(study.parameters.len(), self.parameters, "parameters", "parameters");
        most(cases(study), self.cases, "objective.operating_points", "bearings times operating points");
        // A factor may make a study of the experiments larger than the one it is made of.
        if let Some((run, beyond)) = study
            .experiments()
            .enumerate()
            .find_map(|(k, of)| Some((k + 1, self.exceeded_by(of).into_iter().next()?)))
        {
            all.push(("experiments".to_owned(), format!("run {run}: {}: {}", beyond.0, beyond.1)));
        }
        all
    }

    /// Whether a study is small enough to be computed while the caller waits.
    pub fn is_direct(&self, study: &Study) -> bool {
        (cells(study) * study.orbit.steps * cases(study)) as f64 <= self.direct_work
    }
}

fn cells(study: &Study) -> usize {
    study.film.cells_around * 2 * study.film.cells_across_half
}

/// Bearings times operating points.
fn cases(study: &Study) -> usize {
    study.bearings.len() * study.points.len().max(1)
}

//! What several test modules share.

use std::path::{Path, PathBuf};
use stribeck::film::FilmInput;
use stribeck::run::{Cancel, RunContext, Silent};
use stribeck::study::{Format, Study};

/// A file of this repository.
pub fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Rows of numbers of a CSV file in `tests/data`, comments and head left out.
pub fn table(name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(here("tests/data").join(name)).unwrap();
    let lines = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    lines.map(|l| l.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

/// The study of the main job, changed as text first.
pub fn main_study(changes: &[(&str, &str)]) -> Study {
    let mut text = std::fs::read_to_string(here("studies/operational-170x215.toml")).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "the study does not contain {from:?}");
        text = text.replace(from, to);
    }
    Study::read(&text, Format::Toml, Some(&here("studies")))
        .unwrap_or_else(|e| panic!("{e}: {:#?}", e.faults))
}

/// Sections that make the main study coarse and quick.
pub const COARSE: &str =
    "[film]\ncells_around = 36\ncells_across_half = 4\n[orbit]\nsteps_per_cycle = 240\n[oil]";

/// Runs something that wants a context.
pub fn quietly<T>(f: impl FnOnce(RunContext<'_>) -> T) -> T {
    let cancel = Cancel::default();
    f(RunContext { cancel: &cancel, progress: &Silent })
}

/// A bearing with round numbers: B/D as given, Psi = 1e-3, eta = 0.01 Pa s.
pub fn bearing(eps: f64, width_ratio: f64, speed_rad_s: f64) -> FilmInput {
    FilmInput::at_rest(eps, 0.1 * width_ratio, 0.1, 50e-6, 0.01, speed_rad_s)
}

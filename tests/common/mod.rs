//! What several test modules share.

pub mod films;

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

/// Where the study of the main job stands.
pub const MAIN: &str = "studies/operational-170x215.toml";
/// The same bearing with a smooth Swift-Stieber film and a given film temperature.
pub const SMOOTH: &str = "tests/data/smooth-170x215.toml";

/// The study of the main job, changed as text first.
pub fn main_study(changes: &[(&str, &str)]) -> Study {
    changed_study(MAIN, changes)
}

/// Its smooth sister, changed as text first.
pub fn smooth_study(changes: &[(&str, &str)]) -> Study {
    changed_study(SMOOTH, changes)
}

fn changed_study(path: &str, changes: &[(&str, &str)]) -> Study {
    let mut text = std::fs::read_to_string(here(path)).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "the study does not contain {from:?}");
        text = text.replace(from, to);
    }
    Study::read(&merged(&text), Format::Toml, Some(&here("studies")))
        .unwrap_or_else(|e| panic!("{e}: {:#?}", e.faults))
}

/// A study of this repository in a folder of its own, with its data, each change made once; without the figures it must reproduce as
/// it stands.
pub fn copied_study(folder: &Path, of: &str, changes: &[(&str, &str)]) -> PathBuf {
    let text = std::fs::read_to_string(here(of)).unwrap();
    let mut about = false;
    let lines = text.lines().filter(|l| {
        about = if l.starts_with('[') { matches!(*l, "[expected]" | "[coarse]") } else { about };
        !about
    });
    let mut text: String = lines.map(|l| format!("{l}\n")).collect();
    for (from, to) in changes {
        assert!(text.contains(from), "the study does not contain {from:?}");
        text = text.replacen(from, to, 1);
    }
    std::fs::create_dir_all(folder.join("data")).unwrap();
    let data = "data/engine_pressure_170x215_digitised.csv";
    std::fs::copy(here("studies").join(data), folder.join(data)).unwrap();
    let path = folder.join("study.toml");
    std::fs::write(&path, merged(&text)).unwrap();
    path
}

/// Holds the example on the page of a module against the lines of the test that runs it.
pub fn assert_example(test: &str, page: &str, least_lines: usize) {
    let between = |text: &str, from: &str, to: &str| -> String {
        let lines = text.lines().skip_while(|l| *l != from).skip(1);
        lines.take_while(|l| *l != to).map(|l| format!("{l}\n")).collect()
    };
    let tested = std::fs::read_to_string(here(test)).unwrap();
    let tested = between(&tested, "// The example begins here.", "// The example ends here.");
    let text = std::fs::read_to_string(here(page)).unwrap();
    let lines = text.lines().map_while(|l| l.strip_prefix("//!"));
    let shown: String = lines.map(|l| format!("{}\n", l.strip_prefix(' ').unwrap_or(l))).collect();
    let shown = between(&shown, "```no_run", "```");
    assert!(tested.lines().count() > least_lines && tested == shown, "copy the example to {page}:\n{tested}");
}

/// The text with every section that stands twice put together; later keys replace earlier ones.
pub fn merged(text: &str) -> String {
    let mut sections: Vec<(String, Vec<String>)> = vec![(String::new(), Vec::new())];
    let mut at = 0;
    for line in text.lines() {
        if line.starts_with('[') {
            let known = sections.iter().position(|(head, _)| head == line && !line.starts_with("[["));
            at = known.unwrap_or(sections.len());
            if known.is_none() {
                sections.push((line.to_owned(), Vec::new()));
            }
            continue;
        }
        if let Some((key, _)) = line.split_once(" = ") {
            let same = |l: &String| l.split_once(" = ").is_some_and(|(k, _)| k == key);
            if at > 0 && !key.starts_with(' ') {
                sections[at].1.retain(|l| !same(l));
            }
        }
        sections[at].1.push(line.to_owned());
    }
    let all = sections.iter().flat_map(|(head, lines)| std::iter::once(head).chain(lines));
    all.skip(1).map(|l| format!("{l}\n")).collect()
}

/// The program, without colours and for five minutes at most.
pub fn stribeck() -> assert_cmd::Command {
    let mut command = assert_cmd::Command::cargo_bin("stribeck").unwrap();
    command.timeout(std::time::Duration::from_secs(300)).env("NO_COLOR", "1");
    command
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

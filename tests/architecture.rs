//! The floors of the house: a module uses only what stands below it, rooms stay small, nobody imports upwards.

use crate::common::here;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Floors from the ground up; modules of one floor do not know each other.
const FLOORS: &[&[&str]] = &[
    &["math", "units", "run"],
    &["laws", "dae"],
    &["film"],
    &["cranktrain"],
    &["orbit"],
    &["gradient"],
    &["optimise", "running_in"],
    &["report"],
    &["study"],
    &["service"],
    &["cli"],
];

/// Outside crates that have one room.
const ROOMS: &[(&str, &str)] = &[
    ("argmin", "optimise"),
    ("clarabel", "optimise"),
    ("clap", "cli"),
    ("indicatif", "cli"),
    ("comfy_table", "cli"),
    ("owo_colors", "cli"),
    ("miette", "cli"),
    ("ctrlc", "cli"),
    ("kuva", "report"),
    ("minijinja", "report"),
    ("terminal_size", "cli"),
    ("sobol_burley", "optimise"),
    ("base64", "service"),
    ("jsonc_parser", "study"),
    ("toml", "study"),
    ("num_dual", "dae"),
    ("axum", "service"),
    ("sqlx", "service"),
    ("utoipa", "service"),
    ("tower_http", "service"),
    ("governor", "service"),
    ("metrics", "service"),
];

fn sources() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![here("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                found.push((path, text));
            }
        }
    }
    found.sort();
    found
}

fn module(path: &Path) -> String {
    let inside = path.strip_prefix(here("src")).unwrap();
    inside.iter().next().unwrap().to_string_lossy().trim_end_matches(".rs").to_owned()
}

fn floor(module: &str) -> usize {
    FLOORS.iter().position(|f| f.contains(&module)).unwrap_or_else(|| panic!("{module} stands on no floor"))
}

/// Names that follow `crate::` in the code; comments may point anywhere.
fn uses(text: &str) -> Vec<String> {
    let code: String =
        text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    code.split("crate::")
        .skip(1)
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>())
        .filter(|name| name.chars().next().is_some_and(char::is_lowercase))
        .collect()
}

#[test]
fn nobody_imports_upwards() {
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        let from = module(&path);
        if from == "lib" || from == "main" {
            continue;
        }
        for to in uses(&text).into_iter().filter(|to| *to != from) {
            if floor(&to) >= floor(&from) {
                wrong.push(format!("{} uses {to}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn outside_crates_stay_in_their_rooms() {
    for (path, text) in sources() {
        for (name, room) in ROOMS {
            let used = text.lines().any(|l| {
                l.trim_start().starts_with(&format!("use {name}::"))
                    || l.contains(&format!("{name}::")) && !l.trim_start().starts_with("//")
            });
            let plain_report = *name == "toml" && module(&path) == "report";
            assert!(!used || module(&path) == *room || plain_report, "{name} is used in {}", path.display());
        }
    }
}

#[test]
fn rooms_are_small_and_say_what_they_are() {
    let mut sizes = Vec::new();
    for (path, text) in sources() {
        assert!(text.starts_with("//!"), "{} does not say what it is", path.display());
        sizes.push(text.lines().count());
        let todo = ["todo!", "unimplemented!", "dbg!"];
        assert!(!todo.iter().any(|t| text.contains(t)), "{} is unfinished", path.display());
    }
    sizes.sort_unstable();
    assert!(sizes[sizes.len() / 2] < 200, "median file of {} lines", sizes[sizes.len() / 2]);
}

#[test]
fn floors_are_those_of_the_crate_page() {
    let page = std::fs::read_to_string(here("src/lib.rs")).unwrap();
    let declared: Vec<&str> =
        page.lines().filter_map(|l| l.strip_prefix("pub mod ")).map(|l| l.trim_end_matches(';')).collect();
    let mut seen = BTreeMap::new();
    for name in FLOORS.iter().flat_map(|f| f.iter()) {
        assert!(declared.contains(name), "{name} is no module");
        assert!(page.contains(&format!("[`{name}`]")), "the crate page does not name {name}");
        *seen.entry(*name).or_insert(0) += 1;
    }
    assert_eq!(seen.len(), declared.len(), "modules without a floor");
}

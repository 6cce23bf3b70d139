//! How experiments are laid out: factors with their levels, and the studies that come of them, each checked.
//!
//! A grid holds every combination (the last factor changes fastest). A Latin hypercube and Sobol's sequence give points of the
//! unit box; a factor between bounds takes the value there, a factor with a list the entry of that share of the list.
//! Deliberately not here: what is done with the studies.

use super::check::Study;
use super::factors::{Factor, Level, factor};
use super::faults::Faults;
use super::file::{EachName, ExperimentsFile, PlanName, StudyFile};
use super::variant::{Wrong, variant};
use crate::optimise::{latin_hypercube, sobol};
use serde_json::Value;
use std::path::Path;

const PATH: &str = "experiments";
/// Runs at most, if nobody says less.
const MOST: usize = 2000;

/// Checked experiments.
#[derive(Debug, Clone)]
pub(super) struct ExperimentsPlan {
    pub plan: PlanName,
    pub each: EachName,
    pub factors: Vec<Factor>,
    pub runs: Vec<RunPlan>,
}

/// One of them.
#[derive(Debug, Clone)]
pub(super) struct RunPlan {
    /// Level of every factor.
    pub levels: Vec<Level>,
    pub study: Study,
}

/// Experiments as written, checked by themselves.
pub(super) struct Layout {
    plan: PlanName,
    each: EachName,
    seed: u64,
    runs: usize,
    factors: Vec<Factor>,
}

/// Keys that say something about a study, and sections that make many of it: no factors.
const WORDS: [&str; 8] =
    ["format", "title", "question", "assumptions", "expected", "coarse", "choices", "experiments"];

/// Whether a path is another one or lies below it.
fn within(above: &str, path: &str) -> bool {
    path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

fn at(key: &str) -> String {
    format!("{PATH}.{key}")
}

/// The experiments as written, their defaults written in; mistakes are told whatever else is wrong.
pub(super) fn layout(file: &mut StudyFile, most: Option<usize>, faults: &mut Faults) -> Option<Layout> {
    faults.get(&file.experiments, PATH);
    let alone = [
        (file.choices.is_absent(), "choices"),
        (file.characteristic.is_absent(), "characteristic"),
        (file.comparison.is_absent(), "comparison"),
    ];
    let super::Given::Value(e) = &mut file.experiments else { return None };
    for (_, other) in alone.iter().filter(|(absent, _)| !absent) {
        faults.add(PATH, format!("cannot stand beside {other}: remove one of them"));
    }
    faults.unknown::<ExperimentsFile>(&e.unknown, PATH);
    let plan = faults.or(&mut e.plan, &at("plan"), PlanName::Grid);
    let each = faults.or(&mut e.each, &at("each"), EachName::Simulate);
    let drawn = plan != PlanName::Grid;
    let (mut runs, mut seed) = (None, 1);
    if drawn {
        runs = faults.need(&e.runs, &at("runs"));
        seed = faults.or(&mut e.seed, &at("seed"), 1);
        faults.range(runs.map(|r| r as f64), &at("runs"), |v| v >= 2.0, "at least 2");
    } else {
        let why = "a grid has as many runs as combinations of levels";
        faults.unused(&e.runs, &at("runs"), why);
        faults.unused(&e.seed, &at("seed"), "a grid draws nothing");
    }
    faults.need(&e.factors, &at("factors"));
    let super::Given::Value(list) = &mut e.factors else { return None };
    let wanted = list.len();
    if list.is_empty() {
        faults.add(&at("factors"), "needs at least one [[experiments.factors]]");
    }
    let mut factors: Vec<Factor> = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{PATH}.factors[{i}]");
        faults.get(given, &path);
        let super::Given::Value(one) = given else { continue };
        let Some(found) = factor(one, &path, drawn, faults) else { continue };
        let meets = |k: &&str| factors.iter().any(|f| f.keys().any(|o| within(o, k) || within(k, o)));
        if let Some(twice) = found.keys().find(meets) {
            faults.add(&path, format!("\"{twice}\" is varied by an earlier factor already"));
        }
        if let Some(key) = found.keys().find(|k| WORDS.iter().any(|w| within(w, k))) {
            faults.add(&path, format!("\"{key}\" has no effect on an answer"));
        }
        factors.push(found);
    }
    let count = runs.unwrap_or_else(|| factors.iter().fold(1, |n: usize, f| n.saturating_mul(f.levels())));
    let most = most.unwrap_or(MOST);
    if count > most {
        faults.add(PATH, format!("have {count} runs; at most {most} are made"));
        return None;
    }
    (factors.len() == wanted && (runs.is_some() || !drawn)).then_some(Layout {
        plan,
        each,
        seed,
        runs: count,
        factors,
    })
}

impl Layout {
    /// The levels of every run.
    fn rows(&self) -> Vec<Vec<Level>> {
        let points = match self.plan {
            PlanName::Grid => {
                return (0..self.runs).map(|k| self.combination(k)).collect();
            }
            PlanName::LatinHypercube => latin_hypercube(self.runs, self.factors.len(), self.seed),
            PlanName::Sobol => sobol(self.runs, self.factors.len(), self.seed),
        };
        let row = |point: &Vec<f64>| self.factors.iter().zip(point).map(|(f, u)| f.drawn(*u)).collect();
        points.iter().map(row).collect()
    }

    fn combination(&self, mut k: usize) -> Vec<Level> {
        let mut levels = Vec::new();
        for f in self.factors.iter().rev() {
            levels.push(f.level(k % f.levels()));
            k /= f.levels();
        }
        levels.reverse();
        levels
    }
}

/// The studies of the experiments; `raw` is the study as written.
pub(super) fn experiments(
    layout: Option<Layout>,
    raw: &Value,
    base: Option<&Path>,
    faults: &mut Faults,
) -> Option<ExperimentsPlan> {
    let layout = layout.filter(|_| !faults.any())?;
    let (mut runs, mut wrong) = (Vec::new(), Vec::new());
    for (k, levels) in layout.rows().into_iter().enumerate() {
        let set = levels.iter().flat_map(|l| l.set.iter().map(|(key, to)| (key.as_str(), to)));
        match variant(raw, set, base) {
            Ok(study) => runs.push(RunPlan { levels, study }),
            Err(e) => wrong.push((k, levels, e)),
        }
    }
    let others = wrong.len().saturating_sub(1);
    if let Some((k, levels, first)) = wrong.into_iter().next() {
        let text = |(l, f): (&Level, &Factor)| format!("{} {}", l.text, f.unit).trim_end().to_owned();
        let texts: Vec<String> = levels.iter().zip(&layout.factors).map(text).collect();
        let more =
            if others > 0 { format!(" ({others} more of the runs have mistakes)") } else { String::new() };
        let list = match first {
            Wrong::Mistakes(list) => list,
            Wrong::NoPlace(key) => vec![(key, "there is no such place in this study".to_owned())],
        };
        for (path, message) in list {
            let words = format!("run {} ({}): {path}: {message}{more}", k + 1, texts.join(", "));
            faults.add(&guilty(&layout.factors, &path), words);
        }
        return None;
    }
    let Layout { plan, each, factors, .. } = layout;
    Some(ExperimentsPlan { plan, each, factors, runs })
}

/// The factor whose key, or one above or below it, a mistake is about.
fn guilty(factors: &[Factor], path: &str) -> String {
    let about = |f: &&Factor| f.keys().any(|k| path.starts_with(k) || k.starts_with(path));
    let found = factors.iter().position(|f| about(&f));
    found.map_or_else(|| PATH.to_owned(), |i| format!("{PATH}.factors[{i}]"))
}

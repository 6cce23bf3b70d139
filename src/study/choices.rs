//! Choices from lists: the study with each combination of options is a study of its own, checked with it and searched one after
//! the other, each from the design before; the best one is the answer.

use super::check::Study;
use super::faults::{Faults, join};
use super::file::{ChoiceFile, OptionFile, StudyFile};
use super::searches::{Searched, rank, searches};
use super::variant::{Wrong, variant};
use crate::optimise::Outcome;
use crate::report::{ChoiceReport, ChoiceRun, ChoicesReport};
use crate::run::{Cost, Event, RunContext, Store};
use serde_json::Value;
use std::path::Path;

const PATH: &str = "choices";
/// Combinations that are searched at most.
const MOST: usize = 200;

/// Checked choices.
#[derive(Debug, Clone)]
pub(super) struct Choices {
    /// Names of the choices with those of their options.
    pub lists: Vec<(String, Vec<String>)>,
    /// Every combination: which option of each choice, and the study with them.
    pub variants: Vec<(Vec<usize>, Study)>,
}

/// A choice as written, checked by itself.
pub(super) struct List {
    name: String,
    options: Vec<(String, Vec<(String, Value)>)>,
}

/// The choices as written; mistakes are told whatever else is wrong.
pub(super) fn lists(file: &StudyFile, faults: &mut Faults) -> Vec<List> {
    let given = faults.get(&file.choices, PATH).unwrap_or_default();
    let mut lists: Vec<List> = Vec::new();
    for (i, given) in given.iter().enumerate() {
        let path = format!("{PATH}[{i}]");
        let Some(choice) = faults.get(given, &path) else { continue };
        let Some(list) = one(&choice, &path, faults) else { continue };
        let keys = |l: &List| -> Vec<String> {
            l.options.iter().flat_map(|(_, set)| set.iter().map(|(key, _)| key.clone())).collect()
        };
        if lists.iter().any(|other| other.name == list.name) {
            faults.add(&join(&path, "name"), "stands twice");
        }
        let earlier: Vec<String> = lists.iter().flat_map(keys).collect();
        if let Some(twice) = keys(&list).iter().find(|key| earlier.contains(key)) {
            faults.add(&join(&path, "options"), format!("\"{twice}\" is set by an earlier choice already"));
        }
        lists.push(list);
    }
    let count = lists.iter().map(|l| l.options.len()).product::<usize>();
    if count > MOST {
        faults.add(PATH, format!("have {count} combinations; at most {MOST} are searched"));
    }
    lists
}

/// The variants of a study with choices; `raw` is the study as written.
pub(super) fn choices(
    lists: Vec<List>,
    raw: &Value,
    base: Option<&Path>,
    faults: &mut Faults,
) -> Option<Choices> {
    if lists.is_empty() || faults.any() {
        return None;
    }
    let count = lists.iter().map(|l| l.options.len()).product::<usize>();
    let mut variants = Vec::new();
    for k in 0..count {
        let picks = picks(&lists, k);
        variants.extend(combined(&lists, &picks, raw, base, faults).map(|study| (picks, study)));
    }
    let names = |l: List| (l.name, l.options.into_iter().map(|(name, _)| name).collect());
    Some(Choices { lists: lists.into_iter().map(names).collect(), variants })
}

fn one(choice: &ChoiceFile, path: &str, faults: &mut Faults) -> Option<List> {
    faults.unknown::<ChoiceFile>(&choice.unknown, path);
    let name = faults.need(&choice.name, &join(path, "name"));
    let at = join(path, "options");
    let given = faults.need(&choice.options, &at)?;
    if given.len() < 2 {
        faults.add(&at, "needs at least two options");
    }
    let mut options: Vec<(String, Vec<(String, Value)>)> = Vec::new();
    for (k, given) in given.iter().enumerate() {
        let at = format!("{at}[{k}]");
        let Some(option) = faults.get(given, &at) else { continue };
        faults.unknown::<OptionFile>(&option.unknown, &at);
        let name = faults.need(&option.name, &join(&at, "name"));
        let Some(set) = faults.need(&option.set, &join(&at, "set")) else { continue };
        if name.as_ref().is_some_and(|n| options.iter().any(|(other, _)| other == n)) {
            faults.add(&join(&at, "name"), "stands twice");
        }
        for key in set.keys() {
            if key == PATH || key.starts_with("choices[") || key.starts_with("choices.") {
                faults.add(&join(&at, "set"), "a choice cannot set choices");
            }
        }
        options.push((name.unwrap_or_default(), set.into_iter().collect()));
    }
    Some(List { name: name?, options })
}

/// Which option of each choice the combination `k` takes; the last choice changes fastest.
fn picks(lists: &[List], mut k: usize) -> Vec<usize> {
    let mut picks = vec![0; lists.len()];
    for (pick, list) in picks.iter_mut().zip(lists).rev() {
        (*pick, k) = (k % list.options.len(), k / list.options.len());
    }
    picks
}

fn combined(
    lists: &[List],
    picks: &[usize],
    raw: &Value,
    base: Option<&Path>,
    faults: &mut Faults,
) -> Option<Study> {
    let at = |c: usize| format!("{PATH}[{c}].options[{}]", picks[c]);
    let set = lists.iter().zip(picks).flat_map(|(list, pick)| &list.options[*pick].1);
    let found = variant(raw, set.map(|(key, to)| (key.as_str(), to)), base);
    // At the option that sets the key, or a key above it, if one does.
    let guilty = |path: &str| {
        let sets =
            |c: &usize| lists[*c].options[picks[*c]].1.iter().any(|(key, _)| path.starts_with(key.as_str()));
        (0..lists.len()).find(sets).map_or_else(|| PATH.to_owned(), at)
    };
    match found {
        Ok(study) => return Some(study),
        Err(Wrong::NoPlace(key)) => {
            faults.add(&join(&guilty(&key), "set"), format!("there is no place '{key}' in this study"));
        }
        Err(Wrong::Mistakes(list)) => {
            let taken: Vec<&str> = lists.iter().zip(picks).map(|(l, p)| l.options[*p].0.as_str()).collect();
            for (path, message) in list {
                faults.add(&guilty(&path), format!("with \"{}\": {path}: {message}", taken.join("\", \"")));
            }
        }
    }
    None
}

/// Searches every combination; returns the study that won with what was found, and the table.
pub(super) fn choose<'r, 's>(
    choices: &'s Choices,
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> Result<(&'s Study, Searched<'r>, ChoicesReport), String> {
    let mut best: Option<(usize, Searched<'r>)> = None;
    let mut runs = Vec::new();
    let (mut simulations, mut gradients) = (Cost::default(), Cost::default());
    let mut reason = String::new();
    for (k, (picks, study)) in choices.variants.iter().enumerate() {
        if context.cancel.is_cancelled() && best.is_some() {
            break;
        }
        let names = names(choices, picks);
        let name = format!("choice {} of {}: {}", k + 1, choices.variants.len(), names.join(", "));
        context.progress.tell(&Event::Stage { name });
        let from = best.as_ref().map(|(j, found)| beside(&choices.variants[*j].1, &found.minimum.x, study));
        let found = match searches(study, from.as_deref(), &format!("choice-{k}-"), context, store) {
            Ok(found) => found,
            Err(e) => {
                runs.push(failed(names));
                reason = e;
                continue;
            }
        };
        runs.push(run(study, names, &found));
        let (loser, winner) = match best.take() {
            Some((j, earlier)) if rank(&earlier.minimum) <= rank(&found.minimum) => {
                (Some(found), (j, earlier))
            }
            Some((_, earlier)) => (Some(earlier), (k, found)),
            None => (None, (k, found)),
        };
        if let Some(loser) = loser {
            let (own, beyond) = loser.plan.problem.costs();
            simulations += own + loser.others.0;
            gradients += beyond + loser.others.1;
        }
        best = Some(winner);
    }
    let (k, mut found) = best.ok_or(reason)?;
    found.others.0 += simulations;
    found.others.1 += gradients;
    let (picks, study) = &choices.variants[k];
    let taken = choices
        .lists
        .iter()
        .zip(picks)
        .map(|((name, options), p)| ChoiceReport { name: name.clone(), taken: options[*p].clone() });
    let report = ChoicesReport {
        taken: taken.collect(),
        parameters: study.parameters.iter().map(|p| p.name.clone()).collect(),
        units: study.parameters.iter().map(|p| p.variable.unit.to_owned()).collect(),
        runs,
    };
    Ok((study, found, report))
}

/// A start for one study from the design of another: parameters of the same name, moved into the box; the others from their own start.
fn beside(other: &Study, x: &[f64], study: &Study) -> Vec<f64> {
    let of = |p: &super::ParameterPlan| {
        let known = other.parameters.iter().position(|o| o.name == p.name);
        known.map_or(p.start, |j| x[j].clamp(p.lower, p.upper))
    };
    study.parameters.iter().map(of).collect()
}

fn names(choices: &Choices, picks: &[usize]) -> Vec<String> {
    choices.lists.iter().zip(picks).map(|((_, options), p)| options[*p].clone()).collect()
}

fn failed(options: Vec<String>) -> ChoiceRun {
    ChoiceRun {
        options,
        status: Outcome::StartFailed,
        loss_w: None,
        violation: None,
        simulations: 0,
        design: Vec::new(),
    }
}

fn run(study: &Study, options: Vec<String>, found: &Searched) -> ChoiceRun {
    let end = &found.minimum;
    ChoiceRun {
        options,
        status: end.outcome,
        loss_w: end.values.as_ref().map(|v| v.objective),
        violation: end.values.as_ref().map(|v| v.violation()),
        simulations: (found.plan.problem.costs().0 + found.others.0).simulations
            / found.plan.cases.len() as u64,
        design: end.x.iter().zip(&study.parameters).map(|(x, p)| p.variable.shown(*x)).collect(),
    }
}

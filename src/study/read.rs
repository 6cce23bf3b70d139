//! From text to a study: values, what is set from outside or by the coarse setting, the checks, and what a study says about itself.

use super::check::{Study, check};
use super::choices::{self, List};
use super::document::{Format, parse};
use super::faults::{Fault, Faults, StudyErrors, line_of};
use super::file::StudyFile;
use super::place::put;
use super::{expected, layout};
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;

const COARSE: &str = "coarse";

/// How a study is read.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reading<'a> {
    /// Folder below which tables in files are looked for; without it no file is read.
    pub base: Option<&'a Path>,
    /// Whether the study's coarse setting counts.
    pub coarse: bool,
    /// Values that replace those of the file, by the path of their key.
    pub set: &'a [(String, Value)],
    /// Runs that experiments may have; every one of them is checked. None: 2000.
    pub most_runs: Option<usize>,
}

/// A key with its value from `KEY=VALUE`: as TOML would read the value, or else as text.
///
/// # Errors
/// In words, if there is no key.
pub fn setting(text: &str) -> Result<(String, Value), String> {
    let (key, value) = text.split_once('=').ok_or("expected KEY=VALUE, like film.cells_around=80")?;
    let (key, value) = (key.trim(), value.trim());
    if key.is_empty() {
        return Err("expected a key before the =".to_owned());
    }
    let parsed: Option<toml::Table> = toml::from_str(&format!("value = {value}")).ok();
    let parsed = parsed.and_then(|mut table| serde_json::to_value(table.remove("value")?).ok());
    Ok((key.to_owned(), parsed.unwrap_or_else(|| Value::String(value.to_owned()))))
}

impl Study {
    /// Reads and checks a study. Tables in files are looked for below `base`; without a base no file is read.
    pub fn read(text: &str, format: Format, base: Option<&Path>) -> Result<Self, StudyErrors> {
        Self::read_with(text, format, &Reading { base, ..Reading::default() })
    }

    /// The same with some keys replaced.
    pub fn read_with(text: &str, format: Format, with: &Reading<'_>) -> Result<Self, StudyErrors> {
        let (mut value, spans) = parse(text, format).map_err(|errors| {
            let faults = errors.into_iter().map(|(message, span)| Fault {
                path: String::new(),
                message,
                line: Some(line_of(text, span.start)),
                span: Some(span),
            });
            StudyErrors { faults: faults.collect(), text: text.to_owned() }
        })?;
        let early = replaced(&mut value, with);
        let mut faults = Faults::of(value.clone());
        early.iter().for_each(|(path, message)| faults.add(path, message));
        let study = document(&value, with, &mut faults);
        if let (Some(study), false) = (study, faults.any()) {
            return Ok(study);
        }
        let mut faults: Vec<Fault> = faults
            .into_list()
            .into_iter()
            .map(|(path, message)| {
                let span = spans.find(&path);
                Fault { line: span.as_ref().map(|s| line_of(text, s.start)), path, message, span }
            })
            .collect();
        faults.sort_by_key(|f| f.line);
        faults.dedup();
        Err(StudyErrors { faults, text: text.to_owned() })
    }
}

/// Replaces what is set from outside, after what the coarse setting says; returns what has no place.
fn replaced(value: &mut Value, with: &Reading<'_>) -> Vec<(String, String)> {
    let mut wrong = Vec::new();
    let no_place = |key: &str| format!("there is no place '{key}' in this study");
    if with.coarse {
        let setting = value.get(COARSE).and_then(Value::as_object).cloned();
        if setting.is_none() {
            wrong.push((COARSE.to_owned(), "is missing: the study has no coarse setting".to_owned()));
        }
        for (key, to) in setting.unwrap_or_default() {
            if put(value, &key, to).is_none() {
                wrong.push((COARSE.to_owned(), no_place(&key)));
            }
        }
    }
    for (key, to) in with.set {
        if put(value, key, to.clone()).is_none() {
            wrong.push((String::new(), format!("cannot be set: {}", no_place(key))));
        }
    }
    wrong
}

/// The study of a document, with all that is made of it.
fn document(value: &Value, with: &Reading<'_>, faults: &mut Faults) -> Option<Study> {
    let mut file = match StudyFile::deserialize(value.clone()) {
        Ok(file) => file,
        Err(e) => {
            faults.add("", format!("the file must be a table of sections ({e})"));
            return None;
        }
    };
    let lists: Vec<List> = choices::lists(&file, faults);
    let mut expected = expected::expected(&mut file, with.coarse, faults);
    if !with.set.is_empty() {
        // They are those of the study as it is written.
        expected.clear();
    }
    let layout = layout::layout(&mut file, with.most_runs, faults);
    let study = check(file, with.base, faults)?;
    if !with.coarse {
        coarse(&study.file, value, with, faults);
    }
    let choices = choices::choices(lists, value, with.base, faults);
    let experiments = layout::experiments(layout, value, with.base, faults);
    Some(Study { choices, experiments, expected, coarse: with.coarse, ..study })
}

/// A coarse setting that is not used is checked all the same: the study with it must be one, too.
fn coarse(file: &StudyFile, value: &Value, with: &Reading<'_>, faults: &mut Faults) {
    let given = faults.get(&file.coarse, COARSE).is_some();
    if !given || faults.any() {
        return;
    }
    let (mut value, with) = (value.clone(), Reading { coarse: true, set: &[], ..*with });
    replaced(&mut value, &with).iter().for_each(|(path, message)| faults.add(path, message));
    let mut own = Faults::of(value.clone());
    document(&value, &with, &mut own);
    own.into_list()
        .iter()
        .for_each(|(path, message)| faults.add(COARSE, format!("with it: {path}: {message}")));
}

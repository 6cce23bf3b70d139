//! A study with other values at some of its keys: what choices, experiments and the coarse setting are made of.

use super::check::{Study, check};
use super::faults::Faults;
use super::file::StudyFile;
use super::place::put;
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;

/// Sections that make many studies of one, or speak about it; none of them belongs to a variant.
const ABOUT: [&str; 4] = ["choices", "experiments", "expected", "coarse"];

/// Why there is no such study.
pub(super) enum Wrong {
    /// A key has no place in it.
    NoPlace(String),
    /// Its mistakes, path and words.
    Mistakes(Vec<(String, String)>),
}

/// The study as written, with the values of some keys replaced.
pub(super) fn variant<'v>(
    raw: &Value,
    set: impl IntoIterator<Item = (&'v str, &'v Value)>,
    base: Option<&Path>,
) -> Result<Study, Wrong> {
    let mut value = raw.clone();
    if let Some(map) = value.as_object_mut() {
        ABOUT.iter().for_each(|section| drop(map.remove(*section)));
    }
    for (key, to) in set {
        if put(&mut value, key, to.clone()).is_none() {
            return Err(Wrong::NoPlace(key.to_owned()));
        }
    }
    let mut faults = Faults::of(value.clone());
    let study = StudyFile::deserialize(value).ok().and_then(|file| check(file, base, &mut faults));
    study.ok_or_else(|| Wrong::Mistakes(faults.into_list()))
}

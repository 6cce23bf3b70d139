//! Factors of experiments: a list of levels, or a range of a quantity with its unit.

use super::faults::{Faults, join};
use super::file::{FactorFile, OptionFile, SpacingName};
use crate::units::{split, tidy};
use serde_json::Value;

/// Relative difference of two ratios of refinement that are one.
const SAME_RATIO: f64 = 1e-6;

/// A level of a factor.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Level {
    /// As a table shows it.
    pub text: String,
    /// Its number in the factor's unit, if it is one.
    pub number: Option<f64>,
    /// Keys and what they become.
    pub set: Vec<(String, Value)>,
}

/// Something that is varied.
#[derive(Debug, Clone)]
pub(super) struct Factor {
    pub name: String,
    /// Unit of all numbers; empty for plain numbers and words.
    pub unit: String,
    /// Ratio by which every level refines the one before.
    pub ratio: Option<f64>,
    domain: Domain,
}

#[derive(Debug, Clone)]
enum Domain {
    List(Vec<Level>),
    Range { key: String, lower: f64, upper: f64, whole: bool, logarithmic: bool, levels: usize },
}

impl Factor {
    /// Keys it sets.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        let (key, list) = match &self.domain {
            Domain::Range { key, .. } => (Some(key.as_str()), None),
            Domain::List(levels) => (None, levels.first()),
        };
        key.into_iter().chain(list.into_iter().flat_map(|l| l.set.iter().map(|(k, _)| k.as_str())))
    }

    /// Levels in a grid.
    pub fn levels(&self) -> usize {
        match &self.domain {
            Domain::List(levels) => levels.len(),
            Domain::Range { levels, .. } => *levels,
        }
    }

    /// Level `k` of a grid.
    pub fn level(&self, k: usize) -> Level {
        match &self.domain {
            Domain::List(levels) => levels[k].clone(),
            Domain::Range { levels, .. } => self.drawn(k as f64 / (*levels - 1).max(1) as f64),
        }
    }

    /// The level at a share of the range, or of the list.
    pub fn drawn(&self, share: f64) -> Level {
        match &self.domain {
            Domain::List(levels) => {
                levels[((share * levels.len() as f64) as usize).min(levels.len() - 1)].clone()
            }
            Domain::Range { key, lower, upper, whole, logarithmic, .. } => {
                let v = match logarithmic {
                    true => lower * (upper / lower).powf(share),
                    false => lower + share * (upper - lower),
                };
                let v = tidy(if *whole { v.round() } else { v });
                level(vec![key.clone()], v, *whole, &self.unit)
            }
        }
    }
}

fn level(keys: Vec<String>, number: f64, whole: bool, unit: &str) -> Level {
    let value = match (unit.is_empty(), whole) {
        (true, true) => Value::from(number as i64),
        (true, false) => Value::from(number),
        (false, _) => Value::from(format!("{number} {unit}")),
    };
    let text = crate::report::short(number);
    let set = keys.into_iter().map(|key| (key, value.clone())).collect();
    Level { text, number: Some(number), set }
}

/// Number and unit of a value; whether it is a whole number without unit.
fn quantity(value: &Value) -> Option<(f64, String, bool)> {
    match value {
        Value::Number(n) => Some((n.as_f64()?, String::new(), n.is_i64() || n.is_u64())),
        Value::String(text) => {
            let (number, unit) = split(text);
            let number = number.parse().ok().filter(|v: &f64| v.is_finite())?;
            Some((number, unit.to_owned(), false))
        }
        _ => None,
    }
}

/// A factor as written; `drawn`: levels are drawn from it, not counted.
pub(super) fn factor(file: &mut FactorFile, path: &str, drawn: bool, faults: &mut Faults) -> Option<Factor> {
    faults.unknown::<FactorFile>(&file.unknown, path);
    let at = |key: &str| join(path, key);
    let refines = faults.or(&mut file.refinement, &at("refinement"), false);
    let mut made = if !file.options.is_absent() {
        let why = "options say what is set";
        faults.unused(&file.key, &at("key"), why);
        faults.unused(&file.values, &at("values"), why);
        refuse_range(file, path, why, faults);
        options(file, path, faults)
    } else if !file.values.is_absent() {
        refuse_range(file, path, "values are given", faults);
        values(file, path, faults)
    } else if file.lower.is_absent() && file.upper.is_absent() {
        faults.add(path, "needs values, or lower and upper, or options");
        None
    } else {
        range(file, path, drawn, faults)
    }?;
    if refines {
        made.ratio = ratio(&made, path, drawn, faults);
    }
    Some(made)
}

fn refuse_range(file: &FactorFile, path: &str, why: &str, faults: &mut Faults) {
    faults.unused(&file.lower, &join(path, "lower"), why);
    faults.unused(&file.upper, &join(path, "upper"), why);
    faults.unused(&file.levels, &join(path, "levels"), why);
    faults.unused(&file.spacing, &join(path, "spacing"), why);
}

fn options(file: &FactorFile, path: &str, faults: &mut Faults) -> Option<Factor> {
    let name = faults.need(&file.name, &join(path, "name"));
    let mut levels = Vec::new();
    let given = faults.get(&file.options, &join(path, "options"))?;
    for (k, given) in given.iter().enumerate() {
        let at = format!("{path}.options[{k}]");
        let Some(option) = faults.get(given, &at) else { continue };
        faults.unknown::<OptionFile>(&option.unknown, &at);
        let text = faults.need(&option.name, &join(&at, "name"));
        let set = faults.need(&option.set, &join(&at, "set"));
        if let (Some(text), Some(set)) = (text, set) {
            levels.push(Level { text, number: None, set: set.into_iter().collect() });
        }
    }
    if given.len() < 2 {
        faults.add(&join(path, "options"), "needs at least two options");
    }
    (levels.len() == given.len() && levels.len() > 1).then_some(Factor {
        name: name?,
        unit: String::new(),
        ratio: None,
        domain: Domain::List(levels),
    })
}

fn values(file: &mut FactorFile, path: &str, faults: &mut Faults) -> Option<Factor> {
    let key = faults.need(&file.key, &join(path, "key"));
    let name = faults.or(&mut file.name, &join(path, "name"), key.clone().unwrap_or_default());
    let given = faults.get(&file.values, &join(path, "values"))?;
    if given.len() < 2 {
        faults.add(&join(path, "values"), "needs at least two values");
        return None;
    }
    if (1..given.len()).any(|k| given[..k].contains(&given[k])) {
        faults.add(&join(path, "values"), "hold a value twice");
    }
    let key = key?;
    let found: Vec<Option<(f64, String, bool)>> = given.iter().map(quantity).collect();
    let unit = found[0].as_ref().map(|q| q.1.clone());
    let numbers = found.iter().all(|q| q.as_ref().map(|q| &q.1) == unit.as_ref() && q.is_some());
    let one = |(value, q): (&Value, &Option<(f64, String, bool)>)| {
        let number = q.as_ref().filter(|_| numbers).map(|q| q.0);
        let plain = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let text = number.map_or(plain, crate::report::short);
        Level { text, number, set: vec![(key.clone(), value.clone())] }
    };
    let levels = given.iter().zip(&found).map(one).collect();
    let unit = unit.filter(|_| numbers).unwrap_or_default();
    Some(Factor { name, unit, ratio: None, domain: Domain::List(levels) })
}

fn range(file: &mut FactorFile, path: &str, drawn: bool, faults: &mut Faults) -> Option<Factor> {
    let at = |key: &str| join(path, key);
    let key = faults.need(&file.key, &at("key"));
    let name = faults.or(&mut file.name, &at("name"), key.clone().unwrap_or_default());
    let (lower, upper) = (faults.need(&file.lower, &at("lower")), faults.need(&file.upper, &at("upper")));
    let spacing = faults.or(&mut file.spacing, &at("spacing"), SpacingName::Linear);
    let levels = match drawn {
        true => {
            faults.unused(&file.levels, &at("levels"), "levels are drawn");
            Some(2)
        }
        false => faults.need(&file.levels, &at("levels")),
    };
    let mut read = |value: Option<Value>, key: &str| {
        let value = value?;
        let found = quantity(&value);
        if found.is_none() {
            faults.add(&at(key), "must be a number, or a number with its unit in quotes");
        }
        found
    };
    let (lower, upper) = (read(lower, "lower"), read(upper, "upper"));
    let ((low, unit, whole), (high, other, whole_too)) = (lower?, upper?);
    let logarithmic = spacing == SpacingName::Logarithmic;
    if unit != other {
        faults.add(&at("upper"), format!("must have the unit of lower, \"{unit}\", found \"{other}\""));
    } else if low >= high {
        faults.add(&at("upper"), "must be larger than lower");
    } else if logarithmic && low <= 0.0 {
        faults.add(&at("lower"), "must be above zero for levels at equal ratios");
    }
    faults.range(levels.map(|l| l as f64), &at("levels"), |v| v >= 2.0, "at least 2");
    let whole = whole && whole_too;
    let domain =
        Domain::Range { key: key?, lower: low, upper: high, whole, logarithmic, levels: levels?.max(2) };
    Some(Factor { name, unit, ratio: None, domain })
}

/// The ratio of refinement of a factor's levels.
fn ratio(factor: &Factor, path: &str, drawn: bool, faults: &mut Faults) -> Option<f64> {
    let at = join(path, "refinement");
    if drawn || factor.levels() < 3 {
        faults.add(&at, "needs a grid with three levels of the factor at least");
        return None;
    }
    // Of several keys the first one whose number changes.
    let levels: Vec<Level> = (0..factor.levels()).map(|k| factor.level(k)).collect();
    let numbers = |j: usize| -> Option<Vec<f64>> {
        levels.iter().map(|l| quantity(&l.set.get(j)?.1).map(|q| q.0)).collect()
    };
    let changing = |n: &Vec<f64>| n.windows(2).all(|w| w[0] != w[1]);
    let found = (0..levels[0].set.len()).filter_map(numbers).find(changing);
    let ratios: Vec<f64> = found.iter().flat_map(|n| n.windows(2).map(|w| w[1] / w[0])).collect();
    let Some(first) = ratios.first().copied().filter(|r| r.is_finite() && *r > 0.0) else {
        faults.add(&at, "needs levels of a number that changes from each to the next");
        return None;
    };
    if ratios.iter().any(|r| (r / first - 1.0).abs() > SAME_RATIO) {
        faults.add(&at, "needs levels that refine by the same ratio each");
        return None;
    }
    Some(first.max(1.0 / first))
}

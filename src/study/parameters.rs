//! Checks of what is varied.

use super::Given;
use super::bearings::Bearings;
use super::faults::{Faults, join};
use super::file::{ParameterFile, QuantityText, StudyFile};
use super::lexicon::{Lexicon, Target};
use super::plans::{FilmPlan, ParameterPlan};

/// Design parameters with their box.
pub(super) fn parameters(
    file: &mut StudyFile,
    bearings: &Bearings,
    film: Option<&FilmPlan>,
    faults: &mut Faults,
) -> Option<Vec<ParameterPlan>> {
    faults.need(&file.parameters, "parameters");
    let lexicon = Lexicon::of(file, bearings, film);
    let Given::Value(list) = &mut file.parameters else { return None };
    if list.is_empty() {
        faults.add("parameters", "needs at least one [[parameters]]");
    }
    let mut plans: Vec<ParameterPlan> = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("parameters[{i}]");
        faults.get(given, &path);
        let Given::Value(p) = given else { continue };
        faults.unknown::<ParameterFile>(&p.unknown, &path);
        let name_at = join(&path, "name");
        let Some(name) = faults.need(&p.name, &name_at) else { continue };
        let Some(targets) = lexicon.targets(&name, &name_at, faults) else { continue };
        if let Some(twice) = targets.iter().find(|t| plans.iter().any(|p| p.name == t.name)) {
            faults.add(&name_at, format!("\"{}\" stands twice", twice.name));
        }
        plans.extend(boxed(p, &path, &targets, &lexicon, faults).unwrap_or_default());
    }
    Some(plans)
}

/// The parameters of one entry; the start of a single one is written into the file.
fn boxed(
    p: &mut ParameterFile,
    path: &str,
    targets: &[Target],
    lexicon: &Lexicon,
    faults: &mut Faults,
) -> Option<Vec<ParameterPlan>> {
    let at = |key: &str| join(path, key);
    let variable = targets.first()?.variable;
    let mut value = |text: Option<QuantityText>, key: &str| {
        let text = text?.0;
        variable.si(&text).map_err(|e| faults.add(&at(key), format!("found \"{text}\": {e}"))).ok()
    };
    let given = [p.lower.value().cloned(), p.upper.value().cloned(), p.start.value().cloned()];
    let [lower, upper, start] = given;
    let (lower, upper, start) = (value(lower, "lower"), value(upper, "upper"), value(start, "start"));
    faults.need(&p.lower, &at("lower"));
    faults.need(&p.upper, &at("upper"));
    faults.get(&p.start, &at("start"));
    let start_of = |target: &Target| start.or_else(|| lexicon.value(target));
    let starts: Vec<f64> = targets.iter().map(start_of).collect::<Option<_>>()?;
    let (lower, upper) = (lower?, upper?);
    let (least, most) = lexicon.allowed(&targets[0]);
    let unit = variable.unit_words();
    let words = format!("above {} and at most {}{unit}", variable.short(least), variable.short(most));
    faults.range(Some(lower), &at("lower"), |v| v > least && v <= most, &words);
    faults.range(Some(upper), &at("upper"), |v| v > least && v <= most, &words);
    if lower >= upper {
        faults.add(&at("upper"), "must be larger than lower");
    } else if let Some(k) = starts.iter().position(|s| !(lower..=upper).contains(s)) {
        let [low, high, found] = [lower, upper, starts[k]].map(|v| variable.short(v));
        let which = if p.start.is_absent() { "the value in its own section" } else { "the start" };
        let words = format!("{which} must lie between {low} and {high}{unit}, found {found}{unit}");
        faults.add(&at("start"), words);
    }
    if let ([start], true) = (&starts[..], p.start.is_absent()) {
        p.start = Given::Value(QuantityText(variable.text(*start)));
    }
    let plan = |(t, start): (&Target, &f64)| ParameterPlan {
        name: t.name.clone(),
        bearing: t.bearing,
        stage: t.stage,
        variable: t.variable,
        lower,
        upper,
        start: *start,
    };
    Some(targets.iter().zip(&starts).map(plan).collect())
}

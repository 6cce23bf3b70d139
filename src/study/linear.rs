//! Limits on sums of design parameters.

use super::Given;
use super::faults::{Faults, join};
use super::file::{LinearConstraintFile, StudyFile, TermFile};
use super::plans::ParameterPlan;
use super::variables::Variable;
use crate::optimise::{LinearConstraint, Relation, Sense};

/// A checked limit on a sum: `sum factor * parameter`, SI units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LinearPlan {
    /// Index and factor of each parameter.
    pub terms: Vec<(usize, f64)>,
    /// Allowed side; none where the sum is given.
    pub sense: Option<Sense>,
    /// Limit, SI units.
    pub limit: f64,
    /// Unit of the limit in reports.
    pub variable: Variable,
}

impl LinearPlan {
    /// The sum at a design.
    pub fn value(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|&(j, factor)| factor * x[j]).sum()
    }

    /// How far the sum is beyond its limit; negative where there is room.
    pub fn excess(&self, x: &[f64]) -> f64 {
        let beyond = self.value(x) - self.limit;
        match self.sense {
            Some(Sense::AtMost) => beyond,
            Some(Sense::AtLeast) => -beyond,
            None => beyond.abs(),
        }
    }

    /// How much the sum can change within the boxes.
    pub fn room(&self, parameters: &[ParameterPlan]) -> f64 {
        let width = |&(j, factor): &(usize, f64)| factor.abs() * (parameters[j].upper - parameters[j].lower);
        self.terms.iter().map(width).sum()
    }

    /// The row of a problem of `n` variables.
    pub fn row(&self, n: usize) -> LinearConstraint {
        let sign = if self.sense == Some(Sense::AtLeast) { -1.0 } else { 1.0 };
        let mut factors = vec![0.0; n];
        self.terms.iter().for_each(|&(j, factor)| factors[j] += sign * factor);
        let relation = if self.sense.is_some() { Relation::AtMost } else { Relation::Equal };
        LinearConstraint { factors, relation, bound: sign * self.limit }
    }
}

/// All limits on sums.
pub(super) fn linear_constraints(
    file: &StudyFile,
    parameters: &[ParameterPlan],
    faults: &mut Faults,
) -> Vec<LinearPlan> {
    let list = faults.get(&file.linear_constraints, "linear_constraints").unwrap_or_default();
    let mut plans = Vec::new();
    for (i, given) in list.iter().enumerate() {
        let path = format!("linear_constraints[{i}]");
        if let Some(row) = faults.get(given, &path) {
            plans.extend(one(&row, &path, parameters, faults));
        }
    }
    plans
}

fn one(
    row: &LinearConstraintFile,
    path: &str,
    parameters: &[ParameterPlan],
    faults: &mut Faults,
) -> Option<LinearPlan> {
    faults.unknown::<LinearConstraintFile>(&row.unknown, path);
    let list = faults.need(&row.terms, &join(path, "terms"))?;
    let mut terms = Vec::new();
    let (mut variable, mut whole): (Option<Variable>, bool) = (None, true);
    for (k, given) in list.iter().enumerate() {
        let at = format!("{}[{k}]", join(path, "terms"));
        let Some((index, factor)) = term(given, &at, parameters, faults) else {
            whole = false;
            continue;
        };
        let own = parameters[index].variable;
        let first = *variable.get_or_insert(own);
        if own.unit == "degC" {
            faults.add(&at, "temperatures cannot be added: their zero is a convention");
            return None;
        }
        if own.kind() != first.kind() {
            let words = format!("is measured in {}, the first term in {}", own.unit, first.unit);
            faults.add(&at, format!("cannot be added: {} {words}", parameters[index].name));
            return None;
        }
        terms.push((index, factor));
    }
    let Some(variable) = variable else {
        if whole {
            faults.add(&join(path, "terms"), "needs at least one term");
        }
        return None;
    };
    let mut limits = Vec::new();
    for (key, given, sense) in [
        ("at_least", &row.at_least, Some(Sense::AtLeast)),
        ("at_most", &row.at_most, Some(Sense::AtMost)),
        ("equals", &row.equals, None),
    ] {
        let at = join(path, key);
        if let Some(text) = faults.get(given, &at) {
            match variable.si(&text.0) {
                Ok(limit) => limits.push((sense, limit)),
                Err(e) => {
                    faults.add(&at, format!("found \"{}\": {e}", text.0));
                    return None;
                }
            }
        }
    }
    let [(sense, limit)] = limits[..] else {
        faults.add(path, "give exactly one of at_least, at_most and equals");
        return None;
    };
    whole.then_some(LinearPlan { terms, sense, limit, variable })
}

fn term(
    given: &Given<TermFile>,
    at: &str,
    parameters: &[ParameterPlan],
    faults: &mut Faults,
) -> Option<(usize, f64)> {
    let term = faults.get(given, at)?;
    faults.unknown::<TermFile>(&term.unknown, at);
    let name = faults.need(&term.parameter, &join(at, "parameter"));
    let factor = faults.need(&term.factor, &join(at, "factor"));
    let nonzero = |v: f64| v != 0.0 && v.abs() <= 1e9;
    faults.range(factor, &join(at, "factor"), nonzero, "not zero and of at most 1e9");
    let name = name?;
    let found = parameters.iter().position(|p| p.name == name);
    if found.is_none() {
        let names: Vec<&str> = parameters.iter().map(|p| p.name.as_str()).collect();
        let words = format!("\"{name}\" is not among the [[parameters]]: {}", names.join(", "));
        faults.add(&join(at, "parameter"), words);
    }
    Some((found?, factor?))
}

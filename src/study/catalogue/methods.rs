//! Search methods as a list.
//!
//! Deliberately not here: what is minimised, and budgets of a search.

use super::docs;
use crate::optimise::Method;
use serde::Serialize;
use serde_json::Value;

/// A search method.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodEntry {
    /// As a study writes it.
    pub key: String,
    /// As reports write it.
    pub name: &'static str,
    /// What it is.
    pub what: String,
    /// Whether it uses gradients.
    pub gradients: bool,
    /// How it meets limits on sums of parameters.
    pub linear_constraints: &'static str,
    /// When to choose it.
    pub choose: &'static str,
    /// How a study asks for it.
    pub chosen_by: String,
    /// Whether it searches if the study says nothing.
    pub default: bool,
}

/// All search methods.
pub fn methods() -> Vec<MethodEntry> {
    let entry = |(key, what): (String, String)| {
        let method: Method = serde_json::from_value(Value::String(key.clone())).ok()?;
        Some(MethodEntry {
            name: method.words(),
            what,
            gradients: method != Method::Cobyla,
            linear_constraints: if method == Method::Sqp {
                "in every design that is tried"
            } else {
                "in the end"
            },
            choose: choose(method),
            chosen_by: format!("optimiser.method = \"{key}\""),
            default: method == Method::default(),
            key,
        })
    };
    docs::words::<Method>().into_iter().filter_map(entry).collect()
}

fn choose(method: Method) -> &'static str {
    match method {
        Method::Sqp => "by default: the fewest simulations",
        Method::AugmentedLagrangian => {
            "as second opinion: several times the simulations, but no model of the constraints' curvature"
        }
        Method::Cobyla => "where gradients do not help: objectives with noise; few parameters",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_listed_and_one_is_the_default() {
        let keys: Vec<String> = methods().into_iter().map(|m| m.key).collect();
        assert_eq!(keys, ["sqp", "augmented-lagrangian", "cobyla"]);
        assert_eq!(methods().iter().filter(|m| m.default).count(), 1);
    }
}

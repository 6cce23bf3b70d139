//! Gradient engines as a list.
//!
//! Deliberately not here: measured times (see the comparison of a study).

use super::docs;
use super::entry::Choice;
use crate::gradient::EngineName;
use serde::Serialize;

/// A gradient engine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EngineEntry {
    /// As a study writes it.
    pub key: &'static str,
    /// What it is.
    pub what: String,
    /// Whether it is exact for the discrete periodic model.
    pub exact: bool,
    /// How close it comes.
    pub accuracy: &'static str,
    /// Its work in simulations, `n_p` parameters and `n_q` quantities.
    pub cost: &'static str,
    /// What it keeps in memory.
    pub memory: &'static str,
    /// When to choose it.
    pub choose: &'static str,
    /// How a study asks for it.
    pub chosen_by: String,
    /// Whether it computes the gradients if the study says nothing.
    pub default: bool,
}

/// All engines.
pub fn engines() -> Vec<EngineEntry> {
    let meanings = docs::words::<EngineName>();
    EngineName::ALL.iter().map(|name| entry(*name, &meanings)).collect()
}

fn entry(name: EngineName, meanings: &[(String, String)]) -> EngineEntry {
    let exact = matches!(name, EngineName::Tra | EngineName::Adj);
    EngineEntry {
        key: name.as_str(),
        what: docs::meaning(meanings, name.as_str()),
        exact,
        accuracy: accuracy(name),
        cost: cost(name),
        memory: if exact { "a cycle and its factors, as far as orbit.memory allows" } else { "one cycle" },
        choose: choose(name),
        chosen_by: Choice::Key("gradient.engine", name.as_str()).text(),
        default: name == EngineName::Adj,
    }
}

fn accuracy(name: EngineName) -> &'static str {
    match name {
        EngineName::Fw | EngineName::Bw => "about eps_p, and what rounding, settling and kinks leave",
        EngineName::Cen => "about eps_p^2, and what rounding, settling and kinks leave",
        EngineName::Tra | EngineName::Adj => "exact for the discrete periodic model",
    }
}

fn cost(name: EngineName) -> &'static str {
    match name {
        EngineName::Fw | EngineName::Bw => {
            "n_p simulations continued from the settled cycle, for any n_q; each about 0.4 of one from a \
             cold start"
        }
        EngineName::Cen => {
            "2 n_p simulations continued from the settled cycle, for any n_q; each about 0.4 of one from a \
             cold start"
        }
        EngineName::Tra => {
            "grows with n_p, for any n_q: a solve per step, sweep and parameter; that of one simulation at \
             about 12 parameters"
        }
        EngineName::Adj => {
            "independent of n_p, grows with n_q: a solve per step, sweep and quantity; about 0.2 of a \
             simulation for a few quantities"
        }
    }
}

fn choose(name: EngineName) -> &'static str {
    match name {
        EngineName::Fw | EngineName::Bw => "to see the one-sided slopes of a kink",
        EngineName::Cen => "to check the others",
        EngineName::Tra => "for fewer parameters than quantities; as second opinion on ADJ",
        EngineName::Adj => "by default",
    }
}

#[cfg(test)]
mod tests {
    use super::super::example::study;
    use super::*;

    #[test]
    fn every_engine_is_explained_and_the_default_is_that_of_a_study() {
        let list = engines();
        assert!(list.iter().all(|e| !e.what.is_empty()));
        let defaults: Vec<&str> = list.iter().filter(|e| e.default).map(|e| e.key).collect();
        assert_eq!(defaults, [study(&[]).engine.as_str()]);
    }
}

//! Quantities a cycle is judged by, as a list.
//!
//! Deliberately not here: how they are computed, and limits on the march through a running-in.

use super::docs;
use crate::optimise::Sense;
use crate::orbit::Reduction;
use crate::study::QuantityName;
use crate::study::constraints::wrong_side;
use serde::Serialize;

/// A quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityEntry {
    /// As a study writes it.
    pub key: &'static str,
    /// As reports write it.
    pub title: &'static str,
    /// Unit in reports.
    pub unit: &'static str,
    /// What it is.
    pub meaning: String,
    /// What is made of the instants of a cycle.
    pub over_cycle: &'static str,
    /// Whether a search sees a smooth extremum instead of the exact one, which is reported beside it.
    pub smooth: bool,
    /// Whether it is what a search minimises.
    pub objective: bool,
    /// Whether it can be limited from below.
    pub at_least: bool,
    /// Whether it can be limited from above.
    pub at_most: bool,
    /// What a bearing needs for it; empty for nothing.
    pub needs: &'static str,
}

/// All quantities.
pub fn quantities() -> Vec<QuantityEntry> {
    let meanings = docs::words::<QuantityName>();
    QuantityName::ALL.iter().map(|quantity| entry(*quantity, &meanings)).collect()
}

fn entry(quantity: QuantityName, meanings: &[(String, String)]) -> QuantityEntry {
    let (reduction, smooth) = match quantity.of_cycle(1.0).0.reduction {
        Reduction::Mean => ("mean", false),
        Reduction::Max => ("largest value, exact", false),
        Reduction::Min => ("smallest value, exact", false),
        Reduction::SmoothMax(_) => ("smooth maximum, at or above the largest value", true),
        Reduction::SmoothMin(_) => ("smooth minimum, at or below the smallest value", true),
    };
    QuantityEntry {
        key: quantity.key(),
        title: quantity.title(),
        unit: quantity.unit().0,
        meaning: docs::meaning(meanings, quantity.key()),
        over_cycle: reduction,
        smooth,
        objective: quantity == QuantityName::MeanFrictionLoss,
        at_least: wrong_side(quantity, Sense::AtLeast).is_none(),
        at_most: wrong_side(quantity, Sense::AtMost).is_none(),
        needs: if quantity.is_of_contact() { "[bearings.NAME.roughness] with a contact" } else { "" },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_a_meaning_and_is_minimised_or_limited() {
        let list = quantities();
        assert_eq!(list.len(), QuantityName::ALL.len());
        for q in &list {
            assert!(!q.meaning.is_empty(), "{}", q.key);
            assert_ne!(q.objective, q.at_least || q.at_most, "{}", q.key);
        }
        let of = |key: &str| list.iter().find(|q| q.key == key).unwrap();
        assert!(of("min-film-thickness").smooth && !of("min-film-thickness").at_most);
        assert!(!of("specific-load").smooth && of("wear-rate").needs.contains("contact"));
    }
}

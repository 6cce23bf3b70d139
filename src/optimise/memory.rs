//! What a design problem remembers, and can write down for another process.

use super::EvaluationError;
use super::case::Evaluated;
use crate::gradient::GradientTable;
use crate::run::Cost;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// Designs whose cycles are kept.
const KEPT_ORBITS: usize = 3;

/// A design by the bits of its variables.
pub(super) type Key = Vec<u64>;
/// Values of each case's quantities.
pub(super) type CaseValues = Vec<Vec<f64>>;
/// Gradients of each case's quantities by its own parameters.
pub(super) type CaseRows = Vec<Vec<Vec<f64>>>;

pub(super) fn key(x: &[f64]) -> Key {
    x.iter().map(|v| v.to_bits()).collect()
}

#[derive(Default, Serialize, Deserialize)]
pub(super) struct Memory {
    pub values: BTreeMap<Key, Result<CaseValues, EvaluationError>>,
    pub rows: BTreeMap<Key, CaseRows>,
    /// How the gradients change along a direction, by design and direction.
    pub changes: BTreeMap<(Key, Key), CaseRows>,
    orbits: VecDeque<(Key, Arc<Evaluated>)>,
    /// The design differentiated last: where new ones start.
    pub base: Option<Arc<Evaluated>>,
    /// Gradients of the design differentiated last: the search, the curvature and the report ask for the same ones.
    pub tables: Option<(Key, Arc<Vec<GradientTable>>)>,
    pub cost: Cost,
    pub gradient_cost: Cost,
    /// Work done when the last snapshot was taken.
    #[serde(skip)]
    pub saved: (Cost, Cost),
}

impl Memory {
    /// Cycles of a design that are still at hand.
    pub fn at_hand(&self, key: &Key) -> Option<Arc<Evaluated>> {
        self.orbits.iter().find(|(k, _)| k == key).map(|(_, known)| known.clone())
    }

    /// Cycles a new design starts from.
    pub fn nearby(&self) -> Option<Arc<Evaluated>> {
        self.base.clone().or_else(|| self.orbits.back().map(|(_, first)| first.clone()))
    }

    pub fn keep(&mut self, key: Key, found: Arc<Evaluated>) {
        self.orbits.push_front((key, found));
        self.orbits.truncate(KEPT_ORBITS);
    }

    /// Gradients asked for before; the search is at that design again, if its cycles are still at hand.
    pub fn known_rows(&mut self, key: &Key) -> Option<CaseRows> {
        let known = self.rows.get(key).cloned()?;
        self.base = self.at_hand(key).or(self.base.take());
        Some(known)
    }

    /// What another process wrote down of a problem with as many cases; none if it does not fit.
    pub fn read(snapshot: &[u8], cases: usize) -> Option<Self> {
        let memory = postcard::from_bytes::<Self>(snapshot).ok()?;
        let fits = |e: &Evaluated| e.orbits.len() == cases;
        let usable = memory.orbits.iter().all(|(_, e)| fits(e)) && memory.base.iter().all(|e| fits(e));
        usable.then_some(Self { saved: (memory.cost, memory.gradient_cost), ..memory })
    }
}

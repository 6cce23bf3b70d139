//! A constrained problem made of periodic models: every case is one bearing at one operating point.
//!
//! The objective is a weighted sum of quantities, one row of constraints belongs to each limit. Evaluated designs are
//! remembered by the bits of their parameters, and so are their gradients; the cycles of the latest designs are kept to be
//! differentiated. New designs start from the cycle of the one differentiated last (the search's place), whatever was tried in
//! between. Cases run in parallel; their results do not depend on how.
//!
//! All that a problem remembers can be written down ([`DesignProblem::snapshot`]) and given to another process. A search
//! that starts over on it finds every answer it had, without a simulation, arrives where it was and goes on to the same
//! numbers: no optimiser needs a state of its own on disk.

use super::{ConstrainedProblem, EvaluationError, Slopes, Values};
use crate::dae::SensitiveDae;
use crate::gradient::{GradientEngine, GradientError, GradientTable};
use crate::orbit::{Orbit, OrbitError, OrbitOptions, Quantity, settle};
use crate::run::{Cost, Event, IterationEvent, RunContext};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard};

/// Designs whose cycles are kept.
const KEPT_ORBITS: usize = 3;

/// One model with what is asked of it.
pub struct Case<M> {
    /// The model at the start design.
    pub model: M,
    /// For each parameter of the model, which design variable it is.
    pub variables: Vec<usize>,
    /// Quantities evaluated and differentiated; weights and limits refer to them.
    pub quantities: Vec<Quantity>,
    /// How its cycle is computed.
    pub options: OrbitOptions,
    /// Share of each quantity in the objective, `(quantity, weight)`.
    pub objective: Vec<(usize, f64)>,
}

/// Which side of a limit is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// The quantity must not fall below the limit.
    AtLeast,
    /// The quantity must not exceed the limit.
    AtMost,
}

/// A limit on a quantity of a case; the constraint is the relative excess over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Case it belongs to.
    pub case: usize,
    /// Quantity of that case.
    pub quantity: usize,
    /// Allowed side.
    pub sense: Sense,
    /// Limit in SI units, above zero.
    pub limit: f64,
}

impl Limit {
    /// The constraint `c <= 0` and its derivative by the quantity.
    fn constraint(&self, value: f64) -> (f64, f64) {
        match self.sense {
            Sense::AtLeast => (1.0 - value / self.limit, -1.0 / self.limit),
            Sense::AtMost => (value / self.limit - 1.0, 1.0 / self.limit),
        }
    }
}

/// A simulated design.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Evaluated {
    /// Settled cycle of each case.
    pub orbits: Vec<Orbit>,
}

/// The problem; see the module page.
pub struct DesignProblem<'r, M: SensitiveDae> {
    cases: Vec<Case<M>>,
    limits: Vec<Limit>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    engine: Box<dyn GradientEngine<M>>,
    run: RunContext<'r>,
    memory: Mutex<Memory>,
    /// Called with a snapshot at accepted designs.
    save: Option<Save<'r>>,
}

type Key = Vec<u64>;
/// Takes a snapshot.
type Save<'r> = Box<dyn Fn(&[u8]) + Send + Sync + 'r>;

#[derive(Default, Serialize, Deserialize)]
struct Memory {
    values: BTreeMap<Key, Result<Values, EvaluationError>>,
    slopes: BTreeMap<Key, Slopes>,
    orbits: VecDeque<(Key, Arc<Evaluated>)>,
    /// The design differentiated last: where new ones start.
    base: Option<Arc<Evaluated>>,
    /// Gradients of the design differentiated last: the search, the curvature and the report ask for the same ones.
    tables: Option<(Key, Arc<Vec<GradientTable>>)>,
    cost: Cost,
    gradient_cost: Cost,
    /// Work done when the last snapshot was taken.
    #[serde(skip)]
    saved: (Cost, Cost),
}

impl Memory {
    /// Cycles of a design that are still at hand.
    fn at_hand(&self, key: &Key) -> Option<Arc<Evaluated>> {
        self.orbits.iter().find(|(k, _)| k == key).map(|(_, known)| known.clone())
    }

    /// Gradients asked for before; the search is at that design again, if its cycles are still at hand.
    fn known_slopes(&mut self, key: &Key) -> Option<Slopes> {
        let known = self.slopes.get(key).cloned()?;
        self.base = self.at_hand(key).or(self.base.take());
        Some(known)
    }
}

impl<'r, M: SensitiveDae> DesignProblem<'r, M> {
    /// A problem of cases and limits over a box of design variables, differentiated by `engine`.
    pub fn new(
        cases: Vec<Case<M>>,
        limits: Vec<Limit>,
        bounds: (Vec<f64>, Vec<f64>),
        engine: Box<dyn GradientEngine<M>>,
        run: RunContext<'r>,
    ) -> Self {
        let (lower, upper) = bounds;
        Self { cases, limits, lower, upper, engine, run, memory: Mutex::default(), save: None }
    }

    /// Hands a snapshot to `save` whenever a design was accepted and something new is known.
    pub fn saved_by(&mut self, save: impl Fn(&[u8]) + Send + Sync + 'r) {
        self.save = Some(Box::new(save));
    }

    /// The cases.
    pub fn cases(&self) -> &[Case<M>] {
        &self.cases
    }

    /// Work done so far: simulations, and gradients beyond them.
    pub fn costs(&self) -> (Cost, Cost) {
        let memory = self.lock();
        (memory.cost, memory.gradient_cost)
    }

    /// The model of a case at a design.
    pub fn model(&self, case: usize, x: &[f64]) -> Result<M, EvaluationError> {
        let case = &self.cases[case];
        let p: Vec<f64> = case.variables.iter().map(|&j| x[j]).collect();
        case.model.with_parameters(&p).map_err(|e| EvaluationError::Failed(e.to_string()))
    }

    /// Settled cycles of a design, simulated if not at hand.
    pub fn evaluated(&self, x: &[f64]) -> Result<Arc<Evaluated>, EvaluationError> {
        let key = key(x);
        let start = {
            let memory = self.lock();
            if let Some(known) = memory.at_hand(&key) {
                return Ok(known);
            }
            memory.base.clone().or_else(|| memory.orbits.back().map(|(_, first)| first.clone()))
        };
        let orbits: Result<Vec<Orbit>, EvaluationError> = (0..self.cases.len())
            .into_par_iter()
            .map(|c| {
                let model = self.model(c, x)?;
                let near = start.as_ref().map(|s| &s.orbits[c]);
                settle(&model, &self.cases[c].options, near, self.run.cancel).map_err(|e| match e {
                    OrbitError::Cancelled(_) => EvaluationError::Cancelled,
                    other => EvaluationError::Failed(other.to_string()),
                })
            })
            .collect();
        let found = Arc::new(Evaluated { orbits: orbits? });
        let mut memory = self.lock();
        memory.cost += found.orbits.iter().map(|o| o.cost).sum();
        memory.orbits.push_front((key, found.clone()));
        memory.orbits.truncate(KEPT_ORBITS);
        Ok(found)
    }

    /// Gradient table of each case at a design.
    pub fn tables(&self, x: &[f64]) -> Result<Arc<Vec<GradientTable>>, EvaluationError> {
        let key = key(x);
        if let Some((_, known)) = self.lock().tables.as_ref().filter(|(k, _)| *k == key) {
            return Ok(known.clone());
        }
        let at = self.evaluated(x)?;
        let tables: Result<Vec<GradientTable>, EvaluationError> = (0..self.cases.len())
            .into_par_iter()
            .map(|c| {
                let case = &self.cases[c];
                let model = self.model(c, x)?;
                self.engine
                    .gradient(&model, &at.orbits[c], &case.options, &case.quantities, self.run.cancel)
                    .map_err(|e| match e {
                        GradientError::Cancelled(_) | GradientError::Orbit(OrbitError::Cancelled(_)) => {
                            EvaluationError::Cancelled
                        }
                        other => EvaluationError::Failed(other.to_string()),
                    })
            })
            .collect();
        let tables = Arc::new(tables?);
        let mut memory = self.lock();
        memory.gradient_cost += tables.iter().map(|t| t.cost).sum();
        memory.tables = Some((key, tables.clone()));
        Ok(tables)
    }

    /// Lets the first design start from cycles of a neighbour of the problem: one with the same cases and other limits.
    pub fn begin_beside(&self, cycles: Arc<Evaluated>) {
        self.lock().base = Some(cycles);
    }

    /// All that is known, for another process; a format of this version of the program.
    pub fn snapshot(&self) -> Vec<u8> {
        postcard::to_stdvec(&*self.lock()).unwrap_or_default()
    }

    /// Takes over what another process knew; whether it could be read.
    pub fn restore(&self, snapshot: &[u8]) -> bool {
        let found = postcard::from_bytes::<Memory>(snapshot);
        let usable = found.as_ref().is_ok_and(|m| {
            let fits = |e: &Evaluated| e.orbits.len() == self.cases.len();
            m.orbits.iter().all(|(_, e)| fits(e)) && m.base.iter().all(|e| fits(e))
        });
        if let (Ok(memory), true) = (found, usable) {
            *self.lock() = Memory { saved: (memory.cost, memory.gradient_cost), ..memory };
        }
        usable
    }

    fn lock(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    fn reduce(&self, at: &Evaluated) -> Values {
        let value =
            |case: usize, quantity: usize| at.orbits[case].value(&self.cases[case].quantities[quantity]);
        let objective = (0..self.cases.len())
            .flat_map(|c| self.cases[c].objective.iter().map(move |&(q, w)| w * value(c, q)))
            .sum();
        let inequalities = self.limits.iter().map(|l| l.constraint(value(l.case, l.quantity)).0).collect();
        Values { objective, inequalities, equalities: Vec::new() }
    }

    /// Spreads a row over a case's parameters onto the design variables, times a factor.
    fn scatter(&self, case: usize, row: &[f64], factor: f64, into: &mut [f64]) {
        for (&j, g) in self.cases[case].variables.iter().zip(row) {
            into[j] += factor * g;
        }
    }
}

impl<M: SensitiveDae> ConstrainedProblem for DesignProblem<'_, M> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        (self.lower.clone(), self.upper.clone())
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let known = self.lock().values.get(&key(x)).cloned();
        if let Some(known) = known {
            return known;
        }
        let result = self.evaluated(x).map(|at| self.reduce(&at));
        if result != Err(EvaluationError::Cancelled) {
            self.lock().values.insert(key(x), result.clone());
        }
        let simulations = self.lock().cost.simulations;
        let objective_w = result.as_ref().ok().map(|v| v.objective);
        self.run.progress.tell(&Event::Simulated { simulations, objective_w });
        result
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let key = key(x);
        if let Some(known) = self.lock().known_slopes(&key) {
            return Ok(known);
        }
        let at = self.evaluated(x)?;
        let tables = self.tables(x)?;
        let n = x.len();
        let mut objective = vec![0.0; n];
        for (c, case) in self.cases.iter().enumerate() {
            for &(q, w) in &case.objective {
                self.scatter(c, &tables[c].rows[q], w, &mut objective);
            }
        }
        let constraint = |l: &Limit| {
            let value = at.orbits[l.case].value(&self.cases[l.case].quantities[l.quantity]);
            let mut row = vec![0.0; n];
            self.scatter(l.case, &tables[l.case].rows[l.quantity], l.constraint(value).1, &mut row);
            row
        };
        let inequalities = self.limits.iter().map(constraint).collect();
        let slopes = Slopes { objective, inequalities, equalities: Vec::new() };
        let mut memory = self.lock();
        memory.slopes.insert(key, slopes.clone());
        memory.base = Some(at);
        Ok(slopes)
    }

    fn accepted(&self, news: &IterationEvent) {
        self.run.progress.tell(&Event::Iteration(*news));
        let Some(save) = &self.save else { return };
        let costs = self.costs();
        if std::mem::replace(&mut self.lock().saved, costs) != costs {
            save(&self.snapshot());
        }
    }
}

fn key(x: &[f64]) -> Key {
    x.iter().map(|v| v.to_bits()).collect()
}

//! A constrained problem made of periodic models: every case is one bearing at one operating point.
//!
//! The objective is a weighted sum of quantities, one row of constraints belongs to each limit. Evaluated designs are
//! remembered by the bits of their variables, and so are their gradients; the cycles of the latest designs are kept to be
//! differentiated. New designs start from the cycle of the one differentiated last (the search's place), whatever was tried in
//! between. Cases run in parallel; their results do not depend on how.
//!
//! Behind the variables of the search there may be others that it leaves where they are ([`DesignProblem::beside`]): a point given
//! with them is a neighbour, its gradients have entries for them. Objectives can be taken apart by operating point
//! ([`ManyObjectives`]), and gradients be followed along a direction ([`Curved`]).
//!
//! All that a problem remembers can be written down ([`DesignProblem::snapshot`]) and given to another process. A search
//! that starts over on it finds every answer it had, without a simulation, arrives where it was and goes on to the same
//! numbers: no optimiser needs a state of its own on disk.

use super::case::{Case, Evaluated, Limit};
use super::memory::{CaseRows, CaseValues, Key, Memory, key};
use super::{ConstrainedProblem, Curved, EvaluationError, LinearConstraint, ManyObjectives, Slopes, Values};
use crate::dae::SensitiveDae;
use crate::gradient::{
    EngineName, GradientEngine, GradientError, GradientTable, HessianProduct, hessian_times,
};
use crate::orbit::{Orbit, OrbitError, settle};
use crate::run::{Cost, Event, IterationEvent, RunContext};
use rayon::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard};

/// Length of the differences along a direction that is given in variables of natural size.
const STEP: f64 = 1e-3;

/// The problem; see the module page.
pub struct DesignProblem<'r, M: SensitiveDae> {
    cases: Vec<Case<M>>,
    limits: Vec<Limit>,
    linear: Vec<LinearConstraint>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Values of the variables behind those of the search.
    beside: Vec<f64>,
    engine: Box<dyn GradientEngine<M>>,
    run: RunContext<'r>,
    memory: Mutex<Memory>,
    /// Called with a snapshot at accepted designs.
    save: Option<Save<'r>>,
    /// What is told of the cycles of accepted designs.
    watch: Option<Watch>,
}

/// Takes a snapshot.
type Save<'r> = Box<dyn Fn(&[u8]) + Send + Sync + 'r>;
/// Makes an event of the cycles of a design.
type Watch = Box<dyn Fn(&Evaluated) -> Event + Send + Sync>;

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
        let (linear, beside, memory) = (Vec::new(), Vec::new(), Mutex::default());
        Self { cases, limits, linear, lower, upper, beside, engine, run, memory, save: None, watch: None }
    }

    /// Adds constraints that are linear in the design variables.
    #[must_use]
    pub fn with_linear(self, linear: Vec<LinearConstraint>) -> Self {
        Self { linear, ..self }
    }

    /// Adds variables behind those of the box that the search leaves at these values.
    #[must_use]
    pub fn beside(self, values: Vec<f64>) -> Self {
        Self { beside: values, ..self }
    }

    /// Lets an event tell of the cycles of every accepted design.
    #[must_use]
    pub fn watched(self, watch: impl Fn(&Evaluated) -> Event + Send + Sync + 'static) -> Self {
        Self { watch: Some(Box::new(watch)), ..self }
    }

    /// The gradient engine.
    pub fn engine_name(&self) -> EngineName {
        self.engine.name()
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

    /// A point with the variables behind those of the search, where they are not given.
    pub fn whole(&self, x: &[f64]) -> Vec<f64> {
        let missing = (self.lower.len() + self.beside.len()).saturating_sub(x.len()).min(self.beside.len());
        x.iter().chain(&self.beside[self.beside.len() - missing..]).copied().collect()
    }

    /// The model of a case at a design.
    pub fn model(&self, case: usize, x: &[f64]) -> Result<M, EvaluationError> {
        let (case, x) = (&self.cases[case], self.whole(x));
        let p: Vec<f64> = case.variables.iter().map(|&j| x[j]).collect();
        case.model.with_parameters(&p).map_err(|e| EvaluationError::Failed(e.to_string()))
    }

    /// Settled cycles of a design, simulated if not at hand.
    pub fn evaluated(&self, x: &[f64]) -> Result<Arc<Evaluated>, EvaluationError> {
        let key = key(&self.whole(x));
        let start = {
            let memory = self.lock();
            if let Some(known) = memory.at_hand(&key) {
                return Ok(known);
            }
            memory.nearby()
        };
        let orbits = self.every_case(|c| {
            let near = start.as_ref().map(|s| &s.orbits[c]);
            let model = self.model(c, x)?;
            settle(&model, &self.cases[c].options, near, self.run.cancel).map_err(of_orbit)
        })?;
        let found = Arc::new(Evaluated { orbits });
        let mut memory = self.lock();
        memory.cost += found.orbits.iter().map(|o| o.cost).sum();
        memory.keep(key, found.clone());
        Ok(found)
    }

    /// Gradient table of each case at a design.
    pub fn tables(&self, x: &[f64]) -> Result<Arc<Vec<GradientTable>>, EvaluationError> {
        let key = key(&self.whole(x));
        if let Some((_, known)) = self.lock().tables.as_ref().filter(|(k, _)| *k == key) {
            return Ok(known.clone());
        }
        let at = self.evaluated(x)?;
        let tables = self.every_case(|c| {
            let (case, model) = (&self.cases[c], self.model(c, x)?);
            let (orbit, cancel) = (&at.orbits[c], self.run.cancel);
            self.engine.gradient(&model, orbit, &case.options, &case.quantities, cancel).map_err(of_gradient)
        })?;
        let tables = Arc::new(tables);
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
        let found = Memory::read(snapshot, self.cases.len());
        let usable = found.is_some();
        if let Some(memory) = found {
            *self.lock() = memory;
        }
        usable
    }

    fn lock(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Something of every case, in parallel.
    fn every_case<T: Send>(
        &self,
        of: impl Fn(usize) -> Result<T, EvaluationError> + Send + Sync,
    ) -> Result<Vec<T>, EvaluationError> {
        (0..self.cases.len()).into_par_iter().map(of).collect()
    }

    /// Values of all quantities, remembered or simulated.
    fn case_values(&self, x: &[f64]) -> Result<CaseValues, EvaluationError> {
        let key = key(&self.whole(x));
        let known = self.lock().values.get(&key).cloned();
        if let Some(known) = known {
            return known;
        }
        let of_case =
            |(case, orbit): (&Case<M>, &Orbit)| case.quantities.iter().map(|q| orbit.value(q)).collect();
        let result = self.evaluated(x).map(|at| self.cases.iter().zip(&at.orbits).map(of_case).collect());
        if result != Err(EvaluationError::Cancelled) {
            self.lock().values.insert(key, result.clone());
        }
        let simulations = self.lock().cost.simulations;
        let objective_w = result.as_ref().ok().map(|values| self.reduced(values).objective);
        self.run.progress.tell(&Event::Simulated { simulations, objective_w });
        result
    }

    /// Gradients of all quantities, remembered or computed.
    fn case_rows(&self, x: &[f64]) -> Result<CaseRows, EvaluationError> {
        let key = key(&self.whole(x));
        if let Some(known) = self.lock().known_rows(&key) {
            return Ok(known);
        }
        let (at, tables) = (self.evaluated(x)?, self.tables(x)?);
        let rows: CaseRows = tables.iter().map(|t| t.rows.clone()).collect();
        let mut memory = self.lock();
        memory.rows.insert(key, rows.clone());
        memory.base = Some(at);
        Ok(rows)
    }

    /// How all gradients change along a direction, remembered or computed.
    fn case_changes(&self, x: &[f64], direction: &[f64]) -> Result<CaseRows, EvaluationError> {
        let key: (Key, Key) = (key(&self.whole(x)), key(direction));
        if let Some(known) = self.lock().changes.get(&key) {
            return Ok(known.clone());
        }
        let at = self.evaluated(x)?;
        let products: Vec<HessianProduct> = self.every_case(|c| {
            let (case, model) = (&self.cases[c], self.model(c, x)?);
            let along: Vec<f64> =
                case.variables.iter().map(|&j| direction.get(j).copied().unwrap_or(0.0)).collect();
            let (orbit, options, cancel) = (&at.orbits[c], &case.options, self.run.cancel);
            hessian_times(&model, orbit, options, &case.quantities, &along, STEP, cancel).map_err(of_gradient)
        })?;
        let mut memory = self.lock();
        memory.gradient_cost += products.iter().map(|p| p.cost).sum();
        let rows: CaseRows = products.into_iter().map(|p| p.rows).collect();
        memory.changes.insert(key, rows.clone());
        Ok(rows)
    }

    fn reduced(&self, values: &CaseValues) -> Values {
        let weighted = |(case, values): (&Case<M>, &Vec<f64>)| -> f64 {
            case.objective.iter().map(|&(q, w)| w * values[q]).sum()
        };
        let objective = self.cases.iter().zip(values).map(weighted).sum();
        let of = |l: &Limit| l.constraint(values[l.case][l.quantity]).0;
        let inequalities = self.limits.iter().map(of).collect();
        Values { objective, inequalities, equalities: Vec::new() }
    }

    /// Gradients by all `n` variables of those by the parameters of each case.
    fn spread(&self, rows: &CaseRows, n: usize) -> Slopes {
        let mut objective = vec![0.0; n];
        for (c, case) in self.cases.iter().enumerate() {
            case.objective.iter().for_each(|&(q, w)| self.scatter(c, &rows[c][q], w, &mut objective));
        }
        let constraint = |l: &Limit| {
            let mut row = vec![0.0; n];
            self.scatter(l.case, &rows[l.case][l.quantity], l.constraint(0.0).1, &mut row);
            row
        };
        let inequalities = self.limits.iter().map(constraint).collect();
        Slopes { objective, inequalities, equalities: Vec::new() }
    }

    /// Spreads a row over a case's parameters onto the design variables, times a factor; variables beyond the row's end are left out.
    fn scatter(&self, case: usize, row: &[f64], factor: f64, into: &mut [f64]) {
        for (&j, g) in self.cases[case].variables.iter().zip(row) {
            if let Some(entry) = into.get_mut(j) {
                *entry += factor * g;
            }
        }
    }

    fn parts(&self) -> usize {
        self.cases.iter().map(|c| c.part + 1).max().unwrap_or(0)
    }
}

impl<M: SensitiveDae> ConstrainedProblem for DesignProblem<'_, M> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        (self.lower.clone(), self.upper.clone())
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        Ok(self.reduced(&self.case_values(x)?))
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        Ok(self.spread(&self.case_rows(x)?, x.len()))
    }

    fn linear(&self) -> Vec<LinearConstraint> {
        self.linear.clone()
    }

    fn accepted(&self, news: &IterationEvent) {
        // The design differentiated last.
        let accepted = self.lock().base.clone();
        if let (Some(watch), Some(at)) = (&self.watch, accepted) {
            self.run.progress.tell(&watch(&at));
        }
        self.run.progress.tell(&Event::Iteration(*news));
        let Some(save) = &self.save else { return };
        let costs = self.costs();
        if std::mem::replace(&mut self.lock().saved, costs) != costs {
            save(&self.snapshot());
        }
    }
}

impl<M: SensitiveDae> ManyObjectives for DesignProblem<'_, M> {
    fn objectives(&self, x: &[f64]) -> Result<Vec<f64>, EvaluationError> {
        let (mut sums, values) = (vec![0.0; self.parts()], self.case_values(x)?);
        for (case, values) in self.cases.iter().zip(&values) {
            case.objective.iter().for_each(|&(q, w)| sums[case.part] += w * values[q]);
        }
        Ok(sums)
    }

    fn objective_slopes(&self, x: &[f64]) -> Result<Vec<Vec<f64>>, EvaluationError> {
        let (mut sums, rows) = (vec![vec![0.0; x.len()]; self.parts()], self.case_rows(x)?);
        for (c, case) in self.cases.iter().enumerate() {
            case.objective.iter().for_each(|&(q, w)| self.scatter(c, &rows[c][q], w, &mut sums[case.part]));
        }
        Ok(sums)
    }
}

impl<M: SensitiveDae> Curved for DesignProblem<'_, M> {
    fn slopes_along(&self, x: &[f64], direction: &[f64]) -> Result<Slopes, EvaluationError> {
        Ok(self.spread(&self.case_changes(x, direction)?, x.len()))
    }
}

fn of_orbit(e: OrbitError) -> EvaluationError {
    match e {
        OrbitError::Cancelled(_) => EvaluationError::Cancelled,
        other => EvaluationError::Failed(other.to_string()),
    }
}

fn of_gradient(e: GradientError) -> EvaluationError {
    match e {
        GradientError::Cancelled(_) | GradientError::Orbit(OrbitError::Cancelled(_)) => {
            EvaluationError::Cancelled
        }
        other => EvaluationError::Failed(other.to_string()),
    }
}

//! What the optimiser knows: iterate, model, multipliers, incumbent, history.

use super::minimum::Incumbent;
use super::quasi_newton::QuasiNewton;
use super::{Outcome, Slopes, Values};
use crate::run::IterationEvent;
use argmin::core::{Problem, State, TerminationReason, TerminationStatus};
use std::collections::{HashMap, VecDeque};
use std::time::Duration;

/// A weight exceeds its multiplier by this factor, so that steps of the sub-problem descend.
const MARGIN: f64 = 1.5;
/// Smallest weight of a violation, in units of the scaled objective.
const LEAST_PENALTY: f64 = 1e-3;

/// Lagrange multipliers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Multipliers {
    /// Of the inequalities, at or above zero.
    pub inequalities: Vec<f64>,
    /// Of the equalities.
    pub equalities: Vec<f64>,
    /// Of the lower bounds, at or above zero.
    pub lower: Vec<f64>,
    /// Of the upper bounds, at or above zero.
    pub upper: Vec<f64>,
    /// Of the linear constraints, those with an upper bound at or above zero.
    pub linear: Vec<f64>,
}

/// A point with everything known there, in scaled variables.
#[derive(Debug, Clone)]
pub(super) struct Iterate {
    pub x: Vec<f64>,
    pub values: Values,
    pub slopes: Slopes,
}

/// State of an SQP run; scaled variables inside. argmin's own notion of "best" looks at the cost alone, so the incumbent is
/// kept here: feasible points first, then lower objective.
#[derive(Debug, Clone)]
pub struct SqpState {
    pub(super) iterate: Option<Iterate>,
    pub(super) incumbent: Option<Incumbent>,
    /// Points accepted before, the latest first.
    pub(super) earlier: VecDeque<Iterate>,
    /// Null steps since the last accepted point.
    pub(super) nulls: usize,
    pub(super) model: QuasiNewton,
    pub(super) multipliers: Multipliers,
    /// Weights of the violations in the merit function: inequalities, then equalities.
    pub(super) penalties: Vec<f64>,
    /// Longest change of a scaled variable in one iteration.
    pub(super) radius: f64,
    pub(super) kkt: f64,
    /// Gradients whose combination the KKT residual is of.
    pub(super) combined: usize,
    /// KKT residual of the point before, by its own gradient alone.
    pub(super) last_kkt: f64,
    pub(super) last_step: f64,
    pub(super) stalled: u32,
    pub(super) failures: Vec<String>,
    pub(super) history: Vec<IterationEvent>,
    pub(super) outcome: Option<Outcome>,
    start: Option<Vec<f64>>,
    iter: u64,
    max_iters: u64,
    counts: HashMap<String, u64>,
    time: Option<Duration>,
    status: TerminationStatus,
}

impl SqpState {
    /// Sets the start, in true variables.
    #[must_use]
    pub fn start(mut self, x: Vec<f64>) -> Self {
        self.start = Some(x);
        self
    }

    /// Limits the iterations.
    #[must_use]
    pub fn max_iters(mut self, n: u64) -> Self {
        self.max_iters = n;
        self
    }

    pub(super) fn start_point(&self) -> Option<&[f64]> {
        self.start.as_deref()
    }

    /// Ends the run with an outcome.
    pub(super) fn end(mut self, outcome: Outcome) -> Self {
        self.outcome = Some(outcome);
        let reason = match outcome {
            Outcome::Converged => TerminationReason::SolverConverged,
            Outcome::Cancelled => TerminationReason::Interrupt,
            other => TerminationReason::SolverExit(format!("{other:?}")),
        };
        self.terminate_with(reason)
    }

    /// Lets the weights of the merit function follow new multipliers (Powell 1978).
    pub(super) fn weigh(&mut self, multipliers: &Multipliers) {
        let all = multipliers.inequalities.iter().chain(&multipliers.equalities);
        self.penalties.resize(multipliers.inequalities.len() + multipliers.equalities.len(), 0.0);
        for (mu, multiplier) in self.penalties.iter_mut().zip(all) {
            let size = (MARGIN * multiplier.abs()).max(LEAST_PENALTY);
            *mu = size.max(0.5 * (*mu + size));
        }
    }

    /// Keeps the better of the incumbent and the iterate.
    pub(super) fn remember(&mut self, tolerance: f64) {
        if let Some(now) = &self.iterate {
            Incumbent::keep_better(&mut self.incumbent, &now.x, &now.values, tolerance);
        }
    }

    /// Notes the optimality found at the iterate; a converged iterate becomes the incumbent whatever came before.
    pub(super) fn judge(&mut self, converged: bool) {
        let Some(now) = &self.iterate else { return };
        let same = self.incumbent.as_ref().is_some_and(|best| best.x == now.x);
        if same || converged {
            self.incumbent = Some(Incumbent {
                x: now.x.clone(),
                values: now.values.clone(),
                kkt: self.kkt,
                combined: self.combined,
                multipliers: self.multipliers.clone(),
            });
        }
    }
}

impl State for SqpState {
    type Param = Vec<f64>;
    type Float = f64;

    fn new() -> Self {
        Self {
            iterate: None,
            incumbent: None,
            earlier: VecDeque::new(),
            nulls: 0,
            model: QuasiNewton::new(0),
            multipliers: Multipliers::default(),
            penalties: Vec::new(),
            radius: f64::INFINITY,
            kkt: f64::INFINITY,
            combined: 1,
            last_kkt: f64::INFINITY,
            last_step: 0.0,
            stalled: 0,
            failures: Vec::new(),
            history: Vec::new(),
            outcome: None,
            start: None,
            iter: 0,
            max_iters: u64::MAX,
            counts: HashMap::new(),
            time: Some(Duration::ZERO),
            status: TerminationStatus::NotTerminated,
        }
    }

    fn update(&mut self) {}

    fn get_param(&self) -> Option<&Vec<f64>> {
        self.iterate.as_ref().map(|i| &i.x)
    }

    fn get_best_param(&self) -> Option<&Vec<f64>> {
        self.incumbent.as_ref().map(|best| &best.x)
    }

    fn get_max_iters(&self) -> u64 {
        self.max_iters
    }

    fn increment_iter(&mut self) {
        self.iter += 1;
    }

    fn get_iter(&self) -> u64 {
        self.iter
    }

    fn get_cost(&self) -> f64 {
        self.iterate.as_ref().map_or(f64::INFINITY, |i| i.values.objective)
    }

    fn get_best_cost(&self) -> f64 {
        self.incumbent.as_ref().map_or(f64::INFINITY, |best| best.values.objective)
    }

    fn get_target_cost(&self) -> f64 {
        f64::NEG_INFINITY
    }

    fn func_counts<O>(&mut self, problem: &Problem<O>) {
        self.counts = problem.counts.iter().map(|(k, v)| ((*k).to_owned(), *v)).collect();
    }

    fn get_func_counts(&self) -> &HashMap<String, u64> {
        &self.counts
    }

    fn time(&mut self, time: Option<Duration>) -> &mut Self {
        self.time = time;
        self
    }

    fn get_time(&self) -> Option<Duration> {
        self.time
    }

    fn get_last_best_iter(&self) -> u64 {
        self.iter
    }

    fn is_best(&self) -> bool {
        self.incumbent.as_ref().zip(self.iterate.as_ref()).is_some_and(|(best, i)| best.x == i.x)
    }

    fn terminate_with(mut self, reason: TerminationReason) -> Self {
        self.status = TerminationStatus::Terminated(reason);
        self
    }

    fn get_termination_status(&self) -> &TerminationStatus {
        &self.status
    }

    fn get_termination_reason(&self) -> Option<&TerminationReason> {
        match &self.status {
            TerminationStatus::Terminated(reason) => Some(reason),
            TerminationStatus::NotTerminated => None,
        }
    }
}

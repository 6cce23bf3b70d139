//! The search methods behind one door, and what a search may cost.
//!
//! [`Method::Sqp`] is what the others are measured against: the augmented Lagrangian needs several times its simulations but no
//! model of the constraints' curvature, COBYLA needs no gradients at all, which is for objectives with noise.

use super::linear::Softened;
use super::memory::{Key, key};
use super::minimum::Minimum;
use super::problem::Scaled;
use super::sqp::{SqpOptions, minimise};
use super::{
    ConstrainedProblem, EvaluationError, LinearConstraint, Outcome, Slopes, Values, cobyla, lagrangian,
};
use crate::run::IterationEvent;
use argmin::core::Error;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// How the next design is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Sequential quadratic programming.
    #[default]
    Sqp,
    /// Limited-memory BFGS on the box with an augmented Lagrangian for the constraints.
    AugmentedLagrangian,
    /// Linear approximations without gradients (Powell 1994).
    Cobyla,
}

impl Method {
    /// Its name in sentences.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sqp => "SQP",
            Self::AugmentedLagrangian => "augmented Lagrangian with L-BFGS",
            Self::Cobyla => "COBYLA",
        }
    }
}

/// What a search may cost; none for no limit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Budget {
    /// Different designs simulated at most; what gradients simulate beside them does not count.
    pub simulations: Option<u64>,
    /// Wall time, s. A search that ends by it does not end at the same design twice.
    pub seconds: Option<f64>,
}

/// A method with its settings.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SearchOptions {
    /// The method.
    pub method: Method,
    /// Tolerance, iterations and step limit: common to all methods.
    pub settings: SqpOptions,
    /// Its budget.
    pub budget: Budget,
}

/// Searches from a start by the method asked for, within its budget.
///
/// # Errors
/// Only if argmin itself fails; everything else is an [`Outcome`].
pub fn search<P: ConstrainedProblem + ?Sized>(
    problem: &P,
    start: &[f64],
    options: &SearchOptions,
) -> Result<Minimum, Error> {
    let watched = Watched {
        problem,
        budget: options.budget,
        began: Instant::now(),
        asked: Mutex::default(),
        spent: AtomicBool::new(false),
    };
    let softened = || Softened::new(&watched, start);
    if options.method != Method::Sqp && !problem.linear().is_empty() {
        // Methods that do not hold the rows would search long for what does not exist.
        let scaled = Scaled::new(problem, start);
        if let Err(end) = scaled.allowed(start) {
            return Ok(*end);
        }
    }
    let mut end = match options.method {
        Method::Sqp => minimise(&watched, start, options.settings)?,
        Method::AugmentedLagrangian => {
            let problem = softened();
            problem.restored(lagrangian::minimise(&problem, start, options.settings))
        }
        Method::Cobyla => {
            let problem = softened();
            problem.restored(cobyla::minimise(&problem, start, options.settings))
        }
    };
    if end.outcome == Outcome::Cancelled && watched.spent.into_inner() {
        end.outcome = Outcome::BudgetSpent;
    }
    Ok(end)
}

/// A problem that stops answering when the budget is spent.
struct Watched<'p, P: ?Sized> {
    problem: &'p P,
    budget: Budget,
    began: Instant,
    /// Designs that were asked for; asking again costs nothing.
    asked: Mutex<HashSet<Key>>,
    spent: AtomicBool,
}

impl<P: ConstrainedProblem + ?Sized> ConstrainedProblem for Watched<'_, P> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        self.problem.bounds()
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let design = key(x);
        let mut asked = self.asked.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let late = self.budget.seconds.is_some_and(|s| self.began.elapsed().as_secs_f64() > s);
        let spent = self.budget.simulations.is_some_and(|most| asked.len() as u64 >= most);
        if late || (spent && !asked.contains(&design)) {
            self.spent.store(true, Ordering::Relaxed);
            return Err(EvaluationError::Cancelled);
        }
        asked.insert(design);
        drop(asked);
        self.problem.values(x)
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        self.problem.slopes(x)
    }

    fn linear(&self) -> Vec<LinearConstraint> {
        self.problem.linear()
    }

    fn accepted(&self, news: &IterationEvent) {
        self.problem.accepted(news);
    }
}

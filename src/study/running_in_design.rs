//! The running-in design: least loss while the bearings wear, within limits on what they wear.
//!
//! ```text
//! minimise  sum_bearings count * P_wear(x)  (or the loss in the end)    subject to the limits of the study with new surfaces,
//!           largest wear depth and worn volume of every bearing within theirs
//! ```
//!
//! The blocks of each march are those that its error control chose at the start design, so that values and gradients belong to one
//! discrete problem (see [`crate::running_in`]); the run marches the design anew, with blocks of its own, and reports that.

use super::build::Plan;
use super::check::Study;
use super::programme::{march_options, stages};
use super::running_in::RunningInPlan;
use crate::optimise::{ConstrainedProblem, EvaluationError, LinearConstraint, Slopes, Values};
use crate::run::{Cost, IterationEvent, RunContext};
use crate::running_in::{
    March, MarchEngine, MarchError, MarchOptions, RunningInQuantity, Stage, march, march_gradient, replay,
};
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// One bearing of the problem.
struct Own {
    bearing: usize,
    count: f64,
    options: MarchOptions,
    shares: Vec<Vec<f64>>,
}

/// A bearing marched through its programme at a design.
struct Marched {
    stages: Vec<Stage>,
    found: March,
}

/// A design with its marches.
struct Latest {
    x: Vec<f64>,
    marched: Arc<Vec<Marched>>,
}

/// The problem; see the module page.
pub(super) struct RunningInProblem<'p, 'r> {
    study: &'p Study,
    wanted: &'p RunningInPlan,
    plan: &'p Plan<'r>,
    context: RunContext<'p>,
    own: Vec<Own>,
    /// The design marched last: its gradients are asked for next, if it is accepted.
    latest: Mutex<Option<Latest>>,
    cost: Mutex<Cost>,
}

fn refused(e: MarchError) -> EvaluationError {
    match e {
        MarchError::Cancelled => EvaluationError::Cancelled,
        other => EvaluationError::Failed(other.to_string()),
    }
}

impl<'p, 'r> RunningInProblem<'p, 'r> {
    /// The problem with the blocks that its start design asks for.
    pub fn new(
        study: &'p Study,
        wanted: &'p RunningInPlan,
        plan: &'p Plan<'r>,
        start: &[f64],
        context: RunContext<'p>,
    ) -> Result<Self, EvaluationError> {
        let own = |bearing: usize| {
            let plan_of = &study.bearings[bearing];
            let options = march_options(study, wanted, bearing);
            let stages = stages(study, wanted, plan, bearing, start)
                .map_err(|e| EvaluationError::Failed(e.to_string()))?;
            let found = march(&stages, &options, context.cancel, &mut |_| {}).map_err(refused)?;
            let (count, shares) = (f64::from(plan_of.count), found.shares(&stages));
            Ok(Own { bearing, count, options, shares })
        };
        let own: Result<Vec<Own>, EvaluationError> = (0..study.bearings.len()).map(own).collect();
        let (latest, cost) = (Mutex::default(), Mutex::default());
        Ok(Self { study, wanted, plan, context, own: own?, latest, cost })
    }

    /// Work of all marches and of their gradients.
    pub fn cost(&self) -> Cost {
        *self.cost.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    fn spend(&self, cost: Cost) {
        *self.cost.lock().unwrap_or_else(std::sync::PoisonError::into_inner) += cost;
    }

    /// All bearings marched at a design.
    fn marched(&self, x: &[f64]) -> Result<Arc<Vec<Marched>>, EvaluationError> {
        let latest = || self.latest.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(known) = latest().as_ref().filter(|known| known.x == x) {
            return Ok(known.marched.clone());
        }
        let one = |own: &Own| {
            let stages = stages(self.study, self.wanted, self.plan, own.bearing, x)
                .map_err(|e| EvaluationError::Failed(e.to_string()))?;
            let found =
                replay(&stages, &own.shares, &own.options, None, self.context.cancel).map_err(refused)?;
            self.spend(found.course.cost);
            Ok(Marched { stages, found })
        };
        let all: Result<Vec<Marched>, EvaluationError> = self.own.par_iter().map(one).collect();
        let marched = Arc::new(all?);
        *latest() = Some(Latest { x: x.to_vec(), marched: marched.clone() });
        Ok(marched)
    }

    fn minimised(&self) -> RunningInQuantity {
        self.wanted.minimise.unwrap_or(RunningInQuantity::MeanLoss)
    }
}

impl ConstrainedProblem for RunningInProblem<'_, '_> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        self.plan.problem.bounds()
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let mut values = self.plan.problem.values(x)?;
        values.objective = 0.0;
        for (own, Marched { stages, found, .. }) in self.own.iter().zip(&*self.marched(x)?) {
            let Some(Stage { model, .. }) = stages.last() else { continue };
            values.objective += own.count * self.minimised().value(&found.course, model);
            let beyond =
                self.wanted.limits.iter().map(|l| l.quantity.value(&found.course, model) / l.limit - 1.0);
            values.inequalities.extend(beyond);
        }
        Ok(values)
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let mut slopes = self.plan.problem.slopes(x)?;
        slopes.objective.fill(0.0);
        let (lower, upper) = self.bounds();
        let steps: Vec<f64> =
            lower.iter().zip(&upper).map(|(l, u)| self.study.perturbation * (u - l)).collect();
        let engine = MarchEngine { name: self.study.engine, steps: &steps };
        let of: Vec<RunningInQuantity> =
            std::iter::once(self.minimised()).chain(self.wanted.limits.iter().map(|l| l.quantity)).collect();
        for (own, Marched { stages, found }) in self.own.iter().zip(&*self.marched(x)?) {
            let table = march_gradient(engine, stages, found, &own.options, &of, self.context.cancel);
            let table = table.map_err(refused)?;
            self.spend(table.cost);
            let mut rows = table.rows.into_iter();
            let objective = rows.next().unwrap_or_default();
            slopes.objective.iter_mut().zip(&objective).for_each(|(sum, g)| *sum += own.count * g);
            for (mut row, limit) in rows.zip(&self.wanted.limits) {
                row.iter_mut().for_each(|g| *g /= limit.limit);
                row.resize(x.len(), 0.0);
                slopes.inequalities.push(row);
            }
        }
        Ok(slopes)
    }

    fn linear(&self) -> Vec<LinearConstraint> {
        self.plan.problem.linear()
    }

    fn accepted(&self, news: &IterationEvent) {
        self.plan.problem.accepted(news);
    }
}

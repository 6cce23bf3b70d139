//! The running-in design: least loss while the bearings wear, within limits on what they wear.
//!
//! ```text
//! minimise    sum_bearings count * P_wear(x)      or energy, or the loss in the end
//! subject to  the limits of the study with new surfaces, and of every bearing those on what is worn and on the cycle in the end
//! ```
//!
//! The blocks of each march are those that its error control chose at the start design, so that values and gradients belong to one
//! discrete problem (see [`crate::running_in`]); the run marches the design anew, with blocks of its own, and reports that. A first
//! leg may take groups of blocks instead (`P_alpha`); the next begins at its end, with the blocks that are right there. A leg whose
//! blocks do not fit its end, where a march of its own finds other values, is followed by one more.
//!
//! What was found at every design is remembered and saved: a search that was stopped marches nothing twice.

use super::build::Plan;
use super::check::Study;
use super::keep::Keep;
use super::programme::{march_options, stages};
use super::running_in::RunningInPlan;
use crate::optimise::{ConstrainedProblem, EvaluationError, LinearConstraint, Slopes, Values};
use crate::run::{Cost, IterationEvent, RunContext};
use crate::running_in::{
    March, MarchEngine, MarchError, MarchOptions, RunningInQuantity, Stage, approximation, march,
    march_gradient, replay,
};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Blocks of every bearing and stage, as shares of the stage's duration.
type Blocks = Vec<Vec<Vec<f64>>>;

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

/// What was found at a design: per bearing the minimised quantity and the limited ones, and their gradients where they were asked for.
#[derive(Clone, Serialize, Deserialize)]
struct Found {
    x: Vec<f64>,
    values: Vec<Vec<f64>>,
    rows: Option<Vec<Vec<Vec<f64>>>>,
}

/// Work of marches, and of gradients through them beyond the marches.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Work {
    pub marches: Cost,
    pub gradients: Cost,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.marches += other.marches;
        self.gradients += other.gradients;
    }
}

/// All that was found for a choice of blocks, and the work it was.
#[derive(Default, Serialize, Deserialize)]
struct Memory {
    blocks: Blocks,
    groups: Blocks,
    /// What the marches that chose the blocks found there.
    chosen_at: Vec<Vec<f64>>,
    found: Vec<Found>,
    work: Work,
}

impl Memory {
    fn saved(keep: &Keep) -> Option<Self> {
        postcard::from_bytes(&keep.load()?).ok()
    }

    fn save(&self, keep: &Keep) {
        keep.save(&postcard::to_stdvec(self).unwrap_or_default());
    }
}

/// The problem; see the module page.
pub(super) struct RunningInProblem<'p, 'r> {
    study: &'p Study,
    wanted: &'p RunningInPlan,
    plan: &'p Plan<'r>,
    context: RunContext<'p>,
    keep: Keep<'p>,
    options: Vec<MarchOptions>,
    blocks: Blocks,
    memory: Mutex<Memory>,
    /// The design marched last: its gradients are asked for next, if it is accepted.
    latest: Mutex<Option<Latest>>,
}

fn refused(e: MarchError) -> EvaluationError {
    match e {
        MarchError::Cancelled => EvaluationError::Cancelled,
        other => EvaluationError::Failed(other.to_string()),
    }
}

fn open<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The minimised quantity and the limited ones of a bearing, in this order.
fn quantities(wanted: &RunningInPlan, bearing: usize) -> Vec<RunningInQuantity> {
    let minimised = wanted.minimise.unwrap_or(RunningInQuantity::MeanLoss);
    std::iter::once(minimised).chain(wanted.limits_of(bearing).map(|l| l.quantity)).collect()
}

/// Values of the minimised quantity and the limited ones of a bearing.
fn values(wanted: &RunningInPlan, bearing: usize, stages: &[Stage], found: &March) -> Vec<f64> {
    let Some(Stage { model, .. }) = stages.last() else { return Vec::new() };
    quantities(wanted, bearing).iter().map(|q| q.value(&found.course, model)).collect()
}

/// Step of the difference that proves a gradient, as a share of the box.
const BESIDE: f64 = 1e-5;

/// Number of blocks.
fn count(blocks: &Blocks) -> usize {
    blocks.iter().flatten().map(Vec::len).sum()
}

impl<'p, 'r> RunningInProblem<'p, 'r> {
    /// The problem with the blocks that a start design asks for.
    pub fn new(
        study: &'p Study,
        wanted: &'p RunningInPlan,
        plan: &'p Plan<'r>,
        start: &[f64],
        keep: Keep<'p>,
        context: RunContext<'p>,
    ) -> Result<Self, EvaluationError> {
        let options: Vec<MarchOptions> =
            (0..study.bearings.len()).map(|b| march_options(study, wanted, b)).collect();
        let memory = match Memory::saved(&keep) {
            Some(memory) => memory,
            None => {
                let memory = first_march(study, wanted, plan, start, &options, context)?;
                memory.save(&keep);
                memory
            }
        };
        let (blocks, latest) = (memory.blocks.clone(), Mutex::default());
        let memory = Mutex::new(memory);
        Ok(Self { study, wanted, plan, context, keep, options, blocks, memory, latest })
    }

    /// The same with groups of its blocks: `P_alpha` in place of `P_wear`.
    pub fn approximated(&self, keep: Keep<'p>) -> Self {
        let groups = open(&self.memory).groups.clone();
        let memory =
            Memory::saved(&keep).unwrap_or_else(|| Memory { blocks: groups.clone(), ..Memory::default() });
        Self {
            study: self.study,
            wanted: self.wanted,
            plan: self.plan,
            context: self.context,
            keep,
            options: self.options.clone(),
            blocks: groups,
            memory: Mutex::new(memory),
            latest: Mutex::default(),
        }
    }

    /// Largest relative difference between what is found at a design and what the marches found from which another problem chose its
    /// blocks there.
    pub fn apart(&self, x: &[f64], other: &Self) -> Result<f64, EvaluationError> {
        let (frozen, anew) = (self.worth(x)?, open(&other.memory).chosen_at.clone());
        let of = |(bearing, (a, b)): (usize, (&Vec<f64>, &Vec<f64>))| {
            let scales = std::iter::once(0.0).chain(self.wanted.limits_of(bearing).map(|l| l.limit));
            let each = a.iter().zip(b).zip(scales).map(|((a, b), s)| (a - b).abs() / a.abs().max(s));
            each.fold(0.0, f64::max)
        };
        Ok(frozen.iter().zip(&anew).enumerate().map(of).fold(0.0, f64::max))
    }

    /// Blocks of the march, and of them the groups of its approximation.
    pub fn sizes(&self) -> (usize, usize) {
        let memory = open(&self.memory);
        (count(&self.blocks), count(&memory.groups))
    }

    /// Blocks of every bearing and stage.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// Work of all marches and of their gradients.
    pub fn work(&self) -> Work {
        open(&self.memory).work
    }

    /// All bearings marched at a design.
    fn marched(&self, x: &[f64]) -> Result<Arc<Vec<Marched>>, EvaluationError> {
        if let Some(known) = open(&self.latest).as_ref().filter(|known| known.x == x) {
            return Ok(known.marched.clone());
        }
        let one = |bearing: usize| {
            let stages = stages(self.study, self.wanted, self.plan, bearing, x)
                .map_err(|e| EvaluationError::Failed(e.to_string()))?;
            let (blocks, options) = (&self.blocks[bearing], &self.options[bearing]);
            let found = replay(&stages, blocks, options, None, self.context.cancel).map_err(refused)?;
            open(&self.memory).work.marches += found.course.cost;
            Ok(Marched { stages, found })
        };
        let all: Result<Vec<Marched>, EvaluationError> =
            (0..self.options.len()).into_par_iter().map(one).collect();
        let marched = Arc::new(all?);
        *open(&self.latest) = Some(Latest { x: x.to_vec(), marched: marched.clone() });
        Ok(marched)
    }

    fn counts(&self) -> impl Iterator<Item = f64> {
        self.study.bearings.iter().map(|b| f64::from(b.count))
    }

    fn known(&self, x: &[f64]) -> Option<Found> {
        open(&self.memory).found.iter().find(|f| f.x == x).cloned()
    }

    /// What a design is worth, from memory or from its marches.
    fn worth(&self, x: &[f64]) -> Result<Vec<Vec<f64>>, EvaluationError> {
        if let Some(known) = self.known(x) {
            return Ok(known.values);
        }
        let one = |(bearing, m): (usize, &Marched)| values(self.wanted, bearing, &m.stages, &m.found);
        let values: Vec<Vec<f64>> = self.marched(x)?.iter().enumerate().map(one).collect();
        open(&self.memory).found.push(Found { x: x.to_vec(), values: values.clone(), rows: None });
        Ok(values)
    }

    /// Gradients at a design, from memory or from its marches; what is known by then is saved.
    fn gradients(&self, x: &[f64]) -> Result<Vec<Vec<Vec<f64>>>, EvaluationError> {
        if let Some(rows) = self.known(x).and_then(|known| known.rows) {
            return Ok(rows);
        }
        self.worth(x)?;
        let (lower, upper) = self.bounds();
        let steps: Vec<f64> =
            lower.iter().zip(&upper).map(|(l, u)| self.study.perturbation * (u - l)).collect();
        let engine = MarchEngine { name: self.plan.problem.engine_name(), steps: &steps };
        let mut all = Vec::new();
        for (bearing, Marched { stages, found }) in self.marched(x)?.iter().enumerate() {
            let (options, of) = (&self.options[bearing], quantities(self.wanted, bearing));
            let table = march_gradient(engine, stages, found, options, &of, self.context.cancel);
            let mut table = table.map_err(refused)?;
            open(&self.memory).work.gradients += table.cost;
            table.rows.iter_mut().for_each(|row| row.resize(x.len(), 0.0));
            all.push(table.rows);
        }
        let mut memory = open(&self.memory);
        if let Some(found) = memory.found.iter_mut().find(|f| f.x == x) {
            found.rows = Some(all.clone());
        }
        memory.save(&self.keep);
        Ok(all)
    }

    /// The minimised quantity of all bearings at a design, W: energy per length of the programme as the study has it.
    pub fn objective(&self, x: &[f64]) -> Result<f64, EvaluationError> {
        let sum: f64 = self.worth(x)?.iter().zip(self.counts()).map(|(own, n)| n * own[0]).sum();
        Ok(sum / self.wanted.objective_scale())
    }
}

/// A gradient of the minimised quantity, and one derivative of it against a difference.
#[derive(Debug, Clone)]
pub(super) struct Proof {
    /// By every parameter, over its whole box, W.
    pub over_box_w: Vec<f64>,
    /// Along a direction that takes every parameter: by the engine, and by a central difference of two marches, W.
    pub along_w: [f64; 2],
}

impl RunningInProblem<'_, '_> {
    /// The gradient at a design, checked by two marches beside it.
    pub fn proof(&self, x: &[f64]) -> Result<Proof, EvaluationError> {
        let (lower, upper) = self.bounds();
        let boxes: Vec<f64> = lower.iter().zip(&upper).map(|(l, u)| u - l).collect();
        let gradient = self.slopes(x)?.objective;
        let over_box_w: Vec<f64> = gradient.iter().zip(&boxes).map(|(g, b)| g * b).collect();
        // All parameters count, none cancels another.
        let along: Vec<f64> = over_box_w.iter().map(|g| g.signum()).collect();
        let moved = |sign: f64| -> Vec<f64> {
            x.iter().zip(&boxes).zip(&along).map(|((x, b), d)| x + sign * BESIDE * b * d).collect()
        };
        let difference = (self.objective(&moved(1.0))? - self.objective(&moved(-1.0))?) / (2.0 * BESIDE);
        Ok(Proof { along_w: [crate::math::dot(&over_box_w, &along), difference], over_box_w })
    }
}

/// The marches at a start, whose blocks the problem keeps.
fn first_march(
    study: &Study,
    wanted: &RunningInPlan,
    plan: &Plan,
    start: &[f64],
    options: &[MarchOptions],
    context: RunContext<'_>,
) -> Result<Memory, EvaluationError> {
    let mut memory = Memory::default();
    for (bearing, options) in options.iter().enumerate() {
        let stages = stages(study, wanted, plan, bearing, start)
            .map_err(|e| EvaluationError::Failed(e.to_string()))?;
        let found = march(&stages, options, context.cancel, &mut |_| {}).map_err(refused)?;
        memory.blocks.push(found.shares(&stages));
        memory.groups.push(approximation(&found, &stages, options));
        memory.chosen_at.push(values(wanted, bearing, &stages, &found));
        memory.work.marches += found.course.cost;
    }
    Ok(memory)
}

impl ConstrainedProblem for RunningInProblem<'_, '_> {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        self.plan.problem.bounds()
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let mut values = self.plan.problem.values(x)?;
        values.objective = self.objective(x)?;
        for (bearing, own) in self.worth(x)?.iter().enumerate() {
            let limited = own[1..].iter().zip(self.wanted.limits_of(bearing));
            values.inequalities.extend(limited.map(|(v, l)| l.constraint(*v).0));
        }
        Ok(values)
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let mut slopes = self.plan.problem.slopes(x)?;
        slopes.objective.fill(0.0);
        for (bearing, (rows, count)) in self.gradients(x)?.into_iter().zip(self.counts()).enumerate() {
            let mut rows = rows.into_iter();
            let objective = rows.next().unwrap_or_default();
            let by = count / self.wanted.objective_scale();
            slopes.objective.iter_mut().zip(&objective).for_each(|(sum, g)| *sum += by * g);
            for (mut row, limit) in rows.zip(self.wanted.limits_of(bearing)) {
                let (_, by) = limit.constraint(0.0);
                row.iter_mut().for_each(|g| *g *= by);
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

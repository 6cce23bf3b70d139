//! What every method keeps of its search: the problem in scaled variables, the best point, the history, counts.

use super::kkt::kkt_residual;
use super::minimum::{Ended, Incumbent, Minimum};
use super::problem::Scaled;
use super::qp::Qp;
use super::sqp::SqpOptions;
use super::{ConstrainedProblem, EvaluationError, Outcome, Slopes, Values};
use crate::run::IterationEvent;
use nalgebra::DMatrix;

pub(super) struct Record<'p, P: ?Sized> {
    pub scaled: Scaled<'p, P>,
    /// The start in scaled variables.
    pub start: Vec<f64>,
    pub options: SqpOptions,
    pub iterations: u64,
    pub failures: Vec<String>,
    evaluations: u64,
    gradients: u64,
    best: Option<Incumbent>,
    history: Vec<IterationEvent>,
}

impl<'p, P: ConstrainedProblem + ?Sized> Record<'p, P> {
    pub fn new(problem: &'p P, start: &[f64], options: SqpOptions) -> Self {
        let scaled = Scaled::new(problem, start);
        Self {
            start: scaled.to_scaled(start),
            scaled,
            options,
            iterations: 0,
            failures: Vec::new(),
            evaluations: 0,
            gradients: 0,
            best: None,
            history: Vec::new(),
        }
    }

    pub fn values(&mut self, s: &[f64]) -> Result<Values, EvaluationError> {
        self.evaluations += 1;
        let values = self.scaled.values(s)?;
        Incumbent::keep_better(&mut self.best, s, &values, self.options.tolerance);
        Ok(values)
    }

    pub fn slopes(&mut self, s: &[f64]) -> Result<Slopes, EvaluationError> {
        self.gradients += 1;
        self.scaled.slopes(s)
    }

    /// Notes an accepted point and tells of it.
    pub fn accept(&mut self, s: &[f64], values: &Values, slopes: &Slopes, from: &[f64]) {
        self.iterations += 1;
        let kkt = self.judge(s, values, slopes);
        let step = s.iter().zip(from).fold(0.0f64, |a, (b, c)| a.max((b - c).abs()));
        let news = IterationEvent {
            iteration: self.iterations,
            objective_w: values.objective * self.scaled.objective_scale,
            violation: values.violation(),
            kkt,
            step,
            simulations: self.evaluations,
        };
        self.scaled.problem.accepted(&news);
        self.history.push(news);
    }

    /// KKT residual of a point, with the multipliers of a quadratic model of unit curvature there; a point that meets the
    /// tolerance becomes the best one.
    pub fn judge(&mut self, s: &[f64], values: &Values, slopes: &Slopes) -> f64 {
        let n = s.len();
        let room = |bound: &[f64]| -> Vec<f64> { bound.iter().zip(s).map(|(b, s)| b - s).collect() };
        let (hessian, lower, upper) =
            (DMatrix::identity(n, n), room(&self.scaled.lower), room(&self.scaled.upper));
        let model = Qp { hessian: &hessian, values, slopes, linear: &[], lower: &lower, upper: &upper };
        let Some(found) = model.solve() else { return f64::INFINITY };
        let kkt = kkt_residual(values, slopes, &[], &found);
        let same = self.best.as_ref().is_some_and(|b| b.x == s);
        if same || kkt <= self.options.tolerance {
            let (x, values) = (s.to_vec(), values.clone());
            self.best = Some(Incumbent { x, values, kkt, combined: 1, multipliers: found.multipliers });
        }
        kkt
    }

    /// Names the end of a search that cannot go on.
    pub fn give_up(&self) -> Outcome {
        Incumbent::give_up(self.best.as_ref(), self.options.tolerance)
    }

    /// The best point, its optimality judged if it has not been.
    pub fn judge_best(&mut self) -> Result<f64, EvaluationError> {
        let Some(best) = &self.best else { return Ok(f64::INFINITY) };
        if best.kkt.is_finite() {
            return Ok(best.kkt);
        }
        let (x, values) = (best.x.clone(), best.values.clone());
        let slopes = self.slopes(&x)?;
        let start = self.start.clone();
        self.accept(&x, &values, &slopes, &start);
        Ok(self.best.as_ref().map_or(f64::INFINITY, |b| b.kkt))
    }

    /// Searches from the start, after scaling the objective by its size there; a failure there ends the search.
    pub fn search(mut self, method: impl FnOnce(&mut Self) -> Result<Outcome, EvaluationError>) -> Minimum {
        let scaled = self.scaled.scale_objective_at(&self.start);
        let outcome = scaled.and_then(|()| method(&mut self)).unwrap_or_else(|e| match e {
            EvaluationError::Cancelled => Outcome::Cancelled,
            EvaluationError::Failed(reason) => {
                self.failures.push(reason);
                Outcome::StartFailed
            }
        });
        let ended = Ended {
            outcome,
            best: self.best,
            start: self.start,
            history: self.history,
            failures: self.failures,
            evaluations: self.evaluations,
            gradients: self.gradients,
        };
        ended.restored(&self.scaled)
    }
}

//! What every method keeps of its search: the problem in scaled variables, the best point, the history, counts.

use super::kkt::kkt_residual;
use super::problem::Scaled;
use super::qp::Qp;
use super::sqp::{CLOSE, FEASIBLE, Minimum, SqpOptions};
use super::{ConstrainedProblem, EvaluationError, Multipliers, Outcome, Slopes, Values};
use crate::run::IterationEvent;
use nalgebra::DMatrix;

/// The best point so far.
struct Best {
    x: Vec<f64>,
    values: Values,
    kkt: f64,
    multipliers: Multipliers,
}

pub(super) struct Record<'p, P: ?Sized> {
    pub scaled: Scaled<'p, P>,
    /// The start in scaled variables.
    pub start: Vec<f64>,
    pub options: SqpOptions,
    pub iterations: u64,
    pub failures: Vec<String>,
    evaluations: u64,
    gradients: u64,
    best: Option<Best>,
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

    /// Divides the objective by its size at the start.
    pub fn scale(&mut self) -> Result<(), EvaluationError> {
        let size = self.scaled.values(&self.start)?.objective.abs();
        self.scaled.objective_scale = if size < 1e-8 { 1.0 } else { size };
        Ok(())
    }

    pub fn values(&mut self, s: &[f64]) -> Result<Values, EvaluationError> {
        self.evaluations += 1;
        let values = self.scaled.values(s)?;
        let feasible = self.options.tolerance.max(FEASIBLE);
        let rank = |v: &Values| (v.violation().max(feasible), v.objective);
        if self.best.as_ref().is_none_or(|b| rank(&values) < rank(&b.values)) {
            let (x, values) = (s.to_vec(), values.clone());
            self.best = Some(Best { x, values, kkt: f64::INFINITY, multipliers: Multipliers::default() });
        }
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
        let model = Qp { hessian: &hessian, values, slopes, lower: &lower, upper: &upper };
        let Some(found) = model.solve() else { return f64::INFINITY };
        let kkt = kkt_residual(values, slopes, &found);
        let same = self.best.as_ref().is_some_and(|b| b.x == s);
        if same || kkt <= self.options.tolerance {
            let (x, values) = (s.to_vec(), values.clone());
            self.best = Some(Best { x, values, kkt, multipliers: found.multipliers });
        }
        kkt
    }

    /// Names the end of a search that cannot go on.
    pub fn give_up(&self) -> Outcome {
        let close =
            |b: &Best| b.kkt <= CLOSE.max(10.0 * self.options.tolerance) && b.values.violation() <= CLOSE;
        if self.best.as_ref().is_some_and(close) { Outcome::AlmostConverged } else { Outcome::NoProgress }
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

    pub fn finish(self, outcome: Outcome) -> Minimum {
        let scale = self.scaled.objective_scale;
        let restore = |v: &[f64]| v.iter().map(|m| m * scale).collect();
        let (x, values, kkt, m) = match self.best {
            Some(b) => (b.x, Some(b.values), b.kkt, b.multipliers),
            None => (self.start, None, f64::INFINITY, Multipliers::default()),
        };
        Minimum {
            outcome,
            x: self.scaled.to_true(&x),
            values: values.map(|v| Values { objective: v.objective * scale, ..v }),
            multipliers: Multipliers {
                inequalities: restore(&m.inequalities),
                equalities: restore(&m.equalities),
                lower: restore(&m.lower),
                upper: restore(&m.upper),
            },
            kkt,
            combined: 1,
            history: self.history,
            failures: self.failures,
            evaluations: self.evaluations,
            gradients: self.gradients,
        }
    }
}

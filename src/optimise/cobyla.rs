//! COBYLA (Powell 1994) in the unit box: linear models from values at the corners of a simplex, no gradients. One gradient at its
//! end says how good the end is.

use super::minimum::Minimum;
use super::record::Record;
use super::sqp::SqpOptions;
use super::{ConstrainedProblem, EvaluationError, Outcome, Values};
use std::cell::RefCell;

/// First and last size of the simplex, in boxes.
const FIRST: f64 = 0.1;
/// A design that cannot be simulated counts as this much worse than the start, and as violating every constraint by one.
const BAD: f64 = 10.0;
/// Evaluations at most, per iteration that is allowed.
const PER_ITERATION: u64 = 20;

/// What is known of the last point asked for: value and constraints come from one simulation.
struct Last<'r, 'p, P: ?Sized> {
    record: &'r mut Record<'p, P>,
    x: Vec<f64>,
    values: Values,
    cancelled: bool,
}

/// Searches from a start.
pub(super) fn minimise<P: ConstrainedProblem + ?Sized>(
    problem: &P,
    start: &[f64],
    options: SqpOptions,
) -> Minimum {
    Record::new(problem, start, options).search(|record| {
        let begin = record.start.clone();
        let first = record.values(&begin)?;
        let cancelled = search(record, first);
        Ok(end(record, cancelled))
    })
}

/// Judges the best point by its gradient.
fn end<P: ConstrainedProblem + ?Sized>(record: &mut Record<'_, P>, cancelled: bool) -> Outcome {
    match record.judge_best() {
        _ if cancelled => Outcome::Cancelled,
        Ok(kkt) if kkt <= record.options.tolerance => Outcome::Converged,
        Err(EvaluationError::Cancelled) => Outcome::Cancelled,
        _ => record.give_up(),
    }
}

/// Runs COBYLA; whether it was cancelled.
fn search<P: ConstrainedProblem + ?Sized>(record: &mut Record<'_, P>, first: Values) -> bool {
    let start = record.start.clone();
    let n = start.len();
    let bounds: Vec<(f64, f64)> =
        record.scaled.lower.iter().copied().zip(record.scaled.upper.iter().copied()).collect();
    let (above, equal) = (first.inequalities.len(), first.equalities.len());
    let most = (record.options.max_iterations * PER_ITERATION) as usize;
    let tolerance = record.options.tolerance;
    let last = RefCell::new(Last { record, x: start.clone(), values: first, cancelled: false });
    let ask = |x: &[f64], pick: &dyn Fn(&Values) -> f64| -> f64 {
        let mut last = last.borrow_mut();
        if last.x != x {
            last.update(x);
        }
        pick(&last.values)
    };
    let ask = &ask;
    let objective = |x: &[f64], (): &mut ()| ask(x, &|v| v.objective);
    // The crate wants constraints at or above zero; an equality is two of them.
    let constraint = |k: usize| {
        move |x: &[f64], (): &mut ()| {
            ask(x, &|v| match k.checked_sub(above) {
                None => -v.inequalities[k],
                Some(e) if e % 2 == 0 => v.equalities[e / 2],
                Some(e) => -v.equalities[e / 2],
            })
        }
    };
    let constraints: Vec<_> = (0..above + 2 * equal).map(constraint).collect();
    let stop = cobyla::StopTols { ftol_rel: 0.0, ftol_abs: 0.0, xtol_rel: 0.0, xtol_abs: vec![tolerance; n] };
    // How it ends is judged by the gradient at the best point, not by its own status.
    let begin = cobyla::RhoBeg::All(FIRST);
    let _ = cobyla::minimize(objective, &start, &bounds, &constraints, (), most, begin, Some(stop));
    last.into_inner().cancelled
}

impl<P: ConstrainedProblem + ?Sized> Last<'_, '_, P> {
    fn update(&mut self, x: &[f64]) {
        self.x = x.to_vec();
        let found = if self.cancelled { Err(EvaluationError::Cancelled) } else { self.record.values(x) };
        match found {
            Ok(values) => self.values = values,
            Err(e) => {
                self.cancelled |= e == EvaluationError::Cancelled;
                if let EvaluationError::Failed(reason) = e {
                    self.record.failures.push(reason);
                }
                self.values.objective = BAD;
                self.values.inequalities.fill(1.0);
                self.values.equalities.fill(1.0);
            }
        }
    }
}

//! Augmented Lagrangian (Hestenes and Powell 1969) with limited-memory BFGS on the box inside (Nocedal and Wright 2006, ch. 17
//! and 7.2).
//!
//! ```text
//! Phi(x) = f + sum (max(0, l + r c)^2 - l^2) / (2 r) + sum (m g + r g^2 / 2)        minimised over the box, then
//! l = max(0, l + r c),   m = m + r g,   r = 10 r where the violation did not fall to a quarter
//! ```
//!
//! The inner search moves the variables that are not held by a bound along a two-loop direction and projects the way back into
//! the box. Deliberately not here: second derivatives, filters; for those see [`super::sqp`].

use super::minimum::Minimum;
use super::problem::Scaled;
use super::record::Record;
use super::sqp::SqpOptions;
use super::{ConstrainedProblem, EvaluationError, Outcome, Slopes, Values};
use crate::math::dot;
use std::collections::VecDeque;

/// Pairs of changes that are kept.
const PAIRS: usize = 10;
/// Weight of the violation at the start, its growth, and how far one outer iteration has to bring the violation down.
const WEIGHT: f64 = 10.0;
const GROWTH: f64 = 10.0;
const ENOUGH: f64 = 0.25;
/// Largest weight.
const HEAVIEST: f64 = 1e8;
/// Projected gradient at which the first inner search ends; each that follows ends at a tenth.
const LOOSE: f64 = 1e-1;
/// Share of the slope that a step must achieve, and the shortest step.
const ARMIJO: f64 = 1e-4;
const SHORTEST: f64 = 1e-10;
/// Curvature below this share of the lengths is no curvature.
const FLAT: f64 = 1e-12;

/// Multiplier estimates and the weight of the violation.
struct Prices {
    inequalities: Vec<f64>,
    equalities: Vec<f64>,
    weight: f64,
}

impl Prices {
    /// The augmented Lagrangian.
    fn value(&self, v: &Values) -> f64 {
        let r = self.weight;
        let above = self.inequalities.iter().zip(&v.inequalities);
        let above: f64 = above.map(|(l, c)| ((l + r * c).max(0.0).powi(2) - l * l) / (2.0 * r)).sum();
        let equal = self.equalities.iter().zip(&v.equalities);
        v.objective + above + equal.map(|(m, g)| m * g + 0.5 * r * g * g).sum::<f64>()
    }

    /// Its gradient.
    fn gradient(&self, v: &Values, slopes: &Slopes) -> Vec<f64> {
        let mut sum = slopes.objective.clone();
        let mut add = |row: &[f64], by: f64| sum.iter_mut().zip(row).for_each(|(s, g)| *s += by * g);
        let above = self.inequalities.iter().zip(&v.inequalities).zip(&slopes.inequalities);
        above.for_each(|((l, c), row)| add(row, (l + self.weight * c).max(0.0)));
        let equal = self.equalities.iter().zip(&v.equalities).zip(&slopes.equalities);
        equal.for_each(|((m, g), row)| add(row, m + self.weight * g));
        sum
    }

    /// The next estimates.
    fn update(&mut self, v: &Values) {
        let r = self.weight;
        self.inequalities.iter_mut().zip(&v.inequalities).for_each(|(l, c)| *l = (*l + r * c).max(0.0));
        self.equalities.iter_mut().zip(&v.equalities).for_each(|(m, g)| *m += r * g);
    }
}

struct Point {
    x: Vec<f64>,
    values: Values,
    slopes: Slopes,
}

/// Searches from a start.
pub(super) fn minimise<P: ConstrainedProblem + ?Sized>(
    problem: &P,
    start: &[f64],
    options: SqpOptions,
) -> Minimum {
    Record::new(problem, start, options).search(outer)
}

fn outer<P: ConstrainedProblem + ?Sized>(record: &mut Record<'_, P>) -> Result<Outcome, EvaluationError> {
    let x = record.start.clone();
    let mut now = Point { values: record.values(&x)?, slopes: record.slopes(&x)?, x };
    let mut prices = Prices {
        inequalities: vec![0.0; now.values.inequalities.len()],
        equalities: vec![0.0; now.values.equalities.len()],
        weight: WEIGHT,
    };
    let (mut rough, mut last) = (LOOSE, f64::INFINITY);
    loop {
        let ended = inner(record, &mut now, &prices, rough)?;
        let violation = now.values.violation();
        prices.update(&now.values);
        let kkt = record.judge(&now.x, &now.values, &now.slopes);
        if kkt <= record.options.tolerance {
            return Ok(Outcome::Converged);
        }
        if ended == Ended::Spent {
            return Ok(Outcome::IterationLimit);
        }
        let finest = 0.1 * record.options.tolerance;
        let stuck = ended == Ended::Stuck || rough <= finest;
        if violation > ENOUGH * last && violation > record.options.tolerance {
            prices.weight *= GROWTH;
        } else if stuck && violation <= record.options.tolerance {
            return Ok(record.give_up());
        }
        if prices.weight > HEAVIEST {
            return Ok(if violation > 1e-3 { Outcome::Infeasible } else { record.give_up() });
        }
        (rough, last) = ((0.1 * rough).max(finest), violation);
    }
}

#[derive(PartialEq)]
enum Ended {
    /// The projected gradient is small.
    Flat,
    /// No step along the direction descends.
    Stuck,
    /// The iterations are used up.
    Spent,
}

/// Minimises the augmented Lagrangian over the box.
fn inner<P: ConstrainedProblem + ?Sized>(
    record: &mut Record<'_, P>,
    now: &mut Point,
    prices: &Prices,
    rough: f64,
) -> Result<Ended, EvaluationError> {
    let mut pairs: VecDeque<(Vec<f64>, Vec<f64>)> = VecDeque::with_capacity(PAIRS);
    let mut gradient = prices.gradient(&now.values, &now.slopes);
    loop {
        let scaled = &record.scaled;
        if projected(scaled, &now.x, &gradient) <= rough {
            return Ok(Ended::Flat);
        }
        if record.iterations >= record.options.max_iterations {
            return Ok(Ended::Spent);
        }
        let held: Vec<bool> = (0..now.x.len())
            .map(|j| {
                (now.x[j] <= scaled.lower[j] && gradient[j] > 0.0)
                    || (now.x[j] >= scaled.upper[j] && gradient[j] < 0.0)
            })
            .collect();
        let direction = direction(&gradient, &held, &pairs, record.options.step_limit);
        let Some(next) = step(record, now, prices, &gradient, &direction)? else {
            if pairs.is_empty() {
                return Ok(Ended::Stuck);
            }
            pairs.clear();
            continue;
        };
        let there = prices.gradient(&next.values, &next.slopes);
        let change = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
        let (s, y) = (change(&next.x, &now.x), change(&there, &gradient));
        if dot(&s, &y) > FLAT * dot(&y, &y).max(dot(&s, &s)) {
            pairs.truncate(PAIRS - 1);
            pairs.push_front((s, y));
        }
        (*now, gradient) = (next, there);
    }
}

/// How far a step along the steepest descent would still go inside the box.
fn projected<P: ?Sized>(scaled: &Scaled<'_, P>, x: &[f64], gradient: &[f64]) -> f64 {
    (0..x.len()).fold(0.0f64, |a, j| {
        a.max(((x[j] - gradient[j]).clamp(scaled.lower[j], scaled.upper[j]) - x[j]).abs())
    })
}

/// `-H g` on the variables that are free, by the two loops over the kept pairs; a change of the first step's length at most.
fn direction(
    gradient: &[f64],
    held: &[bool],
    pairs: &VecDeque<(Vec<f64>, Vec<f64>)>,
    limit: f64,
) -> Vec<f64> {
    let free = |v: &[f64]| -> Vec<f64> {
        v.iter().zip(held).map(|(v, held)| if *held { 0.0 } else { *v }).collect()
    };
    let add = |d: &mut [f64], by: f64, v: &[f64]| d.iter_mut().zip(v).for_each(|(d, v)| *d += by * v);
    let kept: Vec<(Vec<f64>, Vec<f64>)> =
        pairs.iter().map(|(s, y)| (free(s), free(y))).filter(|(s, y)| dot(s, y) > 0.0).collect();
    let mut d: Vec<f64> = free(gradient).iter().map(|g| -g).collect();
    let mut shares = Vec::with_capacity(kept.len());
    for (s, y) in &kept {
        let share = dot(s, &d) / dot(s, y);
        add(&mut d, -share, y);
        shares.push(share);
    }
    if let Some((s, y)) = kept.first() {
        let size = dot(s, y) / dot(y, y);
        d.iter_mut().for_each(|d| *d *= size);
    }
    for ((s, y), share) in kept.iter().zip(shares).rev() {
        let back = dot(y, &d) / dot(s, y);
        add(&mut d, share - back, s);
    }
    if dot(&d, gradient) >= 0.0 {
        d = free(gradient).iter().map(|g| -g).collect();
    }
    let longest = d.iter().fold(0.0f64, |a, d| a.max(d.abs()));
    if longest > limit {
        d.iter_mut().for_each(|d| *d *= limit / longest);
    }
    d
}

/// The first point on the projected way that descends enough and has a gradient.
fn step<P: ConstrainedProblem + ?Sized>(
    record: &mut Record<'_, P>,
    now: &Point,
    prices: &Prices,
    gradient: &[f64],
    direction: &[f64],
) -> Result<Option<Point>, EvaluationError> {
    let (here, mut share) = (prices.value(&now.values), 1.0);
    while share >= SHORTEST {
        let (low, high) = (&record.scaled.lower, &record.scaled.upper);
        let x: Vec<f64> =
            (0..now.x.len()).map(|j| (now.x[j] + share * direction[j]).clamp(low[j], high[j])).collect();
        let slope: f64 = (0..x.len()).map(|j| gradient[j] * (x[j] - now.x[j])).sum();
        let tried = record.values(&x).and_then(|values| {
            let descends = prices.value(&values) <= here + ARMIJO * slope.min(0.0);
            if descends && slope < 0.0 { record.slopes(&x).map(|s| Some((values, s))) } else { Ok(None) }
        });
        match tried {
            Ok(Some((values, slopes))) => {
                record.accept(&x, &values, &slopes, &now.x);
                return Ok(Some(Point { x, values, slopes }));
            }
            Ok(None) => {}
            Err(EvaluationError::Cancelled) => return Err(EvaluationError::Cancelled),
            Err(EvaluationError::Failed(reason)) => record.failures.push(reason),
        }
        share *= 0.5;
    }
    Ok(None)
}

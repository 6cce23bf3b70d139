//! The last digits of an optimum by Newton's method: exact curvature instead of what gradients told on the way.
//!
//! ```text
//! minimise 1/2 d'H d + (H d0 + f')'d   over   d0 + Z v,   A d0 = -c,   Z a basis of the directions that active rows leave free
//! ```
//!
//! `H` is the Hessian of the Lagrangian along those directions, one product each ([`Curved`]); active are the bounds, linear and
//! other constraints that the search ended at. Multipliers are those of least squares. A step is kept if the KKT residual, which
//! counts what is missed of constraints too, falls. In the end the point is kept if its residual is below that of the search: at a
//! kink, where the search judges by a combination of gradients, it is not. Near a solution that is strict and keeps its active rows,
//! the residual falls quadratically. Deliberately not here: finding the active rows, which is the search's task.

use super::minimum::Minimum;
use super::problem::Scaled;
use super::{ConstrainedProblem, Curved, EvaluationError, Multipliers, Relation, Slopes, Values};
use nalgebra::{DMatrix, DVector};

/// Newton steps at most.
const STEPS: u64 = 6;
/// Directions up to which second derivatives are worth their simulations.
const MOST: usize = 30;
/// Closer to a bound than this share of the box, a variable stands at it.
const AT_BOUND: f64 = 1e-6;
/// A constraint with a multiplier above this share of the largest is active.
const ACTIVE: f64 = 1e-6;
/// Singular values below this share of the largest are none.
const RANK: f64 = 1e-10;
/// Length of the differences along a direction, in boxes.
const ALONG: f64 = 0.1;

/// What polishing did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Polished {
    /// Newton steps that were kept.
    pub steps: u64,
    /// Hessian products asked for.
    pub products: u64,
    /// Residual before and after.
    pub kkt: (f64, f64),
}

/// A row that holds the design, with what is missing to its limit.
struct Held {
    row: Vec<f64>,
    rest: f64,
    /// Whether the multiplier has a sign.
    one_sided: bool,
    slot: Slot,
}

#[derive(Clone, Copy)]
enum Slot {
    Inequality(usize),
    Equality(usize),
    Linear(usize),
    Lower(usize),
    Upper(usize),
}

/// Improves the end of a search, in place, down to a residual of `tolerance`.
pub fn polish<P: ConstrainedProblem + Curved + ?Sized>(
    problem: &P,
    end: &mut Minimum,
    tolerance: f64,
) -> Result<Polished, EvaluationError> {
    let mut done = Polished { kkt: (end.kkt, end.kkt), ..Polished::default() };
    let Some(mut values) = end.values.clone() else { return Ok(done) };
    let before = end.clone();
    let mut scaled = Scaled::new(problem, &end.x);
    // By what the search found: asking at the image in the unit box would simulate the design again.
    scaled.scale_objective(values.objective);
    values.objective /= scaled.objective_scale;
    let mut x = end.x.clone();
    let mut slopes = scaled.of(problem.slopes(&x)?);
    let mut prices = end.multipliers.clone();
    loop {
        let s = scaled.to_scaled(&x);
        let held = held(&scaled, &s, &values, &slopes, &prices);
        let fitted = fit(&held, &slopes);
        let residual = residual(&held, &fitted, &slopes, &values);
        // A kept step brought the point here: what is known of it belongs to it.
        if residual < end.kkt || done.steps > 0 {
            (end.kkt, end.combined) = (residual, 1);
            end.multipliers = restored(&scaled, &held, &fitted, &values, s.len());
        }
        if residual <= tolerance || done.steps >= STEPS {
            break;
        }
        let free = free_directions(&held, s.len());
        if free.len() > MOST {
            break;
        }
        let mut columns = Vec::new();
        for direction in &free {
            done.products += 1;
            columns.push(product(&scaled, &x, direction, &held, &fitted)?);
        }
        let Some(step) = newton(&held, &free, &columns, &gradient(&slopes, &held, &fitted)) else { break };
        let to: Vec<f64> =
            (0..s.len()).map(|j| (s[j] + step[j]).clamp(scaled.lower[j], scaled.upper[j])).collect();
        let next = scaled.to_true(&to);
        let there = scaled.values(&to);
        end.evaluations += 1;
        let found = there.and_then(|there| Ok((there, scaled.of(problem.slopes(&next)?))));
        end.gradients += 1;
        let (there, new_slopes) = match found {
            Ok(found) => found,
            Err(EvaluationError::Cancelled) => return Err(EvaluationError::Cancelled),
            Err(EvaluationError::Failed(reason)) => {
                end.failures.push(reason);
                break;
            }
        };
        let new_held = self::held(&scaled, &to, &there, &new_slopes, &prices);
        let new_fit = fit(&new_held, &new_slopes);
        let better = self::residual(&new_held, &new_fit, &new_slopes, &there) < residual;
        if !better {
            break;
        }
        done.steps += 1;
        prices = restored(&scaled, &new_held, &new_fit, &there, s.len());
        (x, values, slopes) = (next, there, new_slopes);
        end.x = x.clone();
        end.values = Some(Values { objective: values.objective * scaled.objective_scale, ..values.clone() });
    }
    if end.kkt > before.kkt {
        let (evaluations, gradients) = (end.evaluations, end.gradients);
        *end = Minimum { evaluations, gradients, ..before };
        done.steps = 0;
    }
    done.kkt.1 = end.kkt;
    Ok(done)
}

/// The rows that hold a point: those with a multiplier, and bounds it stands at.
fn held<P: ConstrainedProblem + ?Sized>(
    scaled: &Scaled<'_, P>,
    s: &[f64],
    values: &Values,
    slopes: &Slopes,
    prices: &Multipliers,
) -> Vec<Held> {
    let largest = prices.inequalities.iter().fold(f64::MIN_POSITIVE, |a, m| a.max(m.abs()));
    let mut rows = Vec::new();
    for (k, (row, c)) in slopes.inequalities.iter().zip(&values.inequalities).enumerate() {
        if prices.inequalities.get(k).is_some_and(|m| *m > ACTIVE * largest) {
            let slot = Slot::Inequality(k);
            rows.push(Held { row: row.clone(), rest: -c, one_sided: true, slot });
        }
    }
    for (k, (row, g)) in slopes.equalities.iter().zip(&values.equalities).enumerate() {
        rows.push(Held { row: row.clone(), rest: -g, one_sided: false, slot: Slot::Equality(k) });
    }
    for (k, r) in scaled.linear_from(s).into_iter().enumerate() {
        let equal = r.relation == Relation::Equal;
        if equal || r.bound < AT_BOUND {
            rows.push(Held { row: r.factors, rest: r.bound, one_sided: !equal, slot: Slot::Linear(k) });
        }
    }
    for j in 0..s.len() {
        let unit =
            |sign: f64| -> Vec<f64> { (0..s.len()).map(|k| if k == j { sign } else { 0.0 }).collect() };
        if s[j] - scaled.lower[j] < AT_BOUND {
            let rest = s[j] - scaled.lower[j];
            rows.push(Held { row: unit(-1.0), rest, one_sided: true, slot: Slot::Lower(j) });
        } else if scaled.upper[j] - s[j] < AT_BOUND {
            let rest = scaled.upper[j] - s[j];
            rows.push(Held { row: unit(1.0), rest, one_sided: true, slot: Slot::Upper(j) });
        }
    }
    rows
}

fn matrix(held: &[Held], n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(held.len(), n, |i, j| held[i].row[j])
}

/// Multipliers of least squares.
fn fit(held: &[Held], slopes: &Slopes) -> Vec<f64> {
    if held.is_empty() {
        return Vec::new();
    }
    let transposed = matrix(held, slopes.objective.len()).transpose();
    let target = -DVector::from_column_slice(&slopes.objective);
    let svd = transposed.svd(true, true);
    let largest = svd.singular_values.max();
    svd.solve(&target, RANK * largest).map_or_else(|_| vec![0.0; held.len()], |m| m.iter().copied().collect())
}

/// Gradient of the Lagrangian with the fitted multipliers.
fn gradient(slopes: &Slopes, held: &[Held], fitted: &[f64]) -> DVector<f64> {
    let mut sum = DVector::from_column_slice(&slopes.objective);
    for (h, m) in held.iter().zip(fitted) {
        sum.axpy(*m, &DVector::from_column_slice(&h.row), 1.0);
    }
    sum
}

/// Stationarity, complementarity, signs and violation in one.
fn residual(held: &[Held], fitted: &[f64], slopes: &Slopes, values: &Values) -> f64 {
    let stationarity = gradient(slopes, held, fitted).amax();
    held.iter().zip(fitted).fold(stationarity.max(values.violation()), |a, (h, m)| {
        let wrong = if h.one_sided { (-m).max(0.0) } else { 0.0 };
        a.max((m * h.rest).abs()).max(wrong)
    })
}

/// An orthonormal basis of what the rows leave free.
fn free_directions(held: &[Held], n: usize) -> Vec<DVector<f64>> {
    let rows: Vec<Vec<f64>> = held.iter().map(|h| h.row.clone()).collect();
    super::curvature::free_directions(&rows, n)
}

/// Hessian of the Lagrangian times a direction of the scaled variables.
fn product<P: ConstrainedProblem + Curved + ?Sized>(
    scaled: &Scaled<'_, P>,
    x: &[f64],
    direction: &DVector<f64>,
    held: &[Held],
    fitted: &[f64],
) -> Result<DVector<f64>, EvaluationError> {
    let natural = scaled.direction(direction.as_slice(), ALONG);
    let change = scaled.of(scaled.problem.slopes_along(x, &natural)?);
    let mut sum = DVector::from_column_slice(&change.objective);
    for (h, m) in held.iter().zip(fitted) {
        let row = match h.slot {
            Slot::Inequality(k) => &change.inequalities[k],
            Slot::Equality(k) => &change.equalities[k],
            Slot::Linear(_) | Slot::Lower(_) | Slot::Upper(_) => continue,
        };
        sum.axpy(*m, &DVector::from_column_slice(row), 1.0);
    }
    Ok(sum / ALONG)
}

/// The step: onto the active rows, then along what they leave free.
fn newton(
    held: &[Held],
    free: &[DVector<f64>],
    columns: &[DVector<f64>],
    lagrangian: &DVector<f64>,
) -> Option<DVector<f64>> {
    let n = lagrangian.len();
    let mut step = DVector::zeros(n);
    if !held.is_empty() {
        let rest = DVector::from_iterator(held.len(), held.iter().map(|h| h.rest));
        let svd = matrix(held, n).svd(true, true);
        let largest = svd.singular_values.max();
        step = svd.solve(&rest, RANK * largest).ok()?;
    }
    if free.is_empty() {
        return Some(step);
    }
    // The way onto the rows is short near the solution: its curvature along the free directions counts by symmetry.
    let reduced = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        0.5 * (free[i].dot(&columns[j]) + free[j].dot(&columns[i]))
    });
    let right = DVector::from_fn(free.len(), |i, _| -(free[i].dot(lagrangian) + columns[i].dot(&step)));
    let along = reduced.cholesky()?.solve(&right);
    for (d, v) in free.iter().zip(along.iter()) {
        step.axpy(*v, d, 1.0);
    }
    Some(step)
}

/// Fitted multipliers in their own places, in true units; those of inequalities that do not hold the point are zero.
fn restored<P: ConstrainedProblem + ?Sized>(
    scaled: &Scaled<'_, P>,
    held: &[Held],
    fitted: &[f64],
    values: &Values,
    n: usize,
) -> Multipliers {
    let scale = scaled.objective_scale;
    let mut all = Multipliers {
        inequalities: vec![0.0; values.inequalities.len()],
        equalities: vec![0.0; values.equalities.len()],
        lower: vec![0.0; n],
        upper: vec![0.0; n],
        linear: vec![0.0; scaled.linear.len()],
    };
    for (h, m) in held.iter().zip(fitted) {
        let signed = if h.one_sided { m.max(0.0) } else { *m };
        match h.slot {
            Slot::Inequality(k) => all.inequalities[k] = scale * signed,
            Slot::Equality(k) => all.equalities[k] = scale * signed,
            Slot::Linear(k) => all.linear[k] = signed,
            Slot::Lower(j) => all.lower[j] = scale * signed,
            Slot::Upper(j) => all.upper[j] = scale * signed,
        }
    }
    all.linear = scaled.linear_prices(&all.linear);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::dot;
    use crate::optimise::{Outcome, SearchOptions, SqpOptions, search};

    /// `exp(x) + (y - x^2)^2 + z^4 - z` with `x^2 + y^2 <= 1` and `z <= 1/2`.
    struct Bent;

    impl ConstrainedProblem for Bent {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![-2.0; 3], vec![2.0, 2.0, 0.5])
        }
        fn values(&self, p: &[f64]) -> Result<Values, EvaluationError> {
            let objective = p[0].exp() + (p[1] - p[0] * p[0]).powi(2) + p[2].powi(4) - p[2];
            Ok(Values {
                objective,
                inequalities: vec![p[0].powi(2) + p[1].powi(2) - 1.0],
                equalities: vec![],
            })
        }
        fn slopes(&self, p: &[f64]) -> Result<Slopes, EvaluationError> {
            let v = p[1] - p[0] * p[0];
            Ok(Slopes {
                objective: vec![p[0].exp() - 4.0 * p[0] * v, 2.0 * v, 4.0 * p[2].powi(3) - 1.0],
                inequalities: vec![vec![2.0 * p[0], 2.0 * p[1], 0.0]],
                equalities: vec![],
            })
        }
    }

    impl Curved for Bent {
        fn slopes_along(&self, p: &[f64], d: &[f64]) -> Result<Slopes, EvaluationError> {
            let xx = p[0].exp() - 4.0 * p[1] + 12.0 * p[0] * p[0];
            let rows = [[xx, -4.0 * p[0], 0.0], [-4.0 * p[0], 2.0, 0.0], [0.0, 0.0, 12.0 * p[2] * p[2]]];
            let objective = rows.iter().map(|row| dot(row, d)).collect();
            let inequalities = vec![vec![2.0 * d[0], 2.0 * d[1], 0.0]];
            Ok(Slopes { objective, inequalities, equalities: vec![] })
        }
    }

    #[test]
    fn a_rough_optimum_gets_all_its_digits_in_a_few_steps() {
        let rough = SearchOptions {
            settings: SqpOptions { tolerance: 2e-2, ..SqpOptions::default() },
            ..SearchOptions::default()
        };
        let mut end = search(&Bent, &[1.0, 0.5, 0.0], &rough).unwrap();
        assert_eq!(end.outcome, Outcome::Converged);
        let before = end.kkt;
        let polished = polish(&Bent, &mut end, 1e-12).unwrap();
        assert!(before > 1e-5 && end.kkt < 1e-12, "{polished:?}");
        assert!(polished.steps <= 4 && polished.products <= 5, "{polished:?}");
        // The bound on z holds, and its price is the slope there.
        assert_eq!(end.x[2], 0.5);
        assert!((end.multipliers.upper[2] - 2.5 * 0.5).abs() < 1e-12);
        let exact = search(&Bent, &[1.0, 0.5, 0.0], &SearchOptions::default()).unwrap();
        assert!((end.x[0] - exact.x[0]).abs() < 1e-5 && (end.x[1] - exact.x[1]).abs() < 1e-5);
    }
}

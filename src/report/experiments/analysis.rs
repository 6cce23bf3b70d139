//! What follows from the rows: straight fits, and what refinement tells.
//!
//! ```text
//! y = a + sum_j b_j u_j                     u_j: factor between its lowest (0) and highest (1) level; least squares
//! p = ln((y1 - y2) / (y2 - y3)) / ln r      observed order of three levels, each finer by r
//! y0 = y3 + (y3 - y2) / (r^p - 1)           Richardson's extrapolation
//! ```

use super::{EffectReport, ExperimentRun, FactorReport, RefinementReport, ResponseReport};
use nalgebra::{DMatrix, DVector};

/// Orders that discretisations like these have; beyond them the levels are too coarse to show one.
const ORDERS: std::ops::RangeInclusive<f64> = 0.5..=3.0;

/// How a factor enters the fit: a number by its share of the range, words by one column for each level but the first.
enum Column {
    Number { factor: usize, low: f64, high: f64 },
    Level { factor: usize, text: String },
}

impl Column {
    fn all(factors: usize, runs: &[ExperimentRun]) -> Vec<Self> {
        let mut all = Vec::new();
        for factor in 0..factors {
            if let Some((low, high)) = range(runs, factor) {
                all.push(Self::Number { factor, low, high });
                continue;
            }
            if runs.iter().all(|r| r.numbers[factor].is_some()) {
                continue;
            }
            let mut levels: Vec<&String> = Vec::new();
            runs.iter().for_each(|r| {
                if !levels.contains(&&r.levels[factor]) {
                    levels.push(&r.levels[factor]);
                }
            });
            all.extend(levels.into_iter().skip(1).map(|text| Self::Level { factor, text: text.clone() }));
        }
        all
    }

    fn factor(&self) -> usize {
        match self {
            Self::Number { factor, .. } | Self::Level { factor, .. } => *factor,
        }
    }

    fn of(&self, run: &ExperimentRun) -> f64 {
        match self {
            Self::Number { factor, low, high } => {
                run.numbers[*factor].map_or(0.0, |v| (v - low) / (high - low))
            }
            Self::Level { factor, text } => f64::from(u8::from(run.levels[*factor] == *text)),
        }
    }
}

/// Straight fits through all runs with numbers, one per response that varies; of words the largest difference of two levels.
pub fn effects(
    factors: &[FactorReport],
    responses: &[ResponseReport],
    runs: &[ExperimentRun],
) -> Vec<EffectReport> {
    let columns = Column::all(factors.len(), runs);
    if columns.is_empty() {
        return Vec::new();
    }
    let fit = |(k, response): (usize, &ResponseReport)| {
        let known: Vec<(&ExperimentRun, f64)> =
            runs.iter().filter_map(|r| Some((r, (*r.responses.get(k)?)?))).collect();
        if known.len() < columns.len() + 2 {
            return None;
        }
        let rows = DMatrix::from_fn(known.len(), columns.len() + 1, |i, c| match c {
            0 => 1.0,
            c => columns[c - 1].of(known[i].0),
        });
        let y = DVector::from_iterator(known.len(), known.iter().map(|(_, y)| *y));
        let size = y.amax();
        let found = rows.clone().svd(true, true).solve(&y, 1e-12).ok()?;
        let mean = y.mean();
        let spread = y.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        let left = (&rows * &found - &y).norm_squared();
        let varies = size > super::TRACE && spread > 1e-24 * y.norm_squared();
        varies.then(|| EffectReport {
            response: response.key.clone(),
            explained: (1.0 - left / spread).max(0.0),
            changes: (0..factors.len()).map(|j| change(&columns, &found, j, size)).collect(),
        })
    };
    responses.iter().enumerate().filter_map(fit).collect()
}

/// What a factor does by the fit; rounding is nothing.
fn change(columns: &[Column], found: &DVector<f64>, factor: usize, size: f64) -> Option<f64> {
    let own: Vec<(&Column, f64)> = columns.iter().zip(found.iter().skip(1).copied()).collect();
    let own = || own.iter().filter(|(c, _)| c.factor() == factor);
    let value = match own().next()?.0 {
        Column::Number { .. } => own().next()?.1,
        Column::Level { .. } => {
            let (low, high) = own().fold((0.0f64, 0.0f64), |(l, h), (_, v)| (l.min(*v), h.max(*v)));
            high - low
        }
    };
    Some(if value.abs() < 1e-9 * size { 0.0 } else { value })
}

/// Lowest and highest level of a factor of numbers that varies.
fn range(runs: &[ExperimentRun], j: usize) -> Option<(f64, f64)> {
    let numbers: Option<Vec<f64>> = runs.iter().map(|r| r.numbers[j]).collect();
    let (low, high) = numbers?
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    (high > low).then_some((low, high))
}

/// What refining factors tell of every response, for every combination of the other factors.
pub fn refinements(
    factors: &[FactorReport],
    responses: &[ResponseReport],
    runs: &[ExperimentRun],
) -> Vec<RefinementReport> {
    let mut all = Vec::new();
    for (j, factor) in factors.iter().enumerate() {
        let Some(ratio) = factor.refinement_ratio else { continue };
        let others = |run: &ExperimentRun| -> Vec<String> {
            let kept = run.levels.iter().enumerate().filter(|(i, _)| *i != j);
            kept.map(|(_, text)| text.clone()).collect()
        };
        let mut combinations: Vec<Vec<String>> = Vec::new();
        for run in runs {
            let these = others(run);
            if !combinations.contains(&these) {
                combinations.push(these);
            }
        }
        for these in combinations {
            // A grid's runs stand in the order of the levels.
            let line: Vec<&ExperimentRun> = runs.iter().filter(|r| others(r) == these).collect();
            for (k, response) in responses.iter().enumerate() {
                let values: Option<Vec<f64>> = line.iter().map(|r| r.responses.get(k).copied()?).collect();
                let Some(values) = values.filter(|v| v.len() >= 3) else { continue };
                let steady =
                    values.windows(2).all(|w| w[0] == w[1]) || values.iter().all(|v| v.abs() < super::TRACE);
                if !steady {
                    let (factor, response) = (factor.name.clone(), response.key.clone());
                    all.push(refined(factor, response, these.clone(), values, ratio));
                }
            }
        }
    }
    all
}

fn refined(
    factor: String,
    response: String,
    others: Vec<String>,
    values: Vec<f64>,
    ratio: f64,
) -> RefinementReport {
    let [a, b, c] = [values[values.len() - 3], values[values.len() - 2], values[values.len() - 1]];
    let order = Some((a - b) / (b - c)).filter(|q| *q > 0.0).map(|q| q.ln() / ratio.ln());
    let order = order.filter(|p| ORDERS.contains(p));
    let extrapolated = order.map(|p| c + (c - b) / (ratio.powf(p) - 1.0));
    let error_percent = extrapolated.filter(|e| *e != 0.0).map(|e| 100.0 * (c - e).abs() / e.abs());
    RefinementReport { factor, response, others, values, order, extrapolated, error_percent }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn response(key: &str) -> ResponseReport {
        ResponseReport { key: key.to_owned(), title: key.to_owned(), unit: "1".to_owned() }
    }

    fn factor(ratio: Option<f64>) -> FactorReport {
        FactorReport { name: "x".to_owned(), unit: String::new(), refinement_ratio: ratio }
    }

    fn run(number: usize, levels: &[f64], value: f64) -> ExperimentRun {
        ExperimentRun {
            number,
            levels: levels.iter().map(f64::to_string).collect(),
            numbers: levels.iter().map(|v| Some(*v)).collect(),
            study_hash: String::new(),
            status: None,
            failure: None,
            feasible: None,
            responses: vec![Some(value)],
        }
    }

    #[test]
    fn a_plane_is_found_exactly_and_a_constant_has_no_effects() {
        let points = [[1.0, 5.0], [3.0, 5.0], [1.0, 9.0], [3.0, 9.0], [2.0, 6.0]];
        let plane = |p: &[f64; 2]| 4.0 + 2.0 * p[0] - p[1];
        let runs: Vec<_> = points.iter().enumerate().map(|(k, p)| run(k + 1, p, plane(p))).collect();
        let found = effects(&[factor(None), factor(None)], &[response("y")], &runs);
        let changes: Vec<f64> = found[0].changes.iter().map(|c| c.unwrap()).collect();
        assert!((changes[0] - 4.0).abs() < 1e-12 && (changes[1] + 4.0).abs() < 1e-12, "{changes:?}");
        assert!((found[0].explained - 1.0).abs() < 1e-12);
        // Words: the largest difference of two levels.
        let mut words = runs.clone();
        for (run, (level, shift)) in
            words.iter_mut().zip([("a", 0.0), ("b", 5.0), ("c", -2.0), ("a", 0.0), ("b", 5.0)])
        {
            (run.levels[1], run.numbers[1]) = (level.to_owned(), None);
            run.responses = vec![Some(2.0 * run.numbers[0].unwrap() + shift)];
        }
        words.push(ExperimentRun { numbers: vec![Some(9.0), None], ..words[2].clone() });
        words[5].responses = vec![Some(16.0)];
        let found = effects(&[factor(None), factor(None)], &[response("y")], &words);
        assert!((found[0].changes[0].unwrap() - 16.0).abs() < 1e-9, "{found:?}");
        assert!((found[0].changes[1].unwrap() - 7.0).abs() < 1e-9, "{found:?}");
        let same: Vec<_> = points.iter().enumerate().map(|(k, p)| run(k + 1, p, 7.0)).collect();
        assert!(effects(&[factor(None), factor(None)], &[response("y")], &same).is_empty());
    }

    #[test]
    fn order_and_limit_of_a_refinement_are_found() {
        let at = |h: f64| 10.0 + 3.0 * h * h;
        let steps = [1.0, 0.5, 0.25, 0.125];
        let runs: Vec<_> = steps.iter().enumerate().map(|(k, h)| run(k + 1, &[1.0 / h], at(*h))).collect();
        let found = refinements(&[factor(Some(2.0))], &[response("y")], &runs);
        assert!((found[0].order.unwrap() - 2.0).abs() < 1e-9);
        assert!((found[0].extrapolated.unwrap() - 10.0).abs() < 1e-9);
        // Values that swing say nothing.
        let runs: Vec<_> = [1.0, 2.0, 1.0].iter().enumerate().map(|(k, v)| run(k, &[k as f64], *v)).collect();
        assert_eq!(refinements(&[factor(Some(2.0))], &[response("y")], &runs)[0].order, None);
    }
}

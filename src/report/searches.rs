//! Several searches side by side: from different starts, by different methods.

use super::csv_file::written;
use super::word;
use crate::gradient::EngineName;
use crate::optimise::{Method, Outcome};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Searches from different starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartsReport {
    /// Seed of the Latin hypercube all starts but the first belong to.
    pub seed: u64,
    /// Names of the parameters, in the order of starts and designs.
    pub parameters: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// One entry per start; the first is that of the study.
    pub runs: Vec<StartRun>,
    /// Median of the designs simulated by the searches that converged.
    pub median_simulations: Option<u64>,
    /// Whether all searches that converged ended with the same loss (within 1e-4), be it at different designs.
    pub same_loss: bool,
    /// Distinct ends, the best first.
    pub optima: Vec<LocalOptimum>,
}

/// A search from one start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartRun {
    /// The start.
    pub start: Vec<f64>,
    /// How it ended.
    pub status: Outcome,
    /// Objective at its best design, W.
    pub loss_w: Option<f64>,
    /// Largest relative violation of a limit there.
    pub violation: Option<f64>,
    /// Scaled KKT residual there.
    pub kkt: Option<f64>,
    /// Designs simulated.
    pub simulations: u64,
    /// Designs differentiated.
    pub gradient_calls: u64,
    /// Which of the optima it found, counted from 1; none if it did not converge.
    pub optimum: Option<usize>,
}

/// An end that several searches may share: losses within 1e-4, designs within a hundredth of the box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LocalOptimum {
    /// Objective, W.
    pub loss_w: f64,
    /// The design.
    pub design: Vec<f64>,
    /// Searches that ended here.
    pub found: u64,
}

/// A search by one method with one gradient engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RivalRun {
    /// Method.
    pub method: Method,
    /// Gradient engine; COBYLA only judges its end with it.
    pub engine: EngineName,
    /// How it ended.
    pub status: Outcome,
    /// Objective at its best design, W.
    pub loss_w: Option<f64>,
    /// Largest relative violation of a limit there.
    pub violation: Option<f64>,
    /// Scaled KKT residual there.
    pub kkt: Option<f64>,
    /// Designs simulated.
    pub simulations: f64,
    /// Designs differentiated.
    pub gradient_calls: u64,
    /// Work of the gradients in units of a simulation, by factorisations.
    pub gradient_simulations: f64,
}

/// A choice and the option that was taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChoiceReport {
    /// What was chosen.
    pub name: String,
    /// The option.
    pub taken: String,
}

/// Choices from lists, every combination searched.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChoicesReport {
    /// What was taken.
    pub taken: Vec<ChoiceReport>,
    /// Names of the parameters, in the order of the designs.
    pub parameters: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// One entry per combination.
    pub runs: Vec<ChoiceRun>,
}

/// The search with one combination of options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChoiceRun {
    /// Option of each choice.
    pub options: Vec<String>,
    /// How it ended.
    pub status: Outcome,
    /// Objective at its best design, W.
    pub loss_w: Option<f64>,
    /// Largest relative violation of a limit there.
    pub violation: Option<f64>,
    /// Designs simulated.
    pub simulations: u64,
    /// The design; empty if the start could not be simulated.
    pub design: Vec<f64>,
}

/// A robust design: what scatters, by first order and as drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobustReport {
    /// Standard deviations in each margin.
    pub sigmas: f64,
    /// What scatters.
    pub tolerances: Vec<ToleranceReport>,
    /// Objective of the design as drawn on paper, W.
    pub nominal_w: f64,
    /// Its standard deviation by first order, W.
    pub deviation_w: f64,
    /// What is minimised: nominal value and margin, W.
    pub robust_w: f64,
    /// Bearings drawn around the design.
    pub samples: u64,
    /// How many of them could not be simulated.
    pub failed: u64,
    /// Mean objective of those drawn, W.
    pub sampled_mean_w: Option<f64>,
    /// Their standard deviation, W.
    pub sampled_deviation_w: Option<f64>,
    /// Share of those drawn with an objective above the one that is minimised, per cent.
    pub above_percent: Option<f64>,
    /// The limits.
    pub limits: Vec<SampledLimit>,
    /// Whether what was drawn bears out the first order, in words; none without samples.
    pub verdict: Option<String>,
}

/// A quantity that scatters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToleranceReport {
    /// Its name.
    pub parameter: String,
    /// Its value at the design.
    pub nominal: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Unit of the value.
    pub unit: String,
    /// Unit of the deviation.
    pub deviation_unit: String,
}

/// How a limited quantity scatters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SampledLimit {
    /// Limited quantity.
    pub quantity: String,
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    /// Unit of the deviations.
    pub unit: String,
    /// Standard deviation by first order.
    pub deviation: f64,
    /// Standard deviation of those drawn.
    pub sampled_deviation: Option<f64>,
    /// Share of those drawn that break the limit, per cent.
    pub broken_percent: Option<f64>,
}

/// A limit on a sum of parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LinearReport {
    /// The sum in words.
    pub sum: String,
    /// "at least", "at most" or "equals".
    pub sense: String,
    /// Value at the design.
    pub value: f64,
    /// Limit.
    pub limit: f64,
    /// Unit of both.
    pub unit: String,
    /// Whether it holds the design back.
    pub active: bool,
    /// Whether it is kept.
    pub met: bool,
    /// What one unit more of room would save, W; none where no optimum was reached.
    pub price_w_per_unit: Option<f64>,
}

/// An operating point where the worst case counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorstCaseReport {
    /// Its name.
    pub operating_point: String,
    /// Loss times weight at the start design, W.
    pub start_w: Option<f64>,
    /// The same at the design found, W.
    pub optimum_w: f64,
    /// Its share in the decision; those of all add up to one.
    pub share: f64,
}

/// The least loss over a limit on another quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ParetoReport {
    /// The quantity that is limited.
    pub quantity: String,
    /// The bearing whose quantity it is; none for all.
    pub bearing: Option<String>,
    /// "at least" or "at most".
    pub sense: String,
    /// Unit of the limits.
    pub unit: String,
    /// Names of the parameters, in the order of the designs.
    pub parameters: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// One entry per limit, from the easiest to the hardest.
    pub points: Vec<ParetoPoint>,
}

/// One point of a front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ParetoPoint {
    /// The limit.
    pub limit: f64,
    /// How the search ended.
    pub status: Outcome,
    /// Least loss found, W.
    pub loss_w: Option<f64>,
    /// Largest relative violation of a limit there.
    pub violation: Option<f64>,
    /// What one unit more of room would save, W per unit: the slope of the front.
    pub price_w_per_unit: Option<f64>,
    /// Designs asked for.
    pub simulations: u64,
    /// The design.
    pub design: Vec<f64>,
}

/// A front as CSV: limit, loss, price, status and the design.
pub fn pareto_csv(front: &ParetoReport) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut head = vec![format!("{}_{}", front.quantity.replace('-', "_"), front.unit), "loss_w".into()];
    head.extend([format!("price_w_per_{}", front.unit), "status".into()]);
    head.extend(front.parameters.iter().zip(&front.units).map(|(p, u)| format!("{p} [{u}]")));
    writer.write_record(&head)?;
    let number = |v: Option<f64>| v.map_or_else(String::new, |v| v.to_string());
    for p in &front.points {
        let mut row = vec![p.limit.to_string(), number(p.loss_w), number(p.price_w_per_unit)];
        row.push(word(p.status));
        row.extend(p.design.iter().map(f64::to_string));
        writer.write_record(&row)?;
    }
    written(writer)
}

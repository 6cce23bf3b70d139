//! Several searches side by side: from different starts, by different methods.

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
    /// Wall time, s.
    pub seconds: f64,
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
    /// One entry per limit, rising.
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
        let status = serde_json::to_value(p.status).ok().and_then(|v| v.as_str().map(str::to_owned));
        let mut row = vec![p.limit.to_string(), number(p.loss_w), number(p.price_w_per_unit)];
        row.push(status.unwrap_or_default());
        row.extend(p.design.iter().map(f64::to_string));
        writer.write_record(&row)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

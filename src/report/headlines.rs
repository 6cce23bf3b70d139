//! The answer in sentences for everything that is no design: tables, engines side by side, experiments.

use super::{Characteristic, CharacteristicTable, Comparison, Experiments, short};
use crate::gradient::{EngineName, Finding};

/// What a table says: how near it is to its reference, where the torque is least.
pub fn characteristic_headline(found: &Characteristic) -> Vec<String> {
    let mut all = Vec::new();
    for table in &found.tables {
        let near: Vec<String> = table
            .columns
            .iter()
            .filter_map(|c| {
                let unit = if c.unit == "deg" { "deg" } else { "%" };
                Some(format!("{} within {} {unit}", c.title, short(c.largest_difference?)))
            })
            .collect();
        if !near.is_empty() {
            all.push(format!("Of {}, against the reference: {}.", table.name, near.join(", ")));
        }
    }
    all.extend(found.tables.first().and_then(least_torque));
    all
}

/// Where a Stribeck curve has its minimum, and how much of it is contact.
fn least_torque(table: &CharacteristicTable) -> Option<String> {
    let column = |key: &str| table.columns.iter().find(|c| c.key == key);
    let torque = column("torque_nm")?;
    let rows = (0..torque.values.len()).filter_map(|n| Some((n, torque.values[n]?)));
    let (n, least) = rows.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let at = table.varied.values[n]?;
    let contact = column("contact_torque_nm").and_then(|c| c.values[n]);
    let share = contact.filter(|_| least > 0.0).map_or_else(String::new, |c| {
        format!("; {} % of it is contact", short((1000.0 * c / least).round() / 10.0))
    });
    Some(format!(
        "The friction torque of {} is least at {} {}: {} N m{share}.",
        table.name,
        short(at),
        table.varied.unit,
        short(least)
    ))
}

/// How exact the gradients are, and what they cost.
pub fn comparison_headline(found: &Comparison) -> Vec<String> {
    let mut all = Vec::new();
    for case in &found.cases {
        let quantities = &case.proof.quantities;
        let count = |f: Finding| quantities.iter().filter(|q| q.finding == f).count();
        let mismatch = quantities.iter().map(|q| q.mismatch).fold(0.0, f64::max);
        let best =
            |q: &super::ProvenQuantity| q.best.iter().find(|b| b.engine == EngineName::Cen).map(|b| b.error);
        let cen = quantities.iter().filter_map(best).reduce(f64::max);
        let cen = cen.map_or_else(String::new, |e| format!(", central differences to {e:.0e} at their best"));
        all.push(format!(
            "{}: {} of {} gradients are exact; TRA meets ADJ to {mismatch:.0e}{cen}.",
            case.name(),
            count(Finding::Exact),
            quantities.len()
        ));
        if let Some((s, adj)) = case.speed_ups.last().and_then(|s| Some((s, s.adj?))) {
            all.push(format!(
                "For {} parameters central differences take {} times the factorisations of ADJ.",
                s.parameters,
                short(adj)
            ));
        }
    }
    all
}

/// The best run, and what refinement leaves of the loss.
pub fn experiments_headline(found: &Experiments) -> Vec<String> {
    let mut all = Vec::new();
    if let Some(run) = found.best.and_then(|n| found.runs.get(n - 1)) {
        let level = |(f, text): (&super::FactorReport, &String)| match f.unit.as_str() {
            "" => format!("{} {text}", f.name),
            unit => format!("{} {text} {unit}", f.name),
        };
        let levels: Vec<String> = found.factors.iter().zip(&run.levels).map(level).collect();
        let loss = run.responses.first().copied().flatten().map_or_else(String::new, short);
        all.push(format!(
            "The least loss with all limits kept is {loss} W, of run {} ({}).",
            run.number,
            levels.join(", ")
        ));
    } else if found.runs.iter().any(|r| r.feasible == Some(false)) {
        all.push("No run keeps all limits.".to_owned());
    }
    let loss = found.responses.first().map(|r| r.key.as_str());
    for factor in found.factors.iter().filter(|f| f.refinement_ratio.is_some()) {
        let own =
            found.refinements.iter().rfind(|g| g.factor == factor.name && Some(g.response.as_str()) == loss);
        let Some(g) = own else { continue };
        all.push(match (g.order, g.error_percent) {
            (Some(order), Some(error)) => format!(
                "Over {} the loss converges with order {}; the finest level is off by {} %.",
                factor.name,
                short((10.0 * order).round() / 10.0),
                short(error)
            ),
            _ => format!("Over {} the loss shows no order yet: the levels are too coarse.", factor.name),
        });
    }
    all
}

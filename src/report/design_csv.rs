//! What a report of a design says in tables, as CSV: `design.csv`, `limits.csv`, `gradient.csv`, `history.csv`.

use super::csv_file::{maybe, number, table};
use super::{AtBound, Report};

type Table = Result<String, csv::Error>;

/// All of them by name; those without rows are left out.
pub fn design_csv(report: &Report) -> Result<Vec<(&'static str, String)>, csv::Error> {
    let mut all = vec![("design.csv", design(report)?)];
    if !report.constraints.is_empty() {
        all.push(("limits.csv", limits(report)?));
    }
    if report.gradient.is_some() {
        all.push(("gradient.csv", gradient(report)?));
    }
    if !report.history.is_empty() {
        all.push(("history.csv", history(report)?));
    }
    Ok(all)
}

fn design(report: &Report) -> Table {
    let head = [
        "parameter",
        "unit",
        "start",
        "design",
        "lower",
        "upper",
        "at_bound",
        "bound_price_w_per_unit",
        "effect_w_per_percent",
    ];
    let rows = report.design.iter().map(|d| {
        let bound = match d.at_bound {
            AtBound::No => "",
            AtBound::Lower => "lower",
            AtBound::Upper => "upper",
        };
        let mut row = vec![d.name.clone(), d.unit.clone()];
        row.extend([d.start, d.value, d.lower, d.upper].map(number));
        row.push(bound.to_owned());
        row.extend([d.bound_price_w_per_unit, d.effect_w_per_percent].map(maybe));
        row
    });
    table(&head, rows)
}

fn limits(report: &Report) -> Table {
    let head = [
        "quantity",
        "bearing",
        "operating_point",
        "unit",
        "sense",
        "limit",
        "value",
        "exact_value",
        "margin",
        "active",
        "met",
        "price_w_per_unit",
    ];
    let rows = report.constraints.iter().map(|c| {
        let words = [&c.quantity, &c.bearing, &c.operating_point, &c.unit, &c.sense];
        let mut row: Vec<String> = words.into_iter().cloned().collect();
        row.push(number(c.limit));
        row.extend([c.value, c.exact_value, c.margin].map(maybe));
        row.extend([c.active.to_string(), c.met.to_string(), maybe(c.price_w_per_unit)]);
        row
    });
    table(&head, rows)
}

fn gradient(report: &Report) -> Table {
    let head = ["quantity", "bearing", "operating_point", "parameter", "derivative", "unit"];
    let rows = report.gradient.iter().flat_map(|g| &g.rows).flat_map(|g| {
        let each = g.parameters.iter().zip(&g.values).zip(&g.units);
        each.map(|((parameter, value), unit)| {
            vec![
                g.quantity.clone(),
                g.bearing.clone(),
                g.operating_point.clone(),
                parameter.clone(),
                number(*value),
                unit.clone(),
            ]
        })
    });
    table(&head, rows)
}

fn history(report: &Report) -> Table {
    let head = ["iteration", "objective_w", "violation", "kkt", "step", "simulations"];
    let rows = report.history.iter().map(|h| {
        let mut row = vec![h.iteration.to_string()];
        row.extend([h.objective_w, h.violation, h.kkt, h.step].map(number));
        row.push(h.simulations.to_string());
        row
    });
    table(&head, rows)
}

//! Short tables for the terminal.

use super::design_tables::design_tables;
use crate::optimise::Outcome;
use crate::report::{AtBound, Characteristic, CharacteristicColumn, Report, short, titled};
use crate::study::{EngineComparison, EngineRow};
use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};
use owo_colors::OwoColorize;

pub(super) fn table(head: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─')));
    table.set_header(head.to_vec());
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

pub(super) fn maybe(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), short)
}

/// Design, limits and loss of a run.
pub(super) fn summary(report: &Report, colour: bool) -> String {
    let status = word(report.outcome.status);
    let shown = match (colour, report.outcome.status) {
        (true, Outcome::Converged) => status.green().bold().to_string(),
        (true, _) => status.red().bold().to_string(),
        (false, _) => status,
    };
    let mut text = format!("{}\n{shown}: {}\n\n", report.title, report.outcome.advice);
    for reason in &report.outcome.refused {
        text += &format!("refused: {reason}\n");
    }
    let mut design = table(&["parameter", "start", "design", "unit", "lower", "upper", "at bound"]);
    for d in &report.design {
        let bound = match d.at_bound {
            AtBound::No => "",
            AtBound::Lower => "lower",
            AtBound::Upper => "upper",
        };
        design.add_row([
            d.name.clone(),
            short(d.start),
            short(d.value),
            d.unit.clone(),
            short(d.lower),
            short(d.upper),
            bound.to_owned(),
        ]);
    }
    text += &format!("{design}\n\n");
    if !report.constraints.is_empty() {
        text += &format!("{}\n\n", limits(report));
    }
    text += &design_tables(report);
    if report.outcome.status == Outcome::Simulated {
        report.answer.iter().for_each(|line| text += &format!("{line}\n"));
    } else if let (Some(start), Some(optimum)) = (&report.objective.start, &report.objective.optimum) {
        text += &format!(
            "{}: {} W at the start, {} W at the design{}\n",
            if report.objective.worst_case.is_empty() {
                "mean friction loss"
            } else {
                "largest loss x weight"
            },
            short(start.total_w),
            short(optimum.total_w),
            saving(report)
        );
    }
    text += &format!(
        "KKT residual {}, {} cycles simulated, {} gradient calls, {} s\n",
        report.kkt.residual.map_or_else(|| "-".to_owned(), |r| format!("{r:.1e}")),
        report.cost.total.simulations,
        report.cost.gradient_calls,
        short(report.timing.seconds)
    );
    if let Some(steps) = report.kkt.polish_steps {
        text += &format!("polished by {steps} Newton step{}\n", if steps == 1 { "" } else { "s" });
    }
    if report.kkt.combined > 1 {
        text += &format!(
            "the optimum lies on a kink: the residual combines {} gradients met there\n",
            report.kkt.combined
        );
    }
    if let Some(verdict) = &report.kkt.verdict {
        text += &format!("second order: {verdict}\n");
    }
    if let Some(starts) = &report.starts {
        let converged = starts.runs.iter().filter(|r| r.optimum.is_some()).count();
        let median = starts
            .median_simulations
            .map_or_else(String::new, |m| format!(", {m} simulations in the median"));
        text += &format!("{} starts, {converged} converged{median}\n", starts.runs.len());
        let flat = starts.same_loss && starts.optima.len() > 1;
        if let (true, Some(best)) = (flat, starts.optima.first()) {
            let (loss, designs) = (short(best.loss_w), starts.optima.len());
            text += &format!(
                "all at {loss} W within 1e-4, at {designs} designs: the loss is flat between them\n"
            );
        }
        for (k, o) in starts.optima.iter().enumerate().filter(|_| !flat) {
            let margin = if report.robust.is_some() { " with margin" } else { "" };
            text += &format!("optimum {}: {} W{margin}, found by {}\n", k + 1, short(o.loss_w), o.found);
        }
    }
    if let Some(front) = &report.pareto {
        let limit = format!("{} {} [{}]", front.quantity, front.sense, front.unit);
        let mut rows = table(&[&limit, "loss [W]", "price [W/unit]", "outcome", "simulations"]);
        for p in &front.points {
            let status = word(p.status);
            let (loss, price) = (maybe(p.loss_w), maybe(p.price_w_per_unit));
            rows.add_row([short(p.limit), loss, price, status, p.simulations.to_string()]);
        }
        text += &format!("\n{rows}\n");
    }
    if !report.rivals.is_empty() {
        text += &format!("\n{}\n", rivals(report));
    }
    text
}

/// The saving in words; what a start that breaks its limits loses is no measure.
fn saving(report: &Report) -> String {
    let broken = report.objective.start_violation.filter(|v| *v > 1e-6);
    let percent = report.objective.saving_percent;
    match (percent, broken) {
        (Some(s), None) if s >= 0.0 => format!(", {} % saved", short(s)),
        (Some(s), None) => format!(", {} % more", short(-s)),
        (Some(s), Some(v)) => {
            let change =
                if s >= 0.0 { format!("{} % less", short(s)) } else { format!("{} % more", short(-s)) };
            format!(", {change} than a start that breaks its limits by {} %", short(100.0 * v))
        }
        (None, _) => String::new(),
    }
}

/// A word of the report's format as one reads it.
pub(super) fn word(of: impl serde::Serialize) -> String {
    crate::report::word(of).replace('-', " ")
}

fn rivals(report: &Report) -> Table {
    let mut rivals = table(&[
        "method",
        "gradient",
        "outcome",
        "loss [W]",
        "violation",
        "KKT",
        "simulations",
        "gradients",
        "as simulations",
        "time [s]",
    ]);
    for (k, r) in report.rivals.iter().enumerate() {
        let small = |v: Option<f64>| v.map_or_else(|| "-".to_owned(), |v| format!("{v:.1e}"));
        rivals.add_row([
            r.method.words().to_owned(),
            if r.method == crate::optimise::Method::Cobyla {
                "none".to_owned()
            } else {
                r.engine.as_str().to_owned()
            },
            word(r.status),
            maybe(r.loss_w),
            small(r.violation),
            small(r.kkt),
            short(r.simulations),
            r.gradient_calls.to_string(),
            short(r.gradient_simulations),
            maybe(report.timing.rivals_s.get(k).copied()),
        ]);
    }
    rivals
}

fn limits(report: &Report) -> Table {
    let margins = report.robust.is_some();
    let mut head = vec!["limit", "bearing, point", "value", "limit", "unit", "state", "price [W/unit]"];
    if margins {
        head.insert(4, "margin");
    }
    let mut limits = table(&head);
    for c in &report.constraints {
        let state = match (c.met, c.active) {
            _ if c.value.is_none() => "not known",
            (false, _) => "violated",
            (true, true) => "active",
            (true, false) => "",
        };
        let mut row = vec![
            c.quantity.clone(),
            format!("{}, {}", c.bearing, c.operating_point),
            maybe(c.value),
            format!("{} {}", c.sense, short(c.limit)),
            c.unit.clone(),
            state.to_owned(),
            c.price_w_per_unit.filter(|_| c.active).map(short).unwrap_or_default(),
        ];
        if margins {
            row.insert(4, maybe(c.margin));
        }
        limits.add_row(row);
    }
    limits
}

/// The tables of a characteristic, the reference beside what was found.
pub(super) fn characteristic(found: &Characteristic) -> String {
    let mut text = format!("{}\n", found.title);
    for reason in &found.failures {
        text += &format!("missing: {reason}\n");
    }
    for t in &found.tables {
        let unit = |c: &CharacteristicColumn| titled(&c.title, &c.unit);
        let mut head = vec![unit(&t.varied)];
        for c in &t.columns {
            head.push(unit(c));
            if !c.reference.is_empty() {
                head.push("reference".to_owned());
            }
        }
        let mut rows = table(&head.iter().map(String::as_str).collect::<Vec<_>>());
        for n in 0..t.varied.values.len() {
            let mut row = vec![maybe(t.varied.values[n])];
            for c in &t.columns {
                row.push(maybe(c.values[n]));
                if !c.reference.is_empty() {
                    row.push(maybe(c.reference[n]));
                }
            }
            rows.add_row(row);
        }
        text += &format!("\n{}\n{rows}\n", t.name);
        for c in t.columns.iter().filter(|c| c.largest_difference.is_some()) {
            let unit = if c.unit == "deg" { "deg" } else { "%" };
            text += &format!(
                "{}: largest difference from the reference {} {unit}, {} % of the largest reference value\n",
                c.title,
                maybe(c.largest_difference),
                maybe(c.difference_of_maximum_percent),
            );
        }
    }
    text
}

/// The gradient engines side by side.
pub(super) fn engines(comparisons: &[EngineComparison]) -> String {
    let mut text = String::new();
    for c in comparisons {
        text += &format!("{}, {}\n\n", c.bearing, c.operating_point);
        for (k, quantity) in c.quantities.iter().enumerate() {
            let mut head = vec!["engine".to_owned(), "perturbation".to_owned()];
            head.extend(c.parameters.iter().zip(&c.units[k]).map(|(p, u)| format!("{p} [{u}]")));
            head.push("error against ADJ".to_owned());
            let mut values = table(&head.iter().map(String::as_str).collect::<Vec<_>>());
            for row in &c.rows {
                let mut line = vec![row.engine.as_str().to_owned(), perturbation(row)];
                match &row.failure {
                    Some(reason) => line.push(reason.clone()),
                    None => {
                        line.extend(row.values[k].iter().map(|v| format!("{v:.6e}")));
                        line.push(format!("{:.1e}", row.error[k]));
                    }
                }
                values.add_row(line);
            }
            text += &format!("d {quantity}\n{values}\n\n");
        }
        let mut cost = table(&[
            "engine",
            "perturbation",
            "cycles",
            "steps",
            "factorisations",
            "solves",
            "time / simulation",
        ]);
        for row in &c.rows {
            cost.add_row([
                row.engine.as_str().to_owned(),
                perturbation(row),
                short(row.sweeps),
                row.cost.steps.to_string(),
                row.cost.factorisations.to_string(),
                row.cost.solves.to_string(),
                short(row.time_ratio),
            ]);
        }
        text += &format!("cost of all quantities together\n{cost}\n\n");
        text += &format!("weakly active cells: {} over all steps\n\n", c.weakly_active_cells);
    }
    text
}

fn perturbation(row: &EngineRow) -> String {
    row.perturbation.map_or_else(String::new, |e| format!("{e:.0e}"))
}

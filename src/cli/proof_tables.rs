//! Tables of proven gradients and of comparisons for the terminal.

use super::tables::table;
use crate::report::{Comparison, EngineCost, EngineTime, ProvenCase, ProvenQuantity, short};

/// Verdicts, errors over the perturbation and Taylor tables of every case.
pub(super) fn proof(cases: &[ProvenCase]) -> String {
    let mut text = String::new();
    for case in cases {
        text += &verdicts(case);
        for q in &case.quantities {
            text += &format!("\nd {}: error against ADJ over the perturbation\n", q.quantity);
            text += &errors(q);
            text += "Taylor-remainder test along all parameters together, ahead and behind\n";
            text += &taylor(q);
        }
    }
    text
}

/// One line per quantity, and the sentence that goes with it.
pub(super) fn verdicts(case: &ProvenCase) -> String {
    let mut text = format!("{}, {}\n\n", case.bearing, case.operating_point);
    for failure in &case.failures {
        text += &format!("missing: {failure}\n");
    }
    let mut head = vec!["quantity", "value", "unit", "TRA against ADJ"];
    let titles: Vec<String> = match case.quantities.first() {
        Some(q) => q.best.iter().map(|b| format!("best {}", b.engine.as_str())).collect(),
        None => Vec::new(),
    };
    head.extend(titles.iter().map(String::as_str));
    let mut rows = table(&head);
    for q in &case.quantities {
        let start = [q.quantity.clone(), short(q.value), q.unit.clone(), format!("{:.1e}", q.mismatch)];
        let best = q.best.iter().map(|b| format!("{:.1e} at {:.0e}", b.error, b.perturbation));
        rows.add_row(start.into_iter().chain(best));
    }
    text += &format!("{rows}\n\n");
    for q in &case.quantities {
        text += &format!("{}: {}\n", q.quantity, q.verdict);
    }
    text + &format!("weakly active cells: {} over all steps\n", case.weakly_active_cells)
}

fn errors(q: &ProvenQuantity) -> String {
    let mut rows = table(&["engine", "perturbation", "error against ADJ"]);
    rows.add_row(["TRA".to_owned(), String::new(), format!("{:.1e}", q.mismatch)]);
    for d in &q.differences {
        rows.add_row([
            d.engine.as_str().to_owned(),
            format!("{:.0e}", d.perturbation),
            format!("{:.1e}", d.error),
        ]);
    }
    format!("{rows}\n")
}

fn taylor(q: &ProvenQuantity) -> String {
    let mut rows =
        table(&["step", "change ahead", "remainder", "order", "change behind", "remainder", "order"]);
    for (a, b) in q.taylor_ahead.iter().zip(&q.taylor_behind) {
        let order = |o: Option<f64>| o.map_or_else(String::new, |o| format!("{o:.2}"));
        let mut line = vec![format!("{:.1e}", a.step)];
        for t in [a, b] {
            line.extend([format!("{:.1e}", t.change), format!("{:.1e}", t.remainder), order(t.order)]);
        }
        rows.add_row(line);
    }
    format!("{rows}\n")
}

/// What a comparison found: verdicts and cost.
pub(super) fn comparison(found: &Comparison) -> String {
    let mut text = format!("{}\n", found.title);
    for reason in &found.failures {
        text += &format!("missing: {reason}\n");
    }
    for (case, timing) in found.cases.iter().zip(&found.timing.cases) {
        text += &format!("\n{}\n", verdicts(&case.proof));
        text += &costs(&case.costs, &timing.engines);
        for (s, t) in case.speed_ups.iter().zip(&timing.speed_ups) {
            let over = |engine: &str, counted: Option<f64>, timed: Option<f64>| {
                let (counted, timed) = (short(counted?), short(timed?));
                Some(format!("CEN / {engine}: {counted} by factorisations, {timed} by time"))
            };
            let both: Vec<String> =
                [over("ADJ", s.adj, t.adj), over("TRA", s.tra, t.tra)].into_iter().flatten().collect();
            text += &format!(
                "{} {}: {}\n",
                s.parameters,
                if s.parameters == 1 { "parameter" } else { "parameters" },
                both.join("; ")
            );
        }
    }
    text + &format!("{} s\n", short(found.timing.seconds))
}

fn costs(costs: &[EngineCost], times: &[EngineTime]) -> String {
    let mut rows = table(&[
        "engine",
        "parameters",
        "cycles",
        "Newton iterations",
        "factorisations",
        "solves",
        "factorisations / simulation",
        "time / simulation",
    ]);
    for (c, t) in costs.iter().zip(times) {
        rows.add_row([
            c.engine.as_str().to_owned(),
            c.parameters.to_string(),
            short(c.sweeps),
            c.cost.newton_iterations.to_string(),
            c.cost.factorisations.to_string(),
            c.cost.solves.to_string(),
            short(c.factorisations_ratio),
            short(t.simulations),
        ]);
    }
    format!("cost of the gradient of all quantities together\n{rows}\n")
}

//! The CSV files of a comparison; `timing.csv` holds what depends on the machine.

use super::{Comparison, ProvenCase, ProvenQuantity};
use crate::gradient::TaylorRow;
use crate::report::csv_file::{number, table};

type Table = Result<String, csv::Error>;

/// All files but the wall times, by name.
pub fn comparison_csv(found: &Comparison) -> Result<Vec<(&'static str, String)>, csv::Error> {
    Ok(vec![
        ("gradients.csv", gradients(found)?),
        ("errors.csv", errors(found)?),
        ("taylor.csv", taylor(found)?),
        ("cost.csv", cost(found)?),
    ])
}

/// Every quantity of every case.
fn quantities(found: &Comparison) -> impl Iterator<Item = (&ProvenCase, &ProvenQuantity)> {
    found.cases.iter().flat_map(|c| c.proof.quantities.iter().map(|q| (&c.proof, q)))
}

/// The first columns of a row.
fn place(case: &ProvenCase, quantity: &ProvenQuantity) -> Vec<String> {
    vec![case.bearing.clone(), case.operating_point.clone(), quantity.quantity.clone()]
}

fn gradients(found: &Comparison) -> Table {
    let mut rows = Vec::new();
    for (case, q) in quantities(found) {
        let exact = [("ADJ", String::new(), &q.adj), ("TRA", String::new(), &q.tra)];
        let differences =
            q.differences.iter().map(|d| (d.engine.as_str(), d.perturbation.to_string(), &d.values));
        for (engine, perturbation, values) in exact.into_iter().chain(differences) {
            for ((parameter, value), unit) in case.parameters.iter().zip(values).zip(&q.units) {
                let rest = [
                    engine.to_owned(),
                    perturbation.clone(),
                    parameter.clone(),
                    number(*value),
                    unit.clone(),
                ];
                rows.push([place(case, q), rest.to_vec()].concat());
            }
        }
    }
    let head = [
        "bearing",
        "operating_point",
        "quantity",
        "engine",
        "perturbation",
        "parameter",
        "derivative",
        "unit",
    ];
    table(&head, rows)
}

fn errors(found: &Comparison) -> Table {
    let rows = quantities(found).flat_map(|(case, q)| {
        let tra = ("TRA".to_owned(), String::new(), q.mismatch);
        let differences =
            q.differences.iter().map(|d| (d.engine.as_str().to_owned(), d.perturbation.to_string(), d.error));
        std::iter::once(tra).chain(differences).map(move |(engine, perturbation, error)| {
            [place(case, q), vec![engine, perturbation, number(error)]].concat()
        })
    });
    table(&["bearing", "operating_point", "quantity", "engine", "perturbation", "error"], rows)
}

fn taylor(found: &Comparison) -> Table {
    let mut rows = Vec::new();
    for (case, q) in quantities(found) {
        for (direction, steps) in [("ahead", &q.taylor_ahead), ("behind", &q.taylor_behind)] {
            let row = |t: &TaylorRow| {
                let order = t.order.map(number).unwrap_or_default();
                let rest =
                    [direction.to_owned(), number(t.step), number(t.change), number(t.remainder), order];
                [place(case, q), rest.to_vec()].concat()
            };
            rows.extend(steps.iter().map(row));
        }
    }
    let head =
        ["bearing", "operating_point", "quantity", "direction", "step", "change", "remainder", "order"];
    table(&head, rows)
}

fn cost(found: &Comparison) -> Table {
    let rows = found.cases.iter().flat_map(|case| {
        case.costs.iter().map(|c| {
            let counts = [
                c.cost.simulations,
                c.cost.steps,
                c.cost.newton_iterations,
                c.cost.factorisations,
                c.cost.solves,
            ];
            let ratios = [c.newton_iterations_ratio, c.factorisations_ratio, c.solves_ratio];
            let start = [
                case.proof.bearing.clone(),
                case.proof.operating_point.clone(),
                c.engine.as_str().to_owned(),
                c.parameters.to_string(),
            ];
            let start = start.into_iter().chain(counts.map(|n| n.to_string()));
            start.chain(ratios.map(number)).collect()
        })
    });
    let head = [
        "bearing",
        "operating_point",
        "engine",
        "parameters",
        "simulations",
        "steps",
        "newton_iterations",
        "factorisations",
        "solves",
        "newton_iterations_ratio",
        "factorisations_ratio",
        "solves_ratio",
    ];
    table(&head, rows)
}

/// Wall times: the only file that differs between reruns.
pub fn timing_csv(found: &Comparison) -> Table {
    let rows = found.cases.iter().zip(&found.timing.cases).flat_map(|(case, timing)| {
        timing.engines.iter().map(|t| {
            vec![
                case.proof.bearing.clone(),
                case.proof.operating_point.clone(),
                t.engine.as_str().to_owned(),
                t.parameters.to_string(),
                number(t.seconds),
                number(t.simulations),
            ]
        })
    });
    table(&["bearing", "operating_point", "engine", "parameters", "seconds", "time_ratio"], rows)
}

//! The page and the files of a comparison.

use super::super::html::{STYLE, environment};
use super::super::{Files, ReportFile};
use super::figures::{self, Price};
use super::{ComparedCase, Comparison, ProvenQuantity, comparison_csv, timing_csv};
use crate::gradient::{CEN_AGREES, ENGINES_AGREE, EngineName};
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;

const TEMPLATE: &str = include_str!("comparison.html.j2");

/// Figures of one case.
#[derive(Serialize)]
struct CaseFigures {
    errors: Vec<Option<String>>,
    counted: String,
    timed: Option<String>,
}

/// The page as text.
pub fn comparison_html(found: &Comparison) -> Result<String, minijinja::Error> {
    let figures: Vec<CaseFigures> = (0..found.cases.len()).map(|c| case_figures(found, c)).collect();
    let study = toml::to_string(&found.provenance.study).unwrap_or_default();
    let mut environment = environment();
    environment.add_filter("eps", |v: f64| format!("{v:.0e}"));
    environment.add_filter("seven", |v: f64| format!("{v:.6e}"));
    environment.add_template("comparison", TEMPLATE)?;
    environment.get_template("comparison")?.render(context! {
        r => Value::from(Serde(found)),
        figures => Value::from(Serde(figures)),
        engines_agree => ENGINES_AGREE,
        cen_agrees => CEN_AGREES,
        style => STYLE,
        study,
    })
}

fn case_figures(found: &Comparison, c: usize) -> CaseFigures {
    let case = &found.cases[c];
    let error =
        |(k, q): (usize, &ProvenQuantity)| figures::errors(q, &found.engines, &format!("errors-{c}-{k}"));
    let counted = prices(found, |engine| {
        let rows = case.costs.iter().filter(|row| row.engine == engine);
        rows.map(|row| (row.parameters as f64, row.factorisations_ratio)).collect()
    });
    let timed = found.timing.cases.get(c).map(|timing| {
        prices(found, |engine| {
            let rows = timing.engines.iter().filter(|row| row.engine == engine);
            rows.map(|row| (row.parameters as f64, row.simulations)).collect()
        })
    });
    CaseFigures {
        errors: case.proof.quantities.iter().enumerate().map(error).collect(),
        counted: figures::cost(&counted, "factorisations / simulation", &format!("counted-{c}")),
        timed: timed.map(|t| figures::cost(&t, "wall time / simulation", &format!("timed-{c}"))),
    }
}

fn prices(found: &Comparison, points: impl Fn(EngineName) -> Vec<(f64, f64)>) -> Vec<Price> {
    found.engines.iter().map(|&engine| Price { engine, points: points(engine) }).collect()
}

/// Its files: `report.json`, `report.html` and CSV.
pub fn comparison_files(found: &Comparison) -> std::io::Result<Vec<ReportFile>> {
    let mut all = Files::default();
    all.json(found)?;
    for (name, text) in comparison_csv(found).map_err(std::io::Error::other)? {
        all.add(name, Ok::<_, std::fmt::Error>(text))?;
    }
    all.add("timing.csv", timing_csv(found))?;
    all.add("report.html", comparison_html(found))?;
    Ok(all.0)
}

impl ComparedCase {
    /// Name of the case in tables.
    pub fn name(&self) -> String {
        format!("{}, {}", self.proof.bearing, self.proof.operating_point)
    }
}

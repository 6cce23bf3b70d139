//! The page and the files of experiments.

use super::super::csv_file::{maybe, written};
use super::super::html::{STYLE, environment};
use super::super::{Files, ReportFile, titled, word};
use super::{Experiments, figures};
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;

const TEMPLATE: &str = include_str!("experiments.html.j2");
/// Responses that have figures, the most looked at.
const SHOWN: [&str; 4] =
    ["mean_friction_loss_w", "min_film_thickness_um", "max_film_pressure_mpa", "film_temperature_c"];

/// Figures over one factor.
#[derive(Serialize)]
struct FactorFigures {
    name: String,
    figures: Vec<String>,
}

fn all_figures(found: &Experiments) -> Vec<FactorFigures> {
    let shown: Vec<usize> =
        SHOWN.iter().filter_map(|key| found.responses.iter().position(|r| r.key == *key)).collect();
    let over = |(j, f): (usize, &super::FactorReport)| {
        let one = |k: &usize| figures::response(found, j, *k, &format!("factor-{j}-{k}"));
        FactorFigures { name: f.name.clone(), figures: shown.iter().filter_map(one).collect() }
    };
    found.factors.iter().enumerate().map(over).filter(|f| !f.figures.is_empty()).collect()
}

/// The page as text.
pub fn experiments_html(found: &Experiments) -> Result<String, minijinja::Error> {
    let study = toml::to_string(&found.provenance.study).unwrap_or_default();
    let mut environment = environment();
    environment.add_template("experiments", TEMPLATE)?;
    environment.get_template("experiments")?.render(context! {
        r => Value::from(Serde(found)),
        shown => found.shown(),
        figures => Value::from(Serde(all_figures(found))),
        style => STYLE,
        study,
    })
}

/// The runs as text: factors, outcome, responses.
pub fn experiments_csv(found: &Experiments) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let factor = |f: &super::FactorReport| titled(&f.name, &f.unit);
    let head = std::iter::once("run".to_owned()).chain(found.factors.iter().map(factor));
    let head = head.chain(["status", "feasible", "study_hash"].map(str::to_owned));
    writer.write_record(head.chain(found.responses.iter().map(|r| r.key.clone())))?;
    for run in &found.runs {
        let level =
            |(text, number): (&String, &Option<f64>)| number.map_or_else(|| text.clone(), |v| v.to_string());
        let row =
            std::iter::once(run.number.to_string()).chain(run.levels.iter().zip(&run.numbers).map(level));
        let feasible = run.feasible.map_or_else(String::new, |f| f.to_string());
        let row = row.chain([word(run.status), feasible, run.study_hash.clone()]);
        writer.write_record(row.chain(run.responses.iter().copied().map(maybe)))?;
    }
    written(writer)
}

/// Their files: `report.json`, `report.html` and `experiments.csv`.
pub fn experiments_files(found: &Experiments) -> std::io::Result<Vec<ReportFile>> {
    let mut all = Files::default();
    all.json(found)?;
    all.add("experiments.csv", experiments_csv(found))?;
    all.add("report.html", experiments_html(found))?;
    Ok(all.0)
}

//! `report.html`: one self-contained page, the answer first, then the evidence.

use super::{Findings, figures};
use minijinja::value::Serde;
use minijinja::{Environment, Value, context};
use serde::Serialize;

const TEMPLATE: &str = include_str!("report.html.j2");

/// Figures of one working cycle.
#[derive(Serialize)]
struct CycleFigures {
    bearing: String,
    operating_point: String,
    orbit: String,
    film: String,
    pressure: String,
    loss: String,
    load: String,
    map: String,
}

/// The page as text.
pub fn html(findings: &Findings) -> Result<String, minijinja::Error> {
    let report = &findings.report;
    let limit = |quantity: &str, bearing: &str| {
        report.constraints.iter().find(|c| c.quantity == quantity && c.bearing == bearing).map(|c| c.limit)
    };
    let cycles: Vec<CycleFigures> = findings
        .curves
        .iter()
        .enumerate()
        .map(|(k, c)| CycleFigures {
            bearing: c.bearing.clone(),
            operating_point: c.operating_point.clone(),
            orbit: figures::orbit(c, &format!("orbit-{k}")),
            film: figures::film(c, limit("min-film-thickness", &c.bearing), &format!("film-{k}")),
            pressure: figures::pressure(c, limit("max-film-pressure", &c.bearing), &format!("pressure-{k}")),
            loss: figures::loss(c, &format!("loss-{k}")),
            load: figures::load(c, &format!("load-{k}")),
            map: figures::map(c, &format!("map-{k}")),
        })
        .collect();
    let convergence = (!report.history.is_empty()).then(|| figures::convergence(report, "convergence"));
    let cylinder = (!findings.cylinder.is_empty()).then(|| figures::cylinder(&findings.cylinder, "cylinder"));
    let study = toml::to_string_pretty(&report.provenance.study).unwrap_or_default();
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| minijinja::AutoEscape::Html);
    environment.add_filter("sig", significant);
    environment.add_filter("sci", |v: f64| format!("{v:.1e}"));
    environment.add_filter("words", |s: String| s.replace('-', " "));
    environment.add_template("report", TEMPLATE)?;
    environment.get_template("report")?.render(context! {
        r => Value::from(Serde(report)),
        cycles => Value::from(Serde(cycles)),
        convergence,
        cylinder,
        study,
    })
}

/// A number with four significant digits, or a dash for none.
fn significant(value: Value) -> String {
    f64::try_from(value).map_or_else(|_| "–".to_owned(), super::short)
}

//! The page over many reports.

use super::html::{STYLE, environment};
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::{Deserialize, Serialize};

const TEMPLATE: &str = include_str!("index.html.j2");

/// A report in a list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IndexEntry {
    /// Name of the study's file, and of the folder of its report.
    pub name: String,
    /// Title of the study.
    pub title: String,
    /// How it ended.
    pub status: String,
    /// Whether all is well: converged or complete, and every expected figure met.
    pub good: bool,
    /// Loss of the design, or of the best run, W; none for tables.
    pub loss_w: Option<f64>,
    /// Saving over the start, per cent; none where that is no measure.
    pub saving_percent: Option<f64>,
    /// Figures the study expects.
    pub expected: usize,
    /// How many of them are met.
    pub met: usize,
    /// Whether the study's coarse setting was used.
    pub coarse: bool,
    /// Wall time, s.
    pub seconds: f64,
}

/// The page as text.
pub fn index_html(entries: &[IndexEntry]) -> Result<String, minijinja::Error> {
    let mut environment = environment();
    environment.add_template("index", TEMPLATE)?;
    environment.get_template("index")?.render(context! {
        entries => Value::from(Serde(entries)),
        style => STYLE,
    })
}

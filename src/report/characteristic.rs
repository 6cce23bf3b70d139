//! Characteristics: tables of what bearings do over a varied quantity, with published values beside them.
//!
//! Content of `report.json` of a study that tabulates instead of optimising, its CSV and its page.

use super::csv_file::{maybe, written};
use super::figures;
use super::html::{STYLE, environment};
use super::{Assumption, ExpectedReport, Files, Provenance, ReportFile, ReportTiming};
use minijinja::context;
use minijinja::value::{Serde, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the format.
pub const CHARACTERISTIC_FORMAT: &str = "stribeck-characteristic/1";

/// Unit of columns that stand in one figure: a torque and its parts.
const TORQUE: &str = "N m";

const TEMPLATE: &str = include_str!("characteristic.html.j2");

/// How a tabulation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CharacteristicStatus {
    /// Every row was computed.
    Complete,
    /// Some rows could not be computed; the reasons are listed.
    Incomplete,
    /// Stopped from outside.
    Cancelled,
}

/// A tabulated study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Characteristic {
    /// Version of this format, "stribeck-characteristic/1".
    pub schema_version: String,
    /// SHA-256 of all that decides on the answer: the study with every default and its tables, without its words.
    pub study_hash: String,
    /// Title of the study.
    pub title: String,
    /// Question of the study.
    pub question: Option<String>,
    /// How it ended.
    pub status: CharacteristicStatus,
    /// The answer in sentences.
    pub answer: Vec<String>,
    /// Why rows are missing.
    pub failures: Vec<String>,
    /// Where the reference values are from.
    pub reference_source: Option<String>,
    /// One table per bearing, and one of the shaft where torques add up.
    pub tables: Vec<CharacteristicTable>,
    /// Figures the study expects, held against what was found.
    pub expected: Vec<ExpectedReport>,
    /// What depends on the machine and differs between reruns. Nothing else does.
    pub timing: ReportTiming,
    /// What is assumed and why.
    pub assumptions: Vec<Assumption>,
    /// What this rests on.
    pub provenance: Provenance,
}

/// One table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CharacteristicTable {
    /// What it is about: a bearing, or "shaft".
    pub name: String,
    /// The varied quantity.
    pub varied: CharacteristicColumn,
    /// What was found.
    pub columns: Vec<CharacteristicColumn>,
}

/// One column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CharacteristicColumn {
    /// Name in CSV files and references; ends with the unit.
    pub key: String,
    /// Name in words.
    pub title: String,
    /// Unit; "1" for a pure number.
    pub unit: String,
    /// One value per row; none where the row failed.
    pub values: Vec<Option<f64>>,
    /// Reference values, where there are any.
    pub reference: Vec<Option<f64>>,
    /// Largest difference from the reference: relative to each value, percent (angles: in the unit itself).
    pub largest_difference: Option<f64>,
    /// The same, relative to the largest reference value, percent.
    pub difference_of_maximum_percent: Option<f64>,
}

impl CharacteristicColumn {
    /// A column without reference.
    pub fn new(key: &str, title: &str, unit: &str, values: Vec<Option<f64>>) -> Self {
        Self {
            key: key.to_owned(),
            title: title.to_owned(),
            unit: unit.to_owned(),
            values,
            reference: Vec::new(),
            largest_difference: None,
            difference_of_maximum_percent: None,
        }
    }

    /// Sets reference values beside the column and measures the differences.
    pub fn compare(&mut self, reference: Vec<Option<f64>>) {
        // Beside a reference of zero a relative difference means nothing.
        let pairs: Vec<(f64, f64)> = self
            .values
            .iter()
            .zip(&reference)
            .filter_map(|(v, r)| v.zip(*r))
            .filter(|(_, r)| *r != 0.0)
            .collect();
        let top = pairs.iter().fold(0.0f64, |a, (_, r)| a.max(r.abs()));
        let angle = self.unit == "deg";
        let miss = |(v, r): &(f64, f64)| if angle { (v - r).abs() } else { 100.0 * (v / r - 1.0).abs() };
        if !pairs.is_empty() {
            self.largest_difference = Some(pairs.iter().map(miss).fold(0.0, f64::max));
            let of_top = pairs.iter().map(|(v, r)| 100.0 * (v - r).abs() / top).fold(0.0, f64::max);
            self.difference_of_maximum_percent = Some(of_top);
        }
        self.reference = reference;
    }
}

/// One table as CSV.
pub fn characteristic_csv(table: &CharacteristicTable) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let all: Vec<&CharacteristicColumn> = std::iter::once(&table.varied).chain(&table.columns).collect();
    let mut head: Vec<String> = Vec::new();
    for c in &all {
        head.push(c.key.clone());
        if !c.reference.is_empty() {
            head.push(format!("{}_reference", c.key));
        }
    }
    writer.write_record(head)?;
    for n in 0..table.varied.values.len() {
        let mut row = Vec::new();
        for c in &all {
            row.push(maybe(c.values[n]));
            if !c.reference.is_empty() {
                row.push(maybe(c.reference[n]));
            }
        }
        writer.write_record(row)?;
    }
    written(writer)
}

/// Figures of one table, every column in one of them: torques stand together, a column that is zero is left out.
#[derive(Serialize)]
struct TableFigures {
    name: String,
    figures: Vec<String>,
}

/// Columns by figure.
fn together(columns: &[CharacteristicColumn]) -> Vec<Vec<&CharacteristicColumn>> {
    let zero = |c: &CharacteristicColumn| c.values.iter().flatten().all(|v| *v == 0.0);
    let shown: Vec<&CharacteristicColumn> = columns.iter().filter(|c| !zero(c)).collect();
    let same = |a: &&CharacteristicColumn, b: &&CharacteristicColumn| a.unit == TORQUE && b.unit == TORQUE;
    shown.chunk_by(same).map(<[_]>::to_vec).collect()
}

/// The page as text.
pub fn characteristic_html(found: &Characteristic) -> Result<String, minijinja::Error> {
    let figures: Vec<TableFigures> = found
        .tables
        .iter()
        .enumerate()
        .map(|(t, table)| {
            let figure = |(k, columns): (usize, Vec<&CharacteristicColumn>)| {
                figures::characteristic(&table.varied, &columns, &format!("table-{t}-{k}"))
            };
            let figures = together(&table.columns).into_iter().enumerate().map(figure).collect();
            TableFigures { name: table.name.clone(), figures }
        })
        .collect();
    let study = toml::to_string(&found.provenance.study).unwrap_or_default();
    let mut environment = environment();
    environment.add_template("characteristic", TEMPLATE)?;
    environment.get_template("characteristic")?.render(context! {
        r => Value::from(Serde(found)),
        figures => Value::from(Serde(figures)),
        style => STYLE,
        study,
    })
}

/// Its files: `report.json`, `report.html` and one CSV file per table.
pub fn characteristic_files(found: &Characteristic) -> std::io::Result<Vec<ReportFile>> {
    let mut all = Files::default();
    all.json(found)?;
    for table in &found.tables {
        all.add(format!("{}.csv", table.name), characteristic_csv(table))?;
    }
    all.add("report.html", characteristic_html(found))?;
    Ok(all.0)
}

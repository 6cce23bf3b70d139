//! Tables of two characteristics, paired by name; their rows are paired by the varied quantity, their columns by key.

use super::paired;
use crate::report::{CharacteristicColumn, CharacteristicTable, titled};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A table of each report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TablePair {
    /// What it is about: a bearing, or "shaft".
    pub name: String,
    /// The varied quantity in words.
    pub varied: String,
    /// Its unit; "1" for a pure number.
    pub unit: String,
    /// Its values, one per row.
    pub at: Vec<Option<f64>>,
    /// What was found.
    pub columns: Vec<ColumnPair>,
}

/// A column of each report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ColumnPair {
    /// Name in CSV files; ends with the unit.
    pub key: String,
    /// Name in words.
    pub title: String,
    /// Unit; "1" for a pure number.
    pub unit: String,
    /// In A, one value per row; none where A has none.
    pub a: Vec<Option<f64>>,
    /// In B, one value per row; none where B has none.
    pub b: Vec<Option<f64>>,
    /// B less A.
    pub difference: Vec<Option<f64>>,
}

impl TablePair {
    /// The varied quantity with its unit.
    pub fn label(&self) -> String {
        titled(&self.varied, &self.unit)
    }
}

impl ColumnPair {
    /// Whether A and B are the same in every row.
    pub fn equal(&self) -> bool {
        self.a == self.b
    }

    /// Title with unit.
    pub fn label(&self) -> String {
        titled(&self.title, &self.unit)
    }
}

/// A row: its number, and the varied quantity as text.
type Row = (usize, String);

/// The tables of two characteristics.
pub fn tables(a: &Value, b: &Value) -> Vec<TablePair> {
    let of = |report: &Value| -> Vec<CharacteristicTable> {
        let tables = report.get("tables").and_then(|t| Vec::<CharacteristicTable>::deserialize(t).ok());
        tables.unwrap_or_default()
    };
    let (a, b) = (of(a), of(b));
    paired(&a, &b, |t| (t.name.as_str(), t.varied.key.as_str())).into_iter().filter_map(pair).collect()
}

fn pair((a, b): (Option<&CharacteristicTable>, Option<&CharacteristicTable>)) -> Option<TablePair> {
    let either = a.or(b)?;
    let (rows_a, rows_b) = (rows(a), rows(b));
    let rows = paired(&rows_a, &rows_b, |(_, at)| at.as_str());
    let varied = |t: Option<&CharacteristicTable>, row| value(t.map(|t| &t.varied), row);
    let columns = |t: Option<&CharacteristicTable>| t.map(|t| t.columns.clone()).unwrap_or_default();
    let (columns_a, columns_b) = (columns(a), columns(b));
    Some(TablePair {
        name: either.name.clone(),
        varied: either.varied.title.clone(),
        unit: either.varied.unit.clone(),
        at: rows.iter().map(|(x, y)| varied(a, *x).or_else(|| varied(b, *y))).collect(),
        columns: paired(&columns_a, &columns_b, |c| c.key.as_str())
            .into_iter()
            .filter_map(|(x, y)| column(x, y, &rows))
            .collect(),
    })
}

/// Rows of a table by the varied quantity, up to rounding.
fn rows(table: Option<&CharacteristicTable>) -> Vec<Row> {
    let values = table.map(|t| t.varied.values.as_slice()).unwrap_or_default();
    values.iter().map(|v| v.map_or_else(String::new, |v| format!("{v:.8e}"))).enumerate().collect()
}

fn column(
    a: Option<&CharacteristicColumn>,
    b: Option<&CharacteristicColumn>,
    rows: &[(Option<&Row>, Option<&Row>)],
) -> Option<ColumnPair> {
    let either = a.or(b)?;
    let found: Vec<(Option<f64>, Option<f64>)> =
        rows.iter().map(|(x, y)| (value(a, *x), value(b, *y))).collect();
    Some(ColumnPair {
        key: either.key.clone(),
        title: either.title.clone(),
        unit: either.unit.clone(),
        a: found.iter().map(|v| v.0).collect(),
        b: found.iter().map(|v| v.1).collect(),
        difference: found.iter().map(|(a, b)| a.zip(*b).map(|(a, b)| b - a)).collect(),
    })
}

fn value(column: Option<&CharacteristicColumn>, row: Option<&Row>) -> Option<f64> {
    column?.values.get(row?.0).copied().flatten()
}

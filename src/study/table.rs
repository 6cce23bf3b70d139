//! Tables of numbers in a study: inline, or in a CSV file beside it. Column names carry the unit.

use super::Given;
use super::faults::{Faults, join};
use super::file::Unknown;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Largest table that is read.
const MOST_ROWS: usize = 100_000;

/// A table: either a file, or columns and rows.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(deny_unknown_fields)]
pub struct TableFile {
    /// CSV file beside the study, `#` starts a comment, first row the column names.
    pub file: Given<String>,
    /// Column names, if the table stands here.
    pub columns: Given<Vec<String>>,
    /// Rows of numbers, if the table stands here.
    pub rows: Given<Vec<Vec<f64>>>,
    /// Keys that are not part of the format.
    #[serde(flatten)]
    #[schemars(skip)]
    pub unknown: Unknown,
}

/// Numbers by column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl TableFile {
    /// Reads the table; a file is read below `base` only and becomes part of the study. Mistakes are noted at `path`.
    pub(super) fn load(&mut self, base: Option<&Path>, path: &str, faults: &mut Faults) -> Option<Table> {
        faults.unknown::<Self>(&self.unknown, path);
        let file = faults.get(&self.file, &join(path, "file"));
        let columns = faults.get(&self.columns, &join(path, "columns"));
        let rows = faults.get(&self.rows, &join(path, "rows"));
        let table = match (file, columns, rows) {
            (Some(file), None, None) => read_csv(&file, base).map_err(|e| (join(path, "file"), e)),
            (None, Some(columns), Some(rows)) => Ok(Table { columns, rows }),
            _ => Err((path.to_owned(), "give either file, or columns and rows".to_owned())),
        };
        let table = table.and_then(|t| t.checked().map_err(|e| (path.to_owned(), e)));
        match table {
            Ok(table) => Some(table),
            Err((at, message)) => {
                faults.add(&at, message);
                None
            }
        }
    }
}

impl Table {
    fn checked(self) -> Result<Self, String> {
        let width = self.columns.len();
        if self.rows.len() > MOST_ROWS {
            return Err(format!("has {} rows; at most {MOST_ROWS} are read", self.rows.len()));
        }
        match self.rows.iter().position(|r| r.len() != width || r.iter().any(|v| !v.is_finite())) {
            Some(i) => Err(format!("row {} must hold {width} finite numbers", i + 1)),
            None => Ok(self),
        }
    }

    /// The first column found under one of the names, multiplied by the factor that goes with the name.
    pub fn column(&self, names: &[(&str, f64)]) -> Result<Vec<f64>, String> {
        for (name, factor) in names {
            if let Some(k) = self.columns.iter().position(|c| c == name) {
                return Ok(self.rows.iter().map(|r| r[k] * factor).collect());
            }
        }
        let wanted: Vec<&str> = names.iter().map(|n| n.0).collect();
        Err(format!("needs a column {}; it has {}", wanted.join(" or "), self.columns.join(", ")))
    }

    /// All numbers as text, for the study's hash.
    pub fn fingerprint(&self) -> String {
        format!("{:?}{:?}", self.columns, self.rows)
    }
}

fn read_csv(file: &str, base: Option<&Path>) -> Result<Table, String> {
    let base = base.ok_or("files cannot be read here; put columns and rows into the study")?;
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(base.join(file))
        .map_err(|e| format!("'{file}' cannot be read: {e}"))?;
    let broken = |e: csv::Error| format!("'{file}' is no CSV table: {e}");
    let columns = reader.headers().map_err(broken)?.iter().map(str::to_owned).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, csv::Position::line);
        let numbers: Result<Vec<f64>, String> = record
            .iter()
            .map(|v| v.parse().map_err(|_| format!("line {line} of '{file}': '{v}' is not a number")))
            .collect();
        rows.push(numbers?);
    }
    Ok(Table { columns, rows })
}

/// Crank angles in radians and one or more columns, one period without a repeated end point.
pub(super) fn periodic(
    table: &Table,
    period_rad: f64,
    columns: &[&[(&str, f64)]],
) -> Result<(Vec<f64>, Vec<Vec<f64>>), String> {
    let degree = std::f64::consts::PI / 180.0;
    let mut angles = table.column(&[("crank_angle_deg", degree), ("crank_angle_rad", 1.0)])?;
    let mut values: Vec<Vec<f64>> =
        columns.iter().map(|names| table.column(names)).collect::<Result<_, _>>()?;
    let (Some(&first), Some(&last)) = (angles.first(), angles.last()) else {
        return Err("has no rows".to_owned());
    };
    if (last - first - period_rad).abs() < 1e-9 {
        let n = angles.len();
        if let Some(column) = values.iter().find(|c| (c[0] - c[n - 1]).abs() > 1e-6 * c[0].abs().max(1.0)) {
            return Err(format!(
                "first and last row are one cycle apart but differ: {} and {}",
                column[0],
                column[n - 1]
            ));
        }
        angles.pop();
        values.iter_mut().for_each(|c| {
            c.pop();
        });
    }
    Ok((angles, values))
}

//! Tables of numbers in a study: inline, or in a CSV file beside it. Column names carry the unit.

use super::Given;
use super::faults::{Faults, join};
use super::given::Unknown;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Component, Path};

/// Largest table that is read.
const MOST_ROWS: usize = 100_000;
/// Largest CSV file that is read.
const MOST_FILE_BYTES: u64 = 32_000_000;
/// Bad rows that are named one by one.
const NAMED_ROWS: usize = 5;
/// Widest hole in a periodic table, degrees: a spline across more would be invented.
const WIDEST_HOLE_DEG: f64 = 30.0;

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
    let inside = Path::new(file).components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    if !inside {
        return Err(format!("'{file}' must lie in the folder of the study or below it"));
    }
    let size = std::fs::metadata(base.join(file)).map(|m| if m.is_file() { m.len() } else { u64::MAX });
    if size.is_ok_and(|bytes| bytes > MOST_FILE_BYTES) {
        return Err(format!("'{file}' is no file, or larger than 32 MB"));
    }
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(base.join(file))
        .map_err(|e| format!("'{file}' cannot be read: {e}"))?;
    let broken = |e: csv::Error| format!("'{file}' is no CSV table: {e}");
    let columns = reader.headers().map_err(broken)?.iter().map(str::to_owned).collect();
    let mut rows = Vec::new();
    let mut bad = Vec::new();
    for record in reader.records() {
        let record = match record {
            Ok(record) => record,
            Err(e) => {
                bad.push(broken(e));
                continue;
            }
        };
        let line = record.position().map_or(0, csv::Position::line);
        let number = |v: &str| v.parse().ok().filter(|v: &f64| v.is_finite());
        match record.iter().map(|v| number(v).ok_or(v)).collect::<Result<Vec<f64>, &str>>() {
            Ok(row) => rows.push(row),
            Err(v) => bad.push(format!("line {line} of '{file}': '{v}' is not a finite number")),
        }
    }
    let more = bad.len().saturating_sub(NAMED_ROWS);
    bad.truncate(NAMED_ROWS);
    if more > 0 {
        bad.push(format!("and {more} more rows"));
    }
    if bad.is_empty() { Ok(Table { columns, rows }) } else { Err(bad.join("; ")) }
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
    let degrees = |v: f64| crate::report::short(v.to_degrees());
    if let Some(i) = (1..angles.len()).find(|&i| angles[i] <= angles[i - 1]) {
        return Err(format!(
            "crank angles must increase: {} comes after {}",
            degrees(angles[i]),
            degrees(angles[i - 1])
        ));
    }
    let next = |i: usize| angles.get(i + 1).copied().unwrap_or(angles[0] + period_rad);
    if let Some(i) = (0..angles.len()).find(|&i| next(i) - angles[i] > WIDEST_HOLE_DEG * degree) {
        let (from, to) = (degrees(angles[i]), degrees(next(i)));
        return Err(format!(
            "must cover the whole cycle of {}: nothing stands between {from} and {to} degrees",
            degrees(period_rad)
        ));
    }
    Ok((angles, values))
}

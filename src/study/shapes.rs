//! Checks of the shapes of shell and journal.

use super::Given;
use super::bearings::is_name;
use super::faults::{Faults, join, refuse_others};
use super::file::{ShapeFile, ShapeKind, SurfaceName};
use super::machine::zero;
use super::table::{Table, TableFile};
use crate::cranktrain::BearingShape;
use crate::film::{Profile, SurfaceTable, TensorSpline};
use crate::report::short;
use crate::units::Length;
use std::f64::consts::TAU;
use std::path::Path;

/// Coefficients of a spline at most.
const MOST_COEFFICIENTS: usize = 2000;
/// Largest height of a shape, m.
const HIGHEST_M: f64 = 1e-2;

pub(super) fn shapes(
    list: &mut [Given<ShapeFile>],
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Vec<BearingShape> {
    let mut found: Vec<BearingShape> = Vec::new();
    for (i, given) in list.iter_mut().enumerate() {
        let path = format!("{path}[{i}]");
        faults.get(given, &path);
        let Given::Value(file) = given else { continue };
        faults.unknown::<ShapeFile>(&file.unknown, &path);
        let name = faults.need(&file.name, &join(&path, "name"));
        if let Some(name) = name.as_ref().filter(|name| !is_name(name)) {
            let words = format!("a shape's name is made of letters, digits, '_' and '-', found \"{name}\"");
            faults.add(&join(&path, "name"), words);
        }
        if let Some(name) = name.as_ref().filter(|name| found.iter().any(|s| s.name == **name)) {
            faults.add(&join(&path, "name"), format!("the name \"{name}\" stands twice"));
        }
        let on = faults.or(&mut file.on, &join(&path, "on"), SurfaceName::Shell);
        let profile = profile(file, &path, base, faults, fingerprint);
        if let (Some(name), Some(profile)) = (name, profile) {
            found.push(BearingShape { name, profile, on_journal: on == SurfaceName::Journal });
        }
    }
    found
}

fn profile(
    file: &mut ShapeFile,
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<Profile> {
    let at = |key: &str| join(path, key);
    let kind = faults.need(&file.kind, &at("kind"))?;
    let (words, used): (&str, &[&str]) = match kind {
        ShapeKind::Lemon => ("lemon", &["offset", "angle"]),
        ShapeKind::Offset => ("offset", &["offset", "angle"]),
        ShapeKind::Barrel => ("barrel", &["height"]),
        ShapeKind::Cone => ("cone", &["height"]),
        ShapeKind::EdgeRelief => ("edge-relief", &["depth", "length_share"]),
        ShapeKind::Spline => ("spline", &["around", "across", "symmetric", "coefficients"]),
        ShapeKind::Table => ("table", &["table"]),
    };
    let why = format!("kind is \"{words}\"");
    refuse_others!(
        faults,
        file,
        path,
        &why,
        used,
        [offset, angle, height, depth, length_share, around, across, symmetric, coefficients, table,]
    );
    let (before, height) = (faults.count(), |given: &Given<Length>, key: &str, faults: &mut Faults| {
        let value = faults.need(given, &at(key)).map(|v| v.si());
        faults.range(value, &at(key), |v| v.abs() <= HIGHEST_M, "between -10 mm and 10 mm");
        value
    });
    let profile = match kind {
        ShapeKind::Lemon | ShapeKind::Offset => {
            let angle_rad = faults.or(&mut file.angle, &at("angle"), zero("0 deg")).si();
            let offset_m = height(&file.offset, "offset", faults)?;
            if kind == ShapeKind::Lemon {
                Profile::LemonBore { offset_m, angle_rad }
            } else {
                Profile::OffsetBore { offset_m, angle_rad }
            }
        }
        ShapeKind::Barrel => Profile::Barrel { height_m: height(&file.height, "height", faults)? },
        ShapeKind::Cone => Profile::Cone { height_m: height(&file.height, "height", faults)? },
        ShapeKind::EdgeRelief => {
            let depth = height(&file.depth, "depth", faults);
            let length = faults.need(&file.length_share, &at("length_share"));
            faults.range(
                length,
                &at("length_share"),
                |v| v > 0.0 && v <= 1.0,
                "above 0 and at most 1 (half the width)",
            );
            Profile::EdgeRelief { depth_m: depth?, length_share: length? }
        }
        ShapeKind::Spline => Profile::Spline(spline(file, path, faults)?),
        ShapeKind::Table => {
            Profile::Table(measured(&mut file.table, &at("table"), base, faults, fingerprint)?)
        }
    };
    (faults.count() == before).then_some(profile)
}

fn spline(file: &mut ShapeFile, path: &str, faults: &mut Faults) -> Option<TensorSpline> {
    let (at, before) = (|key: &str| join(path, key), faults.count());
    let symmetric = faults.or(&mut file.symmetric, &at("symmetric"), true);
    let (around, across) =
        (faults.need(&file.around, &at("around")), faults.need(&file.across, &at("across")));
    let least = if symmetric { 3 } else { 4 };
    let words = format!("1 or at least {least}");
    let most = MOST_COEFFICIENTS as f64;
    faults.range(
        around.map(|n| n as f64),
        &at("around"),
        |n| n == 1.0 || (4.0..=most).contains(&n),
        "1 or at least 4",
    );
    let fits = |n: f64| n == 1.0 || (f64::from(least)..=most).contains(&n);
    faults.range(across.map(|n| n as f64), &at("across"), fits, &words);
    let (around, across) = (around?, across?);
    if faults.count() > before {
        return None;
    }
    if around.saturating_mul(across) > MOST_COEFFICIENTS || around * across == 0 {
        faults.add(path, format!("a spline has 1 to {MOST_COEFFICIENTS} coefficients, around times across"));
        return None;
    }
    let flat = vec![Given::Value(zero("0 um")); around * across];
    let given = faults.or(&mut file.coefficients, &at("coefficients"), flat);
    let one = |(k, given): (usize, &Given<Length>)| {
        let path = format!("{}[{k}]", at("coefficients"));
        let value = faults.need(given, &path).map(|v| v.si());
        faults.range(value, &path, |v| v.abs() <= HIGHEST_M, "between -10 mm and 10 mm");
        value.unwrap_or(0.0)
    };
    let coefficients: Vec<f64> = given.iter().enumerate().map(one).collect();
    let made = match symmetric && across > 1 {
        true => TensorSpline::symmetric(around, across, coefficients),
        false => TensorSpline::new(around, across, coefficients),
    };
    made.map_err(|e| faults.add(&at("coefficients"), e.to_string())).ok()
}

fn measured(
    given: &mut Given<TableFile>,
    path: &str,
    base: Option<&Path>,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<SurfaceTable> {
    faults.need(given, path);
    let Given::Value(file) = given else { return None };
    let table = file.load(base, path, faults)?;
    fingerprint.push_str(&table.fingerprint());
    surface(&table).map_err(|e| faults.add(path, e)).ok()
}

/// A surface from rows in any order that fill a grid of angles and axial positions.
fn surface(table: &Table) -> Result<SurfaceTable, String> {
    let angles = table.column(&[("angle_deg", TAU / 360.0), ("angle_rad", 1.0)])?;
    let zetas = table.column(&[("zeta", 1.0)])?;
    let heights = table.column(&[("height_um", 1e-6), ("height_m", 1.0)])?;
    if let Some(h) = heights.iter().find(|h| h.abs() > HIGHEST_M) {
        return Err(format!("heights must lie between -10 mm and 10 mm, found {} mm", short(h * 1e3)));
    }
    let lines = |all: &[f64]| {
        let mut lines = all.to_vec();
        lines.sort_by(f64::total_cmp);
        lines.dedup();
        lines
    };
    let (around, across) = (lines(&angles), lines(&zetas));
    let mut grid = vec![None; around.len() * across.len()];
    for ((angle, zeta), height) in angles.iter().zip(&zetas).zip(&heights) {
        let (i, k) = (around.partition_point(|a| a < angle), across.partition_point(|z| z < zeta));
        grid[i * across.len() + k] = Some(*height);
    }
    let whole: Option<Vec<f64>> = grid.iter().copied().collect();
    let Some(heights) = whole.filter(|h| h.len() == angles.len()) else {
        let (n, m) = (around.len(), across.len());
        let rows = angles.len();
        return Err(format!(
            "must fill a grid: {n} angles times {m} axial positions need {} rows, found {rows}",
            n * m
        ));
    };
    SurfaceTable::new(around, across, &heights).map_err(|e| e.to_string())
}

//! The sensitivity map: where a micrometre of gap matters for the mean loss.

use super::build::Plan;
use super::observe;
use crate::cranktrain::JournalBearing;
use crate::gradient::{EngineName, GradientTable, engine};
use crate::optimise::Evaluated;
use crate::report::{Curves, GapSensitivityReport, MapExtremum, MapRange, SensitivityMaps};
use crate::run::Cancel;

/// W/m3 in W/(um cm2).
const PER_UM_CM2: f64 = 1e-6 * 1e-4;
/// mm2 in cm2.
const MM2_PER_CM2: f64 = 100.0;

/// Map of the loss of one case at a design. It falls out of the adjoint; other engines do not know it, so the adjoint is
/// run for it alone.
pub(super) fn maps(
    plan: &Plan,
    case: usize,
    x: &[f64],
    at: &Evaluated,
    table: &GradientTable,
    cancel: &Cancel,
) -> Option<SensitivityMaps> {
    let (orbit, asked) = (&at.orbits[case], &plan.problem.cases()[case]);
    let model = observe::found(plan, case, x, orbit)?;
    let of_loss = match table.fields.first() {
        Some(fields) => return converted(&model, fields),
        None => &asked.quantities[..1],
    };
    let adjoint = engine(EngineName::Adj, 0.0);
    let table = adjoint.gradient(&model, orbit, &asked.options, of_loss, cancel).ok()?;
    converted(&model, table.fields.first()?)
}

fn converted(model: &JournalBearing, fields: &[f64]) -> Option<SensitivityMaps> {
    let found = model.gap_sensitivity(fields)?;
    let scaled = |map: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        map.into_iter().map(|row| row.into_iter().map(|v| v * PER_UM_CM2).collect()).collect()
    };
    Some(SensitivityMaps {
        shell_w_per_um_cm2: scaled(found.shell),
        journal_w_per_um_cm2: scaled(found.journal),
    })
}

/// The map of a case in short.
pub(super) fn summary(c: &Curves) -> Option<GapSensitivityReport> {
    let maps = c.sensitivity.as_ref()?;
    let shell = &maps.shell_w_per_um_cm2;
    let cells = shell.iter().map(Vec::len).sum::<usize>() as f64;
    let cell_cm2 = std::f64::consts::PI * c.diameter_mm * c.width_mm / cells / MM2_PER_CM2;
    Some(GapSensitivityReport {
        bearing: c.bearing.clone(),
        operating_point: c.operating_point.clone(),
        everywhere_w_per_um: shell.iter().flatten().sum::<f64>() * cell_cm2,
        shell: ends(c, shell)?,
        journal: ends(c, &maps.journal_w_per_um_cm2)?,
    })
}

fn ends(c: &Curves, map: &[Vec<f64>]) -> Option<MapRange> {
    let (around, across) = (map.len(), map.first()?.len());
    let extremum = |sign: f64| {
        let cells = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
        let (i, j) = cells
            .max_by(|a, b| (sign * map[a.0][a.1]).total_cmp(&(sign * map[b.0][b.1])))
            .unwrap_or_default();
        MapExtremum {
            w_per_um_cm2: map[i][j],
            angle_deg: 360.0 * i as f64 / around as f64,
            axial_mm: c.width_mm * ((j as f64 + 0.5) / across as f64 - 0.5),
        }
    };
    Some(MapRange { saves_most: extremum(-1.0), costs_most: extremum(1.0) })
}

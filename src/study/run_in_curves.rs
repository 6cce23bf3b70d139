//! Before and after running-in: the profile across the width where the shell has worn most, and the Stribeck curve.
//!
//! ```text
//! f(n) = mean P / mean (|F| |U|)    over the cycle at the crank speed n, with the gas load and the oil of the last stage
//! ```
//!
//! The curve is that of the engine, not of a test rig: the load turns and pulsates, inertia grows with the speed.

use crate::cranktrain::{BearingOutput, BearingSetup, JournalBearing, SurfaceField};
use crate::orbit::{Orbit, OrbitOptions};
use crate::report::{ProfileReport, StribeckPoint};
use crate::run::Cancel;
use crate::running_in::{Stage, new_surfaces, settled_with_wear};
use std::sync::Arc;

/// Speeds of the curve, as shares of that of the last stage; the first is where the search begins.
const SPEEDS: [f64; 7] = [1.0, 0.75, 0.55, 0.4, 0.28, 0.19, 0.12];

/// The profile of the shell across its width where it has worn most; none if it has not, or without cells.
pub(super) fn profile(model: &JournalBearing, worn_m: &SurfaceField) -> Option<ProfileReport> {
    let mesh = model.film().mesh()?;
    let (cell, depth) = worn_m.shell.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if *depth <= 0.0 {
        return None;
    }
    let row = cell / mesh.n_z;
    let across = |field: &[f64]| mesh.map(field.iter().map(|v| v * 1e6)).swap_remove(row);
    let speed = model.setup().speed_rad_s;
    let shape = |worn: SurfaceField| -> Option<Vec<f64>> {
        let setup = BearingSetup { worn_m: Arc::new(worn), ..model.setup().clone() };
        let (_, shape_m) = JournalBearing::new(setup).ok()?.still_input([0.0; 2], speed);
        Some(if shape_m.is_empty() { vec![0.0; mesh.cells()] } else { shape_m })
    };
    let new = shape(SurfaceField::default())?;
    let run_in = shape(SurfaceField { shell: worn_m.shell.clone(), journal: Vec::new() })?;
    let (new_um, run_in_um) = (across(&new), across(&run_in));
    let (width_mm, n) = (model.setup().width_m * 1e3, new_um.len() as f64);
    let axial_mm = (0..new_um.len()).map(|j| width_mm * ((j as f64 + 0.5) / n - 0.5)).collect();
    let angle_deg = 360.0 * row as f64 / mesh.n_phi as f64;
    Some(ProfileReport { angle_deg, axial_mm, new_um, run_in_um })
}

/// The Stribeck curves with new and with worn surfaces, at rising speeds; speeds at which a cycle could not be simulated are left out
/// of its curve.
pub(super) fn stribeck(
    last: &Stage,
    worn_m: &SurfaceField,
    options: &OrbitOptions,
    cancel: &Cancel,
) -> Vec<StribeckPoint> {
    let curve = |worn: &SurfaceField| -> Vec<Option<f64>> {
        let mut near: Option<Orbit> = None;
        let mut at = |share: f64| {
            let speed_rad_s = share * last.model.setup().speed_rad_s;
            let setup = BearingSetup { speed_rad_s, ..last.model.setup().clone() };
            let model = JournalBearing::new(setup).ok()?;
            let rate = settled_with_wear(&model, worn, options, near.as_ref(), cancel).ok()?;
            let friction = friction(&model, &rate.orbit);
            near = Some(rate.orbit);
            Some(friction)
        };
        SPEEDS.iter().map(|share| at(*share)).collect()
    };
    let (new, run_in) = rayon::join(|| curve(&new_surfaces(&last.model, false)), || curve(worn_m));
    let rpm = last.model.setup().speed_rad_s * 30.0 / std::f64::consts::PI;
    let mut points: Vec<StribeckPoint> = (SPEEDS.iter().zip(new).zip(run_in))
        .map(|((share, new), run_in)| StribeckPoint { speed_rpm: share * rpm, new, run_in })
        .collect();
    points.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
    points
}

/// Mean friction power over the mean product of load and sliding speed.
fn friction(model: &JournalBearing, orbit: &Orbit) -> f64 {
    let s = model.setup();
    let reference = |n: usize| {
        let drive = model.drive(orbit.time_s(n));
        let [x, y] = drive.load_n;
        x.hypot(y) * (drive.relative_speed_rad_s * s.diameter_m / 2.0).abs()
    };
    let sum: f64 = (0..orbit.steps()).map(reference).sum();
    orbit.mean(BearingOutput::Loss.index()) * orbit.steps() as f64 / sum
}

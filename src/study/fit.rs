//! Checks of a bearing as a whole: that a gap is left, and that its cycle repeats.

use super::faults::{Faults, join};
use super::plans::BearingPlan;
use crate::cranktrain::Tilt;
use crate::film::{Feed, Opening};
use crate::report::short;
use std::f64::consts::TAU;

/// The centred journal must not touch the shell, however it is tilted and whatever the shapes.
pub(super) fn leave_a_gap(plan: &BearingPlan, path: &str, faults: &mut Faults) {
    if plan.diametral_clearance_m <= 0.0 {
        return;
    }
    let tilt = match plan.tilt {
        Tilt::Given(tilt) => tilt,
        Tilt::Free => [0.0; 2],
    };
    let zetas = (0..=20).map(|k| 0.1 * f64::from(k) - 1.0);
    let points: Vec<[f64; 2]> =
        zetas.flat_map(|z| (0..180).map(move |i| [TAU * f64::from(i) / 180.0, z])).collect();
    let mut gap: Vec<f64> = points
        .iter()
        .map(|[phi, z]| {
            let arm = z * plan.width_m / 2.0;
            plan.diametral_clearance_m / 2.0 - arm * (tilt[0] * phi.cos() + tilt[1] * phi.sin())
        })
        .collect();
    let mut one = vec![0.0; points.len()];
    for shape in &plan.shapes {
        shape.profile.gap_m_into(&points, 0.0, &mut one);
        gap.iter_mut().zip(&one).for_each(|(h, s)| *h += s);
    }
    let least = gap.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((k, least)) = least.filter(|(_, h)| *h <= 0.0) {
        let [phi, zeta] = points[k];
        let (at, low) = (short(phi.to_degrees()), short(least * 1e6));
        let key = if plan.shapes.is_empty() { "tilt_x" } else { "shapes" };
        let words =
            format!("leave no gap: {low} um for the centred journal at {at} deg and zeta = {}", short(zeta));
        faults.add(&join(path, key), format!("tilt and shapes {words}"));
    }
}

/// What turns with the journal must stand where it stood after a cycle.
pub(super) fn come_back(plan: &BearingPlan, path: &str, faults: &mut Faults) {
    if plan.load.journal_returns() {
        return;
    }
    let words = "turns with the journal, which does not come back after one cycle; choose a cycle of full turns, or put it on the shell";
    if plan.supply.as_ref().is_some_and(|s| s.feeds.iter().any(turns)) {
        faults.add(&join(path, "supply"), words);
    }
    if plan.shapes.iter().any(|s| s.on_journal && !s.profile.axisymmetric()) {
        faults.add(&join(path, "shapes"), words);
    }
}

/// Whether an opening changes the film while the journal turns.
fn turns(feed: &Feed) -> bool {
    let closed = |extent: f64| extent > TAU - 1e-9;
    feed.on_journal
        && !matches!(feed.opening, Opening::CircumferentialGroove { extent_rad, .. } if closed(extent_rad))
}

//! The figures of a running-in.

use super::figures::{even_up, scaled_across};
use super::svg::{FOUND, START, half, render, styled, tight_axis};
use super::{BearingRunningIn, ProfileReport, RunningInBlock, StribeckPoint};
use kuva::prelude::*;

/// Friction loss over a running-in programme.
pub fn loss(b: &BearingRunningIn, name: &str) -> String {
    over_programme(b, |m| m.loss_w, ("mean friction loss [W]", Axis::Near), name)
}

/// Share of contact in the loss over a running-in programme.
pub fn share(b: &BearingRunningIn, name: &str) -> String {
    over_programme(b, |m| 100.0 * m.contact_share, ("contact share [%]", Axis::FromZero), name)
}

/// Deepest wear over a running-in programme.
pub fn depth(b: &BearingRunningIn, name: &str) -> String {
    over_programme(b, |m| m.max_wear_depth_um, ("largest wear depth [µm]", Axis::FromZero), name)
}

/// Where an axis begins.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    /// At zero.
    FromZero,
    /// Near the values, whose change is what counts.
    Near,
}

/// A number of every block over time; where a stage ends it jumps.
fn over_programme(
    b: &BearingRunningIn,
    of: impl Fn(&RunningInBlock) -> f64,
    (label, axis): (&str, Axis),
    name: &str,
) -> String {
    let points: Vec<(f64, f64)> = b.blocks.iter().map(|m| (m.time_h, of(m))).collect();
    let up: Vec<f64> = points.iter().map(|p| p.1).collect();
    let plots: Vec<Plot> =
        vec![LinePlot::new().with_data(points).with_color(FOUND).with_stroke_width(1.8).into()];
    let hours: Vec<f64> = b.blocks.iter().map(|m| m.time_h).collect();
    let (end, step) = tight_axis(hours.iter().copied());
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label("time [h]")
        .with_y_label(label)
        .with_x_axis_min(0.0)
        .with_x_axis_max(end)
        .with_x_tick_step(step);
    let layout = if axis == Axis::FromZero { even_up(layout, &up) } else { layout };
    render(plots, layout, name)
}

/// The shell across its width, new and run in.
pub fn profile(p: &ProfileReport, name: &str) -> String {
    let curve = |values: &[f64], colour: &str, legend: &str| -> Plot {
        let points = p.axial_mm.iter().copied().zip(values.iter().copied());
        LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.8).with_legend(legend).into()
    };
    let plots = vec![curve(&p.new_um, START, "new"), curve(&p.run_in_um, FOUND, "run in")];
    let up: Vec<f64> = p.new_um.iter().chain(&p.run_in_um).copied().collect();
    let end = p.axial_mm.iter().fold(0.0f64, |m, z| m.max(z.abs()));
    let (end, step) = tight_axis([end]);
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label("position across the width [mm]")
        .with_y_label("profile [µm]")
        .with_x_axis_min(-end)
        .with_x_axis_max(end)
        .with_x_tick_step(step);
    render(plots, even_up(layout, &up), name)
}

/// Stribeck curves with new and with run-in surfaces; none if nothing is known.
pub fn stribeck(points: &[StribeckPoint], name: &str) -> Option<String> {
    let of = |which: fn(&StribeckPoint) -> Option<f64>| -> Vec<(f64, f64)> {
        points.iter().filter_map(|p| which(p).map(|f| (p.speed_rpm, 1e3 * f))).collect()
    };
    let (new, run_in) = (of(|p| p.new), of(|p| p.run_in));
    if new.is_empty() || run_in.is_empty() {
        return None;
    }
    let (across, up): (Vec<f64>, Vec<f64>) = new.iter().chain(&run_in).copied().unzip();
    let curve = |data: Vec<(f64, f64)>, colour: &str, legend: &str| -> Plot {
        LinePlot::new().with_data(data).with_color(colour).with_stroke_width(1.8).with_legend(legend).into()
    };
    let plots = vec![curve(new, START, "new"), curve(run_in, FOUND, "run in")];
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label("crank speed [rpm]")
        .with_y_label("friction coefficient [1/1000]");
    Some(render(plots, even_up(scaled_across(layout, &across), &up), name))
}

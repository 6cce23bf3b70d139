//! The figures of a comparison: errors over the perturbation, cost over the number of parameters. Engines differ in colour,
//! mark and dash. Both axes are logarithmic, drawn as even axes of logarithms: kuva's own end at 1e-10.

use super::super::svg::{FOUND, LIMIT, SECOND, SKY, THIRD, half, render, styled};
use super::ProvenQuantity;
use crate::gradient::EngineName;
use kuva::prelude::*;
use std::sync::Arc;

/// Errors below this are drawn here.
const LEAST_ERROR: f64 = 1e-16;
/// Ticks upwards at most.
const MOST_TICKS: f64 = 8.0;

/// How an engine is drawn.
fn style(engine: EngineName) -> (&'static str, MarkerShape, bool) {
    match engine {
        EngineName::Fw => (SECOND, MarkerShape::Circle, false),
        EngineName::Bw => (SKY, MarkerShape::Square, true),
        EngineName::Cen => (THIRD, MarkerShape::Triangle, false),
        EngineName::Tra => (LIMIT, MarkerShape::Diamond, true),
        EngineName::Adj => (FOUND, MarkerShape::Circle, false),
    }
}

fn curve(points: &[(f64, f64)], engine: EngineName, legend: &str) -> Vec<Plot> {
    let (colour, mark, dashed) = style(engine);
    let points = || points.iter().copied();
    let line =
        LinePlot::new().with_data(points()).with_color(colour).with_stroke_width(1.6).with_legend(legend);
    let line = if dashed { line.with_dashed() } else { line };
    let marks = ScatterPlot::new().with_data(points()).with_color(colour).with_size(3.5).with_marker(mark);
    vec![line.into(), marks.into()]
}

/// Axes of logarithms with a tick at every so many of them.
fn logarithmic(layout: Layout, across: [f64; 2], up: &[f64], ticks: [TickFormat; 2]) -> Layout {
    let low = up.iter().copied().fold(f64::INFINITY, f64::min).floor();
    let high = up.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil().max(low + 1.0);
    let step = ((high - low) / MOST_TICKS).ceil();
    let [x, y] = ticks;
    half(layout)
        .with_x_axis_min(across[0])
        .with_x_axis_max(across[1])
        .with_x_tick_step(1.0)
        .with_x_tick_format(x)
        .with_y_axis_min(low)
        .with_y_axis_max(low + step * ((high - low) / step).ceil())
        .with_y_tick_step(step)
        .with_y_tick_format(y)
}

fn power() -> TickFormat {
    TickFormat::Custom(Arc::new(|v: f64| format!("1e{v:.0}")))
}

/// Ticks that read as the numbers they are the logarithms of.
fn plain(base: f64) -> TickFormat {
    TickFormat::Custom(Arc::new(move |v: f64| crate::report::short(base.powf(v))))
}

/// Errors of the differences against ADJ over the perturbation, that of TRA as a line.
pub fn errors(q: &ProvenQuantity, engines: &[EngineName], name: &str) -> Option<String> {
    let shown = |v: f64| v.max(LEAST_ERROR).log10();
    let mut plots = Vec::new();
    let (mut across, mut up) = (Vec::new(), Vec::new());
    for &engine in engines {
        let rows = q.differences.iter().filter(|d| d.engine == engine);
        let points: Vec<(f64, f64)> = rows.map(|d| (d.perturbation.log10(), shown(d.error))).collect();
        if !points.is_empty() {
            across.extend(points.iter().map(|p| p.0));
            up.extend(points.iter().map(|p| p.1));
            plots.extend(curve(&points, engine, engine.as_str()));
        }
    }
    let (least, most) = (across.iter().copied().reduce(f64::min)?, across.iter().copied().reduce(f64::max)?);
    let ends = [least.floor(), most.ceil().max(least.floor() + 1.0)];
    if engines.contains(&EngineName::Tra) {
        let level = shown(q.mismatch);
        up.push(level);
        plots.extend(curve(&ends.map(|x| (x, level)), EngineName::Tra, "TRA").into_iter().take(1));
    }
    let layout = logarithmic(styled(Layout::auto_from_plots(&plots)), ends, &up, [power(), power()])
        .with_x_label("relative perturbation")
        .with_y_label("error against ADJ");
    Some(render(plots, layout, name))
}

/// One engine's cost: numbers of parameters and prices.
pub struct Price {
    pub engine: EngineName,
    pub points: Vec<(f64, f64)>,
}

/// Cost over the number of parameters.
pub fn cost(prices: &[Price], label: &str, name: &str) -> String {
    let mut plots = Vec::new();
    let (mut most, mut up) = (1.0f64, Vec::new());
    // Dashed ones last: they show what they cover.
    let dashed = |p: &&Price| style(p.engine).2;
    let (last, first): (Vec<&Price>, Vec<&Price>) = prices.iter().partition(dashed);
    for price in first.into_iter().chain(last) {
        let points: Vec<(f64, f64)> = price.points.iter().map(|(k, p)| (k.log2(), p.log10())).collect();
        most = points.iter().fold(most, |most, p| most.max(p.0));
        up.extend(points.iter().map(|p| p.1));
        plots.extend(curve(&points, price.engine, price.engine.as_str()));
    }
    let layout =
        logarithmic(styled(Layout::auto_from_plots(&plots)), [0.0, most], &up, [plain(2.0), plain(10.0)])
            .with_x_label("number of parameters")
            .with_y_label(label);
    render(plots, layout, name)
}

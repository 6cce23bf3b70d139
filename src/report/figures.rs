//! The figures of a report.

use super::svg::{FOUND, LIMIT, SECOND, START, axis, over_cycle, render, styled};
use super::{Curves, Report};
use kuva::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Columns of the pressure map at most; more would only make the page heavy.
const MAP_COLUMNS: usize = 120;

/// A closed cycle: the first value stands again at its end.
fn line(x: &[f64], y: &[f64], cycle: f64, colour: &str, legend: &str) -> LinePlot {
    let end = y.first().map(|y| (cycle, *y));
    let points = x.iter().copied().zip(y.iter().copied()).chain(end).filter(|p| p.1.is_finite());
    LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.8).with_legend(legend)
}

fn cycle_deg(c: &Curves) -> f64 {
    let n = c.crank_angle_deg.len() as f64;
    (c.crank_angle_deg.last().copied().unwrap_or(0.0) * n / (n - 1.0).max(1.0)).round()
}

/// A quantity over the cycle: start and design found, with a limit if there is one.
fn over_angle(
    c: &Curves,
    series: [(&[f64], &str, &str); 3],
    limit: Option<f64>,
    label: &str,
    name: &str,
) -> String {
    let mut plots: Vec<Plot> = Vec::new();
    for (y, colour, legend) in series.iter().filter(|s| s.0.len() == c.crank_angle_deg.len()) {
        plots.push(line(&c.crank_angle_deg, y, cycle_deg(c), colour, legend).into());
    }
    let everything = series.iter().flat_map(|s| s.0.iter().copied()).chain(limit);
    // Room for the legend above the curves.
    let (top, step) = axis(everything.map(|v| 1.15 * v));
    let mut layout = over_cycle(styled(Layout::auto_from_plots(&plots)), cycle_deg(c))
        .with_y_label(label)
        .with_y_axis_min(0.0)
        .with_y_axis_max(top)
        .with_y_tick_step(step)
        .with_legend_position(LegendPosition::InsideTopCenter);
    if let Some(limit) = limit {
        let reference = ReferenceLine::horizontal(limit).with_color(LIMIT).with_stroke_width(1.2);
        layout = layout.with_reference_line(reference.with_label("limit"));
    }
    render(plots, layout, name)
}

/// Smallest film thickness over the cycle.
pub fn film(c: &Curves, limit: Option<f64>, name: &str) -> String {
    let series =
        [(&c.start_film_min_um[..], START, "start"), (&c.film_min_um, FOUND, "design"), (&[], "", "")];
    over_angle(c, series, limit, "smallest film thickness [µm]", name)
}

/// Largest film pressure over the cycle.
pub fn pressure(c: &Curves, limit: Option<f64>, name: &str) -> String {
    let series = [
        (&c.start_pressure_max_mpa[..], START, "start"),
        (&c.pressure_max_mpa, FOUND, "design"),
        (&[], "", ""),
    ];
    over_angle(c, series, limit, "largest film pressure [MPa]", name)
}

/// Cylinder pressure over the cycle, (degrees, MPa).
pub fn cylinder(curve: &[(f64, f64)], name: &str) -> String {
    let plots: Vec<Plot> = vec![
        LinePlot::new().with_data(curve.iter().copied()).with_color(LIMIT).with_stroke_width(1.8).into(),
    ];
    let (top, step) = axis(curve.iter().map(|p| p.1));
    let layout = over_cycle(styled(Layout::auto_from_plots(&plots)), curve.last().map_or(720.0, |p| p.0))
        .with_y_label("cylinder pressure [MPa]")
        .with_y_axis_min(0.0)
        .with_y_axis_max(top)
        .with_y_tick_step(step)
        .with_height(220.0);
    render(plots, layout, name)
}

/// Friction loss over the cycle.
pub fn loss(c: &Curves, name: &str) -> String {
    let series = [
        (&c.start_loss_w[..], START, "start: friction loss"),
        (&c.loss_w, FOUND, "design: friction loss"),
        (&c.dissipation_w, SECOND, "design: with squeeze power"),
    ];
    over_angle(c, series, None, "power [W]", name)
}

/// Load of the bearing over the cycle.
pub fn load(c: &Curves, name: &str) -> String {
    let size: Vec<f64> = c.load_kn.iter().map(|l| l[0].hypot(l[1])).collect();
    over_angle(c, [(&size, LIMIT, "load"), (&[], "", ""), (&[], "", "")], None, "load [kN]", name)
}

/// Orbit of the journal in the clearance circle, at equal scale.
pub fn orbit(c: &Curves, name: &str) -> String {
    let circle = (0..=180).map(|i| (TAU * f64::from(i) / 180.0).sin_cos()).map(|(s, c)| (c, s));
    let closed = |path: &[[f64; 2]]| -> Vec<(f64, f64)> {
        path.iter().chain(path.first()).map(|e| (e[0], e[1])).collect()
    };
    let mut plots: Vec<Plot> = vec![
        LinePlot::new().with_data(circle).with_color("#555555").with_stroke_width(1.2).with_dashed().into(),
    ];
    if !c.start_eccentricity.is_empty() {
        plots.push(path(closed(&c.start_eccentricity), START, "start"));
    }
    plots.push(path(closed(&c.eccentricity), FOUND, "design"));
    plots.push(marks(c));
    let (left, right, top, bottom, side) = (64.0, 20.0, 16.0, 54.0, 400.0);
    let layout = styled(Layout::auto_from_plots(&plots))
        .with_x_label("eccentricity ratio along x")
        .with_y_label("eccentricity ratio along y")
        .with_x_axis_min(-1.2)
        .with_x_axis_max(1.2)
        .with_y_axis_min(-1.2)
        .with_y_axis_max(1.2)
        .with_x_tick_step(0.5)
        .with_y_tick_step(0.5)
        .with_tick_format(TickFormat::Fixed(1))
        .with_width(left + side + right)
        .with_height(top + side + bottom)
        .with_force_margins(left, right)
        .with_force_margins_y(top, bottom)
        .with_legend_position(LegendPosition::InsideBottomRight);
    render(plots, layout, name)
}

fn path(points: Vec<(f64, f64)>, colour: &str, legend: &str) -> Plot {
    LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.8).with_legend(legend).into()
}

/// Crank angles along the orbit.
fn marks(c: &Curves) -> Plot {
    let n = c.eccentricity.len();
    let at: Vec<usize> = (0..8).map(|k| k * n / 8).collect();
    let labels: Vec<String> = at.iter().map(|&k| format!("{:.0}°", c.crank_angle_deg[k])).collect();
    ScatterPlot::new()
        .with_data(at.iter().map(|&k| (c.eccentricity[k][0], c.eccentricity[k][1])))
        .with_color(FOUND)
        .with_size(3.0)
        .with_labels(labels.iter().map(String::as_str))
        .into()
}

/// Film pressure over the unwrapped bearing at the instant of its maximum.
pub fn map(c: &Curves, name: &str) -> String {
    let around = c.pressure_map_mpa.len();
    let every = around.div_ceil(MAP_COLUMNS).max(1);
    let across = c.pressure_map_mpa.first().map_or(0, Vec::len);
    let peak = |i: &usize| c.pressure_map_mpa[*i].iter().copied().fold(0.0, f64::max);
    let highest = (0..around).max_by(|a, b| peak(a).total_cmp(&peak(b))).unwrap_or(0);
    // The picture is cut where the pressure is not: opposite to 0 if the peak is near 0.
    let near_zero = highest < around / 4 || highest > 3 * around / 4;
    let first_deg = if near_zero { -180.0 } else { 0.0 };
    let first = if near_zero { around / 2 } else { 0 };
    // kuva draws rows upwards: one row per axial cell, one column per angle.
    let column = |i: usize| &c.pressure_map_mpa[(first + i) % around];
    let grid: Vec<Vec<f64>> =
        (0..across).map(|j| (0..around).step_by(every).map(|i| column(i)[j]).collect()).collect();
    let top = grid.iter().flatten().copied().fold(0.0f64, f64::max);
    let half_cell = 180.0 / around as f64 * every as f64;
    let plots: Vec<Plot> = vec![
        QuiverPlot::new()
            .with_color_map(ColorMap::Cividis)
            .with_color_range(0.0, top)
            .with_color_legend_label("film pressure [MPa]")
            .into(),
        Heatmap::new()
            .with_data(grid)
            .with_color_map(ColorMap::Cividis)
            .with_x_range(first_deg - half_cell, first_deg + 360.0 - half_cell)
            .with_y_range(-c.width_mm / 2.0, c.width_mm / 2.0)
            .with_cell_size(1.0)
            .into(),
    ];
    let layout = styled(Layout::auto_from_plots(&plots))
        .with_x_label("angle around the shell [deg]")
        .with_y_label("axial position [mm]")
        .with_x_axis_min(first_deg - half_cell)
        .with_x_axis_max(first_deg + 360.0 - half_cell)
        .with_y_axis_min(-c.width_mm / 2.0)
        .with_y_axis_max(c.width_mm / 2.0)
        .with_x_tick_step(45.0)
        .with_show_grid(false)
        .with_height(240.0);
    render(plots, layout, name)
}

/// KKT residual and violation over the iterations, on a logarithmic scale.
pub fn convergence(report: &Report, name: &str) -> String {
    let series = |pick: &dyn Fn(&crate::run::IterationEvent) -> f64| -> Vec<(f64, f64)> {
        report.history.iter().map(|h| (h.iteration as f64, pick(h).max(1e-16).log10())).collect()
    };
    let (kkt, violation) = (series(&|h| h.kkt), series(&|h| h.violation.max(1e-12)));
    let tolerance = report.kkt.tolerance.log10();
    let low = kkt.iter().chain(&violation).map(|p| p.1).fold(tolerance - 1.0, f64::min).floor();
    let high = kkt.iter().chain(&violation).map(|p| p.1).fold(0.0, f64::max).ceil();
    let last = report.history.last().map_or(1.0, |h| h.iteration.max(1) as f64);
    let curve = |data: &[(f64, f64)], colour: &str, legend: &str, shape| -> [Plot; 2] {
        let data = || data.iter().copied();
        [
            LinePlot::new()
                .with_data(data())
                .with_color(colour)
                .with_stroke_width(1.6)
                .with_legend(legend)
                .into(),
            ScatterPlot::new().with_data(data()).with_color(colour).with_size(3.0).with_marker(shape).into(),
        ]
    };
    let plots: Vec<Plot> = curve(&kkt, FOUND, "KKT residual", MarkerShape::Circle)
        .into_iter()
        .chain(curve(&violation, SECOND, "constraint violation", MarkerShape::Square))
        .collect();
    let layout = styled(Layout::auto_from_plots(&plots))
        .with_x_label("iteration")
        .with_y_label("scaled residual")
        .with_x_axis_min(0.0)
        .with_x_axis_max(last)
        .with_x_tick_step((last / 8.0).ceil().max(1.0))
        .with_x_tick_format(TickFormat::Integer)
        .with_y_axis_min(low)
        .with_y_axis_max(high)
        .with_y_tick_step(2.0)
        .with_y_tick_format(TickFormat::Custom(Arc::new(|v: f64| format!("1e{v:.0}"))))
        .with_reference_line(
            ReferenceLine::horizontal(tolerance)
                .with_color(LIMIT)
                .with_stroke_width(1.2)
                .with_label("tolerance"),
        )
        .with_legend_position(LegendPosition::InsideTopCenter);
    render(plots, layout, name)
}

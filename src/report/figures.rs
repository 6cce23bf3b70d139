//! The figures of a report.

use super::html::units;
use super::svg::{
    FOUND, LIMIT, SECOND, SKY, START, THIRD, axis, half, legend_below, over_cycle, render, styled, tight_axis,
};
use super::{CharacteristicColumn, Curves, ParetoReport, Report, titled};
use kuva::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Room of a crank angle beside the orbit, in eccentricity ratios.
const MARK_WIDTH: f64 = 0.22;
/// The same upwards.
const MARK_HEIGHT: f64 = 0.1;
/// Ratio of the ends of a varied quantity above which its axis is logarithmic.
const WIDE: f64 = 10.0;
/// Ratio of largest to smallest value found above which the axis is logarithmic.
const DECADES: f64 = 100.0;

/// A closed cycle: the first value stands again at its end.
fn line(x: &[f64], y: &[f64], cycle: f64, colour: &str) -> LinePlot {
    let end = y.first().map(|y| (cycle, *y));
    let points = x.iter().copied().zip(y.iter().copied()).chain(end).filter(|p| p.1.is_finite());
    LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.8)
}

fn cycle_deg(c: &Curves) -> f64 {
    let n = c.crank_angle_deg.len() as f64;
    (c.crank_angle_deg.last().copied().unwrap_or(0.0) * n / (n - 1.0).max(1.0)).round()
}

/// A curve over the cycle.
struct Series<'a> {
    values: &'a [f64],
    colour: &'static str,
    legend: &'static str,
    /// Whether it is a part of another one; drawn dashed, so that both are seen where they are one.
    part: bool,
}

impl<'a> Series<'a> {
    fn new(values: &'a [f64], colour: &'static str, legend: &'static str) -> Self {
        Self { values, colour, legend, part: false }
    }

    fn part(values: &'a [f64], colour: &'static str, legend: &'static str) -> Self {
        Self { values, colour, legend, part: true }
    }

    fn plot(&self, c: &Curves) -> LinePlot {
        let plot = line(&c.crank_angle_deg, self.values, cycle_deg(c), self.colour);
        if self.part { plot.with_dashed() } else { plot }
    }
}

/// Largest values over all operating points of a bearing: its figures are compared, so they have one scale.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tops {
    film_um: f64,
    pressure_mpa: f64,
    contact_mpa: f64,
    loss_w: f64,
    load_kn: f64,
    /// Film pressure of the map, MPa.
    pub map_mpa: f64,
}

impl Tops {
    /// Those of a bearing.
    pub fn of<'c>(curves: impl Iterator<Item = &'c Curves>) -> Self {
        let mut tops = Self::default();
        let up = |top: &mut f64, values: &[f64]| {
            *top = values.iter().copied().filter(|v| v.is_finite()).fold(*top, f64::max);
        };
        for c in curves {
            up(&mut tops.film_um, &c.film_min_um);
            up(&mut tops.film_um, &c.start_film_min_um);
            up(&mut tops.pressure_mpa, &c.pressure_max_mpa);
            up(&mut tops.pressure_mpa, &c.start_pressure_max_mpa);
            up(&mut tops.contact_mpa, &c.contact_max_mpa);
            [&c.loss_w, &c.start_loss_w, &c.dissipation_w].into_iter().for_each(|v| up(&mut tops.loss_w, v));
            let size: Vec<f64> = c.load_kn.iter().map(|l| l[0].hypot(l[1])).collect();
            up(&mut tops.load_kn, &size);
            c.pressure_map_mpa.iter().for_each(|row| up(&mut tops.map_mpa, row));
        }
        tops
    }
}

/// A quantity over the cycle, with a limit if there is one. A single curve needs no legend.
fn over_angle(
    c: &Curves,
    series: &[Series],
    (limit, top): (Option<f64>, f64),
    frame: fn(Layout) -> Layout,
    label: &str,
    name: &str,
) -> String {
    let shown: Vec<&Series> = series.iter().filter(|s| s.values.len() == c.crank_angle_deg.len()).collect();
    let legend = |plot: LinePlot, s: &Series| if shown.len() > 1 { plot.with_legend(s.legend) } else { plot };
    let plots: Vec<Plot> = shown.iter().map(|s| legend(s.plot(c), s).into()).collect();
    let values = shown.iter().flat_map(|s| s.values.iter().copied());
    let (top, step) = axis(values.chain(limit).chain([top]));
    let mut layout = over_cycle(frame(styled(Layout::auto_from_plots(&plots))), cycle_deg(c))
        .with_y_label(label)
        .with_y_axis_min(0.0)
        .with_y_axis_max(top)
        .with_y_tick_step(step);
    if let Some(limit) = limit {
        let reference = ReferenceLine::horizontal(limit).with_color(LIMIT).with_stroke_width(1.2);
        layout = layout.with_reference_line(reference.with_label("limit"));
    }
    render(plots, layout, name)
}

/// Smallest film thickness over the cycle.
pub fn film(c: &Curves, limit: Option<f64>, tops: &Tops, name: &str) -> String {
    let series =
        [Series::new(&c.start_film_min_um, START, "start"), Series::new(&c.film_min_um, FOUND, "design")];
    over_angle(c, &series, (limit, tops.film_um), half, "film thickness [µm]", name)
}

/// Largest film pressure over the cycle.
pub fn pressure(c: &Curves, limit: Option<f64>, tops: &Tops, name: &str) -> String {
    let series = [
        Series::new(&c.start_pressure_max_mpa, START, "start"),
        Series::new(&c.pressure_max_mpa, FOUND, "design"),
    ];
    over_angle(c, &series, (limit, tops.pressure_mpa), half, "film pressure [MPa]", name)
}

/// Largest contact pressure over the cycle.
pub fn contact(c: &Curves, limit: Option<f64>, tops: &Tops, name: &str) -> String {
    let series = [Series::new(&c.contact_max_mpa, FOUND, "design")];
    over_angle(c, &series, (limit, tops.contact_mpa), half, "contact pressure [MPa]", name)
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

/// A front: the least loss over the limit on another quantity.
pub fn front(p: &ParetoReport, name: &str) -> String {
    let found: Vec<(f64, f64)> = p.points.iter().filter_map(|q| Some((q.limit, q.loss_w?))).collect();
    let points = || found.iter().copied();
    let plots: Vec<Plot> = vec![
        LinePlot::new().with_data(points()).with_color(FOUND).with_stroke_width(1.8).into(),
        ScatterPlot::new().with_data(points()).with_color(FOUND).with_size(4.0).into(),
    ];
    let (across, up): (Vec<f64>, Vec<f64>) = found.iter().copied().unzip();
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label(format!("{} {} [{}]", p.quantity.replace('-', " "), p.sense, units(&p.unit)))
        .with_y_label("least mean friction loss [W]");
    render(plots, scaled_up(scaled_across(layout, &across), &up), name)
}

/// What an axis shows: a name with its unit as it is written in text.
pub(super) fn labelled(name: &str, unit: &str) -> String {
    titled(name, &units(unit))
}

/// Columns over the varied one: what was found as curves, the reference as points.
pub fn characteristic(x: &CharacteristicColumn, columns: &[&CharacteristicColumn], name: &str) -> String {
    let plots: Vec<Plot> = columns
        .iter()
        .zip([FOUND, SECOND, THIRD])
        .enumerate()
        .flat_map(|(k, (c, colour))| column(x, c, colour, (columns.len() > 1).then_some(k)))
        .collect();
    let label = |c: &CharacteristicColumn| labelled(&c.title, &c.unit);
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label(label(x))
        .with_y_label(columns.first().map_or_else(String::new, |c| label(c)));
    let across = x.values.iter().flatten().copied().collect::<Vec<f64>>();
    let up = columns.iter().flat_map(|c| c.values.iter().chain(&c.reference)).flatten().copied();
    let (layout, up) = (scaled_across(layout, &across), up.collect::<Vec<f64>>());
    // A sum and its parts stand on one even scale, however small a part may become.
    render(plots, if columns.len() > 1 { even_up(layout, &up) } else { scaled_up(layout, &up) }, name)
}

/// Smallest and largest value.
fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

/// Ticks that read as the numbers in the tables.
fn plain() -> TickFormat {
    TickFormat::Custom(Arc::new(super::short))
}

/// The axis of a varied quantity: from zero, or logarithmic where it spans much.
pub(super) fn scaled_across(layout: Layout, values: &[f64]) -> Layout {
    let (low, high) = range(values);
    if low > 0.0 && high > WIDE * low {
        return layout.with_log_x().with_x_axis_min(low).with_x_axis_max(high).with_x_tick_format(plain());
    }
    let (end, step) = tight_axis(values.iter().copied());
    layout.with_x_axis_min(0.0).with_x_axis_max(end).with_x_tick_step(step)
}

/// The axis of what was found: from zero, or in decades where it spans some.
fn scaled_up(layout: Layout, values: &[f64]) -> Layout {
    let (low, high) = range(values);
    if low > 0.0 && high > DECADES * low {
        let decade = |v: f64| 10f64.powf(v);
        return layout
            .with_log_y()
            .with_y_axis_min(decade(low.log10().floor()))
            .with_y_axis_max(decade(high.log10().ceil()))
            .with_y_tick_format(plain());
    }
    even_up(layout, values)
}

/// An axis of what was found that starts at zero.
pub(super) fn even_up(layout: Layout, values: &[f64]) -> Layout {
    let (end, step) = tight_axis(values.iter().copied());
    layout.with_y_axis_min(range(values).0.min(0.0)).with_y_axis_max(end).with_y_tick_step(step)
}

/// One column of a characteristic: a curve, and points where there is a reference. `place` tells its place among
/// several in one figure, of which the first is the sum of the others.
fn column(
    x: &CharacteristicColumn,
    y: &CharacteristicColumn,
    colour: &str,
    place: Option<usize>,
) -> Vec<Plot> {
    let points = |v: &[Option<f64>]| -> Vec<(f64, f64)> {
        x.values.iter().zip(v).filter_map(|(x, y)| x.zip(*y)).collect()
    };
    let reference = points(&y.reference);
    let mut curve = LinePlot::new().with_data(points(&y.values)).with_color(colour).with_stroke_width(1.8);
    if place.is_some_and(|k| k > 0) {
        curve = curve.with_dashed();
    }
    if place.is_some() {
        curve = curve.with_legend(y.title.as_str());
    } else if !reference.is_empty() {
        curve = curve.with_legend("computed");
    }
    let mut plots: Vec<Plot> = vec![curve.into()];
    if !reference.is_empty() {
        let (marked, legend) = match place {
            Some(_) => (colour, format!("{}: reference", y.title)),
            None => (SECOND, "reference".to_owned()),
        };
        let marks = ScatterPlot::new().with_data(reference).with_color(marked).with_size(4.0);
        plots.push(marks.with_legend(legend).into());
    }
    plots
}

/// Friction loss over the cycle; split into its parts where surfaces touch.
pub fn loss(c: &Curves, tops: &Tops, name: &str) -> String {
    let hydrodynamic: Vec<f64> = c.loss_w.iter().zip(&c.contact_loss_w).map(|(l, k)| l - k).collect();
    let mut series = vec![
        Series::new(&c.start_loss_w, START, "start"),
        Series::new(&c.loss_w, FOUND, "design"),
        Series::new(&c.dissipation_w, SECOND, "design: with squeeze power"),
    ];
    if c.touches() {
        series.push(Series::part(&hydrodynamic, SKY, "design: hydrodynamic"));
        series.push(Series::part(&c.contact_loss_w, THIRD, "design: contact"));
    }
    over_angle(c, &series, (None, tops.loss_w), legend_below, "friction loss [W]", name)
}

/// Load of the bearing over the cycle.
pub fn load(c: &Curves, tops: &Tops, name: &str) -> String {
    let size: Vec<f64> = c.load_kn.iter().map(|l| l[0].hypot(l[1])).collect();
    over_angle(c, &[Series::new(&size, LIMIT, "load")], (None, tops.load_kn), half, "load [kN]", name)
}

/// Orbit of the journal in the clearance circle, at equal scale.
pub fn orbit(c: &Curves, name: &str) -> String {
    let closed = |path: &[[f64; 2]]| -> Vec<(f64, f64)> {
        path.iter().chain(path.first()).map(|e| (e[0], e[1])).collect()
    };
    let mut plots: Vec<Plot> = Vec::new();
    if !c.start_eccentricity.is_empty() {
        plots.push(path(closed(&c.start_eccentricity), START, "start"));
    }
    plots.push(path(closed(&c.eccentricity), FOUND, "design"));
    plots.push(marks(c));
    in_clearance_circle(plots, name)
}

/// Paths in the clearance circle, at equal scale.
pub(super) fn in_clearance_circle(paths: Vec<Plot>, name: &str) -> String {
    let circle = (0..=180).map(|i| (TAU * f64::from(i) / 180.0).sin_cos()).map(|(s, c)| (c, s));
    let circle = LinePlot::new().with_data(circle).with_color("#555555").with_stroke_width(1.2).with_dashed();
    let plots: Vec<Plot> = std::iter::once(circle.into()).chain(paths).collect();
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

/// Crank angles along the orbit, where they do not stand on one another.
fn marks(c: &Curves) -> Plot {
    let n = c.eccentricity.len();
    let mut at: Vec<usize> = Vec::new();
    for k in (0..8).map(|k| k * n / 8) {
        let [x, y] = c.eccentricity[k];
        let apart = |other: &usize| {
            let [a, b] = c.eccentricity[*other];
            (x - a).abs() > MARK_WIDTH || (y - b).abs() > MARK_HEIGHT
        };
        if at.iter().all(apart) {
            at.push(k);
        }
    }
    let labels: Vec<String> = at.iter().map(|&k| format!("{:.0}°", c.crank_angle_deg[k])).collect();
    ScatterPlot::new()
        .with_data(at.iter().map(|&k| (c.eccentricity[k][0], c.eccentricity[k][1])))
        .with_color(FOUND)
        .with_size(3.0)
        .with_labels(labels.iter().map(String::as_str))
        .into()
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
        );
    render(plots, legend_below(layout), name)
}

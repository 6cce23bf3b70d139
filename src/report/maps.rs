//! Fields over the unwrapped bearing, as pictures.

use super::svg::{half, render, styled};
use super::{BearingRunningIn, Curves};
use kuva::prelude::*;
use std::sync::Arc;

/// Columns of a map at most; more would only make the page heavy.
const MAP_COLUMNS: usize = 120;
/// Ends and middle of the colours of signed fields: blue, white, orange; told apart by the colour-blind too.
const SIGNED: [[f64; 3]; 3] = [[0.0, 90.0, 160.0], [247.0, 247.0, 247.0], [190.0, 80.0, 0.0]];

/// Which surface a map unwraps.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    Shell,
    Journal,
}

/// From where to where the colours go.
#[derive(Clone, Copy)]
struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    fn upwards(high: f64) -> Self {
        Self { low: 0.0, high }
    }

    fn both_ways(size: f64) -> Self {
        Self { low: -size, high: size }
    }

    fn colours(self) -> ColorMap {
        if self.low == 0.0 { ColorMap::Cividis } else { ColorMap::Custom(Arc::new(signed)) }
    }

    /// Colours of a grid; kuva spreads the map it is given over the values that occur.
    fn of(self, grid: &[Vec<f64>]) -> ColorMap {
        let every = || grid.iter().flatten().copied();
        let low = every().fold(f64::INFINITY, f64::min);
        let span = every().fold(f64::NEG_INFINITY, f64::max) - low;
        let (map, Self { low: from, high: to }) = (self.colours(), self);
        ColorMap::Custom(Arc::new(move |v| map.map(((low + v * span - from) / (to - from)).clamp(0.0, 1.0))))
    }
}

/// Colour of a signed field, 0 to 1 with the sign changing at 1/2.
fn signed(v: f64) -> String {
    let (from, to, share) =
        if v < 0.5 { (SIGNED[0], SIGNED[1], 2.0 * v) } else { (SIGNED[1], SIGNED[2], 2.0 * v - 1.0) };
    let [r, g, b] = [0, 1, 2].map(|k| (from[k] + share * (to[k] - from[k])).round() as u8);
    format!("rgb({r},{g},{b})")
}

/// Film pressure over the unwrapped bearing at the instant of its maximum, coloured up to `top` MPa.
pub fn pressure_map(c: &Curves, top: f64, name: &str) -> String {
    map(c, &c.pressure_map_mpa, Scale::upwards(top), Frame::Shell, "film pressure [MPa]", name)
}

/// Fill of the gap at the same instant; none for a film that does not know it.
pub fn fill_map(c: &Curves, name: &str) -> Option<String> {
    (!c.fill_map.is_empty())
        .then(|| map(c, &c.fill_map, Scale::upwards(1.0), Frame::Shell, "filled share of the gap", name))
}

/// What the shapes add to the gap; none without shapes.
pub fn shape_map(c: &Curves, name: &str) -> Option<String> {
    let size = c.shape_um.iter().flatten().fold(0.0f64, |a, v| a.max(v.abs()));
    let label = "added to the gap [\u{b5}m]";
    (size > 0.0).then(|| map(c, &c.shape_um, Scale::both_ways(size), Frame::Shell, label, name))
}

/// Where a picture of the unwrapped bearing is cut: its first row and the angle there. Not where the pressure is:
/// opposite to 0 if the peak is near 0.
fn cut(pressure: &[Vec<f64>]) -> (usize, f64) {
    let around = pressure.len();
    let peak = |i: &usize| pressure[*i].iter().copied().fold(0.0, f64::max);
    let highest = (0..around).max_by(|a, b| peak(a).total_cmp(&peak(b))).unwrap_or(0);
    let near_zero = highest < around / 4 || highest > 3 * around / 4;
    if near_zero { (around / 2, -180.0) } else { (0, 0.0) }
}

/// Derivative of the mean loss by the local gap, on the shell and on the journal, in one scale of colours.
pub fn sensitivity_maps(c: &Curves, name: &str) -> Option<[String; 2]> {
    let s = c.sensitivity.as_ref()?;
    let every = s.shell_w_per_um_cm2.iter().chain(&s.journal_w_per_um_cm2).flatten();
    let size = every.fold(0.0f64, |a, v| a.max(v.abs())).max(f64::MIN_POSITIVE);
    let label = "loss per gap [W/(\u{b5}m cm\u{b2})]";
    let draw = |field: &[Vec<f64>], frame, part: &str| {
        map(c, field, Scale::both_ways(size), frame, label, &format!("{name}-{part}"))
    };
    Some([
        draw(&s.shell_w_per_um_cm2, Frame::Shell, "shell"),
        draw(&s.journal_w_per_um_cm2, Frame::Journal, "journal"),
    ])
}

/// A field over the unwrapped bearing, rows around and columns across.
fn map(c: &Curves, field: &[Vec<f64>], scale: Scale, frame: Frame, label: &str, name: &str) -> String {
    let cut = if frame == Frame::Shell { cut(&c.pressure_map_mpa) } else { (0, 0.0) };
    unwrapped(c.width_mm, cut, field, scale, frame, (label, name))
}

/// Depth worn off a shell or a journal, both in one scale of colours, cut where it does not wear.
pub fn wear_map(b: &BearingRunningIn, frame: Frame, name: &str) -> Option<String> {
    let depth_um = match frame {
        Frame::Shell => &b.wear_depth_um,
        Frame::Journal => &b.journal_wear_depth_um,
    };
    let deepest = |field: &[Vec<f64>]| field.iter().flatten().copied().fold(0.0f64, f64::max);
    let top = deepest(&b.wear_depth_um).max(deepest(&b.journal_wear_depth_um));
    let words = ("wear depth [µm]", name);
    (deepest(depth_um) > 0.0).then(|| {
        let (field, scale) = (depth_um, Scale::upwards(top));
        unwrapped(b.width_mm, cut(field), field, scale, frame, words)
    })
}

/// A field of the unwrapped bearing, cut at a row that stands at an angle.
fn unwrapped(
    width_mm: f64,
    (first, first_deg): (usize, f64),
    field: &[Vec<f64>],
    scale: Scale,
    frame: Frame,
    (label, name): (&str, &str),
) -> String {
    let around = field.len();
    let every = around.div_ceil(MAP_COLUMNS).max(1);
    let across = field.first().map_or(0, Vec::len);
    // kuva draws rows upwards: one row per axial cell, one column per angle.
    let column = |i: usize| &field[(first + i) % around];
    let grid: Vec<Vec<f64>> =
        (0..across).map(|j| (0..around).step_by(every).map(|i| column(i)[j]).collect()).collect();
    let colours = scale.of(&grid);
    let half_cell = 180.0 / around as f64 * every as f64;
    let plots: Vec<Plot> = vec![
        QuiverPlot::new()
            .with_color_map(scale.colours())
            .with_color_range(scale.low, scale.high)
            .with_color_legend_label(label)
            .into(),
        Heatmap::new()
            .with_data(grid)
            .with_color_map(colours)
            .with_x_range(first_deg - half_cell, first_deg + 360.0 - half_cell)
            .with_y_range(-width_mm / 2.0, width_mm / 2.0)
            .with_cell_size(1.0)
            .into(),
    ];
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label(match frame {
            Frame::Shell => "angle around the shell [deg]",
            Frame::Journal => "angle around the journal [deg]",
        })
        .with_y_label("axial position [mm]")
        .with_x_axis_min(first_deg - half_cell)
        .with_x_axis_max(first_deg + 360.0 - half_cell)
        .with_y_axis_min(-width_mm / 2.0)
        .with_y_axis_max(width_mm / 2.0)
        .with_x_tick_step(90.0)
        .with_show_grid(false);
    render(plots, layout, name)
}

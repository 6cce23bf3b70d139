//! Figures of experiments: responses over the factors of numbers.

use super::{ExperimentRun, Experiments};
use crate::report::figures::labelled;
use crate::report::svg::{FOUND, LIMIT, SECOND, SKY, START, THIRD, axis_around, half, render, styled};
use kuva::prelude::*;

/// Colours of lines that differ by another factor.
const COLOURS: [&str; 6] = [FOUND, SECOND, THIRD, SKY, START, LIMIT];

/// Runs that differ in one factor only.
struct Line<'a> {
    others: Vec<&'a String>,
    points: Vec<(f64, f64)>,
}

/// A response over a factor. In a grid with few other levels every combination of them is a line; otherwise every run is a point.
pub fn response(found: &Experiments, factor: usize, response: usize, name: &str) -> Option<String> {
    let known: Vec<(&ExperimentRun, f64, f64)> = found
        .runs
        .iter()
        .filter_map(|r| Some((r, r.numbers[factor]?, r.responses.get(response).copied()??)))
        .collect();
    if known.len() < 2 {
        return None;
    }
    let mut lines: Vec<Line> = Vec::new();
    for (run, x, y) in &known {
        let others: Vec<&String> =
            run.levels.iter().enumerate().filter(|(j, _)| *j != factor).map(|(_, text)| text).collect();
        match lines.iter_mut().find(|line| line.others == others) {
            Some(line) => line.points.push((*x, *y)),
            None => lines.push(Line { others, points: vec![(*x, *y)] }),
        }
    }
    let drawn = found.plan != "grid" || lines.len() > COLOURS.len();
    let mut plots: Vec<Plot> = Vec::new();
    if drawn {
        let points = known.iter().map(|(_, x, y)| (*x, *y));
        plots.push(ScatterPlot::new().with_data(points).with_color(FOUND).with_size(3.5).into());
    } else {
        let single = lines.len() == 1;
        for (Line { others, points }, colour) in lines.iter_mut().zip(COLOURS) {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut line =
                LinePlot::new().with_data(points.iter().copied()).with_color(colour).with_stroke_width(1.8);
            if !single {
                let text: Vec<&str> = others.iter().map(|t| t.as_str()).collect();
                line = line.with_legend(text.join(", "));
            }
            plots.push(line.into());
            let marks = points.iter().copied();
            plots.push(ScatterPlot::new().with_data(marks).with_color(colour).with_size(3.5).into());
        }
    }
    let (f, r) = (&found.factors[factor], &found.responses[response]);
    let across: Vec<f64> = known.iter().map(|k| k.1).collect();
    let up: Vec<f64> = known.iter().map(|k| k.2).collect();
    let layout = half(styled(Layout::auto_from_plots(&plots)))
        .with_x_label(labelled(&f.name, &f.unit))
        .with_y_label(labelled(&r.title, &r.unit));
    let ((left, right, step_x), (low, high, step_y)) = (axis_around(&across), axis_around(&up));
    let layout = layout
        .with_x_axis_min(left)
        .with_x_axis_max(right)
        .with_x_tick_step(step_x)
        .with_y_axis_min(low)
        .with_y_axis_max(high)
        .with_y_tick_step(step_y);
    Some(render(plots, layout, name))
}

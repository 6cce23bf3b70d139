//! Style of all figures, and what kuva's SVG needs to live in one page with others.

use kuva::prelude::*;

/// Start design: grey.
pub const START: &str = "#8a8a8a";
/// Design found: blue (Okabe and Ito's colour-blind safe palette, as all colours here).
pub const FOUND: &str = "#0072B2";
/// Second curve of the same design: vermilion.
pub const SECOND: &str = "#D55E00";
/// Third curve of the same design: bluish green.
pub const THIRD: &str = "#009E73";
/// Fourth curve of the same design: sky blue.
pub const SKY: &str = "#56B4E9";
/// Limits: black.
pub const LIMIT: &str = "#222222";

/// Width of a figure in pixels.
pub const WIDTH: f64 = 720.0;
/// Width of a figure beside another.
pub const HALF_WIDTH: f64 = 504.0;
/// Height of a curve figure in pixels.
pub const HEIGHT: f64 = 300.0;
/// Height of a figure beside another.
const HALF_HEIGHT: f64 = 270.0;

/// Common style of a figure.
pub fn styled(layout: Layout) -> Layout {
    let theme = Theme {
        background: "none".into(),
        grid_color: "#e4e4e4".into(),
        legend_border: "#cccccc".into(),
        ..Theme::light()
    };
    layout
        .with_theme(theme)
        .with_font_family("system-ui, sans-serif")
        .with_label_size(13)
        .with_tick_size(11)
        .with_body_size(12)
        .with_width(WIDTH)
        .with_height(HEIGHT)
}

/// A figure that stands beside another; its legend lies below it.
pub fn half(layout: Layout) -> Layout {
    legend_below(layout).with_width(HALF_WIDTH).with_height(HALF_HEIGHT).with_label_size(12)
}

/// Puts the legend below the figure, where it hides nothing.
pub fn legend_below(layout: Layout) -> Layout {
    layout.with_legend_position(LegendPosition::OutsideBottomColumns).with_legend_box(false)
}

/// A crank angle axis over one cycle.
pub fn over_cycle(layout: Layout, cycle_deg: f64) -> Layout {
    layout
        .with_x_label("crank angle after firing TDC [deg]")
        .with_x_axis_min(0.0)
        .with_x_axis_max(cycle_deg)
        .with_x_tick_step(cycle_deg / 8.0)
        .with_x_tick_format(TickFormat::Integer)
}

/// Upper end of an axis that starts at zero, with some room above all of `values`, and a step for its ticks.
pub fn axis(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    up_to(1.04, values)
}

/// Like [`axis`], without room: the last value may stand at the end.
pub fn tight_axis(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    up_to(1.0 - 1e-9, values)
}

/// Ends and step of an axis around values that need not begin at zero; no value stands on an end.
pub fn axis_around(values: &[f64]) -> (f64, f64, f64) {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let span = (high - low).max(1e-3 * high.abs().max(low.abs())).max(1e-12);
    let step = nice(span / 5.0);
    (((low - 0.1 * span) / step).floor() * step, ((high + 0.1 * span) / step).ceil() * step, step)
}

/// The next larger step that reads well.
fn nice(raw: f64) -> f64 {
    let decade = 10f64.powf(raw.log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|m| m * decade).find(|s| *s >= raw).unwrap_or(raw)
}

fn up_to(room: f64, values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let top = values.into_iter().filter(|v| v.is_finite()).fold(0.0f64, f64::max).max(1e-12);
    let step = nice(top / 5.0);
    ((top * room / step).ceil() * step, step)
}

/// Renders plots; clip paths get names that are unique in the page and the same on every run.
pub fn render(plots: Vec<Plot>, layout: Layout, name: &str) -> String {
    finish(&render_to_svg(plots, layout), name)
}

fn finish(svg: &str, name: &str) -> String {
    let ids: Vec<&str> = svg.split("<clipPath id=\"").skip(1).filter_map(|p| p.split('"').next()).collect();
    let mut out = svg.to_owned();
    for (k, id) in ids.iter().enumerate() {
        out = out
            .replace(&format!("id=\"{id}\""), &format!("id=\"{name}-{k}\""))
            .replace(&format!("url(#{id})"), &format!("url(#{name}-{k})"));
    }
    let head = out[..out.find('>').unwrap_or(0)].to_owned();
    let size =
        |key: &str| head.split(&format!(" {key}=\"")).nth(1).and_then(|s| s.split('"').next()).unwrap_or("0");
    let view = format!("<svg role=\"img\" viewBox=\"0 0 {} {}\" ", size("width"), size("height"));
    out.replacen("<svg ", &view, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_inside_a_figure_are_stable_and_its_size_is_a_view_box() {
        let svg = |name| {
            let plots: Vec<Plot> = vec![LinePlot::new().with_data([(0.0, 1.0), (1.0, 2.0)]).into()];
            let layout = styled(Layout::auto_from_plots(&plots));
            render(plots, layout, name)
        };
        assert_eq!(svg("a"), svg("a"));
        assert!(svg("a").contains("viewBox=\"0 0 720 300\""));
        assert!(!svg("b").contains("kuva-clip"));
    }

    #[test]
    fn axes_start_at_zero_and_end_on_a_tick() {
        assert_eq!(axis([3.0, 8.7]), (10.0, 2.0));
        let (top, step) = axis([307.0]);
        assert!(top >= 307.0 && (top / step).fract() == 0.0);
        assert_eq!(tight_axis([0.3, 0.98]).0, 1.0);
        assert_eq!(tight_axis([1500.0]).0, 1500.0);
        assert_eq!(axis_around(&[70.0, 130.0]), (60.0, 140.0, 20.0));
        let (low, high, _) = axis_around(&[-0.01, 0.01]);
        assert!(low < -0.01 && high > 0.01);
    }
}

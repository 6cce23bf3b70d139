//! Working cycles of two designs in the same figures, read back from their `orbit.csv`: A grey, B blue, on one scale.

use super::super::data::TOUCH_MPA;
use super::super::figures::in_clearance_circle;
use super::super::svg::{FOUND, START, axis, half, legend_below, over_cycle, render, styled};
use kuva::prelude::*;
use serde::{Deserialize, Serialize};

/// Relative difference up to which a cycle is that of a report: `orbit.csv` has ten digits.
const SAME: f64 = 1e-6;

/// A step of a cycle, by the columns of `orbit.csv`.
#[derive(Debug, Deserialize)]
struct Step {
    bearing: String,
    operating_point: String,
    crank_angle_deg: f64,
    eccentricity_x_ratio: f64,
    eccentricity_y_ratio: f64,
    film_thickness_min_um: f64,
    film_pressure_max_mpa: f64,
    contact_pressure_max_mpa: f64,
    friction_loss_w: f64,
    contact_loss_w: f64,
}

/// A working cycle of one bearing at one operating point.
#[derive(Debug)]
pub struct Cycle {
    /// Bearing.
    pub bearing: String,
    /// Operating point.
    pub operating_point: String,
    steps: Vec<Step>,
}

/// Figures of one bearing at one operating point, as SVG.
#[derive(Debug, Serialize)]
pub struct CycleOverlay {
    bearing: String,
    operating_point: String,
    orbit: String,
    film: String,
    pressure: String,
    loss: String,
    /// Hydrodynamic and contact part of the loss, where the surfaces touch.
    parts: Option<String>,
}

/// A number of every step.
type Of = fn(&Step) -> f64;

impl Step {
    fn is_finite(&self) -> bool {
        let numbers = [
            self.crank_angle_deg,
            self.eccentricity_x_ratio,
            self.eccentricity_y_ratio,
            self.film_thickness_min_um,
            self.film_pressure_max_mpa,
            self.contact_pressure_max_mpa,
            self.friction_loss_w,
            self.contact_loss_w,
        ];
        numbers.iter().all(|v| v.is_finite())
    }

    fn hydrodynamic_loss_w(&self) -> f64 {
        self.friction_loss_w - self.contact_loss_w
    }
}

/// The cycles of an `orbit.csv`; in words, why they cannot be read.
pub fn cycles(text: &str) -> Result<Vec<Cycle>, String> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut found: Vec<Cycle> = Vec::new();
    for (k, step) in reader.deserialize::<Step>().enumerate() {
        let step = step.map_err(|e| e.to_string())?;
        if !step.is_finite() {
            return Err(format!("row {} holds a number that is none", k + 1));
        }
        match found.last_mut().filter(|c| c.is_of(&step.bearing, &step.operating_point)) {
            Some(cycle) => cycle.steps.push(step),
            None => found.push(Cycle {
                bearing: step.bearing.clone(),
                operating_point: step.operating_point.clone(),
                steps: vec![step],
            }),
        }
    }
    let stuck = found.iter().find(|c| c.end_deg() <= 0.0);
    let told = stuck.map(|c| format!("{}, {} has no crank angles that grow", c.bearing, c.operating_point));
    told.map_or(Ok(found), Err)
}

impl Cycle {
    /// Whether it is that of a bearing at an operating point.
    pub fn is_of(&self, bearing: &str, operating_point: &str) -> bool {
        (self.bearing.as_str(), self.operating_point.as_str()) == (bearing, operating_point)
    }

    /// Whether its smallest film is that of a report.
    pub fn has_film(&self, smallest_um: f64) -> bool {
        let found = self.steps.iter().map(|s| s.film_thickness_min_um).fold(f64::INFINITY, f64::min);
        (found - smallest_um).abs() <= SAME * smallest_um.abs()
    }

    /// Where the first step comes again.
    fn end_deg(&self) -> f64 {
        let n = self.steps.len() as f64;
        let last = self.steps.last().map_or(0.0, |s| s.crank_angle_deg);
        (last * n / (n - 1.0).max(1.0)).round()
    }

    /// A curve that closes.
    fn curve(&self, of: Of) -> Vec<(f64, f64)> {
        let end = self.steps.first().map(|s| (self.end_deg(), of(s)));
        self.steps.iter().map(|s| (s.crank_angle_deg, of(s))).chain(end).collect()
    }

    fn path(&self) -> Vec<(f64, f64)> {
        let place = |s: &Step| (s.eccentricity_x_ratio, s.eccentricity_y_ratio);
        self.steps.iter().chain(self.steps.first()).map(place).collect()
    }

    fn touches(&self) -> bool {
        self.steps.iter().any(|s| s.contact_pressure_max_mpa > TOUCH_MPA)
    }
}

/// Figures of every bearing and operating point that both have.
pub fn overlays(a: &[Cycle], b: &[Cycle]) -> Vec<CycleOverlay> {
    let partner = |x: &Cycle| b.iter().find(|y| y.is_of(&x.bearing, &x.operating_point));
    a.iter()
        .filter_map(|x| Some((x, partner(x)?)))
        .enumerate()
        .map(|(k, (x, y))| CycleOverlay::draw(x, y, k + 1))
        .collect()
}

impl CycleOverlay {
    fn draw(a: &Cycle, b: &Cycle, k: usize) -> Self {
        let one = |of: Of, frame: fn(Layout) -> Layout, label: &str, name: &str| {
            let series = [Series::new(a, of, START, "A"), Series::new(b, of, FOUND, "B")];
            over_angle(&series, frame, label, &format!("{name}-{k}"))
        };
        Self {
            bearing: a.bearing.clone(),
            operating_point: a.operating_point.clone(),
            orbit: orbit(a, b, &format!("orbit-{k}")),
            film: one(|s| s.film_thickness_min_um, half, "film thickness [µm]", "film"),
            pressure: one(|s| s.film_pressure_max_mpa, half, "film pressure [MPa]", "pressure"),
            loss: one(|s| s.friction_loss_w, legend_below, "friction loss [W]", "loss"),
            parts: (a.touches() || b.touches()).then(|| parts(a, b, &format!("parts-{k}"))),
        }
    }
}

/// A curve over the cycle; parts of another one are dashed.
struct Series<'c> {
    cycle: &'c Cycle,
    of: Of,
    colour: &'static str,
    legend: &'static str,
    dashed: bool,
}

impl<'c> Series<'c> {
    fn new(cycle: &'c Cycle, of: Of, colour: &'static str, legend: &'static str) -> Self {
        Self { cycle, of, colour, legend, dashed: false }
    }

    fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    fn plot(&self) -> Plot {
        let line = line(self.cycle.curve(self.of), self.colour).with_legend(self.legend);
        if self.dashed { line.with_dashed().into() } else { line.into() }
    }
}

fn line(points: Vec<(f64, f64)>, colour: &str) -> LinePlot {
    LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.8)
}

/// Hydrodynamic and contact part of the friction loss.
fn parts(a: &Cycle, b: &Cycle, name: &str) -> String {
    let contact: Of = |s| s.contact_loss_w;
    let series = [
        Series::new(a, Step::hydrodynamic_loss_w, START, "A: hydrodynamic"),
        Series::new(b, Step::hydrodynamic_loss_w, FOUND, "B: hydrodynamic"),
        Series::new(a, contact, START, "A: contact").dashed(),
        Series::new(b, contact, FOUND, "B: contact").dashed(),
    ];
    over_angle(&series, legend_below, "parts of the friction loss [W]", name)
}

fn over_angle(series: &[Series<'_>], frame: fn(Layout) -> Layout, label: &str, name: &str) -> String {
    let plots: Vec<Plot> = series.iter().map(Series::plot).collect();
    let end = series.iter().map(|s| s.cycle.end_deg()).fold(0.0, f64::max);
    let (top, step) = axis(series.iter().flat_map(|s| s.cycle.steps.iter().map(s.of)));
    let layout = over_cycle(frame(styled(Layout::auto_from_plots(&plots))), end)
        .with_y_label(label)
        .with_y_axis_min(0.0)
        .with_y_axis_max(top)
        .with_y_tick_step(step);
    render(plots, layout, name)
}

/// Orbits of the journal in the clearance circle, at equal scale.
fn orbit(a: &Cycle, b: &Cycle, name: &str) -> String {
    let paths: Vec<Plot> =
        vec![line(a.path(), START).with_legend("A").into(), line(b.path(), FOUND).with_legend("B").into()];
    in_clearance_circle(paths, name)
}

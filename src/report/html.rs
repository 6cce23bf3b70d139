//! `report.html`: one self-contained page, the answer first, then the evidence.

use super::data::TOUCH_MPA;
use super::figures::Tops;
use super::maps::Frame;
use super::{BearingRunningIn, Findings, Report, ReportFile, figures, maps, run_in_figures};
use minijinja::value::Serde;
use minijinja::{Environment, Value, context};
use serde::Serialize;

/// The page of an answer that has none of its own.
const PLAIN: &str = "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{{ title }}</title>\n\
    <style>{{ style|safe }}</style></head>\n<body><header><h1>{{ title }}</h1></header>\n<main><pre>{{ text }}</pre></main></body>\n</html>\n";
const TEMPLATE: &str = include_str!("report.html.j2");
/// Beginning and end of all reports.
const HEAD: &str = include_str!("head.html.j2");
const FOOT: &str = include_str!("foot.html.j2");
/// Style of all pages.
pub(super) const STYLE: &str = include_str!("style.css");

/// Figures of one working cycle.
#[derive(Serialize)]
struct CycleFigures {
    bearing: String,
    operating_point: String,
    orbit: String,
    film: String,
    pressure: String,
    contact: Option<String>,
    loss: String,
    load: String,
    pressure_map: String,
    fill_map: Option<String>,
    shape_map: Option<String>,
    sensitivity_maps: Option<[String; 2]>,
}

/// Figures of one running-in; none where it failed.
#[derive(Serialize, Default)]
struct RunningInFigures {
    loss: Option<String>,
    share: Option<String>,
    depth: Option<String>,
    map: Option<String>,
    journal_map: Option<String>,
    profile: Option<String>,
    stribeck: Option<String>,
}

impl RunningInFigures {
    fn of((k, b): (usize, &BearingRunningIn)) -> Self {
        if b.blocks.is_empty() {
            return Self::default();
        }
        Self {
            loss: Some(run_in_figures::loss(b, &format!("running-in-loss-{k}"))),
            share: Some(run_in_figures::share(b, &format!("running-in-share-{k}"))),
            depth: Some(run_in_figures::depth(b, &format!("running-in-depth-{k}"))),
            map: maps::wear_map(b, Frame::Shell, &format!("wear-{k}")),
            journal_map: maps::wear_map(b, Frame::Journal, &format!("journal-wear-{k}")),
            profile: b.profile.as_ref().map(|p| run_in_figures::profile(p, &format!("profile-{k}"))),
            stribeck: run_in_figures::stribeck(&b.stribeck, &format!("stribeck-{k}")),
        }
    }
}

/// Figures of every cycle.
fn cycle_figures(findings: &Findings) -> Vec<CycleFigures> {
    let report = &findings.report;
    let limit = |quantity: &str, bearing: &str| {
        report.constraints.iter().find(|c| c.quantity == quantity && c.bearing == bearing).map(|c| c.limit)
    };
    findings
        .curves
        .iter()
        .enumerate()
        .map(|(k, c)| (k, c, Tops::of(findings.curves.iter().filter(|o| o.bearing == c.bearing))))
        .map(|(k, c, tops)| CycleFigures {
            bearing: c.bearing.clone(),
            operating_point: c.operating_point.clone(),
            orbit: figures::orbit(c, &format!("orbit-{k}")),
            film: figures::film(c, limit("min-film-thickness", &c.bearing), &tops, &format!("film-{k}")),
            pressure: figures::pressure(
                c,
                limit("max-film-pressure", &c.bearing),
                &tops,
                &format!("pressure-{k}"),
            ),
            contact: c.touches().then(|| {
                figures::contact(c, limit("max-contact-pressure", &c.bearing), &tops, &format!("contact-{k}"))
            }),
            loss: figures::loss(c, &tops, &format!("loss-{k}")),
            load: figures::load(c, &tops, &format!("load-{k}")),
            pressure_map: maps::pressure_map(c, tops.map_mpa, &format!("map-{k}")),
            fill_map: maps::fill_map(c, &format!("fill-{k}")),
            shape_map: maps::shape_map(c, &format!("shape-{k}")),
            sensitivity_maps: maps::sensitivity_maps(c, &format!("sensitivity-{k}")),
        })
        .collect()
}

/// All figures of a page, drawn once.
#[derive(Serialize)]
pub(super) struct Figures {
    cycles: Vec<CycleFigures>,
    running_in: Vec<RunningInFigures>,
    convergence: Option<String>,
    front: Option<String>,
    cylinder: Option<String>,
}

impl Figures {
    /// Draws those of a report.
    pub fn of(findings: &Findings) -> Self {
        let report = &findings.report;
        let bearings = report.running_in.iter().flat_map(|r| &r.bearings);
        let searched = !report.history.is_empty();
        Self {
            cycles: cycle_figures(findings),
            running_in: bearings.enumerate().map(RunningInFigures::of).collect(),
            convergence: searched.then(|| figures::convergence(report, "convergence")),
            front: report.pareto.as_ref().map(|p| figures::front(p, "front")),
            cylinder: (!findings.cylinder.is_empty())
                .then(|| figures::cylinder(&findings.cylinder, "cylinder")),
        }
    }

    /// They one by one, as SVG: `orbit-1.svg` and so on, numbered by cycle or bearing.
    pub fn files(&self) -> Vec<ReportFile> {
        let mut all = Vec::new();
        let mut add = |name: String, text: &str| {
            if text.starts_with("<svg") {
                all.push(ReportFile {
                    name: format!("{}.svg", name.replace('_', "-")),
                    text: text.to_owned(),
                });
            }
        };
        let cycles = self.cycles.iter().map(|c| (String::new(), serde_json::to_value(c)));
        let bearings = self.running_in.iter().map(|b| ("running-in-".to_owned(), serde_json::to_value(b)));
        for list in [cycles.collect::<Vec<_>>(), bearings.collect()] {
            for (k, (prefix, figures)) in list.into_iter().enumerate() {
                let Ok(serde_json::Value::Object(figures)) = figures else { continue };
                for (name, figure) in figures {
                    match figure {
                        serde_json::Value::String(text) => add(format!("{prefix}{name}-{}", k + 1), &text),
                        serde_json::Value::Array(surfaces) => {
                            for (text, surface) in surfaces.iter().zip(["shell", "journal"]) {
                                let text = text.as_str().unwrap_or_default();
                                add(format!("{prefix}{name}-{surface}-{}", k + 1), text);
                            }
                        }
                        _ => {}
                    }
                }
            }
        }
        for (name, figure) in
            [("convergence", &self.convergence), ("front", &self.front), ("cylinder", &self.cylinder)]
        {
            figure.iter().for_each(|text| add(name.to_owned(), text));
        }
        all
    }

    /// The page with them.
    pub fn page(&self, report: &Report) -> Result<String, minijinja::Error> {
        let study = toml::to_string(&report.provenance.study).unwrap_or_default();
        let mut environment = environment();
        environment.add_template("report", TEMPLATE)?;
        environment.get_template("report")?.render(context! {
            r => Value::from(Serde(report)),
            figures => Value::from(Serde(self)),
            touch_mpa => TOUCH_MPA,
            style => STYLE,
            study,
        })
    }
}

/// The page as text.
pub fn html(findings: &Findings) -> Result<String, minijinja::Error> {
    Figures::of(findings).page(&findings.report)
}

/// An answer that has no page of its own, as it is.
pub fn plain_page(title: &str, text: &str) -> Result<String, minijinja::Error> {
    let mut environment = environment();
    environment.add_template("plain", PLAIN)?;
    environment.get_template("plain")?.render(context! { title, text, style => STYLE })
}

/// What all templates can use.
pub(super) fn environment() -> Environment<'static> {
    let mut environment = Environment::new();
    for (name, text) in [("head", HEAD), ("foot", FOOT)] {
        environment.add_template(name, text).expect("the templates of this program are well written");
    }
    environment.set_auto_escape_callback(|_| minijinja::AutoEscape::Html);
    environment.add_filter("sig", significant);
    environment.add_filter("sci", |v: f64| format!("{v:.1e}"));
    environment.add_filter("units", |text: String| units(&text));
    environment.add_filter("plain", plain);
    environment.add_filter("link", link);
    environment.add_filter("words", |s: String| s.replace('-', " "));
    environment
}

/// A number with four significant digits, or a dash for none.
fn significant(value: Value) -> String {
    f64::try_from(value).map_or_else(|_| "–".to_owned(), super::short)
}

/// A value as it is: numbers with six significant digits, so that a miss can be seen.
fn plain(value: Value) -> String {
    match f64::try_from(value.clone()) {
        Ok(number) if value.kind() == minijinja::value::ValueKind::Number => {
            format!("{}", format!("{number:.5e}").parse::<f64>().unwrap_or(number))
        }
        _ if value.is_none() || value.is_undefined() => "–".to_owned(),
        _ => value.to_string(),
    }
}

/// A file name as it stands in a link.
fn link(name: &str) -> String {
    let kept = |b: u8| b.is_ascii_alphanumeric() || b"._-".contains(&b);
    name.bytes().map(|b| if kept(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}

/// A unit, or a sentence with units, as it is written in text; words that only contain their letters stay.
pub(super) fn units(text: &str) -> String {
    let apart = |c: char| !c.is_alphanumeric();
    let word = |piece: &str| {
        let (word, end) = piece.split_at(piece.find(apart).unwrap_or(piece.len()));
        let word = match word {
            "um" => "µm",
            "degC" => "°C",
            "mm3" => "mm³",
            other => other,
        };
        format!("{word}{end}")
    };
    text.split_inclusive(apart).map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_in_sentences_are_typeset_and_words_stay() {
        let text = "a minimum of 3 um (9 W per um), 5 mm3/h at 80 degC.";
        assert_eq!(units(text), "a minimum of 3 µm (9 W per µm), 5 mm³/h at 80 °C.");
        assert_eq!(units("W/(um cm2)"), "W/(µm cm2)");
    }

    #[test]
    fn names_of_files_are_links() {
        assert_eq!(link("a b-1.toml"), "a%20b-1.toml");
    }
}

//! The page and the files of two reports side by side.

use super::super::html::{STYLE, environment};
use super::super::svg::{FOUND, START};
use super::super::{Files, ReportFile};
use super::figures::{Cycle, CycleOverlay, cycles, overlays};
use super::{LeafComparison, LeafDifference, Side, SideBySide};
use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;

const TEMPLATE: &str = include_str!("page.html.j2");

/// A leaf that differs, as text.
#[derive(Serialize)]
struct LeafRow<'l> {
    path: &'l str,
    a: Option<String>,
    b: Option<String>,
    relative_percent: Option<f64>,
}

impl<'l> LeafRow<'l> {
    fn of(leaf: &'l LeafDifference) -> Self {
        let [a, b] = leaf.words();
        Self { path: &leaf.path, a, b, relative_percent: leaf.relative.map(|r| 100.0 * r) }
    }
}

fn leaf_rows(found: &LeafComparison) -> Vec<LeafRow<'_>> {
    found.rows.iter().map(LeafRow::of).collect()
}

/// The cycles beside a report; in words, why there are none.
fn cycles_of(name: &str, side: &Side) -> Result<Vec<Cycle>, String> {
    let text = side.orbit_csv.as_ref().ok_or_else(|| format!("there is no orbit.csv beside {name}"))?;
    let found = cycles(text).map_err(|e| format!("the orbit.csv beside {name} cannot be read: {e}"))?;
    let orbits = side.report.get("orbit").and_then(serde_json::Value::as_array);
    let belongs = |orbit: &serde_json::Value| {
        let text = |key: &str| orbit.get(key).and_then(serde_json::Value::as_str).unwrap_or_default();
        let film = orbit.pointer("/min_film_thickness_um/value").and_then(serde_json::Value::as_f64);
        let cycle = found.iter().find(|c| c.is_of(text("bearing"), text("operating_point")));
        cycle.zip(film).is_some_and(|(cycle, film)| cycle.has_film(film))
    };
    if orbits.into_iter().flatten().all(belongs) {
        Ok(found)
    } else {
        Err(format!("the orbit.csv beside {name} belongs to another report"))
    }
}

/// Figures of two designs; in words, why there are none.
fn figures(a: &Side, b: &Side) -> Result<Vec<CycleOverlay>, String> {
    match (cycles_of("A", a), cycles_of("B", b)) {
        (Ok(a), Ok(b)) => {
            let all = overlays(&a, &b);
            let none = || "A and B have no bearing and operating point in common".to_owned();
            if all.is_empty() { Err(none()) } else { Ok(all) }
        }
        (a, b) => Err([a.err(), b.err()].into_iter().flatten().collect::<Vec<_>>().join("; ")),
    }
}

/// The page as text.
pub fn side_by_side_html(found: &SideBySide, a: &Side, b: &Side) -> Result<String, minijinja::Error> {
    let (figures, unshown) = match found.design.as_ref().map(|_| figures(a, b)) {
        Some(Ok(figures)) => (figures, None),
        Some(Err(why)) => (Vec::new(), Some(why)),
        None => (Vec::new(), None),
    };
    let title = match found.a.title == found.b.title {
        true => format!("{}: two reports side by side", found.a.title),
        false => format!("{} | {}", found.a.title, found.b.title),
    };
    let content = found.content.as_ref();
    let mut environment = environment();
    environment.add_template("side_by_side", TEMPLATE)?;
    environment.get_template("side_by_side")?.render(context! {
        r => context! { title, provenance => context! { coarse => false } },
        found => Value::from(Serde(found)),
        figures => Value::from(Serde(figures)),
        unshown,
        content => Value::from(Serde(content.map(leaf_rows))),
        inputs => Value::from(Serde(leaf_rows(&found.inputs))),
        counted => content.map(LeafComparison::counted),
        colour_a => START,
        colour_b => FOUND,
        style => STYLE,
    })
}

/// Their files: `compare.json` and `compare.html`.
pub fn side_by_side_files(found: &SideBySide, a: &Side, b: &Side) -> std::io::Result<Vec<ReportFile>> {
    let mut all = Files::default();
    all.add("compare.json", serde_json::to_string_pretty(found).map(|text| text + "\n"))?;
    all.add("compare.html", side_by_side_html(found, a, b))?;
    Ok(all.0)
}

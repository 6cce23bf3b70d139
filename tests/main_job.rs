//! The main job: from the measured indicator diagram to the optimised bearing.

use crate::common::{COARSE, here, main_study, quietly, smooth_study};
use stribeck::cranktrain::{CylinderPressure, SliderCrank};
use stribeck::optimise::Outcome;
use stribeck::report::{self, AtBound, Findings};
use stribeck::study::run;

fn solve(changes: &[(&str, &str)]) -> Findings {
    let study = smooth_study(changes);
    quietly(|context| run(&study, context))
}

#[test]
fn the_measured_trace_has_the_stated_mean_effective_pressure_and_peak() {
    let text = std::fs::read_to_string(here("studies/data/engine_pressure_170x215_digitised.csv")).unwrap();
    let rows = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    let points: Vec<(f64, f64)> = rows
        .map(|l| l.split_once(',').unwrap())
        .map(|(a, p)| (a.parse().unwrap(), p.parse().unwrap()))
        .collect();
    assert_eq!(points.first().map(|p| p.1), points.last().map(|p| p.1), "the trace closes");
    let (angles, pressures) = points[..points.len() - 1]
        .iter()
        .map(|(a, p)| (a.to_radians(), p * 1e6))
        .unzip::<f64, f64, Vec<_>, Vec<_>>();
    let trace = CylinderPressure::from_table(angles, pressures).unwrap();
    let crank = SliderCrank { throw_m: 0.1075, rod_m: 0.1075 / 0.274, offset_m: 0.0 };
    assert!((trace.imep_pa(&crank) - 2.25e6).abs() <= 0.05e6, "{}", trace.imep_pa(&crank));
    let (peak, at) = trace.peak();
    assert!((peak - 20.8e6).abs() <= 0.15e6 && (at.to_degrees() - 6.4).abs() <= 1.0);
}

#[test]
fn the_main_study_converges_within_its_limits() {
    let end = quietly(|context| run(&main_study(&[]), context)).report;
    assert_eq!(end.outcome.status, Outcome::Converged, "{:?}", end.history);
    assert!(end.kkt.residual.unwrap() < 1e-6 && end.constraints.iter().all(|c| c.met));
    let (start, optimum) = (end.objective.start.unwrap(), end.objective.optimum.unwrap());
    assert!(optimum.total_w < start.total_w);
    let orbit = &end.orbit[0];
    assert!(orbit.film_temperature_c > 60.0, "the heat balance warms the film: {}", orbit.film_temperature_c);
    assert!(end.gradient.unwrap().rows.iter().all(|r| r.verdict.starts_with("exact")));
}

/// On the coarse mesh: that searches meet, and what a limit costs, is a matter of the optimiser and the gradient, not of the mesh.
#[test]
fn three_starts_lead_to_the_same_optimum() {
    let starts = [
        ("55 mm", "125 mm", "110 um", "75 degC"),
        ("46 mm", "113 mm", "170 um", "62 degC"),
        ("64 mm", "120 mm", "75 um", "88 degC"),
    ];
    let ends: Vec<Findings> = starts
        .iter()
        .map(|(w, d, c, t)| {
            let start = |name: &str, value: &str| format!("name = \"{name}\"\nstart = \"{value}\"");
            let names =
                ["big_end.width", "big_end.diameter", "big_end.diametral_clearance", "oil.inlet_temperature"];
            let old: Vec<String> = names.iter().map(|n| format!("name = \"{n}\"")).collect();
            let new: Vec<String> = names.iter().zip([w, d, c, t]).map(|(n, v)| start(n, v)).collect();
            let changes = old.iter().zip(&new).map(|(a, b)| (a.as_str(), b.as_str()));
            solve(&changes.chain([("[oil]", COARSE)]).collect::<Vec<_>>())
        })
        .collect();
    for end in &ends {
        let r = &end.report;
        assert_eq!(r.outcome.status, Outcome::Converged, "{:?}", r.history);
        assert!(r.kkt.residual.unwrap() < 1e-6);
        assert!(r.constraints.iter().all(|c| c.met));
        for (a, b) in r.design.iter().zip(&ends[0].report.design) {
            let width = a.upper - a.lower;
            assert!((a.value - b.value).abs() < 1e-4 * width, "{}: {} and {}", a.name, a.value, b.value);
        }
    }
    let first = &ends[0].report;
    let (start, optimum) = (first.objective.start.unwrap(), first.objective.optimum.unwrap());
    assert!(optimum.total_w < 0.8 * start.total_w);
    // The price of the film limit is the derivative of the optimum by the limit: check it by moving the limit.
    let active = first.constraints.iter().find(|c| c.active).unwrap().price_w_per_unit.unwrap();
    let moved = solve(&[("at_least = \"3 um\"", "at_least = \"2.97 um\""), ("[oil]", COARSE)]).report;
    let saved = optimum.total_w - moved.objective.optimum.unwrap().total_w;
    assert!((saved / 0.03 / active - 1.0).abs() < 0.03, "{saved} against {active}");
}

#[test]
fn report_json_follows_its_schema_and_a_rerun_gives_the_same_numbers() {
    let coarse = [("[oil]", COARSE)];
    let (first, second) = (solve(&coarse), solve(&coarse));
    let validator = jsonschema::validator_for(&report::schema::<report::Report>()).unwrap();
    let value = serde_json::to_value(&first.report).unwrap();
    let mistakes: Vec<String> =
        validator.iter_errors(&value).map(|e| format!("{e} at {}", e.instance_path)).collect();
    assert!(mistakes.is_empty(), "{mistakes:?}");
    let timeless = |f: &Findings| {
        let mut f = f.clone();
        f.report.timing.seconds = 0.0;
        f
    };
    let (first, second) = (timeless(&first), timeless(&second));
    assert_eq!(first, second);
    assert_eq!(report::html(&first).unwrap(), report::html(&second).unwrap());
    let read: report::Report = serde_json::from_value(serde_json::to_value(&first.report).unwrap()).unwrap();
    assert_eq!(read.design, first.report.design);
}

#[test]
fn every_key_of_the_report_is_documented() {
    let api = std::fs::read_to_string(here("api.md")).unwrap();
    let schema = report::schema::<report::Report>();
    for key in schema["properties"].as_object().unwrap().keys() {
        assert!(api.contains(&format!("`{key}`")), "api.md does not document `{key}` of report.json");
    }
}

#[test]
fn the_page_is_self_contained() {
    let page = report::html(&solve(&[("[oil]", COARSE)])).unwrap();
    for outside in ["src=\"http", "href=\"http", "@import", "<script", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("<svg role=\"img\" viewBox=") && page.contains("What limits it"));
    assert!(!page.contains("NaN"), "a figure or table shows a number that is none");
}

#[test]
fn a_wiebe_cycle_instead_of_a_trace_gives_a_design_too() {
    let wiebe = r#"source = "wiebe"
compression_ratio = 14
charge_pressure = "3.9 bar"
charge_temperature = "330 K"
heat_release = "26 kJ"
combustion_start = "-3 deg"
combustion_duration = "70 deg"
"#;
    let table = "source = \"table\"\ntable.file = \"data/engine_pressure_170x215_digitised.csv\"\n";
    let end = solve(&[(table, wiebe), ("[oil]", COARSE)]).report;
    assert_eq!(end.outcome.status, Outcome::Converged);
    assert!(end.design.iter().any(|d| d.at_bound != AtBound::No));
}

#[test]
fn contradicting_limits_end_as_infeasible_and_a_short_leash_as_iteration_limit() {
    let end = solve(&[("[oil]", COARSE), ("at_least = \"3 um\"", "at_least = \"30 um\"")]).report;
    assert_eq!(end.outcome.status, Outcome::Infeasible, "{:?}", end.history);
    assert!(end.constraints.iter().any(|c| !c.met));
    let end = solve(&[("[oil]", COARSE), ("[oil]", "[optimiser]\nmax_iterations = 1\n[oil]")]).report;
    assert_eq!(end.outcome.status, Outcome::IterationLimit);
}

//! The comparison of the gradient engines as a study: figures, files, reruns, and what it refuses.

use crate::common::{here, merged, quietly};
use stribeck::gradient::{EngineName, Finding};
use stribeck::report::{Comparison, ComparisonStatus, comparison_files, comparison_html, write_folder};
use stribeck::study::{Format, Study, compare, schema};

/// The study of the engines on a coarse mesh, few perturbations, with more sections.
fn coarse(sections: &str) -> Study {
    let text = std::fs::read_to_string(here("studies/gradient-engines.toml")).unwrap();
    let text = merged(&format!("{text}\n{COARSE}\n{sections}"));
    Study::read(&text, Format::Toml, Some(&here("studies")))
        .unwrap_or_else(|e| panic!("{e}: {:#?}", e.faults))
}

/// [`crate::common::COARSE`] without its last section and with half its steps (agreement and counts of engines are those of any discrete
/// cycle, fine or coarse), and a short comparison.
const COARSE: &str = "[film]\ncells_around = 36\ncells_across_half = 4\n[orbit]\nsteps_per_cycle = 120\n\
                      [comparison]\nperturbations = [1e-4, 1e-5, 1e-6]\nparameter_counts = [1, 4]\n";

fn compared(study: &Study) -> Comparison {
    quietly(|context| compare(study, context)).expect("the study has a comparison")
}

#[test]
fn the_engines_agree_and_the_cost_of_the_exact_ones_hardly_grows() {
    let study = coarse("[comparison]\nparameter_counts = [16, 1, 4]\n");
    let found = compared(&study);
    assert_eq!(found.status, ComparisonStatus::Complete, "{:?}", found.failures);
    let case = &found.cases[0];
    assert_eq!((case.proof.parameters.len(), case.proof.quantities.len()), (16, 4));
    for q in &case.proof.quantities {
        let best = q.best.iter().find(|b| b.engine == EngineName::Cen).unwrap();
        println!("{}: CEN {:.1e} at {:.0e}; {}", q.quantity, best.error, best.perturbation, q.verdict);
        assert!(q.mismatch <= 1e-9, "{}: TRA = ADJ to {:.1e}", q.quantity, q.mismatch);
        let named = q.finding == Finding::Kink && q.verdict.contains(" from ");
        assert!(best.error <= 1e-5 || named, "{}: {}", q.quantity, q.verdict);
        assert_ne!(q.finding, Finding::Wrong, "{}", q.verdict);
        assert_eq!(q.differences.len(), 3 * 3);
    }
    let cost = |engine, k| case.costs.iter().find(|c| c.engine == engine && c.parameters == k).unwrap().cost;
    let steps = study.orbit.steps as u64;
    for k in [1, 4, 16] {
        let (adj, tra) = (cost(EngineName::Adj, k), cost(EngineName::Tra, k));
        assert_eq!((adj.factorisations, tra.factorisations), (steps, steps), "each step is factorised once");
        assert_eq!((adj.simulations, tra.simulations), (0, 0));
        assert_eq!(cost(EngineName::Cen, k).simulations, 2 * k as u64);
        assert_eq!(adj.solves, cost(EngineName::Adj, 1).solves, "ADJ does not feel parameters");
        let cen = cost(EngineName::Cen, k);
        let both = cost(EngineName::Fw, k).factorisations + cost(EngineName::Bw, k).factorisations;
        // One-sided differences settle the point itself once more.
        assert!(both >= cen.factorisations && both - cen.factorisations < 2 * case.simulation.factorisations);
    }
    assert!(cost(EngineName::Tra, 16).solves < 16 * cost(EngineName::Tra, 1).solves);
    for (s, t) in case.speed_ups.iter().zip(&found.timing.cases[0].speed_ups) {
        let (s_adj, s_tra) = (s.adj.unwrap(), s.tra.unwrap());
        assert!(s_adj > s.parameters as f64 && s_tra > s.parameters as f64, "{s:?}");
        println!("{} parameters: {s_adj:.1} counted, {:.1} timed", s.parameters, t.adj.unwrap());
    }
}

/// That a rerun writes the same bytes is shown with all other kinds of report (`reports`).
#[test]
fn a_comparison_without_cen_has_no_speed_ups_and_is_read_back_as_it_was_written() {
    let found =
        compared(&coarse("[comparison]\nengines = [\"FW\", \"TRA\", \"ADJ\"]\nperturbations = [1e-5]\n"));
    assert!(found.timing.seconds > 0.0 && found.timing.cases.len() == 1);
    assert!(found.cases[0].speed_ups.is_empty(), "there is no speed-up without CEN");
    let text = |c: &Comparison| serde_json::to_string_pretty(c).unwrap();
    let read: Comparison = serde_json::from_str(&text(&found)).unwrap();
    assert_eq!(text(&read), text(&found));
}

#[test]
fn its_folder_is_complete_and_its_page_self_contained() {
    let found = compared(&coarse("[comparison]\nparameter_counts = [2]\nperturbations = [1e-4, 1e-6]\n"));
    let page = comparison_html(&found).unwrap();
    for outside in ["src=\"http", "href=\"http", "@import", "<script", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(!page.contains("NaN"), "a figure or table shows a number that is none");
    for words in [
        "error against ADJ",
        "number of parameters",
        "weakly active cells",
        "Taylor-remainder",
        "[comparison]",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let folder = tempfile::tempdir().unwrap();
    write_folder(&comparison_files(&found).unwrap(), folder.path()).unwrap();
    let lines = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap().lines().count();
    assert_eq!(lines("gradients.csv"), 1 + 4 * 16 * (2 + 3 * 2));
    assert_eq!(lines("errors.csv"), 1 + 4 * (1 + 3 * 2));
    assert_eq!(lines("taylor.csv"), 1 + 4 * 2 * 6);
    assert_eq!((lines("cost.csv"), lines("timing.csv")), (1 + 5, 1 + 5));
    assert!(folder.path().join("report.html").exists() && lines("report.json") > 100);
}

#[test]
fn the_study_printed_with_its_defaults_is_the_same_study() {
    let study = coarse("");
    let printed = study.to_toml();
    for default in ["engines = [", "aggregate_sharpness = 200", "perturbation = 0.000001"] {
        assert!(printed.contains(default), "{default} in\n{printed}");
    }
    assert!(!printed.contains("max_iterations"), "the search has no say");
    let again = Study::read(&printed, Format::Toml, Some(&here("studies"))).unwrap();
    assert_eq!((again.to_toml(), &again.hash), (printed, &study.hash));
    let validator = jsonschema::validator_for(&schema()).unwrap();
    assert!(validator.is_valid(&study.to_json()));
    let text = std::fs::read_to_string(here("studies/gradient-engines.toml")).unwrap();
    let plain = text.replace("parameter_counts = [1, 2, 4, 8, 16]\n", "");
    let plain = Study::read(&plain, Format::Toml, Some(&here("studies"))).unwrap();
    let defaults = plain.to_json()["comparison"].to_string();
    assert!(defaults.contains("[1,2,4,8,16]") && defaults.contains("[0.01,0.003,0.001,"), "{defaults}");
}

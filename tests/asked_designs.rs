//! What a user can ask of a search beside limits: the worst case, margins for what scatters, sums of parameters, choices from lists, a
//! warm start, a polish.

use crate::common::{COARSE, SMOOTH, copied_study, quietly, smooth_study};
use stribeck::optimise::{ConstrainedProblem, Curved, Outcome, Robust};
use stribeck::report::Report;
use stribeck::study::{Study, plan, run};

fn found(study: &Study) -> Report {
    quietly(|context| run(study, context)).report
}

const QUICK: (&str, &str) = ("[oil]", COARSE);

/// A second operating point that loses more than the rated one at the start, less at wide clearances.
const TWO_POINTS: (&str, &str) = (
    "name = \"rated\"",
    "name = \"part load\"\nspeed = \"900 rpm\"\nweight = 2.2\nload_factor = 0.4\n[[objective.operating_points]]\nname = \"rated\"",
);

#[test]
fn the_worst_case_is_no_larger_than_that_of_any_other_design() {
    let mean = [QUICK, TWO_POINTS];
    let report = found(&smooth_study(&mean));
    assert!(report.objective.worst_case.is_empty());
    // Weights of a mean are shares; those of the worst case are as written.
    let of = |r: &Report, k: usize| r.objective.operating_points[k].optimum.unwrap().total_w * [2.2, 1.0][k];
    let mean_design = of(&report, 0).max(of(&report, 1));
    let study = smooth_study(&[
        QUICK,
        ("[machine]", "[objective]\naggregate = \"worst-case\"\n[machine]"),
        TWO_POINTS,
    ]);
    let report = found(&study);
    assert_eq!(report.outcome.status, Outcome::Converged, "{:?}", report.outcome);
    let cases = &report.objective.worst_case;
    assert!((cases.iter().map(|c| c.share).sum::<f64>() - 1.0).abs() < 1e-9);
    let total = report.objective.optimum.unwrap().total_w;
    let largest = cases.iter().fold(0.0f64, |a, c| a.max(c.optimum_w));
    assert!((total / largest - 1.0).abs() < 1e-12);
    assert!(largest <= mean_design * (1.0 + 1e-6), "{largest} {mean_design}");
    for c in cases {
        assert!(c.share < 1e-4 || (c.optimum_w / largest - 1.0).abs() < 1e-5, "{cases:?}");
    }
    assert!(report.objective.start.unwrap().total_w >= largest);
}

const SCATTER: &str = "[robust]\nsamples = 40\n\
    [[robust.tolerances]]\nparameter = \"big_end.diametral_clearance\"\nstandard_deviation = \"3 um\"\n\
    [[robust.tolerances]]\nparameter = \"big_end.supply.pressure\"\nstandard_deviation = \"0.2 bar\"\n\
    [[robust.tolerances]]\nparameter = \"oil.inlet_temperature\"\nstandard_deviation = \"1 K\"\n";

#[test]
fn margins_are_what_drawn_bearings_show_and_the_design_keeps_them() {
    let with = format!("{SCATTER}{COARSE}");
    let study =
        crate::common::main_study(&[("[oil]", &with), ("at_least = \"3 um\"", "at_least = \"2 um\"")]);
    let report = found(&study);
    assert_eq!(report.outcome.status, Outcome::Converged, "{:?}", report.outcome);
    let robust = report.robust.as_ref().unwrap();
    assert_eq!((robust.failed, robust.tolerances.len()), (0, 3));
    let ratio = robust.sampled_deviation_w.unwrap() / robust.deviation_w;
    assert!((ratio - 1.0).abs() < 0.1, "{robust:?}");
    assert!((robust.sampled_mean_w.unwrap() / robust.nominal_w - 1.0).abs() < 0.01);
    let film = report.constraints.iter().position(|c| c.quantity == "min-film-thickness").unwrap();
    let (limit, drawn) = (&report.constraints[film], &robust.limits[film]);
    assert!((drawn.sampled_deviation.unwrap() / drawn.deviation - 1.0).abs() < 0.15, "{drawn:?}");
    // The limit holds with its margin, so hardly any bearing breaks it.
    assert!(limit.active && limit.met);
    let margin = limit.margin.unwrap();
    assert!((margin / (3.0 * drawn.deviation) - 1.0).abs() < 1e-6);
    assert!((limit.value.unwrap() - margin - 2.0).abs() < 1e-4, "{limit:?}");
    assert!(drawn.broken_percent.unwrap() <= 2.5);
    // The gradient by what scatters stands beside that by the parameters.
    let names = &report.gradient.as_ref().unwrap().rows[0].parameters;
    assert_eq!((names.len(), names[4].as_str()), (5, "big_end.supply.pressure"));
}

#[test]
fn gradients_of_margins_match_differences_of_margins() {
    let with = format!("{SCATTER}[film]\nmodel = \"mobility\"\n[orbit]\nsteps_per_cycle = 240\n[oil]");
    let with = with.replace(
        "[[robust.tolerances]]\nparameter = \"big_end.supply.pressure\"\nstandard_deviation = \"0.2 bar\"\n",
        "",
    );
    let study = smooth_study(&[("cavitation = \"swift-stieber\"\n", ""), ("[oil]", &with)]);
    quietly(|context| {
        let plan = plan(&study, study.engine, context).unwrap();
        let deviations = vec![0.0, 0.0, 3e-6, 1.0];
        let robust = Robust::new(&plan.problem, Vec::new(), deviations, 3.0);
        let slopes = robust.slopes(&plan.start).unwrap();
        for (j, p) in study.parameters.iter().enumerate() {
            let step = 1e-4 * (p.upper - p.lower);
            let side = |sign: f64| {
                let mut x = plan.start.clone();
                x[j] += sign * step;
                robust.values(&x).unwrap()
            };
            let (above, below) = (side(1.0), side(-1.0));
            let slope = (above.objective - below.objective) / (2.0 * step);
            let miss = (slopes.objective[j] / slope - 1.0).abs();
            assert!(miss < 1e-4, "{}: {} {slope}", p.name, slopes.objective[j]);
        }
        // A product of the problem itself is what its gradients do.
        let d = [0.0, 0.0, 1e-5, 0.0];
        let change = plan.problem.slopes_along(&plan.start, &d).unwrap();
        let side = |sign: f64| {
            let x: Vec<f64> = plan.start.iter().zip(d).map(|(x, d)| x + 0.01 * sign * d).collect();
            plan.problem.slopes(&x).unwrap()
        };
        let (above, below) = (side(1.0), side(-1.0));
        for j in 0..4 {
            let slope = (above.objective[j] - below.objective[j]) / 0.02;
            assert!((change.objective[j] / slope - 1.0).abs() < 1e-3, "{j}");
        }
    });
}

#[test]
fn sums_of_parameters_are_kept_and_their_price_is_what_moving_them_saves() {
    let with = |limit: &str| {
        let row = format!(
            "[[linear_constraints]]\nterms = [{{ parameter = \"big_end.width\", factor = 1.0 }}, {{ parameter = \"big_end.diametral_clearance\", factor = 50.0 }}]\nat_most = \"{limit} mm\"\n{COARSE}"
        );
        found(&smooth_study(&[("[oil]", &row)]))
    };
    let [below, at, above] = ["67.98", "68", "68.02"].map(with);
    for r in [&below, &at, &above] {
        assert_eq!(r.outcome.status, Outcome::Converged);
        let l = &r.linear_constraints[0];
        assert!(l.value <= l.limit + 1e-9 && l.active, "{l:?}");
        assert_eq!(l.sum, "big_end.width + 50 * big_end.diametral_clearance");
    }
    let total = |r: &Report| r.objective.optimum.unwrap().total_w;
    let price = at.linear_constraints[0].price_w_per_unit.unwrap();
    let saved = (total(&below) - total(&above)) / 0.04;
    assert!((price / saved - 1.0).abs() < 0.05, "{price} {saved}");
}

#[test]
fn the_best_of_a_list_is_what_it_is_when_searched_alone() {
    let option = |name: &str, at_40: u32, at_100: f64| {
        format!(
            "[[choices.options]]\nname = \"{name}\"\nset = {{ \"oil.kinematic_viscosity_40c\" = \"{at_40} mm2/s\", \"oil.kinematic_viscosity_100c\" = \"{at_100} mm2/s\" }}\n"
        )
    };
    let thin = option("thin", 104, 11.8);
    let list = format!("[[choices]]\nname = \"oil\"\n{}{thin}{COARSE}", option("thick", 220, 19.0));
    let study = smooth_study(&[("[oil]", &list)]);
    let report = found(&study);
    let choices = report.choices.as_ref().unwrap();
    assert_eq!(choices.runs.len(), 2);
    assert_eq!(report.study_hash, study.hash);
    let alone = |at_40: &str, at_100: &str| {
        let oil = [QUICK, ("\"139 mm2/s\"", at_40), ("\"14 mm2/s\"", at_100)];
        found(&smooth_study(&oil)).objective.optimum.unwrap().total_w
    };
    let losses = [alone("\"220 mm2/s\"", "\"19 mm2/s\""), alone("\"104 mm2/s\"", "\"11.8 mm2/s\"")];
    for (run, loss) in choices.runs.iter().zip(losses) {
        assert!((run.loss_w.unwrap() / loss - 1.0).abs() < 1e-6, "{run:?} {loss}");
    }
    let best = losses[0].min(losses[1]);
    assert!((report.objective.optimum.unwrap().total_w / best - 1.0).abs() < 1e-6);
    let taken = if losses[0] < losses[1] { "thick" } else { "thin" };
    assert_eq!(choices.taken[0].taken, taken);
}

#[test]
fn a_run_starts_from_the_design_of_an_earlier_report() {
    let folder = tempfile::tempdir().unwrap();
    let file = copied_study(folder.path(), SMOOTH, &[QUICK]);
    let stribeck = || {
        let mut command = assert_cmd::Command::cargo_bin("stribeck").unwrap();
        command.arg("run").arg(&file).arg("--json").arg("--out").arg(folder.path().join("out"));
        command
    };
    let read = |command: &mut assert_cmd::Command| -> Report {
        serde_json::from_slice(&command.assert().success().get_output().stdout).unwrap()
    };
    let first = read(&mut stribeck());
    let earlier = folder.path().join("earlier.json");
    std::fs::write(&earlier, serde_json::to_string(&first).unwrap()).unwrap();
    let again = read(stribeck().arg("--start-from").arg(&earlier));
    assert!(again.history.len() < first.history.len() && again.history.last().unwrap().simulations <= 2);
    for (a, b) in again.design.iter().zip(&first.design) {
        assert_eq!(a.start, b.value);
        assert!(((a.value - b.value) / (a.upper - a.lower)).abs() < 1e-4, "{a:?} {b:?}");
    }
    let refused = stribeck().arg("--start-from").arg(&file).assert().code(1);
    let text = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(text.contains("give the report.json of an earlier"), "{text}");
}

#[test]
fn a_polish_finishes_what_a_short_search_left() {
    let wide = [
        ("lower = \"45 mm\"\nupper = \"65 mm\"", "lower = \"30 mm\"\nupper = \"100 mm\""),
        ("lower = \"70 um\"\nupper = \"180 um\"", "lower = \"50 um\"\nupper = \"500 um\""),
        (
            "quantity = \"specific-load\"\nat_most = \"68 MPa\"",
            "quantity = \"specific-load\"\nat_most = \"200 MPa\"",
        ),
    ];
    let with = |optimiser: &str| {
        let optimiser = format!("[optimiser]\n{optimiser}\n{COARSE}");
        let mut changes = vec![("[oil]", optimiser.as_str())];
        changes.extend(wide);
        found(&smooth_study(&changes))
    };
    let short = with("max_iterations = 8");
    assert_eq!(short.outcome.status, Outcome::IterationLimit);
    let polished = with("max_iterations = 8\npolish = true");
    assert_eq!(polished.outcome.status, Outcome::Converged, "{:?}", polished.kkt);
    assert!(polished.kkt.polish_steps.unwrap() >= 1);
    assert!(polished.kkt.residual.unwrap() <= 1e-6 && short.kkt.residual.unwrap() > 1e-6);
    let whole = with("");
    let total = |r: &Report| r.objective.optimum.unwrap().total_w;
    assert!((total(&polished) / total(&whole) - 1.0).abs() < 1e-6);
}

#[test]
fn margins_of_temperatures_are_differences_of_temperature() {
    let with = format!("{SCATTER}{COARSE}").replace("samples = 40", "samples = 0");
    let hot = "[[constraints]]\nquantity = \"film-temperature\"\nat_most = \"95 degC\"\n\n[[constraints]]\nquantity = \"max-film-pressure\"";
    let report = found(&crate::common::main_study(&[
        ("[oil]", &with),
        ("at_least = \"3 um\"", "at_least = \"2 um\""),
        ("[[constraints]]\nquantity = \"max-film-pressure\"", hot),
    ]));
    let limit = report.constraints.iter().find(|c| c.quantity == "film-temperature").unwrap();
    let rows = &report.gradient.as_ref().unwrap().rows;
    let row = rows.iter().find(|r| r.quantity == "film-temperature").unwrap();
    let by = |name: &str| row.values[row.parameters.iter().position(|p| p == name).unwrap()];
    let scatter = [
        3.0 * by("big_end.diametral_clearance"),
        0.2 * by("big_end.supply.pressure"),
        by("oil.inlet_temperature"),
    ];
    let deviation = scatter.iter().map(|s| s * s).sum::<f64>().sqrt();
    assert!((limit.margin.unwrap() / (3.0 * deviation) - 1.0).abs() < 1e-6, "{limit:?} {deviation}");
    let robust = report.robust.unwrap();
    let sampled = robust.limits.iter().find(|l| l.quantity == "film-temperature").unwrap();
    assert!((sampled.deviation / deviation - 1.0).abs() < 1e-6 && sampled.unit == "K");
    assert!(robust.verdict.is_none() && robust.tolerances[2].deviation_unit == "K");
}

#[test]
fn an_option_may_change_what_is_searched() {
    let few = "[{ name = \"big_end.diametral_clearance\", lower = \"70 um\", upper = \"180 um\" }, { name = \"big_end.width\", lower = \"45 mm\", upper = \"65 mm\" }]";
    let list = format!(
        "[[choices]]\nname = \"searched\"\n[[choices.options]]\nname = \"all\"\nset = {{}}\n[[choices.options]]\nname = \"few\"\nset = {{ \"parameters\" = {few} }}\n{COARSE}"
    );
    let report = found(&smooth_study(&[("[oil]", &list)]));
    let runs = &report.choices.as_ref().unwrap().runs;
    assert_eq!((runs[0].design.len(), runs[1].design.len()), (4, 2));
    assert!(runs[0].loss_w.unwrap() < runs[1].loss_w.unwrap(), "{runs:?}");
}

#[test]
fn sums_that_no_box_allows_are_told_by_every_method_at_once() {
    for method in ["sqp", "augmented-lagrangian", "cobyla"] {
        let row = format!(
            "[optimiser]\nmethod = \"{method}\"\n[[linear_constraints]]\nterms = [{{ parameter = \"big_end.width\", factor = 1.0 }}, {{ parameter = \"big_end.diameter\", factor = -1.0 }}]\nat_least = \"0 mm\"\n{COARSE}"
        );
        let report = found(&smooth_study(&[("[oil]", &row)]));
        assert_eq!(report.outcome.status, Outcome::Infeasible, "{method}");
        assert!(report.outcome.refused[0].contains("contradict"), "{:?}", report.outcome);
        let l = &report.linear_constraints[0];
        assert!(!l.met && !l.active && report.objective.saving_percent.is_none());
        assert_eq!(l.sum, "big_end.width - big_end.diameter");
    }
}

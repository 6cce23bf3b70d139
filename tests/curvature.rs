//! Second derivatives of cycle quantities.

use crate::common::{COARSE, quietly, smooth_study};
use stribeck::dae::Dae;
use stribeck::gradient::hessian_times;
use stribeck::orbit::{OrbitOptions, settle};
use stribeck::run::Cancel;
use stribeck::study::plan;

#[test]
fn hessians_are_symmetric_and_match_second_differences() {
    // The short film has no kink, so second derivatives exist everywhere.
    let study = smooth_study(&[
        ("cavitation = \"swift-stieber\"\n", "model = \"mobility\"\n"),
        ("[oil]", "[orbit]\nsteps_per_cycle = 360\n[oil]"),
    ]);
    let (model, options, of) = quietly(|run| {
        let plan = plan(&study, stribeck::gradient::EngineName::Adj, run).unwrap();
        let case = &plan.problem.cases()[0];
        (case.model.clone(), case.options, case.quantities[..1].to_vec())
    });
    let (options, cancel) = (OrbitOptions { periodicity_tolerance: 1e-13, ..options }, Cancel::default());
    let orbit = settle(&model, &options, None, &cancel).unwrap();
    let n = model.parameters().len();
    // In units of the parameters' own sizes, so that entries can be compared.
    let size = |j: usize| model.parameter_scale(j);
    let column = |j: usize| -> Vec<f64> {
        let d: Vec<f64> = (0..n).map(|k| if k == j { size(k) } else { 0.0 }).collect();
        let found = hessian_times(&model, &orbit, &options, &of, &d, 1e-4, &cancel).unwrap();
        assert_eq!(found.cost.simulations, 2);
        (0..n).map(|k| found.rows[0][k] * size(k)).collect()
    };
    let hessian: Vec<Vec<f64>> = (0..n).map(column).collect();
    let largest = hessian.iter().flatten().fold(0.0f64, |a, v| a.max(v.abs()));
    for i in 0..n {
        for (j, row) in hessian.iter().enumerate().take(i) {
            let miss = (hessian[i][j] - row[i]).abs() / largest;
            assert!(miss < 1e-6, "{i} {j}: {} {}", hessian[i][j], row[i]);
        }
        let value = |step: f64| {
            let mut p = model.parameters().to_vec();
            p[i] += step * size(i);
            settle(&model.with_parameters(&p).unwrap(), &options, Some(&orbit), &cancel)
                .unwrap()
                .value(&of[0])
        };
        let step = 1e-3;
        let second = (value(step) - 2.0 * value(0.0) + value(-step)) / (step * step);
        assert!((hessian[i][i] - second).abs() < 1e-4 * largest, "{i}: {} {second}", hessian[i][i]);
    }
}

#[test]
fn an_optimum_inside_the_box_curves_upwards() {
    // In a box this wide the film limit is bought with width and clearance together: one direction stays free.
    let study = smooth_study(&[
        ("[oil]", COARSE),
        ("lower = \"45 mm\"\nupper = \"65 mm\"", "lower = \"30 mm\"\nupper = \"100 mm\""),
        ("lower = \"70 um\"\nupper = \"180 um\"", "lower = \"50 um\"\nupper = \"500 um\""),
        (
            "quantity = \"specific-load\"\nat_most = \"68 MPa\"",
            "quantity = \"specific-load\"\nat_most = \"200 MPa\"",
        ),
    ]);
    let findings = quietly(|run| stribeck::study::run(&study, run));
    let found = findings.report.kkt;
    let curvature = found.curvature.unwrap();
    assert_eq!((curvature.free_directions, curvature.eigenvalues.len()), (1, 1));
    assert!(curvature.eigenvalues[0] > 0.0, "{curvature:?}");
    assert!(found.verdict.unwrap().starts_with("a strict local minimum"));
}

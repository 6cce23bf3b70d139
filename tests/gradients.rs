//! The five gradient engines against each other, on the study of the main job and on coarser cases of other kinds.

use crate::common::{COARSE, main_study, quietly, smooth_study};
use stribeck::gradient::{EngineName, verdict};
use stribeck::study::{EngineComparison, Study, Sweep, compare_engines, run};

/// Best error of an engine in each row over its perturbations.
fn best(c: &EngineComparison, engine: EngineName) -> Vec<f64> {
    let rows = c.rows.iter().filter(|r| r.engine == engine);
    rows.fold(vec![f64::INFINITY; c.quantities.len()], |best, r| {
        best.iter().zip(&r.error).map(|(a, b)| a.min(*b)).collect()
    })
}

fn compare(study: &Study, steps: &[f64]) -> Vec<EngineComparison> {
    quietly(|run| compare_engines(study, &EngineName::ALL, &Sweep(steps.to_vec()), run)).unwrap()
}

fn assert_agreement(c: &EngineComparison, [tra, cen, one_sided]: [f64; 3]) {
    for (engine, allowed) in [
        (EngineName::Tra, tra),
        (EngineName::Cen, cen),
        (EngineName::Fw, one_sided),
        (EngineName::Bw, one_sided),
    ] {
        for (quantity, error) in c.quantities.iter().zip(best(c, engine)) {
            assert!(
                error <= allowed,
                "{engine:?} of {quantity} ({}): {error:.1e} > {allowed:.0e}",
                c.bearing
            );
        }
    }
}

#[test]
fn all_engines_agree_on_the_smooth_study() {
    let study = smooth_study(&[]);
    let comparisons = compare(&study, &[1e-5, 3e-6, 1e-6]);
    assert_eq!(comparisons.len(), 1);
    assert_eq!(comparisons[0].quantities.len(), 4);
    assert_agreement(&comparisons[0], [1e-10, 1e-6, 1e-4]);
    let cost = |engine| comparisons[0].rows.iter().find(|r| r.engine == engine).unwrap().cost;
    let (adj, tra, cen) = (cost(EngineName::Adj), cost(EngineName::Tra), cost(EngineName::Cen));
    assert_eq!(
        (adj.simulations, tra.simulations, cen.simulations),
        (0, 0, 8),
        "one pair of cycles per parameter"
    );
    assert_eq!(adj.solves, 4 * adj.steps, "one transposed solve per quantity and step");
    let steps = study.orbit.steps as u64;
    assert_eq!((adj.factorisations, tra.factorisations), (steps, steps), "each step is factorised once");
}

/// Variants of the main study: coarse, each of another kind.
fn variants() -> Vec<(&'static str, Study)> {
    let coarse = ("[oil]", COARSE);
    let mass =
        ("diametral_clearance = \"110 um\"", "diametral_clearance = \"110 um\"\njournal_mass = \"60 kg\"");
    let rupture = ("cavitation = \"swift-stieber\"\n", "");
    let mobility = ("[oil]", "[film]\nmodel = \"mobility\"\n[orbit]\nsteps_per_cycle = 360\n[oil]");
    let euler = ("steps_per_cycle = 240", "steps_per_cycle = 240\nscheme = \"bdf1\"");
    let second = (
        "[[parameters]]\nname = \"big_end.width\"",
        "[[objective.operating_points]]\nname = \"part load\"\nspeed = \"1200 rpm\"\nload_factor = 0.6\n\n[[parameters]]\nname = \"big_end.width\"",
    );
    let pressed = ("[film]", "[film]\nside_pressure = \"3 bar\"\ncavitation_pressure = \"-0.5 bar\"");
    vec![
        ("coarse", smooth_study(&[coarse])),
        ("journal with mass", smooth_study(&[coarse, mass])),
        ("mobility", smooth_study(&[rupture, mobility])),
        ("implicit Euler", smooth_study(&[coarse, euler])),
        ("two operating points", smooth_study(&[coarse, second])),
        ("side and cavitation pressure", smooth_study(&[coarse, pressed])),
    ]
}

#[test]
fn engines_agree_on_every_kind_of_case() {
    for (name, study) in variants() {
        for c in compare(&study, &[1e-5, 1e-6, 1e-7]) {
            println!("{name}, {}", c.operating_point);
            // A coarse mesh has large cells, so that single kinks weigh more than on the main study.
            assert_agreement(&c, [1e-9, 1e-5, 1e-3]);
        }
    }
}

#[test]
fn a_main_bearing_of_a_v_engine_has_exact_gradients_too() {
    let study = smooth_study(&[
        ("[oil]", COARSE),
        ("kind = \"big-end\"", "kind = \"main\"\nmain_bearing = 2"),
        ("[cylinder_pressure]", V8),
    ]);
    assert_agreement(&compare(&study, &[1e-5, 1e-6, 1e-7])[0], [1e-9, 1e-5, 1e-3]);
}

/// Cross-plane crankshaft of a V8.
const V8: &str = r#"vee_angle = "90 deg"
throw_angles = ["0 deg", "90 deg", "270 deg", "180 deg"]
firing_order = ["A1", "A3", "A4", "B1", "B3", "B4", "B2", "A2"]
throw_mass = "4 kg"

[cylinder_pressure]"#;

#[test]
fn taylor_remainders_of_objective_and_constraints_fall_with_order_two() {
    let study = main_study(&[("[oil]", COARSE), ("[oil]", "[optimiser]\nmax_iterations = 1\n[oil]")]);
    let findings = quietly(|context| run(&study, context));
    let gradient = findings.report.gradient.unwrap();
    assert_eq!(gradient.rows.len(), 4);
    for row in &gradient.rows {
        assert!(row.verdict.starts_with("exact"), "{}: {} {:#?}", row.quantity, row.verdict, row.check);
        assert_eq!(row.verdict, verdict(&row.check));
    }
}

#[test]
fn engines_agree_on_the_main_study_with_its_full_physics() {
    // Mass-conserving film with supply, rough surfaces in contact, heat balance; coarse, so that it is quick.
    let study = main_study(&[("[oil]", COARSE)]);
    let comparison = &compare(&study, &[1e-6])[0];
    assert_agreement(comparison, [1e-9, 1e-5, 1e-3]);
}

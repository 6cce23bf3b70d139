//! What is recorded of a cycle, and how many threads work on it, changes no result.

use crate::common::{COARSE, main_study, quietly, smooth_study};
use stribeck::cranktrain::JournalBearing;
use stribeck::gradient::{EngineName, GradientTable, engine};
use stribeck::orbit::{Orbit, OrbitOptions, Quantity, Recording, settle};
use stribeck::run::Cancel;
use stribeck::study::{Study, plan};

/// First bearing of a study with its quantities.
fn case(study: &Study) -> (JournalBearing, OrbitOptions, Vec<Quantity>) {
    quietly(|run| {
        let plan = plan(study, EngineName::Adj, run).unwrap();
        let case = &plan.problem.cases()[0];
        (case.model.clone(), case.options, case.quantities.clone())
    })
}

fn gradient(study: &Study, name: EngineName, memory_bytes: usize) -> (Orbit, GradientTable) {
    let (model, options, of) = case(study);
    let options = OrbitOptions { memory_bytes, ..options };
    let orbit = settle(&model, &options, None, &Cancel::default()).unwrap();
    let table = engine(name, 1e-6).gradient(&model, &orbit, &options, &of, &Cancel::default()).unwrap();
    (orbit, table)
}

/// Largest difference of two tables, relative to the largest entry of each row.
fn difference(a: &GradientTable, b: &GradientTable) -> f64 {
    let row = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let size = b.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs() / size))
    };
    a.rows.iter().zip(&b.rows).map(row).fold(0.0, f64::max)
}

#[test]
fn checkpoints_and_factors_made_again_give_the_same_cycle_and_gradient() {
    let study = main_study(&[("[oil]", COARSE)]);
    let poor = main_study(&[("[oil]", COARSE), ("[oil]", "[orbit]\nmemory = \"100 kB\"\n[oil]")]);
    assert_eq!((study.orbit.memory_bytes, poor.orbit.memory_bytes), (1_000_000_000, 100_000));
    let steps = study.orbit.steps as u64;
    let sizes = [1 << 30, 2 << 20, 100_000];
    let found: Vec<(Orbit, GradientTable)> =
        sizes.iter().map(|bytes| gradient(&study, EngineName::Adj, *bytes)).collect();
    let recordings: Vec<Recording> = found.iter().map(|(orbit, _)| orbit.recording).collect();
    assert_eq!(recordings, [Recording::Factors, Recording::States, Recording::Checkpoints]);
    let (orbit, table) = &found[0];
    for (other, theirs) in &found[1..] {
        for (a, b) in orbit.outputs.iter().flatten().zip(other.outputs.iter().flatten()) {
            assert!((a - b).abs() <= 1e-8 * a.abs().max(1e-12), "{a} {b}");
        }
        let miss = difference(theirs, table);
        assert!(miss < 1e-7, "{miss:.1e}");
        // Every sweep factorises again.
        assert!(theirs.cost.factorisations > steps && theirs.cost.factorisations <= theirs.cost.steps);
    }
    assert_eq!(table.cost.factorisations, steps, "kept factors are made once");
    let kept = found[2].0.states.iter().filter(|z| !z.is_empty()).count();
    assert_eq!(kept, 2 * 240usize.div_ceil(32), "two states in front of every block");
    let (model, ..) = case(&study);
    let bytes = recordings.iter().map(|r| r.bytes_per_step(&model)).collect::<Vec<_>>();
    assert!(bytes[0] > 20 * bytes[1] && bytes[1] >= 15 * bytes[2], "{bytes:?}");
}

#[test]
fn the_work_of_a_cycle_and_of_its_gradients_is_counted() {
    let studies = [
        ("main study, heat balance", main_study(&[("[oil]", COARSE)])),
        ("smooth Swift-Stieber", smooth_study(&[("[oil]", COARSE)])),
    ];
    let mut lines = String::new();
    for (name, study) in studies {
        let (orbit, adj) = gradient(&study, EngineName::Adj, 1 << 30);
        let (_, tra) = gradient(&study, EngineName::Tra, 1 << 30);
        let per_step = orbit.cost.newton_iterations as f64 / orbit.cost.steps as f64;
        assert!(per_step <= 3.0, "{name}: {per_step} iterations per step");
        // Chord steps solve with the factors of the iteration before.
        let factorised = orbit.cost.factorisations as f64 / orbit.cost.steps as f64;
        assert!(factorised <= per_step && orbit.cost.solves >= orbit.cost.newton_iterations);
        let steps = study.orbit.steps as u64;
        for (engine, table) in [("ADJ", &adj), ("TRA", &tra)] {
            // What is carried beyond the forced sweep costs solves only.
            assert_eq!(table.cost.factorisations, steps, "{name}: {engine}");
            let columns = table.cost.solves / table.cost.steps;
            assert_eq!(table.cost.solves, columns * table.cost.steps, "{name}: {engine}");
        }
        lines += &format!(
            "{name}: {} cycles, {:.2} iterations and {factorised:.2} factorisations per step; sweeps ADJ {}, TRA {}; solves ADJ {}, TRA {}\n",
            orbit.cycles, per_step, adj.sweeps, tra.sweeps, adj.cost.solves, tra.cost.solves
        );
    }
    insta::assert_snapshot!(lines);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let study = smooth_study(&[("[oil]", COARSE)]);
    for name in [EngineName::Adj, EngineName::Tra, EngineName::Fw, EngineName::Cen] {
        let tables: Vec<GradientTable> = [1, 2, 5]
            .map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| gradient(&study, name, 1 << 30).1)
            })
            .into();
        assert!(tables.iter().all(|t| t == &tables[0]), "{name:?}");
    }
}

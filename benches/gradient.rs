//! A gradient of four quantities by four parameters in units of one settled simulation, per engine.
//!
//!     cargo bench --bench gradient
//!
//! Divide each engine's time by that of `simulation`: that ratio is what the README quotes.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use stribeck::gradient::{EngineName, engine};
use stribeck::optimise::DesignProblem;
use stribeck::orbit::settle;
use stribeck::run::{Cancel, RunContext, Silent};
use stribeck::study::{Format, Study, plan};

fn benches(c: &mut Criterion) {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let text = std::fs::read_to_string(root.join("operational-170x215.toml")).expect("the study is there");
    let study = Study::read(&text, Format::Toml, Some(&root)).expect("the study has no mistakes");
    let cancel = Cancel::default();
    let context = RunContext { cancel: &cancel, progress: &Silent };
    let plan = plan(&study, EngineName::Adj, context).expect("the study can be built");
    let problem: &DesignProblem<_> = &plan.problem;
    let case = &problem.cases()[0];
    let orbit = settle(&case.model, &case.options, None, &cancel).expect("the start settles");
    let mut group = c.benchmark_group("gradient");
    group.sample_size(10);
    group.bench_function("simulation", |t| {
        t.iter(|| black_box(settle(&case.model, &case.options, None, &cancel).is_ok()));
    });
    for name in EngineName::ALL {
        let engine = engine(name, 1e-6);
        group.bench_function(name.as_str(), |t| {
            t.iter(|| {
                let table = engine.gradient(&case.model, &orbit, &case.options, &case.quantities, &cancel);
                black_box(table.is_ok())
            });
        });
    }
    group.finish();
}

criterion_group!(gradient, benches);
criterion_main!(gradient);

//! What the ratio benches share: one core, medians, and a study with the shape of its shell free.

use std::path::Path;
use std::time::Instant;
use stribeck::study::{Format, Study};

/// Median wall time of a few runs, s.
pub fn seconds(runs: usize, mut work: impl FnMut()) -> f64 {
    let mut all: Vec<f64> = (0..runs)
        .map(|_| {
            let began = Instant::now();
            work();
            began.elapsed().as_secs_f64()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    all[runs / 2]
}

/// The operational study changed as text; later keys of a section are added to it.
pub fn study(changes: &[(&str, &str)]) -> Study {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut text =
        std::fs::read_to_string(root.join("operational-170x215.toml")).expect("the study is there");
    for (from, to) in changes {
        assert!(text.contains(from), "the study does not contain {from:?}");
        text = text.replace(from, to);
    }
    Study::read(&text, Format::Toml, Some(&root)).unwrap_or_else(|e| panic!("{:#?}", e.faults))
}

/// All computations on one core.
pub fn one_core() {
    stribeck::run::use_threads(std::num::NonZeroUsize::MIN);
}

/// The allocator of the program.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

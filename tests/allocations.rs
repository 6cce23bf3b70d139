//! What a step asks of its memory: once warm, linearising, factorising and solving allocate nothing,
//! nor does the march from step to step.

use crate::common::{MAIN, main_study, quietly};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use stribeck::dae::{Dae, LinearisedDae, SensitiveDae, Step};
use stribeck::gradient::EngineName;
use stribeck::math::{CyclicBand, Stencil};
use stribeck::orbit::{OrbitOptions, settle};
use stribeck::run::Cancel;
use stribeck::study::plan;

/// Counts the allocations of each thread.
pub struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call is handed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
}

fn allocations(work: impl FnOnce()) -> u64 {
    let before = COUNT.with(Cell::get);
    work();
    COUNT.with(Cell::get) - before
}

#[test]
fn the_band_allocates_nothing() {
    let (n, b) = (24, 5);
    let mut a = Stencil::zeros(n * b);
    for k in 0..n * b {
        a.diagonal[k] = 5.0;
        (a.west[k], a.east[k]) = (-1.0, -0.5);
        a.south[k] = if k % b > 0 { -1.0 } else { 0.0 };
    }
    let mut solver = CyclicBand::new(n, b);
    let mut rhs = vec![1.0; 3 * n * b];
    let count = allocations(|| {
        solver.factor(&a).unwrap();
        solver.solve(&mut rhs);
        solver.solve_transposed(&mut rhs);
    });
    assert_eq!(count, 0);
}

#[test]
fn a_newton_iteration_of_the_main_study_allocates_nothing() {
    let study = main_study(&[("[oil]", crate::common::COARSE)]);
    quietly(|run| {
        let plan = plan(&study, EngineName::Adj, run).unwrap();
        let model = &plan.problem.cases()[0].model;
        let (z, past) = (model.cold_start(), vec![0.0; model.memories()]);
        let (mut memory, mut residual) = (vec![0.0; model.memories()], vec![0.0; model.states()]);
        let (mut room, mut factors) = (model.room(), model.factors());
        let mut iteration = || {
            let step = Step { t_s: 1e-3, z: &z, alpha: 1e3, past: &past };
            model.linearise(step, &mut memory, &mut residual, &mut room, &mut factors).unwrap();
            model.solve(&factors, &mut residual);
            model.solve_transposed(&factors, &mut residual);
        };
        iteration();
        assert_eq!(allocations(iteration), 0, "in an iteration of {MAIN}");
    });
}

#[test]
fn a_march_allocates_as_much_for_one_cycle_as_for_three() {
    // At a given film temperature: the heat balance repeats the march.
    let study = main_study(&[
        ("[oil]", crate::common::COARSE),
        ("# Switched on; every key has a default.\n[bearings.big_end.heat_balance]\n", ""),
        ("\"bearings.big_end.heat_balance\" =", "\"oil.density_15c\" ="),
    ]);
    quietly(|run| {
        let plan = plan(&study, EngineName::Adj, run).unwrap();
        let case = &plan.problem.cases()[0];
        let marched = |tolerance: f64| {
            // No factors are kept, so nothing but steps is taken.
            let options =
                OrbitOptions { memory_bytes: 2 << 20, periodicity_tolerance: tolerance, ..case.options };
            let mut cycles = 0.0;
            let count = allocations(|| {
                cycles = settle(&case.model, &options, None, &Cancel::default()).unwrap().cycles
            });
            (cycles, count)
        };
        let ((short, few), (long, many)) = (marched(1e-2), marched(1e-11));
        assert!(long > short + 1.5, "{short} and {long} cycles");
        assert_eq!(few, many, "{short} and {long} cycles");
    });
}

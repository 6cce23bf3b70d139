//! One step of a mass-conserving cycle in units of one factorisation and solve of its own film matrix, on one core.
//!
//!     cargo bench --bench orbit
//!
//! Target: at most 4, and at least 60 % of the time in the linear solver. A step takes two to three Newton iterations.
//! Most assemble the film, factorise it and solve for three right-hand sides (residual and two motions) in one go; the last is
//! often a chord step, which assembles and solves for one with the factors there are.
//!
//! Profile, as found by this bench (last column: share of the factorisations and solves, measured on hot matrices, so a lower
//! limit): 54 % on 60 x 6, 53 % on 72 x 8, 73 % on 85 x 20, 61 % on 120 x 20; the rest is the film's arrays (cells, faces, rows).

mod common;

use common::{one_core, seconds, study};
use std::hint::black_box;
use stribeck::film::FilmLinear;
use stribeck::gradient::EngineName;
use stribeck::math::CyclicBand;
use stribeck::orbit::settle;
use stribeck::run::{Cancel, RunContext, Silent};
use stribeck::study::plan;

/// Factorisations in a measurement.
const REPEATS: usize = 20;

fn main() {
    one_core();
    let cancel = Cancel::default();
    let context = RunContext { cancel: &cancel, progress: &Silent };
    println!(
        "{:>12} {:>6} {:>10} {:>10} {:>10} {:>12} {:>14} {:>10} {:>10}",
        "cells", "steps", "cycles", "it/step", "fact/step", "step [us]", "factor+solve", "ratio", "in solver"
    );
    for (around, across, steps) in [(60, 6, 480), (72, 8, 720), (85, 20, 720), (120, 20, 720)] {
        let cells = format!("cells_around = {around}\ncells_across_half = {across}");
        let study = study(&[
            ("# Switched on; every key has a default.\n[bearings.big_end.heat_balance]\n", ""),
            ("\"bearings.big_end.heat_balance\" =", "\"oil.density_15c\" ="),
            ("[bearings.big_end.roughness]\njournal = \"0.2 um\"\nshell = \"0.4 um\"\n", ""),
            ("\"bearings.big_end.roughness\" =", "\"oil.inlet_temperature\" ="),
            ("\"oil.inlet_temperature\" = \"usual", "\"machine.bore\" = \"usual"),
            ("cells_around = 60\ncells_across_half = 6", &cells),
            ("steps_per_cycle = 480", &format!("steps_per_cycle = {steps}")),
        ]);
        let plan = plan(&study, EngineName::Adj, context).expect("the study can be built");
        let case = &plan.problem.cases()[0];
        let (model, mut orbit) = (&case.model, None);
        let cycle = seconds(1, || orbit = settle(model, &case.options, None, &cancel).ok());
        let orbit = orbit.expect("the start settles");
        let per_step = cycle / orbit.cost.steps as f64;
        let matrix = film_matrix(model, &orbit);
        let [none, one, three] = [0, 1, 3].map(matrix);
        let iterations = orbit.cost.newton_iterations as f64 / orbit.cost.steps as f64;
        let factorised = orbit.cost.factorisations as f64 / orbit.cost.steps as f64;
        println!(
            "{:>12} {steps:>6} {:>10.2} {iterations:>10.2} {factorised:>10.2} {:>12.1} {:>14.1} {:>10.2} {:>9.0}%",
            format!("{around} x {across}"),
            orbit.cycles,
            per_step * 1e6,
            one * 1e6,
            per_step / one,
            100.0 * (factorised * three + (iterations - factorised) * (one - none)) / per_step
        );
    }
}

/// Mean time of a factorisation and a solve with some right-hand sides, over film matrices of the whole cycle.
fn film_matrix<'a>(
    model: &'a stribeck::cranktrain::JournalBearing,
    orbit: &'a stribeck::orbit::Orbit,
) -> impl Fn(usize) -> f64 + 'a {
    move |columns| {
        let (blocks, b) = model.film().shape();
        let (n, mut total, mut looked) = (blocks * b, 0.0, 0);
        let (mut linear, mut solver) = (FilmLinear::new(n, 2), CyclicBand::new(blocks, b));
        let alpha = orbit.scheme.rates(orbit.dt_s)[0];
        orbit.for_each(model, |step, at| {
            if step % 24 == 0 {
                let mut room = Vec::new();
                let site = model.film_site(at, &mut room);
                model.film().linearise(&site, model.film_unknowns(at.z), alpha, &[], &mut linear);
                let mut rhs = vec![1.0; columns * n];
                total += seconds(1, || {
                    for _ in 0..REPEATS {
                        solver.factor(&linear.stencil).expect("a film matrix is regular");
                        solver.solve(&mut rhs);
                        rhs.fill(1.0);
                    }
                    black_box(&rhs);
                });
                looked += REPEATS;
            }
        });
        total / looked as f64
    }
}

//! A gradient by 1, 8, 64, 512 coefficients of a free shell profile, in units of one settled simulation, on one core.
//!
//!     cargo bench --bench gradient
//!
//! The bearing is that of `studies/operational-170x215.toml` with its full physics (mass-conserving cavity, roughness, contact,
//! supply) at a given film temperature, so that a simulation is one settled cycle, on 60 x 12 cells and 480 steps. FW and CEN
//! are measured up to 8 coefficients: their cost is one and two simulations per coefficient.
//! Targets: ADJ at most 0.5 for one quantity and 0.8 for four, the same for any number of coefficients within 10 %.

mod common;

use common::{one_core, seconds, study};
use stribeck::gradient::{EngineName, engine};
use stribeck::orbit::{Quantity, settle};
use stribeck::run::{Cancel, RunContext, Silent};
use stribeck::study::plan;

const PROFILE: &str =
    "[[bearings.big_end.shapes]]\nname = \"free\"\nkind = \"spline\"\naround = 64\nacross = 8\n\n[film]";

fn main() {
    one_core();
    let cancel = Cancel::default();
    let context = RunContext { cancel: &cancel, progress: &Silent };
    println!(
        "{:>6} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8}",
        "n_p", "ADJ, 1", "ADJ, 4", "TRA", "FW", "CEN", "s"
    );
    for count in [1usize, 8, 64, 512] {
        let bounds = "lower = \"-5 um\"\nupper = \"5 um\"\n";
        let parameters: String = (0..count)
            .map(|k| format!("[[parameters]]\nname = \"big_end.shapes.free.coefficients[{k}]\"\n{bounds}\n"))
            .collect();
        let study = study(&[
            ("# Switched on; every key has a default.\n[bearings.big_end.heat_balance]\n", ""),
            ("\"bearings.big_end.heat_balance\" =", "\"oil.density_15c\" ="),
            ("[film]", PROFILE),
            (
                "[[parameters]]\nname = \"big_end.width\"",
                &format!("{parameters}[[parameters]]\nname = \"big_end.width\""),
            ),
        ]);
        let plan = plan(&study, EngineName::Adj, context).expect("the study can be built");
        let case = &plan.problem.cases()[0];
        // The profile's coefficients alone: width and the like stay as they are.
        let mut setup = case.model.setup().clone();
        setup.parameters.truncate(count);
        let model = stribeck::cranktrain::JournalBearing::new(setup).expect("the bearing exists");
        let settled = || settle(&model, &case.options, None, &cancel).expect("the start settles");
        let orbit = settled();
        // Each run is set against a simulation right beside it: a machine's pace drifts.
        let ratio = |name: EngineName, of: &[Quantity], runs: usize| {
            let engine = engine(name, 1e-6);
            let run =
                || drop(engine.gradient(&model, &orbit, &case.options, of, &cancel).expect("a gradient"));
            let mut all: Vec<f64> =
                (0..runs).map(|_| seconds(1, run) / seconds(1, || drop(settled()))).collect();
            all.sort_by(f64::total_cmp);
            all[runs / 2]
        };
        let (one, four) = (&case.quantities[..1], &case.quantities[..]);
        let (adj_1, adj_4) = (ratio(EngineName::Adj, one, 9), ratio(EngineName::Adj, four, 9));
        let tra = ratio(EngineName::Tra, four, 1);
        let (fw, cen) = match count <= 8 {
            true => (ratio(EngineName::Fw, four, 1), ratio(EngineName::Cen, four, 1)),
            false => (f64::NAN, f64::NAN),
        };
        let speed_up = cen / adj_4;
        println!("{count:>6} {adj_1:>10.3} {adj_4:>10.3} {tra:>8.2} {fw:>8.2} {cen:>8.2} {speed_up:>8.1}");
    }
}

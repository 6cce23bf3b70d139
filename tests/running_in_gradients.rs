//! Gradients through a running-in: five engines, geometry, oil and programme; with and without the states of all cycles.

use crate::common::{COARSE, main_study, quietly};
use crate::running_in::{leaning, options, stage};
use std::sync::Arc;
use stribeck::cranktrain::{
    BearingLoad, BearingOutput, BearingParameter, BearingSetup, Cylinder, JournalBearing, Smoothing,
};
use stribeck::dae::Dae;
use stribeck::gradient::{EngineName, engine};
use stribeck::orbit::{Quantity, Reduction, settle};
use stribeck::run::Cancel;
use stribeck::running_in::{
    March, MarchEngine, MarchOptions, RunningInQuantity, Stage, march_gradient, replay,
};
use stribeck::study::plan;

fn all() -> [RunningInQuantity; 9] {
    let in_the_end = |output: BearingOutput, reduction| {
        RunningInQuantity::Final(Quantity { output: output.index(), reduction })
    };
    [
        RunningInQuantity::EnergyLost,
        RunningInQuantity::MeanLoss,
        RunningInQuantity::final_loss(),
        RunningInQuantity::WearVolume,
        RunningInQuantity::MaxDepth(50.0),
        RunningInQuantity::TimeToRunIn,
        in_the_end(BearingOutput::GapMin, Reduction::SmoothMin(100.0)),
        in_the_end(BearingOutput::PressurePeak, Reduction::SmoothMax(100.0)),
        in_the_end(BearingOutput::ContactPeak, Reduction::SmoothMax(100.0)),
    ]
}

/// A bearing that has load factor and speed as its last parameters.
fn operated(model: &JournalBearing, speed_rad_s: f64, load_factor: f64) -> JournalBearing {
    let mut setup = BearingSetup { speed_rad_s, load_factor, ..model.setup().clone() };
    let BearingLoad::BigEnd(cylinder) = &*setup.load else { panic!("a big end") };
    let pressure = Arc::new(cylinder.pressure.scaled(0.0));
    setup.idle = Some(Arc::new(BearingLoad::BigEnd(Cylinder { pressure, ..cylinder.clone() })));
    setup.parameters.retain(|p| *p != BearingParameter::FilmTemperature);
    setup.parameters.extend([BearingParameter::LoadFactor, BearingParameter::Speed]);
    JournalBearing::new(setup).unwrap()
}

struct Programme {
    stages: [Stage; 2],
    steps: Vec<f64>,
    names: Vec<String>,
    found: March,
    options: MarchOptions,
}

/// Two stages in five blocks: variables are some of the bearing's own, load factor and speed of the first stage, both durations.
fn programme(
    own: &[BearingParameter],
    journal_share: f64,
    smoothing: Option<Smoothing>,
    memory_bytes: usize,
) -> Programme {
    let relief = "[[bearings.big_end.shapes]]\nname = \"edge\"\nkind = \"edge-relief\"\ndepth = \"0.2 um\"\n\
        length_share = 0.3\n\n[bearings.big_end.roughness]";
    let study = leaning(&[("[bearings.big_end.roughness]", relief)]);
    let (at, orbit) = stage(&study, 900.0);
    let setup = BearingSetup { parameters: own.to_vec(), smoothing, ..at.model.setup().clone() };
    let model = JournalBearing::new(setup).unwrap();
    let n = own.len();
    let stages = [
        Stage {
            model: operated(&model, 120.0, 0.8),
            duration_s: 300.0,
            variables: (0..n + 2).collect(),
            duration_variable: Some(n + 2),
        },
        Stage { model, duration_s: 900.0, variables: (0..n).collect(), duration_variable: Some(n + 3) },
    ];
    // So small that no edge of a cavity passes a cell between the two sides, where quantities have kinks: ten times longer steps of load
    // factor and temperature cross some and miss by 1e-4.
    let step = |p: &BearingParameter| match p {
        BearingParameter::InletTemperature => 3e-5,
        BearingParameter::DiametralClearance => 8e-10,
        _ => 1e-7,
    };
    let steps = own.iter().map(step).chain([1e-6, 1e-4, 0.01, 0.01]).collect();
    let more = ["load factor", "speed", "first duration", "second duration"].map(str::to_owned);
    let names = own.iter().map(|p| format!("{p:?}")).chain(more).collect();
    let options = MarchOptions { journal_share, memory_bytes, ..options(orbit) };
    let shares = vec![vec![0.1, 0.3, 0.6], vec![0.2, 0.8]];
    let found = replay(&stages, &shares, &options, None, &Cancel::default()).unwrap();
    Programme { stages, steps, names, found, options }
}

impl Programme {
    fn gradient(&self, name: EngineName) -> Vec<Vec<f64>> {
        let engine = MarchEngine { name, steps: &self.steps };
        let (stages, cancel) = (&self.stages, Cancel::default());
        march_gradient(engine, stages, &self.found, &self.options, &all(), &cancel).unwrap().rows
    }

    /// What settling leaves of a quantity, over the step of a difference: it counts where little is asked of a large value.
    fn noise(&self, quantity: usize, variable: usize) -> f64 {
        let (first, last) = self.found.course.losses();
        let left = match all()[quantity] {
            RunningInQuantity::TimeToRunIn => 1e-12 * self.found.course.energy_j / (first - last).abs(),
            of if self.names[variable].ends_with("duration") => {
                1e-10 * of.value(&self.found.course, &self.stages[1].model).abs()
            }
            _ => 0.0,
        };
        left / (2.0 * self.steps[variable])
    }

    /// The worst miss of differences beyond their noise, told line by line.
    fn misses(&self, name: EngineName, adj: &[Vec<f64>]) -> f64 {
        let mut worst = 0.0f64;
        for (q, (found, adj)) in self.gradient(name).iter().zip(adj).enumerate() {
            for (v, (d, a)) in found.iter().zip(adj).enumerate() {
                let miss = ((d - a).abs() - self.noise(q, v)).max(0.0) / a.abs().max(f64::MIN_POSITIVE);
                println!("{:?} by {}: ADJ {a:.8e}, {name:?} {miss:.1e}", all()[q], self.names[v]);
                worst = worst.max(miss);
            }
        }
        worst
    }
}

/// Half of the shell's roughness goes with the first tenths of a micrometre.
const SMOOTHS: Option<Smoothing> = Some(Smoothing { left: 0.5, depth_m: 2e-7 });
const MORE: [BearingParameter; 6] = [
    BearingParameter::Width,
    BearingParameter::Diameter,
    BearingParameter::JournalRoughness,
    BearingParameter::ShellRoughness,
    BearingParameter::Tilt(0),
    BearingParameter::Shape(0, 0),
];
const OWN: [BearingParameter; 3] =
    [BearingParameter::Width, BearingParameter::DiametralClearance, BearingParameter::InletTemperature];

#[test]
fn tra_and_adj_agree_on_every_quantity_of_a_running_in() {
    for (journal_share, smoothing, own) in [(0.0, None, &OWN[..]), (0.3, SMOOTHS, &MORE[..])] {
        let at = programme(own, journal_share, smoothing, 1 << 30);
        let [tra, adj] = [EngineName::Tra, EngineName::Adj].map(|e| at.gradient(e));
        for (q, (tra, adj)) in tra.iter().zip(&adj).enumerate() {
            for (v, (t, a)) in tra.iter().zip(adj).enumerate() {
                let miss = (t - a).abs() / a.abs();
                println!("share {journal_share}, {:?} by {}: {a:.9e} {miss:.1e}", all()[q], at.names[v]);
                assert!((t - a).abs() <= 1e-9 * a.abs(), "{:?} by {}: {t} {a}", all()[q], at.names[v]);
            }
        }
        // Where wear smooths the shell the loss falls, and its time constant has a gradient.
        assert!(smoothing.is_none() || adj[5].iter().all(|g| *g != 0.0), "{:?}", adj[5]);
    }
}

#[test]
fn differences_agree_with_adj_on_every_quantity_of_a_running_in() {
    let at = programme(&OWN[1..], 0.0, SMOOTHS, 1 << 30);
    let worst = at.misses(EngineName::Cen, &at.gradient(EngineName::Adj));
    assert!(worst < 5e-5, "CEN {worst:.1e}");
    let at = programme(&OWN[1..2], 0.3, None, 1 << 30);
    let adj = at.gradient(EngineName::Adj);
    for name in [EngineName::Fw, EngineName::Bw] {
        let worst = at.misses(name, &adj);
        assert!(worst < 1e-3, "{name:?} {worst:.1e}");
    }
}

#[test]
fn cycles_that_were_not_kept_are_settled_again_to_the_same_gradient() {
    let [kept, dropped] = [1 << 30, 0].map(|memory| programme(&OWN[1..2], 0.0, None, memory));
    assert!(dropped.found.blocks.iter().all(|b| b.rates.iter().all(|r| r.orbit.states[0].is_empty())));
    for name in [EngineName::Adj, EngineName::Tra] {
        let (a, b) = (kept.gradient(name), dropped.gradient(name));
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((a - b).abs() <= 1e-6 * a.abs(), "{a} {b}");
        }
    }
}

#[test]
fn load_factor_and_speed_are_parameters_like_any_other() {
    let heavy = "kind = \"big-end\"\njournal_mass = \"30 kg\"";
    for changes in [&[("[oil]", COARSE)][..], &[("[oil]", COARSE), ("kind = \"big-end\"", heavy)]] {
        let study = main_study(changes);
        let (model, options) = quietly(|context| {
            let plan = plan(&study, EngineName::Adj, context).unwrap();
            let case = &plan.problem.cases()[0];
            (operated(&case.model, 140.0, 0.9), case.options)
        });
        let cancel = Cancel::default();
        let orbit = settle(&model, &options, None, &cancel).unwrap();
        let of: Vec<Quantity> = (0..model.outputs())
            .filter(|o| *o != BearingOutput::Rubbing.index())
            .flat_map(|output| {
                [Reduction::Mean, Reduction::SmoothMax(20.0)].map(|reduction| Quantity { output, reduction })
            })
            .collect();
        let [tra, adj, cen] = [EngineName::Tra, EngineName::Adj, EngineName::Cen]
            .map(|e| engine(e, 1e-6).gradient(&model, &orbit, &options, &of, &cancel).unwrap().rows);
        let n = adj[0].len();
        for (q, row) in adj.iter().enumerate() {
            for v in n - 2..n {
                let size = row[v].abs().max(1e-6 * orbit.value(&of[q]).abs() / model.parameters()[v]);
                let (t, c) = ((tra[q][v] - row[v]).abs(), (cen[q][v] - row[v]).abs());
                println!("{:?} by {v}: {:.6e} TRA {:.1e} CEN {:.1e}", of[q], row[v], t / size, c / size);
                let holds = t <= 1e-8 * size && c <= 1e-4 * size;
                assert!(holds, "{:?} by {v}: {} {} {}", of[q], row[v], tra[q][v], cen[q][v]);
            }
        }
    }
}

//! Running-in: what touches wears, what does not stays as it is; balances, order, gradients.

use crate::common::{COARSE, main_study, quietly};
use stribeck::cranktrain::BearingOutput;
use stribeck::gradient::EngineName;
use stribeck::orbit::OrbitOptions;
use stribeck::run::Cancel;
use stribeck::running_in::{March, MarchOptions, RunningInQuantity, Stage, march, march_predicted, replay};
use stribeck::study::{Study, plan};

/// Archard's coefficient of the tests, m3/(N m): a hundred times that of mild wear, so that an hour suffices.
const WEAR: f64 = 1e-15;

/// The main bearing on a coarse mesh with a journal that leans, so that one edge touches.
pub fn leaning(changes: &[(&str, &str)]) -> Study {
    let mut all = vec![
        ("[oil]", COARSE),
        ("kind = \"big-end\"", "kind = \"big-end\"\ntilt_x = \"0.02 deg\""),
        ("journal = \"0.2 um\"", "journal = \"0.4 um\""),
    ];
    all.extend_from_slice(changes);
    main_study(&all)
}

pub fn stage(study: &Study, duration_s: f64) -> (Stage, OrbitOptions) {
    quietly(|context| {
        let plan = plan(study, EngineName::Adj, context).unwrap();
        let case = &plan.problem.cases()[0];
        (Stage::new(case.model.clone(), duration_s), case.options)
    })
}

pub fn options(orbit: OrbitOptions) -> MarchOptions {
    MarchOptions {
        wear_m3_per_n_m: WEAR,
        journal_share: 0.0,
        tolerance_m: 2e-8,
        max_blocks: 200,
        settled: None,
        orbit,
        memory_bytes: 1 << 30,
    }
}

fn run(stages: &[Stage], options: &MarchOptions) -> March {
    march(stages, options, &Cancel::default(), &mut |_| {}).unwrap()
}

#[test]
fn a_bearing_that_does_not_touch_does_not_wear_at_all() {
    let study = main_study(&[("[oil]", COARSE)]);
    let (stage, orbit) = stage(&study, 3600.0);
    let model = stage.model.clone();
    let found = run(&[stage], &options(orbit));
    assert!(found.course.worn_m.shell.iter().all(|w| *w == 0.0));
    assert_eq!(found.blocks.len(), 1, "nothing to resolve");
    assert_eq!(RunningInQuantity::WearVolume.value(&found.course, &model), 0.0);
    let (first, last) = found.course.losses();
    assert!(
        (found.course.energy_j - 3600.0 * first).abs() < 1e-6 * found.course.energy_j
            && (first / last - 1.0).abs() < 1e-9
    );
}

#[test]
fn an_edge_wears_until_it_touches_less_and_volume_is_what_archard_says() {
    let study = leaning(&[]);
    let (stage, orbit) = stage(&study, 3600.0);
    let (model, options) = (stage.model.clone(), options(orbit));
    let found = run(&[stage], &options);
    let shares: Vec<f64> = found.blocks.iter().map(|b| b.rates[0].contact_share()).collect();
    println!("{} blocks, {} refused, contact share {shares:.4?}", found.blocks.len(), found.course.refused);
    assert!(shares[0] > 0.01 && found.course.last.contact_share() < 0.5 * shares[0]);
    assert!(found.blocks.iter().all(|b| b.error_m <= options.tolerance_m));
    // The edge that the journal leans on, and only that one.
    let mesh = model.film().mesh().unwrap();
    let row =
        |j: usize| (0..mesh.n_phi).map(|i| found.course.worn_m.shell[i * mesh.n_z + j]).fold(0.0, f64::max);
    let (one, other) = (row(0), row(mesh.n_z - 1));
    assert!(one.max(other) > 1e-7 && one.min(other) < 0.2 * one.max(other), "{one} {other}");
    // Volume of every block: K / H times load times way, from the friction of contact.
    let friction = 0.08;
    let area = std::f64::consts::PI * 0.125 * 0.060 / mesh.cells() as f64;
    for (k, block) in found.blocks.iter().enumerate() {
        let after = found.blocks.get(k + 1).map_or(&found.course.worn_m, |next| &next.worn_m);
        let depth: f64 = after.shell.iter().zip(&block.worn_m.shell).map(|(a, b)| a - b).sum();
        let way: f64 = block.rates.iter().map(|r| r.mean(BearingOutput::ContactLoss)).sum::<f64>() / friction;
        let archard = WEAR * 0.5 * block.length_s * way;
        assert!((depth * area / archard - 1.0).abs() < 1e-10, "block {k}: {} {archard}", depth * area);
    }
}

#[test]
fn blocks_converge_with_second_order() {
    let study = leaning(&[]);
    let (stage, orbit) = stage(&study, 3600.0);
    let (model, options) = (stage.model.clone(), options(orbit));
    let stages = [stage];
    let with = |n: usize| {
        let shares = vec![vec![1.0 / n as f64; n]];
        let found = replay(&stages, &shares, &options, None, &Cancel::default()).unwrap();
        [RunningInQuantity::EnergyLost, RunningInQuantity::WearVolume].map(|q| q.value(&found.course, &model))
    };
    let [coarse, middle, fine] = [6, 12, 24].map(with);
    for k in 0..2 {
        let order = ((coarse[k] - middle[k]) / (middle[k] - fine[k])).abs().log2();
        println!("quantity {k}: order {order:.2}");
        assert!(order > 1.5, "{order}");
    }
}

/// Largest difference of two worn shells over the largest depth of the second.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let off = a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    off / b.iter().copied().fold(0.0, f64::max)
}

#[test]
fn predicted_cycles_lead_to_the_same_surfaces_with_fewer_solved_ones() {
    let study = leaning(&[]);
    for (duration_s, tolerance_m) in [(3600.0, 2e-8), (14400.0, 2e-8)] {
        let (stage, orbit) = stage(&study, duration_s);
        let options = MarchOptions { tolerance_m, ..options(orbit) };
        let stages = [stage];
        let full = run(&stages, &options).course;
        let found = march_predicted(&stages, &options, &Cancel::default(), &mut |_| {}).unwrap();
        let course = &found.course;
        let [solved, of] = [course, &full].map(|c| c.cost.simulations);
        let [work, of_work] = [course, &full].map(|c| c.cost.factorisations);
        let miss = apart(&course.worn_m.shell, &full.worn_m.shell);
        let energy = course.energy_j / full.energy_j - 1.0;
        println!(
            "{duration_s} s, {tolerance_m:.0e} m: {solved} of {of} cycles solved ({} windows, {} refused), {:.2} of the \
             factorisations, shells {miss:.1e} apart, energy {energy:.1e}, largest error {:.1e} m",
            found.windows,
            course.refused,
            work as f64 / of_work as f64,
            found.error_m
        );
        assert!(miss < 0.01 && energy.abs() < 1e-3 && found.error_m <= tolerance_m);
        assert!(solved as f64 <= 0.65 * of as f64 && work as f64 <= 0.65 * of_work as f64, "{solved} {of}");
    }
}

const PROGRAMME: &str = "[running_in]\nwear_depth_tolerance = \"0.05 um\"\n\
    [[running_in.stages]]\nname = \"slow\"\nduration = \"30 min\"\nspeed = \"1000 rpm\"\nload_factor = 0.6\n\
    [[running_in.stages]]\nname = \"rated\"\nduration = \"2 h\"\nspeed = \"1500 rpm\"\noil_inlet_temperature = \"70 degC\"\n";

#[test]
fn a_study_runs_its_design_in_and_reports_it() {
    let with = format!("{PROGRAMME}{COARSE}");
    let rough = "journal = \"0.4 um\"\nwear_coefficient = \"3e-7 mm3/(N m)\"";
    let study = main_study(&[
        ("[oil]", &with),
        ("kind = \"big-end\"", "kind = \"big-end\"\ntilt_x = \"0.015 deg\""),
        ("journal = \"0.2 um\"", rough),
        (
            "quantity = \"max-film-pressure\"\nat_most = \"300 MPa\"",
            "quantity = \"contact-loss\"\nat_most = \"30 W\"",
        ),
        (
            "quantity = \"min-film-thickness\"\nat_least = \"3 um\"",
            "quantity = \"min-film-thickness\"\nat_least = \"0.3 um\"",
        ),
    ]);
    let findings = quietly(|context| stribeck::study::run(&study, context));
    let report = &findings.report;
    let bearing = &report.running_in.as_ref().unwrap().bearings[0];
    assert_eq!(bearing.failure, None);
    // New surfaces are those of the search.
    let new = bearing.operating_points[0].new.loss_w;
    assert!((new / report.objective.optimum.unwrap().total_w - 1.0).abs() < 1e-6);
    let run_in = bearing.operating_points[0].run_in.unwrap();
    assert!(run_in.contact_loss_w < bearing.operating_points[0].new.contact_loss_w);
    // Times, depths and volumes rise; the two stages end where they should.
    for pair in bearing.blocks.windows(2) {
        assert!(pair[1].time_h >= pair[0].time_h && pair[1].wear_volume_mm3 >= pair[0].wear_volume_mm3);
    }
    let end = |stage: &str| bearing.blocks.iter().rfind(|b| b.stage == stage).unwrap().time_h;
    assert!((end("slow") - 0.5).abs() < 1e-9 && (end("rated") - 2.5).abs() < 1e-9);
    let volume: f64 = bearing.wear_depth_um.iter().flatten().sum::<f64>() * 1e-3;
    let cells = bearing.wear_depth_um.iter().flatten().count() as f64;
    let width = |name: &str| report.design.iter().find(|d| d.name.ends_with(name)).unwrap().value;
    let area = std::f64::consts::PI * width("diameter") * width("width") / cells;
    assert!((volume * area / bearing.wear_volume_mm3 - 1.0).abs() < 1e-9);
    let folder = tempfile::tempdir().unwrap();
    stribeck::report::write_folder(&stribeck::report::files(&findings, false).unwrap(), folder.path())
        .unwrap();
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(text("running-in.csv").lines().count(), 1 + bearing.blocks.len());
    assert!(text("wear.csv").starts_with("bearing,surface,angle_deg,axial_mm,wear_depth_um"));
    assert!(text("report.html").contains("Running-in of the design") && !text("report.html").contains("NaN"));
}

/// The main study on a coarse mesh with a leaning journal and a programme of one hour; clearance, width and what is added vary.
/// Several tests halve its steps: limits, programmes and ends of stages are kept by the same march on any step.
fn running_in_study(running_in: &str, more: &str, changes: &[(&str, &str)]) -> Study {
    let stage = "[[running_in.stages]]\nname = \"rated\"\nduration = \"1 h\"\nspeed = \"1500 rpm\"\n";
    let with = format!("[running_in]\n{running_in}{stage}{COARSE}");
    let rough = "journal = \"0.4 um\"\nwear_coefficient = \"3e-7 mm3/(N m)\"";
    let fixed = "name = \"big_end.diameter\"\nlower = \"112 mm\"\nupper = \"128 mm\"\n\n[[parameters]]\n";
    let cooled =
        "[[parameters]]\nname = \"oil.inlet_temperature\"\nlower = \"60 degC\"\nupper = \"90 degC\"\n\n";
    let mut all = vec![
        ("[oil]", with.as_str()),
        ("kind = \"big-end\"", "kind = \"big-end\"\ntilt_x = \"0.012 deg\""),
        ("journal = \"0.2 um\"", rough),
        (fixed, ""),
        (cooled, more),
        (
            "quantity = \"max-film-pressure\"\nat_most = \"300 MPa\"",
            "quantity = \"contact-loss\"\nat_most = \"50 W\"",
        ),
        (
            "quantity = \"min-film-thickness\"\nat_least = \"3 um\"",
            "quantity = \"min-film-thickness\"\nat_least = \"0.2 um\"",
        ),
    ];
    all.extend_from_slice(changes);
    main_study(&all)
}

#[test]
fn a_running_in_design_loses_less_within_its_wear_limits() {
    let asked =
        "minimise = \"mean-loss\"\nmax_wear_volume = \"0.1 mm3\"\nwear_depth_tolerance = \"0.5 um\"\n";
    let study = running_in_study(asked, "", &[("steps_per_cycle = 240", "steps_per_cycle = 120")]);
    let report = quietly(|context| stribeck::study::run(&study, context)).report;
    let running_in = report.running_in.as_ref().unwrap();
    println!("{:?} {:?} {:#?}", report.outcome, running_in.limits, report.design);
    assert_eq!(report.outcome.status, stribeck::optimise::Outcome::Converged);
    let limit = &running_in.limits[0];
    assert!(limit.met && limit.active && limit.price_w_per_unit > 0.0, "{limit:?}");
    // What the run marched anew agrees with what the search saw in its own blocks.
    let (minimised, bearing) = (running_in.minimised.as_ref().unwrap(), &running_in.bearings[0]);
    assert!((bearing.mean_loss_w / minimised.optimum - 1.0).abs() < 1e-3);
    assert!((bearing.wear_volume_mm3 / limit.value - 1.0).abs() < 0.1);
    assert!(report.objective.quantity.contains("running-in"));
    // The gradient through the march is proven where it was used last.
    let gradient = running_in.gradient.as_ref().unwrap();
    println!("{gradient:?}");
    assert!(gradient.apart < 1e-4 && gradient.effect_w_per_percent.len() == 2, "{gradient:?}");
}

#[test]
fn limits_on_the_run_in_bearing_hold_in_the_end_and_not_before() {
    // Without this limit the film in the end is 0.52 um thick.
    let asked = "minimise = \"mean-loss\"\nwear_depth_tolerance = \"0.1 um\"\n\
        constraints = [{ quantity = \"min-film-thickness\", at_least = \"0.57 um\" }]\n";
    let free = (
        "quantity = \"contact-loss\"\nat_most = \"50 W\"",
        "quantity = \"side-flow\"\nat_most = \"1000 l/min\"",
    );
    let coarser = ("steps_per_cycle = 240", "steps_per_cycle = 120");
    let study = running_in_study(asked, "", &[coarser, free]);
    let report = quietly(|context| stribeck::study::run(&study, context)).report;
    let running_in = report.running_in.as_ref().unwrap();
    let (limit, bearing) = (&running_in.limits[0], &running_in.bearings[0]);
    println!("{:?} {limit:?} {:?}", report.outcome.status, bearing.operating_points);
    assert_eq!(report.outcome.status, stribeck::optimise::Outcome::Converged);
    assert_eq!((limit.quantity.as_str(), limit.sense.as_str()), ("min-film-thickness-run-in", "at least"));
    assert!(limit.met && limit.active && limit.price_w_per_unit > 0.0, "{limit:?}");
    assert!(bearing.operating_points[0].new.min_film_thickness_um < 0.5, "it holds when run in, not before");
    // The design marched anew keeps it, to what its blocks leave.
    let last = bearing.blocks.last().unwrap();
    assert!((last.min_film_thickness_um / limit.value - 1.0).abs() < 0.02, "{last:?} {limit:?}");
}

#[test]
fn the_programme_is_designed_with_the_bearing_and_the_approximation_leads_to_the_same_design() {
    let more =
        "[[parameters]]\nname = \"running_in.rated.duration\"\nlower = \"0.25 h\"\nupper = \"3 h\"\n\n";
    let asked = |first: bool| {
        format!(
            "minimise = \"final-loss\"\nmax_energy_lost = \"4000 kJ\"\nwear_depth_tolerance = \"0.03 um\"\n\
             approximate_first = {first}\n"
        )
    };
    let run = |first| {
        let fixed = "name = \"big_end.width\"\nlower = \"45 mm\"\nupper = \"65 mm\"\n\n[[parameters]]\n";
        let coarser = ("steps_per_cycle = 240", "steps_per_cycle = 120");
        let study = running_in_study(&asked(first), more, &[coarser, (fixed, "")]);
        quietly(|context| stribeck::study::run(&study, context)).report
    };
    let (plain, approximated) = (run(false), run(true));
    for report in [&plain, &approximated] {
        let r = report.running_in.as_ref().unwrap();
        println!("{:?} {:?} {:?} {:?}", report.outcome.status, r.minimised, r.approximation, r.limits);
        println!("{:?} {:?}", report.design.iter().map(|d| d.value).collect::<Vec<_>>(), report.cost);
        assert_eq!(report.outcome.status, stribeck::optimise::Outcome::Converged);
        assert!(r.limits.iter().all(|l| l.met));
    }
    for (a, b) in plain.design.iter().zip(&approximated.design) {
        assert!((a.value - b.value).abs() < 0.02 * (a.upper - a.lower), "{} {} {}", a.name, a.value, b.value);
    }
    let of = |report: &stribeck::report::Report| {
        let r = report.running_in.as_ref().unwrap();
        (r.minimised.clone().unwrap().optimum, r.approximation.clone())
    };
    let ((a, none), (b, some)) = (of(&plain), of(&approximated));
    assert!((a / b - 1.0).abs() < 2e-3 && none.is_none(), "{a} {b}");
    let some = some.unwrap();
    assert!(2 * some.groups <= some.blocks && some.start_error_percent.abs() < 1.0);
    assert!((some.alpha.iter().sum::<f64>() - 0.5).abs() < 1e-12, "half, for both ends of each group");
}

#[test]
fn a_stage_ends_early_when_blocks_change_little() {
    use stribeck::running_in::Settled;
    let study = leaning(&[("steps_per_cycle = 240", "steps_per_cycle = 120")]);
    let (stage, orbit) = stage(&study, 36000.0);
    let settled = Some(Settled { loss_share_per_s: 1e-6, depth_m_per_s: 5e-11 });
    let options = MarchOptions { settled, ..options(orbit) };
    let stages = [stage];
    let found = run(&stages, &options);
    let predicted = march_predicted(&stages, &options, &Cancel::default(), &mut |_| {}).unwrap();
    println!("{} s, {} s predicted", found.course.duration_s, predicted.course.duration_s);
    for course in [&found.course, &predicted.course] {
        assert!(course.duration_s < 36000.0 && course.duration_s > 600.0);
        assert!((course.last_duration_s - course.duration_s).abs() < 1e-9);
    }
    // Frozen blocks repeat the shortened programme.
    let again = replay(&stages, &found.shares(&stages), &options, None, &Cancel::default()).unwrap();
    assert!((again.course.duration_s / found.course.duration_s - 1.0).abs() < 1e-12);
    assert!((again.course.energy_j / found.course.energy_j - 1.0).abs() < 1e-9);
}

#[test]
fn surfaces_that_wear_smooth_touch_less() {
    use stribeck::cranktrain::{BearingSetup, JournalBearing, Smoothing};
    let study = leaning(&[("steps_per_cycle = 240", "steps_per_cycle = 120")]);
    let (stage, orbit) = stage(&study, 1200.0);
    let smooths = |left: f64| {
        let smoothing = Some(Smoothing { left, depth_m: 2e-7 });
        let setup = BearingSetup { smoothing, ..stage.model.setup().clone() };
        let stages = [Stage::new(JournalBearing::new(setup).unwrap(), 1200.0)];
        march_predicted(&stages, &options(orbit), &Cancel::default(), &mut |_| {}).unwrap().course
    };
    let [rough, smooth] = [1.0, 0.4].map(smooths);
    println!("contact share {} {}", rough.last.contact_share(), smooth.last.contact_share());
    // Without smoothing the option changes nothing but rounding.
    let stages = [stage];
    let plain = march_predicted(&stages, &options(orbit), &Cancel::default(), &mut |_| {}).unwrap().course;
    assert!((rough.energy_j / plain.energy_j - 1.0).abs() < 1e-9);
    // New surfaces are the same, run-in ones are not.
    assert!((smooth.moments[0].rate.loss_w() / rough.moments[0].rate.loss_w() - 1.0).abs() < 1e-9);
    assert!(smooth.last.contact_share() < 0.95 * rough.last.contact_share());
}

/// Takes what is saved, up to a number of times: what a process that is killed leaves behind.
#[derive(Default)]
struct Killed {
    saved: std::sync::Mutex<std::collections::BTreeMap<String, Vec<u8>>>,
    left: std::sync::atomic::AtomicI64,
}

impl stribeck::run::Store for Killed {
    fn load(&self, name: &str) -> Option<Vec<u8>> {
        self.saved.lock().unwrap().get(name).cloned()
    }

    fn save(&self, name: &str, what: &[u8]) {
        if self.left.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) > 0 {
            self.saved.lock().unwrap().insert(name.to_owned(), what.to_vec());
        }
    }
}

#[test]
fn a_running_in_design_goes_on_where_it_was_stopped_to_the_same_report() {
    let asked =
        "minimise = \"mean-loss\"\nmax_wear_volume = \"0.1 mm3\"\nwear_depth_tolerance = \"0.5 um\"\n";
    let study = running_in_study(asked, "", &[("steps_per_cycle = 240", "steps_per_cycle = 120")]);
    let run = |store: &Killed| {
        let mut report = quietly(|context| stribeck::study::run_saved(&study, context, store)).report;
        report.timing.seconds = 0.0;
        report
    };
    let whole = run(&Killed::default());
    let store = Killed { left: 7.into(), ..Killed::default() };
    run(&store);
    let names: Vec<String> = store.saved.lock().unwrap().keys().cloned().collect();
    assert!(names.contains(&"search-marches-0".to_owned()), "{names:?}");
    assert_eq!(serde_json::to_value(run(&store)).unwrap(), serde_json::to_value(&whole).unwrap());
}

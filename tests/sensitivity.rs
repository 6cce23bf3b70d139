//! The sensitivity map: the derivative of the mean loss by the local gap, against what is known of it.

use crate::common::{COARSE, main_study, quietly, smooth_study};
use stribeck::cranktrain::{BearingParameter, GapSensitivity, JournalBearing};
use stribeck::dae::Dae;
use stribeck::gradient::{EngineName, GradientTable, engine};
use stribeck::orbit::{OrbitOptions, Quantity, settle};
use stribeck::run::Cancel;
use stribeck::study::{Study, plan, run};

fn adjoint(study: &Study) -> (JournalBearing, GradientTable) {
    let (model, options, of): (JournalBearing, OrbitOptions, Vec<Quantity>) = quietly(|run| {
        let plan = plan(study, EngineName::Adj, run).unwrap();
        let case = &plan.problem.cases()[0];
        (case.model.clone(), case.options, case.quantities.clone())
    });
    let orbit = settle(&model, &options, None, &Cancel::default()).unwrap();
    let table =
        engine(EngineName::Adj, 0.0).gradient(&model, &orbit, &options, &of, &Cancel::default()).unwrap();
    (model, table)
}

/// Integral of a map over the surface.
fn integral(model: &JournalBearing, map: &[Vec<f64>]) -> f64 {
    let area = std::f64::consts::PI * model.setup().diameter_m * model.setup().width_m;
    map.iter().flatten().sum::<f64>() * area / (map.len() * map[0].len()) as f64
}

fn map(model: &JournalBearing, table: &GradientTable) -> GapSensitivity {
    model.gap_sensitivity(&table.fields[0]).unwrap()
}

#[test]
fn a_gap_that_widens_everywhere_is_a_larger_clearance() {
    // Nothing but the gap knows the clearance where no opening ties a cell to the supply.
    let pressed = ("cavitation = \"swift-stieber\"\n", "side_pressure = \"2 bar\"\n");
    let (model, table) = adjoint(&smooth_study(&[("[oil]", COARSE), pressed]));
    let clearance = model.setup().parameters.iter().position(|p| *p == BearingParameter::DiametralClearance);
    let by_radial_clearance = 2.0 * table.rows[0][clearance.unwrap()];
    let found = map(&model, &table);
    for (name, surface) in [("shell", &found.shell), ("journal", &found.journal)] {
        let everywhere = integral(&model, surface);
        let miss = (everywhere / by_radial_clearance - 1.0).abs();
        assert!(miss < 1e-9, "{name}: {everywhere} {by_radial_clearance}");
    }
}

#[test]
fn a_coefficient_of_a_profile_has_the_projection_of_the_map_as_derivative() {
    let shape = "[oil]\n[[bearings.big_end.shapes]]\nname = \"crown\"\nkind = \"barrel\"\nheight = \"1 um\"\n[[parameters]]\nname = \"big_end.shapes.crown.height\"\nlower = \"0 um\"\nupper = \"9 um\"\n[oil]";
    let study = main_study(&[("[oil]", COARSE), ("[oil]", shape)]);
    let (model, table) = adjoint(&study);
    let found = map(&model, &table).shell;
    // The crown adds height zeta^2 to the gap.
    let across = found[0].len();
    let crown = |j: usize| ((2 * j + 1) as f64 / across as f64 - 1.0).powi(2);
    let weighted: Vec<Vec<f64>> =
        found.iter().map(|row| row.iter().enumerate().map(|(j, v)| v * crown(j)).collect()).collect();
    let projected = integral(&model, &weighted);
    let height = model.setup().parameters.iter().position(|p| matches!(p, BearingParameter::Shape(..)));
    // The heat balance is in both, through its own equation.
    let derivative = table.rows[0][height.unwrap()];
    assert!((projected / derivative - 1.0).abs() < 1e-9, "{projected} {derivative}");
    assert_eq!(model.parameters().len(), 4 + 1 + 1, "four of the study, the crown, the film temperature");
}

#[test]
fn the_report_holds_the_map_as_picture_table_and_grid() {
    let study = main_study(&[("[oil]", COARSE), ("[oil]", "[optimiser]\nmax_iterations = 1\n[oil]")]);
    let findings = quietly(|context| run(&study, context));
    let short = &findings.report.gradient.as_ref().unwrap().gap_sensitivity[0];
    assert!(
        short.shell.saves_most.w_per_um_cm2 < 0.0 && short.journal.costs_most.w_per_um_cm2 > 0.0,
        "{short:?}"
    );
    let csv = stribeck::report::sensitivity_csv(&findings).unwrap();
    assert_eq!(csv.lines().count(), 1 + 2 * 36 * 8, "two surfaces, 36 columns, both halves");
    let grids = stribeck::report::film_vtk(&findings.curves[0]);
    assert_eq!(grids.len(), 2);
    let (name, shell) = &grids[0];
    assert_eq!(*name, "shell");
    assert!(shell.contains("WholeExtent=\"0 8 0 36 0 0\"") && shell.contains("Name=\"fill\""));
    let numbers = shell.lines().filter(|l| l.starts_with(|c: char| c == '-' || c.is_ascii_digit()));
    assert_eq!(numbers.count(), 37 * 9 + 3 * 36, "points, then three fields by rows");
    assert!(stribeck::report::html(&findings).unwrap().contains("Where a micrometre of gap on the shell"));
}

//! Patterns against the interface, names and values against a study.

use super::*;
use crate::study::catalogue::example::study;

#[test]
fn patterns_are_those_of_the_interface_and_all_have_a_meaning() {
    let list = parameters(None);
    let names: Vec<&str> = list.iter().map(|e| e.name.as_str()).collect();
    for name in [
        "<bearing>.width",
        "<bearing>.diametral_clearance",
        "<bearing>.tilt_y",
        "<bearing>.roughness.shell",
        "<bearing>.supply.pressure",
        "<bearing>.shapes.<shape>.offset",
        "<bearing>.shapes.<shape>.length_share",
        "<bearing>.shapes.<shape>.scale",
        "<bearing>.shapes.<shape>.coefficients[*]",
        "<bearing>.shapes.<shape>.coefficients[<number>]",
        "oil.inlet_temperature",
        "running_in.<stage>.duration",
        "running_in.<stage>.oil_inlet_temperature",
    ] {
        assert_eq!(names.iter().filter(|n| **n == name).count(), 1, "{name} in {names:?}");
    }
    assert_eq!(names.len(), 21, "{names:?}");
    assert!(list.iter().all(|e| !e.meaning.is_empty() && e.value.is_none() && e.bounds.is_none()));
}

#[test]
fn a_study_lists_its_values_and_boxes() {
    let coefficients = "name = \"bearing.width\"\nlower = \"30 mm\"\nupper = \"60 mm\"\n\n[[parameters]]\n\
                        name = \"bearing.shapes.spline.coefficients[*]\"\nlower = \"-1 um\"\nupper = \"2 um\"";
    let width = "name = \"bearing.width\"\nlower = \"30 mm\"\nupper = \"60 mm\"";
    let list = parameters(Some(&study(&[(width, coefficients)])));
    let of = |name: &str| list.iter().find(|e| e.name == name).unwrap();
    assert_eq!((of("bearing.width").value, of("bearing.width").bounds), (Some(40.0), Some([30.0, 60.0])));
    assert_eq!((of("bearing.diameter").value, of("bearing.diameter").bounds), (Some(80.0), None));
    assert_eq!(of("oil.inlet_temperature").value, Some(45.0));
    assert_eq!(of("running_in.stage.duration").value, Some(5.0));
    let all = of("bearing.shapes.spline.coefficients[*]");
    assert_eq!((all.value, all.bounds, all.start), (Some(0.0), Some([-1.0, 2.0]), Some(0.0)));
    let last = of("bearing.shapes.spline.coefficients[11]");
    assert_eq!(last.bounds, Some([-1.0, 2.0]));
    assert!(all.covers(last) && !all.covers(all) && !last.covers(all) && !all.covers(of("bearing.width")));
}

#[test]
fn what_has_no_effect_is_no_parameter() {
    let programme = "[running_in]\nminimise = \"mean-loss\"";
    let changes =
        [("grade = \"ISO VG 46\"", "dynamic_viscosity = \"20 mPa s\""), (programme, "[running_in]")];
    let names: Vec<String> = parameters(Some(&study(&changes))).into_iter().map(|e| e.name).collect();
    assert!(names.iter().all(|n| !n.starts_with("oil.") && !n.starts_with("running_in.")), "{names:?}");
}

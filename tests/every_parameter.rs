//! FW, BW, CEN, TRA and ADJ against each other for every kind of parameter a case has: smooth and rough, full and starved,
//! heat on and off, big-end, main and table load, mobility, Reynolds and mass-conserving film, one and two operating points.
//!
//! TRA and ADJ agree to 1e-9 everywhere. CEN agrees with them to 1e-5, or the check names the kink.

use crate::common::{here, merged, quietly};
use stribeck::gradient::Finding;
use stribeck::study::{Format, Study, prove};

const FRAME: &str = r#"
format = "stribeck-study/1"
title = "every parameter"

[machine]
bore = "170 mm"
throw = "107.5 mm"
throw_over_rod = 0.274
oscillating_mass = "11.5 kg"
rotating_mass = "11.3 kg"

[cylinder_pressure]
source = "table"
table.file = "data/engine_pressure_170x215_digitised.csv"

[bearings.b]
kind = "big-end"
width = "55 mm"
diameter = "125 mm"
diametral_clearance = "110 um"

[film]
cells_around = 24
cells_across_half = 3

[orbit]
steps_per_cycle = 120
memory = "100 MB"

[oil]
grade = "SAE 40"
inlet_temperature = "75 degC"
film_temperature_rise = "18 K"

[[objective.operating_points]]
name = "rated"
speed = "1500 rpm"
load_factor = 0.4

[[parameters]]
name = "b.width"
lower = "45 mm"
upper = "65 mm"
[[parameters]]
name = "b.diameter"
lower = "112 mm"
upper = "128 mm"
[[parameters]]
name = "b.diametral_clearance"
lower = "70 um"
upper = "180 um"
[[parameters]]
name = "oil.inlet_temperature"
lower = "60 degC"
upper = "90 degC"
"#;

/// Sections of a case and the parameters that come with them: `name lower upper`.
struct Case {
    name: &'static str,
    changes: &'static [(&'static str, &'static str)],
    sections: &'static str,
    parameters: &'static [&'static str],
    limits: &'static str,
}

const SUPPLY: &str = "[bearings.b.supply]\npressure = \"4 bar\"\n[[bearings.b.supply.openings]]\nkind = \"circumferential-groove\"\nstart = \"130 deg\"\nextent = \"100 deg\"\nwidth_share = 0.3\n";
const STARVED: &str = "[bearings.b.supply]\npressure = \"1 bar\"\n[[bearings.b.supply.openings]]\nkind = \"circumferential-groove\"\nstart = \"130 deg\"\nextent = \"100 deg\"\nwidth_share = 0.12\n";
const FILM_LIMIT: &str = "[[constraints]]\nquantity = \"min-film-thickness\"\nat_least = \"1 um\"\n";
const SIDE_FLOW: &str = "[[constraints]]\nquantity = \"side-flow\"\nat_least = \"0.1 l/min\"\n";
const SMOOTH_SS: &str = "[film]\ncavitation = \"swift-stieber\"\n";
const TILTS: [&str; 2] = ["b.tilt_x|-0.01 deg|0.01 deg", "b.tilt_y|-0.01 deg|0.01 deg"];
/// Stands for [`load_table`].
const LOAD_TABLE: &str = "LOAD TABLE";
const BIG_END: &str = "kind = \"big-end\"";

const CASES: &[Case] = &[
    Case {
        name: "mobility, big end",
        changes: &[],
        sections: "[film]\nmodel = \"mobility\"\n",
        parameters: &[],
        limits: FILM_LIMIT,
    },
    Case {
        name: "mobility with heat, two operating points",
        changes: &[(
            "load_factor = 0.4",
            "load_factor = 0.4\n[[objective.operating_points]]\nname = \"part\"\nspeed = \"1200 rpm\"\nload_factor = 0.2",
        )],
        sections: "[film]\nmodel = \"mobility\"\n[bearings.b.heat_balance]\n",
        parameters: &[],
        limits: "[[constraints]]\nquantity = \"film-temperature\"\nat_most = \"120 degC\"\n",
    },
    Case {
        name: "smooth Swift-Stieber, tilted",
        changes: &[],
        sections: SMOOTH_SS,
        parameters: &TILTS,
        limits: FILM_LIMIT,
    },
    Case {
        name: "smooth Swift-Stieber, shapes of the shell",
        changes: &[],
        sections: "[film]\ncavitation = \"swift-stieber\"\n[bearings.b]\nshapes = [{ name = \"l\", kind = \"lemon\", offset = \"3 um\", angle = \"10 deg\" }, { name = \"o\", kind = \"offset\", offset = \"2 um\", angle = \"80 deg\" }, { name = \"s\", kind = \"spline\", around = 4, across = 3 }, { name = \"r\", kind = \"edge-relief\", depth = \"4 um\", length_share = 0.2 }]\n",
        parameters: &[
            "b.shapes.l.offset|0 um|9 um",
            "b.shapes.l.angle|-20 deg|30 deg",
            "b.shapes.o.offset|0 um|9 um",
            "b.shapes.o.angle|60 deg|100 deg",
            "b.shapes.s.coefficients[*]|-2 um|9 um",
            "b.shapes.r.depth|0 um|9 um",
            "b.shapes.r.length_share|0.1|0.4",
        ],
        limits: "",
    },
    Case {
        name: "full mass-conserving film, journal shapes that turn",
        changes: &[],
        sections: "[film]\nside_pressure = \"2 bar\"\n[bearings.b]\nshapes = [{ name = \"p\", kind = \"barrel\", on = \"journal\", height = \"2 um\" }, { name = \"c\", kind = \"cone\", on = \"journal\", height = \"2 um\" }, { name = \"s\", kind = \"spline\", on = \"journal\", around = 4, across = 3 }, { name = \"t\", kind = \"table\", on = \"journal\", table = { columns = [\"angle_deg\", \"zeta\", \"height_um\"], rows = [[0, -1, 0], [0, 1, 1], [120, -1, 0.5], [120, 1, 0], [240, 1, 0], [240, -1, 1]] } }]\n",
        parameters: &[
            "b.shapes.p.height|0 um|9 um",
            "b.shapes.c.height|-5 um|9 um",
            "b.shapes.s.coefficients[*]|-2 um|9 um",
            "b.shapes.t.scale|0.5|2",
        ],
        limits: FILM_LIMIT,
    },
    Case {
        name: "starved mass-conserving film",
        // A smooth starved film with so little oil needs a finer mesh to bear the load.
        changes: &[
            ("cells_around = 24\ncells_across_half = 3", "cells_around = 48\ncells_across_half = 4"),
            ("steps_per_cycle = 120", "steps_per_cycle = 240"),
        ],
        sections: STARVED,
        parameters: &["b.supply.pressure|0.5 bar|6 bar"],
        limits: SIDE_FLOW,
    },
    Case {
        name: "rough with contact and heat",
        changes: &[],
        sections: "[bearings.b.heat_balance]\n[bearings.b.roughness]\njournal = \"0.3 um\"\nshell = \"0.6 um\"\n",
        parameters: &[
            "b.supply.pressure|2 bar|6 bar",
            "b.roughness.journal|0.2 um|1 um",
            "b.roughness.shell|0.2 um|1 um",
        ],
        limits: "[[constraints]]\nquantity = \"contact-loss\"\nat_most = \"500 W\"\n[[constraints]]\nquantity = \"wear-rate\"\nat_most = \"1 mm3/h\"\n",
    },
    Case {
        name: "main bearing, rough without contact, free tilt",
        changes: &[(BIG_END, "kind = \"main\"\nmain_bearing = 2"), ("[cylinder_pressure]", V8)],
        sections: "[bearings.b]\nfree_tilt = true\nroughness = { journal = \"0.3 um\", shell = \"0.6 um\", contact = \"none\" }\n",
        parameters: &["b.roughness.journal|0.2 um|1 um", "b.supply.pressure|2 bar|6 bar"],
        limits: "[[constraints]]\nquantity = \"hydrodynamic-loss\"\nat_most = \"5 kW\"\n",
    },
    Case {
        name: "load from a table, journal with mass, implicit Euler, two operating points",
        changes: &[
            (BIG_END, LOAD_TABLE),
            ("[orbit]", "[orbit]\nscheme = \"bdf1\""),
            (
                "load_factor = 0.4",
                "load_factor = 1\n[[objective.operating_points]]\nname = \"slow\"\nspeed = \"1100 rpm\"\nload_factor = 0.7",
            ),
        ],
        sections: "[film]\ncavitation = \"swift-stieber\"\n[bearings.b]\njournal_mass = \"40 kg\"\n",
        parameters: &["b.tilt_y|-0.01 deg|0.01 deg"],
        limits: "[[constraints]]\nquantity = \"specific-load\"\nat_most = \"100 MPa\"\n",
    },
];

const V8: &str = r#"vee_angle = "90 deg"
throw_angles = ["0 deg", "90 deg", "270 deg", "180 deg"]
firing_order = ["A1", "A3", "A4", "B1", "B3", "B4", "B2", "A2"]
throw_mass = "4 kg"

[cylinder_pressure]"#;

/// A load that turns and swells, in kN, over a cycle in steps of 15 degrees.
fn load_table() -> String {
    let row = |k: u32| {
        let a = f64::from(15 * k).to_radians();
        let size = 30.0 + 20.0 * (a / 2.0).cos();
        format!("[{}, {:.4}, {:.4}]", 15 * k, size * a.cos() + 15.0, size * a.sin())
    };
    let rows: Vec<String> = (0..48).map(row).collect();
    let columns = "columns = [\"crank_angle_deg\", \"force_x_kn\", \"force_y_kn\"]";
    format!("kind = \"table\"\nload = {{ {columns}, rows = [{}] }}", rows.join(", "))
}

fn study(case: &Case) -> Study {
    let mut text = FRAME.to_owned();
    for (from, to) in case.changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    if case.sections.contains("mobility") {
        text = text.replace("cells_around = 24\ncells_across_half = 3\n", "");
    }
    if text.contains(LOAD_TABLE) {
        text = text.replace(LOAD_TABLE, &load_table());
        let (from, to) = (text.find("[machine]").unwrap(), text.find("[bearings.b]").unwrap());
        text.replace_range(from..to, "");
    }
    let fed = case.sections.contains("supply")
        || case.sections.contains("swift")
        || case.sections.contains("mobility")
        || case.sections.contains("side_pressure");
    let supply = if fed { "" } else { SUPPLY };
    let parameters: String = case
        .parameters
        .iter()
        .map(|p| {
            let parts: Vec<&str> = p.split('|').collect();
            format!(
                "[[parameters]]\nname = \"{}\"\nlower = \"{}\"\nupper = \"{}\"\n",
                parts[0], parts[1], parts[2]
            )
        })
        .collect();
    let text = merged(&format!("{text}\n{}{supply}{parameters}{}", case.sections, case.limits));
    Study::read(&text, Format::Toml, Some(&here("studies")))
        .unwrap_or_else(|e| panic!("{}: {:#?}\n{text}", case.name, e.faults))
}

#[test]
fn every_kind_of_parameter_has_exact_gradients_in_every_kind_of_case() {
    assert!(CASES.len() >= 8);
    let (mut exact, mut kinks) = (0, 0);
    for case in CASES {
        let study = study(case);
        let proven = quietly(|run| prove(&study, &[1e-4, 1e-5, 1e-6, 1e-7], run)).unwrap();
        assert_eq!(proven.len(), study.points.len());
        for q in proven.iter().flat_map(|p| &p.quantities) {
            println!(
                "{}: {}: {:?}, TRA - ADJ {:.1e}: {}",
                case.name, q.quantity, q.finding, q.mismatch, q.verdict
            );
            assert!(q.mismatch < 1e-9, "{}: {}: {:.1e}", case.name, q.quantity, q.mismatch);
            match q.finding {
                Finding::Exact => exact += 1,
                Finding::Kink => kinks += 1,
                other => panic!("{}: {}: {other:?}: {}", case.name, q.quantity, q.verdict),
            }
        }
    }
    assert!(exact > 2 * kinks, "{exact} confirmed, {kinks} kinks");
}

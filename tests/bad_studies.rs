//! Study files with mistakes: every one is reported, at its place, in words; nothing panics.

use crate::common::{here, merged};
use proptest::prelude::*;
use stribeck::study::{Format, Study, StudyErrors};

fn main_text() -> String {
    std::fs::read_to_string(here(crate::common::SMOOTH)).unwrap()
}

fn errors(text: &str) -> StudyErrors {
    Study::read(text, Format::Toml, Some(&here("studies"))).expect_err("the study has mistakes")
}

#[test]
fn all_mistakes_of_a_file_are_reported_at_once_with_their_lines() {
    let mut text = main_text();
    for (from, to) in [
        ("bore = \"170 mm\"", "bore = 170"),
        ("throw = \"107.5 mm\"", "throw = \"107.5 kg\""),
        ("oscillating_mass = \"11.5 kg\"", "oscilating_mass = \"11.5 kg\""),
        ("density_15c = \"895 kg/m3\"\n", ""),
        ("speed = \"1500 rpm\"", "speed = \"1500\""),
        ("upper = \"65 mm\"", "upper = \"40 mm\""),
        ("name = \"big_end.diameter\"", "name = \"bigend.diameter\""),
        ("at_most = \"300 MPa\"", "at_least = \"300 MPa\""),
        ("quantity = \"specific-load\"", "quantity = \"specific-weight\""),
        ("kind = \"big-end\"", "kind = \"big-end\"\nmain_bearing = 2"),
        ("\"oil.inlet_temperature\" =", "\"oil.outlet_temperature\" ="),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let found = errors(&text);
    let list: Vec<String> = found
        .faults
        .iter()
        .map(|f| format!("line {}: {}: {}", f.line.unwrap_or(0), f.path, f.message))
        .collect();
    insta::assert_snapshot!(list.join("\n"));
}

#[test]
fn each_kind_of_mistake_has_its_words() {
    let one = |from: &str, to: &str| {
        let text = main_text();
        assert!(text.contains(from), "{from}");
        let list = errors(&merged(&text.replacen(from, to, 1))).faults;
        list.iter().map(|f| format!("{}: {}", f.path, f.message)).collect::<Vec<_>>().join(" | ")
    };
    let cases = [
        ("format = \"stribeck-study/1\"", "format = \"stribeck-study/9\""),
        ("[[parameters]]\nname = \"big_end.width\"", "[[parameters]]\nname = \"big_end.depth\""),
        ("[bearings.big_end]", "[bearings.\"big end\"]"),
        ("table.file = \"data/engine_pressure_170x215_digitised.csv\"", "table.file = \"data/none.csv\""),
        (
            "table.file = \"data/engine_pressure_170x215_digitised.csv\"",
            "table.columns = [\"a\"]\ntable.rows = [[1.0], [2.0]]",
        ),
        ("throw_over_rod = 0.274", "throw_over_rod = 1.4"),
        ("throw_over_rod = 0.274", "throw_over_rod = 0.274\nrod_length = \"0.4 m\""),
        ("kinematic_viscosity_100c = \"14 mm2/s\"", "kinematic_viscosity_100c = \"140 mm2/s\""),
        ("diametral_clearance = \"110 um\"", "diametral_clearance = \"11 mm\""),
        ("diametral_clearance = \"110 um\"", "diametral_clearance = \"-110 um\""),
        ("[oil]", "[film]\ncells_around = 4\nmodel = \"jfo\"\n[oil]"),
        ("[film]\ncavitation = \"swift-stieber\"", "[film]\nmodel = \"mobility\"\ncells_around = 72"),
        ("[oil]", "[gradient]\nengine = \"FD\"\n[oil]"),
        ("upper = \"90 degC\"", "upper = \"74 degC\""),
        ("at_least = \"3 um\"", "at_least = \"3 um\"\nat_most = \"4 um\""),
        ("quantity = \"min-film-thickness\"", "quantity = \"min-film-thickness\"\nbearing = \"main\""),
        ("kind = \"big-end\"", "kind = \"main\"\nmain_bearing = 1"),
        ("bore = \"170 mm\"", "bore = \"170 mm\"\nthrow_angles = [\"0 deg\", 5]"),
        (
            "table.file = \"data/engine_pressure_170x215_digitised.csv\"",
            "table.file = \"../operational-170x215.toml\"",
        ),
        (
            "table.file = \"data/engine_pressure_170x215_digitised.csv\"",
            "table.columns = [\"crank_angle_deg\", \"pressure_mpa\"]\ntable.rows = [[0.0, 1.0], [20.0, 2.0], [340.0, 1.0]]",
        ),
        (
            "[oil]",
            "[film]\ncells_around = 2000\ncells_across_half = 200\n[orbit]\nsteps_per_cycle = 100000\n[oil]",
        ),
        ("speed = \"1500 rpm\"", "speed = \"-1500 rpm\""),
        ("upper = \"180 um\"", "upper = \"180 mm\""),
        ("upper = \"65 mm\"", "upper = 65"),
        ("density_15c = \"895 kg/m3\"", "density_15c = nan"),
        ("kind = \"big-end\"", "kind = \"main\"\nmain_bearing = 9"),
        (
            "throw = \"107.5 mm\"",
            "throw = \"107.5 mm\"\nthrow_angles = [\"0 deg\", \"90 deg\"]\nfiring_order = [\"A1\", \"B1\"]",
        ),
        ("title = ", "title = \"twice\"\ntitle = "),
    ];
    let list: Vec<String> = cases.iter().map(|(from, to)| format!("{to:?}\n    {}", one(from, to))).collect();
    insta::assert_snapshot!(list.join("\n"));
}

/// Mistakes in what is asked of a search; each stands before `[oil]`.
const ASKED: &[&str] = &[
    "[running_in]\nstages = []",
    "[running_in]\nwear_depth_tolerance = \"0 um\"\njournal_share = 2\nmax_blocks = 0\n[[running_in.stages]]\nname = \"a\"\nduration = \"2 days\"\nspeed = \"0 rpm\"\nload = 2",
    "[objective]\naggregate = \"worst\"",
    "[objective]\naggregate = \"worst-case\"\n[robust]\ntolerances = []",
    "[robust]\nsigmas = -1\nsamples = 3\n[[robust.tolerances]]\nparameter = \"big_end.clearance\"\nstandard_deviation = \"3 um\"",
    "[[robust.tolerances]]\nparameter = \"oil.inlet_temperature\"\nstandard_deviation = \"3 degC\"",
    "[[robust.tolerances]]\nparameter = \"big_end.width\"\nstandard_deviation = \"0 mm\"\n[[robust.tolerances]]\nparameter = \"big_end.width\"\nstandard_deviation = \"1 mm\"",
    "[optimiser]\npolish = true\n[objective]\naggregate = \"worst-case\"",
    "[[linear_constraints]]\nterms = []\nat_most = \"1 mm\"",
    "[[linear_constraints]]\nterms = [{ parameter = \"big_end.width\" }, { parameter = \"big_end.depth\", factor = 1 }]\nat_most = \"1 mm\"",
    "[[linear_constraints]]\nterms = [{ parameter = \"oil.inlet_temperature\", factor = 1 }]\nat_most = \"80 degC\"",
    "[[linear_constraints]]\nterms = [{ parameter = \"big_end.width\", factor = 1 }]\nat_most = \"80 degC\"",
    "[[linear_constraints]]\nterms = [{ parameter = \"big_end.width\", factor = 0 }]\nat_most = \"80 mm\"\nat_least = \"1 mm\"",
    "[[choices]]\nname = \"oil\"\noptions = [{ name = \"one\", set = { \"oil.density_15c\" = \"900 kg/m3\" } }]",
    "[[choices]]\nname = \"oil\"\noptions = [{ name = \"a\", set = { \"oils.grade\" = \"x\" } }, { name = \"a\", set = { choices = 1 } }, { set = 3 }]",
    "[[choices]]\nname = \"oil\"\noptions = [{ name = \"good\", set = {} }, { name = \"bad\", set = { \"oil.density_15c\" = 900 } }]",
];

#[test]
fn mistakes_in_what_is_asked_have_their_words() {
    let list: Vec<String> = ASKED
        .iter()
        .map(|asked| {
            let text = main_text().replacen("[oil]\n", &format!("{asked}\n[oil]\n"), 1);
            let faults = errors(&merged(&text)).faults;
            let words: Vec<String> = faults.iter().map(|f| format!("{}: {}", f.path, f.message)).collect();
            format!("{asked}\n    {}", words.join("\n    "))
        })
        .collect();
    insta::assert_snapshot!(list.join("\n"));
}

/// Mistakes in the keys of oil, supply, roughness, shapes and heat: what is replaced, and by what.
const PHYSICS: &[(&str, &str)] = &[
    // Oil.
    (SHEET, "grade = \"SAE 10W-40\"\n"),
    (SHEET, ""),
    (SHEET, "grade = \"SAE 40\"\ndensity_15c = \"895 kg/m3\"\n"),
    (SHEET, "dynamic_viscosity = \"10 mPa s\"\nviscosity_law = \"vogel\"\n"),
    (SHEET, "viscosity_points = [{ temperature = \"40 degC\", dynamic_viscosity = \"0.1 Pa s\" }]\n"),
    (SHEET, "viscosity_points = [{ temperature = \"40 degC\" }, { temp = \"80 degC\" }, 3]\n"),
    (
        SHEET,
        "grade = \"mine\"\n[grades.mine]\nkinematic_viscosity_40c = \"139 cSt\"\n[grades.\"sae-40\"]\n[oil]\n",
    ),
    ("[oil]\n", "[oil]\npiezoviscosity = \"barus\"\n"),
    ("[oil]\n", "[oil]\npressure_viscosity_coefficient = \"20 1/GPa\"\nheat_capacity = \"2 kJ/(kg K)\"\n"),
    (
        "[oil]\n",
        "[oil]\nshear_thinning = \"cross\"\nrelaxation_time = \"2 us\"\nsecond_newtonian_ratio = 1.2\n",
    ),
    (
        "[oil]\n",
        "[oil]\nshear_thinning = \"carreau\"\nrelaxation_time = \"2 um\"\nshear_exponent = 1.5\nsecond_newtonian_ratio = 0.5\n",
    ),
    // Film and supply.
    ("cavitation = \"swift-stieber\"", "cavitation = \"mass-conserving\""),
    ("cavitation = \"swift-stieber\"", "cavitation = \"swift-stieber\"\ncavity_shear = \"fill\""),
    (KIND, "kind = \"big-end\"\nsupply = { pressure = \"-2 bar\", openings = [] }"),
    (
        KIND,
        "kind = \"big-end\"\nsupply = { pressure = \"4 bar\", openings = [{ kind = \"hole\", angle = \"0 deg\", extent = \"9 deg\" }, { kind = \"slot\" }, { angle = \"0 deg\" }] }",
    ),
    (
        KIND,
        "kind = \"big-end\"\nsupply = { openings = [{ kind = \"pocket\", angle = \"0 deg\", extent = \"30 deg\", width_share = 0.5, centre = 0.7 }, { kind = \"circumferential-groove\", width_share = 0.2, start = \"10 deg\" }] }",
    ),
    // Roughness.
    (KIND, "kind = \"big-end\"\nroughness = { journal = \"0 um\", shell = \"0 um\" }"),
    (
        KIND,
        "kind = \"big-end\"\nroughness = { journal = \"0.2 um\", shell = \"0.3 mm\", shell_peklenik = 12, elastic_factor = 0.003, asperity_product = 0.04 }",
    ),
    (
        KIND,
        "kind = \"big-end\"\nroughness = { journal = \"0.2 um\", shell = \"0.3 um\", contact = \"none\", boundary_friction = 0.1 }",
    ),
    // Heat.
    (KIND, "kind = \"big-end\"\nheat_balance = { film_share = 1.5, ambient_temperature = \"50 degC\" }"),
    // Tilt and shapes.
    (KIND, "kind = \"big-end\"\nfree_tilt = true\ntilt_x = \"0.01 deg\""),
    (KIND, "kind = \"big-end\"\ntilt_x = \"5 mrad\"\nfree_tilt = \"no\""),
    (
        KIND,
        "kind = \"big-end\"\nshapes = [{ name = \"a b\", kind = \"barrel\", offset = \"3 um\" }, { kind = \"lemon\" }]",
    ),
    (
        KIND,
        "kind = \"big-end\"\nshapes = [{ name = \"a\", kind = \"cone\", height = \"-90 um\" }, { name = \"a\", kind = \"edge-relief\", depth = \"5 um\", length_share = 0 }]",
    ),
    (KIND, "kind = \"big-end\"\nshapes = [{ name = \"a\", kind = \"cone\", height = \"-90 um\" }]"),
    (
        KIND,
        "kind = \"big-end\"\nshapes = [{ name = \"a\", kind = \"spline\", around = 3, across = 2 }, { name = \"b\", kind = \"spline\", around = 4, across = 3, coefficients = [\"1 um\"] }]",
    ),
    (
        KIND,
        "kind = \"big-end\"\nshapes = [{ name = \"a\", kind = \"table\", table = { columns = [\"angle_deg\", \"zeta\", \"height_um\"], rows = [[0, 0, 1], [90, 1, 2]] } }]",
    ),
    // What the mobility film does not know.
    (
        "[film]\ncavitation = \"swift-stieber\"",
        "[film]\nmodel = \"mobility\"\n[bearings.big_end]\ntilt_x = \"0 deg\"\nsupply = {}\nshapes = []\n[oil]\npiezoviscosity = \"none\"",
    ),
    // Parameters and constraints.
    ("name = \"big_end.width\"", "name = \"big_end.roughness.shell\""),
    (
        "name = \"big_end.width\"\nlower = \"45 mm\"\nupper = \"65 mm\"",
        "name = \"big_end.tilt_x\"\nlower = \"-1 deg\"\nupper = \"0.05 deg\"",
    ),
    (
        KIND,
        "kind = \"big-end\"\nshapes = [{ name = \"s\", kind = \"spline\", around = 4, across = 3 }]\n[[parameters]]\nname = \"big_end.shapes.s.coefficients[*]\"\nlower = \"-1 um\"\nupper = \"5\"\n[[parameters]]\nname = \"big_end.shapes.s.coefficients[12]\"\n[bearings.big_end]",
    ),
    ("quantity = \"max-film-pressure\"", "quantity = \"max-contact-pressure\""),
    (
        "quantity = \"max-film-pressure\"\nat_most = \"300 MPa\"",
        "quantity = \"contact-loss\"\nat_least = \"3 W\"",
    ),
    (
        "quantity = \"max-film-pressure\"\nat_most = \"300 MPa\"",
        "quantity = \"film-temperature\"\nat_most = \"90 W\"\n[[constraints]]\nquantity = \"wear-rate\"\nat_least = \"1 mm3/h\"",
    ),
    ("[film]", "[orbit]\nmemory = \"12\"\n[film]"),
    (
        "\"oil.inlet_temperature\" = ",
        "\"bearings.big_end.supply.pressure\" = \"x\"\n\"oil.inlet_temperature\" = ",
    ),
];
const KIND: &str = "kind = \"big-end\"";
const SHEET: &str = "kinematic_viscosity_40c = \"139 mm2/s\"\nkinematic_viscosity_100c = \"14 mm2/s\"\ndensity_15c = \"895 kg/m3\"\n";

#[test]
fn mistakes_in_the_physics_have_their_words_too() {
    let main = main_text();
    // Reasons of assumptions about the data sheet are not what is looked at.
    let main: String =
        main.lines().filter(|l| !l.starts_with("\"oil.kin")).map(|l| format!("{l}\n")).collect();
    let one = |from: &str, to: &str| {
        assert!(main.contains(from), "{from}");
        let list = errors(&merged(&main.replacen(from, to, 1))).faults;
        list.iter().map(|f| format!("    {}: {}", f.path, f.message)).collect::<Vec<_>>().join("\n")
    };
    let list: Vec<String> = PHYSICS.iter().map(|(from, to)| format!("{to:?}\n{}", one(from, to))).collect();
    insta::assert_snapshot!(list.join("\n"));
}

/// Mistakes in a comparison: what stands in front of `[oil]`.
const COMPARISON: &[&str] = &[
    "[comparison]\nengine = [\"ADJ\"]\nperturbation = 1e-6\n",
    "[comparison]\nengines = [\"ADJ\", \"FD\"]\n",
    "[comparison]\nengines = []\nparameter_counts = []\n",
    "[comparison]\nengines = [\"CEN\", \"ADJ\", \"CEN\"]\nperturbations = [1e-4, 1e-4, 0.5, -1e-3]\n",
    "[comparison]\nengines = [\"TRA\", \"ADJ\"]\nperturbations = [1e-4]\n",
    "[comparison]\nperturbations = []\n",
    "[comparison]\nperturbations = 1e-4\n",
    "[comparison]\nparameter_counts = [0, 2, 2, 5, -1]\n",
    "[comparison]\nparameter_counts = [0, 2, 2, 5]\n",
    "comparison = true\n",
    "[comparison]\n[gradient]\nengine = \"TRA\"\nperturbation = 0\n",
    "[comparison]\n[optimiser]\nmax_iterations = 3\naggregate_sharpness = 1\n",
    "[comparison]\n[characteristic]\nvary = \"speed\"\nspeeds = [\"1000 rpm\"]\n",
];

#[test]
fn mistakes_in_a_comparison_have_their_words() {
    let main = main_text();
    let one = |to: &&str| {
        let text = match to.starts_with('[') {
            true => main.replacen("[oil]", &format!("{to}[oil]"), 1),
            false => format!("{to}{main}"),
        };
        let list = errors(&merged_head(&text)).faults;
        let list: Vec<String> = list.iter().map(|f| format!("    {}: {}", f.path, f.message)).collect();
        format!("{to:?}\n{}", list.join("\n"))
    };
    let list: Vec<String> = COMPARISON.iter().map(one).collect();
    insta::assert_snapshot!(list.join("\n"));
}

/// What a study says about itself, and experiments.
const ABOUT: &[&str] = &[
    "[coarse]\n\"film.cells\" = 40\n\"bearings.big_end.width\" = \"40 kg\"\n",
    "[coarse]\n\"parameters[9].lower\" = \"4 mm\"\n",
    "[expected]\n\"objective.optimum.total_w\" = 1436.0\n",
    "[expected]\n\"a\" = { coarse = 1.0 }\n\"b\" = { value = [1.0], within = 0.1 }\n\"c\" = { value = 1.0, relative = 0.1, absolute = -1.0 }\n",
    "[experiments]\nplan = \"random\"\neach = \"optimise\"\n",
    "[experiments]\nruns = 10\nseed = 3\nfactors = []\n",
    "[experiments]\nplan = \"sobol\"\n[[experiments.factors]]\nkey = \"film.cells_around\"\nlower = 40\nupper = 80\nlevels = 3\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\nvalues = [40]\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\nlower = 80\nupper = 40\nlevels = 1\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"bearings.big_end.width\"\nlower = \"40 mm\"\nupper = \"0.05 m\"\nlevels = 3\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells\"\nvalues = [40, 50, 60]\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"bearings.big_end.width\"\nvalues = [\"50 mm\", \"80 mm\", \"90 mm\"]\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\nvalues = [40, 50, 70]\nrefinement = true\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\nvalues = [40, 80]\nrefinement = true\n[[experiments.factors]]\nkey = \"film.cells_around\"\nvalues = [40, 50]\n",
    "[experiments]\n[[experiments.factors]]\nname = \"mesh\"\nkey = \"film.cells_around\"\noptions = [{ name = \"coarse\" }]\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\nlower = 40\nupper = 9000\nlevels = 3000\nspacing = \"even\"\n",
    "[experiments]\n[[experiments.factors]]\nkey = \"film.cells_around\"\nvalues = [40, 50]\n[comparison]\n",
];

#[test]
fn mistakes_in_what_a_study_says_about_itself_have_their_words() {
    let main = main_text();
    let one = |to: &&str| {
        let text = main.replacen("[oil]", &format!("{to}[oil]"), 1);
        let list = errors(&merged_head(&text)).faults;
        let list: Vec<String> = list.iter().map(|f| format!("    {}: {}", f.path, f.message)).collect();
        format!("{to:?}\n{}", list.join("\n"))
    };
    let list: Vec<String> = ABOUT.iter().map(one).collect();
    insta::assert_snapshot!(list.join("\n"));
}

/// The text with sections put together, keys in front of the first section kept.
fn merged_head(text: &str) -> String {
    let head: String = text.lines().take_while(|l| !l.starts_with('[')).map(|l| format!("{l}\n")).collect();
    format!("{head}{}", merged(&text[head.len()..]))
}

#[test]
fn json_is_read_as_strictly_as_toml() {
    let read = |text: &str| Study::read(text, Format::Json, None).err().unwrap();
    for (text, words) in [
        ("", "empty"),
        ("{ \"format\": 1e999 }", "out of range"),
        ("{ \"format\": \"a\", \"format\": \"b\" }", "twice"),
        ("{ // comment\n }", "omment"),
        ("[1, 2]", "table of sections"),
        ("{}", "is missing"),
    ] {
        let faults = read(text).faults;
        assert!(faults.iter().any(|f| f.message.contains(words)), "{text}: {faults:?}");
    }
}

#[test]
fn a_study_from_the_network_reads_no_files() {
    let faults = Study::read(&main_text(), Format::Toml, None).err().unwrap().faults;
    assert!(
        faults
            .iter()
            .any(|f| f.path == "cylinder_pressure.table.file" && f.message.contains("cannot be read here"))
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn mutated_studies_never_panic(cut in 0usize..4000, length in 0usize..40, insert in "\\PC{0,12}") {
        let text = main_text();
        let chars: Vec<char> = text.chars().collect();
        let (from, to) = (cut.min(chars.len()), (cut + length).min(chars.len()));
        let mutated: String = chars[..from].iter().copied().chain(insert.chars()).chain(chars[to..].iter().copied()).collect();
        let _ = Study::read(&mutated, Format::Toml, Some(&here("studies")));
    }

    #[test]
    fn any_text_is_refused_without_panic(text in "\\PC{0,200}") {
        prop_assert!(Study::read(&text, Format::Toml, None).is_err());
        prop_assert!(Study::read(&text, Format::Json, None).is_err());
    }

    #[test]
    fn swapped_values_never_panic(pick in 0usize..200, value in prop_oneof![
        Just("0"), Just("-1"), Just("\"\""), Just("\"1e308 m\""), Just("[]"), Just("{}"), Just("true"), Just("\"nan mm\""), Just("1e300"),
    ]) {
        let text = main_text();
        let lines: Vec<&str> = text.lines().collect();
        let keyed: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ") && !lines[i].starts_with('#')).collect();
        let line = keyed[pick % keyed.len()];
        let key = lines[line].split(" = ").next().unwrap();
        let mut changed: Vec<String> = lines.iter().map(|l| (*l).to_owned()).collect();
        changed[line] = format!("{key} = {value}");
        let _ = Study::read(&changed.join("\n"), Format::Toml, Some(&here("studies")));
    }
}

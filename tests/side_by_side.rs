//! Two reports side by side: what differs, what is refused, the page, and the command.

use crate::common::{here, quietly};
use assert_cmd::Command;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::LazyLock;
use stribeck::report::{
    Findings, LimitState, NumberPair, Side, SideBySide, orbit_csv, side_by_side, side_by_side_files,
    side_by_side_html,
};
use stribeck::study::{Format, Study, run};

/// The example of the interface, changed as text first, solved.
fn solved(changes: &[(&str, &str)]) -> Findings {
    let page = std::fs::read_to_string(here("api.md")).unwrap();
    let example = page.split("### Example").nth(1).unwrap();
    let mut text = example.split("```toml\n").nth(1).unwrap().split("```").next().unwrap().to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "the example does not contain {from:?}");
        text = text.replace(from, to);
    }
    let study = Study::read(&text, Format::Toml, None).unwrap_or_else(|e| panic!("{e}: {:#?}", e.faults));
    quietly(|context| run(&study, context))
}

fn side(label: &str, findings: &Findings) -> Side {
    Side {
        label: label.to_owned(),
        report: serde_json::to_value(&findings.report).unwrap(),
        orbit_csv: Some(orbit_csv(findings).unwrap()),
    }
}

/// The example, and the same with a thinner film.
static PAIR: LazyLock<[Side; 2]> = LazyLock::new(|| {
    let thinner = [("at_least = \"4 um\"", "at_least = \"3.8 um\"")];
    [side("out/a", &solved(&[])), side("out/b", &solved(&thinner))]
});

fn compared(a: &Side, b: &Side) -> SideBySide {
    side_by_side(a, b).unwrap_or_else(|e| panic!("{e}"))
}

fn named<'p>(pairs: &'p [NumberPair], name: &str) -> &'p NumberPair {
    pairs.iter().find(|n| n.name == name).unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn two_designs_differ_where_they_do() {
    let [a, b] = &*PAIR;
    let found = compared(a, b);
    let answer = &found.answer[0];
    for words in
        ["B loses ", " less than A; the smallest film of B is ", " um thinner; ", "both keep all limits."]
    {
        assert!(answer.contains(words), "{words:?} in {answer:?}");
    }
    assert!(found.notes.is_empty() && found.content.is_none(), "{:?}", found.notes);
    let pair = found.design.as_ref().unwrap();
    let loss = named(&pair.objective, "friction loss of the design");
    let number = |side: &Side, at: &str| side.report.pointer(at).and_then(Value::as_f64);
    assert_eq!(loss.a, number(a, "/objective/optimum/total_w"));
    assert_eq!(loss.difference, Some(loss.b.unwrap() - loss.a.unwrap()));
    let percent = 100.0 * (loss.b.unwrap() / loss.a.unwrap() - 1.0);
    assert!((loss.difference_percent.unwrap() - percent).abs() < 1e-9);
    let clearance = named(&pair.parameters, "drive.diametral_clearance");
    assert_eq!((clearance.unit.as_str(), clearance.b), ("um", number(b, "/design/1/value")));
    let film = pair.limits.iter().find(|l| l.quantity == "min-film-thickness").unwrap();
    assert_eq!((film.a.unwrap().limit, film.b.unwrap().limit), (4.0, 3.8));
    assert_eq!(film.b.unwrap().state, LimitState::Active);
    let cycle = &pair.cycles[0];
    assert_eq!(cycle.name(), "drive, full speed");
    assert_eq!(named(&cycle.numbers, "smallest film").a, number(a, "/orbit/0/min_film_thickness_um/value"));
    assert_eq!(named(&cycle.numbers, "film temperature").difference_percent, None);
    let [input] = found.inputs.rows.as_slice() else { panic!("{:#?}", found.inputs) };
    assert_eq!(input.path, "constraints[0].at_least");
    assert_eq!(input.words(), ["4 um", "3.8 um"].map(|v| Some(v.to_owned())));
    let read: SideBySide = serde_json::from_value(serde_json::to_value(&found).unwrap()).unwrap();
    assert_eq!(read, found);
}

#[test]
fn a_report_does_not_differ_from_itself() {
    let a = &PAIR[0];
    let found = compared(a, a);
    assert!(found.answer[0].starts_with("A and B lose the same, "), "{:?}", found.answer);
    assert!(found.answer[0].contains("their smallest films are the same") && found.notes.is_empty());
    assert_eq!((found.inputs.differing, found.inputs.rows.len()), (0, 0));
    assert!(found.inputs.equal > 50);
    let pair = found.design.unwrap();
    let cases = pair.cycles.iter().chain(&pair.running_in).flat_map(|c| &c.numbers);
    let all = pair.objective.iter().chain(&pair.parameters).chain(&pair.work).chain(cases);
    assert!(all.clone().count() > 15);
    assert!(all.clone().all(|n| n.difference.is_none_or(|d| d == 0.0)));
    assert!(pair.limits.iter().all(|l| l.a == l.b && l.difference == Some(0.0)));
    assert!(pair.outcome.iter().all(|t| t.a == t.b));
}

#[test]
fn what_only_one_has_stands_alone_and_broken_limits_are_named() {
    let [a, b] = &*PAIR;
    let mut b = b.clone();
    b.report["design"].as_array_mut().unwrap().remove(0);
    b.report["constraints"][0]["met"] = false.into();
    b.report["outcome"]["status"] = "no-progress".into();
    b.report["constraints"].as_array_mut().unwrap().remove(1);
    let found = compared(a, &b);
    assert!(
        found.answer[0].ends_with("B breaks min-film-thickness (drive, full speed), A keeps all limits."),
        "{:?}",
        found.answer
    );
    assert!(found.answer[1].contains("B ended as \"no progress\""), "{:?}", found.answer);
    let pair = found.design.unwrap();
    let width = named(&pair.parameters, "drive.width");
    assert!(width.a.is_some() && width.b.is_none() && width.difference.is_none());
    assert_eq!(pair.limits[0].b.unwrap().state, LimitState::Violated);
    assert!(pair.limits[1].a.is_some() && pair.limits[1].b.is_none());
}

fn between<'t>(text: &'t str, start: &str) -> Vec<&'t str> {
    text.split(start).skip(1).filter_map(|rest| rest.split(['"', ')']).next()).collect()
}

/// Self-contained, every id once, every link to one of them.
fn assert_sound(page: &str) {
    for outside in ["src=\"http", "href=\"http", "@import", "<script", "url(http", "NaN"] {
        assert!(!page.contains(outside), "{outside}");
    }
    let ids = between(page, " id=\"");
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len(), "{ids:?}");
    for link in between(page, "href=\"#").into_iter().chain(between(page, "url(#")) {
        assert!(unique.contains(link), "{link} leads nowhere");
    }
}

#[test]
fn the_page_is_sound_and_shows_both() {
    let [a, b] = &*PAIR;
    let found = compared(a, b);
    let page = side_by_side_html(&found, a, b).unwrap();
    assert_sound(&page);
    assert_eq!(page.matches("<svg role=\"img\"").count(), 4, "orbit, film, pressure, loss; nothing touches");
    for words in [
        "out&#x2f;b",
        "id=\"parameters\"",
        "id=\"limits\"",
        "film thickness [µm]",
        "friction loss [W]",
        "constraints[0].at_least",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let files = side_by_side_files(&found, a, b).unwrap();
    assert_eq!(files.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["compare.json", "compare.html"]);
    assert_eq!(files[1].text, page);
}

#[test]
fn without_its_own_cycles_a_page_says_why_it_has_no_figures() {
    let [a, b] = &*PAIR;
    let found = compared(a, b);
    let with = |csv: Option<&str>| {
        let b = Side { orbit_csv: csv.map(str::to_owned), ..b.clone() };
        let page = side_by_side_html(&found, a, &b).unwrap();
        assert_sound(&page);
        assert!(!page.contains("<svg"));
        page
    };
    assert!(with(None).contains("There are no figures: there is no orbit.csv beside B."));
    assert!(with(a.orbit_csv.as_deref()).contains("the orbit.csv beside B belongs to another report."));
    assert!(with(Some("bearing,operating_point\nx,y\n")).contains("the orbit.csv beside B cannot be read"));
}

/// A characteristic of one bearing at some speeds.
fn characteristic(speeds: &[f64], torque: f64) -> Side {
    let of = |factor: f64| speeds.iter().map(|n| factor * n).collect::<Vec<f64>>();
    let column = |key: &str, title: &str, unit: &str, numbers: Vec<f64>| {
        json!({ "key": key, "title": title, "unit": unit, "values": numbers, "reference": [],
                "largest_difference": null, "difference_of_maximum_percent": null })
    };
    let report = json!({
        "schema_version": "stribeck-characteristic/1", "title": format!("{torque}"), "status": "complete",
        "study_hash": format!("{torque}"), "timing": { "seconds": torque },
        "tables": [{
            "name": "shaft",
            "varied": column("speed_rpm", "speed", "rpm", of(1.0)),
            "columns": [column("torque_nm", "torque", "N m", of(torque)),
                        column("film_min_um", "smallest film", "um", of(0.5))],
        }],
        "provenance": { "version": "0.1.0", "study": { "oil": { "grade": "SAE 40" } } },
    });
    Side { label: format!("torque {torque}"), report, orbit_csv: None }
}

#[test]
fn characteristics_are_compared_row_by_row_and_leaf_by_leaf() {
    let (a, b) = (characteristic(&[100.0, 200.0], 2.0), characteristic(&[100.0, 200.0, 300.0], 3.0));
    let found = compared(&a, &b);
    let [table] = found.tables.as_slice() else { panic!("{:?}", found.tables) };
    assert_eq!((table.label().as_str(), table.at.len()), ("speed [rpm]", 3));
    let torque = &table.columns[0];
    assert_eq!(torque.a, [Some(200.0), Some(400.0), None]);
    assert_eq!(torque.b, [Some(300.0), Some(600.0), Some(900.0)]);
    assert_eq!(torque.difference, [Some(100.0), Some(200.0), None]);
    let content = found.content.as_ref().unwrap();
    let paths: Vec<&str> = content.rows.iter().map(|r| r.path.as_str()).collect();
    assert_eq!(paths[..2], ["tables[0].columns[0].values[0]", "tables[0].columns[0].values[1]"]);
    assert_eq!(content.rows[0].relative, Some(1.0 / 3.0));
    assert_eq!(content.differing, 2 + 3, "two torques, and a row that only B has");
    assert_eq!((found.inputs.differing, found.inputs.equal), (0, 1));
    assert!(found.answer[1].contains("33.33 %"), "{:?}", found.answer);
    assert_sound(&side_by_side_html(&found, &a, &b).unwrap());
    let same = compared(&a, &a);
    assert_eq!(same.content.unwrap().differing, 0);
    assert!(same.tables[0].columns.iter().all(|c| c.equal()) && same.notes.is_empty());
}

#[test]
fn reports_of_another_kind_or_version_are_told_apart() {
    let a = &PAIR[0];
    let other = characteristic(&[100.0], 1.0);
    let refused = side_by_side(a, &other).unwrap_err();
    for words in ["A (out/a) is of a design", "B (torque 1) is of a characteristic", "of the same kind"] {
        assert!(refused.contains(words), "{words:?} in {refused}");
    }
    for (report, words) in
        [(json!([]), "it names no schema_version"), (json!({"schema_version": "x/2"}), "is \"x/2\"")]
    {
        let none = Side { label: "none".to_owned(), report, orbit_csv: None };
        let refused = side_by_side(a, &none).unwrap_err();
        assert!(refused.starts_with("B (none) is no report") && refused.contains(words), "{refused}");
    }
    let mut old = a.clone();
    old.report.as_object_mut().unwrap().remove("kkt");
    let found = compared(a, &old);
    assert!(found.design.is_none() && found.notes[0].contains("missing field `kkt`"), "{:?}", found.notes);
    assert!(found.content.unwrap().rows.iter().all(|r| r.path.starts_with("kkt.")));
}

fn stribeck() -> Command {
    let mut command = Command::cargo_bin("stribeck").unwrap();
    command.env("NO_COLOR", "1").arg("compare");
    command
}

/// Writes a report as a run leaves it.
fn folder(at: &Path, side: &Side) {
    std::fs::create_dir_all(at).unwrap();
    std::fs::write(at.join("report.json"), side.report.to_string()).unwrap();
    if let Some(text) = &side.orbit_csv {
        std::fs::write(at.join("orbit.csv"), text).unwrap();
    }
}

#[test]
fn the_command_prints_the_answer_first_and_writes_where_it_is_told() {
    let root = tempfile::tempdir().unwrap();
    let at = |name: &str| root.path().join(name);
    folder(&at("a"), &PAIR[0]);
    folder(&at("b"), &PAIR[1]);
    folder(&at("c"), &characteristic(&[100.0, 200.0], 1.0));
    let run = stribeck().arg(at("a")).arg(at("b").join("report.json")).assert().code(0);
    let text = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    for words in [
        "B loses ",
        "drive.width",
        "min-film-thickness",
        "smallest film",
        "inputs that differ",
        "4 um",
        "simulations",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
    let json =
        stribeck().args([at("a"), at("b")]).arg("--json").arg("--out").arg(at("page")).assert().code(0);
    let json: SideBySide = serde_json::from_slice(&json.get_output().stdout).unwrap();
    let written: SideBySide =
        serde_json::from_slice(&std::fs::read(at("page").join("compare.json")).unwrap()).unwrap();
    assert_eq!(written, json);
    let page = std::fs::read_to_string(at("page").join("compare.html")).unwrap();
    assert!(page.contains("<svg"), "orbit.csv is found beside report.json");
    let same = stribeck().args([at("c"), at("c")]).assert().code(0);
    let text = String::from_utf8_lossy(&same.get_output().stdout).into_owned();
    assert!(text.contains("No value differs") && text.contains("the same in both: torque"), "{text}");
    stribeck().args([at("a"), at("none")]).assert().code(1);
    let kinds = stribeck().args([at("a"), at("c")]).assert().code(2);
    assert!(String::from_utf8_lossy(&kinds.get_output().stderr).contains("different kinds"));
    std::fs::write(at("text"), "no report").unwrap();
    stribeck().args([at("a"), at("text")]).assert().code(2);
    stribeck().arg(at("a")).assert().code(2);
}

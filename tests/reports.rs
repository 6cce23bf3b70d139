//! Reports as their readers get them: whole pages whose links lead somewhere, the same bytes on every rerun.

use crate::common::{COARSE, SMOOTH, copied_study, stribeck};
use crate::studies::gallery;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Values of an attribute in a page.
fn attributes<'t>(page: &'t str, name: &str) -> Vec<&'t str> {
    page.split(&format!(" {name}=\"")).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// A page is whole: every link leads somewhere, no name stands twice, nothing is fetched, every figure has a size and axes with words.
fn assert_whole(path: &Path) {
    let page = std::fs::read_to_string(path).unwrap();
    let at = path.display();
    let mut ids = attributes(&page, "id");
    for link in attributes(&page, "href") {
        match link.strip_prefix('#') {
            Some(anchor) => assert!(ids.contains(&anchor), "{at}: no {link}"),
            None => {
                assert!(!link.contains("://"), "{at}: {link} is somewhere else");
                let to = path.parent().unwrap().join(link.replace("%20", " "));
                assert!(to.exists(), "{at}: {link} leads nowhere");
            }
        }
    }
    for fetched in ["src", "xlink:href", "data-src"] {
        assert!(attributes(&page, fetched).is_empty(), "{at} fetches something");
    }
    assert!(!page.contains("@import") && !page.contains("<script"), "{at}");
    for clip in page.split("url(#").skip(1).filter_map(|r| r.split(')').next()) {
        assert!(ids.contains(&clip), "{at}: no #{clip}");
    }
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "{at}: a name stands twice");
    for figure in page.split("<svg ").skip(1) {
        let figure = figure.split("</svg>").next().unwrap();
        assert!(figure.contains("viewBox=\"0 0 "), "{at}");
        assert!(figure.matches("<text").count() >= 4, "{at}: a figure without words");
        for bad in ["NaN", ">inf<", "undefined"] {
            assert!(!figure.contains(bad), "{at}: a figure shows {bad}");
        }
    }
    for word in ["undefined", ">NaN<", ">none<"] {
        assert!(!page.contains(word), "{at} shows {word}");
    }
    assert_balanced(&page, &at.to_string());
}

/// Every element of the page but figures is closed where it was opened.
fn assert_balanced(page: &str, at: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        let end = rest.find('>').unwrap();
        let (tag, behind) = (&rest[..end], &rest[end + 1..]);
        rest = behind;
        let name = tag.split([' ', '/', '\n']).find(|s| !s.is_empty()).unwrap_or("");
        let void = ["meta", "br", "!doctype", "!--", "link"].iter().any(|v| name.starts_with(v));
        if void || tag.ends_with('/') {
            continue;
        }
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name), "{at}: </{name}>"),
            None if name == "style" || name == "svg" => {
                let close = format!("</{name}>");
                rest = &behind[behind.find(&close).unwrap() + close.len()..];
            }
            None => open.push(name),
        }
    }
    assert!(open.is_empty(), "{at}: {open:?} stay open");
}

#[test]
fn pages_of_the_gallery_are_whole() {
    let folder = gallery().path();
    let mut pages = vec![folder.join("index.html")];
    for entry in std::fs::read_dir(folder).unwrap() {
        let page = entry.unwrap().path().join("report.html");
        if page.exists() {
            pages.push(page);
        }
    }
    assert!(pages.len() > 12);
    pages.iter().for_each(|page| assert_whole(page));
}

/// Files of a folder by name, without what is said to depend on the machine.
fn content(folder: &Path) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() || name == "run.stamp" || name == "timing.csv" {
            continue;
        }
        let mut text = std::fs::read_to_string(&path).unwrap();
        if name == "report.json" {
            let mut report: serde_json::Value = serde_json::from_str(&text).unwrap();
            assert!(report["timing"]["seconds"].as_f64().unwrap() > 0.0);
            report.as_object_mut().unwrap().remove("timing");
            text = report.to_string();
        }
        if name == "report.html" {
            text = untimed(&text);
        }
        all.insert(name, text);
    }
    all
}

/// A page without its timing blocks.
fn untimed(page: &str) -> String {
    let mut parts = page.split("<!-- timing -->");
    let first = parts.next().unwrap().to_owned();
    let rest: Vec<&str> = parts.map(|p| p.split_once("<!-- /timing -->").unwrap().1).collect();
    assert!(!rest.is_empty());
    first + &rest.concat()
}

/// The smooth study, coarse, with other sections.
fn study(folder: &Path, more: &str) -> PathBuf {
    copied_study(folder, SMOOTH, &[("[oil]", COARSE), ("[oil]", &format!("{more}\n[oil]"))])
}

#[test]
fn reruns_write_the_same_bytes_but_for_the_timing() {
    let rivals = "[optimiser]\nrivals = [{ method = \"sqp\", engine = \"CEN\" }]";
    let comparison = "[comparison]\nperturbations = [1e-5, 1e-6]\nparameter_counts = [1, 2]";
    let experiments = "[experiments]\nplan = \"sobol\"\nruns = 4\n[[experiments.factors]]\n\
        key = \"bearings.big_end.width\"\nlower = \"55 mm\"\nupper = \"60 mm\"";
    for more in [rivals, comparison, experiments] {
        let folder = tempfile::tempdir().unwrap();
        let file = study(folder.path(), more);
        let run = |name: &str, threads: &str| {
            let out = folder.path().join(name);
            stribeck()
                .arg("run")
                .arg(&file)
                .arg("--out")
                .arg(&out)
                .args(["--threads", threads])
                .assert()
                .success();
            content(&out)
        };
        let (first, second) = (run("first", "2"), run("second", "1"));
        assert!(first.len() >= 3, "{:?}", first.keys());
        assert_eq!(first.keys().collect::<Vec<_>>(), second.keys().collect::<Vec<_>>());
        for (name, text) in &first {
            assert!(*text == second[name], "{name} differs between two runs of\n{more}");
        }
    }
}

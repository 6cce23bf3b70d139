//! The examples of `api.md` are run as they stand there, against a service of their own.

use super::common::Service;
use crate::common::here;
use std::process::Command;

/// Blocks of shell in a section of a page.
fn shell(page: &str, section: &str) -> String {
    let from = page.find(&format!("\n## {section}\n")).unwrap_or_else(|| panic!("no section {section}"));
    let rest = &page[from + 4..];
    let section = rest.find("\n## ").map_or(rest, |end| &rest[..end]);
    let mut all = String::new();
    for block in section.split("```sh\n").skip(1) {
        all += block.split("```").next().unwrap();
    }
    all
}

#[test]
fn every_route_has_an_example_that_works() {
    let page = std::fs::read_to_string(here("api.md")).unwrap();
    let script = shell(&page, "HTTP");
    let service = Service::start(2);
    let described = service.get("/openapi.json").ok(200);
    for (path, methods) in described["paths"].as_object().unwrap() {
        let plain = path.split('{').next().unwrap().trim_end_matches('/');
        let told = match path.rsplit('}').next() {
            Some(end) if !end.is_empty() && path.contains('}') => script.contains(end),
            _ => script.contains(plain),
        };
        assert!(told, "api.md has no example of {path} {methods}");
    }
    let script = script.replace("http://127.0.0.1:8080", &service.url(""));
    assert!(!script.contains("8080"));
    let folder = tempfile::tempdir().unwrap();
    let found =
        Command::new("bash").args(["-euo", "pipefail", "-c", &script]).current_dir(folder.path()).output();
    let found = found.expect("bash and curl");
    let (out, err) = (String::from_utf8_lossy(&found.stdout), String::from_utf8_lossy(&found.stderr));
    assert!(found.status.success(), "{script}\n{out}\n{err}");
}

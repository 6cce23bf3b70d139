//! `stribeck describe`: the catalogue of laws, engines, methods, quantities and parameters.
//!
//! Deliberately not here: what is in it, which the study floor knows.

use super::EXIT_STUDY;
use super::commands::{Stop, put, read};
use super::tables::table;
use crate::report::short;
use crate::study::catalogue::{
    EngineEntry, Law, MethodEntry, ParameterEntry, QuantityEntry, engines, laws, laws_in_use, methods,
    parameters, quantities, references,
};
use crate::study::{Reading, Study};
use clap::{Args, ValueEnum};
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Table, Width};
use serde::Serialize;
use std::io::IsTerminal;
use std::path::PathBuf;

/// Width of tables that go into a pipe or a file.
const PIPE: u16 = 120;
/// Tables are never narrower.
const NARROWEST: u16 = 60;

#[derive(Debug, Args)]
pub(super) struct DescribeArguments {
    /// What to list.
    #[arg(value_enum)]
    topic: Topic,
    /// Study file, TOML or JSON: with `laws` only those it uses, with their references; with `parameters` everything it can vary.
    file: Option<PathBuf>,
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Topic {
    /// Laws and numerical methods: equation, source, how a study chooses them, where they are valid.
    Laws,
    /// Gradient engines: what they cost and when to choose them.
    Engines,
    /// Quantities that are minimised or limited.
    Quantities,
    /// What can be a design parameter.
    Parameters,
    /// Search methods.
    Methods,
}

/// Lists what was asked for.
pub(super) fn describe(a: &DescribeArguments) -> Result<u8, Stop> {
    let study = match &a.file {
        Some(path) if !matches!(a.topic, Topic::Laws | Topic::Parameters) => {
            eprintln!("error: {}: only laws and parameters are listed for a study", path.display());
            return Ok(EXIT_STUDY);
        }
        Some(path) => Some(read(path, Reading::default(), a.json)?),
        None => None,
    };
    let study = study.as_ref();
    put(&match a.topic {
        Topic::Laws => {
            let list = study.map_or_else(laws, laws_in_use);
            told(a.json, &list, |list| law_tables(list) + &study.map_or_else(String::new, reference_table))
        }
        Topic::Engines => told(a.json, &engines(), engine_table),
        Topic::Quantities => told(a.json, &quantities(), quantity_table),
        Topic::Parameters => {
            let tables = if study.is_some() { parameter_table } else { pattern_table };
            told(a.json, &parameters(study), tables)
        }
        Topic::Methods => told(a.json, &methods(), method_table),
    });
    Ok(0)
}

/// A list as JSON or as tables.
fn told<T: Serialize>(json: bool, list: &[T], tables: impl Fn(&[T]) -> String) -> String {
    if json { serde_json::to_string_pretty(list).unwrap_or_default() + "\n" } else { tables(list) }
}

/// A table of texts that wrap at the width of the terminal.
fn texts(head: &[&str]) -> Table {
    let known = if std::io::stdout().is_terminal() { terminal_size::terminal_size() } else { None };
    let width = known.map_or(PIPE, |(terminal_size::Width(width), _)| width.max(NARROWEST));
    let mut texts = table(head);
    texts.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    for column in texts.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Left);
    }
    texts
}

/// The same with names in front that are not broken.
fn named(head: &[&str]) -> Table {
    let mut named = texts(head);
    if let Some(column) = named.column_mut(0) {
        column.set_constraint(ColumnConstraint::ContentWidth);
    }
    named
}

fn marked(name: &str, default: bool) -> String {
    if default { format!("{name} (default)") } else { name.to_owned() }
}

/// Lines of a cell, empty ones left out.
fn lines(all: &[&str]) -> String {
    all.iter().copied().filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
}

fn law_tables(list: &[Law]) -> String {
    let mut text = String::new();
    for topic in list.chunk_by(|a, b| a.topic == b.topic) {
        let mut rows = texts(&[topic[0].topic, "chosen by, equation, source, range"]);
        if let Some(column) = rows.column_mut(0) {
            column.set_constraint(ColumnConstraint::Absolute(Width::Percentage(30)));
        }
        for law in topic {
            // What always holds is no default of anything.
            let default = law.default && law.chosen_by != "always";
            let about = [law.chosen_by.as_str(), &law.equation, &law.source, law.remark];
            rows.add_row([marked(law.name, default), lines(&about)]);
        }
        text += &format!("{}\n\n", rows.trim_fmt());
    }
    text
}

fn reference_table(study: &Study) -> String {
    let mut rows = named(&["", "reference"]);
    for (k, reference) in references(study).into_iter().enumerate() {
        rows.add_row([(k + 1).to_string(), reference]);
    }
    format!("{}\n", rows.trim_fmt())
}

fn engine_table(list: &[EngineEntry]) -> String {
    let mut rows = named(&["engine", "what it is", "accuracy", "cost", "choose it"]);
    for e in list {
        rows.add_row([e.key, &e.what, e.accuracy, e.cost, e.choose]);
    }
    format!("{}\nn_p parameters, n_q quantities; eps_p: gradient.perturbation\n", rows.trim_fmt())
}

fn quantity_table(list: &[QuantityEntry]) -> String {
    let mut rows = named(&["quantity", "unit", "meaning", "over the cycle", "in a study"]);
    for q in list {
        let limits = match (q.objective, q.at_least, q.at_most) {
            (true, ..) => "minimised",
            (_, true, true) => "at_least or at_most",
            (_, true, false) => "at_least",
            (_, false, true) => "at_most",
            _ => "",
        };
        rows.add_row([q.key, q.unit, &q.meaning, q.over_cycle, &lines(&[limits, q.needs])]);
    }
    format!("{}\n", rows.trim_fmt())
}

fn pattern_table(list: &[ParameterEntry]) -> String {
    let mut rows = named(&["parameter", "unit", "meaning", "needs"]);
    for p in list {
        rows.add_row([p.name.as_str(), p.unit, &p.meaning, p.needs]);
    }
    format!("{}\n", rows.trim_fmt())
}

/// What a study can vary; coefficients one by one only where they are parameters of their own.
fn parameter_table(list: &[ParameterEntry]) -> String {
    let mut rows = named(&["parameter", "unit", "value", "may be", "box", "meaning"]);
    let told = |p: &ParameterEntry| {
        list.iter().any(|all| all.covers(p) && (p.bounds.is_none() || all.bounds.is_some()))
    };
    let range = |range: Option<[f64; 2]>| {
        range.map_or_else(String::new, |[low, high]| format!("{} .. {}", short(low), short(high)))
    };
    for p in list.iter().filter(|p| !told(p)) {
        let value = p.value.map(short).unwrap_or_default();
        let (allowed, bounds) = (range(p.allowed), range(p.bounds));
        rows.add_row([p.name.as_str(), p.unit, &value, &allowed, &bounds, &p.meaning]);
    }
    let words = "what has a box is a parameter of this study already; coefficients one by one: --json";
    format!("{}\n{words}\n", rows.trim_fmt())
}

fn method_table(list: &[MethodEntry]) -> String {
    let mut rows = named(&["method", "what it is", "gradients", "linear constraints hold", "choose it"]);
    for m in list {
        let gradients = if m.gradients { "yes" } else { "no" };
        rows.add_row([
            marked(&m.key, m.default).as_str(),
            &m.what,
            gradients,
            m.linear_constraints,
            m.choose,
        ]);
    }
    format!("{}\n", rows.trim_fmt())
}

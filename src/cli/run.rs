//! `stribeck run`: one study, several, or all of a folder; what was computed before is not computed again.
//!
//! All studies are read and checked before the first one runs. As many run at once as there are threads; those that measure times
//! run alone after the others.

use super::commands::{Stop, cancel_on_ctrl_c, put, read};
use super::progress::Display;
use super::stamp::{Done, Stamp, program};
use super::{EXIT_EXPECTED, EXIT_FILE, EXIT_STUDY, dry_run, exit_code, summaries, told};
use crate::optimise::{EvaluationError, Outcome};
use crate::report::{self, IndexEntry};
use crate::run::{Cancel, FolderStore, RunContext};
use crate::study::{Answer, Reading, Study, Task, answer, setting};
use clap::Args;
use serde_json::{Value, json};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    /// Study files, TOML or JSON, or folders of them.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Folder for report.html, report.json and CSV files [default: out/<name of the study file>]; with several studies the folder that holds
    /// one for each [default: out].
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Start from the design in the report.json of an earlier run, of this study or another with the same parameters.
    #[arg(long, value_name = "REPORT")]
    start_from: Option<PathBuf>,
    /// Compute everything anew: what was computed before, or was known when an earlier run was stopped, does not count.
    #[arg(long)]
    fresh: bool,
    /// Simulate the start design only, and run it in if the study says how.
    #[arg(long, conflicts_with = "start_from")]
    simulate: bool,
    /// Use the study's coarse setting, to see quickly whether it works.
    #[arg(long)]
    coarse: bool,
    /// Give a key of the study another value, like --set "film.cells_around=80" or --set "bearings.big_end.width=60 mm". May stand many times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    set: Vec<(String, Value)>,
    /// Compute nothing: check the studies, and estimate the work.
    #[arg(long)]
    dry_run: bool,
    /// Print the report as JSON instead of a table.
    #[arg(long, conflicts_with = "json_lines")]
    json: bool,
    /// Print progress and ends as lines of JSON instead of tables.
    #[arg(long)]
    json_lines: bool,
}

/// A study on its way.
struct Job {
    name: String,
    file: PathBuf,
    folder: PathBuf,
    study: Study,
}

/// How a study ended.
struct End {
    done: Done,
    /// What is told of it at this terminal.
    told: String,
    /// Whether it had been computed before.
    before: bool,
}

pub(super) fn run(a: &RunArguments) -> Result<u8, Stop> {
    let many = a.files.len() > 1 || a.files.iter().any(|f| f.is_dir());
    if many && (a.start_from.is_some() || a.json) {
        eprintln!("error: --start-from and --json go with a single study");
        return Ok(EXIT_STUDY);
    }
    let jobs = jobs(a, many)?;
    if a.dry_run {
        put(&dry_run::told(
            &jobs.iter().map(|j| (j.name.as_str(), j.folder.as_path(), &j.study)).collect::<Vec<_>>(),
            a.json,
        ));
        return Ok(0);
    }
    if a.simulate && jobs.iter().any(|j| j.study.experiments().next().is_some()) {
        eprintln!("note: --simulate looks at the study itself; its experiments are left out");
    }
    let (cancel, display) = (cancel_on_ctrl_c(), Display::new(a.json_lines));
    let ends: Vec<Mutex<Option<Result<End, Stop>>>> = jobs.iter().map(|_| Mutex::new(None)).collect();
    let work = |at_once: usize, which: &dyn Fn(&Job) -> bool| {
        let chosen: Vec<usize> = (0..jobs.len()).filter(|k| which(&jobs[*k])).collect();
        each(&chosen, at_once, |k| {
            let end = one(&jobs[k], a, many, &cancel, &display);
            if end.is_err() {
                display.end(&jobs[k].name, json!({ "status": "failed" }));
            }
            *ends[k].lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(end);
        });
    };
    work(rayon::current_num_threads(), &|job| !job.study.measures_time());
    work(1, &|job| job.study.measures_time());
    let ends = ends.into_iter().filter_map(|e| e.into_inner().ok().flatten());
    finish(a, many, &jobs, ends.collect())
}

/// Does something with every number of a list, on some threads of their own, so that waiting for one study never holds another.
fn each(list: &[usize], at_once: usize, work: impl Fn(usize) + Sync) {
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..at_once.min(list.len()) {
            scope.spawn(|| {
                while let Some(k) = list.get(next.fetch_add(1, Ordering::Relaxed)) {
                    work(*k);
                }
            });
        }
    });
}

/// The studies that are asked for, all checked; every mistake of every file is told.
fn jobs(a: &RunArguments, many: bool) -> Result<Vec<Job>, Stop> {
    let mut files = Vec::new();
    for path in &a.files {
        files.extend(if path.is_dir() { studies_in(path)? } else { vec![path.clone()] });
    }
    let (mut jobs, mut stops): (Vec<Job>, Vec<Stop>) = (Vec::new(), Vec::new());
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = match (many, &a.out) {
            (false, Some(out)) => out.clone(),
            (false, None) => Path::new("out").join(&name),
            (true, out) => out.as_deref().unwrap_or(Path::new("out")).join(&name),
        };
        if let Some(twin) = jobs.iter().find(|j| j.name == name) {
            let words =
                format!("has the name of {}: their reports would lie in one folder", twin.file.display());
            stops.push(Stop::File(file, std::io::Error::other(words)));
            continue;
        }
        let with = Reading { coarse: a.coarse, set: &a.set, ..Reading::default() };
        let study =
            read(&file, with, a.json).and_then(|s| super::commands::started(s, a.start_from.as_deref()));
        match study {
            Ok(study) => jobs.push(Job { name, file, folder, study }),
            Err(stop) => stops.push(stop),
        }
    }
    let last = stops.pop();
    stops.iter().for_each(|stop| {
        stop.tell();
    });
    last.map_or(Ok(jobs), Err)
}

fn studies_in(folder: &Path) -> Result<Vec<PathBuf>, Stop> {
    let lost = |e| Stop::File(folder.to_owned(), e);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(lost)? {
        let path = entry.map_err(lost)?.path();
        let study = path.extension().is_some_and(|e| e == "toml" || e == "json");
        if study && path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    match files.is_empty() {
        true => Err(lost(std::io::Error::other("holds no study: no file that ends in .toml or .json"))),
        false => Ok(files),
    }
}

fn one(job: &Job, a: &RunArguments, many: bool, cancel: &Cancel, display: &Display) -> Result<End, Stop> {
    let lost = |e| Stop::File(job.folder.clone(), e);
    std::fs::create_dir_all(&job.folder).map_err(lost)?;
    let task = if a.simulate { Task::Simulation } else { Task::Answer };
    let stamp = Stamp::new(&job.folder, &job.study, task);
    let store = FolderStore(job.folder.clone());
    if a.fresh {
        store.forget();
    }
    if job.study.experiments().next().is_some() {
        store.kept_by(&program());
    }
    if let Some(done) = stamp.done().filter(|_| !a.fresh) {
        display.end(&job.name, end_line(&done, job, true));
        return Ok(End { told: done.told.clone(), done, before: true });
    }
    if cancel.is_cancelled() {
        return Err(Stop::Simulation(EvaluationError::Cancelled));
    }
    let options = &job.study.optimiser.options;
    let bars = display.study(&job.name, many, options.settings.max_iterations, options.settings.tolerance);
    let context = RunContext { cancel, progress: &bars };
    let found = answer(&job.study, task, context, &store);
    bars.finish();
    let found = found.map_err(Stop::Simulation)?;
    let files = found.files(false).map_err(lost)?;
    stamp.sweep(&files);
    report::write_folder(&files, &job.folder).map_err(lost)?;
    let done = summaries::done(&found, a.coarse, told::told(&found, false), code(&found));
    if !found.is_cancelled() {
        stamp.set(&done, &files);
        // Only a search leaves checkpoints behind it, and only its own end makes them useless.
        if task == Task::Answer && matches!(found, Answer::Design(_) | Answer::Experiments(_)) {
            store.clear();
        }
    }
    display.end(&job.name, end_line(&done, job, false));
    Ok(End { done, told: told::told(&found, std::io::stdout().is_terminal()), before: false })
}

fn end_line(done: &Done, job: &Job, before: bool) -> Value {
    json!({
        "status": done.entry.status,
        "exit_code": done.code,
        "computed_before": before,
        "report": job.folder.join("report.json"),
    })
}

/// The exit code of an answer.
fn code(found: &Answer) -> u8 {
    let own = match found {
        Answer::Design(found) => exit_code(found.report.outcome.status),
        Answer::Comparison(c) if c.any_wrong() && !found.is_cancelled() => super::EXIT_WRONG_GRADIENT,
        _ => match found.status().as_str() {
            "cancelled" => exit_code(Outcome::Cancelled),
            "incomplete" => super::EXIT_INCOMPLETE,
            _ => 0,
        },
    };
    let missed = found.expected().iter().any(|e| !e.met);
    if own == 0 && missed { EXIT_EXPECTED } else { own }
}

/// Prints what there is to say at the end; the exit code is the first that is not zero.
fn finish(a: &RunArguments, many: bool, jobs: &[Job], ends: Vec<Result<End, Stop>>) -> Result<u8, Stop> {
    if a.coarse && !a.json && !a.json_lines {
        put("Coarse setting: it shows whether a study works, its numbers decide nothing.\n\n");
    }
    if !many {
        let end = ends.into_iter().next().ok_or(Stop::Simulation(EvaluationError::Cancelled))??;
        let folder = &jobs[0].folder;
        if a.json {
            let path = folder.join("report.json");
            put(&std::fs::read_to_string(&path).map_err(|e| Stop::File(path, e))?);
        } else if !a.json_lines {
            put(&end.told);
            if end.before {
                put("computed before; nothing has changed since (--fresh computes it anew)\n");
            }
            put(&format!("report: {}\n", folder.join("report.html").display()));
        }
        return Ok(end.done.code);
    }
    let mut code = 0;
    let mut rows: Vec<(IndexEntry, bool)> = Vec::new();
    for (job, end) in jobs.iter().zip(ends) {
        let own = match end {
            Ok(end) => {
                let entry = IndexEntry { name: job.name.clone(), ..end.done.entry };
                rows.push((entry, end.before));
                end.done.code
            }
            Err(stop) => {
                eprint!("{}: ", job.name);
                stop.tell()
            }
        };
        code = if code == 0 { own } else { code };
    }
    let base = a.out.as_deref().unwrap_or(Path::new("out"));
    let entries: Vec<IndexEntry> = rows.iter().map(|(e, _)| e.clone()).collect();
    let index = base.join("index.html");
    let page = report::index_html(&entries).map_err(std::io::Error::other);
    if let Err(e) = page.and_then(|text| std::fs::write(&index, text)) {
        Stop::File(index, e).tell();
        return Ok(EXIT_FILE);
    }
    if !a.json_lines {
        put(&summaries::table_of(&rows));
        put(&format!("reports: {}\n", index.display()));
    }
    Ok(code)
}

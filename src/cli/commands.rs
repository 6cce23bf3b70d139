//! The four commands.

use super::progress::Bars;
use super::{
    CheckArguments, EXIT_FILE, EXIT_INCOMPLETE, EXIT_STUDY, EXIT_WRONG_GRADIENT, GradientArguments,
    RunArguments, SchemaArguments, exit_code, faults, proof_tables, tables,
};
use crate::optimise::EvaluationError;
use crate::report::{self, ComparisonStatus};
use crate::run::{Cancel, FolderStore, RunContext};
use crate::study::{Answer, Format, Study, StudyErrors, Sweep, Task, answer, compare_engines, prove};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

/// A command that cannot go on.
pub(super) enum Stop {
    /// A file could not be read or written.
    File(PathBuf, std::io::Error),
    /// The study has mistakes.
    Study(PathBuf, StudyErrors, bool),
    /// The simulation failed.
    Simulation(EvaluationError),
}

impl Stop {
    /// Tells the reason and returns the exit code.
    pub fn tell(&self) -> u8 {
        match self {
            Self::File(path, e) => {
                eprintln!("error: {}: {e}", path.display());
                EXIT_FILE
            }
            Self::Study(_, errors, true) => {
                put(&(serde_json::to_string_pretty(&errors.faults).unwrap_or_default() + "\n"));
                EXIT_STUDY
            }
            Self::Study(path, errors, false) => {
                eprint!("{}", faults::render(path, errors, std::io::stderr().is_terminal()));
                EXIT_STUDY
            }
            Self::Simulation(EvaluationError::Cancelled) => {
                eprintln!("cancelled");
                130
            }
            Self::Simulation(e) => {
                eprintln!("error: the start design cannot be simulated: {e}");
                exit_code(crate::optimise::Outcome::StartFailed)
            }
        }
    }
}

/// Prints to standard output; a closed pipe is the reader's choice, not an error.
fn put(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

fn read(path: &Path, json: bool) -> Result<Study, Stop> {
    let text = std::fs::read_to_string(path).map_err(|e| Stop::File(path.to_owned(), e))?;
    let base = path.parent().unwrap_or(Path::new("."));
    Study::read(&text, Format::of_path(path), Some(base)).map_err(|e| Stop::Study(path.to_owned(), e, json))
}

/// A flag that Ctrl-C raises; a second Ctrl-C ends the process at once.
fn cancel_on_ctrl_c() -> Cancel {
    let cancel = Cancel::default();
    let flag = cancel.clone();
    let handler = move || {
        if flag.is_cancelled() {
            std::process::exit(130);
        }
        flag.cancel();
        eprintln!("\nstopping, what is known is being written (press again to stop at once)");
    };
    if ctrlc::set_handler(handler).is_err() {
        eprintln!("warning: Ctrl-C will end this run without a report");
    }
    cancel
}

pub(super) fn run(a: &RunArguments) -> Result<u8, Stop> {
    let study = started(read(&a.file, a.json)?, a.start_from.as_deref())?;
    let name = a.file.file_stem().unwrap_or_default();
    let folder = a.out.clone().unwrap_or_else(|| Path::new("out").join(name));
    std::fs::create_dir_all(&folder).map_err(|e| Stop::File(folder.clone(), e))?;
    let (cancel, bars) = (cancel_on_ctrl_c(), Bars::new(study.optimiser.options.settings.max_iterations));
    let context = RunContext { cancel: &cancel, progress: &bars };
    let store = FolderStore(folder.clone());
    if a.fresh {
        store.clear();
    }
    let task = if a.simulate { Task::Simulation } else { Task::Answer };
    let found = answer(&study, task, context, &store).map_err(Stop::Simulation)?;
    bars.finish();
    let files = found.files(false).map_err(|e| Stop::File(folder.clone(), e))?;
    report::write_folder(&files, &folder).map_err(|e| Stop::File(folder.clone(), e))?;
    // Only a search leaves checkpoints behind it, and only its own end makes them useless.
    if task == Task::Answer && matches!(found, Answer::Design(_)) && !found.is_cancelled() {
        store.clear();
    }
    if a.json {
        put(files.iter().find(|f| f.name == "report.json").map_or("", |f| &f.text));
    } else {
        put(&told(&found));
        put(&format!("report: {}\n", folder.join("report.html").display()));
    }
    Ok(code(&found))
}

/// An answer as tables.
fn told(found: &Answer) -> String {
    match found {
        Answer::Design(found) => tables::summary(&found.report, std::io::stdout().is_terminal()),
        Answer::Characteristic(found) => tables::characteristic(found),
        Answer::Comparison(found) => proof_tables::comparison(found),
        Answer::Gradient(found) => tables::engines(found),
    }
}

/// The exit code of an answer.
fn code(found: &Answer) -> u8 {
    match found {
        Answer::Design(found) => exit_code(found.report.outcome.status),
        Answer::Comparison(found) if found.any_wrong() && found.status != ComparisonStatus::Cancelled => {
            EXIT_WRONG_GRADIENT
        }
        _ => match found.status().as_str() {
            "cancelled" => exit_code(crate::optimise::Outcome::Cancelled),
            "incomplete" => EXIT_INCOMPLETE,
            _ => 0,
        },
    }
}

/// The study, from the design of an earlier report if there is one.
fn started(study: Study, report: Option<&Path>) -> Result<Study, Stop> {
    let Some(path) = report else { return Ok(study) };
    let unreadable = |e: String| {
        let words = format!("cannot be started from: {e}; give the report.json of an earlier 'stribeck run'");
        Stop::File(path.to_owned(), std::io::Error::other(words))
    };
    let text = std::fs::read_to_string(path).map_err(|e| Stop::File(path.to_owned(), e))?;
    let found: report::Report = serde_json::from_str(&text).map_err(|e| unreadable(e.to_string()))?;
    let (study, count) = study.started_from(&found).map_err(unreadable)?;
    eprintln!("starting from {count} parameter values of {}", path.display());
    Ok(study)
}

pub(super) fn check(a: &CheckArguments) -> Result<u8, Stop> {
    let study = read(&a.file, a.json)?;
    if a.json {
        put(&(serde_json::to_string_pretty(&study.to_json()).unwrap_or_default() + "\n"));
    } else {
        put(&format!("# checked: no mistakes; every default is written out\n# hash: {}\n", study.hash));
        put(&study.to_toml());
    }
    Ok(0)
}

pub(super) fn schema(a: &SchemaArguments) -> Result<u8, Stop> {
    let schema = if a.report { report::schema() } else { crate::study::schema() };
    put(&(serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"));
    Ok(0)
}

pub(super) fn gradient(a: &GradientArguments) -> Result<u8, Stop> {
    let study = read(&a.file, a.json)?;
    if study.points.is_empty() {
        eprintln!("error: {}: a study that tabulates a characteristic has no gradient", a.file.display());
        return Ok(EXIT_STUDY);
    }
    if a.check {
        return checked(&study, a);
    }
    let engines = a.engine.map_or_else(|| vec![study.engine], super::EngineChoice::engines);
    let sweep = if a.sweep { Sweep::wide() } else { Sweep(vec![study.perturbation]) };
    let (cancel, bars) = (cancel_on_ctrl_c(), Bars::new(0));
    let context = RunContext { cancel: &cancel, progress: &bars };
    let result = compare_engines(&study, &engines, &sweep, context);
    bars.finish();
    let comparisons = result.map_err(Stop::Simulation)?;
    let json = serde_json::to_string_pretty(&comparisons).unwrap_or_default() + "\n";
    if let Some(path) = &a.out {
        std::fs::write(path, &json).map_err(|e| Stop::File(path.clone(), e))?;
    }
    put(&if a.json { json } else { tables::engines(&comparisons) });
    Ok(0)
}

/// Proves the gradient and says what was found.
fn checked(study: &Study, a: &GradientArguments) -> Result<u8, Stop> {
    let (cancel, bars) = (cancel_on_ctrl_c(), Bars::new(0));
    let context = RunContext { cancel: &cancel, progress: &bars };
    let result = prove(study, &study.check_perturbations(), context);
    bars.finish();
    let cases = result.map_err(Stop::Simulation)?;
    let json = serde_json::to_string_pretty(&cases).unwrap_or_default() + "\n";
    if let Some(path) = &a.out {
        std::fs::write(path, &json).map_err(|e| Stop::File(path.clone(), e))?;
    }
    put(&if a.json { json } else { proof_tables::proof(&cases) });
    Ok(if cases.iter().any(|c| c.any_wrong()) { EXIT_WRONG_GRADIENT } else { 0 })
}

//! The commands but `run`, and what all of them share.

use super::progress::Bars;
use super::{
    CheckArguments, EXIT_FILE, EXIT_STUDY, EXIT_WRONG_GRADIENT, GradientArguments, ReportChoice,
    SchemaArguments, exit_code, faults, proof_tables, tables,
};
use crate::optimise::EvaluationError;
use crate::report;
use crate::run::{Cancel, RunContext};
use crate::study::{Format, Reading, Study, StudyErrors, Sweep, compare_engines, prove};
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
pub(super) fn put(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Reads a study; tables in files are looked for beside it.
pub(super) fn read(path: &Path, with: Reading<'_>, json: bool) -> Result<Study, Stop> {
    let text = std::fs::read_to_string(path).map_err(|e| Stop::File(path.to_owned(), e))?;
    let with = Reading { base: Some(path.parent().unwrap_or(Path::new("."))), ..with };
    Study::read_with(&text, Format::of_path(path), &with).map_err(|e| Stop::Study(path.to_owned(), e, json))
}

/// A flag that Ctrl-C raises; a second Ctrl-C ends the process at once.
pub(super) fn cancel_on_ctrl_c() -> Cancel {
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

/// The study, from the design of an earlier report if there is one.
pub(super) fn started(study: Study, report: Option<&Path>) -> Result<Study, Stop> {
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
    let study = read(&a.file, Reading::default(), a.json)?;
    if a.json {
        put(&(serde_json::to_string_pretty(&study.to_json()).unwrap_or_default() + "\n"));
    } else {
        put(&format!("# checked: no mistakes; every default is written out\n# hash: {}\n", study.hash));
        put(&study.to_toml());
    }
    Ok(0)
}

pub(super) fn schema(a: &SchemaArguments) -> Result<u8, Stop> {
    let schema = match a.report {
        None => crate::study::schema(),
        Some(ReportChoice::Design) => report::schema::<report::Report>(),
        Some(ReportChoice::Characteristic) => report::schema::<report::Characteristic>(),
        Some(ReportChoice::Experiments) => report::schema::<report::Experiments>(),
        Some(ReportChoice::Comparison) => report::schema::<report::Comparison>(),
    };
    put(&(serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"));
    Ok(0)
}

pub(super) fn gradient(a: &GradientArguments) -> Result<u8, Stop> {
    let study = read(&a.file, Reading::default(), a.json)?;
    if study.points.is_empty() {
        eprintln!("error: {}: a study that tabulates a characteristic has no gradient", a.file.display());
        return Ok(EXIT_STUDY);
    }
    if a.check {
        return checked(&study, a);
    }
    let engines = a.engine.map_or_else(|| vec![study.engine], super::EngineChoice::engines);
    let sweep = if a.sweep { Sweep::wide() } else { Sweep(vec![study.perturbation]) };
    let (cancel, bars) = (cancel_on_ctrl_c(), Bars::alone(0, study.optimiser.options.settings.tolerance));
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
    let (cancel, bars) = (cancel_on_ctrl_c(), Bars::alone(0, study.optimiser.options.settings.tolerance));
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

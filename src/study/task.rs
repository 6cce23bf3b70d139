//! What a study can be asked for, and the answer in one form, whoever asks: command line or service.

use super::check::Study;
use super::engines::{EngineComparison, Sweep, compare_engines};
use super::{characterise, compare, run_saved, simulate};
use crate::optimise::EvaluationError;
use crate::report::{
    Characteristic, Comparison, Findings, ReportFile, characteristic_files, comparison_files, files,
};
use crate::run::{RunContext, Store};

/// What is wanted of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// Its answer: a design, or the table or comparison it asks for.
    Answer,
    /// The start design simulated, nothing searched.
    Simulation,
    /// The gradient at the start design, by the study's engine.
    Gradient,
}

/// What was found.
pub enum Answer {
    /// A design.
    Design(Box<Findings>),
    /// A table.
    Characteristic(Characteristic),
    /// Gradient engines side by side.
    Comparison(Comparison),
    /// Gradients, one entry per bearing and operating point.
    Gradient(Vec<EngineComparison>),
}

/// Does what is wanted. A search that fails is an answer too; an error is a gradient that cannot be.
pub fn answer<'r>(
    study: &Study,
    task: Task,
    context: RunContext<'r>,
    store: &'r dyn Store,
) -> Result<Answer, EvaluationError> {
    match task {
        Task::Gradient if study.points.is_empty() => {
            Err(EvaluationError::Failed("a study that tabulates a characteristic has no gradient".to_owned()))
        }
        Task::Gradient => compare_engines(study, &[study.engine], &Sweep(vec![study.perturbation]), context)
            .map(Answer::Gradient),
        Task::Answer | Task::Simulation => {
            if let Some(found) = characterise(study, context) {
                return Ok(Answer::Characteristic(found));
            }
            if let Some(found) = compare(study, context) {
                return Ok(Answer::Comparison(found));
            }
            let findings = match task {
                Task::Simulation => simulate(study, context),
                _ => run_saved(study, context, store),
            };
            Ok(Answer::Design(Box::new(findings)))
        }
    }
}

impl Answer {
    /// How it ended: an [`Outcome`] for designs, "complete", "incomplete" or "cancelled" for everything else.
    pub fn status(&self) -> String {
        fn word(status: impl serde::Serialize) -> String {
            serde_json::to_value(status).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
        }
        match self {
            Self::Design(found) => word(found.report.outcome.status),
            Self::Characteristic(found) => word(found.status),
            Self::Comparison(found) => word(found.status),
            Self::Gradient(_) => "complete".to_owned(),
        }
    }

    /// Whether it is only what was known when it was stopped.
    pub fn is_cancelled(&self) -> bool {
        self.status() == "cancelled"
    }

    /// `report.json`, `report.html` (none for gradients) and what stands beside them; with `plots` the figures of a design, too.
    pub fn files(&self, plots: bool) -> std::io::Result<Vec<ReportFile>> {
        match self {
            Self::Design(found) => files(found, plots),
            Self::Characteristic(found) => characteristic_files(found),
            Self::Comparison(found) => comparison_files(found),
            Self::Gradient(found) => {
                let text = serde_json::to_string_pretty(found).map_err(std::io::Error::other)? + "\n";
                Ok(vec![ReportFile { name: "report.json".to_owned(), text }])
            }
        }
    }
}

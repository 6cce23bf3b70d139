//! What a study can be asked for, and the answer in one form, whoever asks: command line or service.

use super::check::Study;
use super::engines::{EngineComparison, Sweep, compare_engines};
use super::expected::judged;
use super::{characterise, compare, experiment, run_saved, simulate};
use crate::optimise::EvaluationError;
use crate::report::{
    Characteristic, Comparison, ExpectedReport, Experiments, Findings, ReportFile, characteristic_files,
    comparison_files, experiments_files, files, word,
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
    /// Experiments.
    Experiments(Experiments),
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
        Task::Simulation if study.searches() || study.experiments.is_some() => {
            Ok(Answer::Design(Box::new(simulate(study, context))))
        }
        Task::Answer | Task::Simulation => {
            let mut found = asked(study, context, store);
            found.hold_against(study);
            Ok(found)
        }
    }
}

/// What a study asks for.
fn asked<'r>(study: &Study, context: RunContext<'r>, store: &'r dyn Store) -> Answer {
    if let Some(found) = characterise(study, context) {
        return Answer::Characteristic(found);
    }
    if let Some(found) = compare(study, context) {
        return Answer::Comparison(found);
    }
    match experiment(study, context, store) {
        Some(found) => Answer::Experiments(found),
        None => Answer::Design(Box::new(run_saved(study, context, store))),
    }
}

impl Answer {
    /// How it ended: an [`crate::optimise::Outcome`] for designs, "complete", "incomplete" or "cancelled" for everything else.
    pub fn status(&self) -> String {
        match self {
            Self::Design(found) => word(found.report.outcome.status),
            Self::Characteristic(found) => word(found.status),
            Self::Comparison(found) => word(found.status),
            Self::Experiments(found) => word(found.status),
            Self::Gradient(_) => "complete".to_owned(),
        }
    }

    /// Figures the study expects, held against the answer.
    pub fn expected(&self) -> &[ExpectedReport] {
        match self {
            Self::Design(found) => &found.report.expected,
            Self::Characteristic(found) => &found.expected,
            Self::Comparison(found) => &found.expected,
            Self::Experiments(found) => &found.expected,
            Self::Gradient(_) => &[],
        }
    }

    /// Holds the figures the study expects against it.
    fn hold_against(&mut self, study: &Study) {
        if study.expected.is_empty() || self.is_cancelled() {
            return;
        }
        let judge =
            |report: serde_json::Result<serde_json::Value>| judged(study, &report.unwrap_or_default());
        match self {
            Self::Design(found) => found.report.expected = judge(serde_json::to_value(&found.report)),
            Self::Characteristic(found) => found.expected = judge(serde_json::to_value(&*found)),
            Self::Comparison(found) => found.expected = judge(serde_json::to_value(&*found)),
            Self::Experiments(found) => found.expected = judge(serde_json::to_value(&*found)),
            Self::Gradient(_) => {}
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
            Self::Experiments(found) => experiments_files(found),
            Self::Gradient(found) => {
                let text = serde_json::to_string_pretty(found).map_err(std::io::Error::other)? + "\n";
                Ok(vec![ReportFile { name: "report.json".to_owned(), text }])
            }
        }
    }
}

//! The answer as data, tables, pictures and pages.
//!
//! [`Report`] is the content of `report.json`; [`Curves`] hold what the plots and `orbit.csv` need. Both are filled by the
//! floor above; here they are written. Deliberately not here: how the numbers came about.

mod characteristic;
mod comparison;
mod csv_file;
mod data;
mod design_csv;
mod experiments;
mod figures;
mod headline;
mod headlines;
mod html;
mod index;
mod maps;
mod run_in_figures;
mod running_in;
mod searches;
mod side_by_side;
mod svg;
mod vtk;

pub use characteristic::{
    CHARACTERISTIC_FORMAT, Characteristic, CharacteristicColumn, CharacteristicStatus, CharacteristicTable,
    characteristic_csv, characteristic_files, characteristic_html,
};
pub use comparison::{
    BestError, COMPARISON_FORMAT, CaseTiming, ComparedCase, Comparison, ComparisonStatus, DifferenceRow,
    EngineCost, EngineTime, ProvenCase, ProvenQuantity, SpeedUp, Timing, comparison_csv, comparison_files,
    comparison_html, timing_csv,
};
pub use csv_file::{orbit_csv, sensitivity_csv};
pub use data::*;
pub use design_csv::design_csv;
pub use experiments::{
    EXPERIMENTS_FORMAT, EffectReport, ExperimentRun, Experiments, ExperimentsStatus, FactorReport,
    RefinementReport, ResponseReport, effects, experiments_csv, experiments_files, experiments_html,
    refinements,
};
pub use headline::headline;
pub use headlines::{characteristic_headline, comparison_headline, experiments_headline};
pub use html::{html, plain_page};
pub use index::{IndexEntry, index_html};
pub use running_in::{
    ApproximationReport, BearingRunningIn, BeforeAfter, CycleState, MinimisedReport, ProfileReport,
    RunningInBlock, RunningInGradientReport, RunningInReport, StageReport, StribeckPoint, WearLimitReport,
    running_in_csv, stribeck_csv, wear_csv,
};
pub use searches::{
    ChoiceReport, ChoiceRun, ChoicesReport, LinearReport, LocalOptimum, ParetoPoint, ParetoReport, RivalRun,
    RobustReport, SampledLimit, StartRun, StartsReport, ToleranceReport, WorstCaseReport, pareto_csv,
};
pub use side_by_side::{
    CasePair, ColumnPair, DesignPair, LeafComparison, LeafDifference, LimitPair, LimitSide, LimitState,
    NumberPair, ReportHead, SIDE_BY_SIDE_FORMAT, Side, SideBySide, TablePair, TextPair, side_by_side,
    side_by_side_files, side_by_side_html,
};
pub use vtk::film_vtk;

use std::path::Path;

/// JSON Schema (2020-12) of the `report.json` of an answer.
pub fn schema<T: schemars::JsonSchema>() -> serde_json::Value {
    schemars::schema_for!(T).to_value()
}

/// One file of a report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Name, without a folder.
    pub name: String,
    /// Content.
    pub text: String,
}

/// Collects the files of a report.
#[derive(Debug, Default)]
struct Files(Vec<ReportFile>);

impl Files {
    fn add<E: Into<Box<dyn std::error::Error + Send + Sync>>>(
        &mut self,
        name: impl Into<String>,
        text: Result<String, E>,
    ) -> std::io::Result<()> {
        self.0.push(ReportFile { name: name.into(), text: text.map_err(std::io::Error::other)? });
        Ok(())
    }

    fn json(&mut self, report: &impl serde::Serialize) -> std::io::Result<()> {
        self.add("report.json", serde_json::to_string_pretty(report).map(|text| text + "\n"))
    }
}

/// The files of a report: `report.json`, `design.csv` and its like, `orbit.csv`, where there are any the fields (`sensitivity.csv`, `*.vts`), `report.html`;
/// with `plots` every figure of the page as SVG, too.
pub fn files(findings: &Findings, plots: bool) -> std::io::Result<Vec<ReportFile>> {
    let mut all = Files::default();
    all.json(&findings.report)?;
    for (name, text) in design_csv(&findings.report).map_err(std::io::Error::other)? {
        all.add(name, Ok::<_, std::fmt::Error>(text))?;
    }
    all.add("orbit.csv", orbit_csv(findings))?;
    if findings.curves.iter().any(|c| c.sensitivity.is_some()) {
        all.add("sensitivity.csv", sensitivity_csv(findings))?;
    }
    if let Some(front) = &findings.report.pareto {
        all.add("pareto.csv", pareto_csv(front))?;
    }
    if let Some(r) = &findings.report.running_in {
        all.add("running-in.csv", running_in_csv(r))?;
        all.add("stribeck.csv", stribeck_csv(r))?;
        all.add("wear.csv", wear_csv(r))?;
    }
    for (k, c) in findings.curves.iter().enumerate() {
        for (surface, text) in film_vtk(c) {
            all.add(format!("{surface}-{}.vts", k + 1), Ok::<_, std::fmt::Error>(text))?;
        }
    }
    let figures = html::Figures::of(findings);
    all.add("report.html", figures.page(&findings.report))?;
    if plots {
        all.0.extend(figures.files());
    }
    Ok(all.0)
}

/// Writes the files of a report into a folder, which is made if need be.
pub fn write_folder(files: &[ReportFile], folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    files.iter().try_for_each(|f| std::fs::write(folder.join(&f.name), &f.text))
}

/// A value of one of the report's lists of words, as the report writes it: "almost-converged".
pub fn word(of: impl serde::Serialize) -> String {
    match serde_json::to_value(of) {
        Ok(serde_json::Value::String(word)) => word,
        _ => String::new(),
    }
}

/// What a column or an axis is called: a title with its unit, if it has one.
pub fn titled(title: &str, unit: &str) -> String {
    match unit {
        "" | "1" => title.to_owned(),
        unit => format!("{title} [{unit}]"),
    }
}

/// A number with four significant digits, plain if that is readable.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let size = value.abs().log10().floor() as i32;
    if !(-4..7).contains(&size) {
        return format!("{value:.3e}");
    }
    let digits = usize::try_from(3 - size).unwrap_or(0);
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_have_four_significant_digits() {
        for (value, text) in [
            (1311.304, "1311"),
            (0.003_380_99, "0.003381"),
            (75.0, "75"),
            (60.648_4, "60.65"),
            (-1e-9, "-1.000e-9"),
            (0.0, "0"),
            (123_456.7, "123457"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}

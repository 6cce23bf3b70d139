//! The answer as data, tables, pictures and pages.
//!
//! [`Report`] is the content of `report.json`; [`Curves`] hold what the plots and `orbit.csv` need. Both are filled by the
//! floor above; here they are written. Deliberately not here: how the numbers came about.

mod characteristic;
mod comparison;
mod csv_file;
mod data;
mod figures;
mod html;
mod maps;
mod run_in_figures;
mod running_in;
mod searches;
mod svg;
mod vtk;

pub use characteristic::{
    CHARACTERISTIC_FORMAT, Characteristic, CharacteristicColumn, CharacteristicStatus, CharacteristicTable,
    characteristic_csv, characteristic_html, write_characteristic,
};
pub use comparison::{
    BestError, COMPARISON_FORMAT, CaseTiming, ComparedCase, Comparison, ComparisonStatus, DifferenceRow,
    EngineCost, EngineTime, ProvenCase, ProvenQuantity, SpeedUp, Timing, comparison_csv, comparison_html,
    timing_csv, write_comparison,
};
pub use csv_file::{orbit_csv, sensitivity_csv};
pub use data::*;
pub use html::html;
pub use running_in::{
    ApproximationReport, BearingRunningIn, BeforeAfter, CycleState, MinimisedReport, ProfileReport,
    RunningInBlock, RunningInGradientReport, RunningInReport, StageReport, StribeckPoint, WearLimitReport,
    running_in_csv, stribeck_csv, wear_csv,
};
pub use searches::{
    ChoiceReport, ChoiceRun, ChoicesReport, LinearReport, LocalOptimum, ParetoPoint, ParetoReport, RivalRun,
    RobustReport, SampledLimit, StartRun, StartsReport, ToleranceReport, WorstCaseReport, pareto_csv,
};
pub use vtk::film_vtk;

use std::path::Path;

/// JSON Schema (2020-12) of `report.json`.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Report).to_value()
}

/// Writes `report.json`, `report.html`, `orbit.csv` and, where there are any, the fields (`sensitivity.csv`, `*.vts`) into a
/// folder, which is made if need be.
pub fn write_folder(findings: &Findings, folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let json = serde_json::to_string_pretty(&findings.report).map_err(std::io::Error::other)?;
    std::fs::write(folder.join("report.json"), json + "\n")?;
    std::fs::write(folder.join("orbit.csv"), orbit_csv(findings).map_err(std::io::Error::other)?)?;
    if findings.curves.iter().any(|c| c.sensitivity.is_some()) {
        let csv = sensitivity_csv(findings).map_err(std::io::Error::other)?;
        std::fs::write(folder.join("sensitivity.csv"), csv)?;
    }
    if let Some(front) = &findings.report.pareto {
        std::fs::write(folder.join("pareto.csv"), pareto_csv(front).map_err(std::io::Error::other)?)?;
    }
    if let Some(r) = &findings.report.running_in {
        let csv = |text: Result<String, csv::Error>| text.map_err(std::io::Error::other);
        std::fs::write(folder.join("running-in.csv"), csv(running_in_csv(r))?)?;
        std::fs::write(folder.join("stribeck.csv"), csv(stribeck_csv(r))?)?;
        std::fs::write(folder.join("wear.csv"), csv(wear_csv(r))?)?;
    }
    for (k, c) in findings.curves.iter().enumerate() {
        for (surface, text) in film_vtk(c) {
            std::fs::write(folder.join(format!("{surface}-{}.vts", k + 1)), text)?;
        }
    }
    std::fs::write(folder.join("report.html"), html(findings).map_err(std::io::Error::other)?)
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

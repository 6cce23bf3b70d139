//! `orbit.csv`: the working cycles at the design found, one row per bearing, operating point and step; `sensitivity.csv`: the
//! derivative of the mean loss by the local gap, one row per bearing, operating point, surface and cell.

use super::Findings;

/// The table as text.
pub fn orbit_csv(findings: &Findings) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "bearing",
        "operating_point",
        "crank_angle_deg",
        "eccentricity_x_ratio",
        "eccentricity_y_ratio",
        "film_thickness_min_um",
        "gap_max_um",
        "film_pressure_max_mpa",
        "contact_pressure_max_mpa",
        "friction_loss_w",
        "contact_loss_w",
        "dissipation_w",
        "side_flow_l_min",
        "load_x_kn",
        "load_y_kn",
    ])?;
    for c in &findings.curves {
        for n in 0..c.crank_angle_deg.len() {
            let numbers = [
                c.crank_angle_deg[n],
                c.eccentricity[n][0],
                c.eccentricity[n][1],
                c.film_min_um[n],
                c.gap_max_um[n],
                c.pressure_max_mpa[n],
                c.contact_max_mpa[n],
                c.loss_w[n],
                c.contact_loss_w[n],
                c.dissipation_w[n],
                c.side_flow_l_min[n],
                c.load_kn[n][0],
                c.load_kn[n][1],
            ];
            let text = numbers.map(number);
            writer.write_record([c.bearing.clone(), c.operating_point.clone()].into_iter().chain(text))?;
        }
    }
    written(writer)
}

/// The sensitivity maps as text.
pub fn sensitivity_csv(findings: &Findings) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let head =
        ["bearing", "operating_point", "surface", "angle_deg", "axial_mm", "loss_per_gap_w_per_um_cm2"];
    writer.write_record(head)?;
    for c in &findings.curves {
        let Some(s) = &c.sensitivity else { continue };
        for (surface, field) in [("shell", &s.shell_w_per_um_cm2), ("journal", &s.journal_w_per_um_cm2)] {
            for (i, row) in field.iter().enumerate() {
                let angle = 360.0 * i as f64 / field.len() as f64;
                for (j, value) in row.iter().enumerate() {
                    let axial = c.width_mm * ((j as f64 + 0.5) / row.len() as f64 - 0.5);
                    let numbers = [format!("{angle:.4}"), format!("{axial:.4}"), number(*value)];
                    let labels = [c.bearing.clone(), c.operating_point.clone(), surface.to_owned()];
                    writer.write_record(labels.into_iter().chain(numbers))?;
                }
            }
        }
    }
    written(writer)
}

/// What was written, as text.
pub(super) fn written(writer: csv::Writer<Vec<u8>>) -> Result<String, csv::Error> {
    let bytes = writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Head and rows as text.
pub(super) fn table(
    head: &[&str],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(head)?;
    for row in rows {
        writer.write_record(row)?;
    }
    written(writer)
}

/// A number with ten digits.
pub(super) fn number(value: f64) -> String {
    format!("{value:.9e}")
}

/// A number that may be missing.
pub(super) fn maybe(value: Option<f64>) -> String {
    value.map_or_else(String::new, number)
}

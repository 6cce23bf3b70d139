//! Film fields as VTK structured grids (`.vts`, XML, ASCII), for ParaView and its kin: one patch per cell on the cylinder of
//! the surface, lengths in mm.
//!
//! Written by hand: the format is a page of text, and the crate for it is not kept up. Deliberately not here: fields over
//! time.

use super::Curves;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Name of a surface and its grid: the shell with film pressure and fill at the instant of the largest pressure and the
/// what shapes add to the gap, and the derivative of the mean loss by the local gap; the journal with the latter. Nothing for a film without fields.
pub fn film_vtk(c: &Curves) -> Vec<(&'static str, String)> {
    let mut shell: Vec<(&str, &[Vec<f64>])> = vec![("film_pressure_mpa", &c.pressure_map_mpa)];
    if !c.fill_map.is_empty() {
        shell.push(("fill", &c.fill_map));
    }
    if !c.shape_um.is_empty() {
        shell.push(("shape_um", &c.shape_um));
    }
    let Some(s) = &c.sensitivity else { return Vec::new() };
    shell.push(("loss_per_gap_w_per_um_cm2", &s.shell_w_per_um_cm2));
    let journal: [(&str, &[Vec<f64>]); 1] = [("loss_per_gap_w_per_um_cm2", &s.journal_w_per_um_cm2)];
    vec![("shell", grid(c, &shell)), ("journal", grid(c, &journal))]
}

fn grid(c: &Curves, fields: &[(&str, &[Vec<f64>])]) -> String {
    let (around, across) = (fields[0].1.len(), fields[0].1.first().map_or(0, Vec::len));
    let extent = format!("0 {across} 0 {around} 0 0");
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<!-- {} -->\n<VTKFile type=\"StructuredGrid\" version=\"0.1\">\n<StructuredGrid WholeExtent=\"{extent}\">\n<Piece Extent=\"{extent}\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n",
        format!("{}, {}", c.bearing, c.operating_point).replace("--", "- -"),
    );
    for i in 0..=around {
        // Cells stand around their centres, at whole multiples of the angle between columns.
        let (s, c_phi) = (TAU * (i as f64 - 0.5) / around as f64).sin_cos();
        for j in 0..=across {
            let r = c.diameter_mm / 2.0;
            let z = c.width_mm * (j as f64 / across as f64 - 0.5);
            let _ = writeln!(text, "{:.6} {:.6} {z:.6}", r * c_phi, r * s);
        }
    }
    text += "</DataArray>\n</Points>\n<CellData>\n";
    for (name, field) in fields {
        let _ = writeln!(text, "<DataArray type=\"Float64\" Name=\"{name}\" format=\"ascii\">");
        for row in *field {
            let line: Vec<String> = row.iter().map(|v| format!("{v:.9e}")).collect();
            text += &line.join(" ");
            text.push('\n');
        }
        text += "</DataArray>\n";
    }
    text + "</CellData>\n</Piece>\n</StructuredGrid>\n</VTKFile>\n"
}

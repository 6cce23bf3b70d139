//! The tabulation: bearings at given eccentricities, or a shaft over its speed.

use super::build;
use super::characteristic::{CharacteristicPlan, Vary};
use super::check::Study;
use super::run::{assumptions, provenance};
use crate::cranktrain::{BearingOutput, BearingSetup, JournalBearing};
use crate::film::{FilmSite, SteadyState, steady_at};
use crate::orbit::{Orbit, settle};
use crate::report::{
    CHARACTERISTIC_FORMAT, Characteristic, CharacteristicColumn, CharacteristicStatus, CharacteristicTable,
    ReportTiming, characteristic_headline,
};
use crate::run::{Event, RunContext};
use std::f64::consts::TAU;
use std::time::Instant;

/// Name of the table in which torques add up.
const SHAFT: &str = "shaft";
/// Rows of a reference belong to a value of the varied quantity if they differ by no more than this share.
const SAME: f64 = 1e-6;

/// Tabulates a study that has a characteristic.
pub fn characterise(study: &Study, context: RunContext<'_>) -> Option<Characteristic> {
    let plan = study.characteristic.as_ref()?;
    let began = Instant::now();
    let mut work = Work { study, context, failures: Vec::new() };
    let mut tables = match &plan.vary {
        &Vary::Eccentricity { ref ratios, speed_rad_s, ambient_at_widest_gap } => (0..study.bearings.len())
            .map(|b| work.eccentricity_table(b, ratios, speed_rad_s, ambient_at_widest_gap))
            .collect(),
        Vary::Speed(speeds) => work.speed_tables(speeds),
    };
    compare(plan, &mut tables);
    let status = match (context.cancel.is_cancelled(), work.failures.is_empty()) {
        (true, _) => CharacteristicStatus::Cancelled,
        (false, true) => CharacteristicStatus::Complete,
        (false, false) => CharacteristicStatus::Incomplete,
    };
    let mut found = Characteristic {
        schema_version: CHARACTERISTIC_FORMAT.to_owned(),
        study_hash: study.hash.clone(),
        title: study.file.title.value().cloned().unwrap_or_default(),
        question: study.file.question.value().cloned(),
        status,
        answer: Vec::new(),
        failures: work.failures,
        reference_source: plan.source.clone(),
        tables,
        expected: Vec::new(),
        timing: ReportTiming { seconds: began.elapsed().as_secs_f64(), rivals_s: Vec::new() },
        assumptions: assumptions(study),
        provenance: provenance(study),
    };
    found.answer = characteristic_headline(&found);
    Some(found)
}

struct Work<'a> {
    study: &'a Study,
    context: RunContext<'a>,
    failures: Vec<String>,
}

/// Columns by key, title and unit, filled row by row.
struct Rows {
    heads: Vec<(&'static str, &'static str, &'static str)>,
    values: Vec<Vec<Option<f64>>>,
}

impl Rows {
    fn new(heads: &[(&'static str, &'static str, &'static str)]) -> Self {
        Self { heads: heads.to_vec(), values: vec![Vec::new(); heads.len()] }
    }

    fn push(&mut self, row: Option<Vec<f64>>) {
        for (k, column) in self.values.iter_mut().enumerate() {
            column.push(row.as_ref().map(|r| r[k]));
        }
    }

    fn columns(self) -> Vec<CharacteristicColumn> {
        let made = |((key, title, unit), values)| CharacteristicColumn::new(key, title, unit, values);
        self.heads.into_iter().zip(self.values).map(made).collect()
    }
}

impl Work<'_> {
    fn eccentricity_table(
        &mut self,
        bearing: usize,
        ratios: &[f64],
        speed_rad_s: f64,
        ambient_at_widest_gap: bool,
    ) -> CharacteristicTable {
        let name = self.study.bearings[bearing].name.clone();
        let mut rows = Rows::new(&[
            ("sommerfeld_number", "Sommerfeld number", "1"),
            ("attitude_deg", "attitude angle", "deg"),
            ("side_flow_number", "side flow number", "1"),
            ("friction_number", "friction number", "1"),
            ("pressure_max_mpa", "largest film pressure", "MPa"),
            ("film_min_um", "smallest film thickness", "um"),
        ]);
        for &eps in ratios {
            if self.context.cancel.is_cancelled() {
                rows.push(None);
                continue;
            }
            self.context.progress.tell(&Event::Stage { name: format!("{name} at eccentricity ratio {eps}") });
            let row = self.at_eccentricity(bearing, eps, speed_rad_s, ambient_at_widest_gap);
            rows.push(
                row.map_err(|e| self.failures.push(format!("{name} at eccentricity ratio {eps}: {e}"))).ok(),
            );
        }
        let varied = ratios.iter().map(|r| Some(*r)).collect();
        CharacteristicTable {
            name,
            varied: CharacteristicColumn::new("eccentricity_ratio", "eccentricity ratio", "1", varied),
            columns: rows.columns(),
        }
    }

    fn at_eccentricity(
        &self,
        bearing: usize,
        eps: f64,
        speed_rad_s: f64,
        ambient_at_widest_gap: bool,
    ) -> Result<Vec<f64>, String> {
        let film = build::characteristic_film(self.study, bearing, ambient_at_widest_gap);
        let setup = self.setup(bearing, speed_rad_s)?;
        let model = JournalBearing::new(setup).map_err(|e| e.to_string())?;
        let c = model.setup().diametral_clearance_m / 2.0;
        let (input, shape) = model.still_input([eps * c, 0.0], speed_rad_s);
        let site = FilmSite { input, shape_m: &shape, journal_angle_rad: 0.0, marks: &[], shell_left: &[] };
        let SteadyState { q, output, .. } =
            steady_at(film.as_ref(), &site, None).map_err(|e| e.to_string())?;
        let [fx, fy] = output.force_n;
        let (force, radius) = (fx.hypot(fy), input.diameter_m / 2.0);
        let psi = c / radius;
        let side = output.side_flow_m3_s / (radius.powi(3) * psi * speed_rad_s);
        let friction = (output.loss_w + output.contact_loss_w) / (radius * speed_rad_s) / force / psi;
        Ok(vec![
            input.sommerfeld(force, speed_rad_s),
            (-fy).atan2(-fx).to_degrees().abs(),
            side,
            friction,
            film.pressure_max_pa(&site, &q) * 1e-6,
            output.gap_min_m * 1e6,
        ])
    }

    fn setup(&self, bearing: usize, speed_rad_s: f64) -> Result<BearingSetup, String> {
        build::still_setup(self.study, bearing, speed_rad_s).map_err(|e| e.to_string())
    }

    fn speed_tables(&mut self, speeds: &[f64]) -> Vec<CharacteristicTable> {
        let rpm: Vec<Option<f64>> = speeds.iter().map(|s| Some(s * 60.0 / TAU)).collect();
        let varied = CharacteristicColumn::new("speed_rpm", "speed", "rpm", rpm);
        let mut tables: Vec<CharacteristicTable> = (0..self.study.bearings.len())
            .map(|b| CharacteristicTable {
                name: self.study.bearings[b].name.clone(),
                varied: varied.clone(),
                columns: self.over_speed(b, speeds).columns(),
            })
            .collect();
        let total = |n: usize, column: usize| {
            let share = |(b, t): (usize, &CharacteristicTable)| {
                t.columns[column].values[n].map(|v| v * f64::from(self.study.bearings[b].count))
            };
            tables.iter().enumerate().map(share).sum::<Option<f64>>()
        };
        let sum = |column: usize| (0..speeds.len()).map(|n| total(n, column)).collect();
        let columns = vec![
            CharacteristicColumn::new("torque_nm", "friction torque", "N m", sum(0)),
            CharacteristicColumn::new("hydrodynamic_torque_nm", "hydrodynamic part", "N m", sum(1)),
            CharacteristicColumn::new("contact_torque_nm", "contact part", "N m", sum(2)),
        ];
        tables.insert(0, CharacteristicTable { name: SHAFT.to_owned(), varied, columns });
        tables
    }

    fn over_speed(&mut self, bearing: usize, speeds: &[f64]) -> Rows {
        let name = self.study.bearings[bearing].name.clone();
        let mut rows = Rows::new(&[
            ("torque_nm", "friction torque", "N m"),
            ("hydrodynamic_torque_nm", "hydrodynamic part", "N m"),
            ("contact_torque_nm", "contact part", "N m"),
            ("eccentricity_ratio", "eccentricity ratio", "1"),
            ("film_min_um", "smallest film thickness", "um"),
            ("pressure_max_mpa", "largest film pressure", "MPa"),
            ("contact_pressure_max_mpa", "largest contact pressure", "MPa"),
            ("film_temperature_c", "film temperature", "degC"),
        ]);
        let mut near: Option<Orbit> = None;
        for &speed in speeds {
            let rpm = speed * 60.0 / TAU;
            if self.context.cancel.is_cancelled() {
                rows.push(None);
                continue;
            }
            self.context.progress.tell(&Event::Stage { name: format!("{name} at {rpm:.0} rpm") });
            match self.at_speed(bearing, speed, near.as_ref()) {
                Ok((row, orbit)) => {
                    rows.push(Some(row));
                    near = Some(orbit);
                }
                Err(e) => {
                    self.failures.push(format!("{name} at {rpm:.0} rpm: {e}"));
                    rows.push(None);
                }
            }
        }
        rows
    }

    /// A constant load is a periodic one: the settled cycle is the equilibrium.
    fn at_speed(
        &self,
        bearing: usize,
        speed_rad_s: f64,
        near: Option<&Orbit>,
    ) -> Result<(Vec<f64>, Orbit), String> {
        let model = JournalBearing::new(self.setup(bearing, speed_rad_s)?).map_err(|e| e.to_string())?;
        let orbit =
            settle(&model, &self.study.orbit, near, self.context.cancel).map_err(|e| e.to_string())?;
        let model = orbit.model(&model).map_err(|e| e.to_string())?;
        let mean = |o: BearingOutput| orbit.mean(o.index());
        let (loss, contact) = (mean(BearingOutput::Loss), mean(BearingOutput::ContactLoss));
        let z = orbit.state(0);
        let n = model.film().unknowns();
        let c = model.setup().diametral_clearance_m / 2.0;
        let row = vec![
            loss / speed_rad_s,
            (loss - contact) / speed_rad_s,
            contact / speed_rad_s,
            z[n].hypot(z[n + 1]) / c,
            mean(BearingOutput::GapMin) * 1e6,
            mean(BearingOutput::PressurePeak) * 1e-6,
            mean(BearingOutput::ContactPeak) * 1e-6,
            model.film_temperature_k() - crate::laws::ZERO_CELSIUS_K,
        ];
        Ok((row, orbit))
    }
}

/// Sets the reference beside the first table's columns.
fn compare(plan: &CharacteristicPlan, tables: &mut [CharacteristicTable]) {
    let (Some(reference), Some(table)) = (&plan.reference, tables.first_mut()) else { return };
    let Ok(at) = reference.column(&[(&table.varied.key, 1.0)]) else { return };
    let varied = table.varied.values.clone();
    for column in &mut table.columns {
        if let Ok(known) = reference.column(&[(&column.key, 1.0)]) {
            let beside = |x: &Option<f64>| {
                let x = (*x)?;
                at.iter().position(|r| (r - x).abs() <= SAME * x.abs()).map(|k| known[k])
            };
            column.compare(varied.iter().map(beside).collect());
        }
    }
}

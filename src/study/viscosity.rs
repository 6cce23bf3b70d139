//! Where the viscosity comes from: a grade, a data sheet, three points, or a constant.

use super::Given;
use super::catalogue::oil as laws_of_oil;
use super::faults::{Faults, refuse_others};
use super::file::{OilFile, ViscosityLawName, ViscosityPointFile};
use super::oil::density_range;
use crate::laws::{Grade, OilDataError, Viscosity, ZERO_CELSIUS_K};
use crate::units::{HeatCapacity, PressureViscosity, tidy};

/// What a data sheet says of an oil.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    pub name: String,
    pub kinematic_40c_mm2_s: f64,
    pub kinematic_100c_mm2_s: f64,
    pub density_15c_kg_m3: f64,
    pub heat_capacity: Option<HeatCapacity>,
    pub pressure_viscosity: Option<PressureViscosity>,
}

impl Sheet {
    pub fn of_grade(grade: &Grade) -> Self {
        let heat = format!("{} J/(kg K)", grade.heat_capacity_j_kg_k);
        let rise = format!("{} 1/GPa", tidy(grade.pressure_viscosity_per_pa * 1e9));
        Self {
            name: grade.name.to_owned(),
            kinematic_40c_mm2_s: grade.kinematic_viscosity_40c_mm2_s,
            kinematic_100c_mm2_s: grade.kinematic_viscosity_100c_mm2_s,
            density_15c_kg_m3: grade.density_15c_kg_m3,
            heat_capacity: heat.parse().ok(),
            pressure_viscosity: rise.parse().ok(),
        }
    }

    fn law(&self, law: ViscosityLawName) -> Result<Viscosity, OilDataError> {
        let walther = Viscosity::from_data_sheet(
            self.kinematic_40c_mm2_s,
            self.kinematic_100c_mm2_s,
            self.density_15c_kg_m3,
        )?;
        let point = |celsius: f64| (ZERO_CELSIUS_K + celsius, walther.at(ZERO_CELSIUS_K + celsius).0);
        match law {
            ViscosityLawName::Walther => Ok(walther),
            ViscosityLawName::Vogel => Viscosity::vogel_from_two_points([point(40.0), point(100.0)]),
        }
    }
}

/// Viscosity law, its source in words, and the density at 15 degC if it is known; `heat`: the density is needed anyway.
type Found = (Viscosity, String, Option<f64>);

/// The viscosity from the one source that is given; others are refused.
pub(super) fn viscosity(
    oil: &mut OilFile,
    grade: Option<&Sheet>,
    heat: bool,
    faults: &mut Faults,
) -> Option<Found> {
    let refuse = |oil: &OilFile, source: &str, used: &[&str], faults: &mut Faults| {
        refuse_others!(
            faults,
            oil,
            "oil",
            &format!("oil.{source} is given"),
            used,
            [
                grade,
                kinematic_viscosity_40c,
                kinematic_viscosity_100c,
                density_15c,
                viscosity_law,
                viscosity_points,
            ]
        );
    };
    if !oil.dynamic_viscosity.is_absent() {
        let used: &[&str] = if heat { &["density_15c"] } else { &[] };
        refuse(oil, "dynamic_viscosity", used, faults);
        let eta = faults.get(&oil.dynamic_viscosity, "oil.dynamic_viscosity").map(|eta| eta.si());
        faults.range(eta, "oil.dynamic_viscosity", |v| v > 0.0, "above zero");
        let density = density(oil, heat, faults);
        return Some((
            Viscosity::Constant { viscosity_pa_s: eta? },
            laws_of_oil::CONSTANT.words.to_owned(),
            density,
        ));
    }
    if !oil.viscosity_points.is_absent() {
        let used: &[&str] = if heat { &["viscosity_points", "density_15c"] } else { &["viscosity_points"] };
        refuse(oil, "viscosity_points", used, faults);
        let density = density(oil, heat, faults);
        let words = laws_of_oil::VOGEL_OF_POINTS.words.to_owned();
        return Some((through_points(&oil.viscosity_points, faults)?, words, density));
    }
    if !oil.grade.is_absent() {
        refuse(oil, "grade", &["grade", "viscosity_law"], faults);
        let (law, words) = drawn_through(oil, grade, "oil.grade", faults)?;
        return Some((law, words, grade.map(|g| g.density_15c_kg_m3)));
    }
    let sheet = [
        oil.kinematic_viscosity_40c.is_absent(),
        oil.kinematic_viscosity_100c.is_absent(),
        oil.density_15c.is_absent(),
    ];
    if sheet == [true; 3] {
        let words = "needs one source of the viscosity: grade, or kinematic_viscosity_40c, kinematic_viscosity_100c and \
                     density_15c, or viscosity_points, or dynamic_viscosity";
        faults.add("oil", words);
        return None;
    }
    let sheet = data_sheet(oil, faults);
    let (law, words) = drawn_through(oil, sheet.as_ref(), "oil.kinematic_viscosity_40c", faults)?;
    Some((law, words, sheet.map(|s| s.density_15c_kg_m3)))
}

/// Walther's or Vogel's law through a data sheet.
fn drawn_through(
    oil: &mut OilFile,
    sheet: Option<&Sheet>,
    path: &str,
    faults: &mut Faults,
) -> Option<(Viscosity, String)> {
    let name = faults.or(&mut oil.viscosity_law, "oil.viscosity_law", ViscosityLawName::Walther);
    let sheet = sheet?;
    let law = sheet.law(name).map_err(|e| faults.add(path, e.to_string())).ok()?;
    let who = match name {
        ViscosityLawName::Walther => laws_of_oil::WALTHER.words,
        ViscosityLawName::Vogel => laws_of_oil::VOGEL.words,
    };
    Some((law, format!("{who}, through the two points of {}", sheet.name)))
}

fn data_sheet(oil: &OilFile, faults: &mut Faults) -> Option<Sheet> {
    let mut kinematic =
        |given, path| faults.need(given, path).map(|v: crate::units::KinematicViscosity| v.si() * 1e6);
    let nu_40 = kinematic(&oil.kinematic_viscosity_40c, "oil.kinematic_viscosity_40c");
    let nu_100 = kinematic(&oil.kinematic_viscosity_100c, "oil.kinematic_viscosity_100c");
    let density = density(oil, true, faults);
    Some(Sheet {
        name: "the data sheet".to_owned(),
        kinematic_40c_mm2_s: nu_40?,
        kinematic_100c_mm2_s: nu_100?,
        density_15c_kg_m3: density?,
        heat_capacity: None,
        pressure_viscosity: None,
    })
}

fn density(oil: &OilFile, needed: bool, faults: &mut Faults) -> Option<f64> {
    if !needed {
        return None;
    }
    let density = faults.need(&oil.density_15c, "oil.density_15c").map(|v| v.si());
    density_range(density, "oil.density_15c", faults);
    density
}

fn through_points(given: &Given<Vec<Given<ViscosityPointFile>>>, faults: &mut Faults) -> Option<Viscosity> {
    let path = "oil.viscosity_points";
    let list = faults.get(given, path)?;
    let mut points = Vec::new();
    for (i, given) in list.iter().enumerate() {
        let path = format!("{path}[{i}]");
        let Some(point) = faults.get(given, &path) else { continue };
        faults.unknown::<ViscosityPointFile>(&point.unknown, &path);
        let t = faults.need(&point.temperature, &format!("{path}.temperature"));
        let eta = faults.need(&point.dynamic_viscosity, &format!("{path}.dynamic_viscosity"));
        points.extend(t.zip(eta).map(|(t, eta)| (t.si(), eta.si())));
    }
    if list.len() != 3 {
        faults.add(path, format!("needs three points, found {}", list.len()));
    }
    let points: [(f64, f64); 3] = points.try_into().ok()?;
    Viscosity::vogel_from_points(points).map_err(|e| faults.add(path, e.to_string())).ok()
}

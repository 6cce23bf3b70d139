//! Checks of the oil: one source of its viscosity, its answer to pressure and shear, its heat.

use super::Given;
use super::faults::{Faults, join};
use super::file::{GradeFile, OilFile, StudyFile};
use super::machine::zero;
use super::plans::OilPlan;
use super::rheology;
use super::viscosity::{Sheet, viscosity};
use std::collections::BTreeMap;

/// What the rest of the study wants of the oil.
#[derive(Debug, Clone, Copy)]
pub(super) struct OilUse {
    /// The film's only law is a viscosity.
    pub mobility: bool,
    /// A bearing has a heat balance.
    pub heat: bool,
}

pub(super) fn oil(
    file: &mut StudyFile,
    used: OilUse,
    faults: &mut Faults,
    fingerprint: &mut String,
) -> Option<OilPlan> {
    let grades = grades(&mut file.grades, faults);
    faults.need(&file.oil, "oil");
    let Given::Value(oil) = &mut file.oil else { return None };
    faults.unknown::<OilFile>(&oil.unknown, "oil");
    let inlet = faults.need(&oil.inlet_temperature, "oil.inlet_temperature").map(|v| v.si());
    let words = "between -50 degC and 200 degC";
    faults.range(inlet, "oil.inlet_temperature", |v| (223.15..=473.15).contains(&v), words);
    let rise = faults.or(&mut oil.film_temperature_rise, "oil.film_temperature_rise", zero("0 K")).si();
    let words = "between 0 K and 150 K";
    faults.range(Some(rise), "oil.film_temperature_rise", |v| (0.0..=150.0).contains(&v), words);
    let grade = grade_of(oil, &grades, faults);
    for name in grades.keys().filter(|name| oil.grade.value() != Some(*name)) {
        faults.add(&format!("grades.{name}"), "is not used: oil.grade is another oil; remove it");
    }
    if let Some(grade) = &grade {
        fingerprint.push_str(&format!("{grade:?}"));
    }
    let viscosity = viscosity(oil, grade.as_ref(), used.heat, faults);
    let laws = rheology::laws(oil, grade.as_ref(), used.mobility, faults);
    let heat = heat(oil, grade.as_ref(), used.heat, faults);
    let (viscosity, source, density) = viscosity?;
    Some(OilPlan {
        viscosity,
        source,
        inlet_temperature_k: inlet?,
        film_rise_k: rise,
        laws: laws?,
        volumetric_heat_j_m3_k: if used.heat { heat * density? } else { 0.0 },
    })
}

/// The oils a study brings along.
fn grades(
    given: &mut Given<BTreeMap<String, Given<GradeFile>>>,
    faults: &mut Faults,
) -> BTreeMap<String, Option<Sheet>> {
    faults.get(given, "grades");
    let Given::Value(map) = given else { return BTreeMap::new() };
    let mut found = BTreeMap::new();
    for (name, given) in map.iter_mut() {
        let path = join("grades", name);
        faults.get(given, &path);
        if crate::laws::Grade::named(name).is_some() {
            faults.add(&path, "is the name of a known grade; choose another");
        }
        let sheet = match given {
            Given::Value(grade) => user_grade(name, grade, &path, faults),
            _ => None,
        };
        found.insert(name.clone(), sheet);
    }
    found
}

fn user_grade(name: &str, g: &mut GradeFile, path: &str, faults: &mut Faults) -> Option<Sheet> {
    faults.unknown::<GradeFile>(&g.unknown, path);
    let at = |key: &str| join(path, key);
    let nu_40 = faults.need(&g.kinematic_viscosity_40c, &at("kinematic_viscosity_40c")).map(|v| v.si());
    let nu_100 = faults.need(&g.kinematic_viscosity_100c, &at("kinematic_viscosity_100c")).map(|v| v.si());
    let density = faults.need(&g.density_15c, &at("density_15c")).map(|v| v.si());
    let heat = faults.or(&mut g.heat_capacity, &at("heat_capacity"), zero("2000 J/(kg K)"));
    let rise = faults.get(&g.pressure_viscosity_coefficient, &at("pressure_viscosity_coefficient"));
    heat_range(heat.si(), &at("heat_capacity"), faults);
    density_range(density, &at("density_15c"), faults);
    coefficient_range(rise.as_ref().map(|v| v.si()), &at("pressure_viscosity_coefficient"), faults);
    Some(Sheet {
        name: name.to_owned(),
        kinematic_40c_mm2_s: nu_40? * 1e6,
        kinematic_100c_mm2_s: nu_100? * 1e6,
        density_15c_kg_m3: density?,
        heat_capacity: Some(heat),
        pressure_viscosity: rise,
    })
}

fn grade_of(oil: &OilFile, grades: &BTreeMap<String, Option<Sheet>>, faults: &mut Faults) -> Option<Sheet> {
    let name = faults.get(&oil.grade, "oil.grade")?;
    if let Some(own) = grades.get(&name) {
        return own.clone();
    }
    let known = crate::laws::Grade::named(&name).map(Sheet::of_grade);
    if known.is_none() {
        let names: Vec<&str> = crate::laws::GRADES.iter().map(|g| g.name).collect();
        let own: String = grades.keys().map(|name| format!(", {name}")).collect();
        let list = names.join(", ");
        faults.add(
            "oil.grade",
            format!("there is no grade \"{name}\"; grades: {list}{own}, or one in [grades.NAME]"),
        );
    }
    known
}

/// Specific heat capacity, J/(kg K).
fn heat(oil: &mut OilFile, grade: Option<&Sheet>, wanted: bool, faults: &mut Faults) -> f64 {
    let path = "oil.heat_capacity";
    if !wanted {
        faults.unused(&oil.heat_capacity, path, "no bearing has a heat_balance");
        return 0.0;
    }
    let default = grade.and_then(|g| g.heat_capacity.clone()).unwrap_or_else(|| zero("2000 J/(kg K)"));
    let heat = faults.or(&mut oil.heat_capacity, path, default).si();
    heat_range(heat, path, faults);
    heat
}

fn heat_range(value: f64, path: &str, faults: &mut Faults) {
    faults.range(Some(value), path, |v| (500.0..=10_000.0).contains(&v), "between 500 and 10000 J/(kg K)");
}

pub(super) fn coefficient_range(value: Option<f64>, path: &str, faults: &mut Faults) {
    faults.range(value, path, |v| v > 0.0 && v <= 1e-7, "above 0 and at most 100 1/GPa");
}

pub(super) fn density_range(value: Option<f64>, path: &str, faults: &mut Faults) {
    faults.range(value, path, |v| (500.0..=2000.0).contains(&v), "between 500 and 2000 kg/m3");
}

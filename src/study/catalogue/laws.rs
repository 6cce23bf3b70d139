//! Laws and methods as a list, those of a study, and its references.
//!
//! Deliberately not here: the table itself, which stands in one file per topic; what a report says, see the study's methods.

use super::entry::{Choice, Entry};
use super::{experiments, film, machine, numerics, oil, search, shapes, sources, surfaces, wear};
use crate::laws::{GRADES, Grade};
use crate::study::{Study, methods};
use serde::Serialize;

/// A law or method.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Law {
    /// What it is about.
    pub topic: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its formula in plain text; empty for what has none.
    pub equation: String,
    /// Authors and years.
    pub source: String,
    /// Full references of the source.
    pub references: Vec<&'static str>,
    /// How a study asks for it: `key = "value"`, a section, or "always".
    pub chosen_by: String,
    /// Whether it holds if the study says nothing.
    pub default: bool,
    /// Where it is valid, what to mind.
    pub remark: &'static str,
    /// What a report says of it; empty where it says nothing.
    pub in_report: &'static str,
}

impl Law {
    fn of(entry: &Entry) -> Self {
        Self {
            topic: entry.topic,
            name: entry.name,
            equation: entry.equation.to_owned(),
            source: entry.sources.join("; "),
            references: entry.sources.iter().filter_map(|key| sources::full(key)).collect(),
            chosen_by: entry.chosen.text(),
            default: entry.default || entry.chosen == Choice::Always,
            remark: entry.remark,
            in_report: entry.words,
        }
    }

    fn of_grade(grade: &Grade) -> Self {
        Self {
            topic: "oil grade",
            name: grade.name,
            equation: format!(
                "{} mm2/s at 40 degC, {} mm2/s at 100 degC, {} kg/m3 at 15 degC, {} J/(kg K), {} 1/GPa",
                grade.kinematic_viscosity_40c_mm2_s,
                grade.kinematic_viscosity_100c_mm2_s,
                grade.density_15c_kg_m3,
                grade.heat_capacity_j_kg_k,
                crate::units::tidy(grade.pressure_viscosity_per_pa * 1e9),
            ),
            source: String::new(),
            references: Vec::new(),
            chosen_by: Choice::Key("oil.grade", grade.name).text(),
            default: false,
            remark: "typical mineral oil, no product; a data sheet is better",
            in_report: "",
        }
    }
}

/// The whole table, topic by topic.
fn table() -> impl Iterator<Item = &'static Entry> {
    let topics = [
        film::TABLE,
        shapes::TABLE,
        oil::TABLE,
        surfaces::TABLE,
        wear::TABLE,
        machine::TABLE,
        numerics::TABLE,
        search::TABLE,
        experiments::TABLE,
    ];
    topics.into_iter().flatten().copied()
}

/// All laws and methods, topic by topic, and the oil grades known by name.
pub fn laws() -> Vec<Law> {
    table().map(Law::of).chain(GRADES.iter().map(Law::of_grade)).collect()
}

/// Those a study uses.
pub fn laws_in_use(study: &Study) -> Vec<Law> {
    let used = methods::in_use(study);
    let name = study.file.oil.value().and_then(|o| o.grade.value());
    let grade = name.and_then(|name| Grade::named(name)).map(Law::of_grade);
    table().filter(|e| used.iter().any(|u| std::ptr::eq(*u, *e))).map(Law::of).chain(grade).collect()
}

/// Full references of the laws and methods a study uses, each once, in the order of its report.
pub fn references(study: &Study) -> Vec<String> {
    methods::references(study)
}

#[cfg(test)]
mod tests {
    use super::super::docs;
    use super::super::example::study;
    use super::*;
    use crate::gradient::EngineName;
    use crate::optimise::Method;
    use crate::study::file::{
        AccelerationName, AggregateName, CavitationName, CavityShearName, CompressibilityName,
        ContactIntegralName, ContactName, FilmModelName, PiezoviscosityName, PlanName, PressureSource,
        SchemeName, ShapeKind, ShearThinningName, ViscosityLawName,
    };

    #[test]
    fn every_word_that_chooses_a_law_is_in_the_table() {
        let rough = "bearings.NAME.roughness.contact";
        let integral = format!("{rough}_integral");
        for (key, words) in [
            ("film.model", docs::words::<FilmModelName>()),
            ("film.cavitation", docs::words::<CavitationName>()),
            ("film.cavity_shear", docs::words::<CavityShearName>()),
            ("bearings.NAME.shapes[*].kind", docs::words::<ShapeKind>()),
            ("oil.viscosity_law", docs::words::<ViscosityLawName>()),
            ("oil.piezoviscosity", docs::words::<PiezoviscosityName>()),
            ("oil.compressibility", docs::words::<CompressibilityName>()),
            ("oil.shear_thinning", docs::words::<ShearThinningName>()),
            (rough, docs::words::<ContactName>()),
            (integral.as_str(), docs::words::<ContactIntegralName>()),
            ("cylinder_pressure.source", docs::words::<PressureSource>()),
            ("orbit.scheme", docs::words::<SchemeName>()),
            ("gradient.engine", docs::words::<EngineName>()),
            ("optimiser.method", docs::words::<Method>()),
            ("objective.aggregate", docs::words::<AggregateName>()),
            ("running_in.acceleration", docs::words::<AccelerationName>()),
            ("experiments.plan", docs::words::<PlanName>()),
        ] {
            assert!(words.len() > 1, "{key}");
            for (word, _) in words {
                let chosen = format!("{key} = \"{word}\"");
                assert!(laws().iter().any(|law| law.chosen_by == chosen), "{chosen}");
            }
        }
    }

    #[test]
    fn defaults_are_those_of_a_checked_study() {
        let values = study(&[]).to_json();
        let mut seen = 0;
        for entry in table() {
            let Choice::Key(key, value) = entry.chosen else { continue };
            let place = format!("/{}", key.replace("NAME", "bearing").replace('.', "/"));
            let Some(found) = values.pointer(&place) else { continue };
            seen += 1;
            assert_eq!(found == value, entry.default, "{key} = {value}, found {found}");
        }
        assert!(seen > 25, "{seen}");
    }

    #[test]
    fn sources_are_known_and_all_of_them_are_used() {
        for entry in table() {
            for key in entry.sources {
                assert!(sources::full(key).is_some(), "{}: {key}", entry.name);
            }
            assert!(!entry.topic.is_empty() && !entry.name.is_empty());
        }
        for (key, _) in sources::REFERENCES {
            assert!(table().any(|e| e.sources.contains(key)), "{key}");
        }
    }

    #[test]
    fn what_a_study_uses_is_part_of_the_table() {
        let (all, used) = (laws(), laws_in_use(&study(&[])));
        assert!(used.iter().all(|law| all.contains(law)));
        let names: Vec<&str> = used.iter().map(|law| law.name).collect();
        for name in [
            "Greenwood and Tripp",
            "mass-conserving rupture and reformation",
            "ISO VG 46",
            "ADJ, discrete adjoint",
        ] {
            assert!(names.contains(&name), "{name} in {names:?}");
        }
        assert!(!names.contains(&"Barus") && !names.contains(&"COBYLA"));
    }
}

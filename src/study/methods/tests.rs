//! Sentences are those that reports always had, and nothing is said that the catalogue does not know.

use super::*;
use crate::study::Format;
use crate::study::catalogue::example::study;
use crate::study::catalogue::laws;

/// Changes of the study with every parameter, each with a sentence it brings.
const CHANGES: &[(&str, &str, &str)] = &[
    (
        "[oil]",
        "[film]\ncavitation = \"swift-stieber\"\n[oil]",
        "Film: Reynolds (1886) equation by finite volumes; rupture after Swift (1932) and Stieber (1933); \
         shear all around, in the ruptured part too",
    ),
    (
        "[oil]",
        "[film]\ncavitation = \"guembel\"\n[oil]",
        "Film: Reynolds (1886) equation by finite volumes; tension left out after Guembel (1914); shear all \
         around, in the ruptured part too",
    ),
    (
        "[oil]",
        "[film]\ncavitation = \"none\"\n[oil]",
        "Film: Reynolds (1886) equation by finite volumes; no rupture (Sommerfeld 1904); shear all around, \
         in the ruptured part too",
    ),
    (
        "[oil]",
        "[oil]\nviscosity_law = \"vogel\"",
        "Oil: viscosity Vogel (1921), through the two points of ISO VG 46",
    ),
    (
        "grade = \"ISO VG 46\"",
        "dynamic_viscosity = \"20 mPa s\"",
        "Oil: viscosity the same at every temperature",
    ),
    (
        "grade = \"ISO VG 46\"",
        "viscosity_points = [{ temperature = \"40 degC\", dynamic_viscosity = \"40 mPa s\" }, { temperature \
         = \"70 degC\", dynamic_viscosity = \"13 mPa s\" }, { temperature = \"100 degC\", dynamic_viscosity \
         = \"6 mPa s\" }]",
        "Oil: viscosity Vogel (1921) through three points",
    ),
    ("[oil]", "[oil]\npiezoviscosity = \"barus\"", "Oil: viscosity over pressure after Barus (1893)"),
    ("[oil]", "[oil]\npiezoviscosity = \"roelands\"", "Oil: viscosity over pressure after Roelands (1966)"),
    (
        "[oil]",
        "[oil]\ncompressibility = \"dowson-higginson\"",
        "Oil: density over pressure after Dowson and Higginson (1966)",
    ),
    (
        "[oil]",
        "[oil]\nshear_thinning = \"cross\"\nsecond_newtonian_ratio = 0.5\ncritical_shear_rate = \"1e6 1/s\"\n\
         shear_exponent = 0.8",
        "Oil: viscosity over shear rate after Cross (1965)",
    ),
    (
        "[oil]",
        "[oil]\nshear_thinning = \"carreau\"\nsecond_newtonian_ratio = 0.5\nrelaxation_time = \"1 \
         us\"\nshear_exponent = 0.8",
        "Oil: viscosity over shear rate after Carreau (1972)",
    ),
    (
        "shell = \"0.5 um\"",
        "shell = \"0.5 um\", contact_integral = \"power-fit\"",
        "Contact: integral by the power fit of Hu, Cheng, Arai, Kobayashi and Aoyama (1994)",
    ),
    (
        "shell = \"0.5 um\"",
        "shell = \"0.5 um\", contact_integral = \"polynomial-fit\"",
        "Contact: integral by a polynomial fit",
    ),
    (
        "shell = \"0.5 um\"",
        "shell = \"0.5 um\", contact_integral = \"exponential-fit\"",
        "Contact: integral by an exponential fit",
    ),
    (
        "roughness = {",
        "heat_balance = {}\nroughness = {",
        "Heat: one film temperature per bearing from the balance over the cycle, by Broyden's method (1965)",
    ),
    (
        "kind = \"constant\"",
        "kind = \"constant\"\nfree_tilt = true",
        "Tilt: the journal tilts until the film's moment vanishes",
    ),
    (
        "minimise = \"mean-loss\"",
        "minimise = \"mean-loss\"\nacceleration = \"none\"",
        "Running-in: wear after Archard (1953), a settled cycle stands for many; blocks by Heun's method",
    ),
    (
        "[oil]",
        "[orbit]\nscheme = \"bdf1\"\n[oil]",
        "Orbit: backward differences (Gear 1971) with constant steps, closed periodically",
    ),
    (
        "[oil]",
        "[gradient]\nengine = \"CEN\"\n[oil]",
        "Gradient: discrete adjoint of the periodic orbit or its alternatives FW, BW, CEN, TRA",
    ),
];

const NARROW: &str = r#"
format = "stribeck-study/1"
title = "a narrow bearing"
[bearings.one]
kind = "constant"
force = "2 kN"
width = "20 mm"
diameter = "50 mm"
diametral_clearance = "60 um"
[film]
model = "mobility"
[oil]
grade = "ISO VG 46"
inlet_temperature = "50 degC"
[[objective.operating_points]]
name = "rated"
speed = "1000 rpm"
[[parameters]]
name = "one.width"
lower = "15 mm"
upper = "25 mm"
[optimiser]
method = "cobyla"
"#;

#[test]
fn sentences_of_a_study_with_everything() {
    let expected = [
        "Film: Reynolds (1886) equation by finite volumes; mass-conserving rupture and reformation after \
         Jakobsson and Floberg (1957) and Olsson (1965), as a complementarity problem after Giacopini et al. \
         (2010); in the ruptured part as much oil is sheared as there is",
        "Oil: viscosity Walther (1931), ASTM D341, through the two points of ISO VG 46",
        "Supply: openings at the supply pressure as smooth masks on the mesh",
        "Roughness: flow and shear factors of Patir and Cheng (1978, 1979), average gap after Wu and Zheng \
         (1989)",
        "Contact: Greenwood and Tripp (1971), elastic summits; constant boundary friction coefficient",
        "Shape: tensor product of cubic B-splines (de Boor 1972, Cox 1972; Piegl and Tiller 1997)",
        "Shape: measured surface, cubic Hermite polynomials between the points",
        "Orbit: backward differences (Gear 1971) with constant steps, closed periodically",
        "Gradient: discrete adjoint of the periodic orbit or its alternatives FW, BW, CEN, TRA",
        "Optimiser: sequential quadratic programming (Nocedal and Wright 2006), damped BFGS (Powell 1978), \
         sub-problem by Clarabel, framework argmin",
        "Smooth extrema: power norm, on the safe side of the exact extremum",
        "Running-in: wear after Archard (1953), a settled cycle stands for many; cycles predicted by proper \
         orthogonal decomposition (method of snapshots, Sirovich 1987) and checked",
    ];
    assert_eq!(methods(&study(&[])), expected);
}

/// Holds every sentence of a study against the catalogue.
fn assert_catalogued(study: &Study) {
    let known = laws();
    for sentence in sentences(study) {
        let text = sentence.text();
        for entry in &sentence.parts {
            assert!(!entry.words.is_empty() && text.contains(entry.words), "{}: {text}", entry.name);
            let found = known.iter().any(|law| law.name == entry.name && law.in_report == entry.words);
            assert!(found, "{}", entry.name);
        }
    }
    for entry in untold(study) {
        assert!(entry.words.is_empty(), "{} has a sentence", entry.name);
        assert!(known.iter().any(|law| law.name == entry.name), "{}", entry.name);
    }
}

#[test]
fn every_sentence_is_as_it_was_and_known_to_the_catalogue() {
    for (from, to, sentence) in CHANGES {
        let study = study(&[(*from, *to)]);
        assert!(methods(&study).iter().any(|s| s == sentence), "{sentence} in {:#?}", methods(&study));
        assert_catalogued(&study);
    }
    let narrow = Study::read(NARROW, Format::Toml, None).unwrap();
    assert_eq!(methods(&narrow)[0], "Film: short bearing, Ocvirk (1952), Booker's mobility method (1965)");
    assert_catalogued(&narrow);
    assert!(in_use(&narrow).iter().any(|e| e.name == "COBYLA"));
}

#[test]
fn references_are_full_and_stand_once() {
    let list = references(&study(&[]));
    assert!(list.len() > 15 && list[0].starts_with("O. Reynolds: On the theory of lubrication"), "{list:#?}");
    for (k, text) in list.iter().enumerate() {
        assert!(!list[..k].contains(text), "{text}");
    }
    for author in ["J. F. Archard", "H. S. Cheng", "L. Sirovich", "C. Walther"] {
        assert!(list.iter().any(|text| text.contains(author)), "{author}");
    }
}

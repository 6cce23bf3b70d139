//! Checks of rough surfaces and their contact.

use super::faults::{Faults, join, refuse_others};
use super::file::{ContactIntegralName, ContactName, RoughnessFile};
use super::machine::zero;
use super::plans::RoughnessPlan;
use crate::film::Roughness;
use crate::laws::{ContactIntegral, GreenwoodTripp, RoughSurfaces};
use crate::report::short;

/// Steel journal and aluminium-tin shell: Young's modulus in Pa, Poisson's ratio.
const USUAL_PAIR: [(f64, f64); 2] = [(210e9, 0.3), (70e9, 0.33)];
/// Where the tables of the flow factors begin.
const LEAST_PEKLENIK: f64 = 1.0 / 9.0 - 1e-10;
/// How far the mean planes may come together below zero gap, over the combined roughness.
const DEPTH: f64 = 1.5;

pub(super) fn roughness(file: &mut RoughnessFile, path: &str, faults: &mut Faults) -> Option<RoughnessPlan> {
    faults.unknown::<RoughnessFile>(&file.unknown, path);
    let (at, before) = (|key: &str| join(path, key), faults.count());
    let journal = faults.need(&file.journal, &at("journal")).map(|v| v.si());
    let shell = faults.need(&file.shell, &at("shell")).map(|v| v.si());
    let words = "between 0 um and 50 um";
    faults.range(journal, &at("journal"), |v| (0.0..=50e-6).contains(&v), words);
    faults.range(shell, &at("shell"), |v| (0.0..=50e-6).contains(&v), words);
    let lay = [
        faults.or(&mut file.journal_peklenik, &at("journal_peklenik"), 1.0),
        faults.or(&mut file.shell_peklenik, &at("shell_peklenik"), 1.0),
    ];
    for (lay, key) in lay.into_iter().zip(["journal_peklenik", "shell_peklenik"]) {
        faults.range(
            Some(lay),
            &at(key),
            |v| (LEAST_PEKLENIK..=9.0).contains(&v),
            "between 1/9 (0.1112) and 9",
        );
    }
    let contact = contact(file, path, faults);
    let (journal_m, shell_m) = (journal?, shell?);
    if journal_m == 0.0 && shell_m == 0.0 {
        faults.add(path, "needs a roughness above zero; leave the section out for smooth surfaces");
        return None;
    }
    if faults.count() > before {
        return None;
    }
    let surfaces = RoughSurfaces::new(lay[0], lay[1], journal_m, shell_m);
    let surfaces = surfaces.map_err(|e| faults.add(path, e.to_string())).ok()?;
    let (contact, boundary_friction, wear_m3_per_j) = contact?;
    let depth_m = DEPTH * journal_m.hypot(shell_m);
    Some(RoughnessPlan {
        journal_m,
        shell_m,
        wear_m3_per_j,
        film: Roughness { surfaces, contact, boundary_friction, depth_m },
    })
}

/// Contact law, its friction coefficient, and the volume worn off per work of friction, m3/J.
fn contact(
    file: &mut RoughnessFile,
    path: &str,
    faults: &mut Faults,
) -> Option<(Option<GreenwoodTripp>, f64, f64)> {
    let at = |key: &str| join(path, key);
    if faults.or(&mut file.contact, &at("contact"), ContactName::GreenwoodTripp) == ContactName::None {
        refuse_others!(
            faults,
            file,
            path,
            "contact is \"none\"",
            [],
            [
                contact_integral,
                elastic_factor,
                asperity_product,
                sigma_over_beta,
                modulus,
                summit_sigma_ratio,
                summit_height_ratio,
                wear_coefficient,
                boundary_friction,
            ]
        );
        return Some((None, 0.0, 0.0));
    }
    let name = faults.or(&mut file.contact_integral, &at("contact_integral"), ContactIntegralName::Exact);
    let integral = match name {
        ContactIntegralName::Exact => ContactIntegral::Exact,
        ContactIntegralName::PowerFit => ContactIntegral::PowerFit,
        ContactIntegralName::PolynomialFit => ContactIntegral::PolynomialFit,
        ContactIntegralName::ExponentialFit => ContactIntegral::ExponentialFit,
    };
    let usual = format!("{} GPa", short(GreenwoodTripp::composite_modulus_pa(USUAL_PAIR) * 1e-9));
    let modulus = faults.or(&mut file.modulus, &at("modulus"), zero(&usual)).si();
    let spread = faults.or(&mut file.summit_sigma_ratio, &at("summit_sigma_ratio"), 1.0);
    let height = faults.or(&mut file.summit_height_ratio, &at("summit_height_ratio"), 0.0);
    let friction = faults.or(&mut file.boundary_friction, &at("boundary_friction"), 0.08);
    faults.range(Some(modulus), &at("modulus"), |v| (1e8..=1e12).contains(&v), "between 0.1 and 1000 GPa");
    faults.range(Some(spread), &at("summit_sigma_ratio"), |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
    faults.range(Some(height), &at("summit_height_ratio"), |v| (-3.0..=3.0).contains(&v), "between -3 and 3");
    faults.range(Some(friction), &at("boundary_friction"), |v| (0.0..=1.0).contains(&v), "between 0 and 1");
    let wear = faults.or(&mut file.wear_coefficient, &at("wear_coefficient"), zero("1e-8 mm3/(N m)")).si();
    let words = "between 0 and 1e-3 mm3/(N m)";
    faults.range(Some(wear), &at("wear_coefficient"), |v| (0.0..=1e-12).contains(&v), words);
    let law = summits(file, path, integral, modulus, faults)?;
    let law = GreenwoodTripp { summit_sigma_ratio: spread, summit_height_ratio: height, ..law };
    // Wear goes with the work of friction; without friction it is not known.
    let per_work = if friction > 0.0 { wear / friction } else { 0.0 };
    Some((Some(law), friction, per_work))
}

/// The elastic factor as given, or from the shape of the summits.
fn summits(
    file: &mut RoughnessFile,
    path: &str,
    integral: ContactIntegral,
    modulus_pa: f64,
    faults: &mut Faults,
) -> Option<GreenwoodTripp> {
    let at = |key: &str| join(path, key);
    let usual = GreenwoodTripp::from_summits(integral, modulus_pa, 0.04, 1e-3).ok()?;
    if !file.elastic_factor.is_absent() {
        refuse_others!(
            faults,
            file,
            path,
            "elastic_factor is given",
            [],
            [asperity_product, sigma_over_beta]
        );
        let factor = faults.get(&file.elastic_factor, &at("elastic_factor"));
        faults.range(factor, &at("elastic_factor"), |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
        return Some(GreenwoodTripp { elastic_factor: factor?, ..usual });
    }
    let product = faults.or(&mut file.asperity_product, &at("asperity_product"), 0.04);
    let ratio = faults.or(&mut file.sigma_over_beta, &at("sigma_over_beta"), 1e-3);
    faults.range(Some(product), &at("asperity_product"), |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
    faults.range(Some(ratio), &at("sigma_over_beta"), |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
    GreenwoodTripp::from_summits(integral, modulus_pa, product, ratio).ok()
}

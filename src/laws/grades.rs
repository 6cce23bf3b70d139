//! Typical oils by the name of their viscosity grade.
//!
//! The rows are typical of mineral monograde engine oils (SAE J300 classes, viscosity index about 100) and of mineral
//! circulating and hydraulic oils (midpoint viscosities of ISO 3448, viscosity index 95 to 115). They stand for no
//! product: with a data sheet at hand, take the data sheet. The ISO VG 32, 46 and 68 rows follow the lubricant table of
//! the open rotordynamics program ross.
//!
//! Deliberately not here: multigrade oils (they need shear thinning), prices, additives.

use super::{OilDataError, Viscosity};

/// What a data sheet says of an oil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grade {
    /// Name as printed on the drum.
    pub name: &'static str,
    /// Kinematic viscosity at 40 degC.
    pub kinematic_viscosity_40c_mm2_s: f64,
    /// Kinematic viscosity at 100 degC.
    pub kinematic_viscosity_100c_mm2_s: f64,
    /// Density at 15 degC.
    pub density_15c_kg_m3: f64,
    /// Specific heat capacity at film temperature.
    pub heat_capacity_j_kg_k: f64,
    /// Pressure-viscosity coefficient at film temperature; mineral oils lie between 1.2e-8 and 2.2e-8 1/Pa.
    pub pressure_viscosity_per_pa: f64,
}

/// The grades known by name, thin to thick within each family.
pub const GRADES: [Grade; 6] = [
    row("SAE 30", [104.0, 11.8, 893.0, 2000.0, 1.9e-8]),
    row("SAE 40", [139.0, 14.0, 895.0, 2000.0, 2.0e-8]),
    row("ISO VG 32", [32.0, 5.4, 874.0, 1949.0, 1.7e-8]),
    row("ISO VG 46", [46.0, 7.0, 863.0, 1950.0, 1.8e-8]),
    row("ISO VG 68", [68.0, 8.8, 867.0, 1951.0, 1.9e-8]),
    row("ISO VG 100", [100.0, 11.2, 885.0, 1950.0, 2.0e-8]),
];

const fn row(
    name: &'static str,
    [nu_40, nu_100, density, heat_capacity, pressure_viscosity]: [f64; 5],
) -> Grade {
    Grade {
        name,
        kinematic_viscosity_40c_mm2_s: nu_40,
        kinematic_viscosity_100c_mm2_s: nu_100,
        density_15c_kg_m3: density,
        heat_capacity_j_kg_k: heat_capacity,
        pressure_viscosity_per_pa: pressure_viscosity,
    }
}

impl Grade {
    /// The grade of this name; case, spaces and hyphens do not count.
    pub fn named(name: &str) -> Option<&'static Self> {
        static TABLE: [Grade; GRADES.len()] = GRADES;
        let plain = |name: &str| -> String {
            name.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).map(|c| c.to_ascii_lowercase()).collect()
        };
        let wanted = plain(name);
        TABLE.iter().find(|grade| plain(grade.name) == wanted)
    }

    /// Walther's law through the two viscosities.
    pub fn viscosity(&self) -> Result<Viscosity, OilDataError> {
        Viscosity::from_data_sheet(
            self.kinematic_viscosity_40c_mm2_s,
            self.kinematic_viscosity_100c_mm2_s,
            self.density_15c_kg_m3,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grade_answers_to_its_name_and_is_an_oil() {
        for grade in &GRADES {
            assert_eq!(Grade::named(grade.name), Some(grade));
            let law = grade.viscosity().unwrap();
            let (warm, hot) = (law.at(313.15).0, law.at(373.15).0);
            assert!(warm > hot && hot > 0.003, "{}", grade.name);
        }
        assert_eq!(Grade::named("sae-40").unwrap().name, "SAE 40");
        assert_eq!(Grade::named("iso-vg-46").unwrap().name, "ISO VG 46");
        assert_eq!(Grade::named("Iso VG_100").unwrap().name, "ISO VG 100");
        assert_eq!(Grade::named("SAE 10W-40"), None);
    }

    #[test]
    fn iso_rows_agree_with_the_table_of_ross() {
        // Dynamic viscosities at 40 and 100 degC over one density; its "VG 68" is 3.3 % thinner than the grade's midpoint.
        for (name, eta_40, eta_100, rho, tolerance) in [
            ("ISO VG 32", 0.0279678922948, 0.00466713685563, 873.996, 0.015),
            ("ISO VG 46", 0.03969339831222, 0.006074815741696, 862.9, 0.01),
            ("ISO VG 68", 0.0570722, 0.00766498, 867.0, 0.035),
        ] {
            let grade = Grade::named(name).unwrap();
            for (nu, eta) in [
                (grade.kinematic_viscosity_40c_mm2_s, eta_40),
                (grade.kinematic_viscosity_100c_mm2_s, eta_100),
            ] {
                assert!((nu * 1e-6 * rho / eta - 1.0f64).abs() < tolerance, "{name}: {nu}");
            }
            assert!((grade.density_15c_kg_m3 / rho - 1.0f64).abs() < 1e-3);
        }
    }

    #[test]
    fn rows_lie_in_their_classes() {
        for (name, low, high) in [("SAE 30", 9.3, 12.5), ("SAE 40", 12.5, 16.3)] {
            let nu = Grade::named(name).unwrap().kinematic_viscosity_100c_mm2_s;
            assert!(low <= nu && nu < high, "{name}");
        }
        for midpoint in [32.0, 46.0, 68.0, 100.0] {
            let nu = Grade::named(&format!("ISO VG {midpoint}")).unwrap().kinematic_viscosity_40c_mm2_s;
            assert!((nu / midpoint - 1.0f64).abs() < 0.1);
        }
    }
}

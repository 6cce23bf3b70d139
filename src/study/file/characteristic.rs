//! What is tabulated instead of optimised, as written.

use crate::study::Given;
use crate::study::table::TableFile;
use crate::units::Rotation;

words! {
    /// What a characteristic runs over.
    VaryName {
        /// The journal stands at given eccentricity ratios along 0 deg; the classical dimensionless tables.
        EccentricityRatio,
        /// The shaft turns at given speeds under a constant load: torque over speed, the Stribeck curve.
        Speed,
    }
}

section! {
    /// A table of what the bearings do over a varied quantity, instead of a search for a design.
    CharacteristicFile {
        /// "eccentricity-ratio" or "speed".
        vary: VaryName,
        /// Eccentricity ratios, above 0 and below 1. For vary = "eccentricity-ratio".
        eccentricity_ratios: Vec<f64>,
        /// Speed of the journal. For vary = "eccentricity-ratio".
        speed: Rotation,
        /// Hold the pressure of the surroundings along the widest gap, as many classical tables do. Default false. For vary = "eccentricity-ratio".
        ambient_at_widest_gap: bool,
        /// Speeds of the shaft. For vary = "speed".
        speeds: Vec<Given<Rotation>>,
        /// Published values to compare with: the varied column ("eccentricity_ratio" or "speed_rpm") and any of the table's columns; rows may be missing. For one bearing, or for the shaft.
        reference: TableFile,
        /// Where the reference is from.
        reference_source: String,
    }
}

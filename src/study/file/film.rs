//! Film and orbit as written.

use crate::units::{Information, Pressure};

words! {
    /// Film model, in order of fidelity.
    FilmModelName {
        /// Booker's short-bearing film in closed form: instant, good for narrow bearings.
        Mobility,
        /// Reynolds' equation on a mesh.
        Reynolds,
    }
}

words! {
    /// What a film does that would pull.
    CavitationName {
        /// It ruptures, and the oil in the cavity is kept account of (Jakobsson, Floberg, Olsson). Needs oil: a supply or a side pressure.
        MassConserving,
        /// It ruptures at the cavitation pressure.
        SwiftStieber,
        /// Tension is computed and then left out of the force (half-Sommerfeld); for comparison.
        Guembel,
        /// It holds any tension; for comparison with closed forms. Many loads have no stable orbit in such a film.
        None,
    }
}

words! {
    /// How much oil is sheared in the cavity.
    CavityShearName {
        /// As much as there is: the shear stress scales with the fill. Only a mass-conserving film knows the fill.
        Fill,
        /// The whole gap, as in the classical friction tables: on the safe side.
        Full,
    }
}

section! {
    /// Lubricating film.
    FilmFile {
        /// "reynolds" (default) or "mobility".
        model: FilmModelName,
        /// "mass-conserving" (default), "swift-stieber", "guembel" or "none". For model = "reynolds", like all below.
        cavitation: CavitationName,
        /// "fill" (default of a mass-conserving film) or "full" (default of all others).
        cavity_shear: CavityShearName,
        /// Cells around the circumference, at least 16. Default 72.
        cells_around: usize,
        /// Cells across half of the width; a bearing that is not symmetric about its mid-plane gets twice as many. Default 8.
        cells_across_half: usize,
        /// Pressure at both edges above the surroundings. Default "0 bar".
        side_pressure: Pressure,
        /// Cavitation pressure above the surroundings, at or below the side pressure. Default "0 bar".
        cavitation_pressure: Pressure,
    }
}

words! {
    /// Difference formula of the time steps.
    SchemeName {
        /// Implicit Euler, first order.
        Bdf1,
        /// Second order.
        Bdf2,
    }
}

section! {
    /// Periodic orbit of the journal.
    OrbitFile {
        /// Steps per cycle, at least 36. Default 720.
        steps_per_cycle: usize,
        /// "bdf2" (default) or "bdf1".
        scheme: SchemeName,
        /// Difference of two cycles (relative to the clearance) that counts as settled. Default 1e-12.
        periodicity_tolerance: f64,
        /// Cycles after which settling is given up. Default 30.
        max_cycles: usize,
        /// Memory for the recording of one cycle under way (of one bearing at one operating point). Default "1 GB". With room for the factors of every step, gradients factorise each step once and slow settling is accelerated; with less, steps are factorised again; with still less, only checkpoints are kept and steps are solved again. The results are the same.
        memory: Information,
    }
}

//! What the film does where it would pull: one signed unknown per cell carries pressure or void.
//!
//! ```text
//! q >= 0:  p = p_cav + q, the cell is full
//! q <  0:  p = p_cav;  mass conserving: fill = 1 + q / VOID_SCALE;  Swift-Stieber: -q is the slack of the balance
//! ```
//!
//! So `p - p_cav >= 0`, `1 - fill >= 0` and their product is zero by construction (Jakobsson and Floberg 1957, Olsson
//! 1965; complementarity after Giacopini et al. 2010), and Newton's method on the piecewise smooth balance is an active
//! set method. Swift-Stieber adds `slack q` for `q < 0` to a balance without void: the form of Brugnano and Casulli
//! (2008), whose Newton iteration is monotone and finite.

/// What the film does where it would pull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cavitation {
    /// It ruptures and the oil in the cavity is kept account of (Jakobsson, Floberg, Olsson).
    MassConserving,
    /// It ruptures: the pressure does not fall below the cavitation pressure (Swift 1932, Stieber 1933).
    SwiftStieber,
    /// Tension is computed and then left out of the force (Guembel's half-Sommerfeld film); for comparison only.
    Guembel,
    /// It holds any tension (Sommerfeld's full film); for comparison with closed forms.
    None,
}

/// How much oil is sheared in the cavity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CavityShear {
    /// As much as there is: the shear stress scales with the fill.
    Fill,
    /// The whole gap, as in the classical friction tables.
    Full,
}

/// Void of size one in units of the unknown, Pa.
pub(super) const VOID_SCALE: f64 = 1e7;

/// Void of a cell that has just ruptured, in units of the unknown: less than rounding leaves of a fill.
const JUST_VOID_PA: f64 = 1e-9;

/// A cell that would pass from full to void, or back, stops at the other side of the switch: the slope it was moved with
/// ends there.
pub fn up_to_the_switch(from: f64, to: f64) -> f64 {
    if from < 0.0 && to > 0.0 {
        0.0
    } else if from > 0.0 && to < 0.0 {
        -JUST_VOID_PA
    } else {
        to
    }
}

/// Pressure above cavitation pressure and fill of a cell, with their derivatives by the unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct Split {
    pub p: f64,
    pub fill: f64,
    pub p_slope: f64,
    pub fill_slope: f64,
}

impl Cavitation {
    /// What an unknown stands for.
    pub(super) fn split(self, q: f64) -> Split {
        let full = Split { p: q, fill: 1.0, p_slope: 1.0, fill_slope: 0.0 };
        let void = Split { p: 0.0, fill: 1.0, p_slope: 0.0, fill_slope: 0.0 };
        match self {
            Self::None | Self::Guembel => full,
            _ if q >= 0.0 => full,
            Self::SwiftStieber => void,
            Self::MassConserving => {
                Split { fill: 1.0 + q / VOID_SCALE, fill_slope: 1.0 / VOID_SCALE, ..void }
            }
        }
    }

    /// Pressure that loads the journal, and its derivative by the unknown.
    pub(super) fn load(self, q: f64) -> (f64, f64) {
        match self {
            Self::None => (q, 1.0),
            _ if q >= 0.0 => (q, 1.0),
            _ => (0.0, 0.0),
        }
    }
}

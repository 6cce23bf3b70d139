//! Shapes of shell and journal: what each adds to the gap.
//!
//! Deliberately not here: which surface they belong to.

use super::entry::{Choice, Entry};

/// What all shapes share; `x` is the angle from the shape's own, `zeta` runs from -1 to 1 across.
const SHAPE: Entry = Entry { topic: "shape", ..Entry::PLAIN };

const fn kind(word: &'static str) -> Choice {
    Choice::Key("bearings.NAME.shapes[*].kind", word)
}

/// Lemon bore.
pub(in crate::study) static LEMON: Entry = Entry {
    name: "lemon bore",
    equation: "offset (1 - |cos x|)",
    chosen: kind("lemon"),
    remark: "x from the middle of a half; soft at the split lines",
    ..SHAPE
};

/// Offset halves.
pub(in crate::study) static OFFSET: Entry = Entry {
    name: "offset halves",
    equation: "offset (1 + sign(sin x) cos x)",
    chosen: kind("offset"),
    remark: "x from a split line; soft there",
    ..SHAPE
};

/// Crown.
pub(in crate::study) static BARREL: Entry =
    Entry { name: "barrel", equation: "height zeta^2", chosen: kind("barrel"), ..SHAPE };

/// Taper.
pub(in crate::study) static CONE: Entry =
    Entry { name: "cone", equation: "height (1 + zeta)/2", chosen: kind("cone"), ..SHAPE };

/// Relief of the edges.
pub(in crate::study) static EDGE_RELIEF: Entry = Entry {
    name: "edge relief",
    equation: "depth ((|zeta| - 1 + length)/length)^2 where |zeta| > 1 - length",
    chosen: kind("edge-relief"),
    remark: "length as a share of half the width",
    ..SHAPE
};

/// Free form.
pub(in crate::study) static SPLINE: Entry = Entry {
    name: "free form of cubic B-splines",
    equation: "sum_ik c_ik N_i(phi) N_k(zeta)",
    words: "tensor product of cubic B-splines (de Boor 1972, Cox 1972; Piegl and Tiller 1997)",
    sources: &["de Boor 1972", "Cox 1972", "Piegl and Tiller 1997"],
    chosen: kind("spline"),
    remark: "periodic around, clamped across; the surface lies within the range of its coefficients",
    ..SHAPE
};

/// Measured surface.
pub(in crate::study) static MEASURED: Entry = Entry {
    name: "measured surface",
    equation: "scale g(phi, zeta), cubic Hermite with the slopes of parabolas through three neighbours",
    words: "measured surface, cubic Hermite polynomials between the points",
    chosen: kind("table"),
    remark: "passes through every height; next to a sharp step it may swing over by a tenth of the step",
    ..SHAPE
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[&LEMON, &OFFSET, &BARREL, &CONE, &EDGE_RELIEF, &SPLINE, &MEASURED];

//! Methods of the cycle: periodic orbit, gradients, smooth extrema.
//!
//! Deliberately not here: what engines cost and when to choose them, which is a list of its own.

use super::entry::{Choice, Entry};

const ORBIT: &str = "orbit";
const GRADIENT: &str = "gradient";
/// What a report says, whatever the difference formula.
const STEPS: &str = "backward differences (Gear 1971) with constant steps, closed periodically";
/// What a report says, whatever the engine.
const ENGINES: &str = "discrete adjoint of the periodic orbit or its alternatives FW, BW, CEN, TRA";

const fn engine(name: &'static str) -> Choice {
    Choice::Key("gradient.engine", name)
}

/// Second order.
pub(in crate::study) static BDF2: Entry = Entry {
    topic: ORBIT,
    name: "BDF2",
    equation: "F(t_n, z_n, m'_n; p) = 0, m'_n = (3/2 m_n - 2 m_{n-1} + 1/2 m_{n-2})/dt, indices modulo N",
    words: STEPS,
    sources: &["Gear 1971"],
    chosen: Choice::Key("orbit.scheme", "bdf2"),
    default: true,
    remark: "second order, stiffly stable; marched until the cycle repeats",
};

/// First order.
pub(in crate::study) static BDF1: Entry = Entry {
    topic: ORBIT,
    name: "BDF1",
    equation: "F(t_n, z_n, m'_n; p) = 0, m'_n = (m_n - m_{n-1})/dt, indices modulo N",
    words: STEPS,
    sources: &["Gear 1971"],
    chosen: Choice::Key("orbit.scheme", "bdf1"),
    remark: "implicit Euler, first order",
    ..Entry::PLAIN
};

/// Corrections of slow cycles.
pub(in crate::study) static PERIOD_MAP: Entry = Entry {
    topic: ORBIT,
    name: "Newton's method on the period map",
    equation: "x* = x + d, (I - G') d = G(x) - x by GMRES",
    sources: &["Saad and Schultz 1986"],
    remark: "only where marching alone would settle slowly and the factors of a cycle fit orbit.memory; \
             never the result",
    ..Entry::PLAIN
};

/// Adjoint.
pub(in crate::study) static ADJ: Entry = Entry {
    topic: GRADIENT,
    name: "ADJ, discrete adjoint",
    equation: "(F_z + a_0/dt F_m' M_z)^T l_n = -w_n (g_z + a_0/dt M_z^T g_m') - M_z^T (a_1 c_{n+1} + a_2 \
               c_{n+2})/dt",
    words: ENGINES,
    chosen: engine("ADJ"),
    default: true,
    remark: "exact for the discrete periodic model; the gradient of the current piece where the edge of the \
             cavity moves",
    ..Entry::PLAIN
};

/// Tangent.
pub(in crate::study) static TRA: Entry = Entry {
    topic: GRADIENT,
    name: "TRA, transient approach",
    equation: "(F_z + a_0/dt F_m' M_z) s_n = -F_p - F_m' (a_0 M_p + a_1 d_{n-1} + a_2 d_{n-2})/dt, d = M_z s \
               + M_p",
    words: ENGINES,
    chosen: engine("TRA"),
    remark: "exact for the discrete periodic model",
    ..Entry::PLAIN
};

/// Central differences.
pub(in crate::study) static CEN: Entry = Entry {
    topic: GRADIENT,
    name: "CEN, central differences",
    equation: "(Q(p + h) - Q(p - h))/2h, h = eps_p |p|",
    words: ENGINES,
    chosen: engine("CEN"),
    remark: "of settled cycles, each continued from the one at p; gradient.perturbation",
    ..Entry::PLAIN
};

/// Forward differences.
pub(in crate::study) static FW: Entry = Entry {
    topic: GRADIENT,
    name: "FW, forward differences",
    equation: "(Q(p + h) - Q(p))/h, h = eps_p |p|",
    words: ENGINES,
    chosen: engine("FW"),
    remark: "the same; one-sided",
    ..Entry::PLAIN
};

/// Backward differences.
pub(in crate::study) static BW: Entry = Entry {
    topic: GRADIENT,
    name: "BW, backward differences",
    equation: "(Q(p) - Q(p - h))/h, h = eps_p |p|",
    words: ENGINES,
    chosen: engine("BW"),
    remark: "the same; one-sided",
    ..Entry::PLAIN
};

/// Smooth extrema.
pub(in crate::study) static EXTREMA: Entry = Entry {
    topic: "smooth extrema",
    name: "power norm",
    equation: "max(g) = (sum g_i^k)^(1/k), min(g) = (sum g_i^-k)^(-1/k)",
    words: "power norm, on the safe side of the exact extremum",
    remark: "errs by at most ln(m)/k where m values lie close to the extremum; k is \
             optimiser.aggregate_sharpness",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[&BDF2, &BDF1, &PERIOD_MAP, &ADJ, &TRA, &CEN, &FW, &BW, &EXTREMA];

//! Running-in: the law of wear and the march through a programme.
//!
//! Deliberately not here: how a running-in design is searched, which is done as for any other.

use super::entry::{Choice, Entry};

const WEAR: &str = "wear";
const RUNNING_IN: &str = "running-in";

/// Archard.
pub(in crate::study) static ARCHARD: Entry = Entry {
    topic: WEAR,
    name: "Archard's wear in a running-in",
    equation: "dw/dt = K/H share r(w), r = 1/T Int p_contact |U| dt over a working cycle",
    words: "wear after Archard (1953), a settled cycle stands for many",
    sources: &["Archard 1953"],
    chosen: Choice::Given("[running_in]"),
    remark: "mild wear: surfaces stand still within a cycle; K/H is roughness.wear_coefficient, also of the \
             quantity wear-rate",
    ..Entry::PLAIN
};

/// Smoothing by wear.
pub(in crate::study) static SMOOTHING: Entry = Entry {
    topic: WEAR,
    name: "smoothing by wear",
    equation: "roughness left = left + (1 - left) exp(-w/depth)",
    chosen: Choice::Given("running_in.roughness_left"),
    remark: "of the shell; 1 leaves the roughness as it is",
    ..Entry::PLAIN
};

/// Heun.
pub(in crate::study) static HEUN: Entry = Entry {
    topic: RUNNING_IN,
    name: "blocks by Heun's method",
    equation: "k1 = f(w), k2 = f(w + h k1), w+ = w + h (k1 + k2)/2, error = h/2 max|k2 - k1|",
    words: "blocks by Heun's method",
    sources: &["Heun 1900"],
    chosen: Choice::Key("running_in.acceleration", "none"),
    remark: "every cycle is computed; a search for a running-in design always does so",
    ..Entry::PLAIN
};

/// Proper orthogonal decomposition.
pub(in crate::study) static POD: Entry = Entry {
    topic: RUNNING_IN,
    name: "cycles predicted from earlier ones",
    equation: "f(w) = f_0 + sum_j c_j (f_j - f_0), c = V_r S_r^-1 Psi^T (w - w_0), X^T X = V S^2 V^T",
    words: "cycles predicted by proper orthogonal decomposition (method of snapshots, Sirovich 1987) and \
            checked",
    sources: &["Sirovich 1987"],
    chosen: Choice::Key("running_in.acceleration", "pod"),
    default: true,
    remark: "one solved cycle per window checks the prediction",
};

/// Approximation of the march.
pub(in crate::study) static P_ALPHA: Entry = Entry {
    topic: RUNNING_IN,
    name: "P_alpha, few groups of blocks",
    equation: "P_alpha = sum_g alpha_g (P(w_g) + P(w_g + h_g k_g)), alpha_g = h_g/2T",
    chosen: Choice::Given("running_in.approximate_first = true"),
    remark: "begins a search; its error against the march is reported",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[&ARCHARD, &SMOOTHING, &HEUN, &POD, &P_ALPHA];

//! How a design is searched: objective, methods, starts, margins.
//!
//! Deliberately not here: when to choose which method, which is a list of its own.

use super::entry::{Choice, Entry};

const OPTIMISER: &str = "optimiser";

const fn method(name: &'static str) -> Choice {
    Choice::Key("optimiser.method", name)
}

/// Weighted mean.
pub(in crate::study) static WEIGHTED_MEAN: Entry = Entry {
    topic: OPTIMISER,
    name: "weighted mean over the operating points",
    equation: "minimise sum w_i f_i(x), sum w_i = 1",
    chosen: Choice::Key("objective.aggregate", "weighted-mean"),
    default: true,
    ..Entry::PLAIN
};

/// Worst case.
pub(in crate::study) static WORST_CASE: Entry = Entry {
    topic: OPTIMISER,
    name: "worst case over the operating points",
    equation: "minimise t subject to f_i(x)/F - t <= 0",
    chosen: Choice::Key("objective.aggregate", "worst-case"),
    ..Entry::PLAIN
};

/// Sequential quadratic programming.
pub(in crate::study) static SQP: Entry = Entry {
    topic: OPTIMISER,
    name: "sequential quadratic programming",
    equation: "minimise 1/2 d'B d + f'd subject to c + C d <= 0, g + G d = 0, A d <= b, lower <= d <= upper",
    words: "sequential quadratic programming (Nocedal and Wright 2006), damped BFGS (Powell 1978), \
            sub-problem by Clarabel, framework argmin",
    sources: &["Nocedal and Wright 2006", "Powell 1978", "Goulart and Chen 2024"],
    chosen: method("sqp"),
    default: true,
    remark: "l1 merit function, second-order correction",
};

/// Kinks.
pub(in crate::study) static KINKS: Entry = Entry {
    topic: OPTIMISER,
    name: "several gradients at a kink",
    equation: "minimise t + d'B d/2 subject to g_i d <= t for all gradients met within the tolerance",
    sources: &["Goldstein 1977", "Clarke 1983"],
    chosen: method("sqp"),
    default: true,
    remark: "only where no single gradient vanishes",
    ..Entry::PLAIN
};

/// Augmented Lagrangian.
pub(in crate::study) static AUGMENTED_LAGRANGIAN: Entry = Entry {
    topic: OPTIMISER,
    name: "augmented Lagrangian with L-BFGS on the box",
    equation: "minimise f + sum (max(0, l + r c)^2 - l^2)/(2 r) + sum (m g + r g^2/2)",
    words: "augmented Lagrangian (Hestenes 1969, Powell 1969) with L-BFGS on the box",
    sources: &["Hestenes 1969", "Powell 1969", "Nocedal and Wright 2006"],
    chosen: method("augmented-lagrangian"),
    ..Entry::PLAIN
};

/// COBYLA.
pub(in crate::study) static COBYLA: Entry = Entry {
    topic: OPTIMISER,
    name: "COBYLA",
    equation: "linear models from values at the corners of a simplex",
    words: "COBYLA (Powell 1994), linear models without gradients",
    sources: &["Powell 1994"],
    chosen: method("cobyla"),
    remark: "no gradients: for objectives with noise",
    ..Entry::PLAIN
};

/// Starts.
pub(in crate::study) static STARTS: Entry = Entry {
    topic: OPTIMISER,
    name: "starts from a Latin hypercube",
    sources: &["McKay et al. 1979"],
    chosen: Choice::Given("optimiser.starts"),
    ..Entry::PLAIN
};

/// Polish.
pub(in crate::study) static POLISH: Entry = Entry {
    topic: OPTIMISER,
    name: "polish by Newton's method",
    equation: "H d = (g(p + e d) - g(p - e d))/2e, g the adjoint gradient",
    sources: &["Nocedal and Wright 2006"],
    chosen: Choice::Given("optimiser.polish = true"),
    remark: "kept only if the KKT residual falls",
    ..Entry::PLAIN
};

/// Margins.
pub(in crate::study) static MARGINS: Entry = Entry {
    topic: OPTIMISER,
    name: "margins for what scatters",
    equation: "minimise f + k s_f subject to c + k s_c <= 0, s_q^2 = sum_j (dq/du_j)^2 sigma_j^2",
    chosen: Choice::Given("[robust]"),
    remark: "first order, checked by drawing bearings",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] =
    &[&WEIGHTED_MEAN, &WORST_CASE, &SQP, &KINKS, &AUGMENTED_LAGRANGIAN, &COBYLA, &STARTS, &POLISH, &MARGINS];

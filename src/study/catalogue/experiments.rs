//! How experiments are laid out, and what is made of their rows.
//!
//! Deliberately not here: factors and levels, which each study has of its own.

use super::entry::{Choice, Entry};

const EXPERIMENTS: &str = "experiments";

const fn plan(word: &'static str) -> Choice {
    Choice::Key("experiments.plan", word)
}

/// Every combination.
pub(in crate::study) static GRID: Entry = Entry {
    topic: EXPERIMENTS,
    name: "grid",
    equation: "every combination of the levels",
    chosen: plan("grid"),
    default: true,
    remark: "with a factor that refines: order p = ln((y1 - y2)/(y2 - y3))/ln r, without discretisation \
             y0 = y3 + (y3 - y2)/(r^p - 1)",
    ..Entry::PLAIN
};

/// Latin hypercube.
pub(in crate::study) static LATIN_HYPERCUBE: Entry = Entry {
    topic: EXPERIMENTS,
    name: "Latin hypercube",
    equation: "of as many equal slices of every factor as there are runs, each holds one point",
    sources: &["McKay et al. 1979"],
    chosen: plan("latin-hypercube"),
    ..Entry::PLAIN
};

/// Sobol's sequence.
pub(in crate::study) static SOBOL: Entry = Entry {
    topic: EXPERIMENTS,
    name: "Sobol's sequence, scrambled",
    equation: "every dyadic interval of every factor holds its share of the points",
    sources: &["Sobol 1967", "Owen 1995", "Burley 2020"],
    chosen: plan("sobol"),
    remark: "the first of more points are the same",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[&GRID, &LATIN_HYPERCUBE, &SOBOL];

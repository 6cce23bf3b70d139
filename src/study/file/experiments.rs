//! What a study says about itself: its coarse setting, the figures it must reproduce, and experiments with its keys, as written.

use super::OptionFile;
use crate::study::Given;
use serde_json::Value;

section! {
    /// A figure of the report that the study must reproduce.
    ExpectedFile {
        /// What the report must say there: a number, a text or a truth value.
        value: Value,
        /// The same with the coarse setting. Default: the value.
        coarse: Value,
        /// How far a number may be away, as a share of the value. Default 0.01, unless absolute is given.
        relative: f64,
        /// How far a number may be away, in its unit. Default: relative counts.
        absolute: f64,
    }
}

words! {
    /// How the experiments are laid out.
    PlanName {
        /// Every combination of the levels.
        Grid,
        /// A Latin hypercube: every factor takes each of as many equal slices as there are runs once.
        LatinHypercube,
        /// Sobol's sequence with Owen's scrambling: evenly spread however many runs there are.
        Sobol,
    }
}

words! {
    /// What is done with every study.
    EachName {
        /// Its start design is simulated.
        Simulate,
        /// A design is searched.
        Search,
    }
}

words! {
    /// How levels lie between two bounds.
    SpacingName {
        /// At equal distances.
        Linear,
        /// At equal ratios.
        Logarithmic,
    }
}

section! {
    /// Something that is varied: one key by values or between bounds, or several keys together by options.
    FactorFile {
        /// The key by its path, like "bearings.big_end.width" or "film.cells_around".
        key: String,
        /// Name in reports. Default: the key.
        name: String,
        /// The values, as the study would write them: ["60 mm", "65 mm"].
        values: Vec<Value>,
        /// Lower bound, like "60 mm". With upper instead of values.
        lower: Value,
        /// Upper bound, in the unit of the lower one.
        upper: Value,
        /// Levels from lower to upper in a grid.
        levels: usize,
        /// How levels lie between the bounds: "linear" (default) or "logarithmic".
        spacing: SpacingName,
        /// Several keys together, instead of key and values: options with a name and what they set.
        options: Vec<Given<OptionFile>>,
        /// Whether every level refines the one before by the same ratio: the report then tells observed orders and what is to be expected without discretisation. For a grid with three levels at least. Default false.
        refinement: bool,
    }
}

section! {
    /// Experiments: the study many times over with other values of its keys, instead of once.
    ExperimentsFile {
        /// "grid" (default), "latin-hypercube" or "sobol".
        plan: PlanName,
        /// Runs of a Latin hypercube or of Sobol's sequence.
        runs: usize,
        /// Seed of the Latin hypercube or of the scrambling. Default 1.
        seed: u64,
        /// "simulate" (default) or "search".
        each: EachName,
        /// What is varied.
        factors: Vec<Given<FactorFile>>,
    }
}

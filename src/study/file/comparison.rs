//! What is compared instead of optimised, as written.

use crate::gradient::EngineName;

section! {
    /// The gradient engines side by side at the start design, instead of a search for a better one.
    ComparisonFile {
        /// Engines compared. Default all: "FW", "BW", "CEN", "TRA", "ADJ". ADJ is the reference in any case.
        engines: Vec<EngineName>,
        /// Relative perturbations of the differences. Default 1e-2 to 1e-9 in half decades (3e-3 between 1e-2 and 1e-3).
        perturbations: Vec<f64>,
        /// Numbers of parameters for which the cost is measured: the first of the list each time. Default 1, 2, 4, ... and all.
        parameter_counts: Vec<usize>,
    }
}

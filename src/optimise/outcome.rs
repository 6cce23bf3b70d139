//! How an optimisation ended.

use serde::{Deserialize, Serialize};

/// Reason why the optimiser stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// A KKT point within the tolerance.
    Converged,
    /// No further progress, but close to a KKT point and feasible.
    AlmostConverged,
    /// The iterations asked for are used up.
    IterationLimit,
    /// The simulations or the time asked for are used up.
    BudgetSpent,
    /// No step improves the design, far from a KKT point.
    NoProgress,
    /// No design in the box meets the constraints, as far as the linearisations tell.
    Infeasible,
    /// The start design could not be simulated.
    StartFailed,
    /// Only the start design was asked for.
    Simulated,
    /// Stopped from outside.
    Cancelled,
}

impl Outcome {
    /// What an engineer can do about it.
    pub fn advice(self) -> &'static str {
        match self {
            Self::Converged => {
                "The design meets the optimality conditions within the tolerance. Look at the active constraints and \
                 parameters at bounds: they limit the design."
            }
            Self::AlmostConverged => {
                "The design is feasible and close to the optimum, but the objective is no longer smooth at this scale. \
                 Loosen optimiser.tolerance, refine the film mesh or use more steps per cycle."
            }
            Self::IterationLimit => "Raise optimiser.max_iterations, or start from this design.",
            Self::BudgetSpent => {
                "The best design found within optimiser.max_simulations or optimiser.max_time is reported. Raise them, or start \
                 from this design."
            }
            Self::NoProgress => {
                "Check the gradient with 'stribeck gradient FILE --engine all'; use the adjoint engine, more steps per \
                 cycle or a finer film mesh, or start from another design."
            }
            Self::Infeasible => {
                "No design that meets all constraints was found: within the box, their linearisations at the last design contradict \
                 each other. The constraint list shows by how much each is missed; widen the box, relax the worst one, or start \
                 from another design."
            }
            Self::StartFailed => {
                "The start design cannot be simulated; the reason is given. If the orbit did not become periodic: more \
                 orbit.max_cycles or a looser orbit.periodicity_tolerance (a film that holds tension often has no stable \
                 orbit). If a step did not converge: more orbit.steps_per_cycle, a larger bearing or less load."
            }
            Self::Simulated => "The start design was simulated; no better one was looked for.",
            Self::Cancelled => {
                "Stopped on request; the best design found until then is reported, if there was one."
            }
        }
    }
}

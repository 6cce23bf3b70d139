//! Gradients of cycle quantities with respect to all parameters, by five engines behind one trait.
//!
//! | engine | what it computes | cost over `n_p` parameters and `n_q` quantities | accuracy | memory | choose it |
//! |---|---|---|---|---|---|
//! | FW, BW | one-sided difference of the settled quantity | `n_p` warm simulations, any `n_q` | about `eps_p`; rounding, what settling leaves, kinks | one cycle | to see the one-sided slopes of a kink |
//! | CEN | central difference | `2 n_p` warm simulations, any `n_q` | about `eps_p^2`, else the same | one cycle | to check the others |
//! | TRA | tangent equations marched along the orbit | a solve per step, sweep and parameter | exact | a cycle and its factors | for fewer parameters than quantities; as second opinion on ADJ |
//! | ADJ | discrete adjoint, marched backwards | a solve per step, sweep and quantity | exact | a cycle and its factors | by default |
//!
//! *Exact* means exact for the discrete periodic model: TRA and ADJ agree to rounding. Factors are kept as far as
//! [`OrbitOptions::memory_bytes`] allows, else made again in every sweep. All engines see the periodic start state change
//! with the design: the differences by settling anew, TRA and ADJ by carrying the memory on to its fixed point.
//!
//! The transient approach has two variants. One marches the *tangent equations*: that is TRA. The other differences the
//! transient itself: every perturbed simulation is **continued from the settled cycle**, not started cold. That is how FW,
//! BW and CEN work here; the perturbed cycle is settled to a share of the perturbation, so that what is left of the start
//! does not count. Measured by `studies/gradient-engines.toml` (16 parameters, 4 quantities, unit: one simulation from a cold
//! start, `eps_p` = 1e-6, one thread):
//!
//! | | 1 parameter | 4 | 16 | error against ADJ, best `eps_p` |
//! |---|---|---|---|---|
//! | FW warm: factorisations, time | 0.34, 0.47 | 1.4, 1.9 | 4.9, 7.1 | 7e-7 |
//! | CEN warm: factorisations, time | 0.68, 0.91 | 2.8, 3.8 | 9.9, 14 | 4e-9 |
//! | TRA: factorisations, time | 0.039, 0.23 | 0.039, 0.44 | 0.039, 1.3 | 3e-14 |
//! | ADJ: factorisations, time | 0.039, 0.23 | 0.039, 0.21 | 0.039, 0.21 | - |
//!
//! Errors are those of the check, which settles every cycle as sharply as rounding allows. A warm difference costs about
//! 0.4 of a simulation, and TRA costs as much as one simulation at about 12 parameters.
//! Cycle unknowns (a film temperature) count as parameters and their means as quantities: one column more for each. By memory,
//! a step of 360 cells takes 3 kB as state and 149 kB with its factors.
//! [`check_gradient`] proves a gradient on any model: it says *exact*, *kink*, *noisy* or *wrong*, and why.
//!
//! A model of one's own proves its gradient with [`taylor_table`], and its products one by one with [`check_ladder`].
//!
//! Quantities are piecewise smooth where cells enter or leave the cavity; the gradient is that of the current piece.
//! Deliberately not here: which parameters and quantities a study asks for.

mod adjoint;
mod along;
mod balanced;
mod chain;
mod finding;
mod finite;
mod ladder;
mod proof;
mod second;
mod sweep;
mod taylor;
mod transient;

pub use along::{Along, AlongTable, along};
pub use balanced::{Adjoint, Transient};
pub use finding::{CEN_AGREES, ENGINES_AGREE, Finding, Verdict};
pub(crate) use finite::tight;
pub use finite::{Difference, FiniteDifference};
pub use ladder::{LadderRow, check_ladder};
pub use proof::{CheckPlan, GradientCheck, QuantityCheck, check_gradient, check_tables};
pub use second::{HessianProduct, hessian_times};
pub use sweep::DifferenceStep;
pub use taylor::{TaylorRow, taylor_table, verdict};

use crate::dae::{InvalidParameters, SensitiveDae};
use crate::math::Singular;
use crate::orbit::{Orbit, OrbitError, OrbitOptions, Quantity};
use crate::run::{Cancel, Cancelled, Cost};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Name of a gradient engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "UPPERCASE")]
pub enum EngineName {
    /// Forward differences.
    Fw,
    /// Backward differences.
    Bw,
    /// Central differences.
    Cen,
    /// Transient approach (forward sensitivity).
    Tra,
    /// Discrete adjoint.
    Adj,
}

impl EngineName {
    /// All engines.
    pub const ALL: [Self; 5] = [Self::Fw, Self::Bw, Self::Cen, Self::Tra, Self::Adj];

    /// The name in capitals.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fw => "FW",
            Self::Bw => "BW",
            Self::Cen => "CEN",
            Self::Tra => "TRA",
            Self::Adj => "ADJ",
        }
    }
}

/// The engine of a name; `perturbation` is the relative step `eps_p` of the differences.
pub fn engine<M: SensitiveDae>(name: EngineName, perturbation: f64) -> Box<dyn GradientEngine<M>> {
    let finite = |difference| Box::new(FiniteDifference { difference, perturbation });
    match name {
        EngineName::Fw => finite(Difference::Forward),
        EngineName::Bw => finite(Difference::Backward),
        EngineName::Cen => finite(Difference::Central),
        EngineName::Tra => Box::new(Transient),
        EngineName::Adj => Box::new(Adjoint),
    }
}

/// Number of parameters that are varied: all but the cycle unknowns.
fn varied<M: SensitiveDae>(model: &M, at: &Orbit) -> usize {
    at.parameters.len() - model.cycle().map_or(0, |c| c.unknowns())
}

/// Derivatives of quantities (rows) by parameters (columns), SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GradientTable {
    /// One row per quantity, one entry per parameter.
    pub rows: Vec<Vec<f64>>,
    /// One row per quantity: derivatives by the model's fields ([`SensitiveDae::fields`]), of which the rows are projections.
    /// ADJ only, else empty.
    pub fields: Vec<Vec<f64>>,
    /// Sweeps over the cycle (settled cycles for the differences).
    pub sweeps: f64,
    /// Share of the memory over which the sensitivity misses being periodic; 0 for the differences.
    pub closure: f64,
    /// Work done, the simulation at the point itself not included.
    pub cost: Cost,
}

/// Why there is no gradient.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GradientError {
    /// A perturbed simulation failed.
    #[error("a perturbed simulation failed: {0}")]
    Orbit(#[from] OrbitError),
    /// A perturbed design does not exist.
    #[error("a perturbed design does not exist: {0}")]
    Parameters(#[from] InvalidParameters),
    /// A step matrix collapsed.
    #[error(transparent)]
    Singular(#[from] Singular),
    /// The cycle unknowns do not answer to the parameters: their equations are singular.
    #[error("the balance over the cycle (film temperature) is singular here")]
    Unbalanced,
    /// The memory of the orbit does not fade.
    #[error("the sensitivity does not become periodic within {0} sweeps: the orbit is hardly stable")]
    NotClosed(usize),
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// One way to a gradient.
pub trait GradientEngine<M: SensitiveDae>: Send + Sync {
    /// Which one.
    fn name(&self) -> EngineName;

    /// Derivatives of the quantities `of` at the settled cycle `at` of `model`.
    fn gradient(
        &self,
        model: &M,
        at: &Orbit,
        options: &OrbitOptions,
        of: &[Quantity],
        cancel: &Cancel,
    ) -> Result<GradientTable, GradientError>;
}

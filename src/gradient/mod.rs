//! Gradients of cycle quantities with respect to all parameters, by five engines behind one trait.
//!
//! | engine | what it computes | cost in simulations for `n_p` parameters, `n_q` quantities | accuracy |
//! |---|---|---|---|
//! | FW, BW | forward, backward difference of the settled quantity | `n_p` | about `eps_p` |
//! | CEN | central difference | `2 n_p` | about `eps_p^2`, limited by rounding |
//! | TRA | tangent equations marched along the orbit | one linear solve per step and parameter | exact |
//! | ADJ | discrete adjoint, marched backwards | one linear solve per step and quantity | exact |
//!
//! *Exact* means exact for the discrete periodic model: TRA and ADJ agree to rounding. Use ADJ by default, TRA if there
//! are fewer parameters than quantities, the differences to check the others. All see the periodic start state change
//! with the design: the differences by settling anew, TRA and ADJ by sweeping on until the carried memory has died out.
//!
//! A model of one's own proves its gradient with [`taylor_table`], and its products one by one with [`check_ladder`].
//!
//! Quantities are piecewise smooth where cells enter or leave the cavity; the gradient is that of the current piece.
//! Deliberately not here: which parameters and quantities a study asks for.

mod adjoint;
mod balanced;
mod chain;
mod finite;
mod ladder;
mod second;
mod taylor;
mod transient;

pub use balanced::{Adjoint, Transient};
pub use finite::{Difference, FiniteDifference};
pub use ladder::{LadderRow, check_ladder};
pub use second::{HessianProduct, hessian_times};
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

/// Derivatives of quantities (rows) by parameters (columns), SI units.
#[derive(Debug, Clone, PartialEq)]
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

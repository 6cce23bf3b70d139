//! The lubricated gap of one journal bearing: from the journal's motion to film pressure, force and friction.
//!
//! Frame and signs: the shell is at rest, `phi` runs with the journal's rotation, `n = (cos phi, sin phi)` points from
//! the shell's centre to the gap at `phi`. The journal's centre stands at the eccentricity `e` and moves with `v = e'`:
//!
//! ```text
//! h = C - e.n            gap;  the smallest gap lies where the journal approaches the shell
//! h' = -v.n              squeeze at rest in the shell frame
//! force = -Int p n dA    on the journal
//! ```
//!
//! A film model has unknowns `q` (pressures; none in closed form), a residual `r(q, u) = 0` and outputs `y(q, u)`, both
//! of the [`FilmInput`] `u`, with all first derivatives as products. Only the relative speed of the surfaces drags oil,
//! so a rotating shell (connecting rod) needs no more than the relative speed and the load in its own frame.
//!
//! Deliberately not here: loads, motion, time.

mod fields;
mod gap;
mod mesh;
mod reynolds;
mod reynolds_derivatives;
mod reynolds_model;
mod short;
mod steady;

pub use gap::Gap;
pub use mesh::{Axial, Mesh};
pub use reynolds::{Cavitation, Reynolds};
pub use short::ShortFilm;
pub use steady::{SteadyError, SteadyState, steady};

use crate::math::Stencil;

/// Everything the film depends on at one instant; the same shape carries changes and derivatives of these quantities.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FilmInput {
    /// Position of the journal's centre in the shell frame, m.
    pub eccentricity_m: [f64; 2],
    /// Velocity of the journal's centre in the shell frame, m/s.
    pub velocity_m_s: [f64; 2],
    /// Angular speed of the journal relative to the shell, rad/s.
    pub speed_rad_s: f64,
    /// Width of the bearing, m.
    pub width_m: f64,
    /// Diameter of the bearing, m.
    pub diameter_m: f64,
    /// Radial clearance, m.
    pub clearance_m: f64,
    /// Dynamic viscosity of the film, Pa s.
    pub viscosity_pa_s: f64,
}

/// What the film answers; the same shape carries changes and weights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FilmOutput {
    /// Force of the film on the journal, N.
    pub force_n: [f64; 2],
    /// Hydrodynamic friction loss: power of the wall shear stress on the journal, W.
    pub loss_w: f64,
    /// Power dissipated in the oil: the wall power less the squeeze power, W.
    pub dissipation_w: f64,
    /// Smallest gap, m.
    pub gap_min_m: f64,
    /// Smooth maximum of the film pressure over the bearing (above the exact one), Pa.
    pub pressure_peak_pa: f64,
    /// Oil that leaves at both edges, m3/s.
    pub side_flow_m3_s: f64,
}

impl FilmInput {
    /// Adds the numbers of another.
    pub fn add(&mut self, other: &Self) {
        for a in 0..2 {
            self.eccentricity_m[a] += other.eccentricity_m[a];
            self.velocity_m_s[a] += other.velocity_m_s[a];
        }
        self.speed_rad_s += other.speed_rad_s;
        self.width_m += other.width_m;
        self.diameter_m += other.diameter_m;
        self.clearance_m += other.clearance_m;
        self.viscosity_pa_s += other.viscosity_pa_s;
    }
}

impl FilmOutput {
    /// Multiplies the integrals over the bearing.
    fn times(&mut self, copies: f64) {
        self.force_n = self.force_n.map(|f| f * copies);
        self.loss_w *= copies;
        self.dissipation_w *= copies;
        self.side_flow_m3_s *= copies;
    }
}

/// A film with its derivatives. `q` are the film's unknowns, `u` is the [`FilmInput`].
pub trait FilmModel: Send + Sync {
    /// Blocks and unknowns per block of the cyclic stencil; `(0, 0)` for a film in closed form.
    fn shape(&self) -> (usize, usize);

    /// Writes `r(q, u)`.
    fn residual(&self, u: &FilmInput, q: &[f64], r: &mut [f64]);

    /// Writes `r_q` (for a semi-smooth residual one element of its generalised Jacobian).
    fn stencil(&self, u: &FilmInput, q: &[f64], a: &mut Stencil);

    /// The stencil and one column `r_u du` per change of the input, together for less than one by one.
    fn linearise(&self, u: &FilmInput, q: &[f64], dus: &[FilmInput], a: &mut Stencil, columns: &mut [f64]) {
        self.stencil(u, q, a);
        if !q.is_empty() {
            for (du, column) in dus.iter().zip(columns.chunks_exact_mut(q.len())) {
                self.residual_tangent(u, q, du, column);
            }
        }
    }

    /// `out += r_u du`.
    fn residual_tangent(&self, u: &FilmInput, q: &[f64], du: &FilmInput, out: &mut [f64]);

    /// `r_u^T lambda`.
    fn residual_cotangent(&self, u: &FilmInput, q: &[f64], lambda: &[f64]) -> FilmInput;

    /// The force alone, for the balance of a step.
    fn force_n(&self, u: &FilmInput, q: &[f64]) -> [f64; 2];

    /// Change of the force for a change of the input at fixed `q`.
    fn force_tangent(&self, u: &FilmInput, q: &[f64], du: &FilmInput) -> [f64; 2];

    /// Derivative of `w.force` by the input; adds its derivative by `q` to `q_bar` if asked.
    fn force_cotangent(&self, u: &FilmInput, q: &[f64], w: [f64; 2], q_bar: Option<&mut [f64]>) -> FilmInput;

    /// `y(q, u)`.
    fn output(&self, u: &FilmInput, q: &[f64]) -> FilmOutput;

    /// `y_q dq + y_u du`.
    fn output_tangent(&self, u: &FilmInput, q: &[f64], dq: &[f64], du: &FilmInput) -> FilmOutput;

    /// Adds `y_q^T w` to `q_bar` and returns `y_u^T w`.
    fn output_cotangent(&self, u: &FilmInput, q: &[f64], w: &FilmOutput, q_bar: &mut [f64]) -> FilmInput;

    /// Largest film pressure, exact on the mesh, Pa.
    fn pressure_max_pa(&self, u: &FilmInput, q: &[f64]) -> f64;

    /// Number of cells in which both the pressure and its slack are almost zero: there the film has a kink.
    fn weakly_active(&self, u: &FilmInput, q: &[f64]) -> usize;

    /// Film pressure as rows over `phi` (first index) and columns over the width, Pa.
    fn pressure_map_pa(&self, u: &FilmInput, q: &[f64]) -> Vec<Vec<f64>>;
}

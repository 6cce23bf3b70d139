//! The geometric scalars of a film on its mesh and how derivatives by them return to the [`FilmInput`].

use super::{FilmInput, Mesh};

/// Scalars the discrete equations are written in.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Scalars {
    /// Surface speed of the journal relative to the shell, m/s.
    pub speed: f64,
    /// Length of a cell around the circumference, m.
    pub dx: f64,
    /// Width of a cell, m.
    pub dz: f64,
    /// Viscosity, Pa s.
    pub eta: f64,
}

impl Scalars {
    pub fn of(mesh: &Mesh, u: &FilmInput) -> Self {
        let radius = u.diameter_m / 2.0;
        Self {
            speed: u.speed_rad_s * radius,
            dx: radius * mesh.d_phi(),
            dz: u.width_m * mesh.cell_share(),
            eta: u.viscosity_pa_s,
        }
    }

    /// Change of the scalars for a change `du` at `u`.
    pub fn tangent(mesh: &Mesh, u: &FilmInput, du: &FilmInput) -> Self {
        Self {
            speed: (du.speed_rad_s * u.diameter_m + u.speed_rad_s * du.diameter_m) / 2.0,
            dx: du.diameter_m / 2.0 * mesh.d_phi(),
            dz: du.width_m * mesh.cell_share(),
            eta: du.viscosity_pa_s,
        }
    }

    /// Adds to `u_bar` what the derivatives by the scalars (held in `self`) mean for the input.
    pub fn pull_back(&self, mesh: &Mesh, u: &FilmInput, u_bar: &mut FilmInput) {
        u_bar.speed_rad_s += self.speed * u.diameter_m / 2.0;
        u_bar.diameter_m += self.speed * u.speed_rad_s / 2.0 + self.dx * mesh.d_phi() / 2.0;
        u_bar.width_m += self.dz * mesh.cell_share();
        u_bar.viscosity_pa_s += self.eta;
    }
}

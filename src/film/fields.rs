//! The scalars the discrete equations are written in and how derivatives by them return to the [`FilmInput`].

use super::{FilmInput, FilmSite, Mesh};

/// Scalars of the mesh and the surfaces.
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
    /// Radial clearance, m.
    pub clearance: f64,
    /// Roughness of the journal, m.
    pub journal: f64,
    /// Roughness of the shell, m.
    pub shell: f64,
    /// Supply pressure above the surroundings, Pa.
    pub supply: f64,
}

impl Scalars {
    pub fn of(mesh: &Mesh, u: &FilmInput) -> Self {
        let radius = u.diameter_m / 2.0;
        Self {
            speed: u.speed_rad_s * radius,
            dx: radius * mesh.d_phi(),
            dz: u.width_m * mesh.cell_share(),
            eta: u.viscosity_pa_s,
            clearance: u.clearance_m,
            journal: u.journal_roughness_m,
            shell: u.shell_roughness_m,
            supply: u.supply_pressure_pa,
        }
    }

    /// The scalars of a cell in which a share of the shell's roughness is left.
    pub fn in_cell(&self, site: &FilmSite, k: usize) -> Self {
        Self { shell: self.shell * site.shell_left.get(k).copied().unwrap_or(1.0), ..*self }
    }

    /// Change of the scalars for a change `du` at `u`.
    pub fn tangent(mesh: &Mesh, u: &FilmInput, du: &FilmInput) -> Self {
        Self {
            speed: (du.speed_rad_s * u.diameter_m + u.speed_rad_s * du.diameter_m) / 2.0,
            ..Self::of(mesh, du)
        }
    }

    /// Adds to `u_bar` what the derivatives by the scalars (held in `self`) mean for the input.
    pub fn pull_back(&self, mesh: &Mesh, u: &FilmInput, u_bar: &mut FilmInput) {
        u_bar.speed_rad_s += self.speed * u.diameter_m / 2.0;
        u_bar.diameter_m += self.speed * u.speed_rad_s / 2.0 + self.dx * mesh.d_phi() / 2.0;
        u_bar.width_m += self.dz * mesh.cell_share();
        u_bar.viscosity_pa_s += self.eta;
        u_bar.clearance_m += self.clearance;
        u_bar.journal_roughness_m += self.journal;
        u_bar.shell_roughness_m += self.shell;
        u_bar.supply_pressure_pa += self.supply;
    }
}

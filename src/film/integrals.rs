//! What the film answers: loads, losses, extrema, side flow.
//!
//! ```text
//! load_i = Int (p + p_contact) dh/dx_i dA                      against eccentricity and tilt
//! loss   = Int k U^2 fill dA + Int U w/2 dp/dx dA              wall power on the journal
//! contact loss = Int mu p_contact |U| dA,   rubbing = sum over cells of mark p_contact |U|
//! dissipation = Int k U^2 fill dA + sum G (p_a - p_b)^2
//! ```

use super::cavitation::{Cavitation, CavityShear};
use super::cells::Cell;
use super::fields::Scalars;
use super::gap::Modes;
use super::{Axial, FilmOutput, FilmSite, Gap, Reynolds};
use crate::math::PowerMean;

impl Reynolds {
    /// Share of the whole gap's shear that a cell bears, and its derivative by the fill.
    pub(super) fn sheared(&self, fill: f64) -> (f64, f64) {
        match self.cavity_shear {
            CavityShear::Full => (1.0, 0.0),
            CavityShear::Fill => (fill, 1.0),
        }
    }

    /// Friction coefficient of contact; 0 for smooth surfaces.
    pub(super) fn boundary_friction(&self) -> f64 {
        self.rough.as_ref().map_or(0.0, |r| r.boundary_friction)
    }

    /// Whether the smallest gap is known in closed form: aligned and cylindrical.
    pub(super) fn is_plain(&self, site: &FilmSite) -> bool {
        site.shape_m.is_empty() && self.mesh.axial == Axial::Half
    }

    /// What is added to gaps so that their smooth minimum exists in contact too.
    pub(super) fn lift_m(&self) -> f64 {
        self.rough.as_ref().map_or(0.0, |r| r.depth_m)
    }

    /// Smooth minimum over the cells of `gap + lift`.
    pub(super) fn lowest(&self, gap: &[f64]) -> PowerMean {
        let lift = self.lift_m();
        PowerMean::minimum(self.sharpness).of(gap.iter().map(|h| h + lift))
    }

    /// Smooth maximum of the pressure above cavitation pressure.
    pub(super) fn peak(&self, q: &[f64]) -> PowerMean {
        PowerMean::maximum(self.sharpness).of(q.iter().map(|q| self.cavitation.load(*q).0))
    }

    /// Smooth maximum of the contact pressure.
    pub(super) fn contact_peak<const N: usize>(&self, cells: &[Cell<N>]) -> PowerMean {
        PowerMean::maximum(self.sharpness).of(cells.iter().map(|c| c.contact.v))
    }

    /// Outputs from cell quantities.
    pub(super) fn outputs<const N: usize>(
        &self,
        site: &FilmSite,
        q: &[f64],
        gap: &[f64],
        cells: &[Cell<N>],
    ) -> FilmOutput {
        let (u, s) = (&site.input, Scalars::of(&self.mesh, &site.input));
        let (area, friction) = (s.dx * s.dz, self.boundary_friction());
        let (mut y, mut loads) = (FilmOutput::default(), [0.0; 4]);
        for (i, column) in cells.chunks_exact(self.mesh.n_z).enumerate() {
            let modes = Modes::at(&self.mesh, u, i);
            for (j, cell) in column.iter().enumerate() {
                let q = q[i * self.mesh.n_z + j];
                let p = self.cavitation.load(q).0 + cell.contact.v;
                let m = modes.of(self.mesh.zetas[j]);
                (0..4).for_each(|a| loads[a] += p * m[a] * area);
                let sheared = self.sheared(self.cavitation.split(q).fill).0;
                y.loss_w += cell.shear.v * s.speed * s.speed * area * sheared;
                y.contact_loss_w += friction * cell.contact.v * s.speed.abs() * area;
                if let Some(mark) = site.marks.get(i * self.mesh.n_z + j) {
                    y.rubbing_w_m2 += mark * cell.contact.v * s.speed.abs();
                }
            }
        }
        y.dissipation_w = y.loss_w;
        self.for_faces(|face| {
            let sides = self.sides(&face, cells, q, s.speed);
            y.dissipation_w += sides.dissipation(face.around, &s).value;
            if face.around {
                y.loss_w += sides.shear_power(&s).value;
            } else if face.b.is_none() {
                y.side_flow_m3_s += sides.flow(false, &s).value;
            }
        });
        y.force_n = [loads[0], loads[1]];
        y.moment_n_m = [loads[2], loads[3]];
        y = y.integrals_times(self.mesh.copies());
        if self.mesh.axial == Axial::Half {
            // The two halves turn the journal against each other.
            y.moment_n_m = [0.0; 2];
        }
        y.gap_min_m =
            if self.is_plain(site) { Gap::minimum_m(u) } else { self.lowest(gap).value() - self.lift_m() };
        y.pressure_peak_pa = self.peak(q).value() + self.cavitation_pressure_pa;
        y.contact_peak_pa = self.contact_peak(cells).value();
        y
    }

    /// Number of cells that are neither clearly full nor clearly void.
    pub(super) fn weak_cells(&self, q: &[f64], share: f64) -> usize {
        if matches!(self.cavitation, Cavitation::None) {
            return 0;
        }
        let top = self.peak(q).exact();
        q.iter().filter(|q| q.abs() <= share * top).count()
    }
}

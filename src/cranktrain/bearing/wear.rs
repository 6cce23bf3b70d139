//! What is rubbed off at an instant: contact pressure times sliding speed of every cell, on both surfaces.
//!
//! Archard (1953): times `K / H` it is the depth worn off per time. What a bearing has lost already stands in
//! [`BearingSetup::worn_m`](super::BearingSetup::worn_m). Deliberately not here: how wear goes on (see `running_in`).

use super::{JournalBearing, SurfaceField};
use crate::dae::At;
use crate::film::Mesh;

impl JournalBearing {
    /// A field of zeros on the cells of both surfaces; empty for a film without cells.
    pub fn blank_field(&self) -> SurfaceField {
        let n = self.setup.film.mesh().map_or(0, Mesh::cells);
        SurfaceField { shell: vec![0.0; n], journal: vec![0.0; n] }
    }

    /// Adds a share of contact pressure times sliding speed, W/m2, at a point of a trajectory; `contact` is room for the cells.
    pub fn add_rubbing(&self, at: At, share: f64, contact: &mut Vec<f64>, into: &mut SurfaceField) {
        let mut room = Vec::new();
        let site = self.film_site(at, &mut room);
        let speed_m_s = (site.input.speed_rad_s * site.input.diameter_m / 2.0).abs();
        contact.resize(into.shell.len(), 0.0);
        self.setup.film.contact_pa(&site, contact);
        contact.iter_mut().for_each(|p| *p *= share * speed_m_s);
        into.shell.iter_mut().zip(contact.iter()).for_each(|(sum, r)| *sum += r);
        let journal = &mut into.journal;
        self.shapes.grid.turn(site.journal_angle_rad, |cell, at, share| journal[at] += share * contact[cell]);
    }
}

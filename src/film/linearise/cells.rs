//! What stands in every cell, as arrays: pressure and fill by the unknown, oil and surfaces by gap and unknown.

use crate::film::cells::Cell;
use crate::film::fields::Scalars;
use crate::film::gap::Modes;
use crate::film::jet::{GAP, Jet, PRESSURE};
use crate::film::reynolds::Reynolds;
use crate::film::{FilmSite, Gap};

/// A quantity of every cell with its derivatives by the cell's own gap and unknown.
#[derive(Debug, Clone, Default)]
pub(super) struct Quantity {
    pub value: Vec<f64>,
    pub by_gap: Vec<f64>,
    pub by_unknown: Vec<f64>,
}

/// All quantities of all cells.
#[derive(Debug, Clone, Default)]
pub(super) struct Cells {
    pub pressure: Vec<f64>,
    pub pressure_slope: Vec<f64>,
    pub fill: Vec<f64>,
    pub fill_slope: Vec<f64>,
    /// Flow resistance around.
    pub around: Quantity,
    /// Flow resistance across, where it differs: on rough surfaces.
    across: Quantity,
    pub transport: Quantity,
    /// Content thickness, where it differs from the transport thickness: between rough surfaces.
    content: Quantity,
    /// Contact pressure, by the gap; empty without contact.
    pub contact: Vec<f64>,
    pub contact_slope: Vec<f64>,
    rough: bool,
    /// Derivatives of the gap by the motions, one array each; a column of the mesh is repeated at either end, so that every
    /// cell has neighbours.
    pub modes: [Vec<f64>; 4],
    gap: Vec<f64>,
}

impl Quantity {
    fn resize(&mut self, n: usize) {
        for v in [&mut self.value, &mut self.by_gap, &mut self.by_unknown] {
            v.resize(n, 0.0);
        }
    }

    pub fn arrays(&self) -> [&Vec<f64>; 3] {
        [&self.value, &self.by_gap, &self.by_unknown]
    }

    #[inline(always)]
    fn set(&mut self, k: usize, jet: &Jet<2>, pressure_slope: f64) {
        self.value[k] = jet.v;
        self.by_gap[k] = jet.d[GAP];
        self.by_unknown[k] = jet.d[PRESSURE] * pressure_slope;
    }
}

impl Cells {
    pub fn len(&self) -> usize {
        self.gap.len()
    }

    /// Flow resistance across.
    pub fn across(&self) -> &Quantity {
        if self.rough { &self.across } else { &self.around }
    }

    /// Content thickness of a full cell.
    pub fn content(&self) -> &Quantity {
        if self.rough { &self.content } else { &self.transport }
    }

    pub fn set(&mut self, film: &Reynolds, site: &FilmSite, q: &[f64], s: &Scalars, motions: usize) {
        self.resize(q.len(), film);
        self.set_modes(film, site, motions);
        Gap::fill(&film.mesh, site, &mut self.gap);
        for (k, q) in q.iter().enumerate() {
            let split = film.cavitation.split(*q);
            self.pressure[k] = split.p;
            self.pressure_slope[k] = split.p_slope;
            self.fill[k] = split.fill;
            self.fill_slope[k] = split.fill_slope;
        }
        if self.rough { self.set_rough(film, site, s) } else { self.set_smooth(film, s) }
    }

    fn resize(&mut self, n: usize, film: &Reynolds) {
        self.rough = film.rough.is_some();
        let all = [
            &mut self.pressure,
            &mut self.pressure_slope,
            &mut self.fill,
            &mut self.fill_slope,
            &mut self.gap,
        ];
        all.into_iter().for_each(|v| v.resize(n, 0.0));
        self.around.resize(n);
        self.transport.resize(n);
        if self.rough {
            self.across.resize(n);
            self.content.resize(n);
        }
        let contact = film.rough.as_ref().is_some_and(|r| r.contact.is_some());
        let rubbing = if contact { n } else { 0 };
        self.contact.resize(rubbing, 0.0);
        self.contact_slope.resize(rubbing, 0.0);
    }

    fn set_modes(&mut self, film: &Reynolds, site: &FilmSite, motions: usize) {
        let (mesh, n_z) = (&film.mesh, film.mesh.n_z);
        self.modes.iter_mut().take(motions).for_each(|m| m.resize(mesh.cells() + 2 * n_z, 0.0));
        for column in 0..mesh.n_phi + 2 {
            let modes = Modes::at(mesh, &site.input, (column + mesh.n_phi - 1) % mesh.n_phi);
            for (j, zeta) in mesh.zetas.iter().enumerate() {
                let of = modes.of(*zeta);
                (0..motions).for_each(|a| self.modes[a][column * n_z + j] = of[a]);
            }
        }
    }

    fn set_smooth(&mut self, film: &Reynolds, s: &Scalars) {
        let mut cell = Cell::<2>::default();
        for k in 0..self.gap.len() {
            cell.set(film, s, self.gap[k], self.pressure[k] + film.cavitation_pressure_pa, false);
            self.around.set(k, &cell.around, self.pressure_slope[k]);
            self.transport.set(k, &cell.transport, self.pressure_slope[k]);
        }
    }

    fn set_rough(&mut self, film: &Reynolds, site: &FilmSite, s: &Scalars) {
        let mut cell = Cell::<2>::default();
        for k in 0..self.gap.len() {
            cell.set(
                film,
                &s.in_cell(site, k),
                self.gap[k],
                self.pressure[k] + film.cavitation_pressure_pa,
                false,
            );
            let slope = self.pressure_slope[k];
            self.around.set(k, &cell.around, slope);
            self.across.set(k, &cell.across, slope);
            self.transport.set(k, &cell.transport, slope);
            self.content.set(k, &cell.content, slope);
            if !self.contact.is_empty() {
                self.contact[k] = cell.contact.v;
                self.contact_slope[k] = cell.contact.d[GAP];
            }
        }
    }
}

//! The Reynolds film as a [`FilmModel`].

use super::reynolds::Reynolds;
use super::{Cavitation, cells::Cell, cotangent, fields::Scalars, linearise, reynolds::Cover, tangent};
use super::{
    FilmChange, FilmCotangent, FilmLinear, FilmModel, FilmOutput, FilmPlace, FilmPoint, FilmSite,
    FilmTangent, FilmWeights, Gap, Mesh, Wanted,
};

/// Pressure or void below this share of the peak counts as zero.
const WEAK: f64 = 1e-7;
/// Unknowns below this count as small when changes are judged, Pa.
const SMALL_PRESSURE_PA: f64 = 1e5;

impl Reynolds {
    /// Gap and cells of a state.
    fn evaluate(&self, site: &FilmSite, q: &[f64], walls: bool) -> (Vec<f64>, Vec<Cell<2>>) {
        let (mut gap, mut cells) = (Vec::new(), Vec::new());
        self.cells(site, q, walls, &mut gap, &mut cells);
        (gap, cells)
    }
}

impl FilmModel for Reynolds {
    fn mesh(&self) -> Option<&Mesh> {
        Some(&self.mesh)
    }

    fn content(&self, site: &FilmSite, q: &[f64], content: &mut [f64]) {
        let u = &site.input;
        Gap::fill(&self.mesh, site, content);
        for (k, (c, q)) in content.iter_mut().zip(q).enumerate() {
            let split = self.cavitation.split(*q);
            let (density, _) = self.oil.compressibility.at(split.p + self.cavitation_pressure_pa);
            let thickness = self.rough.as_ref().map_or(*c, |rough| {
                let left = site.shell_left.get(k).copied().unwrap_or(1.0);
                let sigmas = [u.journal_roughness_m, left * u.shell_roughness_m];
                rough.surfaces.tabulated(*c, sigmas, false).average_gap.value
            });
            *c = split.fill * (density * thickness);
        }
    }

    fn residual(&self, site: &FilmSite, q: &[f64], rate: &[f64], r: &mut [f64]) {
        let s = Scalars::of(&self.mesh, &site.input);
        let (_, cells) = self.evaluate(site, q, false);
        let mut cover = Cover::default();
        self.cover(site.journal_angle_rad, &mut cover);
        self.balance(&cells, q, rate, &s, r);
        self.close_rows(&cover, q, &s, r);
    }

    fn linearise(&self, site: &FilmSite, q: &[f64], alpha: f64, past: &[f64], into: &mut FilmLinear) {
        linearise::linearise(self, site, q, alpha, past, into);
    }

    fn output(&self, site: &FilmSite, q: &[f64]) -> FilmOutput {
        let (gap, cells) = self.evaluate(site, q, true);
        self.outputs(site, q, &gap, &cells)
    }

    fn fix(&self, site: &FilmSite, q: &[f64], outputs: bool, into: &mut FilmPoint) {
        self.cells(site, q, outputs, &mut into.gap, &mut into.cells);
        if into.cover.share.is_empty() || self.cover_turns() {
            self.cover(site.journal_angle_rad, &mut into.cover);
        }
    }

    fn tangent_at(&self, place: &FilmPlace, change: &FilmChange, wanted: Wanted) -> FilmTangent {
        tangent::tangent(self, place, change, wanted)
    }

    fn cotangent_at(&self, place: &FilmPlace, weights: &FilmWeights) -> FilmCotangent {
        cotangent::cotangent(self, place, weights)
    }

    fn admissible(&self, site: &FilmSite, motion: [f64; 4], keep: f64) -> f64 {
        let (u, depth) = (&site.input, self.lift_m());
        if self.is_plain(site) {
            let [x, y, ..] = motion;
            return Gap::admissible(u.clearance_m + depth, u.eccentricity_m, [x, y], keep);
        }
        let mut h = vec![0.0; self.mesh.cells()];
        Gap::fill(&self.mesh, site, &mut h);
        Gap::admissible_cells(&self.mesh, u, &h, depth, &motion, keep)
    }

    fn contains(&self, site: &FilmSite) -> bool {
        let (u, depth) = (&site.input, self.lift_m());
        if self.is_plain(site) {
            return Gap::minimum_m(u) + depth > 0.0;
        }
        let mut h = vec![0.0; self.mesh.cells()];
        Gap::fill(&self.mesh, site, &mut h);
        h.iter().all(|h| h + depth > 0.0)
    }

    fn change(&self, q: &[f64], dq: &[f64]) -> f64 {
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |a, q| a.max(q.abs()));
        largest(dq) / largest(q).max(SMALL_PRESSURE_PA)
    }

    fn pressure_max_pa(&self, _: &FilmSite, q: &[f64]) -> f64 {
        self.peak(q).exact() + self.cavitation_pressure_pa
    }

    fn contact_max_pa(&self, site: &FilmSite, q: &[f64]) -> f64 {
        self.contact_peak(&self.evaluate(site, q, true).1).exact()
    }

    fn contact_pa(&self, site: &FilmSite, contact: &mut [f64]) {
        // Gaps alone decide on contact.
        let q = vec![0.0; contact.len()];
        let cells = self.evaluate(site, &q, false).1;
        contact.iter_mut().zip(&cells).for_each(|(p, cell)| *p = cell.contact.v);
    }

    fn conserves_mass(&self) -> bool {
        self.cavitation == Cavitation::MassConserving
    }

    fn least_fill(&self, q: &[f64]) -> f64 {
        q.iter().map(|q| self.cavitation.split(*q).fill).fold(1.0, f64::min)
    }

    fn weakly_active(&self, q: &[f64]) -> usize {
        self.weak_cells(q, WEAK)
    }

    fn pressure_map_pa(&self, _: &FilmSite, q: &[f64]) -> Vec<Vec<f64>> {
        self.mesh.map(q.iter().map(|q| self.cavitation.load(*q).0 + self.cavitation_pressure_pa))
    }

    fn fill_map(&self, _: &FilmSite, q: &[f64]) -> Vec<Vec<f64>> {
        self.mesh.map(q.iter().map(|q| self.cavitation.split(*q).fill))
    }
}

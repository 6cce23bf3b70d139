//! Reynolds' equation by finite volumes: pressure and oil content of a bearing with supply, on rough or smooth surfaces.
//!
//! With the flow `J` through the faces ([`super::faces`]) and the content `c = fill rho h_T` of the cells, the net
//! outflow of a cell and its row are
//!
//! ```text
//! balance = sum_faces J + dx dz c'                            m3/s at reference density
//! row     = (1 - m) balance + m g (p - p_supply) + g q_slack
//! ```
//!
//! where `m` is the share of the cell that an opening covers ([`super::supply`]) and `g = C^3 / (12 eta) (dz/dx + dx/dz)` a
//! conductance of the size of the film's own. A covered cell stands at the supply pressure; what its balance lacks is
//! what the opening feeds. `q_slack = min(q, 0)` for Swift-Stieber, else nothing ([`super::cavitation`]). At the edges of
//! the bearing the pressure is the side pressure, half a cell away from the cell centre.
//!
//! Deliberately not here: derivatives ([`super::linearise`], [`super::tangent`], [`super::cotangent`]), integrals.

use super::cavitation::{Cavitation, CavityShear};
use super::cells::Cell;
use super::faces::{Face, Sides};
use super::fields::Scalars;
use super::supply::{Feed, any_on_journal, covers};
use super::{FilmSite, Gap, Mesh};
use crate::laws::{Compressibility, GreenwoodTripp, Piezoviscosity, RoughSurfaces, ShearThinning};

/// How the oil depends on pressure and shear; its viscosity at ambient pressure is part of the input.
#[derive(Debug, Clone)]
pub struct Oil {
    /// Viscosity over pressure.
    pub piezoviscosity: Piezoviscosity,
    /// Density over pressure.
    pub compressibility: Compressibility,
    /// Viscosity over shear rate.
    pub shear_thinning: ShearThinning,
}

impl Oil {
    /// An incompressible Newtonian oil of the same viscosity at every pressure.
    pub fn plain() -> Self {
        Self {
            piezoviscosity: Piezoviscosity::None,
            compressibility: Compressibility::Incompressible,
            shear_thinning: ShearThinning::Newtonian,
        }
    }
}

/// Rough surfaces and what happens when they touch.
#[derive(Debug, Clone)]
pub struct Roughness {
    /// Flow factors.
    pub surfaces: RoughSurfaces,
    /// Contact pressure; none for a film without contact.
    pub contact: Option<GreenwoodTripp>,
    /// Friction coefficient of boundary lubrication.
    pub boundary_friction: f64,
    /// How far mean planes may come together below zero gap, m; also keeps the smooth smallest gap above zero.
    pub depth_m: f64,
}

/// Reynolds film on a mesh.
#[derive(Debug, Clone)]
pub struct Reynolds {
    /// The mesh.
    pub mesh: Mesh,
    /// Rupture model.
    pub cavitation: Cavitation,
    /// Shear in the cavity.
    pub cavity_shear: CavityShear,
    /// Pressure at both edges above the surroundings, Pa.
    pub side_pressure_pa: f64,
    /// Cavitation pressure above the surroundings (usually below zero), Pa.
    pub cavitation_pressure_pa: f64,
    /// Columns held at a given pressure above the surroundings, Pa: boundaries of comparison cases.
    pub held_columns: Vec<(usize, f64)>,
    /// Openings that feed oil at the supply pressure.
    pub feeds: Vec<Feed>,
    /// Oil.
    pub oil: Oil,
    /// Rough surfaces; none for smooth ones.
    pub rough: Option<Roughness>,
    /// Sharpness of the smooth extrema of pressure and gap.
    pub sharpness: f64,
}

/// Where the oil of a film goes; all flows in m3/s at reference density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassBalance {
    /// From openings and held columns into the film.
    pub supply: f64,
    /// Out of both edges.
    pub side: f64,
    /// Rate of the content.
    pub stored: f64,
    /// `supply - side - stored`: what the balances of the cells leave.
    pub error: f64,
}

/// How much of each cell is covered, and the pressure (above cavitation) it is held at there.
#[derive(Debug, Clone, Default)]
pub(super) struct Cover {
    pub share: Vec<f64>,
    /// Whether the cell is held at a fixed pressure; else at the supply's.
    pub fixed: Vec<Option<f64>>,
}

impl Reynolds {
    /// A smooth film at ambient pressure all around, Swift-Stieber, whole gap sheared, without supply.
    pub fn new(mesh: Mesh) -> Self {
        Self {
            mesh,
            cavitation: Cavitation::SwiftStieber,
            cavity_shear: CavityShear::Full,
            side_pressure_pa: 0.0,
            cavitation_pressure_pa: 0.0,
            held_columns: Vec::new(),
            feeds: Vec::new(),
            oil: Oil::plain(),
            rough: None,
            sharpness: 200.0,
        }
    }

    /// Side pressure above cavitation pressure.
    pub(super) fn side(&self) -> f64 {
        self.side_pressure_pa - self.cavitation_pressure_pa
    }

    /// Whether the openings turn.
    pub(super) fn cover_turns(&self) -> bool {
        any_on_journal(&self.feeds)
    }

    /// What the openings cover when the journal stands at an angle.
    pub(super) fn cover(&self, journal_angle_rad: f64, into: &mut Cover) {
        let n = self.mesh.cells();
        into.share.resize(n, 0.0);
        into.fixed.resize(n, None);
        if self.feeds.is_empty() {
            into.share.fill(0.0);
        } else {
            let (points, blur) = (self.mesh.points(), self.mesh.cell_size());
            covers(&self.feeds, points, blur, journal_angle_rad, &mut into.share);
        }
        for &(i, p) in &self.held_columns {
            for k in i * self.mesh.n_z..(i + 1) * self.mesh.n_z {
                into.share[k] = 1.0;
                into.fixed[k] = Some(p - self.cavitation_pressure_pa);
            }
        }
    }

    /// Conductance by which covered and slack cells are tied.
    pub(super) fn tie(s: &Scalars) -> f64 {
        s.clearance.powi(3) / (12.0 * s.eta) * (s.dz / s.dx + s.dx / s.dz)
    }

    /// Change of [`Self::tie`].
    pub(super) fn tie_change(s: &Scalars, d: &Scalars) -> f64 {
        let base = s.clearance.powi(3) / (12.0 * s.eta);
        let aspect = s.dz / s.dx + s.dx / s.dz;
        base * aspect * (3.0 * d.clearance / s.clearance - d.eta / s.eta)
            + base * (s.dz / s.dx - s.dx / s.dz) * (d.dz / s.dz - d.dx / s.dx)
    }

    /// Adds a weight on [`Self::tie`].
    pub(super) fn pull_tie(s: &Scalars, weight: f64, bar: &mut Scalars) {
        let base = weight * s.clearance.powi(3) / (12.0 * s.eta);
        let (aspect, skew) = (s.dz / s.dx + s.dx / s.dz, s.dz / s.dx - s.dx / s.dz);
        bar.clearance += 3.0 * base * aspect / s.clearance;
        bar.eta -= base * aspect / s.eta;
        bar.dz += base * skew / s.dz;
        bar.dx -= base * skew / s.dx;
    }

    /// Calls `visit` for every face of the mesh.
    #[inline(always)]
    pub(super) fn for_faces(&self, mut visit: impl FnMut(Face)) {
        let (n, b) = (self.mesh.n_phi, self.mesh.n_z);
        for i in 0..n {
            let east = (i + 1) % n * b;
            for j in 0..b {
                let a = i * b + j;
                visit(Face { a, b: Some(east + j), around: true });
                visit(Face { a, b: (j + 1 < b).then_some(a + 1), around: false });
                if j == 0 && self.mesh.low_edge() {
                    visit(Face { a, b: None, around: false });
                }
            }
        }
    }

    /// Gap and cell quantities, with or without those at the walls.
    pub(super) fn cells<const N: usize>(
        &self,
        site: &FilmSite,
        q: &[f64],
        walls: bool,
        gap: &mut Vec<f64>,
        cells: &mut Vec<Cell<N>>,
    ) {
        let s = Scalars::of(&self.mesh, &site.input);
        gap.resize(q.len(), 0.0);
        Gap::fill(&self.mesh, site, gap);
        cells.resize(q.len(), Cell::default());
        for (k, ((cell, &h), &q)) in cells.iter_mut().zip(&*gap).zip(q).enumerate() {
            let s = s.in_cell(site, k);
            cell.set(self, &s, h, self.cavitation.split(q).p + self.cavitation_pressure_pa, walls);
        }
    }

    /// The two sides of a face.
    pub(super) fn sides<'c, const N: usize>(
        &self,
        face: &Face,
        cells: &'c [Cell<N>],
        q: &[f64],
        speed: f64,
    ) -> Sides<'c, N> {
        let at = |k: usize| self.cavitation.split(q[k]);
        let (a, b) = (at(face.a), face.b.map(at));
        Sides {
            a: &cells[face.a],
            b: face.b.map(|b| &cells[b]),
            drop: a.p - b.map_or(self.side(), |b| b.p),
            fill: if speed >= 0.0 { a.fill } else { b.map_or(1.0, |b| b.fill) },
        }
    }

    /// Net outflow of every cell.
    pub(super) fn balance<const N: usize>(
        &self,
        cells: &[Cell<N>],
        q: &[f64],
        rate: &[f64],
        s: &Scalars,
        r: &mut [f64],
    ) {
        r.iter_mut().zip(rate).for_each(|(r, c)| *r = c * s.dx * s.dz);
        self.for_faces(|face| {
            let flow = self.sides(&face, cells, q, s.speed).flow(face.around, s).value;
            r[face.a] += flow;
            if let Some(b) = face.b {
                r[b] -= flow;
            }
        });
    }

    /// Turns balances into rows.
    pub(super) fn close_rows(&self, cover: &Cover, q: &[f64], s: &Scalars, r: &mut [f64]) {
        let tie = Self::tie(s);
        let slack = self.cavitation == Cavitation::SwiftStieber;
        for (k, r) in r.iter_mut().enumerate() {
            let m = cover.share[k];
            if m > 0.0 {
                let held = cover.fixed[k].unwrap_or(s.supply - self.cavitation_pressure_pa);
                *r = (1.0 - m) * *r + m * tie * (self.cavitation.split(q[k]).p - held);
            }
            if slack {
                *r += tie * q[k].min(0.0);
            }
        }
    }

    /// Where the oil goes, for a state and the rate of its content.
    pub fn mass_balance(&self, site: &FilmSite, q: &[f64], rate: &[f64]) -> MassBalance {
        let s = Scalars::of(&self.mesh, &site.input);
        let (mut gap, mut cells, mut cover) = (Vec::new(), Vec::new(), Cover::default());
        self.cells::<2>(site, q, false, &mut gap, &mut cells);
        self.cover(site.journal_angle_rad, &mut cover);
        let mut r = vec![0.0; q.len()];
        self.balance(&cells, q, rate, &s, &mut r);
        let copies = self.mesh.copies();
        let supply: f64 = r.iter().zip(&cover.share).filter(|(_, m)| **m > 0.0).map(|(r, _)| r).sum();
        let stored: f64 = rate.iter().map(|c| c * s.dx * s.dz).sum();
        let mut side = 0.0;
        self.for_faces(|face| {
            if face.b.is_none() {
                side += self.sides(&face, &cells, q, s.speed).flow(false, &s).value;
            }
        });
        let [supply, side, stored] = [supply, side, stored].map(|v| v * copies);
        MassBalance { supply, side, stored, error: supply - side - stored }
    }
}

//! The film linearised for Newton's method: residual, stencil, columns by the journal's motion, rows of the loads.
//!
//! With the content's rate `alpha c + past`, the residual (that of [`Reynolds::balance`]) depends on `q` and the motion `x` directly and through the
//! content. Nothing is allocated once a [`FilmLinear`] has its size.

use super::cavitation::{Cavitation, Split};
use super::cells::Cell;
use super::faces::Face;
use super::fields::Scalars;
use super::gap::Modes;
use super::reynolds::{Cover, Reynolds};
use super::{Axial, FilmSite};
use crate::math::Stencil;

/// What carries changes of the content from step to step.
#[derive(Debug, Clone, Default)]
pub struct FilmCarry {
    /// Derivative of each content by its unknown.
    pub content_by_unknown: Vec<f64>,
    /// Derivatives of the contents by the motions, one column each.
    pub content_by_motion: Vec<f64>,
    /// Derivative of each residual by the rate of its content, m2.
    pub by_rate: Vec<f64>,
    /// Derivatives of the two forces by the journal's velocity (a film in closed form squeezes without contents).
    pub damping: [[f64; 2]; 2],
}

/// Result and workspace of a linearisation.
#[derive(Debug, Clone)]
pub struct FilmLinear {
    /// Number of motions that are unknowns: 2 (eccentricity) or 4 (and tilt).
    pub motions: usize,
    /// Oil content of every cell, m.
    pub content: Vec<f64>,
    /// Residual.
    pub residual: Vec<f64>,
    /// Derivative of the residual by the unknowns.
    pub stencil: Stencil,
    /// Derivatives of the residual by the motions, one column each.
    pub columns: Vec<f64>,
    /// Derivatives of the loads by the unknowns, one row each.
    pub rows: Vec<f64>,
    /// Loads: force and moment on the journal.
    pub loads: [f64; 4],
    /// Derivatives of the loads by the motions.
    pub corner: [[f64; 4]; 4],
    /// How contents change and what their rates do.
    pub carry: FilmCarry,
    gap: Vec<f64>,
    cells: Vec<Cell<2>>,
    splits: Vec<Split>,
    /// Derivatives of the gap by the motions.
    modes: Vec<[f64; 4]>,
    cover: Cover,
    covered: bool,
}

impl FilmCarry {
    /// Room for a film of `n` unknowns and a number of motions.
    pub fn new(n: usize, motions: usize) -> Self {
        Self {
            content_by_unknown: vec![0.0; n],
            content_by_motion: vec![0.0; n * motions],
            by_rate: vec![0.0; n],
            damping: [[0.0; 2]; 2],
        }
    }

    /// Its size.
    pub fn bytes(n: usize, motions: usize) -> usize {
        (n * (2 + motions) + 4) * size_of::<f64>()
    }
}

impl FilmLinear {
    /// Room for a film of `n` unknowns.
    pub fn new(n: usize, motions: usize) -> Self {
        assert!(motions == 2 || motions == 4, "a journal moves in 2 or 4 ways");
        Self {
            motions,
            content: vec![0.0; n],
            residual: vec![0.0; n],
            stencil: Stencil::zeros(n),
            columns: vec![0.0; n * motions],
            rows: vec![0.0; n * motions],
            loads: [0.0; 4],
            corner: [[0.0; 4]; 4],
            carry: FilmCarry::new(n, motions),
            gap: Vec::with_capacity(n),
            cells: Vec::with_capacity(n),
            splits: Vec::with_capacity(n),
            modes: Vec::with_capacity(n),
            cover: Cover::default(),
            covered: false,
        }
    }
}

pub(super) fn linearise(
    film: &Reynolds,
    site: &FilmSite,
    q: &[f64],
    alpha: f64,
    past: &[f64],
    into: &mut FilmLinear,
) {
    let s = Scalars::of(&film.mesh, &site.input);
    film.cells(site, q, &mut into.gap, &mut into.cells);
    into.splits.clear();
    into.splits.extend(q.iter().map(|q| film.cavitation.split(*q)));
    into.modes.clear();
    for column in 0..film.mesh.n_phi {
        let modes = Modes::at(&film.mesh, &site.input, column);
        into.modes.extend(film.mesh.zetas.iter().map(|zeta| modes.of(*zeta)));
    }
    if !into.covered || film.cover_turns() {
        film.cover(site.journal_angle_rad, &mut into.cover);
        into.covered = true;
    }
    for (k, cell) in into.cells.iter().enumerate() {
        into.content[k] = into.splits[k].fill * cell.content.v;
        let rate = alpha * into.content[k] + past.get(k).copied().unwrap_or(0.0);
        into.residual[k] = rate * s.dx * s.dz;
    }
    into.stencil.clear();
    let mut work = Assembly { film, q, s: &s, into: &mut *into };
    work.storage(alpha);
    film.for_faces(|face| work.face(face));
    work.close_rows();
    work.loads();
    film.close_rows(&into.cover, q, &s, &mut into.residual);
}

struct Assembly<'a> {
    film: &'a Reynolds,
    q: &'a [f64],
    s: &'a Scalars,
    into: &'a mut FilmLinear,
}

impl Assembly<'_> {
    /// Contents and the share of their rates.
    fn storage(&mut self, alpha: f64) {
        let area = self.s.dx * self.s.dz;
        let n = self.q.len();
        for k in 0..n {
            let (split, content) = (self.into.splits[k], self.into.cells[k].content);
            let carry = &mut self.into.carry;
            carry.by_rate[k] = area * (1.0 - self.into.cover.share[k]);
            let by_unknown = split.fill_slope * content.v + split.fill * content.d[1] * split.p_slope;
            carry.content_by_unknown[k] = by_unknown;
            self.into.stencil.diagonal[k] = alpha * area * by_unknown;
            for (a, mode) in self.into.modes[k].iter().enumerate().take(self.into.motions) {
                let by_motion = split.fill * content.d[0] * mode;
                self.into.carry.content_by_motion[a * n + k] = by_motion;
                self.into.columns[a * n + k] = alpha * area * by_motion;
            }
        }
    }

    /// Flow through a face: into the balances, the stencil and the columns of its two cells.
    #[inline(always)]
    fn face(&mut self, face: Face) {
        let film = self.film;
        let splits = |k: usize| self.into.splits[k];
        let flow = film.sides_of(&face, &self.into.cells, splits, self.s.speed).flow(face.around, self.s);
        let resistance = |c: &Cell<2>| if face.around { c.around } else { c.across };
        let upstream = self.s.speed >= 0.0;
        let by = |k: usize, side: usize, sign: f64| {
            let (cell, split) = (&self.into.cells[k], self.into.splits[k]);
            let local = |slot: usize| {
                flow.by_resistance[side] * resistance(cell).d[slot]
                    + flow.by_thickness[side] * cell.transport.d[slot]
            };
            let carried = if (side == 0) == upstream { flow.by_fill * split.fill_slope } else { 0.0 };
            ((sign * flow.by_drop + local(1)) * split.p_slope + carried, local(0))
        };
        let (qa, ha) = by(face.a, 0, 1.0);
        let other = face.b.map(|b| (b, by(b, 1, -1.0)));
        let (a, n) = (face.a, self.q.len());
        self.into.residual[a] += flow.value;
        self.into.stencil.diagonal[a] += qa;
        let near = self.into.modes[a];
        let (far, hb) = other.map_or(([0.0; 4], 0.0), |(b, (_, hb))| (self.into.modes[b], hb));
        for m in 0..self.into.motions {
            let change = ha * near[m] + hb * far[m];
            self.into.columns[m * n + a] += change;
            if let Some(b) = face.b {
                self.into.columns[m * n + b] -= change;
            }
        }
        if let Some((b, (qb, _))) = other {
            self.into.residual[b] -= flow.value;
            let stencil = &mut self.into.stencil;
            stencil.diagonal[b] -= qb;
            if face.around {
                stencil.east[a] += qb;
                stencil.west[b] -= qa;
            } else {
                stencil.north[a] += qb;
                stencil.south[b] -= qa;
            }
        }
    }

    /// Covered and slack cells.
    fn close_rows(&mut self) {
        let (tie, n) = (Reynolds::tie(self.s), self.q.len());
        let slack = self.film.cavitation == Cavitation::SwiftStieber;
        for k in 0..n {
            let m = self.into.cover.share[k];
            if m > 0.0 {
                let stencil = &mut self.into.stencil;
                let sides = [
                    &mut stencil.diagonal,
                    &mut stencil.west,
                    &mut stencil.east,
                    &mut stencil.south,
                    &mut stencil.north,
                ];
                sides.into_iter().for_each(|side| side[k] *= 1.0 - m);
                self.into.stencil.diagonal[k] += m * tie * self.into.splits[k].p_slope;
                (0..self.into.motions).for_each(|a| self.into.columns[a * n + k] *= 1.0 - m);
            }
            if slack && self.q[k] < 0.0 {
                self.into.stencil.diagonal[k] += tie;
            }
        }
    }

    fn loads(&mut self) {
        let area = self.s.dx * self.s.dz * self.film.mesh.copies();
        let (n, d) = (self.q.len(), self.into.motions);
        let (mut loads, mut corner) = ([0.0; 4], [[0.0; 4]; 4]);
        for k in 0..n {
            let (p, slope) = self.film.cavitation.load(self.q[k]);
            let (modes, contact) = (self.into.modes[k], self.into.cells[k].contact);
            for a in 0..d {
                loads[a] += (p + contact.v) * modes[a] * area;
                self.into.rows[a * n + k] = slope * modes[a] * area;
                if contact.d[0] != 0.0 {
                    (0..d).for_each(|b| corner[a][b] += contact.d[0] * modes[a] * modes[b] * area);
                }
            }
        }
        if self.film.mesh.axial == Axial::Half {
            debug_assert!(d == 2, "a tilting journal needs a mesh over the whole width");
        }
        self.into.loads = loads;
        self.into.corner = corner;
    }
}

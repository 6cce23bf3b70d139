//! Reynolds' equation of an isoviscous film by finite volumes, with Swift-Stieber cavitation.
//!
//! With `q = p - p_cav` the net outflow of cell `(i, j)` is
//!
//! ```text
//! r = sum_faces h_f^3 / (12 eta) (q - q_neighbour) length/distance     pressure flow
//!   + U/2 (h_east - h_west) dz                                         Couette flow through the faces
//!   + h' dx dz                                                         squeeze
//! ```
//!
//! with `h_f` the mean gap of the two cells of a face: second order in the cell size, conservative by construction. At
//! the edges of the bearing the pressure is the side pressure, half a cell away from the cell centre.
//!
//! Swift-Stieber (`p >= p_cav`, `r >= 0`, one of them zero) is the complementarity problem `min(d q, r) = 0` with the
//! diagonal `d`; Newton's method on it is the primal-dual active set method, finite and monotone for M-matrices
//! (Hintermueller, Ito and Kunisch 2003). The loss is the wall power; by summation by parts over the same faces it equals
//! dissipation plus squeeze power to rounding (with pressure at the edges or in grooves, plus the power of the flow there).
//!
//! Deliberately not here: mass conservation in the cavity, roughness, variable viscosity.

use super::fields::Scalars;
use super::{FilmInput, FilmOutput, Gap, Mesh};
use crate::math::{PowerMean, Stencil};

/// What the film does where it would pull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cavitation {
    /// It ruptures: the pressure does not fall below the cavitation pressure (Swift 1932, Stieber 1933).
    SwiftStieber,
    /// It holds any tension (Sommerfeld's full film); for comparison with closed forms.
    None,
}

/// Reynolds film on a mesh.
#[derive(Debug, Clone)]
pub struct Reynolds {
    /// The mesh.
    pub mesh: Mesh,
    /// Rupture model.
    pub cavitation: Cavitation,
    /// Pressure at both edges above the surroundings, Pa.
    pub side_pressure_pa: f64,
    /// Cavitation pressure above the surroundings (usually below zero), Pa.
    pub cavitation_pressure_pa: f64,
    /// Columns held at a given pressure above the surroundings (narrow axial supply grooves).
    pub held_columns: Vec<(usize, f64)>,
    /// Sharpness of the smooth maximum of the film pressure.
    pub sharpness: f64,
}

/// One face between two cells, or between a cell and an edge (`b` is `None`).
pub(super) struct Face {
    pub a: usize,
    pub b: Option<usize>,
    /// Face across the circumference (oil is dragged through it) or across the width.
    pub around: bool,
}

impl Reynolds {
    /// A film at ambient pressure all around, Swift-Stieber, without grooves.
    pub fn new(mesh: Mesh) -> Self {
        Self {
            mesh,
            cavitation: Cavitation::SwiftStieber,
            side_pressure_pa: 0.0,
            cavitation_pressure_pa: 0.0,
            held_columns: Vec::new(),
            sharpness: 200.0,
        }
    }

    /// `q` at the edges.
    pub(super) fn side(&self) -> f64 {
        self.side_pressure_pa - self.cavitation_pressure_pa
    }

    /// Calls `visit` for every face of the mesh.
    pub(super) fn for_faces(&self, mut visit: impl FnMut(Face)) {
        let (n, b) = (self.mesh.n_phi, self.mesh.n_z);
        for i in 0..n {
            for j in 0..b {
                let a = i * b + j;
                visit(Face { a, b: Some((i + 1) % n * b + j), around: true });
                if j + 1 < b {
                    visit(Face { a, b: Some(a + 1), around: false });
                } else {
                    visit(Face { a, b: None, around: false });
                }
                if j == 0 && self.mesh.low_edge() {
                    visit(Face { a, b: None, around: false });
                }
            }
        }
    }

    /// Pressure conductance of a face, `h_f^3 / (12 eta) * length / distance`, and the gap there.
    pub(super) fn conductance(&self, face: &Face, h: &[f64], s: &Scalars) -> (f64, f64) {
        let (gap, aspect) = match face.b {
            Some(b) if face.around => ((h[face.a] + h[b]) / 2.0, s.dz / s.dx),
            Some(b) => ((h[face.a] + h[b]) / 2.0, s.dx / s.dz),
            None => (h[face.a], 2.0 * s.dx / s.dz),
        };
        (gap * gap * gap / (12.0 * s.eta) * aspect, gap)
    }

    /// Net outflow of every cell and the diagonal of its derivative by `q`.
    pub(super) fn outflow(&self, u: &FilmInput, q: &[f64], gap: &Gap, r: &mut [f64], diagonal: &mut [f64]) {
        let s = Scalars::of(&self.mesh, u);
        let side = self.side();
        for ((r, d), rate) in r.iter_mut().zip(diagonal.iter_mut()).zip(&gap.rate) {
            *r = rate * s.dx * s.dz;
            *d = 0.0;
        }
        self.for_faces(|face| {
            let (k, h) = self.conductance(&face, &gap.h, &s);
            let outer = face.b.map_or(side, |b| q[b]);
            let drag = if face.around { s.speed / 2.0 * h * s.dz } else { 0.0 };
            let flow = k * (q[face.a] - outer) + drag;
            r[face.a] += flow;
            diagonal[face.a] += k;
            if let Some(b) = face.b {
                r[b] -= flow;
                diagonal[b] += k;
            }
        });
    }

    /// Which rows do not carry the flow balance: cavitated cells, and cells held at a pressure.
    pub(super) fn is_passive(&self, u: &FilmInput, q: &[f64], gap: &Gap) -> Vec<bool> {
        let n = self.mesh.cells();
        let mut passive = vec![false; n];
        if self.cavitation == Cavitation::SwiftStieber {
            let (mut r, mut d) = (vec![0.0; n], vec![0.0; n]);
            self.outflow(u, q, gap, &mut r, &mut d);
            passive.iter_mut().enumerate().for_each(|(k, p)| *p = d[k] * q[k] <= r[k]);
        }
        for &(i, _) in &self.held_columns {
            passive[i * self.mesh.n_z..(i + 1) * self.mesh.n_z].fill(true);
        }
        passive
    }

    pub(super) fn fill_stencil(&self, u: &FilmInput, gap: &Gap, passive: &[bool], a: &mut Stencil) {
        let s = Scalars::of(&self.mesh, u);
        a.clear();
        self.for_faces(|face| {
            let (k, _) = self.conductance(&face, &gap.h, &s);
            a.diagonal[face.a] += k;
            if let Some(other) = face.b {
                a.diagonal[other] += k;
                let (out, back) =
                    if face.around { (&mut a.east, &mut a.west) } else { (&mut a.north, &mut a.south) };
                out[face.a] = -k;
                back[other] = -k;
            }
        });
        for (k, _) in passive.iter().enumerate().filter(|(_, p)| **p) {
            a.decouple(k, a.diagonal[k]);
        }
    }

    /// Integrals over the bearing: see [`FilmOutput`].
    pub(super) fn sums(&self, u: &FilmInput, q: &[f64], gap: &Gap) -> FilmOutput {
        let s = Scalars::of(&self.mesh, u);
        let area = s.dx * s.dz;
        let mut y = FilmOutput::default();
        for (k, (q, h)) in q.iter().zip(&gap.h).enumerate() {
            let n = self.mesh.normals[k / self.mesh.n_z];
            y.force_n[0] -= q * n[0] * area;
            y.force_n[1] -= q * n[1] * area;
            y.loss_w += s.eta * s.speed * s.speed * area / h;
        }
        y.dissipation_w = y.loss_w;
        self.for_faces(|face| {
            let (k, h) = self.conductance(&face, &gap.h, &s);
            let drop = q[face.a] - face.b.map_or(self.side(), |b| q[b]);
            y.dissipation_w += k * drop * drop;
            if face.around {
                y.loss_w -= s.speed / 2.0 * drop * h * s.dz;
            }
            if face.b.is_none() {
                y.side_flow_m3_s += k * drop;
            }
        });
        y.times(self.mesh.copies());
        y
    }

    /// `-sum q n` over the whole bearing: the force per cell area.
    pub(super) fn moments(&self, q: &[f64]) -> [f64; 2] {
        let mut m = [0.0; 2];
        for (column, n) in q.chunks_exact(self.mesh.n_z).zip(&self.mesh.normals) {
            let sum: f64 = column.iter().sum();
            m[0] -= sum * n[0];
            m[1] -= sum * n[1];
        }
        m.map(|m| m * self.mesh.copies())
    }

    /// Smooth maximum over the cells of `q`.
    pub(super) fn peak(&self, q: &[f64]) -> PowerMean {
        PowerMean::maximum(self.sharpness).of(q.iter().copied())
    }
}

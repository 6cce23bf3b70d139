//! The Reynolds film as a [`FilmModel`]: equations of [`super::reynolds`], derivatives of [`super::reynolds_derivatives`].

use super::fields::Scalars;
use super::reynolds::{Cavitation, Reynolds};
use super::reynolds_derivatives as derivatives;
use super::{FilmInput, FilmModel, FilmOutput, Gap};
use crate::math::Stencil;

/// Pressure and slack below this share of the peak count as zero together.
const WEAK: f64 = 1e-7;

impl FilmModel for Reynolds {
    fn shape(&self) -> (usize, usize) {
        (self.mesh.n_phi, self.mesh.n_z)
    }

    fn residual(&self, u: &FilmInput, q: &[f64], r: &mut [f64]) {
        let gap = Gap::of(&self.mesh, u);
        let mut diagonal = vec![0.0; q.len()];
        self.outflow(u, q, &gap, r, &mut diagonal);
        if self.cavitation == Cavitation::SwiftStieber {
            for ((r, d), q) in r.iter_mut().zip(&diagonal).zip(q) {
                *r = r.min(d * q);
            }
        }
        for &(i, p) in &self.held_columns {
            for k in i * self.mesh.n_z..(i + 1) * self.mesh.n_z {
                r[k] = diagonal[k] * (q[k] - (p - self.cavitation_pressure_pa));
            }
        }
    }

    fn stencil(&self, u: &FilmInput, q: &[f64], a: &mut Stencil) {
        let gap = Gap::of(&self.mesh, u);
        self.fill_stencil(u, &gap, &self.is_passive(u, q, &gap), a);
    }

    fn linearise(&self, u: &FilmInput, q: &[f64], dus: &[FilmInput], a: &mut Stencil, columns: &mut [f64]) {
        let gap = Gap::of(&self.mesh, u);
        let passive = self.is_passive(u, q, &gap);
        self.fill_stencil(u, &gap, &passive, a);
        derivatives::residual_tangents(self, u, q, &gap, &passive, dus, columns);
    }

    fn residual_tangent(&self, u: &FilmInput, q: &[f64], du: &FilmInput, out: &mut [f64]) {
        derivatives::residual_tangent(self, u, q, du, out);
    }

    fn residual_cotangent(&self, u: &FilmInput, q: &[f64], lambda: &[f64]) -> FilmInput {
        derivatives::residual_cotangent(self, u, q, lambda)
    }

    fn force_n(&self, u: &FilmInput, q: &[f64]) -> [f64; 2] {
        let s = Scalars::of(&self.mesh, u);
        self.moments(q).map(|m| m * s.dx * s.dz)
    }

    fn force_tangent(&self, u: &FilmInput, q: &[f64], du: &FilmInput) -> [f64; 2] {
        let (s, d) = (Scalars::of(&self.mesh, u), Scalars::tangent(&self.mesh, u, du));
        self.moments(q).map(|m| m * (d.dx * s.dz + s.dx * d.dz))
    }

    fn force_cotangent(&self, u: &FilmInput, q: &[f64], w: [f64; 2], q_bar: Option<&mut [f64]>) -> FilmInput {
        let s = Scalars::of(&self.mesh, u);
        let m = self.moments(q);
        let along = w[0] * m[0] + w[1] * m[1];
        let bar = Scalars { dx: along * s.dz, dz: along * s.dx, ..Default::default() };
        let mut u_bar = FilmInput::default();
        bar.pull_back(&self.mesh, u, &mut u_bar);
        if let Some(q_bar) = q_bar {
            let scale = s.dx * s.dz * self.mesh.copies();
            for (column, n) in q_bar.chunks_exact_mut(self.mesh.n_z).zip(&self.mesh.normals) {
                let add = -scale * (w[0] * n[0] + w[1] * n[1]);
                column.iter_mut().for_each(|q| *q += add);
            }
        }
        u_bar
    }

    fn output(&self, u: &FilmInput, q: &[f64]) -> FilmOutput {
        let gap = Gap::of(&self.mesh, u);
        FilmOutput {
            gap_min_m: Gap::minimum_m(u),
            pressure_peak_pa: self.peak(q).value() + self.cavitation_pressure_pa,
            ..self.sums(u, q, &gap)
        }
    }

    fn output_tangent(&self, u: &FilmInput, q: &[f64], dq: &[f64], du: &FilmInput) -> FilmOutput {
        derivatives::output_tangent(self, u, q, dq, du)
    }

    fn output_cotangent(&self, u: &FilmInput, q: &[f64], w: &FilmOutput, q_bar: &mut [f64]) -> FilmInput {
        derivatives::output_cotangent(self, u, q, w, q_bar)
    }

    fn pressure_max_pa(&self, _: &FilmInput, q: &[f64]) -> f64 {
        self.peak(q).exact() + self.cavitation_pressure_pa
    }

    fn weakly_active(&self, u: &FilmInput, q: &[f64]) -> usize {
        if self.cavitation == Cavitation::None {
            return 0;
        }
        let gap = Gap::of(&self.mesh, u);
        let (mut r, mut d) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        self.outflow(u, q, &gap, &mut r, &mut d);
        let top = self.peak(q).exact();
        (0..q.len()).filter(|&k| q[k].abs().max(r[k].abs() / d[k]) <= WEAK * top).count()
    }

    fn pressure_map_pa(&self, _: &FilmInput, q: &[f64]) -> Vec<Vec<f64>> {
        let p = |v: &f64| v + self.cavitation_pressure_pa;
        q.chunks_exact(self.mesh.n_z)
            .map(|half| match self.mesh.low_edge() {
                true => half.iter().map(p).collect(),
                false => half.iter().rev().chain(half).map(p).collect(),
            })
            .collect()
    }
}

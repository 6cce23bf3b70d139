//! Predictions from cycles that were solved, by proper orthogonal decomposition of the surfaces they had.
//!
//! With the surfaces `w_j` of solved cycles, those of the newest `w0` and `X = [w_j - w0]`, the method of snapshots (Sirovich 1987)
//! takes the basis from the eigenvectors of the small matrix `X^T X = V S^2 V^T`: `Psi = X V / S`. New surfaces have the coordinates
//! `a = Psi^T (w - w0)`, and whatever belongs to a cycle (its loss, how fast it wears, its states) is predicted by the affine map
//! of the coordinates that meets the newest cycle and fits the others,
//!
//! ```text
//! f(w) = f_0 + sum_j c_j (f_j - f_0),    c = V_r S_r^-1 a,     r modes
//! ```
//!
//! The number of modes is the one that would have predicted the newest cycle best from the others. Deliberately not here: when a
//! prediction is good enough (see [`super::predicted`]).

use super::field::flat;
use super::rate::Rate;
use crate::cranktrain::SurfaceField;
use crate::math::dot;
use crate::orbit::Orbit;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// Cycles kept: older ones say little about what comes.
const MOST: usize = 8;
/// Modes below this share of the largest are rounding.
const ROUNDING: f64 = 1e-6;

/// A solved cycle.
struct Snapshot {
    worn: Vec<f64>,
    /// How fast every cell wears, m/s.
    speed: Vec<f64>,
    rate: Arc<Rate>,
}

/// Solved cycles of a stage, the newest last, and the basis they span.
#[derive(Default)]
pub(super) struct Basis {
    snapshots: Vec<Snapshot>,
    map: Option<Map>,
}

/// What turns surfaces into weights of snapshots.
struct Map {
    newest: Vec<f64>,
    /// `w_j - w_0` of the others.
    columns: Vec<Vec<f64>>,
    /// `V_r S_r^-2 V_r^T` of the columns.
    matrix: DMatrix<f64>,
}

fn blended(c: &[f64], fields: impl Iterator<Item = impl AsRef<[f64]>>) -> Vec<f64> {
    let mut sum = Vec::new();
    for (c, field) in c.iter().zip(fields) {
        sum.resize(field.as_ref().len(), 0.0);
        sum.iter_mut().zip(field.as_ref()).for_each(|(s, f)| *s += c * f);
    }
    sum
}

fn off(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

impl Map {
    /// The map of snapshots; none without any.
    fn of(snapshots: &[Snapshot], modes: usize) -> Option<Self> {
        let (newest, others) = snapshots.split_last()?;
        let columns: Vec<Vec<f64>> = others.iter().map(|s| off(&s.worn, &newest.worn)).collect();
        Some(Self { newest: newest.worn.clone(), matrix: inverse(&columns, modes), columns })
    }

    /// Weights of the snapshots for surfaces; they add up to one.
    fn weights(&self, worn: &[f64]) -> Vec<f64> {
        let from = off(worn, &self.newest);
        let products = DVector::from_iterator(self.columns.len(), self.columns.iter().map(|c| dot(c, &from)));
        let mut c: Vec<f64> = (&self.matrix * products).iter().copied().collect();
        c.push(1.0 - c.iter().sum::<f64>());
        c
    }
}

/// Inverse of the products of columns with each other, on their leading modes.
fn inverse(columns: &[Vec<f64>], modes: usize) -> DMatrix<f64> {
    let m = columns.len();
    if m == 0 {
        return DMatrix::zeros(0, 0);
    }
    // Of unit length, so that near cycles, which tell most, are not drowned by far ones.
    let sizes: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    let unit: Vec<Vec<f64>> =
        columns.iter().zip(&sizes).map(|(c, size)| c.iter().map(|v| v / size).collect()).collect();
    let eigen = DMatrix::from_fn(m, m, |i, j| dot(&unit[i], &unit[j])).symmetric_eigen();
    let mut order: Vec<usize> = (0..m).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let largest = eigen.eigenvalues[order[0]];
    let mut matrix = DMatrix::zeros(m, m);
    let real = |k: &&usize| eigen.eigenvalues[**k] > ROUNDING * ROUNDING * largest;
    for k in order.iter().take(modes).filter(real) {
        let v = eigen.eigenvectors.column(*k);
        matrix += v * v.transpose() / eigen.eigenvalues[*k];
    }
    DMatrix::from_fn(m, m, |i, j| matrix[(i, j)] / (sizes[i] * sizes[j]))
}

/// What is predicted for surfaces.
pub(super) struct Prediction {
    /// How fast every cell wears, m/s; never less than not at all.
    pub speed: Vec<f64>,
    /// Mean friction loss, W.
    pub loss_w: f64,
}

impl Basis {
    /// Adds a solved cycle.
    pub fn add(&mut self, worn_m: &SurfaceField, depths: &SurfaceField, rate: Arc<Rate>) {
        let newest = Snapshot { worn: flat(worn_m), speed: flat(depths), rate };
        let known = |s: &Snapshot| s.worn == newest.worn;
        if self.snapshots.iter().any(known) {
            return;
        }
        let modes = self.best_modes(&newest);
        if self.snapshots.len() == MOST {
            self.snapshots.remove(0);
        }
        self.snapshots.push(newest);
        self.map = Map::of(&self.snapshots, modes);
    }

    /// The number of modes with which the newest cycle would have been predicted best.
    fn best_modes(&self, newest: &Snapshot) -> usize {
        let old = &self.snapshots;
        let miss = |modes: usize| {
            let c = Map::of(old, modes).map_or_else(Vec::new, |map| map.weights(&newest.worn));
            let found = blended(&c, old.iter().map(|s| &s.speed));
            found.iter().zip(&newest.speed).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
        };
        // One mode more than what was there to choose from: the newest cycle brings a direction of its own.
        let best = (0..old.len()).min_by(|a, b| miss(*a).total_cmp(&miss(*b)));
        best.map_or(0, |best| best + 1)
    }

    fn weights(&self, worn: &[f64]) -> Vec<f64> {
        self.map.as_ref().map_or_else(Vec::new, |map| map.weights(worn))
    }

    /// Predicts a cycle with these surfaces (shell, then journal).
    pub fn predict(&self, worn: &[f64]) -> Prediction {
        let c = self.weights(worn);
        let mut speed = blended(&c, self.snapshots.iter().map(|s| &s.speed));
        speed.iter_mut().for_each(|v| *v = v.max(0.0));
        let losses: Vec<f64> = self.snapshots.iter().map(|s| s.rate.loss_w()).collect();
        Prediction { speed, loss_w: dot(&c, &losses) }
    }

    /// A guess of the whole cycle with these surfaces, to start its solution from.
    pub fn guess(&self, worn_m: &SurfaceField) -> Option<Orbit> {
        let c = self.weights(&flat(worn_m));
        let newest = self.snapshots.last()?;
        let same = |s: &Snapshot| s.rate.orbit.steps() == newest.rate.orbit.steps();
        if !self.snapshots.iter().all(|s| same(s) && s.rate.state_bytes() > 0) {
            return None;
        }
        let of = |n: usize| blended(&c, self.snapshots.iter().map(|s| &s.rate.orbit.states[n]));
        let states = (0..newest.rate.orbit.steps()).map(of).collect();
        let parameters = blended(&c, self.snapshots.iter().map(|s| &s.rate.orbit.parameters));
        Some(Orbit { parameters, ..newest.rate.orbit.with_states(states) })
    }
}

//! Sums, products and sizes of fields on both surfaces. A surface without cells stands for zero and stays so.

use crate::cranktrain::{JournalBearing, SurfaceField};

/// `w + h k`, nothing for fields that are not there.
pub(super) fn moved(w: &SurfaceField, h: f64, k: &SurfaceField) -> SurfaceField {
    let add = |w: &[f64], k: &[f64]| w.iter().zip(k).map(|(w, k)| w + h * k).collect();
    SurfaceField { shell: add(&w.shell, &k.shell), journal: add(&w.journal, &k.journal) }
}

/// Sum of the products of all cells.
pub(super) fn product(a: &SurfaceField, b: &SurfaceField) -> f64 {
    crate::math::dot(&a.shell, &b.shell) + crate::math::dot(&a.journal, &b.journal)
}

/// Largest size of any cell.
pub fn largest(a: &SurfaceField) -> f64 {
    a.shell.iter().chain(&a.journal).fold(0.0f64, |m, v| m.max(v.abs()))
}

/// Zeros where another field has cells.
pub(super) fn zeros(like: &SurfaceField) -> SurfaceField {
    SurfaceField { shell: vec![0.0; like.shell.len()], journal: vec![0.0; like.journal.len()] }
}

/// Surfaces that have not worn: zeros instead of nothing, so that they are judged by the same cells as worn ones.
pub fn new_surfaces(model: &JournalBearing, journal_wears: bool) -> SurfaceField {
    let SurfaceField { shell, journal } = model.blank_field();
    SurfaceField { shell, journal: if journal_wears { journal } else { Vec::new() } }
}

/// Shell and journal behind each other.
pub(super) fn flat(field: &SurfaceField) -> Vec<f64> {
    field.shell.iter().chain(&field.journal).copied().collect()
}

/// The reverse of [`flat`].
pub(super) fn split(flat: &[f64], like: &SurfaceField) -> SurfaceField {
    let (shell, journal) = flat.split_at(like.shell.len());
    SurfaceField { shell: shell.to_vec(), journal: journal.to_vec() }
}

//! The film linearised for Newton's method: residual, stencil, columns by the journal's motion, rows of the loads.
//!
//! With the content's rate `alpha c + past`, the residual (that of [`Reynolds::balance`]) depends on `q` and the motion `x` directly and through the
//! content. This is where a cycle spends its time beside the solver: all quantities of cells and faces are arrays, one entry per cell,
//! swept in vectors, in the order
//!
//! ```text
//! cells    resistance, thickness, content    with derivatives by gap and unknown     `cells`
//! faces    flow                              with derivatives by both sides          `faces`
//! rows     net outflow, stencil, columns     gathered from the faces of a cell       `rows`
//! ```
//!
//! Nothing is allocated once a [`FilmLinear`] has its size.

mod cells;
mod faces;
mod rows;

use super::FilmSite;
use super::fields::Scalars;
use super::reynolds::{Cover, Reynolds};
use crate::math::Stencil;
use cells::Cells;
use faces::Faces;

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
    room: Room,
}

/// Workspace of a film on a mesh.
#[derive(Debug, Clone, Default)]
struct Room {
    cells: Cells,
    around: Faces,
    across: Faces,
    rows: rows::Gathered,
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
            room: Room::default(),
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
    let room = &mut into.room;
    if !room.covered || film.cover_turns() {
        film.cover(site.journal_angle_rad, &mut room.cover);
        room.covered = true;
    }
    room.cells.set(film, site, q, &s, into.motions);
    room.around.around(&room.cells, film.mesh.n_z, &s);
    room.across.across(&room.cells, film.mesh.n_z, &s);
    rows::store(alpha, past, &s, into);
    rows::gather(film, into);
    rows::edges(film, &s, into);
    rows::close(film, q, &s, into);
    rows::loads(film, q, &s, into);
}

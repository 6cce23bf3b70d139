//! Structured mesh of the unwrapped bearing: `n_phi` columns around, `n_z` cells across, cell `(i, j)` at `i * n_z + j`.
//!
//! Cell centres stand at `phi_i = 2 pi i / n_phi`; axially the cells fill the width evenly, so the edges of the bearing
//! are cell faces. A bearing that is symmetric about its mid-plane needs only one half.

use std::f64::consts::TAU;

/// Which part of the width is meshed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axial {
    /// From the mid-plane to one edge; forces and flows count twice.
    Half,
    /// From edge to edge.
    Full,
}

/// Mesh of the film.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Columns around the circumference.
    pub n_phi: usize,
    /// Cells across the meshed part of the width.
    pub n_z: usize,
    /// The meshed part of the width.
    pub axial: Axial,
    /// `cos phi` and `sin phi` of each column.
    pub normals: Vec<[f64; 2]>,
    /// `zeta = 2 z / L` of each row of cells: 0 at the mid-plane, -1 and 1 at the edges.
    pub zetas: Vec<f64>,
    points: Vec<[f64; 2]>,
}

impl Mesh {
    /// A mesh of `n_phi >= 8` columns by `n_z >= 1` cells.
    pub fn new(n_phi: usize, n_z: usize, axial: Axial) -> Self {
        assert!(n_phi >= 8 && n_z >= 1, "a film mesh needs at least 8 x 1 cells");
        let normals = (0..n_phi)
            .map(|i| {
                let (s, c) = (TAU * i as f64 / n_phi as f64).sin_cos();
                [c, s]
            })
            .collect();
        let zeta = |j: usize| match axial {
            Axial::Half => (j as f64 + 0.5) / n_z as f64,
            Axial::Full => (2 * j + 1) as f64 / n_z as f64 - 1.0,
        };
        let zetas: Vec<f64> = (0..n_z).map(zeta).collect();
        let phi = |i: usize| TAU * i as f64 / n_phi as f64;
        let points = (0..n_phi).flat_map(|i| zetas.iter().map(move |z| [phi(i), *z])).collect();
        Self { n_phi, n_z, axial, normals, zetas, points }
    }

    /// `(phi, zeta)` of every cell centre.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Size of a cell in `phi` and `zeta`.
    pub fn cell_size(&self) -> [f64; 2] {
        [self.d_phi(), 2.0 * self.cell_share()]
    }

    /// Values of the cells as rows over `phi` and columns from edge to edge.
    pub fn map(&self, values: impl IntoIterator<Item = f64>) -> Vec<Vec<f64>> {
        let all: Vec<f64> = values.into_iter().collect();
        all.chunks_exact(self.n_z)
            .map(|row| match self.axial {
                Axial::Full => row.to_vec(),
                Axial::Half => row.iter().rev().chain(row).copied().collect(),
            })
            .collect()
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.n_phi * self.n_z
    }

    /// Angle between columns.
    pub fn d_phi(&self) -> f64 {
        TAU / self.n_phi as f64
    }

    /// How often the meshed part makes up the bearing.
    pub fn copies(&self) -> f64 {
        match self.axial {
            Axial::Half => 2.0,
            Axial::Full => 1.0,
        }
    }

    /// Width of a cell as a share of the width of the bearing.
    pub fn cell_share(&self) -> f64 {
        1.0 / (self.copies() * self.n_z as f64)
    }

    /// Whether the lower face `j = 0` is an edge of the bearing (else the mid-plane).
    pub fn low_edge(&self) -> bool {
        self.axial == Axial::Full
    }
}

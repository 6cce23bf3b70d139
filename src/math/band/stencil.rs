//! The matrix as the film model writes it: five coefficients per unknown.

/// Coefficients of a five-point stencil, one entry of each array per unknown.
#[derive(Debug, Clone, Default)]
pub struct Stencil {
    /// Coefficient of the unknown itself.
    pub diagonal: Vec<f64>,
    /// Coefficient of `(i - 1, j)`, cyclic.
    pub west: Vec<f64>,
    /// Coefficient of `(i + 1, j)`, cyclic.
    pub east: Vec<f64>,
    /// Coefficient of `(i, j - 1)`; must be zero for `j = 0`.
    pub south: Vec<f64>,
    /// Coefficient of `(i, j + 1)`; must be zero for `j = b - 1`.
    pub north: Vec<f64>,
}

impl Stencil {
    /// A zero stencil for `n` unknowns.
    pub fn zeros(n: usize) -> Self {
        let z = || vec![0.0; n];
        Self { diagonal: z(), west: z(), east: z(), south: z(), north: z() }
    }

    /// Makes row `k` say `scale * x_k = rhs_k`.
    pub fn decouple(&mut self, k: usize, scale: f64) {
        self.diagonal[k] = scale;
        for side in [&mut self.west, &mut self.east, &mut self.south, &mut self.north] {
            side[k] = 0.0;
        }
    }

    /// Whether row `k` couples to no other unknown.
    pub fn is_decoupled(&self, k: usize) -> bool {
        [&self.west, &self.east, &self.south, &self.north].iter().all(|side| side[k] == 0.0)
    }
}

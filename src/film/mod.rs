//! The lubricated gap of one journal bearing: from the journal's motion to film pressure, force and friction.
//!
//! Frame and signs: the shell is at rest, `phi` runs with the journal's rotation, `n = (cos phi, sin phi)` points from
//! the shell's centre to the gap at `phi`. The journal's centre stands at the eccentricity `e` and moves with `v = e'`:
//!
//! ```text
//! h = C - (e + z tilt).n + shape      gap;  the smallest gap lies where the journal approaches the shell
//! force = -Int p n dA                 on the journal
//! ```
//!
//! A film is a function of its site (input and shape), its unknowns `q` (none in closed form) and the rate `c'` of its
//! oil content, with values
//!
//! ```text
//! r(q, site, c') = 0      balance of every cell
//! c(q, site)              oil content of every cell: what a step remembers
//! y(q, site)              loads, losses, extrema, flow
//! ```
//!
//! All first derivatives are there in both directions: [`FilmModel::tangent`] and [`FilmModel::cotangent`]. Only the
//! relative speed of the surfaces drags oil, so a rotating shell (connecting rod) needs no more than the relative speed
//! and the load in its own frame. Deliberately not here: loads, motion, time.

mod cavitation;
mod cells;
mod cotangent;
mod faces;
mod fields;
mod gap;
mod input;
mod integrals;
mod jet;
mod linearise;
mod mesh;
mod reynolds;
mod reynolds_model;
mod shape;
mod short;
mod steady;
mod supply;
mod tangent;

pub use cavitation::{Cavitation, CavityShear, up_to_the_switch};
pub use gap::Gap;
pub use input::{FilmInput, FilmOutput, INPUTS, OUTPUTS};
pub use linearise::{FilmCarry, FilmLinear};
pub use mesh::{Axial, Mesh};
pub use reynolds::{MassBalance, Oil, Reynolds, Roughness};
pub use shape::{Profile, SPLIT_HALF_WIDTH, SampledProfile, ShapeError, SurfaceTable, TensorSpline};
pub use short::ShortFilm;
pub use steady::{SteadyError, SteadyState, steady, steady_at};
pub use supply::{Feed, Opening, OpeningError, all_symmetric};

/// Where a film is evaluated; the same shape carries changes.
#[derive(Debug, Clone, Copy)]
pub struct FilmSite<'a> {
    /// The scalars.
    pub input: FilmInput,
    /// What the shapes of journal and shell add to the gap in every cell, m; empty for a cylindrical bearing.
    pub shape_m: &'a [f64],
    /// How far the journal has turned, rad: where its openings stand. Not differentiated.
    pub journal_angle_rad: f64,
    /// Weight of each cell in [`FilmOutput::rubbing_w_m2`]; empty for none. Not differentiated.
    pub marks: &'a [f64],
    /// Share of the shell's roughness that is left in every cell; empty for all of it.
    pub shell_left: &'a [f64],
}

impl From<FilmInput> for FilmSite<'static> {
    fn from(input: FilmInput) -> Self {
        Self { input, shape_m: &[], journal_angle_rad: 0.0, marks: &[], shell_left: &[] }
    }
}

/// What the derivatives at a place rest on; made by [`FilmModel::fix`].
#[derive(Debug, Clone, Default)]
pub struct FilmPoint {
    gap: Vec<f64>,
    cells: Vec<cells::Cell<{ jet::SLOTS }>>,
    cover: reynolds::Cover,
}

/// A place with what was evaluated there.
#[derive(Debug, Clone, Copy)]
pub struct FilmPlace<'a> {
    /// The site.
    pub site: &'a FilmSite<'a>,
    /// The unknowns.
    pub q: &'a [f64],
    /// The rate of the content, m/s. May be empty where the residual is not asked for.
    pub rate: &'a [f64],
    /// What [`FilmModel::fix`] made of site and unknowns.
    pub point: &'a FilmPoint,
}

/// A direction in everything a film depends on. Empty vectors stand for zero.
#[derive(Debug, Clone, Copy)]
pub struct FilmChange<'a> {
    /// Change of the unknowns.
    pub q: &'a [f64],
    /// Change of the rate of the content.
    pub rate: &'a [f64],
    /// Change of the scalars.
    pub input: FilmInput,
    /// Change of the shape.
    pub shape_m: &'a [f64],
    /// Change of the share of the shell's roughness that is left.
    pub shell_left: &'a [f64],
}

/// Which parts of a [`FilmTangent`] are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// The residual.
    pub residual: bool,
    /// The content.
    pub content: bool,
    /// The outputs.
    pub output: bool,
}

impl Wanted {
    /// Everything.
    pub const ALL: Self = Self { residual: true, content: true, output: true };
}

/// What a [`FilmChange`] does.
#[derive(Debug, Clone, Default)]
pub struct FilmTangent {
    /// Change of the residual.
    pub residual: Vec<f64>,
    /// Change of the content.
    pub content: Vec<f64>,
    /// Change of the outputs.
    pub output: FilmOutput,
    /// Change of the contact pressure of every cell, with the outputs, Pa; empty for a film without cells.
    pub contact_pa: Vec<f64>,
}

/// Weights on what a film answers. Empty vectors stand for zero.
#[derive(Debug, Clone, Copy, Default)]
pub struct FilmWeights<'a> {
    /// On the residual.
    pub residual: &'a [f64],
    /// On the content.
    pub content: &'a [f64],
    /// On the outputs.
    pub output: FilmOutput,
}

/// Derivatives of a weighted sum by everything a film depends on.
#[derive(Debug, Clone, Default)]
pub struct FilmCotangent {
    /// By the unknowns.
    pub q: Vec<f64>,
    /// By the rate of the content.
    pub rate: Vec<f64>,
    /// By the scalars.
    pub input: FilmInput,
    /// By the gap of every cell: the sensitivity map, and the derivative by the shape. Empty for a film without cells.
    pub gap_m: Vec<f64>,
    /// By the share of the shell's roughness that is left in every cell; empty where the site does not tell any.
    pub shell_left: Vec<f64>,
}

/// A film with its derivatives.
pub trait FilmModel: Send + Sync {
    /// The mesh; none for a film in closed form.
    fn mesh(&self) -> Option<&Mesh>;

    /// Blocks and unknowns per block of the cyclic stencil; `(0, 0)` for a film in closed form.
    fn shape(&self) -> (usize, usize) {
        self.mesh().map_or((0, 0), |m| (m.n_phi, m.n_z))
    }

    /// Number of unknowns, which is also the number of contents.
    fn unknowns(&self) -> usize {
        let (blocks, b) = self.shape();
        blocks * b
    }

    /// Writes the oil content of every cell, as a thickness at reference density, m.
    fn content(&self, site: &FilmSite, q: &[f64], content: &mut [f64]);

    /// Writes the balance of every cell for a given rate of its content (m/s): net outflow, m3/s.
    fn residual(&self, site: &FilmSite, q: &[f64], rate: &[f64], r: &mut [f64]);

    /// Everything a Newton step needs, for the rate `alpha c + past`, in one pass and without allocation.
    fn linearise(&self, site: &FilmSite, q: &[f64], alpha: f64, past: &[f64], into: &mut FilmLinear);

    /// `y(q, site)`.
    fn output(&self, site: &FilmSite, q: &[f64]) -> FilmOutput;

    /// Evaluates everything the derivatives at a place rest on, once for many directions and weights; those of the outputs
    /// other than the loads only if they are wanted.
    fn fix(&self, site: &FilmSite, q: &[f64], outputs: bool, into: &mut FilmPoint);

    /// Changes of residual, content and outputs along a direction at a fixed place.
    fn tangent_at(&self, place: &FilmPlace, change: &FilmChange, wanted: Wanted) -> FilmTangent;

    /// Derivatives of a weighted sum of residual, content and outputs at a fixed place.
    fn cotangent_at(&self, place: &FilmPlace, weights: &FilmWeights) -> FilmCotangent;

    /// [`Self::tangent_at`] for a single direction.
    fn tangent(&self, site: &FilmSite, q: &[f64], rate: &[f64], change: &FilmChange) -> FilmTangent {
        let mut point = FilmPoint::default();
        self.fix(site, q, true, &mut point);
        let wanted = Wanted { residual: !rate.is_empty(), ..Wanted::ALL };
        self.tangent_at(&FilmPlace { site, q, rate, point: &point }, change, wanted)
    }

    /// [`Self::cotangent_at`] for a single weighted sum.
    fn cotangent(&self, site: &FilmSite, q: &[f64], rate: &[f64], weights: &FilmWeights) -> FilmCotangent {
        let mut point = FilmPoint::default();
        self.fix(site, q, true, &mut point);
        self.cotangent_at(&FilmPlace { site, q, rate, point: &point }, weights)
    }

    /// Largest share of a change of eccentricity and tilt, at most 1, that leaves at least `keep` of every gap.
    fn admissible(&self, site: &FilmSite, motion: [f64; 4], keep: f64) -> f64;

    /// Whether every gap is one the film is defined for.
    fn contains(&self, site: &FilmSite) -> bool;

    /// Size of a change of the unknowns against the unknowns themselves.
    fn change(&self, q: &[f64], dq: &[f64]) -> f64;

    /// Largest film pressure, exact on the mesh, Pa.
    fn pressure_max_pa(&self, site: &FilmSite, q: &[f64]) -> f64;

    /// Largest contact pressure, exact on the mesh, Pa.
    fn contact_max_pa(&self, site: &FilmSite, q: &[f64]) -> f64;

    /// Writes the contact pressure of every cell, Pa; nothing for a film without cells.
    fn contact_pa(&self, site: &FilmSite, contact: &mut [f64]);

    /// Whether the oil in the cavity is kept account of.
    fn conserves_mass(&self) -> bool;

    /// Smallest fill of any cell.
    fn least_fill(&self, q: &[f64]) -> f64;

    /// Number of cells in which pressure and void are almost zero together: there the film has a kink.
    fn weakly_active(&self, q: &[f64]) -> usize;

    /// Film pressure as rows over `phi` (first index) and columns over the width, Pa.
    fn pressure_map_pa(&self, site: &FilmSite, q: &[f64]) -> Vec<Vec<f64>>;

    /// Share of the gap filled with oil, like the pressure map.
    fn fill_map(&self, site: &FilmSite, q: &[f64]) -> Vec<Vec<f64>>;
}

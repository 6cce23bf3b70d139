//! Shapes of bore and journal: what a profile adds to the gap, with derivatives by its coefficients.
//!
//! `phi` is the angle around in rad (periodic), `zeta = z / (width / 2)` runs from -1 to 1 across the width. A profile says
//! how much it ADDS to the gap in m: removed material counts positive. Lengths across are shares and lengths around are
//! angles, so a profile does not depend on the diameter and the width. Heights may be negative; whether a gap remains is
//! for the film to say.
//!
//! A profile of the bore stands still; one of the journal turns with it, see [`Profile::sample_turned`].
//!
//! Deliberately not here: clearance, eccentricity and tilt (motion), elastic deformation, wear, oil supply openings.

mod basis;
mod bore;
mod error;
mod hermite;
mod sample;
mod table;
mod tensor;
#[cfg(test)]
mod tests;

pub use bore::SPLIT_HALF_WIDTH;
pub use error::ShapeError;
pub use sample::SampledProfile;
pub use table::SurfaceTable;
pub use tensor::TensorSpline;

use error::{count, finite};

/// A shape of the bore or of the journal. `x` is the angle from the profile's own angle, `phi - angle_rad`.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// Lemon bore: two arcs of a larger radius. Adds `offset (1 - |cos x|)`: nothing in the middle of the halves (at the
    /// angle and opposite), the offset at the split lines (90 degrees from it), which are soft by [`SPLIT_HALF_WIDTH`].
    LemonBore {
        /// Distance of the centres of the halves from the centre of the bore, m.
        offset_m: f64,
        /// Middle of one half, rad.
        angle_rad: f64,
    },
    /// Offset halves: arcs of a larger radius, displaced along the split line. Adds `offset (1 + s cos x)` with
    /// `s = sign(sin x)`: both halves narrow from `2 offset` to nothing in the direction of rotation and step back at the
    /// split lines `x = 0` and `x = pi`, which are soft by [`SPLIT_HALF_WIDTH`]. A negative offset mirrors the bore and
    /// takes `2 |offset|` off the clearance.
    OffsetBore {
        /// Displacement of each half, m.
        offset_m: f64,
        /// One split line, rad.
        angle_rad: f64,
    },
    /// Crowned (positive: wider at the edges) or hollow over the width. Adds `height zeta^2`.
    Barrel {
        /// What is added at both edges, m.
        height_m: f64,
    },
    /// Tapered over the width. Adds `height (1 + zeta) / 2`: nothing at `zeta = -1`, so that the gap only grows.
    Cone {
        /// What is added at the edge `zeta = 1`, m.
        height_m: f64,
    },
    /// Both edges fall off as parabolas: adds `depth ((|zeta| - 1 + length) / length)^2` where `|zeta| > 1 - length`.
    EdgeRelief {
        /// What is added at both edges, m.
        depth_m: f64,
        /// Length of one relief as a share of half the width, above 0 and at most 1.
        length_share: f64,
    },
    /// Free form.
    Spline(TensorSpline),
    /// Measured surface.
    Table(SurfaceTable),
}

impl Profile {
    /// The coefficients that may be changed, in the order of their names: lengths in m, angles in rad, shares.
    pub fn coefficients(&self) -> Vec<f64> {
        match self {
            Self::LemonBore { offset_m, angle_rad } | Self::OffsetBore { offset_m, angle_rad } => {
                vec![*offset_m, *angle_rad]
            }
            Self::Barrel { height_m } | Self::Cone { height_m } => vec![*height_m],
            Self::EdgeRelief { depth_m, length_share } => vec![*depth_m, *length_share],
            Self::Spline(spline) => spline.coefficients().to_vec(),
            Self::Table(table) => vec![table.scale()],
        }
    }

    /// Number of coefficients.
    pub fn coefficient_count(&self) -> usize {
        match self {
            Self::Spline(spline) => spline.coefficients().len(),
            _ => self.fixed_names().len(),
        }
    }

    /// Names of the coefficients, like `offset` or `coefficients[12]`.
    pub fn coefficient_names(&self) -> Vec<String> {
        match self {
            Self::Spline(spline) => {
                (0..spline.coefficients().len()).map(|j| format!("coefficients[{j}]")).collect()
            }
            _ => self.fixed_names().iter().map(|&n| n.to_owned()).collect(),
        }
    }

    fn fixed_names(&self) -> &'static [&'static str] {
        match self {
            Self::LemonBore { .. } | Self::OffsetBore { .. } => &["offset", "angle"],
            Self::Barrel { .. } | Self::Cone { .. } => &["height"],
            Self::EdgeRelief { .. } => &["depth", "length"],
            Self::Spline(_) => &[],
            Self::Table(_) => &["scale"],
        }
    }

    /// The same kind of profile with other coefficients; refused if they make no sense.
    pub fn with_coefficients(&self, coefficients: &[f64]) -> Result<Self, ShapeError> {
        count("coefficients of the profile", coefficients.len(), self.coefficient_count())?;
        let c = coefficients;
        let other = match self {
            Self::LemonBore { .. } => Self::LemonBore { offset_m: c[0], angle_rad: c[1] },
            Self::OffsetBore { .. } => Self::OffsetBore { offset_m: c[0], angle_rad: c[1] },
            Self::Barrel { .. } => Self::Barrel { height_m: c[0] },
            Self::Cone { .. } => Self::Cone { height_m: c[0] },
            Self::EdgeRelief { .. } => Self::EdgeRelief { depth_m: c[0], length_share: c[1] },
            Self::Spline(spline) => Self::Spline(spline.with_coefficients(c)?),
            Self::Table(table) => Self::Table(table.with_scale(c[0])?),
        };
        other.validate()?;
        Ok(other)
    }

    /// Refuses infinite coefficients and lengths out of range.
    pub fn validate(&self) -> Result<(), ShapeError> {
        match self {
            // They cannot be made with such numbers.
            Self::Spline(_) | Self::Table(_) => return Ok(()),
            _ => {
                for (&name, value) in self.fixed_names().iter().zip(self.coefficients()) {
                    finite(name, value)?;
                }
            }
        }
        match self {
            Self::EdgeRelief { length_share, .. } if !(*length_share > 0.0 && *length_share <= 1.0) => {
                Err(ShapeError::OutOfRange {
                    what: "the length of the edge relief",
                    range: "above 0 and at most 1 (half the width)",
                    value: *length_share,
                })
            }
            _ => Ok(()),
        }
    }

    /// Whether the profile is symmetric about the mid-plane whatever its coefficients: half a mesh suffices.
    pub fn symmetric(&self) -> bool {
        match self {
            Self::Cone { .. } => false,
            Self::Spline(spline) => spline.is_symmetric(),
            Self::Table(table) => table.is_symmetric(),
            _ => true,
        }
    }

    /// Whether the profile is the same all around whatever its coefficients: turning it changes nothing.
    pub fn axisymmetric(&self) -> bool {
        match self {
            Self::LemonBore { .. } | Self::OffsetBore { .. } => false,
            Self::Barrel { .. } | Self::Cone { .. } | Self::EdgeRelief { .. } => true,
            Self::Spline(spline) => spline.is_axisymmetric(),
            Self::Table(table) => table.is_axisymmetric(),
        }
    }
}

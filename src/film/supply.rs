//! Openings of the oil supply as smooth masks: which share of each cell of the film an opening covers.
//!
//! The mask is the average of "inside or not" over one cell, smoothed once more over one cell (with the bump
//! `6 t (1 - t)`), both in `phi` and in `zeta`. With `blur` equal to the size of a cell
//!
//! * it is exactly 1 further than one blur inside an edge and exactly 0 further than one blur outside;
//! * its sum over the cells of an even mesh is the area of the opening, however small the opening and wherever it stands;
//! * it has two continuous derivatives by the position, so an opening that turns with the journal does so smoothly.
//!
//! The bearing's edges mirror the mask: a groove that reaches the edge is 1 up to the edge. A round hole is a stack of
//! rectangles of its area.
//!
//! Deliberately not here: supply pressure, what the film does with the mask, the flow through the opening.

use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// Number of rectangles that make up a round hole.
const STRIPS: usize = 16;
/// What may stick out over an edge or a full turn by rounding.
const ROUNDING: f64 = 1e-9;

/// One opening on the unwrapped bearing, `phi` around in rad and `zeta = z / (width / 2)` from -1 to 1 across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opening {
    /// A groove around the bearing, all around or in part.
    CircumferentialGroove {
        /// Middle of the groove across the width.
        centre_zeta: f64,
        /// Width of the groove as a share of the width of the bearing.
        width_share: f64,
        /// Where the groove starts, rad.
        start_rad: f64,
        /// How far it extends from there with growing `phi`, rad; a full turn closes it.
        extent_rad: f64,
    },
    /// A groove along the axis about the mid-plane.
    AxialGroove {
        /// Its middle, rad.
        angle_rad: f64,
        /// Its extent around, rad.
        extent_rad: f64,
        /// Its length as a share of the width of the bearing; 1 reaches both edges.
        length_share: f64,
    },
    /// A rectangular pocket.
    Pocket {
        /// Its middle around, rad.
        angle_rad: f64,
        /// Its extent around, rad.
        extent_rad: f64,
        /// Its middle across the width.
        centre_zeta: f64,
        /// Its extent across as a share of the width of the bearing.
        width_share: f64,
    },
    /// A round hole, an ellipse in `phi` and `zeta`.
    Hole {
        /// Its centre around, rad.
        angle_rad: f64,
        /// Its centre across the width.
        centre_zeta: f64,
        /// Radius over the radius of the bearing, rad.
        radius_rad: f64,
        /// Radius over half the width of the bearing.
        radius_zeta: f64,
    },
}

/// An opening in the shell or in the journal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feed {
    /// The opening; its angles are those of the part it belongs to.
    pub opening: Opening,
    /// Whether it turns with the journal.
    pub on_journal: bool,
}

/// An opening that makes no sense, in words for whoever gave it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OpeningError {
    /// A number outside of its range, or not finite.
    #[error("{what} has to be {range}, not {value}")]
    OutOfRange {
        /// The name of the number.
        what: &'static str,
        /// The range in words.
        range: &'static str,
        /// The number.
        value: f64,
    },
    /// The opening sticks out of the bearing.
    #[error(
        "the opening reaches from {low} to {high} across the width, beyond the edges of the bearing at -1 and 1"
    )]
    BeyondEdge {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

impl Opening {
    /// Middle and half extent, around and across.
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        match *self {
            Self::CircumferentialGroove { centre_zeta, width_share, start_rad, extent_rad } => {
                ([start_rad + 0.5 * extent_rad, 0.5 * extent_rad], [centre_zeta, width_share])
            }
            Self::AxialGroove { angle_rad, extent_rad, length_share } => {
                ([angle_rad, 0.5 * extent_rad], [0.0, length_share])
            }
            Self::Pocket { angle_rad, extent_rad, centre_zeta, width_share } => {
                ([angle_rad, 0.5 * extent_rad], [centre_zeta, width_share])
            }
            Self::Hole { angle_rad, centre_zeta, radius_rad, radius_zeta } => {
                ([angle_rad, radius_rad], [centre_zeta, radius_zeta])
            }
        }
    }

    /// Refuses sizes that are not positive and openings beyond the edges of the bearing.
    pub fn validate(&self) -> Result<(), OpeningError> {
        let ([angle, around], [centre, across]) = self.bounds();
        let round = matches!(self, Self::Hole { .. });
        let check = |what, range, value: f64, good: bool| {
            if good && value.is_finite() {
                Ok(())
            } else {
                Err(OpeningError::OutOfRange { what, range, value })
            }
        };
        check("the angle of the opening", "a finite number", angle, true)?;
        check("the axial centre of the opening", "within -1 to 1", centre, centre.abs() <= 1.0)?;
        let fits = around > 0.0 && around <= PI + ROUNDING;
        if round {
            check("the radius of the hole around", "above 0 and at most half a turn", around, fits)?;
            check("the radius of the hole across", "above 0 and at most 1", across, across > 0.0)?;
        } else {
            check("the extent around", "above 0 and at most a full turn", 2.0 * around, fits)?;
            check("the share of the width", "above 0 and at most 1", across, across > 0.0)?;
        }
        let (low, high) = (centre - across, centre + across);
        if low < -1.0 - ROUNDING || high > 1.0 + ROUNDING {
            return Err(OpeningError::BeyondEdge { low, high });
        }
        Ok(())
    }

    /// Whether the opening is symmetric about the mid-plane.
    pub fn symmetric(&self) -> bool {
        self.bounds().1[0] == 0.0
    }

    /// Area of the opening as a share of the area of the bearing.
    pub fn area_share(&self) -> f64 {
        let ([_, around], [_, across]) = self.bounds();
        let corner = if matches!(self, Self::Hole { .. }) { 0.25 * PI } else { 1.0 };
        corner * around * across / PI
    }

    /// The share of a cell at `(phi, zeta)` that the opening covers, from 0 to 1; `blur` is the size of a cell in `phi`
    /// and in `zeta`.
    pub fn cover(&self, phi: f64, zeta: f64, blur: [f64; 2]) -> f64 {
        let ([angle, around], [centre, across]) = self.bounds();
        let off = (phi - angle + PI).rem_euclid(TAU) - PI;
        let inside = if let Self::Hole { .. } = self {
            // Seen from the hole the point may stand in a mirror image beyond an edge, but hardly ever does.
            let (mut sum, mut low, mut low_chord) = (0.0, -1.0, 0.0);
            if (zeta - centre).abs() >= across + blur[1]
                && 2.0 - zeta.abs() >= across + centre.abs() + blur[1]
            {
                return 0.0;
            }
            if off.abs() >= around + blur[0] && around + blur[0] <= PI {
                return 0.0;
            }
            for k in 1..=STRIPS {
                // The part of the unit circle below `-cos t` has the area `t - sin t cos t`.
                let (s, c) = (PI * k as f64 / STRIPS as f64).sin_cos();
                let chord = PI * k as f64 / STRIPS as f64 - s * c;
                let (middle, half) = (-0.5 * (c - low), 0.5 * (-c - low));
                let width = 0.5 * around * (chord - low_chord) / (-c - low);
                let share = mirrored(zeta, centre + across * middle, across * half, blur[1]);
                if share > 0.0 {
                    sum += share * turned(off, width, blur[0]);
                }
                (low, low_chord) = (-c, chord);
            }
            sum
        } else {
            let share = mirrored(zeta, centre, across, blur[1]);
            if share > 0.0 { share * turned(off, around, blur[0]) } else { 0.0 }
        };
        inside.clamp(0.0, 1.0)
    }
}

impl Feed {
    /// Refuses an opening that makes no sense.
    pub fn validate(&self) -> Result<(), OpeningError> {
        self.opening.validate()
    }
}

/// Writes the share of each cell that the openings cover together, `1 - Product (1 - cover)`, for cells at the points
/// `[phi, zeta]` and of the size `blur`; openings of the journal are turned by its angle.
pub fn covers(feeds: &[Feed], points: &[[f64; 2]], blur: [f64; 2], journal_angle_rad: f64, out: &mut [f64]) {
    assert_eq!(points.len(), out.len(), "one number per point");
    for (&[phi, zeta], out) in points.iter().zip(out) {
        let open = feeds.iter().fold(1.0, |open, feed| {
            let turn = if feed.on_journal { journal_angle_rad } else { 0.0 };
            open * (1.0 - feed.opening.cover(phi - turn, zeta, blur))
        });
        *out = 1.0 - open;
    }
}

/// Whether the cover changes while the journal turns; a groove all around the journal does not change it.
pub fn any_on_journal(feeds: &[Feed]) -> bool {
    feeds.iter().any(|feed| match feed.opening {
        Opening::CircumferentialGroove { extent_rad, .. } => feed.on_journal && extent_rad < TAU - ROUNDING,
        _ => feed.on_journal,
    })
}

/// Whether all openings are symmetric about the mid-plane, so that half a mesh suffices.
pub fn all_symmetric(feeds: &[Feed]) -> bool {
    feeds.iter().all(|feed| feed.opening.symmetric())
}

/// From 0 at `y = -1` to 1 at `y = 1` with two continuous derivatives; `step(y) + step(-y) = 1`, and the sum over a row
/// of points at the distance 1 grows evenly as the row moves.
fn step(y: f64) -> f64 {
    let rise = |t: f64| t * t * t * (1.0 - 0.5 * t);
    if y <= 0.0 { rise((1.0 + y).max(0.0)) } else { 1.0 - rise((1.0 - y).max(0.0)) }
}

/// The mask of the interval of half length `half` about 0.
fn interval(x: f64, half: f64, blur: f64) -> f64 {
    step((x + half) / blur) - step((x - half) / blur)
}

/// The mask of an interval around the bearing, for a point within half a turn of its middle.
fn turned(off: f64, half: f64, blur: f64) -> f64 {
    if half >= PI - ROUNDING {
        return 1.0;
    }
    interval(off, half, blur) + interval(off - TAU, half, blur) + interval(off + TAU, half, blur)
}

/// The mask of an interval across the bearing with its mirror images beyond the edges.
fn mirrored(zeta: f64, centre: f64, half: f64, blur: f64) -> f64 {
    let at = |z: f64| interval(z - centre, half, blur);
    at(zeta) + at(2.0 - zeta) + at(-2.0 - zeta)
}

#[cfg(test)]
mod tests;

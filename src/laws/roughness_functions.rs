//! The flow factors as functions of `H = gap/sigma` alone, each once continuously differentiable on the whole line.
//!
//! Below the limit of validity of a published formula (and in hard contact, `H < 0`) each function goes on along an
//! exponential of the same value and slope to a bounded value. That part is no measurement: it keeps Newton's method
//! and the gradients alive where the asperities carry the load.
//!
//! Deliberately not here: lengths, shares of the two surfaces, partial derivatives by anything but `H`.

use super::normal;
use super::partials::Slope;
use super::patir_cheng::{
    C, PRESSURE_STRESS, R, SHEAR, SHEAR_STRESS, VALID, interpolate, locate, smooth_step,
};

/// Width in `H` of the two blends: the branches of `Phi_s` pass into each other over `[5, 5 + BLEND_WIDTH]`, and
/// `Phi_fs` passes to zero over `[7 - BLEND_WIDTH, 7]`. Outside, the published formulas hold unchanged.
pub const BLEND_WIDTH: f64 = 0.5;
/// The flow gap of [`RoughFilm`](super::RoughFilm) stays above this multiple of the combined roughness.
pub const FLOW_GAP_FLOOR: f64 = 0.1;

/// Lower limit of the published shear and stress factors.
const LIMIT: f64 = 0.5;
/// `phi_x` of longitudinal valleys closing stays above this.
const PRESSURE_FLOOR: f64 = 1e-3;
/// Length in `H` over which factors without a natural limit level out.
const SETTLING: f64 = 0.25;

/// Goes on below `from` with the same value and slope and tends to a limit on the side the slope points to.
fn settling(h: f64, from: f64, (value, slope): Slope, limit: f64) -> Slope {
    let rate = slope / (value - limit);
    let rest = (value - limit) * (rate * (h - from)).exp();
    (limit + rest, rate * rest)
}

/// Goes on below `from` with the same value and slope and tends to zero, never reaching it.
fn fading(h: f64, from: f64, (value, slope): Slope) -> Slope {
    let rate = slope / value;
    let faded = value * (rate * (h - from)).exp();
    (faded, faded * rate)
}

/// `A H^a exp(-b H + c H^2)`.
fn hump([a, power, b, c]: [f64; 4], h: f64) -> Slope {
    let value = a * (power * h.ln() - b * h + c * h * h).exp();
    (value, value * (power / h - b + 2.0 * c * h))
}

/// Pressure flow factor `phi_x`. Between gamma = 1 and 3 the two formulas are mixed with a smooth step in `ln gamma`, so
/// that nothing jumps at 1 and both rows are met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pressure {
    /// `[C, r, limit]` of the formula up to gamma = 1.
    falling: [f64; 3],
    /// `[C, r, limit]` of the formula from gamma = 3.
    rising: [f64; 3],
    /// Share of the second formula.
    mix: f64,
}

impl Pressure {
    pub fn new(log_gamma: f64) -> Self {
        const ISOTROPIC: usize = 3;
        let rows = [C, R, VALID];
        let row = |k: usize| rows.map(|coefficient| coefficient[k]);
        let between = |first, last| interpolate(&rows, first, last, log_gamma);
        let (below, place) = locate(log_gamma);
        match below {
            0..ISOTROPIC => Self { falling: between(0, ISOTROPIC), rising: row(ISOTROPIC + 1), mix: 0.0 },
            ISOTROPIC => {
                Self { falling: row(ISOTROPIC), rising: row(ISOTROPIC + 1), mix: smooth_step(place).0 }
            }
            _ => Self { falling: row(ISOTROPIC), rising: between(ISOTROPIC + 1, 6), mix: 1.0 },
        }
    }

    pub fn at(&self, h: f64) -> Slope {
        let mut sum = (0.0, 0.0);
        for (share, part) in
            [(1.0 - self.mix, Self::falling(self.falling, h)), (self.mix, Self::rising(self.rising, h))]
        {
            sum = (sum.0 + share * part.0, sum.1 + share * part.1);
        }
        sum
    }

    fn falling([c, r, limit]: [f64; 3], h: f64) -> Slope {
        let lost = c * (-r * h.max(limit)).exp();
        let edge = (1.0 - lost, r * lost);
        if h >= limit { edge } else { settling(h, limit, edge, PRESSURE_FLOOR) }
    }

    fn rising([c, r, limit]: [f64; 3], h: f64) -> Slope {
        let held = h.max(limit);
        let gain = c * held.powf(-r);
        let edge = (1.0 + gain, -r * gain / held);
        if h >= limit { edge } else { settling(h, limit, edge, edge.0 - SETTLING * edge.1) }
    }
}

/// Shear flow factor `Phi_s` of one surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shear([f64; 5]);

impl Shear {
    pub fn new(log_gamma: f64) -> Self {
        Self(interpolate(&SHEAR, 0, 6, log_gamma))
    }

    pub fn at(&self, h: f64) -> Slope {
        let [a1, power, b, c, a2] = self.0;
        let near = |h: f64| hump([a1, power, b, c], h);
        if h < LIMIT {
            return fading(h, LIMIT, near(LIMIT));
        }
        let far = a2 * (-0.25 * h).exp();
        let (t, t_slope) = smooth_step((h - 5.0) / BLEND_WIDTH);
        if t >= 1.0 {
            return (far, -0.25 * far);
        }
        let (value, slope) = near(h);
        let lift = far - value;
        (value + t * lift, slope + t * (-0.25 * far - slope) + t_slope / BLEND_WIDTH * lift)
    }
}

/// `Phi_fs / H` of one surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ShearStress([f64; 4]);

impl ShearStress {
    pub fn new(log_gamma: f64) -> Self {
        let [a3, power, b, c] = interpolate(&SHEAR_STRESS, 0, 6, log_gamma);
        Self([a3, power - 1.0, b, c])
    }

    pub fn at(&self, h: f64) -> Slope {
        // Half the published limit: there all rows rise with H, so that the continuation fades.
        const FROM: f64 = 0.5 * LIMIT;
        if h < FROM {
            return fading(h, FROM, hump(self.0, FROM));
        }
        let (t, t_slope) = smooth_step((7.0 - h) / BLEND_WIDTH);
        if t <= 0.0 {
            return (0.0, 0.0);
        }
        let (value, slope) = hump(self.0, h);
        (t * value, t * slope - t_slope / BLEND_WIDTH * value)
    }
}

/// Pressure stress factor `phi_fp`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PressureStress([f64; 2]);

impl PressureStress {
    pub fn new(log_gamma: f64) -> Self {
        Self(interpolate(&PRESSURE_STRESS, 0, 6, log_gamma))
    }

    pub fn at(&self, h: f64) -> Slope {
        let [d, s] = self.0;
        let lost = d * (-s * h.max(LIMIT)).exp();
        let edge = (1.0 - lost, s * lost);
        if h >= LIMIT { edge } else { settling(h, LIMIT, edge, edge.0 - SETTLING * edge.1) }
    }
}

/// `phi_f / H`, the mean of `sigma / local gap` over a population of polynomial density on three sigmas either side
/// where the local gap exceeds `sigma / 100` (Patir and Cheng 1979). The formula for `H <= 3` holds down to `H = -3`; it
/// is used to -1 and fades below. Above 6, where it cancels, the series of the moments takes its place.
pub(super) fn couette(h: f64) -> Slope {
    const FROM: f64 = -1.0;
    let z = h / 3.0;
    if h < FROM {
        return fading(h, FROM, couette(FROM));
    }
    if z > 2.0 {
        return couette_far(z);
    }
    let s = 1.0 - z * z;
    let (value, slope) = if z <= 1.0 {
        let log = (300.0 * (z + 1.0)).ln();
        let rest = -55.0 + z * (132.0 + z * (345.0 + z * (-160.0 + z * (-405.0 + z * (60.0 + 147.0 * z)))));
        let rest_slope = 132.0 + z * (690.0 + z * (-480.0 + z * (-1620.0 + z * (300.0 + 882.0 * z))));
        (s.powi(3) * log + rest / 60.0, -6.0 * z * s * s * log + s * s * (1.0 - z) + rest_slope / 60.0)
    } else {
        let log = ((z + 1.0) / (z - 1.0)).ln();
        let z2 = z * z;
        let rest = z * (66.0 + z2 * (30.0 * z2 - 80.0));
        let rest_slope = 66.0 + z2 * (150.0 * z2 - 240.0);
        (s.powi(3) * log + rest / 15.0, -6.0 * z * s * s * log + 2.0 * s * s + rest_slope / 15.0)
    };
    (35.0 / 96.0 * value, 35.0 / 288.0 * slope)
}

/// `sum m_k z^(-2k-1) / 3` with the even moments of `(35/32) (1 - x^2)^3` on `[-1, 1]`.
fn couette_far(z: f64) -> Slope {
    let square = 1.0 / (z * z);
    let (mut term, mut odd, mut sum) = (1.0, 1.0, (0.0, 0.0));
    while term > 1e-18 {
        sum = (sum.0 + term, sum.1 + odd * term);
        term *= square * odd / (odd + 8.0);
        odd += 2.0;
    }
    (sum.0 / (3.0 * z), -sum.1 * square / 9.0)
}

/// Average gap over sigma of a Gaussian population, `H (1 + erf(H/sqrt 2))/2 + exp(-H^2/2)/sqrt(2 pi)`; its slope is the
/// contact factor of Wu and Zheng (1989) in exact form.
pub(super) fn average_gap(h: f64) -> Slope {
    let open = normal::upper_tail(-h);
    (normal::density(h) + h * open, open)
}

/// `H` down to 0.5, then settling to [`FLOW_GAP_FLOOR`].
pub(super) fn flow_gap(h: f64) -> Slope {
    if h >= LIMIT { (h, 1.0) } else { settling(h, LIMIT, (LIMIT, 1.0), FLOW_GAP_FLOOR) }
}

#[cfg(test)]
mod tests;

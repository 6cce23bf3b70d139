//! The published coefficients of the flow factors, interpolated between the Peklenik numbers of the tables.
//!
//! Deliberately not here: the functions of `H` the coefficients belong to.

use thiserror::Error;

/// Why a pair of surfaces has no flow factors.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RoughnessError {
    /// The tables end there.
    #[error("the Peklenik number must lie between 1/9 and 9 (found {0})")]
    Peklenik(f64),
    /// Two smooth surfaces need no flow factors.
    #[error("roughnesses must be finite, not negative and not both zero (found {0} m and {1} m)")]
    Sigma(f64, f64),
}

/// Natural logarithms of the Peklenik numbers of the tables: 1/9, 1/6, 1/3, 1, 3, 6, 9.
const NODES: [f64; 7] = [-LN_9, -LN_6, -LN_3, 0.0, LN_3, LN_6, LN_9];
const LN_3: f64 = 1.098_612_288_668_109_8;
const LN_6: f64 = 1.791_759_469_228_055;
const LN_9: f64 = 2.197_224_577_336_219_6;

/// `phi_x = 1 - C exp(-r H)` (gamma up to 1) or `1 + C H^-r` (gamma from 3), valid above a limit; Patir and Cheng 1978.
pub(super) const C: [f64; 7] = [1.48, 1.38, 1.18, 0.9, 0.225, 0.52, 0.87];
pub(super) const R: [f64; 7] = [0.42, 0.42, 0.42, 0.56, 1.5, 1.5, 1.5];
pub(super) const VALID: [f64; 7] = [1.0, 1.0, 0.75, 0.5, 0.5, 0.5, 0.5];
/// `Phi_s = A1 H^a1 exp(-a2 H + a3 H^2)` up to 5, `A2 exp(-0.25 H)` above; `[A1, a1, a2, a3, A2]`, Patir and Cheng 1979.
pub(super) const SHEAR: [[f64; 7]; 5] = [
    [2.046, 1.962, 1.858, 1.899, 1.560, 1.290, 1.011],
    [1.12, 1.08, 1.01, 0.98, 0.85, 0.62, 0.54],
    [0.78, 0.77, 0.76, 0.92, 1.13, 1.09, 1.07],
    [0.03, 0.03, 0.03, 0.05, 0.08, 0.08, 0.08],
    [1.856, 1.754, 1.561, 1.126, 0.556, 0.388, 0.295],
];
/// `Phi_fs = A3 H^a4 exp(-a5 H + a6 H^2)` below 7; `[A3, a4, a5, a6]`, Patir and Cheng 1979.
pub(super) const SHEAR_STRESS: [[f64; 7]; 4] = [
    [14.1, 13.4, 12.3, 11.1, 9.8, 10.1, 8.7],
    [2.45, 2.42, 2.32, 2.31, 2.25, 2.25, 2.15],
    [2.30, 2.30, 2.30, 2.38, 2.80, 2.90, 2.97],
    [0.10, 0.10, 0.10, 0.11, 0.18, 0.18, 0.18],
];
/// `phi_fp = 1 - D exp(-s H)`; `[D, s]`, Patir and Cheng 1979.
pub(super) const PRESSURE_STRESS: [[f64; 7]; 2] =
    [[1.51, 1.51, 1.47, 1.40, 0.98, 0.97, 0.73], [0.52, 0.54, 0.58, 0.66, 0.79, 0.91, 0.91]];

/// Logarithm of a Peklenik number inside the tables.
pub(super) fn log_peklenik(gamma: f64) -> Result<f64, RoughnessError> {
    let log = gamma.ln();
    if log.abs() <= LN_9 + 1e-9 { Ok(log) } else { Err(RoughnessError::Peklenik(gamma)) }
}

/// Index of the row below and the place (0 to 1) between it and the next.
pub(super) fn locate(log_gamma: f64) -> (usize, f64) {
    let row = NODES[1..6].iter().filter(|node| log_gamma >= **node).count();
    let place = (log_gamma - NODES[row]) / (NODES[row + 1] - NODES[row]);
    // A number printed as 1/3 is the row 1/3.
    let snapped = if (place - place.round()).abs() < 1e-12 { place.round() } else { place };
    (row, snapped.clamp(0.0, 1.0))
}

/// One coefficient at a Peklenik number: cubic Hermite in `ln gamma`, monotone between rows and once continuously
/// differentiable (Fritsch and Carlson 1980; slopes by the weighted harmonic mean), flat at the ends of the given rows.
pub(super) fn interpolate<const N: usize>(
    rows: &[[f64; 7]; N],
    first: usize,
    last: usize,
    log_gamma: f64,
) -> [f64; N] {
    let (row, place) = locate(log_gamma);
    let chord = |y: &[f64; 7], k: usize| (y[k + 1] - y[k]) / (NODES[k + 1] - NODES[k]);
    let slope = |y: &[f64; 7], k: usize| {
        if k == first || k == last {
            return 0.0;
        }
        let (left, right) = (chord(y, k - 1), chord(y, k));
        if left * right <= 0.0 {
            return 0.0;
        }
        let (a, b) = (NODES[k] - NODES[k - 1], NODES[k + 1] - NODES[k]);
        3.0 * (a + b) / ((2.0 * b + a) / left + (2.0 * a + b) / right)
    };
    std::array::from_fn(|c| {
        let y = &rows[c];
        let (t, width) = (place, NODES[row + 1] - NODES[row]);
        let rise = smooth_step(t).0;
        let bump = width * t * (1.0 - t) * (slope(y, row) * (1.0 - t) - slope(y, row + 1) * t);
        (1.0 - rise) * y[row] + rise * y[row + 1] + bump
    })
}

/// `3 t^2 - 2 t^3` and its slope, held at 0 and 1 outside.
pub(super) fn smooth_step(t: f64) -> (f64, f64) {
    let t = t.clamp(0.0, 1.0);
    (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_exactly_and_between_them_nothing_overshoots() {
        let gammas: [f64; 7] = [1.0 / 9.0, 1.0 / 6.0, 1.0 / 3.0, 1.0, 3.0, 6.0, 9.0];
        for (k, gamma) in gammas.iter().enumerate() {
            let found = interpolate(&SHEAR, 0, 6, log_peklenik(*gamma).unwrap());
            for c in 0..5 {
                assert_eq!(found[c], SHEAR[c][k]);
            }
        }
        for step in 1..600 {
            let log = NODES[0] + (NODES[6] - NODES[0]) * f64::from(step) / 600.0;
            let (row, _) = locate(log);
            for (c, value) in interpolate(&SHEAR_STRESS, 0, 6, log).into_iter().enumerate() {
                let (a, b) = (SHEAR_STRESS[c][row], SHEAR_STRESS[c][row + 1]);
                assert!(value >= a.min(b) - 1e-12 && value <= a.max(b) + 1e-12);
            }
        }
    }

    #[test]
    fn coefficients_have_one_slope_at_every_row() {
        for node in &NODES[1..6] {
            let at = |d: f64| interpolate(&SHEAR, 0, 6, node + d);
            let d = 1e-6;
            for c in 0..5 {
                let (left, right) = ((at(0.0)[c] - at(-d)[c]) / d, (at(d)[c] - at(0.0)[c]) / d);
                assert!((left - right).abs() < 1e-4, "{left} {right}");
            }
        }
        assert!(log_peklenik(0.1).is_err() && log_peklenik(9.1).is_err() && log_peklenik(f64::NAN).is_err());
    }
}

//! The four cubic B-splines that do not vanish at a point, in one coordinate: periodic around, clamped across.

use std::f64::consts::TAU;

/// Up to four coefficients with their weights at one point; weights of unused places are zero.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Span {
    /// Indices of the coefficients.
    pub index: [usize; 4],
    /// Values of their basis functions.
    pub value: [f64; 4],
    /// Derivatives of their basis functions; only filled around the circumference.
    pub slope: [f64; 4],
}

impl Span {
    /// One coefficient everywhere.
    fn constant() -> Self {
        Self { value: [1.0, 0.0, 0.0, 0.0], ..Self::default() }
    }

    /// `n >= 4` coefficients on even knots, coefficient `k` centred at `phi = 2 pi k / n`; or `n = 1`, a constant.
    pub fn around(n: usize, phi: f64) -> Self {
        if n == 1 {
            return Self::constant();
        }
        let (scale, share) = (n as f64 / TAU, phi.rem_euclid(TAU) * (n as f64 / TAU));
        // Rounding may lift an angle just below a full turn to the full turn.
        let i = (share as usize).min(n - 1);
        let t = share - i as f64;
        let r = 1.0 - t;
        Self {
            index: [(i + n - 1) % n, i, (i + 1) % n, (i + 2) % n],
            value: [
                r * r * r / 6.0,
                (4.0 + t * t * (3.0 * t - 6.0)) / 6.0,
                (4.0 + r * r * (3.0 * r - 6.0)) / 6.0,
                t * t * t / 6.0,
            ],
            slope: [
                -0.5 * r * r * scale,
                t * (1.5 * t - 2.0) * scale,
                -r * (1.5 * r - 2.0) * scale,
                0.5 * t * t * scale,
            ],
        }
    }

    /// `n >= 4` coefficients on the clamped knots of [`knot`]; or `n = 1`, a constant. Beyond the edges the edge counts.
    pub fn across(n: usize, zeta: f64) -> Self {
        if n == 1 {
            return Self::constant();
        }
        let zeta = zeta.clamp(-1.0, 1.0);
        let spans = n - 3;
        let at = 3 + ((0.5 * (zeta + 1.0) * spans as f64) as usize).min(spans - 1);
        // Cox and de Boor, upwards from degree 0 (Piegl and Tiller, The NURBS Book, algorithm A2.2).
        let mut value = [1.0, 0.0, 0.0, 0.0];
        for degree in 1..4 {
            let mut carried = 0.0;
            for (r, value) in value.iter_mut().enumerate().take(degree) {
                let (low, high) = (knot(n, at + 1 + r - degree), knot(n, at + 1 + r));
                let share = *value / (high - low);
                *value = carried + (high - zeta) * share;
                carried = (zeta - low) * share;
            }
            value[degree] = carried;
        }
        Self { index: [at - 3, at - 2, at - 1, at], value, slope: [0.0; 4] }
    }

    /// Mirrors `2 m - 1` coefficients about the middle one: coefficient `m - 1 + k` and `m - 1 - k` become `k`.
    pub fn mirrored(self, m: usize) -> Self {
        let mut folded = Self::default();
        let mut used = 0;
        for a in 0..4 {
            let index = self.index[a].abs_diff(m - 1);
            let at = folded.index[..used].iter().position(|&k| k == index).unwrap_or(used);
            used = used.max(at + 1);
            folded.index[at] = index;
            folded.value[at] += self.value[a];
        }
        folded
    }
}

/// Knot `i` of `n + 4`: four at `zeta = -1`, four at `zeta = 1`, the others even between them.
fn knot(n: usize, i: usize) -> f64 {
    2.0 * i.clamp(3, n) as f64 / (n as f64 - 3.0) - 6.0 / (n as f64 - 3.0) - 1.0
}

/// Where coefficient `i` of `n` stands across the width (its Greville abscissa, the mean of its three inner knots).
pub(super) fn greville(n: usize, i: usize) -> f64 {
    if n == 1 { 0.0 } else { (knot(n, i + 1) + knot(n, i + 2) + knot(n, i + 3)) / 3.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_basis_is_a_partition_of_unity_and_reproduces_lines_across() {
        for n in [1, 4, 5, 9, 16] {
            for i in 0..=200 {
                let (phi, zeta) = (0.05 * f64::from(i) - 3.0, 0.01 * f64::from(i) - 1.0);
                let (a, c) = (Span::around(n, phi), Span::across(n, zeta));
                for span in [a, c] {
                    assert!((span.value.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                    assert!(span.value.iter().all(|v| *v >= 0.0) && span.index.iter().all(|k| *k < n));
                }
                assert!(a.slope.iter().sum::<f64>().abs() < 1e-13);
                let line: f64 = (0..4).map(|k| c.value[k] * greville(n, c.index[k])).sum();
                assert!(n == 1 || (line - zeta).abs() < 1e-14, "{n} {zeta} {line}");
            }
        }
    }

    #[test]
    fn mirrored_spans_have_no_index_twice_and_agree_on_both_sides() {
        for m in 3..8 {
            for i in 0..=100 {
                let zeta = 0.01 * f64::from(i);
                let dense = |z: f64| {
                    let span = Span::across(2 * m - 1, z).mirrored(m);
                    let mut row = vec![0.0; m];
                    for a in 0..4 {
                        assert!(row[span.index[a]] == 0.0 || span.value[a] == 0.0);
                        row[span.index[a]] += span.value[a];
                    }
                    row
                };
                assert!(dense(zeta).iter().zip(dense(-zeta)).all(|(a, b)| (a - b).abs() < 1e-14));
            }
        }
    }
}

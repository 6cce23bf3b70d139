//! Bores of two halves: the lemon bore and the offset bore, with soft split lines.
//!
//! The sharp geometry has a kink (lemon) or a step (offset) at the split lines. A sharp line that moves over the cells
//! of a mesh makes everything a kinked or even discontinuous function of its angle, so within [`SPLIT_HALF_WIDTH`] of
//! a split line the sharp functions are replaced by polynomials that join with two continuous derivatives. Elsewhere
//! the geometry is exact.
//!
//! Deliberately not here: three and more lobes, the relief that real bores carry at the split (see `EdgeRelief` for the
//! outer edges and a spline for anything else).

/// Half of the width of the soft split line, as the cosine or sine of the angle from it (about 2.9 degrees).
pub const SPLIT_HALF_WIDTH: f64 = 0.05;

/// `|x|` and its first two derivatives, soft for `|x| < SPLIT_HALF_WIDTH`; 3/8 of that width instead of 0 at `x = 0`.
fn soft_abs(x: f64) -> [f64; 3] {
    let (w, t) = (SPLIT_HALF_WIDTH, x / SPLIT_HALF_WIDTH);
    if t.abs() >= 1.0 {
        return [x.abs(), x.signum(), 0.0];
    }
    let t2 = t * t;
    [w * (3.0 + t2 * (6.0 - t2)) / 8.0, t * (3.0 - t2) / 2.0, 1.5 * (1.0 - t2) / w]
}

/// `sign(x)` and its first two derivatives, soft for `|x| < SPLIT_HALF_WIDTH`.
fn soft_sign(x: f64) -> [f64; 3] {
    let (w, t) = (SPLIT_HALF_WIDTH, x / SPLIT_HALF_WIDTH);
    if t.abs() >= 1.0 {
        return [x.signum(), 0.0, 0.0];
    }
    let t2 = t * t;
    let rest = 1.0 - t2;
    [t * (15.0 + t2 * (3.0 * t2 - 10.0)) / 8.0, 15.0 * rest * rest / (8.0 * w), -7.5 * t * rest / (w * w)]
}

/// `1 - |cos x|` with its first two derivatives.
pub(super) fn lemon(x: f64) -> [f64; 3] {
    let (s, c) = x.sin_cos();
    let [a, a1, a2] = soft_abs(c);
    [1.0 - a, a1 * s, a1 * c - a2 * s * s]
}

/// `1 + sign(sin x) cos x` with its first two derivatives.
pub(super) fn offset(x: f64) -> [f64; 3] {
    let (s, c) = x.sin_cos();
    let [g, g1, g2] = soft_sign(s);
    [1.0 + g * c, g1 * c * c - g * s, g2 * c * c * c - 3.0 * g1 * c * s - g * c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_function_on_and_off_the_split_lines() {
        for f in [lemon, offset] {
            for i in 0..2000 {
                let (x, d) = (0.0031 * f64::from(i), 1e-6);
                let (low, mid, high) = (f(x - d), f(x), f(x + d));
                for k in 0..2 {
                    let slope = (high[k] - low[k]) / (2.0 * d);
                    assert!((slope - mid[k + 1]).abs() < 1e-4 * (1.0 + mid[k + 1].abs()), "{x} {k} {slope}");
                }
            }
        }
    }

    #[test]
    fn away_from_the_split_the_geometry_is_exact() {
        for i in 0..629 {
            let x = 0.01 * f64::from(i);
            if x.cos().abs() > SPLIT_HALF_WIDTH {
                assert_eq!(lemon(x)[0], 1.0 - x.cos().abs());
            }
            if x.sin().abs() > SPLIT_HALF_WIDTH {
                assert_eq!(offset(x)[0], 1.0 + x.sin().signum() * x.cos());
            }
        }
    }

    #[test]
    fn offset_halves_converge_in_the_direction_of_rotation() {
        for start in [0.0, std::f64::consts::PI] {
            assert!((1..29).all(|i| offset(start + 0.1 * f64::from(i) + 0.1)[1] < 0.0));
            assert!(offset(start + 0.06)[0] > 1.99 && offset(start + std::f64::consts::PI - 0.06)[0] < 0.01);
        }
    }
}

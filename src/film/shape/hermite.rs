//! Cubic Hermite polynomials on an uneven grid with the slopes of parabolas through three neighbours.

/// Weights of value and slope at the lower and at the upper end, and the derivatives of these weights.
pub(super) fn weights(low: f64, high: f64, x: f64) -> ([f64; 4], [f64; 4]) {
    let d = high - low;
    if d <= 0.0 {
        return ([1.0, 0.0, 0.0, 0.0], [0.0; 4]);
    }
    let t = (x - low) / d;
    let r = 1.0 - t;
    let bend = 6.0 * t * r / d;
    (
        [r * r * (1.0 + 2.0 * t), d * t * r * r, t * t * (3.0 - 2.0 * t), -d * t * t * r],
        [-bend, r * (1.0 - 3.0 * t), bend, t * (3.0 * t - 2.0)],
    )
}

/// Slopes along `x` on each of `lines` lines, by the parabola through three neighbours; periodic if there is a period.
pub(super) fn slopes(
    f: &[f64],
    at: impl Fn(usize, usize) -> usize,
    lines: usize,
    x: &[f64],
    period: Option<f64>,
) -> Vec<f64> {
    let n = x.len();
    let mut out = vec![0.0; f.len()];
    if n == 1 {
        return out;
    }
    for line in 0..lines {
        // Length and slope of the interval that starts at grid line `i`.
        let interval = |i: usize| {
            let d = if i + 1 < n { x[i + 1] - x[i] } else { x[0] + period.unwrap_or(0.0) - x[i] };
            (d, (f[at(line, (i + 1) % n)] - f[at(line, i)]) / d)
        };
        for i in 0..n {
            out[at(line, i)] = if period.is_none() && n == 2 {
                interval(0).1
            } else if period.is_none() && (i == 0 || i == n - 1) {
                let (near, far) =
                    if i == 0 { (interval(0), interval(1)) } else { (interval(n - 2), interval(n - 3)) };
                near.1 + (near.1 - far.1) * near.0 / (near.0 + far.0)
            } else {
                let (before, after) = (interval((i + n - 1) % n), interval(i));
                (before.1 * after.0 + after.1 * before.0) / (before.0 + after.0)
            };
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_of_a_parabola_are_exact_and_those_of_a_periodic_line_know_the_period() {
        let x = [0.0, 0.4, 1.0, 3.0];
        let f: Vec<f64> = x.iter().map(|x| 1.0 - 2.0 * x + 3.0 * x * x).collect();
        let s = slopes(&f, |_, i| i, 1, &x, None);
        assert!(s.iter().zip(x).all(|(s, x)| (s - (6.0 * x - 2.0)).abs() < 1e-13));
        let s = slopes(&[0.0, 1.0, 1.0], |_, i| i, 1, &[0.0, 1.0, 2.0], Some(4.0));
        assert!((s[0] - (2.0 - 0.5) / 3.0).abs() < 1e-15 && (s[1] - 0.5).abs() < 1e-15);
        assert_eq!(slopes(&[1.0, 3.0], |_, i| i, 1, &[0.0, 1.0], None), [2.0, 2.0]);
    }
}

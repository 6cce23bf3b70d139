//! Two kernels of dense algebra.

/// `y += a x`; nothing happens for `a = 0`, which rows of cavitated cells make use of.
pub(super) fn axpy(y: &mut [f64], a: f64, x: &[f64]) {
    if a != 0.0 {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
    }
}

/// `a . b` over what both have, in four partial sums, so that the additions do not wait for each other.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let shared = a.len().min(b.len());
    let (a, b) = (&a[..shared], &b[..shared]);
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; 4];
    for (a, b) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::dot;

    #[test]
    fn a_product_takes_every_entry_that_both_have() {
        let ones = [1.0; 9];
        for (m, n) in [(0, 3), (3, 4), (7, 8), (8, 7), (9, 9)] {
            assert_eq!(dot(&ones[..m], &ones[..n]), m.min(n) as f64);
        }
    }
}

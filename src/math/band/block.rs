//! What elimination does with one group of four rows: its `4 x 4` diagonal block and the rows' own remainders.

use super::kernels::{Arithmetic, update};

/// Four rows of `n` entries; row `q` starts at `at - q * skew` of its storage.
#[inline(always)]
pub(super) fn rows_of(storage: &mut [f64], w: usize, at: usize, skew: usize, n: usize) -> [&mut [f64]; 4] {
    let (r0, rest) = storage.split_at_mut(w);
    let (r1, rest) = rest.split_at_mut(w);
    let (r2, r3) = rest.split_at_mut(w);
    [
        &mut r0[at..at + n],
        &mut r1[at - skew..at - skew + n],
        &mut r2[at - 2 * skew..at - 2 * skew + n],
        &mut r3[at - 3 * skew..at - 3 * skew + n],
    ]
}

/// What stands on and above the diagonal; below it are the multipliers of `L`.
#[inline(always)]
pub(super) fn upper_inverse(block: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    let mut upper = [[0.0; 4]; 4];
    for p in 0..4 {
        for c in p..4 {
            upper[p][c] = block[p][c];
        }
    }
    upper
}

/// Replaces four entries of two rows by their multipliers, `entries * U^-1`; `None` if all are zero.
#[inline(always)]
pub(super) fn multipliers<A: Arithmetic>(
    first: &mut [f64],
    second: &mut [f64],
    inverse: &[[f64; 4]; 4],
) -> Option<[[f64; 4]; 2]> {
    let mut any = 0;
    for p in 0..4 {
        any |= magnitude(first[p]) | magnitude(second[p]);
    }
    if any == 0 {
        return None;
    }
    let mut m = [[0.0; 4]; 2];
    for (m, entries) in m.iter_mut().zip([first, second]) {
        for p in 0..4 {
            for c in 0..4 {
                m[c] = A::minus(m[c], -entries[p], inverse[p][c]);
            }
        }
        entries.copy_from_slice(m);
    }
    Some(m)
}

/// Completes rows 1 to 3 of a group right of its diagonal block; returns the range, in whole vectors, that
/// holds anything but zeros.
#[inline(always)]
pub(super) fn eliminate_inside<A: Arithmetic>(rows: [&mut [f64]; 4], t: &[[f64; 4]; 4]) -> (usize, usize) {
    let [r0, r1, r2, r3] = rows;
    if t[1][0] != 0.0 {
        update::<A, 1, 1>([r1], [[t[1][0]]], [r0]);
    }
    if t[2][0] != 0.0 || t[2][1] != 0.0 {
        update::<A, 2, 1>([r2], [[t[2][0], t[2][1]]], [r0, r1]);
    }
    if t[3][0] != 0.0 || t[3][1] != 0.0 || t[3][2] != 0.0 {
        update::<A, 3, 1>([r3], [[t[3][0], t[3][1], t[3][2]]], [r0, r1, r2]);
    }
    let rows: [&[f64]; 4] = [r0, r1, r2, r3];
    let (mut first, mut end) = (0, rows[0].len());
    while first < end && !occupied(rows, first) {
        first += 4;
    }
    while end > first && !occupied(rows, end - 4) {
        end -= 4;
    }
    if first < end { (first, end) } else { (0, 0) }
}

/// Whether any of four rows has anything but zeros in the vector at `c`.
#[inline(always)]
fn occupied(rows: [&[f64]; 4], c: usize) -> bool {
    let mut any = [0; 4];
    for row in rows {
        let vector = &row[c..c + 4];
        for lane in 0..4 {
            any[lane] |= magnitude(vector[lane]);
        }
    }
    any[0] | any[1] | any[2] | any[3] != 0
}

/// The bits of `v` but its sign: zero for both zeros only.
#[inline(always)]
fn magnitude(v: f64) -> u64 {
    v.to_bits() << 1
}

/// Strictly below the diagonal the inverse of the unit `L`, on and above it the inverse of `U`.
#[inline(always)]
pub(super) fn inverses<A: Arithmetic>(t: &[[f64; 4]; 4], reciprocal: &[f64; 4]) -> [[f64; 4]; 4] {
    let mut v = [[0.0; 4]; 4];
    for c in 0..4 {
        v[c][c] = reciprocal[c];
        for p in (0..c).rev() {
            let mut sum = 0.0;
            for s in p + 1..=c {
                sum = A::minus(sum, t[p][s], v[s][c]);
            }
            v[p][c] = sum * reciprocal[p];
        }
        for q in c + 1..4 {
            let mut sum = -t[q][c];
            for s in c + 1..q {
                sum = A::minus(sum, t[q][s], v[s][c]);
            }
            v[q][c] = sum;
        }
    }
    v
}

//! The same few operations on every entry of many arrays, in vector instructions.
//!
//! A compiler that cannot prove that arrays lie apart does not vectorise a loop over a dozen of them. Here results are gathered in
//! a block on the stack, which nothing else can reach, and copied out once the block is full. The operations are rounded
//! the same on every processor: no fused multiply-add.

use super::band::kernels::{Arithmetic, Job, fastest};

/// Entries of a block: results of a dozen arrays stay in the first cache.
const BLOCK: usize = 16;

/// What is done with the entries at one place.
pub(crate) trait Lane<const IN: usize, const OUT: usize> {
    /// Results from inputs; has to be `#[inline(always)]`.
    fn at(&self, input: [f64; IN]) -> [f64; OUT];
}

struct Sweep<'a, L, const IN: usize, const OUT: usize> {
    lane: &'a L,
    input: [&'a [f64]; IN],
    output: [&'a mut [f64]; OUT],
}

/// Writes what `lane` makes of each place. All arrays have the length of the first result.
pub(crate) fn sweep<L: Lane<IN, OUT>, const IN: usize, const OUT: usize>(
    lane: &L,
    input: [&[f64]; IN],
    output: [&mut [f64]; OUT],
) {
    fastest(Sweep { lane, input, output });
}

impl<L: Lane<IN, OUT>, const IN: usize, const OUT: usize> Job for Sweep<'_, L, IN, OUT> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        let Self { lane, input, output } = self;
        let n = output[0].len();
        let input = input.map(|x| &x[..n]);
        for k in (0..n - n % BLOCK).step_by(BLOCK) {
            let inputs: [&[f64; BLOCK]; IN] = std::array::from_fn(|a| {
                (&input[a][k..k + BLOCK]).try_into().expect("a block is as long as a block")
            });
            let mut found = [[0.0; BLOCK]; OUT];
            for i in 0..BLOCK {
                let values = lane.at(inputs.map(|x| x[i]));
                for a in 0..OUT {
                    found[a][i] = values[a];
                }
            }
            for a in 0..OUT {
                output[a][k..k + BLOCK].copy_from_slice(&found[a]);
            }
        }
        for k in n - n % BLOCK..n {
            let values = lane.at(input.map(|x| x[k]));
            for a in 0..OUT {
                output[a][k] = values[a];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct SumAndProduct;

    impl Lane<2, 2> for SumAndProduct {
        #[inline(always)]
        fn at(&self, [a, b]: [f64; 2]) -> [f64; 2] {
            [a + b, a * b]
        }
    }

    #[test]
    fn every_entry_is_visited_once_whatever_the_length() {
        for n in [0, 1, 15, 16, 17, 40] {
            let a: Vec<f64> = (0..n).map(|k| k as f64).collect();
            let b: Vec<f64> = a.iter().map(|a| 0.1 * a - 3.0).collect();
            let (mut sum, mut product) = (vec![f64::NAN; n], vec![f64::NAN; n]);
            sweep(&SumAndProduct, [&a, &b], [&mut sum, &mut product]);
            for k in 0..n {
                assert_eq!((sum[k], product[k]), (a[k] + b[k], a[k] * b[k]));
            }
        }
    }
}

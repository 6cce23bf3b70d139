//! `P_alpha`: the friction loss that takes wear into account, approximated by a weighted mean over few moments of the march.
//!
//! ```text
//! P_wear = E / T       over the blocks of the march
//! P_alpha = sum_g alpha_g (P(w_g) + P(w_g + h_g k_g)),    alpha_g = h_g / 2T      over groups g of consecutive blocks, each one step of Heun's
//! ```
//!
//! A group takes in blocks as long as the surfaces change their own speed of wear little: `h_g max L <= 1` with
//! `L = max|k2 - k1| / (h max|k1|)` of a block, the rate at which wear slows itself down. Heun's method is stable up to 2, and
//! behind 1 it says nothing. What the approximation errs by is measured against the march itself.

use super::field::{largest, moved};
use super::march::{Block, March};
use super::stage::{MarchOptions, Stage};

/// Largest change of the speed of wear, as a share of itself, over a group.
const LARGEST_CHANGE: f64 = 1.0;

/// The groups of a march: shares of the duration of each stage, for [`replay`](super::replay).
pub fn approximation(march: &March, stages: &[Stage], options: &MarchOptions) -> Vec<Vec<f64>> {
    let of = |(k, stage): (usize, &Stage)| {
        let mut groups: Vec<(f64, f64)> = Vec::new();
        for block in march.blocks.iter().filter(|b| b.stage == k) {
            let slowing = slowing(block, options);
            let joined = groups.last().map(|(h, rate)| (h + block.length_s, slowing.max(*rate)));
            match joined.filter(|(h, rate)| h * rate <= LARGEST_CHANGE) {
                Some(joined) => *groups.last_mut().expect("there is a group to join") = joined,
                None => groups.push((block.length_s, slowing)),
            }
        }
        groups.iter().map(|(h, _)| h / stage.duration_s).collect()
    };
    stages.iter().enumerate().map(of).collect()
}

/// The rate at which wear slows itself down in a block, 1/s.
fn slowing(block: &Block, options: &MarchOptions) -> f64 {
    let [k1, k2] = [0, 1].map(|r| options.depths(&block.rates[r]));
    let speed = largest(&k1);
    if speed > 0.0 { largest(&moved(&k2, -1.0, &k1)) / (block.length_s * speed) } else { 0.0 }
}

/// The weights `alpha` of the groups: with the losses at both ends of each they make the mean.
pub fn weights(shares: &[Vec<f64>], durations_s: &[f64]) -> Vec<f64> {
    let lengths =
        shares.iter().zip(durations_s).flat_map(|(own, duration_s)| own.iter().map(move |s| s * duration_s));
    let lengths: Vec<f64> = lengths.collect();
    let total: f64 = lengths.iter().sum();
    lengths.iter().map(|h| h / (2.0 * total)).collect()
}

//! Starts spread over a box: a Latin hypercube (McKay, Beckman and Conover 1979).

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// `count` points in a unit box: along every direction each of `count` equal slices holds exactly one. The same seed gives the
/// same points.
pub fn latin_hypercube(count: usize, directions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut points = vec![vec![0.0; directions]; count];
    for j in 0..directions {
        let mut slices: Vec<usize> = (0..count).collect();
        slices.shuffle(&mut random);
        for (point, slice) in points.iter_mut().zip(slices) {
            point[j] = (slice as f64 + random.random::<f64>()) / count as f64;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slice_holds_one_point_and_a_seed_gives_the_same_points() {
        let points = latin_hypercube(20, 3, 7);
        for j in 0..3 {
            let mut slices: Vec<usize> = points.iter().map(|p| (p[j] * 20.0) as usize).collect();
            slices.sort_unstable();
            assert!(slices.into_iter().eq(0..20));
        }
        assert_eq!(points, latin_hypercube(20, 3, 7));
        assert_ne!(points, latin_hypercube(20, 3, 8));
    }
}

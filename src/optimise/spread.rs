//! Points spread over a box: a Latin hypercube (McKay, Beckman and Conover 1979) and Sobol's sequence (1967) with the scrambling of
//! Owen (1995) as hashed by Burley (2020).

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

/// `count` points of Sobol's sequence in a unit box, scrambled: every dyadic interval gets its share of the points, and the first of more
/// points are the same. The same seed gives the same points; at most 256 directions.
pub fn sobol(count: usize, directions: usize, seed: u64) -> Vec<Vec<f64>> {
    let seed = (seed ^ (seed >> 32)) as u32;
    let at = |n: usize, j: usize| f64::from(sobol_burley::sample(n as u32, j as u32, seed));
    (0..count).map(|n| (0..directions).map(|j| at(n, j)).collect()).collect()
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

    #[test]
    fn sobol_points_fill_every_dyadic_interval_alike() {
        let points = sobol(64, 4, 3);
        for j in 0..4 {
            for intervals in [2usize, 8, 64] {
                let mut counts = vec![0; intervals];
                points.iter().for_each(|p| counts[(p[j] * intervals as f64) as usize] += 1);
                assert!(counts.iter().all(|c| *c == 64 / intervals), "direction {j}: {counts:?}");
            }
        }
        assert_eq!(points[..32], sobol(32, 4, 3)[..]);
        assert_ne!(points, sobol(64, 4, 4));
    }
}

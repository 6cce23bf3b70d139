//! The film's linear system: our cyclic band solver against faer's sparse LU with forced supernodal factors.
//!
//!     cargo bench --bench film
//!
//! Both factorise and solve the same matrices, flooded and half cavitated, forwards and transposed. faer is given the
//! entries that are not zero. Quote ratios, not times.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::PartialPivLuParams;
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::linalg::{SupernodalThreshold, lu::LuRef};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Spec};
use std::f64::consts::TAU;
use std::hint::black_box;
use stribeck::math::{CyclicBand, Stencil};

const MESHES: [(usize, usize); 4] = [(72, 9), (72, 17), (144, 25), (360, 41)];
const COLUMNS: usize = 4;

/// A Newton matrix of Reynolds' equation on `n x b` cells in the gap `h = 1 - 0.8 cos phi` with sliding towards larger
/// `phi`. Cells in full film couple to all neighbours, by conductances that grow with pressure (which makes the matrix
/// nonsymmetric) and by the upwind part of the Couette flow; cavitated cells only hand the film on from the cell before.
fn film_matrix(n: usize, b: usize, cavitated: bool) -> Stencil {
    let gap = |i: usize| 1.0 - 0.8 * (TAU * i as f64 / n as f64).cos();
    let (around, along) = ((n as f64 / TAU).powi(2), (b as f64).powi(2));
    let mut a = Stencil::zeros(n * b);
    for k in 0..n * b {
        let (i, j) = (k / b, k % b);
        let (west, here, east) = (gap(i + n - 1), gap(i), gap(i + 1));
        let couette = 0.1 * n as f64;
        a.west[k] = -couette * west;
        a.diagonal[k] = couette * here + 1.0;
        if cavitated && (i == 0 || 2 * i >= n) {
            continue;
        }
        let face = |h: f64| ((here + h) / 2.0).powi(3);
        let tilt = 0.05 * (i as f64 / n as f64 * TAU).sin();
        a.west[k] -= around * face(west) * (1.0 - tilt);
        a.east[k] = -around * face(east) * (1.0 + tilt);
        a.south[k] = if j > 0 { -along * here.powi(3) * (1.0 - tilt) } else { 0.0 };
        a.north[k] = if j + 1 < b { -along * here.powi(3) * (1.0 + tilt) } else { 0.0 };
        a.diagonal[k] += around * (face(west) + face(east)) + 2.0 * along * here.powi(3);
    }
    a
}

fn sparse(a: &Stencil, n: usize, b: usize) -> SparseColMat<usize, f64> {
    let len = n * b;
    let mut entries = Vec::new();
    for k in 0..len {
        let (i, j) = (k / b, k % b);
        let neighbours = [
            (k, a.diagonal[k]),
            ((i + n - 1) % n * b + j, a.west[k]),
            ((i + 1) % n * b + j, a.east[k]),
            (k.saturating_sub(1), a.south[k]),
            (k + 1, a.north[k]),
        ];
        let coupled = neighbours.into_iter().filter(|&(_, value)| value != 0.0);
        entries.extend(coupled.map(|(column, value)| Triplet::new(k, column, value)));
    }
    SparseColMat::try_new_from_triplets(len, len, &entries).expect("indices are in range")
}

fn own(c: &mut Criterion, name: &str, a: &Stencil, n: usize, b: usize, rhs: &[f64]) {
    let mut group = c.benchmark_group("band");
    let mut band = CyclicBand::new(n, b);
    band.factor(a).expect("the matrix is regular");
    group.bench_function(BenchmarkId::new("factor", name), |t| t.iter(|| band.factor(black_box(a))));
    // Every solve starts from the same right-hand side: solutions of solutions would soon be denormal numbers.
    let (mut x, one) = (rhs.to_vec(), n * b);
    group.bench_function(BenchmarkId::new("solve", name), |t| {
        t.iter(|| {
            x[..one].copy_from_slice(&rhs[..one]);
            band.solve(black_box(&mut x[..one]));
        });
    });
    group.bench_function(BenchmarkId::new("transposed", name), |t| {
        t.iter(|| {
            x[..one].copy_from_slice(&rhs[..one]);
            band.solve_transposed(black_box(&mut x[..one]));
        });
    });
    group.bench_function(BenchmarkId::new("solve 4", name), |t| {
        t.iter(|| {
            x.copy_from_slice(rhs);
            band.solve(black_box(&mut x));
        });
    });
    group.finish();
}

fn faer(c: &mut Criterion, name: &str, a: &Stencil, n: usize, b: usize, rhs: &[f64]) {
    let mut group = c.benchmark_group("faer");
    let matrix = sparse(a, n, b);
    let params = LuSymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let symbolic = factorize_symbolic_lu(matrix.symbolic(), params).expect("symbolic factors");
    let mut numeric = NumericLu::new();
    let lu_params: Spec<PartialPivLuParams, f64> = Spec::default();
    let mut memory = MemBuffer::new(
        symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, lu_params)
            .or(symbolic.solve_in_place_scratch::<f64>(COLUMNS, Par::Seq))
            .or(symbolic.solve_transpose_in_place_scratch::<f64>(COLUMNS, Par::Seq)),
    );
    let mut factor = || {
        let stack = MemStack::new(&mut memory);
        let spec = Spec::default();
        symbolic.factorize_numeric_lu(&mut numeric, matrix.as_ref(), Par::Seq, stack, spec).is_ok()
    };
    // Once in any case: criterion may be told to run the solves only.
    assert!(factor(), "faer factorises");
    group.bench_function(BenchmarkId::new("factor", name), |t| t.iter(|| black_box(factor())));
    let lu = LuRef::new_unchecked(&symbolic, &numeric);
    let (mut x, one) = (rhs.to_vec(), n * b);
    for (what, columns, transposed) in
        [("solve", 1, false), ("transposed", 1, true), ("solve 4", COLUMNS, false)]
    {
        group.bench_function(BenchmarkId::new(what, name), |t| {
            t.iter(|| {
                let x = &mut x[..one * columns];
                x.copy_from_slice(&rhs[..one * columns]);
                let side = MatMut::from_column_major_slice_mut(x, one, columns);
                let stack = MemStack::new(&mut memory);
                if transposed {
                    lu.solve_transpose_in_place_with_conj(Conj::No, side, Par::Seq, stack);
                } else {
                    lu.solve_in_place_with_conj(Conj::No, side, Par::Seq, stack);
                }
            });
        });
    }
    group.finish();
}

fn benches(c: &mut Criterion) {
    for (n, b) in MESHES {
        let rhs: Vec<f64> = (0..n * b * COLUMNS).map(|i| (i as f64).sin()).collect();
        for (film, cavitated) in [("flooded", false), ("half cavitated", true)] {
            let name = format!("{n}x{b} {film}");
            let a = film_matrix(n, b, cavitated);
            own(c, &name, &a, n, b, &rhs);
            faer(c, &name, &a, n, b, &rhs);
        }
    }
}

criterion_group!(film, benches);
criterion_main!(film);

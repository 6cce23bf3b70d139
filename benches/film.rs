//! The film's linear system: our cyclic band solver against faer's sparse LU with forced supernodal factors.
//!
//!     cargo bench --bench film
//!
//! Both factorise and solve the matrix of the same half-ruptured film, forwards and transposed. Quote ratios, not times.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::PartialPivLuParams;
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::linalg::{SupernodalThreshold, lu::LuRef};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Spec};
use std::hint::black_box;
use stribeck::film::{Axial, FilmInput, FilmModel, Mesh, Reynolds, steady};
use stribeck::math::{CyclicBand, Stencil};

const MESHES: [(usize, usize); 4] = [(72, 9), (72, 17), (144, 25), (360, 41)];

fn film_matrix(n: usize, b: usize) -> Stencil {
    let film = Reynolds::new(Mesh::new(n, b, Axial::Full));
    let u = FilmInput::at_rest(0.8, 0.05, 0.1, 50e-6, 0.01, 100.0);
    let q = steady(&film, &u).expect("the film settles").q;
    let mut a = Stencil::zeros(n * b);
    film.stencil(&u, &q, &mut a);
    a
}

fn sparse(a: &Stencil, n: usize, b: usize) -> SparseColMat<usize, f64> {
    let len = n * b;
    let mut entries = Vec::new();
    for k in 0..len {
        let (i, j) = (k / b, k % b);
        entries.push(Triplet::new(k, k, a.diagonal[k]));
        entries.push(Triplet::new(k, (i + n - 1) % n * b + j, a.west[k]));
        entries.push(Triplet::new(k, (i + 1) % n * b + j, a.east[k]));
        if j > 0 {
            entries.push(Triplet::new(k, k - 1, a.south[k]));
        }
        if j + 1 < b {
            entries.push(Triplet::new(k, k + 1, a.north[k]));
        }
    }
    SparseColMat::try_new_from_triplets(len, len, &entries).expect("indices are in range")
}

fn benches(c: &mut Criterion) {
    for (n, b) in MESHES {
        let name = format!("{n}x{b}");
        let a = film_matrix(n, b);
        let rhs: Vec<f64> = (0..n * b).map(|i| (i as f64).sin()).collect();
        let mut own = CyclicBand::new(n, b);
        let mut group = c.benchmark_group("film");
        group
            .bench_function(BenchmarkId::new("band factor", &name), |t| t.iter(|| own.factor(black_box(&a))));
        let mut x = rhs.clone();
        group.bench_function(BenchmarkId::new("band solve", &name), |t| {
            t.iter(|| own.solve(black_box(&mut x)))
        });
        group.bench_function(BenchmarkId::new("band transposed", &name), |t| {
            t.iter(|| own.solve_transposed(black_box(&mut x)));
        });

        let matrix = sparse(&a, n, b);
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
                .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq))
                .or(symbolic.solve_transpose_in_place_scratch::<f64>(1, Par::Seq)),
        );
        group.bench_function(BenchmarkId::new("faer factor", &name), |t| {
            t.iter(|| {
                let stack = MemStack::new(&mut memory);
                let factors = symbolic.factorize_numeric_lu(
                    &mut numeric,
                    matrix.as_ref(),
                    Par::Seq,
                    stack,
                    Spec::default(),
                );
                black_box(factors.is_ok())
            });
        });
        let lu = LuRef::new_unchecked(&symbolic, &numeric);
        let mut y = rhs.clone();
        group.bench_function(BenchmarkId::new("faer solve", &name), |t| {
            t.iter(|| {
                let side = MatMut::from_column_major_slice_mut(&mut y, n * b, 1);
                lu.solve_in_place_with_conj(Conj::No, side, Par::Seq, MemStack::new(&mut memory));
            });
        });
        group.bench_function(BenchmarkId::new("faer transposed", &name), |t| {
            t.iter(|| {
                let side = MatMut::from_column_major_slice_mut(&mut y, n * b, 1);
                lu.solve_transpose_in_place_with_conj(Conj::No, side, Par::Seq, MemStack::new(&mut memory));
            });
        });
        group.finish();
    }
}

criterion_group!(film, benches);
criterion_main!(film);

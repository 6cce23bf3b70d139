//! Both solves against a dense `L U` with pivoting, for films of every shape of cavitation.

use super::kernels::{Job, Plain};
use super::*;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// How a cell couples: in full film to all four neighbours, cavitated to its upwind neighbour, or held.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Cell {
    Film,
    West,
    East,
    Held,
}

/// A stencil with the couplings of `cells` and values from `noise`, and the same as a dense matrix.
fn matrix(n: usize, b: usize, cells: &[Cell], noise: &[f64]) -> (Stencil, DMatrix<f64>) {
    let len = n * b;
    let mut a = Stencil::zeros(len);
    let mut dense = DMatrix::zeros(len, len);
    for k in 0..len {
        let (i, j) = (k / b, k % b);
        let v = |s: usize| 0.1 + noise[(k * 5 + s) % noise.len()].abs();
        let cell = cells[k];
        if cell == Cell::Film {
            a.south[k] = if j > 0 { -v(2) } else { 0.0 };
            a.north[k] = if j + 1 < b { -v(3) } else { 0.0 };
        }
        a.west[k] = if matches!(cell, Cell::Film | Cell::West) { -v(0) } else { 0.0 };
        a.east[k] = if matches!(cell, Cell::Film | Cell::East) { -v(1) } else { 0.0 };
        a.diagonal[k] = 0.05 + 1.1 * v(4) - a.west[k] - a.east[k] - a.south[k] - a.north[k];
        let at = |i: usize, j: usize| i % n * b + j;
        dense[(k, k)] += a.diagonal[k];
        dense[(k, at(i + n - 1, j))] += a.west[k];
        dense[(k, at(i + 1, j))] += a.east[k];
        if j > 0 {
            dense[(k, k - 1)] += a.south[k];
        }
        if j + 1 < b {
            dense[(k, k + 1)] += a.north[k];
        }
    }
    (a, dense)
}

/// Full film, with rectangles (cyclic in the first direction) of other cells laid over it.
fn cells(n: usize, b: usize, regions: &[(usize, usize, usize, usize, u8)]) -> Vec<Cell> {
    let mut cells = vec![Cell::Film; n * b];
    for &(i0, wide, j0, high, kind) in regions {
        for i in (i0..i0 + wide).map(|i| i % n) {
            for j in j0.min(b)..(j0 + high).min(b) {
                cells[i * b + j] = [Cell::West, Cell::East, Cell::Held][kind as usize];
            }
        }
    }
    cells
}

/// Compares with the dense solution, with the instructions of this processor and with those every processor has.
fn check(solver: &mut CyclicBand, a: &Stencil, dense: &DMatrix<f64>, columns: usize) {
    let len = a.diagonal.len();
    let rhs = DMatrix::from_fn(len, columns, |i, c| 1.0 + ((i + 3 * c) as f64 * 0.7).sin());
    solver.factor(a).unwrap();
    let mut plain = solver.clone();
    eliminate::Eliminate { to: &mut plain, a }.run::<Plain>().unwrap();
    for transposed in [false, true] {
        let truth = if transposed { dense.transpose() } else { dense.clone() }.lu().solve(&rhs).unwrap();
        let mut x = rhs.as_slice().to_vec();
        let mut y = x.clone();
        if transposed {
            solver.solve_transposed(&mut x)
        } else {
            solver.solve(&mut x)
        }
        substitute::Solve { by: &plain, rhs: &mut y, spacing: len, transposed }.run::<Plain>();
        for x in [x, y] {
            let error = (DVector::from_vec(x) - DVector::from_column_slice(truth.as_slice())).amax();
            assert!(error < 1e-10 * truth.amax(), "transposed {transposed}: {error:e}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn agrees_with_a_dense_solver(
        n in 3usize..10, b in 1usize..7, columns in 1usize..6,
        noise in prop::collection::vec(-1.0f64..1.0, 37),
        regions in prop::collection::vec((0usize..9, 1usize..8, 0usize..6, 1usize..7, 0u8..3), 0..4),
        later in prop::collection::vec((0usize..9, 1usize..8, 0usize..1, 6usize..7, 0u8..3), 0..3),
    ) {
        // The same solver twice: nothing of the first pattern of zeros may survive.
        let mut solver = CyclicBand::new(n, b);
        for regions in [regions, later] {
            let (a, dense) = matrix(n, b, &cells(n, b, &regions), &noise);
            check(&mut solver, &a, &dense, columns);
        }
    }

    #[test]
    fn scattered_cells_are_no_obstacle(
        n in 3usize..10, b in 1usize..7,
        noise in prop::collection::vec(-1.0f64..1.0, 37),
        kinds in prop::collection::vec(0u8..4, 64),
    ) {
        let cells: Vec<Cell> = (0..n * b)
            .map(|k| [Cell::Film, Cell::West, Cell::East, Cell::Held][kinds[k % kinds.len()] as usize])
            .collect();
        let (a, dense) = matrix(n, b, &cells, &noise);
        check(&mut CyclicBand::new(n, b), &a, &dense, 2);
    }
}

#[test]
fn wide_blocks_agree() {
    let noise: Vec<f64> = (0..37).map(|i| (i as f64 * 1.3).sin()).collect();
    for b in [9, 17, 24] {
        let n = 12;
        // Flooded; cavitated across, sliding either way; cavitated in the middle only; an open groove.
        for regions in
            [&[][..], &[(4, 5, 0, b, 0)], &[(4, 5, 0, b, 1)], &[(4, 5, 2, b - 5, 0)], &[(7, 1, 0, b, 2)]]
        {
            let (a, dense) = matrix(n, b, &cells(n, b, regions), &noise);
            let mut solver = CyclicBand::new(n, b);
            check(&mut solver, &a, &dense, 4);
        }
    }
}

#[test]
fn a_singular_matrix_is_reported() {
    let mut solver = CyclicBand::new(3, 2);
    assert!(solver.factor(&Stencil::zeros(6)).is_err());
    // All rows sum to zero: only the constant is undetermined, and only the last pivot shows it.
    let mut a = Stencil::zeros(6);
    a.diagonal.fill(3.0);
    a.west.fill(-1.0);
    a.east.fill(-1.0);
    (0..3).for_each(|i| (a.north[2 * i], a.south[2 * i + 1]) = (-1.0, -1.0));
    assert!(solver.factor(&a).is_err());
    a.diagonal[0] = f64::NAN;
    assert!(solver.factor(&a).is_err());
}

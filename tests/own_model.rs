//! Models of one's own through the public ladder: the example of the crate page on `dae`, held against its closed form; a
//! pendulum with constraints; and the check of a ladder, on these and on a bearing.

mod ladder;
mod mobility;
mod pendulum;

use nalgebra::Complex;
use stribeck::dae::InvalidParameters;
use stribeck::gradient::verdict;

// The example begins here.
use std::error::Error;
use std::f64::consts::TAU;
use stribeck::dae::{Dense, Equations, Instant, Number, Sizes};
use stribeck::gradient::{EngineName, GradientTable, TaylorRow, check_ladder, engine, taylor_table};
use stribeck::orbit::{Orbit, OrbitOptions, Quantity, Reduction, Scheme, settle};
use stribeck::run::Cancel;

/// A source `V cos(w t)` feeds a capacitor and, beside it, a resistor in series with an inductor.
#[derive(Clone)]
struct Circuit {
    frequency_hz: f64,
}

impl Equations for Circuit {
    fn sizes(&self) -> Sizes {
        Sizes { states: 3, memories: 2, outputs: 2 }
    }

    fn period_s(&self) -> f64 {
        1.0 / self.frequency_hz
    }

    /// Voltage of the capacitor, current through the inductor, current out of the source.
    fn state_scale(&self) -> Vec<f64> {
        vec![10.0, 1.0, 1.0]
    }

    /// Charge of the capacitor, flux of the inductor.
    fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]) {
        let ([u, i, _], [], [_, _, inductance, capacitance]) = at.parts();
        memory.copy_from_slice(&[capacitance * u, inductance * i]);
    }

    /// Currents at the node, voltages around the branch, and what the source prescribes.
    fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]) {
        let ([u, i, source], [charge_rate, flux_rate], [amplitude, resistance, _, _]) = at.parts();
        residual[0] = charge_rate + i - source;
        residual[1] = flux_rate + resistance * i - u;
        residual[2] = u - amplitude * (TAU * self.frequency_hz * at.t_s).cos();
    }

    /// Power into the resistor, power out of the source.
    fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]) {
        let ([u, i, source], [_, _], [_, resistance, _, _]) = at.parts();
        output.copy_from_slice(&[resistance * i * i, u * source]);
    }
}

/// The settled cycle, the gradient of its powers by each engine, and how the remainders of the last one fall.
struct Found {
    orbit: Orbit,
    tables: Vec<GradientTable>,
    checks: Vec<Vec<TaylorRow>>,
}

fn five_engines() -> Result<Found, Box<dyn Error>> {
    // 12 V at 50 Hz, 4 ohm, 20 mH, 100 uF.
    let model = Dense::new(Circuit { frequency_hz: 50.0 }, &[12.0, 4.0, 20e-3, 100e-6])?;
    let cancel = Cancel::default();
    let options = OrbitOptions {
        steps: 200,
        scheme: Scheme::Bdf2,
        periodicity_tolerance: 1e-13,
        max_cycles: 100,
        memory_bytes: 1 << 30,
    };
    let orbit = settle(&model, &options, None, &cancel)?;
    let mean = |output| Quantity { output, reduction: Reduction::Mean };
    let powers = [mean(0), mean(1)];
    println!("{} W, {} W", orbit.value(&powers[0]), orbit.value(&powers[1]));
    // One row per power, one column per parameter, by FW, BW, CEN, TRA and ADJ.
    let mut tables = Vec::new();
    for name in EngineName::ALL {
        let table = engine(name, 1e-6).gradient(&model, &orbit, &options, &powers, &cancel)?;
        println!("{}: {:?}", name.as_str(), table.rows);
        tables.push(table);
    }
    // The remainder of the last one falls with order 2 along this direction, if it is right.
    let along = [1.0, -0.5, 0.8, 0.3];
    let checks = taylor_table(&model, &orbit, &options, &powers, &tables[4], &along, (1e-2, 5), &cancel)?;
    for row in check_ladder(&model, &orbit)? {
        assert!(row.holds(), "{row:?}");
    }
    Ok(Found { orbit, tables, checks })
}
// The example ends here.

/// Mean powers (resistor, source) and their derivatives by `V, R, L, C`, with `d` in place of `i w`:
/// `P = V^2 R / (2 |R + d L|^2)` and `V^2 Re(1 / (R + d L) + d C) / 2`.
///
/// With `d = i w` these are the powers of every textbook on alternating currents (Nilsson and Riedel, *Electric Circuits*,
/// ch. 10): `V^2 R / (2 (R^2 + w^2 L^2))` both. With the symbol of BDF2 they are exact for the discrete cycle. A loop of a source
/// and a capacitor makes the index 2 (Estevez Schwarz and Tischendorf 2000).
fn closed_form(d: Complex<f64>, [v, r, l, c]: [f64; 4]) -> ([f64; 2], [[f64; 4]; 2]) {
    let z = d * l + r;
    let (z2, half) = (z.norm_sqr(), v * v / 2.0);
    let (into, out) = (half * r / z2, half * (z.inv() + d * c).re);
    let by_r = half * (1.0 / z2 - 2.0 * r * z.re / (z2 * z2));
    let by_l = -half * r * 2.0 * (z.conj() * d).re / (z2 * z2);
    let inv2 = (z * z).inv();
    (
        [into, out],
        [
            [2.0 * into / v, by_r, by_l, 0.0],
            [2.0 * out / v, -half * inv2.re, -half * (d * inv2).re, half * d.re],
        ],
    )
}

const AT: [f64; 4] = [12.0, 4.0, 20e-3, 100e-6];

/// `(3/2 - 2 q + q^2/2) / h` with `q = exp(-i w h)`.
fn symbol(steps: usize) -> Complex<f64> {
    let turn = TAU / steps as f64;
    let back = |k: f64| Complex::from_polar(1.0, -k * turn);
    (Complex::from(1.5) - back(1.0) * 2.0 + back(2.0) * 0.5) * (50.0 * steps as f64)
}

/// Largest error of a gradient, each entry relative to its power and parameter.
fn error(rows: &[Vec<f64>], powers: &[f64; 2], truth: &[[f64; 4]; 2]) -> f64 {
    let entry = |q: usize, j: usize| ((rows[q][j] - truth[q][j]) * AT[j] / powers[q]).abs();
    (0..8).map(|k| entry(k / 4, k % 4)).fold(0.0, f64::max)
}

#[test]
fn a_circuit_of_index_two_has_the_gradient_of_its_closed_form_by_all_engines() {
    let Found { orbit, tables, checks } = five_engines().unwrap();
    let (powers, slopes) = closed_form(symbol(200), AT);
    for (q, power) in powers.iter().enumerate() {
        let miss = (orbit.mean(q) / power - 1.0).abs();
        println!("mean {q}: {miss:.1e}");
        assert!(miss < 1e-12, "{} {power}", orbit.mean(q));
    }
    // A neighbour of a finite difference is settled to 1e-7 of its perturbation.
    for ((name, table), allowed) in EngineName::ALL.iter().zip(&tables).zip([1e-5, 1e-5, 1e-7, 1e-11, 1e-11])
    {
        let miss = error(&table.rows, &powers, &slopes);
        println!("{name:?}: {miss:.1e}, closure {:.1e}", table.closure);
        assert!(miss < allowed, "{name:?}: {miss:.1e}");
    }
    for check in &checks {
        assert!(verdict(check).starts_with("exact: the remainder falls"), "{check:#?}");
    }
}

#[test]
fn the_gradient_of_the_circuit_nears_the_textbook_with_order_two() {
    let (powers, slopes) = closed_form(Complex::new(0.0, TAU * 50.0), AT);
    let miss = |steps: usize| {
        let model = Dense::new(Circuit { frequency_hz: 50.0 }, &AT).unwrap();
        let options = OrbitOptions { steps, ..options() };
        let orbit = settle(&model, &options, None, &Cancel::default()).unwrap();
        error(&gradient(EngineName::Adj, &model, &orbit, &options, &MEANS).rows, &powers, &slopes)
    };
    let (coarse, middle, fine) = (miss(100), miss(200), miss(400));
    let orders = [(coarse / middle).log2(), (middle / fine).log2()];
    println!("{coarse:.2e} {middle:.2e} {fine:.2e}: orders {orders:?}");
    assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.1) && fine < 1e-3);
}

const MEANS: [Quantity; 2] =
    [Quantity { output: 0, reduction: Reduction::Mean }, Quantity { output: 1, reduction: Reduction::Mean }];

fn options() -> OrbitOptions {
    OrbitOptions {
        steps: 200,
        scheme: Scheme::Bdf2,
        periodicity_tolerance: 1e-13,
        max_cycles: 400,
        memory_bytes: 1 << 30,
    }
}

fn gradient<E: Equations>(
    name: EngineName,
    model: &Dense<E>,
    orbit: &Orbit,
    options: &OrbitOptions,
    of: &[Quantity],
) -> GradientTable {
    engine(name, 1e-5).gradient(model, orbit, options, of, &Cancel::default()).unwrap()
}

/// The circuit whose resistor warms up: `R = R_20 (1 + a (T - 20 C))`. The temperature is a cycle unknown, `T = 20 C + R_th P`.
#[derive(Clone)]
struct WarmCircuit(Circuit);

impl WarmCircuit {
    /// Rise of the resistance per kelvin (copper).
    const RISE: f64 = 3.93e-3;

    /// The parameters of the cold circuit: `V, R, L, C`.
    fn cold<T: Number>(p: &[T]) -> [T; 4] {
        [p[0], p[1] * (p[5] * Self::RISE + 1.0), p[2], p[3]]
    }
}

/// Parameters: `V`, `R_20`, `L`, `C`, thermal resistance in K/W, temperature above 20 C in K.
impl Equations for WarmCircuit {
    fn sizes(&self) -> Sizes {
        self.0.sizes()
    }

    fn period_s(&self) -> f64 {
        self.0.period_s()
    }

    fn state_scale(&self) -> Vec<f64> {
        self.0.state_scale()
    }

    fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]) {
        self.0.memory(Instant { p: &Self::cold(at.p), ..at }, memory);
    }

    fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]) {
        self.0.residual(Instant { p: &Self::cold(at.p), ..at }, residual);
    }

    fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]) {
        self.0.output(Instant { p: &Self::cold(at.p), ..at }, output);
    }

    fn check(&self, p: &[f64]) -> Result<(), InvalidParameters> {
        let resistance = Self::cold(p)[1];
        if resistance > 0.0 { Ok(()) } else { Err(InvalidParameters("no resistance is left".to_owned())) }
    }

    fn cycle_unknowns(&self) -> usize {
        1
    }

    fn cycle_outputs(&self) -> Vec<usize> {
        vec![0]
    }

    fn cycle_residual<T: Number>(&self, means: &[T], p: &[T], residual: &mut [T]) {
        residual[0] = p[5] - p[4] * means[0];
    }
}

#[test]
fn cycle_unknowns_of_ones_own_are_found_and_differentiated() {
    let start = [12.0, 4.0, 20e-3, 100e-6, 3.0, 10.0];
    let model = Dense::new(WarmCircuit(Circuit { frequency_hz: 50.0 }), &start).unwrap();
    let orbit = settle(&model, &options(), None, &Cancel::default()).unwrap();
    let warm = WarmCircuit::cold(&orbit.parameters);
    let (powers, slopes) = closed_form(symbol(200), warm);
    assert!((orbit.parameters[5] / (3.0 * powers[0]) - 1.0).abs() < 1e-11);
    // P(V, R_20 (1 + a R_th P), L): the chain rule on the closed form.
    let [by_v, by_r, by_l, by_c] = slopes[0];
    let answer = 1.0 - by_r * 4.0 * WarmCircuit::RISE * 3.0;
    let by_heat = by_r * 4.0 * WarmCircuit::RISE * powers[0];
    let truth = [by_v, by_r * warm[1] / 4.0, by_l, by_c, by_heat].map(|g| g / answer);
    for (name, allowed) in [(EngineName::Tra, 1e-10), (EngineName::Adj, 1e-10), (EngineName::Cen, 1e-7)] {
        let rows = gradient(name, &model, &orbit, &options(), &MEANS[..1]).rows;
        let miss = |j: usize| ((rows[0][j] - truth[j]) * start[j] / powers[0]).abs();
        let worst = (0..5).map(miss).fold(0.0, f64::max);
        println!("{name:?}: {worst:.1e}, {} K", orbit.parameters[5]);
        assert!(worst < allowed && rows[0].len() == 5, "{name:?}: {worst:.1e}");
    }
    ladder::assert_sound("warm circuit", &check_ladder(&model, &orbit).unwrap());
    assert!(model.equations().check(&[12.0, -4.0, 20e-3, 100e-6, 3.0, 10.0]).is_err());
}

#[test]
fn the_example_in_the_documentation_is_the_one_that_is_tested() {
    crate::common::assert_example("tests/own_model.rs", "src/dae/mod.rs", 60);
}

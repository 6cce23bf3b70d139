//! The ladder of abilities of a periodic, parameter-dependent, implicit differential-algebraic system.
//!
//! ```text
//! F(t, z, m'; p) = 0,   m = M(t, z; p),   z(t + T) = z(t),        outputs  y = g(t, z, m'; p)
//! ```
//!
//! The *memory* `m` is what the system remembers: positions, velocities, the oil content of a cell (a function of fill
//! and gap). Only its rate enters, so a balance written with it is conserved by any difference formula to rounding.
//! A model climbs as far as it needs: [`Dae`] can be evaluated, [`LinearisedDae`] can be stepped implicitly,
//! [`SensitiveDae`] can be differentiated forwards and backwards. The orbit and gradient floors work on these traits
//! and know no state by name, so a bearing, a train of bearings or a user's own model get the same treatment.
//!
//! **Cycle unknowns** are numbers that are constant over the cycle but not given (the temperature of a film): the last
//! of the parameters, with one equation each between the cycle means of the outputs, `R(mean y, p) = 0`.
//!
//! Derivatives leave as products with vectors, never as full matrices: `F_p` may have hundreds of columns.
//! Deliberately not here: how `m'` is discretised (see [`crate::orbit`]).
//!
//! # A model of your own
//!
//! A small model need not climb by hand: write its equations once as functions of any [`Number`] ([`Equations`]), and [`Dense`]
//! makes all three steps of the ladder of them, with exact derivatives by dual numbers. Systems of index up to 2 are welcome. The
//! period must not depend on the parameters. An alternating current circuit, its mean powers, their gradient by all five
//! engines and two proofs of it:
//!
//! ```no_run
//! use std::error::Error;
//! use std::f64::consts::TAU;
//! use stribeck::dae::{Dense, Equations, Instant, Number, Sizes};
//! use stribeck::gradient::{EngineName, GradientTable, TaylorRow, check_ladder, engine, taylor_table};
//! use stribeck::orbit::{Orbit, OrbitOptions, Quantity, Reduction, Scheme, settle};
//! use stribeck::run::Cancel;
//!
//! /// A source `V cos(w t)` feeds a capacitor and, beside it, a resistor in series with an inductor.
//! #[derive(Clone)]
//! struct Circuit {
//!     frequency_hz: f64,
//! }
//!
//! impl Equations for Circuit {
//!     fn sizes(&self) -> Sizes {
//!         Sizes { states: 3, memories: 2, outputs: 2 }
//!     }
//!
//!     fn period_s(&self) -> f64 {
//!         1.0 / self.frequency_hz
//!     }
//!
//!     /// Voltage of the capacitor, current through the inductor, current out of the source.
//!     fn state_scale(&self) -> Vec<f64> {
//!         vec![10.0, 1.0, 1.0]
//!     }
//!
//!     /// Charge of the capacitor, flux of the inductor.
//!     fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]) {
//!         let ([u, i, _], [], [_, _, inductance, capacitance]) = at.parts();
//!         memory.copy_from_slice(&[capacitance * u, inductance * i]);
//!     }
//!
//!     /// Currents at the node, voltages around the branch, and what the source prescribes.
//!     fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]) {
//!         let ([u, i, source], [charge_rate, flux_rate], [amplitude, resistance, _, _]) = at.parts();
//!         residual[0] = charge_rate + i - source;
//!         residual[1] = flux_rate + resistance * i - u;
//!         residual[2] = u - amplitude * (TAU * self.frequency_hz * at.t_s).cos();
//!     }
//!
//!     /// Power into the resistor, power out of the source.
//!     fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]) {
//!         let ([u, i, source], [_, _], [_, resistance, _, _]) = at.parts();
//!         output.copy_from_slice(&[resistance * i * i, u * source]);
//!     }
//! }
//!
//! /// The settled cycle, the gradient of its powers by each engine, and how the remainders of the last one fall.
//! struct Found {
//!     orbit: Orbit,
//!     tables: Vec<GradientTable>,
//!     checks: Vec<Vec<TaylorRow>>,
//! }
//!
//! fn five_engines() -> Result<Found, Box<dyn Error>> {
//!     // 12 V at 50 Hz, 4 ohm, 20 mH, 100 uF.
//!     let model = Dense::new(Circuit { frequency_hz: 50.0 }, &[12.0, 4.0, 20e-3, 100e-6])?;
//!     let cancel = Cancel::default();
//!     let options = OrbitOptions {
//!         steps: 200,
//!         scheme: Scheme::Bdf2,
//!         periodicity_tolerance: 1e-13,
//!         max_cycles: 100,
//!         memory_bytes: 1 << 30,
//!     };
//!     let orbit = settle(&model, &options, None, &cancel)?;
//!     let mean = |output| Quantity { output, reduction: Reduction::Mean };
//!     let powers = [mean(0), mean(1)];
//!     println!("{} W, {} W", orbit.value(&powers[0]), orbit.value(&powers[1]));
//!     // One row per power, one column per parameter, by FW, BW, CEN, TRA and ADJ.
//!     let mut tables = Vec::new();
//!     for name in EngineName::ALL {
//!         let table = engine(name, 1e-6).gradient(&model, &orbit, &options, &powers, &cancel)?;
//!         println!("{}: {:?}", name.as_str(), table.rows);
//!         tables.push(table);
//!     }
//!     // The remainder of the last one falls with order 2 along this direction, if it is right.
//!     let along = [1.0, -0.5, 0.8, 0.3];
//!     let checks = taylor_table(&model, &orbit, &options, &powers, &tables[4], &along, (1e-2, 5), &cancel)?;
//!     for row in check_ladder(&model, &orbit)? {
//!         assert!(row.holds(), "{row:?}");
//!     }
//!     Ok(Found { orbit, tables, checks })
//! }
//! ```
//!
//! The lines are those of `tests/own_model.rs`, where the result is held against its closed form. A ladder written by hand
//! (a sparse or a large model) is checked product by product with [`crate::gradient::check_ladder`].

mod dense;
mod differentiate;
mod equations;
mod lu;

pub use dense::Dense;
pub use differentiate::{DenseFactors, DensePoint, DenseRoom};
pub use equations::{Equations, Instant, Number, Sizes};

use crate::math::Singular;
use thiserror::Error;

/// A parameter vector for which the model does not exist (say, a clearance below zero).
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{0}")]
pub struct InvalidParameters(pub String);

/// A periodic implicit system that can be evaluated.
pub trait Dae: Send + Sync {
    /// Length of `z`.
    fn states(&self) -> usize;
    /// Length of `m`.
    fn memories(&self) -> usize;
    /// The parameters `p` at which this model stands, SI units; cycle unknowns come last.
    fn parameters(&self) -> &[f64];
    /// Size of a change of a parameter that counts as order one: its own size, unless it is zero.
    fn parameter_scale(&self, j: usize) -> f64 {
        let size = self.parameters()[j].abs();
        if size > 0.0 { size } else { 1.0 }
    }
    /// Length of the period in seconds.
    fn period_s(&self) -> f64;
    /// Number of outputs.
    fn outputs(&self) -> usize;
    /// A state to start the transient from.
    fn cold_start(&self) -> Vec<f64>;
    /// Writes `M(t, z)`.
    fn memory(&self, t_s: f64, z: &[f64], m: &mut [f64]);
    /// Writes `F(t, z, m')` to `residual`.
    fn residual(&self, at: At, residual: &mut [f64]);
    /// Writes the outputs to `y`.
    fn output(&self, at: At, y: &mut [f64]);
    /// Size of a change `dz` of the state in units in which 1 is a change of order one.
    fn change(&self, z: &[f64], dz: &[f64]) -> f64;
    /// Size of a change of the memory in the same units.
    fn memory_change(&self, dm: &[f64]) -> f64;
    /// The same model at other parameters.
    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters>
    where
        Self: Sized;
    /// Equations of the cycle unknowns; none by default.
    fn cycle(&self) -> Option<&dyn CycleEquations> {
        None
    }
}

/// Equations `R(mean y, p) = 0` that fix the last parameters.
pub trait CycleEquations: Send + Sync {
    /// Number of cycle unknowns.
    fn unknowns(&self) -> usize;
    /// Outputs whose cycle means enter.
    fn outputs(&self) -> Vec<usize>;
    /// `R`, given the means in the order of [`Self::outputs`].
    fn residual(&self, means: &[f64], p: &[f64]) -> Vec<f64>;
    /// `dR/dmean` and `dR/dp`, one row per equation.
    fn slopes(&self, means: &[f64], p: &[f64]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>);
    /// A first guess of `dR/dunknown` in total, one row per equation: how the means answer included.
    fn guess(&self, means: &[f64], p: &[f64]) -> Vec<Vec<f64>>;
    /// Size of a change of each unknown that counts as order one.
    fn scale(&self) -> Vec<f64>;
}

/// A system whose steps can be solved by Newton's method, and whose factorised steps carry changes of the memory on.
pub trait LinearisedDae: Dae {
    /// Factors of `F_z + alpha F_m' M_z` with `F_m'` and `M_z`: all that a step needs to carry changes on, and no more,
    /// because a whole cycle of them may be kept.
    type Factors: Send + Sync;
    /// Workspace of a linearisation.
    type Room: Send;
    /// Room for factors.
    fn factors(&self) -> Self::Factors;
    /// Room for factors that are kept while others are made: no larger than need be.
    fn keeper(&self) -> Self::Factors {
        self.factors()
    }
    /// Moves or copies factors into a keeper; what was made may be overwritten then.
    fn keep(&self, made: &mut Self::Factors, keeper: &mut Self::Factors) {
        std::mem::swap(made, keeper);
    }
    /// Largest size of one step's factors.
    fn factor_bytes(&self) -> usize;
    /// A workspace.
    fn room(&self) -> Self::Room;
    /// Writes memory and residual at the rate `alpha M(t, z) + past` and factorises `F_z + alpha F_m' M_z` there.
    fn linearise(
        &self,
        step: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        room: &mut Self::Room,
        into: &mut Self::Factors,
    ) -> Result<(), Singular>;
    /// Like [`Self::linearise`], but `residual` leaves as the solution with the matrix: what Newton's method takes off the
    /// state. Worth writing where a first solve comes cheaper together with the factors.
    fn newton(
        &self,
        step: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        room: &mut Self::Room,
        into: &mut Self::Factors,
    ) -> Result<(), Singular> {
        self.linearise(step, memory, residual, room, into)?;
        self.solve(into, residual);
        Ok(())
    }
    /// Writes memory and residual of a step alone, without its matrix.
    fn balance(&self, step: Step, memory: &mut [f64], residual: &mut [f64], _room: &mut Self::Room) {
        self.memory(step.t_s, step.z, memory);
        let rate: Vec<f64> = memory.iter().zip(step.past).map(|(m, past)| step.alpha * m + past).collect();
        self.residual(At { t_s: step.t_s, z: step.z, rate: &rate }, residual);
    }
    /// Replaces each column of `rhs` by the solution with the factorised matrix.
    fn solve(&self, factors: &Self::Factors, rhs: &mut [f64]);
    /// `out += F_m' rate`.
    fn rate_times(&self, factors: &Self::Factors, rate: &[f64], out: &mut [f64]);
    /// `dm += M_z dz`.
    fn memory_times(&self, factors: &Self::Factors, dz: &[f64], dm: &mut [f64]);
    /// Continues the last step: changes the state `z` (the last one) towards a guess of the next, given the one before
    /// it. By default the last state is the guess.
    fn predict(&self, _before: &[f64], _z: &mut [f64]) {}
    /// Improves the guess `step.z`, handed over in `z`, by whatever the model knows about itself; whether it found one.
    /// Called where Newton's method fails. The step is solved by the stepper all the same.
    fn rescue(&self, _step: Step, _z: &mut [f64]) -> bool {
        false
    }
    /// Whether the model is defined at a state.
    fn contains(&self, _z: &[f64]) -> bool {
        true
    }
    /// Largest fraction of the Newton step `dz` that stays where the model is defined, at most 1.
    fn admissible(&self, _z: &[f64], _dz: &[f64]) -> f64 {
        1.0
    }
    /// Adds a share of a Newton step to the state. A piecewise smooth model may stop parts of it where their piece ends.
    fn advance(&self, z: &mut [f64], dz: &[f64], share: f64) {
        z.iter_mut().zip(dz).for_each(|(z, d)| *z += share * d);
    }
}

/// A system that can be differentiated by states, rates and parameters, in both directions.
///
/// The parameters act at every instant through the same **fields** `u(p)`: scalars such as a clearance, the shape of a gap
/// on every cell. Derivatives by the fields are gathered along a trajectory and brought to the parameters once, so that
/// neither the number of parameters nor their meaning costs anything per step. By default the fields are the parameters.
pub trait SensitiveDae: LinearisedDae {
    /// What the derivatives at one point of a trajectory rest on, so that many of them share its evaluation; `()` will do.
    type Point: Send + Sync;
    /// Room for a point.
    fn point(&self) -> Self::Point;
    /// Evaluates a point.
    fn fix(&self, at: At, into: &mut Self::Point);
    /// Evaluates what [`Self::push`] and [`Self::pull`] rest on, where the derivatives of the outputs will not be asked for.
    fn fix_balance(&self, at: At, into: &mut Self::Point) {
        self.fix(at, into);
    }
    /// Factorises `F_z + alpha F_m' M_z` at a point of a trajectory.
    fn factor(
        &self,
        at: At,
        alpha: f64,
        room: &mut Self::Room,
        into: &mut Self::Factors,
    ) -> Result<(), Singular>;
    /// Replaces each column of `rhs` by the solution with the transposed matrix.
    fn solve_transposed(&self, factors: &Self::Factors, rhs: &mut [f64]);
    /// `rate += F_m'^T v`.
    fn rate_cotangent(&self, factors: &Self::Factors, v: &[f64], rate: &mut [f64]);
    /// `z += M_z^T w`.
    fn memory_cotangent(&self, factors: &Self::Factors, w: &[f64], z: &mut [f64]);
    /// Number of fields.
    fn fields(&self) -> usize {
        self.parameters().len()
    }
    /// `du = u_p dp`.
    fn field_tangent(&self, dp: &[f64], du: &mut [f64]) {
        du.copy_from_slice(dp);
    }
    /// `p += u_p^T u`.
    fn field_cotangent(&self, u: &[f64], p: &mut [f64]) {
        p.iter_mut().zip(u).for_each(|(p, u)| *p += u);
    }
    /// Writes `F_u du` and `M_u du`.
    fn push(&self, point: &Self::Point, at: At, du: &[f64], residual: &mut [f64], memory: &mut [f64]);
    /// `u += F_u^T v + M_u^T w`.
    fn pull(&self, point: &Self::Point, at: At, v: &[f64], w: &[f64], u: &mut [f64]);
    /// Writes `dy = g_z dz + g_m' drate + g_u du`.
    fn output_tangent(&self, point: &Self::Point, at: At, direction: Direction, dy: &mut [f64]);
    /// How many local outputs there are: one for each of many places, asked for as means over the cycle only. None by default.
    fn locals(&self) -> usize {
        0
    }
    /// Adds a share of the change of every local output along a direction to `sums`.
    fn add_local_tangent(&self, _: &Self::Point, _: At, _: Direction, _share: f64, _sums: &mut [f64]) {}
    /// Adds `g_z^T w`, `g_m'^T w` and `g_u^T w` to the three parts of `out`.
    fn output_cotangent(&self, point: &Self::Point, at: At, w: &[f64], out: Cotangent);
}

/// A point of a trajectory.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// Time in seconds.
    pub t_s: f64,
    /// State.
    pub z: &'a [f64],
    /// Rate of the memory.
    pub rate: &'a [f64],
}

/// A point of an implicit step: the rate follows from the state.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Time in seconds.
    pub t_s: f64,
    /// State.
    pub z: &'a [f64],
    /// Weight of the new memory in its rate, 1/s.
    pub alpha: f64,
    /// Share of the older memories in the rate.
    pub past: &'a [f64],
}

/// A direction in states, rates and fields.
#[derive(Debug, Clone, Copy)]
pub struct Direction<'a> {
    /// Change of the state.
    pub z: &'a [f64],
    /// Change of the rate of the memory.
    pub rate: &'a [f64],
    /// Change of the fields.
    pub u: &'a [f64],
}

/// Where the transposed derivatives of outputs are added up.
#[derive(Debug)]
pub struct Cotangent<'a> {
    /// By states.
    pub z: &'a mut [f64],
    /// By rates of the memory.
    pub rate: &'a mut [f64],
    /// By fields.
    pub u: &'a mut [f64],
}

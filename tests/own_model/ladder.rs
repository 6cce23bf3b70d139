//! The check of a ladder: sound models pass, a wrong product is told by its name.

use crate::common::{COARSE, main_study, quietly, smooth_study};
use stribeck::dae::{
    At, Cotangent, Dae, Dense, DenseFactors, DensePoint, DenseRoom, Direction, InvalidParameters,
    LinearisedDae, SensitiveDae, Step,
};
use stribeck::gradient::{EngineName, LadderRow, check_ladder};
use stribeck::math::Singular;
use stribeck::orbit::settle;
use stribeck::study::{Study, plan};

pub fn assert_sound(name: &str, rows: &[LadderRow]) {
    for row in rows {
        println!("{name}: {} / {}: {:.1e}", row.product, row.against, row.mismatch);
    }
    let wrong: Vec<&LadderRow> = rows.iter().filter(|r| !r.holds()).collect();
    assert!(wrong.is_empty(), "{name}: {wrong:#?}");
}

fn check_bearing(name: &str, study: &Study) {
    quietly(|run| {
        let plan = plan(study, EngineName::Adj, run).unwrap();
        let case = &plan.problem.cases()[0];
        let orbit = settle(&case.model, &study.orbit, None, run.cancel).unwrap();
        assert_sound(name, &check_ladder(&case.model, &orbit).unwrap());
    });
}

#[test]
fn the_ladder_of_a_bearing_is_sound() {
    check_bearing("smooth bearing", &smooth_study(&[("[oil]", COARSE)]));
    check_bearing("main bearing", &main_study(&[("[oil]", COARSE)]));
}

/// A product that is wrong.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Push,
    Pull,
    SolveTransposed,
    RateTimes,
    MemoryCotangent,
    OutputTangent,
    OutputCotangent,
    Linearise,
}

/// The circuit with one fault.
struct Faulty(Dense<super::Circuit>, Option<Fault>);

impl Faulty {
    fn spoils(&self, fault: Fault, first: &mut f64) {
        if self.1 == Some(fault) {
            *first *= 1.001;
        }
    }
}

impl Dae for Faulty {
    fn states(&self) -> usize {
        self.0.states()
    }
    fn memories(&self) -> usize {
        self.0.memories()
    }
    fn parameters(&self) -> &[f64] {
        self.0.parameters()
    }
    fn period_s(&self) -> f64 {
        self.0.period_s()
    }
    fn outputs(&self) -> usize {
        Dae::outputs(&self.0)
    }
    fn cold_start(&self) -> Vec<f64> {
        self.0.cold_start()
    }
    fn memory(&self, t_s: f64, z: &[f64], m: &mut [f64]) {
        self.0.memory(t_s, z, m);
    }
    fn residual(&self, at: At, residual: &mut [f64]) {
        Dae::residual(&self.0, at, residual);
    }
    fn output(&self, at: At, y: &mut [f64]) {
        self.0.output(at, y);
    }
    fn change(&self, z: &[f64], dz: &[f64]) -> f64 {
        self.0.change(z, dz)
    }
    fn memory_change(&self, dm: &[f64]) -> f64 {
        self.0.memory_change(dm)
    }
    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters> {
        Ok(Self(self.0.with_parameters(p)?, self.1))
    }
}

impl LinearisedDae for Faulty {
    type Factors = DenseFactors;
    type Room = DenseRoom;
    fn factors(&self) -> DenseFactors {
        self.0.factors()
    }
    fn factor_bytes(&self) -> usize {
        self.0.factor_bytes()
    }
    fn room(&self) -> DenseRoom {
        self.0.room()
    }
    fn linearise(
        &self,
        step: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        room: &mut DenseRoom,
        into: &mut DenseFactors,
    ) -> Result<(), Singular> {
        self.0.linearise(step, memory, residual, room, into)?;
        self.spoils(Fault::Linearise, &mut memory[0]);
        Ok(())
    }
    fn solve(&self, factors: &DenseFactors, rhs: &mut [f64]) {
        self.0.solve(factors, rhs);
    }
    fn rate_times(&self, factors: &DenseFactors, rate: &[f64], out: &mut [f64]) {
        self.0.rate_times(factors, rate, out);
        self.spoils(Fault::RateTimes, &mut out[0]);
    }
    fn memory_times(&self, factors: &DenseFactors, dz: &[f64], dm: &mut [f64]) {
        self.0.memory_times(factors, dz, dm);
    }
}

impl SensitiveDae for Faulty {
    type Point = DensePoint;
    fn point(&self) -> DensePoint {
        self.0.point()
    }
    fn fix(&self, at: At, into: &mut DensePoint) {
        self.0.fix(at, into);
    }
    fn factor(
        &self,
        at: At,
        alpha: f64,
        room: &mut DenseRoom,
        into: &mut DenseFactors,
    ) -> Result<(), Singular> {
        self.0.factor(at, alpha, room, into)
    }
    fn solve_transposed(&self, factors: &DenseFactors, rhs: &mut [f64]) {
        self.0.solve_transposed(factors, rhs);
        self.spoils(Fault::SolveTransposed, &mut rhs[0]);
    }
    fn rate_cotangent(&self, factors: &DenseFactors, v: &[f64], rate: &mut [f64]) {
        self.0.rate_cotangent(factors, v, rate);
    }
    fn memory_cotangent(&self, factors: &DenseFactors, w: &[f64], z: &mut [f64]) {
        self.0.memory_cotangent(factors, w, z);
        self.spoils(Fault::MemoryCotangent, &mut z[0]);
    }
    fn push(&self, point: &DensePoint, at: At, du: &[f64], residual: &mut [f64], memory: &mut [f64]) {
        self.0.push(point, at, du, residual, memory);
        self.spoils(Fault::Push, &mut memory[0]);
    }
    fn pull(&self, point: &DensePoint, at: At, v: &[f64], w: &[f64], u: &mut [f64]) {
        self.0.pull(point, at, v, w, u);
        self.spoils(Fault::Pull, &mut u[1]);
    }
    fn output_tangent(&self, point: &DensePoint, at: At, direction: Direction, dy: &mut [f64]) {
        self.0.output_tangent(point, at, direction, dy);
        self.spoils(Fault::OutputTangent, &mut dy[0]);
    }
    fn output_cotangent(&self, point: &DensePoint, at: At, w: &[f64], out: Cotangent) {
        let Cotangent { z, rate, u } = out;
        self.0.output_cotangent(point, at, w, Cotangent { z, rate, u });
        self.spoils(Fault::OutputCotangent, &mut z[0]);
    }
}

#[test]
fn a_wrong_product_is_told_by_its_name() {
    let sound = Dense::new(super::Circuit { frequency_hz: 50.0 }, &super::AT).unwrap();
    let orbit = settle(&sound, &super::options(), None, &Default::default()).unwrap();
    let told = |fault: Option<Fault>| -> Vec<&'static str> {
        let rows = check_ladder(&Faulty(sound.clone(), fault), &orbit).unwrap();
        rows.iter().filter(|r| !r.holds()).map(|r| r.product).collect()
    };
    assert!(told(None).is_empty());
    for (fault, name) in [
        (Fault::Push, "push"),
        (Fault::Pull, "pull"),
        (Fault::SolveTransposed, "solve_transposed"),
        (Fault::RateTimes, "rate_times"),
        (Fault::MemoryCotangent, "memory_cotangent"),
        (Fault::OutputTangent, "output_tangent"),
        (Fault::OutputCotangent, "output_cotangent"),
        (Fault::Linearise, "linearise"),
    ] {
        let found = told(Some(fault));
        assert!(found.contains(&name), "{name}: {found:?}");
    }
}

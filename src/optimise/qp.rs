//! The quadratic sub-problem, solved by Clarabel.
//!
//! ```text
//! minimise 1/2 d'B d + f'd   subject to   c + C d <= 0,   g + G d = 0,   A d <= b or = b,   lower <= d <= upper
//! ```
//!
//! If the linearised constraints contradict each other, the elastic form lets each be missed at a price: slack `t >= 0`
//! with `penalty * sum t` in the objective. Constraints that are linear in the variables (`A`) have no slack: the point meets them, so
//! a solution always exists.

use super::{LinearConstraint, Multipliers, Relation, Slopes, Values};
use crate::math::dot;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::DMatrix;

/// Price of a missed constraint in the elastic form, in units of the scaled objective.
const ELASTIC_PRICE: f64 = 1e3;
/// Accuracy asked of Clarabel.
const TOLERANCE: f64 = 1e-12;

/// Step and multipliers of a sub-problem.
#[derive(Debug, Clone)]
pub(super) struct QpSolution {
    pub step: Vec<f64>,
    pub multipliers: Multipliers,
    /// Whether constraints had to be missed.
    pub elastic: bool,
}

/// One sub-problem: the model at a point and the room around it.
pub(super) struct Qp<'a> {
    pub hessian: &'a DMatrix<f64>,
    pub values: &'a Values,
    pub slopes: &'a Slopes,
    /// Constraints that are linear in the variables, for steps from the point.
    pub linear: &'a [LinearConstraint],
    /// Bounds of the step.
    pub lower: &'a [f64],
    pub upper: &'a [f64],
}

/// Sparse rows under construction.
#[derive(Default)]
struct Rows {
    i: Vec<usize>,
    j: Vec<usize>,
    v: Vec<f64>,
    b: Vec<f64>,
}

impl Rows {
    fn push(&mut self, entries: impl IntoIterator<Item = (usize, f64)>, b: f64) {
        for (j, v) in entries {
            self.i.push(self.b.len());
            self.j.push(j);
            self.v.push(v);
        }
        self.b.push(b);
    }
}

impl Qp<'_> {
    /// Solves the sub-problem, in elastic form if need be; `None` if Clarabel gives up on both.
    pub fn solve(&self) -> Option<QpSolution> {
        self.attempt(false).or_else(|| self.attempt(true))
    }

    fn attempt(&self, elastic: bool) -> Option<QpSolution> {
        let n = self.lower.len();
        let (me, mi) = (self.values.equalities.len(), self.values.inequalities.len());
        // Slacks: one per inequality, two per equality.
        let slacks = if elastic { mi + 2 * me } else { 0 };
        let rows = self.rows(elastic);
        let a = CscMatrix::new_from_triplets(rows.b.len(), n + slacks, rows.i, rows.j, rows.v);
        let zero = me + self.fixed(Relation::Equal).count();
        let cones = [SupportedConeT::ZeroConeT(zero), SupportedConeT::NonnegativeConeT(rows.b.len() - zero)];
        let mut q = self.slopes.objective.clone();
        q.resize(n + slacks, ELASTIC_PRICE);
        let settings = DefaultSettings {
            verbose: false,
            max_iter: 100,
            max_threads: 1,
            direct_solve_method: "faer".to_owned(),
            presolve_enable: false,
            tol_gap_abs: TOLERANCE,
            tol_gap_rel: TOLERANCE,
            tol_feas: TOLERANCE,
            ..DefaultSettings::default()
        };
        let mut solver =
            DefaultSolver::new(&self.quadratic(slacks), &q, &a, &rows.b, &cones, settings).ok()?;
        solver.solve();
        let solution = &solver.solution;
        let good = matches!(
            solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        );
        let step = solution.x[..n].to_vec();
        let sound = step.iter().chain(&solution.z).all(|v| v.is_finite());
        if !good || !sound || (!elastic && self.missed(&step) > 1e-6) {
            return None;
        }
        Some(QpSolution { step, multipliers: self.multipliers(&solution.z), elastic })
    }

    /// Upper triangle of the Hessian, with nothing for the slacks.
    fn quadratic(&self, slacks: usize) -> CscMatrix<f64> {
        let n = self.lower.len();
        let (mut i, mut j, mut v) = (Vec::new(), Vec::new(), Vec::new());
        for c in 0..n {
            for r in 0..=c {
                i.push(r);
                j.push(c);
                v.push(self.hessian[(r, c)]);
            }
        }
        CscMatrix::new_from_triplets(n + slacks, n + slacks, i, j, v)
    }

    /// Linear constraints of one kind.
    fn fixed(&self, relation: Relation) -> impl Iterator<Item = &LinearConstraint> {
        self.linear.iter().filter(move |r| r.relation == relation)
    }

    /// Equalities, linear ones, inequalities, linear ones, finite lower bounds, finite upper bounds, signs of the slacks.
    fn rows(&self, elastic: bool) -> Rows {
        let n = self.lower.len();
        let (me, mi) = (self.values.equalities.len(), self.values.inequalities.len());
        let mut rows = Rows::default();
        let slack = |k: usize, v: f64| elastic.then_some((n + k, v));
        for (k, (g, value)) in self.slopes.equalities.iter().zip(&self.values.equalities).enumerate() {
            let extra = slack(mi + 2 * k, -1.0).into_iter().chain(slack(mi + 2 * k + 1, 1.0));
            rows.push(g.iter().copied().enumerate().chain(extra), -value);
        }
        let fixed = |rows: &mut Rows, relation: Relation| {
            self.fixed(relation).for_each(|r| rows.push(r.factors.iter().copied().enumerate(), r.bound));
        };
        fixed(&mut rows, Relation::Equal);
        for (k, (c, value)) in self.slopes.inequalities.iter().zip(&self.values.inequalities).enumerate() {
            rows.push(c.iter().copied().enumerate().chain(slack(k, -1.0)), -value);
        }
        fixed(&mut rows, Relation::AtMost);
        for (j, low) in self.lower.iter().enumerate().filter(|(_, v)| v.is_finite()) {
            rows.push([(j, -1.0)], -low);
        }
        for (j, high) in self.upper.iter().enumerate().filter(|(_, v)| v.is_finite()) {
            rows.push([(j, 1.0)], *high);
        }
        if elastic {
            (0..mi + 2 * me).for_each(|k| rows.push([(n + k, -1.0)], 0.0));
        }
        rows
    }

    fn multipliers(&self, z: &[f64]) -> Multipliers {
        let mut rest = z.iter().copied();
        let mut next = |count: usize| -> Vec<f64> { rest.by_ref().take(count).collect() };
        let above = |v: Vec<f64>| -> Vec<f64> { v.into_iter().map(|z| z.max(0.0)).collect() };
        let equalities = next(self.values.equalities.len());
        let mut equal = next(self.fixed(Relation::Equal).count()).into_iter();
        let inequalities = above(next(self.values.inequalities.len()));
        let mut at_most = above(next(self.fixed(Relation::AtMost).count())).into_iter();
        let linear = self.linear.iter().filter_map(|r| match r.relation {
            Relation::Equal => equal.next(),
            Relation::AtMost => at_most.next(),
        });
        let linear = linear.collect();
        let mut of_bounds = |bounds: &[f64]| -> Vec<f64> {
            let one = |b: &f64| if b.is_finite() { next(1).first().map_or(0.0, |z| z.max(0.0)) } else { 0.0 };
            bounds.iter().map(one).collect()
        };
        let (lower, upper) = (of_bounds(self.lower), of_bounds(self.upper));
        Multipliers { inequalities, equalities, lower, upper, linear }
    }

    /// Largest violation of the linearised constraints after a step.
    pub fn missed(&self, step: &[f64]) -> f64 {
        let after = |row: &[f64], value: f64| value + dot(row, step);
        let inequalities = self.slopes.inequalities.iter().zip(&self.values.inequalities);
        let equalities = self.slopes.equalities.iter().zip(&self.values.equalities);
        let above = inequalities.fold(0.0f64, |a, (row, v)| a.max(after(row, *v)));
        let above = equalities.fold(above, |a, (row, v)| a.max(after(row, *v).abs()));
        self.linear.iter().fold(above, |a, r| {
            let excess = r.excess(step);
            a.max(if r.relation == Relation::Equal { excess.abs() } else { excess })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(c: f64) -> QpSolution {
        let values = Values { objective: 0.0, inequalities: vec![c, 3.0], equalities: vec![] };
        let slopes = Slopes {
            objective: vec![-2.0, 0.0],
            inequalities: vec![vec![1.0, 1.0], vec![-1.0, 0.0]],
            equalities: vec![],
        };
        let hessian = DMatrix::identity(2, 2);
        let (lower, upper) = (&[-10.0; 2], &[10.0; 2]);
        Qp { hessian: &hessian, values: &values, slopes: &slopes, linear: &[], lower, upper }.solve().unwrap()
    }

    #[test]
    fn an_active_constraint_gets_its_multiplier() {
        // minimise (x^2 + y^2)/2 - 2 x with x + y <= 1 and x >= 3: x = 3, y = -2.
        let solution = solve(-1.0);
        assert!((solution.step[0] - 3.0).abs() < 1e-8 && (solution.step[1] + 2.0).abs() < 1e-8);
        assert!((solution.multipliers.inequalities[0] - 2.0).abs() < 1e-7);
        assert!((solution.multipliers.inequalities[1] - 3.0).abs() < 1e-7);
        assert!(!solution.elastic);
    }

    #[test]
    fn contradicting_constraints_are_missed_as_little_as_possible() {
        // x + y <= -20 cannot be met with x >= 3, y >= -10.
        let solution = solve(20.0);
        assert!(solution.elastic);
        assert!((solution.step[1] + 10.0).abs() < 1e-5);
    }
}

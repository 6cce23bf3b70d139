//! Linear constraints and many variables.

use super::{
    ConstrainedProblem, EvaluationError, LinearConstraint, Method, Outcome, Relation, SearchOptions, Slopes,
    SqpOptions, Values, search,
};
use std::sync::Mutex;

/// `(x - 3)^2 + (y - 2)^4 + x y + z^2` with `x + 2 y <= 3`, `x - z = 1/2`; every point that is asked for is noted.
#[derive(Default)]
struct Wedge {
    asked: Mutex<Vec<Vec<f64>>>,
}

impl ConstrainedProblem for Wedge {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![0.0, 0.0, -5.0], vec![5.0, 5.0, 5.0])
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        self.asked.lock().unwrap().push(x.to_vec());
        let objective = (x[0] - 3.0).powi(2) + (x[1] - 2.0).powi(4) + x[0] * x[1] + x[2] * x[2];
        Ok(Values { objective, inequalities: vec![], equalities: vec![] })
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let objective = vec![2.0 * (x[0] - 3.0) + x[1], 4.0 * (x[1] - 2.0).powi(3) + x[0], 2.0 * x[2]];
        Ok(Slopes { objective, inequalities: vec![], equalities: vec![] })
    }

    fn linear(&self) -> Vec<LinearConstraint> {
        let row = |factors: [f64; 3], relation, bound| LinearConstraint {
            factors: factors.to_vec(),
            relation,
            bound,
        };
        vec![row([1.0, 2.0, 0.0], Relation::AtMost, 3.0), row([1.0, 0.0, -1.0], Relation::Equal, 0.5)]
    }
}

#[test]
fn linear_constraints_are_met_at_every_point_that_is_asked_for() {
    let problem = Wedge::default();
    let end = search(&problem, &[5.0, 5.0, 5.0], &SearchOptions::default()).unwrap();
    assert_eq!(end.outcome, Outcome::Converged, "{:?}", end.history);
    for x in problem.asked.lock().unwrap().iter() {
        let rows = problem.linear();
        assert!(rows[0].excess(x) <= 1e-9 && rows[1].excess(x).abs() <= 1e-9, "{x:?}");
    }
    // Stationarity with the multipliers handed out.
    let (g, rows) = (problem.slopes(&end.x).unwrap().objective, problem.linear());
    for (j, g) in g.iter().enumerate() {
        let forces: f64 = rows.iter().zip(&end.multipliers.linear).map(|(r, m)| m * r.factors[j]).sum();
        assert!((g + forces - end.multipliers.lower[j] / 5.0).abs() < 1e-5, "{end:?}");
    }
    assert!(end.multipliers.linear[0] > 0.1);
}

#[test]
fn all_methods_agree_on_linear_constraints_and_their_prices() {
    let found = |method, max_iterations| {
        let settings = SqpOptions { max_iterations, ..SqpOptions::default() };
        let options = SearchOptions { method, settings, ..SearchOptions::default() };
        search(&Wedge::default(), &[1.0, 1.0, 1.0], &options).unwrap()
    };
    let best = found(Method::Sqp, 60);
    for method in [Method::AugmentedLagrangian, Method::Cobyla] {
        let other = found(method, 1000);
        for j in 0..3 {
            assert!((other.x[j] - best.x[j]).abs() < 1e-4, "{method:?}: {:?} {:?}", other.x, best.x);
        }
        let apart = |k: usize| other.multipliers.linear[k] - best.multipliers.linear[k];
        assert!(apart(0).abs() < 1e-2 && apart(1).abs() < 1e-2, "{method:?}");
        assert!(other.values.unwrap().inequalities.is_empty());
    }
}

#[test]
fn contradicting_linear_constraints_are_told_before_anything_is_evaluated() {
    struct Nowhere;
    impl ConstrainedProblem for Nowhere {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![0.0], vec![1.0])
        }
        fn values(&self, _: &[f64]) -> Result<Values, EvaluationError> {
            panic!("asked for");
        }
        fn slopes(&self, _: &[f64]) -> Result<Slopes, EvaluationError> {
            panic!("asked for");
        }
        fn linear(&self) -> Vec<LinearConstraint> {
            vec![LinearConstraint { factors: vec![1.0], relation: Relation::AtMost, bound: -0.5 }]
        }
    }
    let end = search(&Nowhere, &[0.5], &SearchOptions::default()).unwrap();
    assert_eq!(end.outcome, Outcome::Infeasible);
    assert!(end.failures[0].contains("contradict"));
}

/// A stiff chain of `n` links that wants to leave its box at places, with a limit on its mean square:
/// `sum (x_i - t_i)^2 + 10 (x_i+1 - x_i)^2 + x_i^4 / 4`.
struct Chain {
    n: usize,
}

impl Chain {
    fn target(i: usize) -> f64 {
        2.0 * (0.05 * i as f64).sin()
    }
}

impl ConstrainedProblem for Chain {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![-0.8; self.n], vec![0.8; self.n])
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let own = x.iter().enumerate().map(|(i, x)| (x - Self::target(i)).powi(2) + x.powi(4) / 4.0);
        let links = x.windows(2).map(|w| 10.0 * (w[1] - w[0]).powi(2));
        let square = x.iter().map(|x| x * x).sum::<f64>() / self.n as f64;
        let objective = own.sum::<f64>() + links.sum::<f64>();
        Ok(Values { objective, inequalities: vec![square / 0.3 - 1.0], equalities: vec![] })
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let own = |(i, x): (usize, &f64)| 2.0 * (x - Self::target(i)) + x.powi(3);
        let mut objective: Vec<f64> = x.iter().enumerate().map(own).collect();
        for i in 1..self.n {
            let pull = 20.0 * (x[i] - x[i - 1]);
            objective[i] += pull;
            objective[i - 1] -= pull;
        }
        let square = x.iter().map(|x| 2.0 * x / (0.3 * self.n as f64)).collect();
        Ok(Slopes { objective, inequalities: vec![square], equalities: vec![] })
    }
}

#[test]
fn a_thousand_variables_need_few_evaluations() {
    for (n, most) in [(20, 40), (200, 40), (1000, 40)] {
        let end = search(&Chain { n }, &vec![0.0; n], &SearchOptions::default()).unwrap();
        println!("{n} variables: {:?}, {} evaluations", end.outcome, end.evaluations);
        assert_eq!(end.outcome, Outcome::Converged, "{n}: {:?}", end.history.last());
        assert!(end.evaluations <= most, "{n}: {} evaluations", end.evaluations);
    }
}

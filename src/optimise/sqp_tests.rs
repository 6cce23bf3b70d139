//! The SQP on small problems with known answers.

use super::{ConstrainedProblem, EvaluationError, Outcome, Slopes, SqpOptions, Values, minimise};

/// Rosenbrock's valley inside a disc; with `hole` the model fails beyond a line.
struct Disc {
    hole: bool,
}

impl ConstrainedProblem for Disc {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![-1.5, -1.5], vec![1.5, 1.5])
    }
    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        if self.hole && x[1] > 0.7 {
            return Err(EvaluationError::Failed("outside".into()));
        }
        Ok(Values {
            objective: (1.0 - x[0]).powi(2) + 100.0 * (x[1] - x[0] * x[0]).powi(2),
            inequalities: vec![x[0] * x[0] + x[1] * x[1] - 1.0],
            equalities: vec![],
        })
    }
    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let v = x[1] - x[0] * x[0];
        Ok(Slopes {
            objective: vec![-2.0 * (1.0 - x[0]) - 400.0 * x[0] * v, 200.0 * v],
            inequalities: vec![vec![2.0 * x[0], 2.0 * x[1]]],
            equalities: vec![],
        })
    }
}

#[test]
fn finds_the_constrained_minimum_from_several_starts_even_if_trials_fail() {
    for (start, hole) in [([-1.0, 0.5], false), ([0.0, 0.0], false), ([0.0, 0.0], true), ([0.5, -1.2], false)]
    {
        let end = minimise(&Disc { hole }, &start, SqpOptions::default()).unwrap();
        assert_eq!(end.outcome, Outcome::Converged, "from {start:?}: {:?}", end.history.last());
        assert!((end.x[0] - 0.786_415_1).abs() < 1e-5 && (end.x[1] - 0.617_698_3).abs() < 1e-5);
        assert!(end.kkt <= 1e-6 && end.multipliers.inequalities[0] > 0.0);
        assert!(end.gradients <= end.evaluations);
    }
}

#[test]
fn equality_constraints_are_met_and_have_multipliers() {
    /// Hock-Schittkowski 6 with a bound: (1 - x)^2 subject to 10 (y - x^2) = 0.
    struct Curve;
    impl ConstrainedProblem for Curve {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![f64::NEG_INFINITY, f64::NEG_INFINITY], vec![0.8, f64::INFINITY])
        }
        fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
            let g = 10.0 * (x[1] - x[0] * x[0]);
            Ok(Values { objective: (1.0 - x[0]).powi(2), inequalities: vec![], equalities: vec![g] })
        }
        fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
            let objective = vec![-2.0 * (1.0 - x[0]), 0.0];
            Ok(Slopes { objective, inequalities: vec![], equalities: vec![vec![-20.0 * x[0], 10.0]] })
        }
    }
    let end = minimise(&Curve, &[-1.2, 1.0], SqpOptions::default()).unwrap();
    assert_eq!(end.outcome, Outcome::Converged);
    assert!((end.x[0] - 0.8).abs() < 1e-6 && (end.x[1] - 0.64).abs() < 1e-6);
    // At the bound the slope of the objective, -0.4, is carried by the bound alone: the equality costs nothing.
    assert!(end.multipliers.equalities[0].abs() < 1e-5);
}

#[test]
fn a_point_without_gradient_is_refused_like_one_without_values() {
    struct Blind;
    impl ConstrainedProblem for Blind {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![-2.0], vec![2.0])
        }
        fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
            Ok(Values { objective: (x[0] - 0.3).powi(4) + 1.0, inequalities: vec![], equalities: vec![] })
        }
        fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
            if x[0] < 0.25 && x[0] > -1.9 {
                return Err(EvaluationError::Failed("no gradient here".into()));
            }
            let objective = vec![4.0 * (x[0] - 0.3).powi(3)];
            Ok(Slopes { objective, inequalities: vec![], equalities: vec![] })
        }
    }
    let end = minimise(&Blind, &[1.9], SqpOptions { tolerance: 1e-4, ..Default::default() }).unwrap();
    assert_eq!(end.outcome, Outcome::Converged, "{:?}", end.failures);
}

#[test]
fn a_problem_without_feasible_point_says_so() {
    struct Never;
    impl ConstrainedProblem for Never {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![0.0], vec![1.0])
        }
        fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
            Ok(Values { objective: x[0], inequalities: vec![2.0 - x[0]], equalities: vec![] })
        }
        fn slopes(&self, _: &[f64]) -> Result<Slopes, EvaluationError> {
            Ok(Slopes { objective: vec![1.0], inequalities: vec![vec![-1.0]], equalities: vec![] })
        }
    }
    let end = minimise(&Never, &[0.2], SqpOptions::default()).unwrap();
    assert_eq!(end.outcome, Outcome::Infeasible);
    assert!((end.x[0] - 1.0).abs() < 1e-6);
}

#[test]
fn a_start_that_fails_and_a_cancelled_run_are_outcomes() {
    let end = minimise(&Disc { hole: true }, &[0.0, 1.0], SqpOptions::default()).unwrap();
    assert_eq!((end.outcome, end.failures.len()), (Outcome::StartFailed, 1));
    struct Stopped;
    impl ConstrainedProblem for Stopped {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![0.0], vec![1.0])
        }
        fn values(&self, _: &[f64]) -> Result<Values, EvaluationError> {
            Err(EvaluationError::Cancelled)
        }
        fn slopes(&self, _: &[f64]) -> Result<Slopes, EvaluationError> {
            Err(EvaluationError::Cancelled)
        }
    }
    assert_eq!(minimise(&Stopped, &[0.5], SqpOptions::default()).unwrap().outcome, Outcome::Cancelled);
}

#[test]
fn an_optimum_on_a_kink_is_certified_by_a_combination_of_gradients() {
    /// `max(x + y^2, y^2 - 2 x) + y / 10`: a valley with a sharp bottom at x = 0.
    struct Valley;
    impl ConstrainedProblem for Valley {
        fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
            (vec![-1.0; 2], vec![1.0; 2])
        }
        fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
            let objective = x[0].max(-2.0 * x[0]) + x[1] * x[1] + 0.1 * x[1] + 1.0;
            Ok(Values { objective, inequalities: vec![x[1] - 0.9], equalities: vec![] })
        }
        fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
            let across = if x[0] >= 0.0 { 1.0 } else { -2.0 };
            let objective = vec![across, 2.0 * x[1] + 0.1];
            Ok(Slopes { objective, inequalities: vec![vec![0.0, 1.0]], equalities: vec![] })
        }
    }
    for start in [[0.7, 0.4], [-0.3, 0.8], [0.01, -0.9]] {
        let end = minimise(&Valley, &start, SqpOptions::default()).unwrap();
        assert_eq!(end.outcome, Outcome::Converged, "from {start:?}: {:?}", end.history.last());
        assert!(end.x[0].abs() < 1e-5 && (end.x[1] + 0.05).abs() < 1e-5, "{:?}", end.x);
        assert!(end.kkt <= 1e-6 && end.combined > 1, "{} gradients", end.combined);
    }
}

//! A problem of one's own through the public optimiser: the example of the crate page on `optimise`, held against its closed form.

// The example begins here.
use stribeck::optimise::{
    ConstrainedProblem, EvaluationError, Method, Minimum, SearchOptions, Slopes, Values, search,
};

/// Radius and height of a can, m, that holds a litre with the least sheet and is at most 15 cm high.
struct Can;

const PI: f64 = std::f64::consts::PI;
const LITRE_M3: f64 = 1e-3;

impl ConstrainedProblem for Can {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![0.01, 0.01], vec![0.2, f64::INFINITY])
    }

    /// Sheet in square decimetres; height and volume relative to what is wanted, so that one tolerance judges both.
    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        let (r, h) = (x[0], x[1]);
        Ok(Values {
            objective: 100.0 * 2.0 * PI * r * (r + h),
            inequalities: vec![h / 0.15 - 1.0],
            equalities: vec![PI * r * r * h / LITRE_M3 - 1.0],
        })
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let (r, h) = (x[0], x[1]);
        Ok(Slopes {
            objective: vec![100.0 * 2.0 * PI * (2.0 * r + h), 100.0 * 2.0 * PI * r],
            inequalities: vec![vec![0.0, 1.0 / 0.15]],
            equalities: vec![vec![2.0 * PI * r * h / LITRE_M3, PI * r * r / LITRE_M3]],
        })
    }
}

fn least_sheet(method: Method) -> Minimum {
    let options = SearchOptions { method, ..SearchOptions::default() };
    let end = search(&Can, &[0.1, 0.05], &options).expect("argmin runs");
    println!(
        "{:?}: {:?} after {} evaluations, {}",
        end.outcome,
        end.x,
        end.evaluations,
        end.outcome.advice()
    );
    end
}
// The example ends here.

#[test]
fn a_can_is_as_high_as_wide_by_every_method() {
    // Without the limit h = 2 r = 2 (V / 2 pi)^(1/3) = 10.84 cm, below 15 cm.
    let radius = (LITRE_M3 / (2.0 * PI)).cbrt();
    for (method, miss) in [(Method::Sqp, 1e-6), (Method::AugmentedLagrangian, 1e-5), (Method::Cobyla, 1e-3)] {
        let end = least_sheet(method);
        assert!((end.x[0] / radius - 1.0).abs() < miss, "{method:?}: {:?}", end.x);
        assert!((end.x[1] / (2.0 * radius) - 1.0).abs() < 2.0 * miss, "{method:?}: {:?}", end.x);
    }
    // Sheet over volume: d(A)/d(V) V = 2/3 A, with the sign of `f + m g`.
    let end = least_sheet(Method::Sqp);
    let sheet = end.values.unwrap().objective;
    assert!((end.multipliers.equalities[0] / (-2.0 / 3.0 * sheet) - 1.0).abs() < 1e-5);
}

#[test]
fn the_example_in_the_documentation_is_the_one_that_is_tested() {
    crate::common::assert_example("tests/own_problem.rs", "src/optimise/mod.rs", 30);
}

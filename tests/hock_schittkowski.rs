//! The optimiser on 38 of the test problems of Hock and Schittkowski (Lecture Notes in Economics and Mathematical Systems 187,
//! Springer 1981), from their own starts, with exact gradients by symbolic differentiation.

use exmex::{Differentiate, Express, FlatEx};
use serde::Deserialize;
use std::fmt::Write;
use stribeck::optimise::{
    Budget, ConstrainedProblem, EvaluationError, Method, Minimum, Outcome, SearchOptions, Slopes, SqpOptions,
    Values, search,
};

#[derive(Deserialize)]
struct Collection {
    problems: Vec<Statement>,
}

#[derive(Deserialize)]
struct Statement {
    name: String,
    n: usize,
    objective: String,
    inequality_ge_0: Vec<String>,
    equality_0: Vec<String>,
    lower: Vec<Option<f64>>,
    upper: Vec<Option<f64>>,
    x0: Vec<f64>,
    f_x0: f64,
    f_star: f64,
}

/// An expression with its gradient; `names` are the variables that occur, by their number.
struct Function {
    value: FlatEx<f64>,
    slopes: Vec<(usize, FlatEx<f64>)>,
    variables: Vec<usize>,
}

impl Function {
    fn read(text: &str) -> Self {
        // A sign in front binds tighter than a power for the parser.
        let text = format!("({text})").replace("(-", "(0-");
        let text = plain_numbers(&text.replace("log(", "ln(").replace("pi", "3.141592653589793"));
        let value: FlatEx<f64> = exmex::parse(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        let number = |name: &String| name[1..].parse::<usize>().unwrap() - 1;
        let variables: Vec<usize> = value.var_names().iter().map(number).collect();
        let slopes = (0..variables.len())
            .map(|k| (variables[k], value.clone().partial(k).unwrap_or_else(|e| panic!("{text}: {e}"))))
            .collect();
        Self { value, slopes, variables }
    }

    fn at(&self, x: &[f64]) -> f64 {
        let picked: Vec<f64> = self.variables.iter().map(|j| x[*j]).collect();
        self.value.eval(&picked).unwrap()
    }

    fn gradient(&self, x: &[f64]) -> Vec<f64> {
        let picked: Vec<f64> = self.variables.iter().map(|j| x[*j]).collect();
        let mut g = vec![0.0; x.len()];
        // A derivative keeps the variables of its expression, whether they still occur or not.
        self.slopes.iter().for_each(|(j, slope)| g[*j] = slope.eval(&picked).unwrap());
        g
    }
}

/// Writes `1.5e-3` as `0.0015`: the parser takes the `e` for a name.
fn plain_numbers(text: &str) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some(c) = rest.chars().next() {
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let inside_name = out.ends_with(|c: char| c.is_ascii_alphanumeric());
        let (mut end, tail) = (digits, &rest[digits..]);
        if let Some(power) = tail.strip_prefix('e') {
            let sign = usize::from(power.starts_with(['-', '+']));
            let figures = power[sign..].find(|c: char| !c.is_ascii_digit()).unwrap_or(power.len() - sign);
            end = if figures > 0 { digits + 1 + sign + figures } else { digits };
        }
        if digits == 0 || inside_name {
            out.push(c);
            rest = &rest[c.len_utf8()..];
        } else {
            out += &rest[..end].parse::<f64>().map_or_else(|_| rest[..end].into(), |v| v.to_string());
            rest = &rest[end..];
        }
    }
    out
}

struct Problem {
    objective: Function,
    inequalities: Vec<Function>,
    equalities: Vec<Function>,
    bounds: (Vec<f64>, Vec<f64>),
}

impl Problem {
    fn of(s: &Statement) -> Self {
        let all = |texts: &[String]| texts.iter().map(|t| Function::read(t)).collect();
        let bound = |v: &[Option<f64>], none: f64| v.iter().map(|b| b.unwrap_or(none)).collect();
        Self {
            objective: Function::read(&s.objective),
            inequalities: all(&s.inequality_ge_0),
            equalities: all(&s.equality_0),
            bounds: (bound(&s.lower, f64::NEG_INFINITY), bound(&s.upper, f64::INFINITY)),
        }
    }
}

impl ConstrainedProblem for Problem {
    fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        self.bounds.clone()
    }

    fn values(&self, x: &[f64]) -> Result<Values, EvaluationError> {
        Ok(Values {
            objective: self.objective.at(x),
            inequalities: self.inequalities.iter().map(|c| -c.at(x)).collect(),
            equalities: self.equalities.iter().map(|g| g.at(x)).collect(),
        })
    }

    fn slopes(&self, x: &[f64]) -> Result<Slopes, EvaluationError> {
        let minus = |g: Vec<f64>| g.into_iter().map(|v| -v).collect();
        Ok(Slopes {
            objective: self.objective.gradient(x),
            inequalities: self.inequalities.iter().map(|c| minus(c.gradient(x))).collect(),
            equalities: self.equalities.iter().map(|g| g.gradient(x)).collect(),
        })
    }
}

#[test]
fn statements_are_read_as_they_are_meant() {
    for s in collection() {
        let problem = Problem::of(&s);
        let f = problem.values(&s.x0).unwrap().objective;
        assert!((f - s.f_x0).abs() <= 1e-9 * s.f_x0.abs().max(1.0), "{}: {f} instead of {}", s.name, s.f_x0);
        assert_eq!(s.n, s.x0.len());
    }
}

fn collection() -> Vec<Statement> {
    let text = std::fs::read_to_string(crate::common::here("tests/data/hock_schittkowski.json")).unwrap();
    serde_json::from_str::<Collection>(&text).unwrap().problems
}

/// Whether an end is the published optimum; HS13 has no multipliers there.
fn solved(s: &Statement, end: &Minimum) -> bool {
    let Some(values) = &end.values else { return false };
    let allowed = if s.name == "HS13" { 1e-4 } else { 1e-6 };
    let met = (values.objective - s.f_star).abs() <= allowed * s.f_star.abs().max(1.0);
    met && values.violation() <= 1e-7 && (end.kkt <= 1e-6 || s.name == "HS13")
}

/// Solves all problems by a method; the table and how many were solved.
fn solve_all(
    method: Method,
    max_iterations: u64,
    good: impl Fn(&Statement, &Minimum) -> bool,
) -> (String, usize) {
    let mut table = String::from("problem  outcome           iterations  evaluations  gradients  solved\n");
    let mut count = 0;
    for s in collection() {
        let settings = SqpOptions { tolerance: 1e-7, max_iterations, ..SqpOptions::default() };
        let options = SearchOptions { method, settings, budget: Budget::default() };
        let end = search(&Problem::of(&s), &s.x0, &options).unwrap();
        let good = good(&s, &end);
        count += usize::from(good);
        let outcome = format!("{:?}", end.outcome);
        let (iterations, answer) = (end.history.len().saturating_sub(1), if good { "yes" } else { "no" });
        let (evaluations, gradients) = (end.evaluations, end.gradients);
        writeln!(
            table,
            "{:<8} {outcome:<18} {iterations:>9} {evaluations:>12} {gradients:>10}  {answer}",
            s.name
        )
        .unwrap();
        if !good || end.outcome != Outcome::Converged {
            let miss = end.values.as_ref().map(|v| (v.objective - s.f_star, v.violation()));
            println!("{}: off by {miss:?}, KKT {:.1e} at {:?}", s.name, end.kkt, end.x);
        }
    }
    println!("{table}{count} of 38 solved");
    (table, count)
}

#[test]
fn classical_problems_are_solved_from_their_own_starts() {
    let (table, count) = solve_all(Method::Sqp, 200, solved);
    assert!(count >= 36, "{count} of 38 solved");
    insta::assert_snapshot!(table);
}

#[test]
fn the_other_methods_solve_most_of_them() {
    let (table, count) = solve_all(Method::AugmentedLagrangian, 3000, solved);
    assert!(count >= 30, "augmented Lagrangian: {count} of 38 solved");
    insta::assert_snapshot!("augmented_lagrangian", table);
    // Without gradients three digits less are asked for.
    let near = |s: &Statement, end: &Minimum| {
        let values = end.values.as_ref().unwrap();
        (values.objective - s.f_star).abs() <= 1e-3 * s.f_star.abs().max(1.0) && values.violation() <= 1e-4
    };
    let (table, count) = solve_all(Method::Cobyla, 500, near);
    assert!(count >= 28, "COBYLA: {count} of 38 solved");
    insta::assert_snapshot!("cobyla", table);
}

//! Every derivative of every film, against differences and against its own transpose.
//!
//! States are random and away from the switches of cavitation; everything a film depends on moves at once: unknowns, rate
//! of the content, all scalars, the shape of the surfaces. Boundary conditions differ from film to film ([`films`]).

use crate::common::films::{Case, all_films};
use proptest::prelude::*;
use stribeck::film::{
    Axial, FilmChange, FilmInput, FilmLinear, FilmModel, FilmOutput, FilmSite, FilmTangent, FilmWeights,
};

/// A point in everything a film depends on, and by subtraction a direction.
struct Point {
    q: Vec<f64>,
    rate: Vec<f64>,
    input: FilmInput,
    shape_m: Vec<f64>,
    shell_left: Vec<f64>,
    marks: Vec<f64>,
}

/// An input of the sizes of a bearing; only tilted films see the tilt.
fn input(x: &[f64], tilted: bool) -> FilmInput {
    let tilt = if tilted { 1e-4 } else { 0.0 };
    FilmInput {
        eccentricity_m: [25e-6 * x[0], 25e-6 * x[1]],
        tilt_rad: [tilt * x[2], tilt * x[3]],
        velocity_m_s: [2e-3 * x[4], 2e-3 * x[5]],
        speed_rad_s: 100.0 + 40.0 * x[6],
        width_m: 0.05 + 0.02 * x[7],
        diameter_m: 0.1 + 0.03 * x[8],
        clearance_m: 60e-6 + 10e-6 * x[9],
        viscosity_pa_s: 0.01 + 0.005 * x[10],
        journal_roughness_m: 5e-6 + 2e-6 * x[11],
        shell_roughness_m: 3e-6 + 1e-6 * x[12],
        supply_pressure_pa: 2e5 + 1e5 * x[13],
    }
}

impl Point {
    /// A state at least 1e4 Pa away from every switch.
    fn of(case: &Case, x: &[f64], noise: &[f64], turn: usize) -> Self {
        let n = case.film.unknowns();
        let number = |k: usize| noise[(k + turn) % noise.len()];
        let q = |k: usize| if number(k) > 0.0 { 1e4 + 5e7 * number(k) } else { -1e4 + 8e6 * number(k) };
        let shape = |k: usize| 4e-6 * number(7 * k + 3);
        Self {
            q: (0..n).map(q).collect(),
            rate: (0..n).map(|k| 1e-3 * number(3 * k + 1)).collect(),
            input: input(x, case.tilted()),
            shape_m: if case.shaped { (0..n).map(shape).collect() } else { Vec::new() },
            marks: (0..n).map(|k| ((k % 7) as f64 - 2.0) / 3.0).collect(),
            shell_left: if case.shaped {
                (0..n).map(|k| 0.7 + 0.2 * number(5 * k + 1)).collect()
            } else {
                Vec::new()
            },
        }
    }

    /// A direction: unknowns by a share of themselves, so that none changes sign.
    fn direction(case: &Case, at: &Self, dx: &[f64], noise: &[f64]) -> Self {
        let (to, zero) = (Self::of(case, dx, noise, 11), [0.0; 14]);
        let share = |k: usize| 0.5 * noise[(5 * k + 2) % noise.len()] * at.q[k];
        Self {
            q: (0..at.q.len()).map(share).collect(),
            input: to.input.moved(&input(&zero, case.tilted()), -1.0),
            shell_left: to.shell_left.iter().map(|left| left - 0.7).collect(),
            ..to
        }
    }

    fn moved(&self, d: &Self, t: f64) -> Self {
        let add = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + t * b).collect();
        Self {
            q: add(&self.q, &d.q),
            rate: add(&self.rate, &d.rate),
            input: self.input.moved(&d.input, t),
            shape_m: add(&self.shape_m, &d.shape_m),
            marks: self.marks.clone(),
            shell_left: add(&self.shell_left, &d.shell_left),
        }
    }

    fn site(&self, journal_angle_rad: f64) -> FilmSite<'_> {
        FilmSite {
            input: self.input,
            shape_m: &self.shape_m,
            journal_angle_rad,
            marks: &self.marks,
            shell_left: &self.shell_left,
        }
    }

    fn change(&self) -> FilmChange<'_> {
        FilmChange {
            q: &self.q,
            rate: &self.rate,
            input: self.input,
            shape_m: &self.shape_m,
            shell_left: &self.shell_left,
        }
    }
}

/// Residual, content and outputs at a point.
fn values(film: &dyn FilmModel, at: &Point, angle: f64) -> FilmTangent {
    let (mut residual, mut content) = (vec![0.0; at.q.len()], vec![0.0; at.q.len()]);
    film.residual(&at.site(angle), &at.q, &at.rate, &mut residual);
    film.content(&at.site(angle), &at.q, &mut content);
    let mut contact_pa = vec![0.0; at.q.len()];
    film.contact_pa(&at.site(angle), &mut contact_pa);
    FilmTangent { residual, content, output: film.output(&at.site(angle), &at.q), contact_pa }
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn dot_abs(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn tangents_are_limits_of_differences_and_cotangents_their_transposes(
        x in prop::collection::vec(-1.0f64..1.0, 14), dx in prop::collection::vec(-1.0f64..1.0, 14),
        noise in prop::collection::vec(-1.0f64..1.0, 97), angle in -7.0f64..7.0, alpha in 1.0f64..1e4,
    ) {
        for case in all_films() {
            let at = Point::of(&case, &x, &noise, 0);
            let along = Point::direction(&case, &at, &dx, &noise);
            let tangent = case.film.tangent(&at.site(angle), &at.q, &at.rate, &along.change());
            check_differences(&case, &at, &along, angle, &tangent);
            check_transpose(&case, &at, &along, angle, &tangent, &noise);
            check_linearised(&case, &at, &along, angle, alpha);
        }
    }
}

fn check_differences(case: &Case, at: &Point, along: &Point, angle: f64, tangent: &FilmTangent) {
    let (film, e) = (case.film.as_ref(), 1e-6);
    let [plus, here, minus] = [e, 0.0, -e].map(|t| values(film, &at.moved(along, t), angle));
    let fields = [
        ("residual", &plus.residual, &minus.residual, &tangent.residual),
        ("content", &plus.content, &minus.content, &tangent.content),
        ("contact", &plus.contact_pa, &minus.contact_pa, &tangent.contact_pa),
    ];
    for (what, plus, minus, tangent) in fields {
        let size = largest(tangent);
        for k in 0..tangent.len() {
            let difference = (plus[k] - minus[k]) / (2.0 * e);
            let miss = (difference - tangent[k]).abs() / size;
            assert!(miss < 1e-6, "{}: {what} {k}: {difference} {} ({miss:.1e})", case.name, tangent[k]);
        }
    }
    let (plus, here, minus) = (plus.output.to_array(), here.output.to_array(), minus.output.to_array());
    for (k, tangent) in tangent.output.to_array().into_iter().enumerate() {
        let difference = (plus[k] - minus[k]) / (2.0 * e);
        let size = tangent.abs() + here[k].abs();
        assert!(
            (difference - tangent).abs() <= 1e-6 * size,
            "{}: output {k}: {difference} {tangent} of {}",
            case.name,
            here[k]
        );
    }
}

fn check_transpose(case: &Case, at: &Point, along: &Point, angle: f64, tangent: &FilmTangent, noise: &[f64]) {
    let n = at.q.len();
    let weights = |turn: usize, size: f64| -> Vec<f64> {
        (0..n).map(|k| noise[(2 * k + turn) % noise.len()] / size).collect()
    };
    let (on_r, on_c) = (weights(5, largest(&tangent.residual)), weights(9, largest(&tangent.content)));
    let dy = tangent.output.to_array();
    let on_y = std::array::from_fn(|k| if dy[k] == 0.0 { 1.0 } else { noise[k] / dy[k] });
    let output = FilmOutput::from_array(on_y);
    let w = FilmWeights { residual: &on_r, content: &on_c, output };
    let bar = case.film.cotangent(&at.site(angle), &at.q, &at.rate, &w);
    let forward = [dot(&on_r, &tangent.residual), dot(&on_c, &tangent.content), dot(&on_y, &dy)];
    let backward = [
        dot(&bar.q, &along.q),
        dot(&bar.rate, &along.rate),
        bar.input.dot(&along.input),
        dot(&bar.gap_m, &along.shape_m),
        dot(&bar.shell_left, &along.shell_left),
    ];
    let size = dot_abs(&bar.q, &along.q)
        + dot_abs(&bar.rate, &along.rate)
        + dot_abs(&bar.input.to_array(), &along.input.to_array())
        + dot_abs(&bar.gap_m, &along.shape_m)
        + dot_abs(&bar.shell_left, &along.shell_left);
    let (forward, backward): (f64, f64) = (forward.iter().sum(), backward.iter().sum());
    assert!((forward - backward).abs() <= 1e-11 * size, "{}: {forward} {backward} of {size}", case.name);
}

/// What Newton's method sees: residual, stencil, columns, rows, corner at the rate `alpha c + past`.
fn check_linearised(case: &Case, at: &Point, along: &Point, angle: f64, alpha: f64) {
    let (film, n, (_, b)) = (case.film.as_ref(), at.q.len(), case.film.shape());
    let motions = if film.mesh().is_some_and(|m| m.axial == Axial::Full) { 4 } else { 2 };
    let mut linear = FilmLinear::new(n, motions);
    let site = at.site(angle);
    film.linearise(&site, &at.q, alpha, &at.rate, &mut linear);
    let here = values(film, at, angle);
    let rate: Vec<f64> = here.content.iter().zip(&at.rate).map(|(c, past)| alpha * c + past).collect();
    let mut residual = vec![0.0; n];
    film.residual(&site, &at.q, &rate, &mut residual);
    let near = |a: &[f64], b: &[f64], what: &str| {
        let size = largest(b);
        for k in 0..b.len() {
            assert!((a[k] - b[k]).abs() <= 1e-11 * size, "{}: {what} {k}: {} {}", case.name, a[k], b[k]);
        }
    };
    near(&linear.content, &here.content, "content");
    near(&linear.residual, &residual, "residual");
    near(&linear.loads[..motions], &here.output.loads()[..motions], "load");

    let u = &along.input;
    let [ex, ey] = u.eccentricity_m;
    let motion = [ex, ey, u.tilt_rad[0], u.tilt_rad[1]];
    let mut moves =
        FilmInput { eccentricity_m: u.eccentricity_m, tilt_rad: u.tilt_rad, ..Default::default() };
    if n == 0 {
        // In closed form the velocity takes the place of the content's rate.
        moves.velocity_m_s = u.eccentricity_m.map(|e| alpha * e);
    }
    let still = FilmChange { q: &along.q, rate: &[], input: moves, shape_m: &[], shell_left: &[] };
    let content = film.tangent(&site, &at.q, &rate, &still).content;
    let d_rate: Vec<f64> = content.iter().map(|c| alpha * c).collect();
    let tangent = film.tangent(&site, &at.q, &rate, &FilmChange { rate: &d_rate, ..still });
    let a = &linear.stencil;
    let dq = |k: usize, by: f64| if by == 0.0 { 0.0 } else { by * along.q[k % n] };
    let row = |k: usize| {
        let sides = dq(k, a.diagonal[k]) + dq(k + n - b, a.west[k]) + dq(k + b, a.east[k]);
        let across = dq(k + n - 1, a.south[k]) + dq(k + 1, a.north[k]);
        sides + across + (0..motions).map(|m| linear.columns[m * n + k] * motion[m]).sum::<f64>()
    };
    near(&(0..n).map(row).collect::<Vec<_>>(), &tangent.residual, "row");
    let load = |i: usize| {
        let by_q = dot(&linear.rows[i * n..(i + 1) * n], &along.q);
        by_q + (0..motions).map(|m| linear.corner[i][m] * motion[m]).sum::<f64>()
    };
    near(&(0..motions).map(load).collect::<Vec<_>>(), &tangent.output.loads()[..motions], "change of load");
}

//! Sliders without cavitation: plane and stepped.

use super::Slider;
use crate::common::table;
use stribeck::film::steady_at;

/// Speed, viscosity and outlet gap.
const FILM: (f64, f64, f64) = (2.0, 0.02, 2e-5);
const LENGTH: f64 = 0.03;

/// Load, friction and largest pressure in units of the table.
fn solve(slider: &Slider) -> [f64; 3] {
    let (speed, eta, h0) = FILM;
    let state = steady_at(&slider.film, &slider.site(), None).unwrap();
    let load: f64 = state.q[1..].iter().map(|p| p * slider.dx).sum();
    let top = state.q.iter().fold(0.0f64, |m, p| m.max(*p));
    let friction = state.output.loss_w / speed / slider.input.width_m;
    let pressure = eta * speed * LENGTH / (h0 * h0);
    [load / (pressure * LENGTH), friction / (eta * speed * LENGTH / h0), top / pressure]
}

#[test]
fn linear_slider() {
    // Infinitely wide, p = 0 at both ends, no rupture; friction is that of the moving surface.
    for row in table("linear_slider.csv") {
        let k = row[0];
        let at = |n| solve(&Slider::new(n, LENGTH, FILM, 0.0, |x| FILM.2 * k * (1.0 - x / LENGTH)));
        let (a, b, c) = (at(250), at(500), at(1000));
        for i in 0..3 {
            let miss = c[i] / row[i + 1] - 1.0;
            println!("slider K {k} quantity {i}: {miss:.1e}");
            assert!(miss.abs() < 1e-4, "{} instead of {} at K {k}", c[i], row[i + 1]);
        }
        let order = ((a[0] - b[0]) / (b[0] - c[0])).abs().log2();
        assert!((order - 2.0).abs() <= 0.1, "order {order} of the load at K {k}");
    }
}

#[test]
fn rayleigh_step() {
    // Infinitely wide, p = 0 at both ends; the step stands on a face, so the two straight branches are met to rounding.
    let (n, ratio, h0) = (1000, 1.8660254037844386, FILM.2);
    for inlet in [0.25, 0.5, 0.718] {
        let step = |x: f64| if x < inlet * LENGTH { (ratio - 1.0) * h0 } else { 0.0 };
        let [load, _, top] = solve(&Slider::new(n, LENGTH, FILM, 0.0, step));
        // p = 6 eta U (h1 - h0) L1 L2 / (h1^3 L2 + h0^3 L1) at the step; the load is half of it times the length.
        let peak = 6.0 * (ratio - 1.0) * inlet * (1.0 - inlet) / (ratio.powi(3) * (1.0 - inlet) + inlet);
        println!("step at {inlet}: load {load} ({:.1e})", load / (peak / 2.0) - 1.0);
        assert!((load / (peak / 2.0) - 1.0).abs() < 1e-4, "{load} instead of {}", peak / 2.0);
        // The largest pressure of a cell stands half a cell away from the step.
        assert!((top / peak - 1.0).abs() < 1.0 / n as f64 / (1.0 - inlet));
        assert!(inlet != 0.718 || (load / 0.206 - 1.0).abs() < 0.5e-3 / 0.206, "{load} at the best step");
    }
}

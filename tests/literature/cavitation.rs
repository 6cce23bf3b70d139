//! Steady films that rupture and conserve oil: the slider with a pocket (Fowell et al. 2007).

use super::Slider;
use crate::common::table;
use stribeck::film::{Cavitation, steady_at};

/// Flux per width and the place where the film forms again, from the closed form.
const FLUX: f64 = 5.229635023923445e-7;
const REFORMATION: f64 = 0.0036112626558133147;
const LENGTH: f64 = 0.01;

struct Pocket {
    flux: f64,
    /// Right face of the last cell with void.
    reformation: f64,
    slider: Slider,
    q: Vec<f64>,
}

/// 1e5 Pa at both ends, cavitation pressure 0; the pocket of 1 um from 2 to 5 mm begins and ends on cell faces.
fn pocket(n: usize) -> Pocket {
    let depth = |x: f64| if (0.002..0.005).contains(&x) { 1e-6 } else { 0.0 };
    let mut slider =
        Slider::new(n, LENGTH, (1.0, 0.01, 1e-6), 1e5, |x| 0.05e-6 * (1.0 - x / LENGTH) + depth(x));
    slider.film.cavitation = Cavitation::MassConserving;
    let state = steady_at(&slider.film, &slider.site(), None).unwrap();
    println!("pocket on {n} cells: {} iterations", state.iterations);
    let last = state.q.iter().rposition(|q| *q < 0.0).unwrap();
    let flux = slider.flux(3 * n / 4, &state.q);
    Pocket { flux, reformation: last as f64 * slider.dx, slider, q: state.q }
}

#[test]
fn pocketed_slider() {
    let all = [500, 1000, 2000, 4000].map(pocket);
    for p in &all {
        println!("flux {:.1e} reformation {:.6}", p.flux / FLUX - 1.0, p.reformation);
        assert!((p.reformation - REFORMATION).abs() <= 2.0 * p.slider.dx, "{}", p.reformation);
    }
    let finest = &all[3];
    assert!((finest.flux / FLUX - 1.0).abs() < 1e-3, "{}", finest.flux);
    // The film ruptures at the entry of the pocket.
    let first = finest.q.iter().position(|q| *q < 0.0).unwrap();
    assert!(((first - 1) as f64 * finest.slider.dx - 0.002).abs() <= finest.slider.dx);
    // Void is carried with first order.
    let order = ((all[0].flux - FLUX) / (finest.flux - FLUX)).abs().log2() / 3.0;
    println!("order {order}");
    assert!((order - 1.0).abs() <= 0.3, "order {order}");
    let rows = table("pocketed_slider_fowell.csv");
    let top = rows.iter().fold(0.0f64, |m, r| m.max(r[1]));
    let found = finest.q.iter().fold(0.0f64, |m, q| m.max(*q));
    println!("peak {:.2e}", found / top - 1.0);
    assert!((found / top - 1.0).abs() < 0.005, "{found} instead of {top}");
    for row in rows {
        // Between the cells left and right of the place; the ends stand on faces.
        let place = row[0] / finest.slider.dx + 0.5;
        let (i, share) = (place.floor() as usize, place.fract());
        let at = |i: usize| finest.q.get(i).map_or(1e5, |q| q.max(0.0));
        let p = (1.0 - share) * at(i) + share * at(i + 1);
        assert!((p - row[1]).abs() < 0.005 * top, "{p} instead of {} at {}", row[1], row[0]);
    }
}

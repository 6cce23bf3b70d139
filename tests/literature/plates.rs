//! A squeeze film between parallel plates that ruptures and heals (Optasanu and Bonneau 2000; Ausas, Jai, Buscaglia 2009).
//!
//! `d/dx(h^3 dp/dx) = 2 d(h theta)/dt` on `0 < x < 1`, p = 0.025 at both ends, cavitation pressure 0,
//! `h = 0.375 + 0.125 cos(4 pi t)`, full at t = 0; mass conserving, implicit Euler.

use super::Slider;
use crate::common::table;
use stribeck::film::{Cavitation, FilmLinear, FilmModel};
use stribeck::math::CyclicBand;

/// Pressure of one unit of the table, Pa.
const UNIT_PA: f64 = 1e7;
const END: f64 = 0.025;
const ONSET: f64 = 0.250079157246517;
const SMALLEST: (f64, f64) = (0.31482586264665263, 0.02300770512112593);
const COLLAPSE: f64 = 0.7323898782892735;

fn gap(t: f64) -> f64 {
    0.375 + 0.125 * (4.0 * std::f64::consts::PI * t).cos()
}

/// The film at the end of a step: time, wetted length from each edge (whole cells), load, relative error of the mass.
struct Instant {
    t: f64,
    wetted: f64,
    load: f64,
    mass_error: f64,
}

fn march(n: usize, steps: usize) -> Vec<Instant> {
    let mut plates = Slider::new(n, 1.0, (0.0, UNIT_PA / 6.0, gap(0.0)), END * UNIT_PA, |_| 0.0);
    plates.film.cavitation = Cavitation::MassConserving;
    let cells = n + 1;
    let (mut linear, mut band) = (FilmLinear::new(cells, 2), CyclicBand::new(cells, 1));
    let (dt, mut q) = (0.75 / steps as f64, vec![END * UNIT_PA; cells]);
    let mut last = vec![0.0; cells];
    plates.film.content(&plates.site(), &q, &mut last);
    let mut all = Vec::new();
    for step in 1..=steps {
        let t = step as f64 * dt;
        plates.input.clearance_m = gap(t);
        let past: Vec<f64> = last.iter().map(|c| -c / dt).collect();
        // The edge of a growing film moves by a cell an iteration: when the cavity opens that is half the film.
        let settled = (0..n).any(|_| {
            plates.film.linearise(&plates.site(), &q, 1.0 / dt, &past, &mut linear);
            band.factor(&linear.stencil).unwrap();
            band.solve(&mut linear.residual);
            q.iter_mut().zip(&linear.residual).for_each(|(q, s)| *q -= s);
            plates.film.change(&q, &linear.residual) < 1e-8
        });
        assert!(settled, "step {step} of {steps} on {n} cells does not settle");
        plates.film.content(&plates.site(), &q, &mut last);
        let rate: Vec<f64> = last.iter().zip(&past).map(|(c, past)| c / dt + past).collect();
        let balance = plates.film.mass_balance(&plates.site(), &q, &rate);
        let full = q[1..].iter().take_while(|q| **q >= 0.0).count();
        // Against the flow at the largest speed of the plates.
        let flow = 0.25 * 2.0 * std::f64::consts::PI * plates.input.width_m;
        all.push(Instant {
            t,
            wetted: (full as f64 / n as f64).min(0.5),
            load: q[1..].iter().map(|q| q.max(0.0) / UNIT_PA).sum::<f64>() / n as f64,
            mass_error: balance.error / flow,
        });
    }
    all
}

#[test]
fn squeeze_film_with_cavitation() {
    let (n, steps) = (1000, 7500);
    let film = march(n, steps);
    let dx = 1.0 / n as f64;
    let ruptured: Vec<&Instant> = film.iter().filter(|i| i.wetted < 0.5).collect();
    let (onset, collapse) = (ruptured[0].t, ruptured[ruptured.len() - 1].t);
    println!("onset {:.1e} collapse {:.1e}", onset / ONSET - 1.0, collapse / COLLAPSE - 1.0);
    assert!((onset / ONSET - 1.0).abs() < 0.002, "onset {onset}");
    assert!((collapse / COLLAPSE - 1.0).abs() < 0.005, "collapse {collapse}");
    let smallest = film.iter().map(|i| i.wetted).fold(1.0, f64::min);
    let when: Vec<f64> = film.iter().filter(|i| i.wetted == smallest).map(|i| i.t).collect();
    println!("smallest {smallest} from {} to {}", when[0], when[when.len() - 1]);
    // Whole cells: the length is known to one cell, and its time to the steps in which that cell is the last.
    assert!((smallest - SMALLEST.1).abs() <= dx, "smallest wetted length {smallest}");
    assert!(when[0] <= SMALLEST.0 && SMALLEST.0 <= when[when.len() - 1]);
    let leak = film.iter().map(|i| i.mass_error.abs()).fold(0.0, f64::max);
    println!("mass {leak:.1e}");
    assert!(leak < 1e-10, "mass is lost: {leak}");
    compare(&film, steps, dx);
}

fn compare(film: &[Instant], steps: usize, dx: f64) {
    let (mut worst, mut worst_load) = (0.0f64, [0.0f64; 2]);
    for row in table("squeeze_cavitation.csv").iter().skip(1) {
        let [t, _, wetted, load, _] = row[..] else { panic!("five columns") };
        let at = &film[(t / 0.75 * steps as f64).round() as usize - 1];
        assert!((at.t - t).abs() < 1e-9);
        if (0.25..=0.26).contains(&t) || t == 0.75 {
            continue;
        }
        worst = worst.max((at.wetted - wetted).abs());
        // A film of few wetted cells carries next to nothing: absolute there, as in the source.
        let miss = (at.load - load).abs();
        println!("t {t} wetted {:+.4} load {load:.5} {miss:.1e} {:.1e}", at.wetted - wetted, miss / load);
        assert!((at.wetted - wetted).abs() <= 0.005, "wetted {} not {wetted} at {t}", at.wetted);
        assert!(miss <= f64::max(0.01 * load, 2e-4), "load {} not {load} at {t}", at.load);
        worst_load[usize::from(wetted < 0.5)] = worst_load[usize::from(wetted < 0.5)].max(miss / load);
    }
    println!("wetted length within {worst:.4} (cell {dx}); load within {worst_load:?}");
}

//! Manufactured checks that need no data: power, mass, contact.

use super::size;
use crate::common::bearing;
use crate::common::films::{live_oil, touching};
use std::f64::consts::PI;
use stribeck::film::{
    Axial, Cavitation, CavityShear, Feed, FilmInput, FilmLinear, FilmModel, FilmSite, Mesh, Opening,
    Reynolds, Roughness, steady, steady_at,
};
use stribeck::math::CyclicBand;

/// `Int p c' dA` over the meshed part, times its copies.
fn squeeze_power(film: &Reynolds, u: &FilmInput, q: &[f64], rate: &[f64]) -> f64 {
    let area = u.diameter_m / 2.0 * film.mesh.d_phi() * u.width_m * film.mesh.cell_share();
    let p = |k: usize| q[k].max(if film.cavitation == Cavitation::None { f64::MIN } else { 0.0 });
    let sum: f64 = rate.iter().enumerate().map(|(k, c)| (p(k) + film.cavitation_pressure_pa) * c).sum();
    sum * area * film.mesh.copies()
}

#[test]
fn wall_power_is_dissipation_squeeze_and_what_flows_over_the_edges() {
    // Smooth, incompressible, no rupture; side pressure 2e5 Pa, with and without a column held at 5e5 Pa.
    for (axial, held) in [(Axial::Half, vec![]), (Axial::Full, vec![]), (Axial::Full, vec![(7, 5e5)])] {
        let film = Reynolds {
            cavitation: Cavitation::None,
            side_pressure_pa: 2e5,
            cavitation_pressure_pa: -3e4,
            held_columns: held,
            ..Reynolds::new(Mesh::new(48, 6, axial))
        };
        let mut u = bearing(0.7, 0.5, 100.0);
        u.velocity_m_s = [2e-3, -1e-3];
        let state = steady(&film, &u).unwrap();
        let balance = film.mass_balance(&u.into(), &state.q, &state.rate);
        let fed = film.held_columns.first().map_or(0.0, |(_, p)| p * balance.supply);
        let edges = film.side_pressure_pa * balance.side;
        let sum = state.output.dissipation_w + squeeze_power(&film, &u, &state.q, &state.rate) + edges - fed;
        println!("power {:.1e} {edges} {fed}", state.output.loss_w / sum - 1.0);
        assert!((state.output.loss_w / sum - 1.0).abs() < 1e-8, "{} {sum}", state.output.loss_w);
    }
}

#[test]
fn wall_power_is_dissipation_and_squeeze_power_where_the_film_ruptures() {
    // p = 0 at both edges: the squeeze power is that of force and velocity.
    for cavitation in [Cavitation::None, Cavitation::SwiftStieber] {
        let film = Reynolds { cavitation, ..Reynolds::new(Mesh::new(48, 6, Axial::Full)) };
        let mut u = bearing(0.7, 0.5, 100.0);
        u.velocity_m_s = [2e-3, -1e-3];
        let y = steady(&film, &u).unwrap().output;
        let squeeze = y.force_n[0] * u.velocity_m_s[0] + y.force_n[1] * u.velocity_m_s[1];
        assert!(((y.loss_w - squeeze) / y.dissipation_w - 1.0).abs() < 1e-11);
    }
}

#[test]
fn half_and_full_width_are_the_same_film() {
    let u = bearing(0.8, 0.5, 100.0);
    let half = steady(&Reynolds::new(Mesh::new(48, 5, Axial::Half)), &u).unwrap().output;
    let full = steady(&Reynolds::new(Mesh::new(48, 10, Axial::Full)), &u).unwrap().output;
    for (a, b) in [
        (half.force_n[0], full.force_n[0]),
        (half.loss_w, full.loss_w),
        (half.side_flow_m3_s, full.side_flow_m3_s),
    ] {
        assert!((a / b - 1.0).abs() < 1e-10);
    }
}

/// A mass-conserving film fed by a groove at the widest gap or by a small hole.
fn fed(opening: Opening) -> Reynolds {
    Reynolds {
        cavitation: Cavitation::MassConserving,
        cavity_shear: CavityShear::Fill,
        cavitation_pressure_pa: -5e4,
        feeds: vec![Feed { opening, on_journal: false }],
        ..Reynolds::new(Mesh::new(72, 8, Axial::Half))
    }
}

const GROOVE: Opening = Opening::AxialGroove { angle_rad: PI, extent_rad: 0.4, length_share: 0.7 };
const HOLE: Opening = Opening::Hole { angle_rad: 2.0, centre_zeta: 0.0, radius_rad: 0.1, radius_zeta: 0.2 };

#[test]
fn oil_is_conserved_by_steady_films() {
    // Well fed and starved; plain oil and one that is compressed; smooth and rough.
    for (opening, supply_pressure_pa) in [(GROOVE, 2e5), (GROOVE, 1e2), (HOLE, 2e5), (HOLE, 1e2)] {
        let mut u = bearing(0.8, 0.5, 100.0);
        (u.supply_pressure_pa, u.journal_roughness_m, u.shell_roughness_m) = (supply_pressure_pa, 1e-6, 2e-6);
        let plain = fed(opening);
        let live = Reynolds { oil: live_oil(), ..plain.clone() };
        let rough = Reynolds { rough: Some(touching()), ..live.clone() };
        for film in [plain, live, rough] {
            let state = steady(&film, &u).unwrap();
            let void = state.q.iter().filter(|q| **q < 0.0).count();
            let balance = film.mass_balance(&u.into(), &state.q, &state.rate);
            println!("{supply_pressure_pa} void {void} {balance:?} {}", state.iterations);
            assert!(void > 0 && balance.side != 0.0);
            assert!(balance.error.abs() <= 1e-10 * balance.side.abs(), "{opening:?} {balance:?}");
        }
    }
}

#[test]
fn oil_is_conserved_by_every_step() {
    // Well fed and starved.
    for (opening, supply_pressure_pa) in [(GROOVE, 1e5), (GROOVE, 1e3), (HOLE, 1e5)] {
        march(&fed(opening), supply_pressure_pa);
    }
}

/// The journal goes around at half its speed, the film remembers its oil; implicit Euler.
fn march(film: &Reynolds, supply_pressure_pa: f64) {
    let (n, dt) = (film.unknowns(), 2e-4);
    let place = |step: usize| {
        let mut u = bearing(0.0, 0.5, 100.0);
        let (s, c) = (50.0 * dt * step as f64).sin_cos();
        (u.eccentricity_m, u.supply_pressure_pa) =
            ([0.7 * c, 0.8 * s].map(|x| x * u.clearance_m), supply_pressure_pa);
        u
    };
    let (mut linear, mut band) = (FilmLinear::new(n, 2), CyclicBand::new(72, 8));
    let mut q = steady(film, &place(0)).unwrap().q;
    let mut last = vec![0.0; n];
    film.content(&place(0).into(), &q, &mut last);
    for step in 1..100 {
        let site = FilmSite::from(place(step));
        let past: Vec<f64> = last.iter().map(|c| -c / dt).collect();
        let settled = (0..40).any(|_| {
            film.linearise(&site, &q, 1.0 / dt, &past, &mut linear);
            band.factor(&linear.stencil).unwrap();
            band.solve(&mut linear.residual);
            q.iter_mut().zip(&linear.residual).for_each(|(q, s)| *q -= s);
            film.change(&q, &linear.residual) < 1e-11
        });
        assert!(settled, "step {step}");
        film.content(&site, &q, &mut last);
        let rate: Vec<f64> = last.iter().zip(&past).map(|(c, p)| c / dt + p).collect();
        let balance = film.mass_balance(&site, &q, &rate);
        assert!(balance.error.abs() <= 1e-10 * balance.side.abs(), "step {step}: {balance:?}");
        assert!(balance.stored != 0.0 && last.iter().all(|c| *c >= 0.0));
    }
}

#[test]
fn contact_carries_load_and_more_of_it_on_rougher_surfaces() {
    // eps = 0.98: the smallest gap is 1 um; Swift-Stieber, p = 0 at both edges.
    let force = |sigma: f64, contact: bool| {
        let pair = touching();
        let rough = Roughness { contact: pair.contact.filter(|_| contact), ..pair };
        let film = Reynolds { rough: Some(rough), ..Reynolds::new(Mesh::new(120, 8, Axial::Half)) };
        let mut u = bearing(0.98, 0.5, 20.0);
        (u.journal_roughness_m, u.shell_roughness_m) = (0.8 * sigma, 0.6 * sigma);
        steady_at(&film, &u.into(), None).unwrap().output
    };
    let all = [0.2e-6, 0.4e-6, 0.8e-6].map(|sigma| (force(sigma, true), force(sigma, false)));
    for (with, without) in &all {
        println!(
            "force {:?} {:?} loss {} {}",
            with.force_n, without.force_n, with.loss_w, with.contact_loss_w
        );
        assert!(without.contact_loss_w == 0.0 && without.contact_peak_pa == 0.0);
        assert!(size(with.force_n) >= size(without.force_n));
    }
    assert!(all.windows(2).all(|w| size(w[1].0.force_n) > size(w[0].0.force_n)));
    assert!(all.windows(2).all(|w| w[1].0.contact_loss_w > w[0].0.contact_loss_w));
}

//! The Stribeck curve of three bearings (Sander et al., conrod test rig at 10 MPa): measured shaft torque over speed.
//!
//! Here all bodies are rigid and the film is isothermal at 100 C; the measured bearings are elastic, which spreads the load
//! and thins the film less at its smallest gap. So shape and place of the minimum are compared, not the torque itself.
//! Mass conserving, cavitation at 100 Pa absolute, ambient pressure at both edges, grooves of the supports over the unloaded
//! 180 degrees at ambient pressure, shear with the fill. The Peklenik number 12 of the shell is taken at the end of the
//! tables, 9.

use super::size;
use super::stiffness::{Response, newton, response};
use std::f64::consts::{FRAC_PI_2, PI};
use stribeck::film::{
    Axial, Cavitation, CavityShear, Feed, FilmInput, FilmModel, Mesh, Oil, Opening, Reynolds, Roughness,
    steady,
};
use stribeck::laws::{
    Compressibility, ContactIntegral, GreenwoodTripp, Piezoviscosity, RoughSurfaces, ShearThinning,
};

const JOURNAL_M: f64 = 0.2e-6;
const SHELL_M: f64 = 0.34e-6;
/// Speed in rpm and shaft torque in N m, digitised by the peer from the publication.
const MEASURED: [(f64, f64); 8] = [
    (3000.0, 1.06),
    (1000.0, 0.544),
    (500.0, 0.43),
    (400.0, 0.46),
    (300.0, 0.58),
    (250.0, 0.747),
    (200.0, 1.076),
    (150.0, 1.71),
];

fn roughness() -> Roughness {
    let sigma = JOURNAL_M.hypot(SHELL_M);
    let contact = GreenwoodTripp {
        integral: ContactIntegral::Exact,
        elastic_factor: 1e-3,
        modulus_pa: 53.3e9,
        summit_sigma_ratio: 0.13e-6f64.hypot(0.28e-6) / sigma,
        summit_height_ratio: (0.21e-6 + 0.39e-6) / sigma,
        asperity_product: 0.05,
    };
    Roughness {
        surfaces: RoughSurfaces::new(4.0, 9.0, JOURNAL_M, SHELL_M).unwrap(),
        contact: Some(contact),
        boundary_friction: 0.02,
        depth_m: 2e-6,
    }
}

/// A bearing whose load of `load_n` stands along x, and its state.
struct Bearing {
    film: Reynolds,
    input: FilmInput,
    load_n: f64,
    q: Vec<f64>,
}

impl Bearing {
    fn new(diameter_m: f64, width_m: f64, load_n: f64, feeds: Vec<Feed>, speed_rad_s: f64) -> Self {
        let film = Reynolds {
            cavitation: Cavitation::MassConserving,
            cavity_shear: CavityShear::Fill,
            cavitation_pressure_pa: 100.0 - 1e5,
            feeds,
            oil: Oil {
                piezoviscosity: Piezoviscosity::Barus { coefficient_per_pa: 9.5e-9 },
                compressibility: Compressibility::Incompressible,
                shear_thinning: ShearThinning::Newtonian,
            },
            rough: Some(roughness()),
            ..Reynolds::new(Mesh::new(180, 8, Axial::Half))
        };
        let mut input =
            FilmInput::at_rest(0.8, width_m, diameter_m, 0.5e-3 * diameter_m, 0.0068, speed_rad_s);
        (input.journal_roughness_m, input.shell_roughness_m) = (JOURNAL_M, SHELL_M);
        let q = steady(&film, &input).unwrap().q;
        Self { film, input, load_n, q }
    }

    /// Newton's method on the balance of forces, every step of it on a steady film, shortened until it is an improvement.
    fn balance(&mut self, speed_rad_s: f64) -> usize {
        self.input.speed_rad_s = speed_rad_s;
        let mut here = self.response(self.input).expect("a film at the place of the speed before");
        for iteration in 1..100 {
            let off = self.off(&here);
            if size(off) < 1e-8 * self.load_n {
                return iteration;
            }
            let step = newton(here.by_position, off);
            let mut share = self.film.admissible(&self.input.into(), [step[0], step[1], 0.0, 0.0], 0.5);
            here = loop {
                let mut next = self.input;
                (0..2).for_each(|a| next.eccentricity_m[a] += share * step[a]);
                let there = self.response(next);
                if let Some(there) = there.filter(|r| size(self.off(r)) < size(off)) {
                    self.input = next;
                    break there;
                }
                share *= 0.5;
                assert!(share > 1e-6, "no way down from {off:?} N at {speed_rad_s} rad/s");
            };
        }
        panic!("no balance at {speed_rad_s} rad/s");
    }

    fn off(&self, r: &Response) -> [f64; 2] {
        [r.force[0] + self.load_n, r.force[1]]
    }

    /// The response at an input; the unknowns are kept where the film was found.
    fn response(&mut self, input: FilmInput) -> Option<Response> {
        response(&self.film, &input, &mut self.q)
    }
}

#[test]
fn torque_has_its_minimum_where_contact_takes_over() {
    let groove = Opening::AxialGroove { angle_rad: PI, extent_rad: PI, length_share: 0.2 };
    let grooved = vec![Feed { opening: groove, on_journal: false }];
    let hole = Opening::AxialGroove { angle_rad: FRAC_PI_2 + PI, extent_rad: 0.2, length_share: 0.2 };
    let fed = vec![Feed { opening: hole, on_journal: false }];
    let first = MEASURED[0].0 * PI / 30.0;
    let mut test = Bearing::new(0.0478, 0.0172, 8000.0, fed, first);
    let mut support = Bearing::new(0.054, 0.025, 4000.0, grooved, first);
    let mut torques = Vec::new();
    println!("speed rpm, torque Nm computed (contact) measured, smallest gaps um, iterations");
    for (rpm, measured) in MEASURED {
        let speed = rpm * PI / 30.0;
        let iterations = [test.balance(speed), support.balance(speed)];
        let y = [&test, &support].map(|b| b.film.output(&b.input.into(), &b.q));
        let sum = |of: fn(&stribeck::film::FilmOutput) -> f64| (of(&y[0]) + 2.0 * of(&y[1])) / speed;
        let contact = sum(|y| y.contact_loss_w);
        let torque = sum(|y| y.loss_w) + contact;
        let gaps = y.map(|y| y.gap_min_m * 1e6);
        println!("{rpm:5} {torque:.3} ({contact:.3}) {measured:.3} {gaps:.3?} {iterations:?}");
        torques.push(torque);
    }
    let lowest = (0..torques.len()).min_by(|a, b| torques[*a].total_cmp(&torques[*b])).unwrap();
    assert!((300.0..=1000.0).contains(&MEASURED[lowest].0), "minimum at {} rpm", MEASURED[lowest].0);
    assert!(torques[lowest..].windows(2).all(|w| w[1] > w[0]), "torque rises to low speed");
    assert!(torques[..=lowest].windows(2).all(|w| w[1] < w[0]), "torque rises to high speed");
}

//! A short bearing under a load that turns, by Booker's mobility (J. Basic Eng. 87, 1965; short film: J. Lubr. Tech. 93, 1971).
//!
//! ```text
//! e' = W (C/R)^2 C / (mu L D) (M_xi, M_eta) + w_j/2 x e,     xi, eta: e/C along and across the load
//! M_xi = (1 - xi)^(5/2) / (pi (L/D)^2),     M_eta = -4 eta (1 - xi)^(3/2) / (pi^2 (L/D)^2)
//! ```
//!
//! A load of constant size that turns with `w_W` has a circle as its orbit, the eccentricity of which is that under a
//! steady load at the speed `|w_j - 2 w_W|`:
//!
//! ```text
//! W (C/R)^2 D / (mu L^3 |w_j/2 - w_W|) = pi eta / (1 - xi)^(5/2),     4 eta^2 = pi xi (1 - xi)
//! ```

use super::{gradient, ladder, options};
use std::f64::consts::{PI, TAU};
use stribeck::dae::{Dense, Equations, Instant, InvalidParameters, Number, Sizes};
use stribeck::gradient::{EngineName, check_ladder};
use stribeck::orbit::{OrbitOptions, Quantity, Reduction, settle};
use stribeck::run::Cancel;

const JOURNAL_RAD_S: f64 = 200.0;
/// As an unbalance of the journal turns.
const LOAD_RAD_S: f64 = 200.0;
const DIAMETER_M: f64 = 0.06;
/// Load N, width m, radial clearance m, viscosity Pa s.
const AT: [f64; 4] = [3e3, 0.03, 40e-6, 0.02];

/// Speed of the entrainment seen from the load.
fn effective_rad_s() -> f64 {
    (JOURNAL_RAD_S / 2.0 - LOAD_RAD_S).abs()
}

#[derive(Clone)]
struct Mobility;

impl Equations for Mobility {
    fn sizes(&self) -> Sizes {
        Sizes { states: 2, memories: 2, outputs: 1 }
    }

    fn period_s(&self) -> f64 {
        TAU / LOAD_RAD_S
    }

    fn state_scale(&self) -> Vec<f64> {
        vec![50e-6; 2]
    }

    fn memory<T: Number>(&self, at: Instant<T>, memory: &mut [T]) {
        memory.copy_from_slice(at.z);
    }

    fn residual<T: Number>(&self, at: Instant<T>, residual: &mut [T]) {
        let ([x, y], [dx, dy], [load, width, clearance, viscosity]) = at.parts();
        let (s, c) = (LOAD_RAD_S * at.t_s).sin_cos();
        let (xi, eta) = ((x * c + y * s) / clearance, (y * c - x * s) / clearance);
        let gap = -xi + 1.0;
        let slender = width / DIAMETER_M;
        let speed = load * (clearance / (DIAMETER_M / 2.0)).powi(2) * clearance
            / (viscosity * width * DIAMETER_M * slender * slender);
        let along = speed * gap * gap * gap.sqrt() / PI;
        let across = -speed * eta * gap * gap.sqrt() * 4.0 / (PI * PI);
        residual[0] = dx - (along * c - across * s) + y * (JOURNAL_RAD_S / 2.0);
        residual[1] = dy - (along * s + across * c) - x * (JOURNAL_RAD_S / 2.0);
    }

    /// Eccentricity ratio.
    fn output<T: Number>(&self, at: Instant<T>, output: &mut [T]) {
        let ([x, y], [_, _], [_, _, clearance, _]) = at.parts();
        output[0] = (x * x + y * y).sqrt() / clearance;
    }

    fn contains(&self, z: &[f64], p: &[f64]) -> bool {
        z[0].hypot(z[1]) < p[2]
    }

    fn check(&self, p: &[f64]) -> Result<(), InvalidParameters> {
        let sound = p[1..].iter().all(|v| *v > 0.0);
        if sound {
            Ok(())
        } else {
            Err(InvalidParameters("width, clearance and viscosity are above zero".into()))
        }
    }
}

/// Eccentricity ratio of the circle and its derivative by the logarithm of the load.
fn closed_form() -> (f64, f64) {
    let [load, width, clearance, viscosity] = AT;
    let number = load * (2.0 * clearance / DIAMETER_M).powi(2) * DIAMETER_M
        / (viscosity * width.powi(3) * effective_rad_s());
    let eta = |xi: f64| (PI * xi * (1.0 - xi)).sqrt() / 2.0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let xi = (low + high) / 2.0;
        if PI * eta(xi) < number * (1.0 - xi).powf(2.5) { low = xi } else { high = xi }
    }
    let xi = low;
    let eps = xi.hypot(eta(xi));
    let eps_by_xi = (2.0 * xi + PI / 4.0 * (1.0 - 2.0 * xi)) / (2.0 * eps);
    let log_by_xi = (1.0 - 2.0 * xi) / (2.0 * xi * (1.0 - xi)) + 2.5 / (1.0 - xi);
    (eps, eps_by_xi / log_by_xi)
}

#[test]
fn a_rotating_load_leads_the_journal_on_bookers_circle() {
    let mean = [Quantity { output: 0, reduction: Reduction::Mean }];
    let model = Dense::new(Mobility, &AT).unwrap();
    let (eps, by_log) = closed_form();
    let miss = |steps: usize| {
        let options = OrbitOptions { steps, ..options() };
        let orbit = settle(&model, &options, None, &Cancel::default()).unwrap();
        let round = orbit.outputs.iter().fold(0.0f64, |a, y| a.max((y[0] - orbit.mean(0)).abs()));
        assert!(round < 1e-12, "a circle: {round}");
        let row = &gradient(EngineName::Adj, &model, &orbit, &options, &mean).rows[0];
        // The load number goes with W, L^-3, C^2, mu^-1.
        let powers = [1.0, -3.0, 2.0, -1.0];
        let slope = |j: usize| (row[j] * AT[j] / (powers[j] * by_log) - 1.0).abs();
        ladder::assert_sound("mobility", &check_ladder(&model, &orbit).unwrap());
        [(orbit.mean(0) / eps - 1.0).abs(), (0..4).map(slope).fold(0.0, f64::max)]
    };
    let (coarse, fine) = (miss(180), miss(360));
    for k in 0..2 {
        let order = (coarse[k] / fine[k]).log2();
        println!("eps {eps}: {:.2e} {:.2e}, order {order:.2}", coarse[k], fine[k]);
        assert!((order - 2.0).abs() < 0.1 && fine[k] < 1e-3);
    }
    assert!(model.equations().check(&[3e3, 0.03, -1e-6, 0.02]).is_err());
}

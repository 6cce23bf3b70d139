//! One dynamically loaded journal bearing as a periodic differential-algebraic system.
//!
//! ```text
//! z = (q, e)        0 = r(q, e, e')                                         film
//!                   0 = f(q, e, e') + W(t)                                  massless journal
//! z = (q, e, v)     0 = e' - v
//!                   0 = m (v' + 2 O x v + O' x e + O x (O x e)) - f - W     journal with mass in a turning shell
//! ```
//!
//! `W` is the load of the journal on the shell, `f` the film's force on the journal, `O` the shell's angular velocity.
//! The film's unknowns `q` have no memory; the journal's position (and velocity) has.
//!
//! Parameters are any of [`BearingParameter`]; the viscosity follows the film temperature, which is the oil's inlet
//! temperature plus a given rise. Deliberately not here: the heat balance that would make that rise a result.

use super::{BearingLoad, Drive};
use crate::dae::{At, Cotangent, Dae, Direction, InvalidParameters, LinearisedDae, SensitiveDae};
use crate::film::{FilmInput, FilmModel, FilmOutput, Gap};
use crate::laws::Viscosity;
use crate::math::{Bordered, Singular, Stencil};
use std::sync::Arc;

/// Share of the smallest gap that one Newton step must leave.
const KEEP_GAP: f64 = 0.2;
/// Pressures below this count as small when changes are judged, Pa.
const SMALL_PRESSURE_PA: f64 = 1e5;

/// What can be varied about a bearing; all values in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BearingParameter {
    /// Width, m.
    Width,
    /// Diameter, m.
    Diameter,
    /// Diametral clearance, m.
    DiametralClearance,
    /// Temperature of the oil at the inlet, K.
    InletTemperature,
}

/// What a bearing reports at every instant, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BearingOutput {
    /// Hydrodynamic friction loss (power of the wall shear stress), W.
    Loss,
    /// Power dissipated in the oil, W.
    Dissipation,
    /// Smallest gap, m.
    GapMin,
    /// Smooth maximum of the film pressure, Pa.
    PressurePeak,
    /// Load over projected area, Pa.
    SpecificLoad,
    /// Oil leaving at both edges, m3/s.
    SideFlow,
}

impl BearingOutput {
    /// All outputs in their order.
    pub const ALL: [Self; 6] =
        [Self::Loss, Self::Dissipation, Self::GapMin, Self::PressurePeak, Self::SpecificLoad, Self::SideFlow];

    /// Position in the output vector.
    pub fn index(self) -> usize {
        Self::ALL.iter().position(|o| *o == self).expect("ALL holds every output")
    }
}

/// Everything that defines a bearing apart from what is varied.
#[derive(Clone)]
pub struct BearingSetup {
    /// Film model.
    pub film: Arc<dyn FilmModel>,
    /// Load over the cycle.
    pub load: Arc<BearingLoad>,
    /// Speed of the crankshaft, rad/s.
    pub speed_rad_s: f64,
    /// Viscosity of the oil.
    pub viscosity: Viscosity,
    /// Film temperature less inlet temperature, K.
    pub film_rise_k: f64,
    /// Mass that moves with the journal, kg; 0 for a massless journal.
    pub journal_mass_kg: f64,
    /// Width, m.
    pub width_m: f64,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Diametral clearance, m.
    pub diametral_clearance_m: f64,
    /// Temperature of the oil at the inlet, K.
    pub inlet_temperature_k: f64,
    /// Which of the above are the parameters `p`, in order.
    pub parameters: Vec<BearingParameter>,
}

impl BearingSetup {
    fn slot(&mut self, parameter: BearingParameter) -> &mut f64 {
        match parameter {
            BearingParameter::Width => &mut self.width_m,
            BearingParameter::Diameter => &mut self.diameter_m,
            BearingParameter::DiametralClearance => &mut self.diametral_clearance_m,
            BearingParameter::InletTemperature => &mut self.inlet_temperature_k,
        }
    }
}

/// A journal bearing at given parameters.
#[derive(Clone)]
pub struct JournalBearing {
    setup: BearingSetup,
    p: Vec<f64>,
    viscosity_pa_s: f64,
    viscosity_slope: f64,
    memory: Vec<usize>,
    n: usize,
}

impl JournalBearing {
    /// A bearing at the values of its setup.
    pub fn new(mut setup: BearingSetup) -> Result<Self, InvalidParameters> {
        let parameters = setup.parameters.clone();
        let p: Vec<f64> = parameters.iter().map(|&k| *setup.slot(k)).collect();
        let positive = [
            ("width", setup.width_m),
            ("diameter", setup.diameter_m),
            ("diametral clearance", setup.diametral_clearance_m),
            ("inlet temperature", setup.inlet_temperature_k),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(InvalidParameters(format!("{name} must be a positive number, found {value}")));
            }
        }
        let (viscosity_pa_s, viscosity_slope) =
            setup.viscosity.at(setup.inlet_temperature_k + setup.film_rise_k);
        if !(viscosity_pa_s > 0.0 && viscosity_pa_s.is_finite()) {
            return Err(InvalidParameters(format!(
                "the oil has no viscosity at {:.1} K",
                setup.inlet_temperature_k + setup.film_rise_k
            )));
        }
        let (blocks, b) = setup.film.shape();
        let n = blocks * b;
        let dynamic = if setup.journal_mass_kg > 0.0 { 4 } else { 2 };
        Ok(Self { memory: (n..n + dynamic).collect(), n, p, viscosity_pa_s, viscosity_slope, setup })
    }

    /// What defines this bearing.
    pub fn setup(&self) -> &BearingSetup {
        &self.setup
    }

    /// The drive at a time.
    pub fn drive(&self, t_s: f64) -> Drive {
        self.setup.load.at(t_s * self.setup.speed_rad_s, self.setup.speed_rad_s)
    }

    /// What the film sees.
    pub fn film_input(&self, at: At) -> FilmInput {
        FilmInput {
            eccentricity_m: self.pair(at.z, 0),
            velocity_m_s: self.pair(at.rate, 0),
            speed_rad_s: self.drive(at.t_s).relative_speed_rad_s,
            width_m: self.setup.width_m,
            diameter_m: self.setup.diameter_m,
            clearance_m: self.setup.diametral_clearance_m / 2.0,
            viscosity_pa_s: self.viscosity_pa_s,
        }
    }

    /// The film's part of a state.
    pub fn film_unknowns<'a>(&self, z: &'a [f64]) -> &'a [f64] {
        &z[..self.n]
    }

    /// Dynamic viscosity at the film temperature, Pa s.
    pub fn viscosity_pa_s(&self) -> f64 {
        self.viscosity_pa_s
    }

    fn has_mass(&self) -> bool {
        self.memory.len() == 4
    }

    /// Position (`k = 0`) or velocity (`k = 1`) in a state vector.
    fn pair(&self, z: &[f64], k: usize) -> [f64; 2] {
        [z[self.n + 2 * k], z[self.n + 2 * k + 1]]
    }

    /// Change of the film's input for changes of position, velocity and parameters.
    fn input_change(&self, de: [f64; 2], dv: [f64; 2], dp: &[f64]) -> FilmInput {
        let mut du = FilmInput { eccentricity_m: de, velocity_m_s: dv, ..Default::default() };
        for (kind, d) in self.setup.parameters.iter().zip(dp) {
            match kind {
                BearingParameter::Width => du.width_m += d,
                BearingParameter::Diameter => du.diameter_m += d,
                BearingParameter::DiametralClearance => du.clearance_m += d / 2.0,
                BearingParameter::InletTemperature => du.viscosity_pa_s += self.viscosity_slope * d,
            }
        }
        du
    }

    /// Adds derivatives by the film's input to derivatives by the parameters.
    fn pull_parameters(&self, u_bar: &FilmInput, p_bar: &mut [f64]) {
        for (kind, bar) in self.setup.parameters.iter().zip(p_bar) {
            *bar += match kind {
                BearingParameter::Width => u_bar.width_m,
                BearingParameter::Diameter => u_bar.diameter_m,
                BearingParameter::DiametralClearance => u_bar.clearance_m / 2.0,
                BearingParameter::InletTemperature => self.viscosity_slope * u_bar.viscosity_pa_s,
            };
        }
    }

    /// Sign of the film force in its row, and the first of the two rows it stands in.
    fn force_row(&self) -> (f64, usize) {
        if self.has_mass() { (-1.0, self.n + 2) } else { (1.0, self.n) }
    }

    /// `out += F_u du` for film and force rows.
    fn input_times(&self, at: At, du: &FilmInput, out: &mut [f64]) {
        let (u, q) = (self.film_input(at), self.film_unknowns(at.z));
        self.setup.film.residual_tangent(&u, q, du, &mut out[..self.n]);
        let df = self.setup.film.force_tangent(&u, q, du);
        let (sign, row) = self.force_row();
        out[row] += sign * df[0];
        out[row + 1] += sign * df[1];
    }

    /// `F_u^T lambda`.
    fn input_transposed_times(&self, at: At, lambda: &[f64]) -> FilmInput {
        let (u, q) = (self.film_input(at), self.film_unknowns(at.z));
        let mut bar = self.setup.film.residual_cotangent(&u, q, &lambda[..self.n]);
        let (sign, row) = self.force_row();
        let weights = [sign * lambda[row], sign * lambda[row + 1]];
        bar.add(&self.setup.film.force_cotangent(&u, q, weights, None));
        bar
    }

    /// Mean pressure of the load on the projected area.
    fn specific_load_pa(&self, t_s: f64) -> f64 {
        let [x, y] = self.drive(t_s).load_n;
        x.hypot(y) / (self.setup.width_m * self.setup.diameter_m)
    }
}

impl Dae for JournalBearing {
    fn states(&self) -> usize {
        self.n + self.memory.len()
    }

    fn memory(&self) -> &[usize] {
        &self.memory
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn period_s(&self) -> f64 {
        self.setup.load.cycle_rad() / self.setup.speed_rad_s
    }

    fn outputs(&self) -> usize {
        BearingOutput::ALL.len()
    }

    fn cold_start(&self) -> Vec<f64> {
        let mut z = vec![0.0; self.states()];
        // Half way towards the load, where most films carry something.
        let [x, y] = self.drive(0.0).load_n;
        let size = x.hypot(y).max(f64::MIN_POSITIVE);
        z[self.n] = 0.25 * self.setup.diametral_clearance_m * x / size;
        z[self.n + 1] = 0.25 * self.setup.diametral_clearance_m * y / size;
        z
    }

    fn residual(&self, at: At, out: &mut [f64]) {
        let (u, q) = (self.film_input(at), self.film_unknowns(at.z));
        let drive = self.drive(at.t_s);
        let n = self.n;
        self.setup.film.residual(&u, q, &mut out[..n]);
        let f = self.setup.film.force_n(&u, q);
        if !self.has_mass() {
            out[n] = f[0] + drive.load_n[0];
            out[n + 1] = f[1] + drive.load_n[1];
            return;
        }
        let (e, v) = (self.pair(at.z, 0), self.pair(at.z, 1));
        let (de, dv) = (self.pair(at.rate, 0), self.pair(at.rate, 1));
        let (o, o1, m) =
            (drive.shell_speed_rad_s, drive.shell_acceleration_rad_s2, self.setup.journal_mass_kg);
        out[n] = de[0] - v[0];
        out[n + 1] = de[1] - v[1];
        out[n + 2] = m * (dv[0] - 2.0 * o * v[1] - o1 * e[1] - o * o * e[0]) - f[0] - drive.load_n[0];
        out[n + 3] = m * (dv[1] + 2.0 * o * v[0] + o1 * e[0] - o * o * e[1]) - f[1] - drive.load_n[1];
    }

    fn output(&self, at: At, y: &mut [f64]) {
        let film = self.setup.film.output(&self.film_input(at), self.film_unknowns(at.z));
        y.copy_from_slice(&[
            film.loss_w,
            film.dissipation_w,
            film.gap_min_m,
            film.pressure_peak_pa,
            self.specific_load_pa(at.t_s),
            film.side_flow_m3_s,
        ]);
    }

    fn change(&self, z: &[f64], dz: &[f64]) -> f64 {
        // Maxima pass over what is no number, so that is looked for first.
        if dz.iter().any(|v| !v.is_finite()) {
            return f64::NAN;
        }
        let top = self.film_unknowns(z).iter().fold(SMALL_PRESSURE_PA, |a, q| a.max(q.abs()));
        let pressure = self.film_unknowns(dz).iter().fold(0.0f64, |a, q| a.max(q.abs())) / top;
        let clearance = self.setup.diametral_clearance_m / 2.0;
        let size = |k: usize| self.pair(dz, k).iter().fold(0.0f64, |a, d| a.max(d.abs()));
        let motion = size(0) / clearance;
        let speed = if self.has_mass() { size(1) / (clearance * self.setup.speed_rad_s) } else { 0.0 };
        pressure.max(motion).max(speed)
    }

    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters> {
        let mut setup = self.setup.clone();
        for (kind, value) in self.setup.parameters.iter().zip(p) {
            *setup.slot(*kind) = *value;
        }
        Self::new(setup)
    }
}

/// Factors of one step of a bearing.
pub struct BearingFactors {
    system: Bordered,
    stencil: Stencil,
}

impl LinearisedDae for JournalBearing {
    type Factors = BearingFactors;

    fn factors(&self) -> BearingFactors {
        let (blocks, b) = self.setup.film.shape();
        BearingFactors {
            system: Bordered::new(blocks, b, self.memory.len()),
            stencil: Stencil::zeros(self.n),
        }
    }

    fn factor(&self, at: At, alpha: f64, into: &mut BearingFactors) -> Result<(), Singular> {
        let (u, q, n) = (self.film_input(at), self.film_unknowns(at.z), self.n);
        let film = &self.setup.film;
        let system = &mut into.system;
        system.columns.fill(0.0);
        system.rows.fill(0.0);
        system.corner.fill(0.0);
        let units = [[1.0, 0.0], [0.0, 1.0]];
        let motions = units.map(|unit| self.input_change(unit, unit.map(|v| alpha * v), &[]));
        film.linearise(&u, q, &motions, &mut into.stencil, &mut system.columns[..2 * n]);
        let (sign, row) = self.force_row();
        let row = row - n;
        for (axis, (unit, du)) in units.iter().zip(&motions).enumerate() {
            let df = film.force_tangent(&u, q, du);
            system.corner[(row, axis)] += sign * df[0];
            system.corner[(row + 1, axis)] += sign * df[1];
            let k = row + axis;
            film.force_cotangent(&u, q, unit.map(|v| sign * v), Some(&mut system.rows[k * n..(k + 1) * n]));
        }
        if self.has_mass() {
            let drive = self.drive(at.t_s);
            let (o, o1, m) =
                (drive.shell_speed_rad_s, drive.shell_acceleration_rad_s2, self.setup.journal_mass_kg);
            for a in 0..2 {
                let s = if a == 0 { -1.0 } else { 1.0 };
                system.corner[(a, a)] = alpha;
                system.corner[(a, 2 + a)] = -1.0;
                system.corner[(2 + a, a)] -= m * o * o;
                system.corner[(2 + a, 1 - a)] += s * m * o1;
                system.corner[(2 + a, 2 + a)] = m * alpha;
                system.corner[(2 + a, 3 - a)] = s * 2.0 * m * o;
            }
        }
        system.factor(&into.stencil)
    }

    fn solve(&self, factors: &BearingFactors, rhs: &mut [f64]) {
        factors.system.solve(rhs);
    }

    fn contains(&self, z: &[f64]) -> bool {
        let [x, y] = self.pair(z, 0);
        x.hypot(y) < self.setup.diametral_clearance_m / 2.0
    }

    fn admissible(&self, z: &[f64], dz: &[f64]) -> f64 {
        Gap::admissible(self.setup.diametral_clearance_m / 2.0, self.pair(z, 0), self.pair(dz, 0), KEEP_GAP)
    }
}

impl SensitiveDae for JournalBearing {
    fn solve_transposed(&self, factors: &BearingFactors, rhs: &mut [f64]) {
        factors.system.solve_transposed(rhs);
    }

    fn times(&self, at: At, rate: &[f64], dp: &[f64], out: &mut [f64]) {
        self.input_times(at, &self.input_change([0.0; 2], self.pair(rate, 0), dp), out);
        if self.has_mass() {
            for a in 0..2 {
                out[self.n + a] += rate[self.n + a];
                out[self.n + 2 + a] += self.setup.journal_mass_kg * rate[self.n + 2 + a];
            }
        }
    }

    fn transposed_times(&self, at: At, v: &[f64], rate: &mut [f64], p: &mut [f64]) {
        let bar = self.input_transposed_times(at, v);
        for a in 0..2 {
            rate[self.n + a] += bar.velocity_m_s[a];
            if self.has_mass() {
                rate[self.n + a] += v[self.n + a];
                rate[self.n + 2 + a] += self.setup.journal_mass_kg * v[self.n + 2 + a];
            }
        }
        self.pull_parameters(&bar, p);
    }

    fn output_tangent(&self, at: At, direction: Direction, dy: &mut [f64]) {
        let du = self.input_change(self.pair(direction.z, 0), self.pair(direction.rate, 0), direction.p);
        let (u, q) = (self.film_input(at), self.film_unknowns(at.z));
        let film = self.setup.film.output_tangent(&u, q, self.film_unknowns(direction.z), &du);
        let shrink = du.width_m / u.width_m + du.diameter_m / u.diameter_m;
        dy.copy_from_slice(&[
            film.loss_w,
            film.dissipation_w,
            film.gap_min_m,
            film.pressure_peak_pa,
            -self.specific_load_pa(at.t_s) * shrink,
            film.side_flow_m3_s,
        ]);
    }

    fn output_cotangent(&self, at: At, w: &[f64], out: Cotangent) {
        let (u, q) = (self.film_input(at), self.film_unknowns(at.z));
        let weights = FilmOutput {
            force_n: [0.0; 2],
            loss_w: w[0],
            dissipation_w: w[1],
            gap_min_m: w[2],
            pressure_peak_pa: w[3],
            side_flow_m3_s: w[5],
        };
        let mut bar = self.setup.film.output_cotangent(&u, q, &weights, &mut out.z[..self.n]);
        let load = w[4] * self.specific_load_pa(at.t_s);
        bar.width_m -= load / u.width_m;
        bar.diameter_m -= load / u.diameter_m;
        for a in 0..2 {
            out.z[self.n + a] += bar.eccentricity_m[a];
            out.rate[self.n + a] += bar.velocity_m_s[a];
        }
        self.pull_parameters(&bar, out.p);
    }
}

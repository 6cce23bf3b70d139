//! One dynamically loaded journal bearing as a periodic differential-algebraic system.
//!
//! ```text
//! z = (q, e, tilt)        0 = r(q, e, tilt, c')          film;  m = (c, e), c the oil content of every cell
//!                         0 = f(q, e, tilt) + W(t)       massless journal
//!                         0 = M(q, e, tilt)              moments, if the journal tilts freely
//! z = (q, e, tilt, v)     0 = e' - v                     m = (c, e, v)
//!                         0 = m (v' + 2 O x v + O' x e + O x (O x e)) - f - W     journal with mass in a turning shell
//! ```
//!
//! `W` is the load of the journal on the shell, `f` and `M` force and moment of film and contact on the journal, `O` the
//! shell's angular velocity. Parameters are any of [`BearingParameter`]. The viscosity follows the film temperature: the
//! inlet temperature plus a given rise, or a cycle unknown with its own equation ([`HeatBalance`]).
//!
//! Deliberately not here: what the film does inside, where loads come from.

mod fields;
mod heat;
mod model;
mod operation;
mod rescue;
mod sensitive;
mod setup;
mod shapes;
mod wear;

pub use fields::GapSensitivity;
pub use heat::HeatBalance;
pub use model::{BearingFactors, BearingRoom};
pub use sensitive::BearingPoint;
pub use setup::{BearingOutput, BearingParameter, BearingSetup, BearingShape, Smoothing, SurfaceField, Tilt};

use super::Drive;
use crate::dae::{At, InvalidParameters};
use crate::film::{FilmInput, FilmModel, FilmSite};
use heat::HeatEquations;
use shapes::Shapes;

/// A journal bearing at given parameters.
#[derive(Clone)]
pub struct JournalBearing {
    setup: BearingSetup,
    p: Vec<f64>,
    viscosity_pa_s: f64,
    viscosity_slope: f64,
    shapes: Shapes,
    heat: Option<HeatEquations>,
    /// Share of the shell's roughness that wear has left in every cell; empty for all of it.
    shell_left: Vec<f64>,
    layout: Layout,
}

/// Where things stand in states and memory.
#[derive(Debug, Clone, Copy)]
struct Layout {
    /// Film unknowns, and contents.
    n: usize,
    /// Motions that are unknowns: 2, or 4 with a free tilt.
    motions: usize,
    /// Whether the journal has mass.
    mass: bool,
}

impl Layout {
    /// Unknowns beside the film's.
    fn border(&self) -> usize {
        self.motions + if self.mass { 2 } else { 0 }
    }

    /// Sign of the force in its rows, and the first of the two rows it stands in, counted from the film's end.
    fn force_row(&self) -> (f64, usize) {
        if self.mass { (-1.0, self.motions) } else { (1.0, 0) }
    }

    /// Memory beside the contents.
    fn remembered(&self) -> usize {
        if self.mass { 4 } else { 2 }
    }
}

impl JournalBearing {
    /// A bearing at the values of its setup.
    pub fn new(mut setup: BearingSetup) -> Result<Self, InvalidParameters> {
        let mut parameters = setup.parameters.clone();
        if setup.heat.is_some() && !parameters.contains(&BearingParameter::FilmTemperature) {
            parameters.push(BearingParameter::FilmTemperature);
        }
        setup.parameters = parameters;
        let p: Vec<f64> = (0..setup.parameters.len()).map(|k| setup.value(setup.parameters[k])).collect();
        setup.check()?;
        let film_temperature_k = setup.film_temperature_k();
        let (viscosity_pa_s, viscosity_slope) = setup.viscosity.at(film_temperature_k);
        if !(viscosity_pa_s > 0.0 && viscosity_pa_s.is_finite()) {
            return Err(InvalidParameters(format!("the oil has no viscosity at {film_temperature_k:.1} K")));
        }
        let layout = Layout {
            n: setup.film.unknowns(),
            motions: if setup.tilt == Tilt::Free { 4 } else { 2 },
            mass: setup.journal_mass_kg > 0.0,
        };
        let heat =
            setup.heat.map(|balance| HeatEquations::of(balance, &setup, viscosity_slope / viscosity_pa_s));
        let shapes = Shapes::of(&setup);
        let left = |s: Smoothing| setup.worn_m.shell.iter().map(|w| s.at(*w).0).collect();
        let shell_left = setup.smoothing.map_or_else(Vec::new, left);
        Ok(Self { p, viscosity_pa_s, viscosity_slope, shapes, heat, shell_left, layout, setup })
    }

    /// What defines this bearing.
    pub fn setup(&self) -> &BearingSetup {
        &self.setup
    }

    /// Its film.
    pub fn film(&self) -> &dyn FilmModel {
        self.setup.film.as_ref()
    }

    /// The drive at a time.
    pub fn drive(&self, t_s: f64) -> Drive {
        self.drive_at(t_s * self.setup.speed_rad_s, self.setup.speed_rad_s)
    }

    /// Dynamic viscosity at the film temperature, Pa s.
    pub fn viscosity_pa_s(&self) -> f64 {
        self.viscosity_pa_s
    }

    /// Temperature of the film, K.
    pub fn film_temperature_k(&self) -> f64 {
        self.setup.film_temperature_k()
    }

    /// The film's part of a state.
    pub fn film_unknowns<'a>(&self, z: &'a [f64]) -> &'a [f64] {
        &z[..self.layout.n]
    }

    /// The contents' part of a rate.
    pub fn content_rate<'a>(&self, rate: &'a [f64]) -> &'a [f64] {
        rate.get(..self.layout.n).unwrap_or(&[])
    }

    /// What the film sees at a point of a trajectory.
    pub fn film_input(&self, at: At) -> FilmInput {
        let n = self.layout.n;
        let velocity = at.rate.get(n..n + 2).map_or([0.0; 2], |v| [v[0], v[1]]);
        self.input(at.t_s, at.z, velocity)
    }

    /// Where the film stands; `shape` is room for surfaces that turn.
    pub fn film_site<'a>(&'a self, at: At, shape: &'a mut Vec<f64>) -> FilmSite<'a> {
        self.site(at.t_s, self.film_input(at), shape)
    }

    /// What the film sees while the journal stands still at a position and turns at a speed; and the shape of its gap.
    pub fn still_input(&self, eccentricity_m: [f64; 2], speed_rad_s: f64) -> (FilmInput, Vec<f64>) {
        let mut z = vec![0.0; self.layout.n + self.layout.border()];
        z[self.layout.n..self.layout.n + 2].copy_from_slice(&eccentricity_m);
        let input = FilmInput { speed_rad_s, ..self.input(0.0, &z, [0.0; 2]) };
        (input, self.shapes.at(0.0, &mut Vec::new()).0.to_vec())
    }

    fn site<'a>(&'a self, t_s: f64, input: FilmInput, shape: &'a mut Vec<f64>) -> FilmSite<'a> {
        let journal_angle_rad = self.drive(t_s).journal_angle_rad;
        let (shape_m, marks) = self.shapes.at(journal_angle_rad, shape);
        FilmSite { input, shape_m, journal_angle_rad, marks, shell_left: &self.shell_left }
    }

    fn input(&self, t_s: f64, z: &[f64], velocity_m_s: [f64; 2]) -> FilmInput {
        let (s, n) = (&self.setup, self.layout.n);
        FilmInput {
            eccentricity_m: [z[n], z[n + 1]],
            tilt_rad: match s.tilt {
                Tilt::Given(tilt) => tilt,
                Tilt::Free => [z[n + 2], z[n + 3]],
            },
            velocity_m_s,
            speed_rad_s: self.drive(t_s).relative_speed_rad_s,
            width_m: s.width_m,
            diameter_m: s.diameter_m,
            clearance_m: s.diametral_clearance_m / 2.0,
            viscosity_pa_s: self.viscosity_pa_s,
            journal_roughness_m: s.journal_roughness_m,
            shell_roughness_m: s.shell_roughness_m,
            supply_pressure_pa: s.supply_pressure_pa,
        }
    }

    /// Mean pressure of the load on the projected area.
    fn specific_load_pa(&self, t_s: f64) -> f64 {
        let [x, y] = self.drive(t_s).load_n;
        x.hypot(y) / (self.setup.width_m * self.setup.diameter_m)
    }
}

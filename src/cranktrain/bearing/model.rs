//! The bearing evaluated and linearised.

use super::rescue::rescue;
use super::{BearingOutput, BearingParameter, JournalBearing};
use crate::cranktrain::Drive;
use crate::dae::{At, CycleEquations, Dae, InvalidParameters, LinearisedDae, Step};
use crate::film::{FilmCarry, FilmLinear, FilmOutput, up_to_the_switch};
use crate::math::{Bordered, Singular};

/// Size of a pressure that is zero, Pa.
const ONE_BAR_PA: f64 = 1e5;
/// Share of the smallest gap that one Newton step must leave.
const KEEP_GAP: f64 = 0.2;

impl JournalBearing {
    /// Position (`k = 0`) or, behind the motions, velocity (`k = 1`) in a state.
    pub(super) fn pair(&self, z: &[f64], k: usize) -> [f64; 2] {
        let first = self.layout.n + k * self.layout.motions;
        [z[first], z[first + 1]]
    }

    /// Rows below the film's, from the rates of position and velocity and the loads of the film.
    fn border_residual(&self, t_s: f64, z: &[f64], rates: &[f64; 4], loads: &[f64; 4], out: &mut [f64]) {
        let (l, drive) = (self.layout, self.drive(t_s));
        let (sign, row) = l.force_row();
        for a in 0..2 {
            out[row + a] = sign * (loads[a] + drive.load_n[a]);
            if l.motions == 4 {
                out[2 + a] = loads[2 + a];
            }
        }
        if l.mass {
            let (e, v) = (self.pair(z, 0), self.pair(z, 1));
            let inertia = inertia(&drive, self.setup.journal_mass_kg, e, v, [rates[2], rates[3]]);
            for a in 0..2 {
                out[a] = rates[a] - v[a];
                out[row + a] += inertia[a];
            }
        }
    }

    /// Corner of the matrix: border rows by border unknowns.
    fn fill_corner(&self, t_s: f64, alpha: f64, linear: &FilmLinear, system: &mut Bordered) {
        let l = self.layout;
        let (sign, row) = l.force_row();
        let corner = &mut system.corner;
        corner.fill(0.0);
        for b in 0..l.motions {
            for a in 0..2 {
                corner[(row + a, b)] = sign * linear.corner[a][b];
                if l.motions == 4 {
                    corner[(2 + a, b)] = linear.corner[2 + a][b];
                }
            }
        }
        if l.mass {
            let (drive, m) = (self.drive(t_s), self.setup.journal_mass_kg);
            let (o, o1) = (drive.shell_speed_rad_s, drive.shell_acceleration_rad_s2);
            for a in 0..2 {
                let (s, v) = (if a == 0 { -1.0 } else { 1.0 }, l.motions);
                corner[(a, a)] += alpha;
                corner[(a, v + a)] -= 1.0;
                corner[(row + a, a)] -= m * o * o;
                corner[(row + a, 1 - a)] += s * m * o1;
                corner[(row + a, v + a)] += m * alpha;
                corner[(row + a, v + 1 - a)] += s * 2.0 * m * o;
            }
        }
    }

    /// The outputs from those of the film.
    pub(super) fn outputs_of(&self, t_s: f64, film: &FilmOutput, y: &mut [f64]) {
        y.copy_from_slice(&[
            film.loss_w + film.contact_loss_w,
            film.contact_loss_w,
            film.dissipation_w + film.contact_loss_w,
            film.gap_min_m,
            film.pressure_peak_pa,
            film.contact_peak_pa,
            self.specific_load_pa(t_s),
            film.side_flow_m3_s,
            film.loss_w,
            self.setup.film_temperature_k(),
            self.setup.wear_m3_per_j * film.contact_loss_w,
            film.rubbing_w_m2,
        ]);
    }
}

/// Mass times absolute acceleration, seen from the turning shell.
pub(super) fn inertia(drive: &Drive, m: f64, e: [f64; 2], v: [f64; 2], dv: [f64; 2]) -> [f64; 2] {
    let (o, o1) = (drive.shell_speed_rad_s, drive.shell_acceleration_rad_s2);
    [
        m * (dv[0] - 2.0 * o * v[1] - o1 * e[1] - o * o * e[0]),
        m * (dv[1] + 2.0 * o * v[0] + o1 * e[0] - o * o * e[1]),
    ]
}

impl Dae for JournalBearing {
    fn states(&self) -> usize {
        self.layout.n + self.layout.border()
    }

    fn memories(&self) -> usize {
        self.layout.n + self.layout.remembered()
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn parameter_scale(&self, j: usize) -> f64 {
        let (size, clearance) = (self.p[j].abs(), self.setup.diametral_clearance_m / 2.0);
        match self.setup.parameters[j] {
            _ if size > 0.0 => size,
            BearingParameter::Shape(..) => clearance,
            BearingParameter::Tilt(_) => 2.0 * clearance / self.setup.width_m,
            BearingParameter::SupplyPressure => ONE_BAR_PA,
            _ => 1.0,
        }
    }

    fn period_s(&self) -> f64 {
        self.setup.load.cycle_rad() / self.setup.speed_rad_s
    }

    fn outputs(&self) -> usize {
        BearingOutput::ALL.len()
    }

    fn cold_start(&self) -> Vec<f64> {
        let (mut z, n) = (vec![0.0; self.states()], self.layout.n);
        // Half way towards the load, where most films carry something.
        let [x, y] = self.drive(0.0).load_n;
        let size = x.hypot(y).max(f64::MIN_POSITIVE);
        z[n] = 0.25 * self.setup.diametral_clearance_m * x / size;
        z[n + 1] = 0.25 * self.setup.diametral_clearance_m * y / size;
        z
    }

    fn memory(&self, t_s: f64, z: &[f64], m: &mut [f64]) {
        let (n, mut room) = (self.layout.n, Vec::new());
        let site = self.site(t_s, self.input(t_s, z, [0.0; 2]), &mut room);
        self.setup.film.content(&site, self.film_unknowns(z), &mut m[..n]);
        m[n..n + 2].copy_from_slice(&self.pair(z, 0));
        if self.layout.mass {
            m[n + 2..].copy_from_slice(&self.pair(z, 1));
        }
    }

    fn residual(&self, at: At, out: &mut [f64]) {
        let (n, mut room) = (self.layout.n, Vec::new());
        let site = self.film_site(at, &mut room);
        let q = self.film_unknowns(at.z);
        self.setup.film.residual(&site, q, self.content_rate(at.rate), &mut out[..n]);
        let loads = self.setup.film.output(&site, q).loads();
        let mut rates = [0.0; 4];
        rates[..self.layout.remembered()].copy_from_slice(&at.rate[n..]);
        self.border_residual(at.t_s, at.z, &rates, &loads, &mut out[n..]);
    }

    fn output(&self, at: At, y: &mut [f64]) {
        let mut room = Vec::new();
        let site = self.film_site(at, &mut room);
        let film = self.setup.film.output(&site, self.film_unknowns(at.z));
        self.outputs_of(at.t_s, &film, y);
    }

    fn change(&self, z: &[f64], dz: &[f64]) -> f64 {
        // Maxima pass over what is no number, so that is looked for first.
        if dz.iter().any(|v| !v.is_finite()) {
            return f64::NAN;
        }
        let film = self.setup.film.change(self.film_unknowns(z), self.film_unknowns(dz));
        let (s, clearance) = (&self.setup, self.setup.diametral_clearance_m / 2.0);
        let size = |v: [f64; 2]| v[0].abs().max(v[1].abs());
        let mut motion = size(self.pair(dz, 0)) / clearance;
        if self.layout.motions == 4 {
            let tilt = [dz[self.layout.n + 2], dz[self.layout.n + 3]];
            motion = motion.max(size(tilt) * s.width_m / (2.0 * clearance));
        }
        let speed = if self.layout.mass { size(self.pair(dz, 1)) / (clearance * s.speed_rad_s) } else { 0.0 };
        film.max(motion).max(speed)
    }

    fn memory_change(&self, dm: &[f64]) -> f64 {
        if dm.iter().any(|v| !v.is_finite()) {
            return f64::NAN;
        }
        let clearance = self.setup.diametral_clearance_m / 2.0;
        let n = self.layout.n;
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |a, d| a.max(d.abs()));
        let speed = largest(&dm[n + 2..]) / self.setup.speed_rad_s;
        largest(&dm[..n + 2]).max(speed) / clearance
    }

    fn with_parameters(&self, p: &[f64]) -> Result<Self, InvalidParameters> {
        Self::new(self.setup.with(p)?)
    }

    fn cycle(&self) -> Option<&dyn CycleEquations> {
        self.heat.as_ref().map(|h| h as &dyn CycleEquations)
    }
}

/// Factors of one step of a bearing.
pub struct BearingFactors {
    pub(super) system: Bordered,
    pub(super) carry: FilmCarry,
}

/// Workspace of a linearisation of a bearing.
pub struct BearingRoom {
    pub(super) linear: FilmLinear,
    shape: Vec<f64>,
}

impl LinearisedDae for JournalBearing {
    type Factors = BearingFactors;
    type Room = BearingRoom;

    fn factors(&self) -> BearingFactors {
        let (blocks, b) = self.setup.film.shape();
        BearingFactors {
            system: Bordered::new(blocks, b, self.layout.border()),
            carry: FilmCarry::new(self.layout.n, self.layout.motions),
        }
    }

    fn keeper(&self) -> BearingFactors {
        let (blocks, b) = self.setup.film.shape();
        BearingFactors {
            system: Bordered::keeper(blocks, b, self.layout.border()),
            carry: FilmCarry::new(self.layout.n, self.layout.motions),
        }
    }

    fn keep(&self, made: &mut BearingFactors, keeper: &mut BearingFactors) {
        made.system.pack_into(&mut keeper.system);
        std::mem::swap(&mut made.carry, &mut keeper.carry);
    }

    fn factor_bytes(&self) -> usize {
        let (blocks, b) = self.setup.film.shape();
        Bordered::bytes(blocks, b, self.layout.border())
            + FilmCarry::bytes(self.layout.n, self.layout.motions)
    }

    fn room(&self) -> BearingRoom {
        BearingRoom { linear: FilmLinear::new(self.layout.n, self.layout.motions), shape: Vec::new() }
    }

    fn linearise(
        &self,
        step: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        room: &mut BearingRoom,
        into: &mut BearingFactors,
    ) -> Result<(), Singular> {
        self.balance(step, memory, residual, room);
        self.enter(step.t_s, step.alpha, &mut room.linear, into);
        into.system.factor(&room.linear.stencil)
    }

    fn newton(
        &self,
        step: Step,
        memory: &mut [f64],
        residual: &mut [f64],
        room: &mut BearingRoom,
        into: &mut BearingFactors,
    ) -> Result<(), Singular> {
        self.balance(step, memory, residual, room);
        self.enter(step.t_s, step.alpha, &mut room.linear, into);
        into.system.factor_and_solve(&room.linear.stencil, residual)
    }

    fn balance(&self, step: Step, memory: &mut [f64], residual: &mut [f64], room: &mut BearingRoom) {
        let (l, n) = (self.layout, self.layout.n);
        memory[n..n + 2].copy_from_slice(&self.pair(step.z, 0));
        if l.mass {
            memory[n + 2..].copy_from_slice(&self.pair(step.z, 1));
        }
        let mut rates = [0.0; 4];
        (0..l.remembered()).for_each(|k| rates[k] = step.alpha * memory[n + k] + step.past[n + k]);
        let velocity = [rates[0], rates[1]];
        self.linearise_film(step.t_s, step.z, velocity, (step.alpha, step.past), room);
        memory[..n].copy_from_slice(&room.linear.content);
        residual[..n].copy_from_slice(&room.linear.residual);
        self.border_residual(step.t_s, step.z, &rates, &room.linear.loads, &mut residual[n..]);
    }

    fn solve(&self, factors: &BearingFactors, rhs: &mut [f64]) {
        factors.system.solve(rhs);
    }

    fn rate_times(&self, factors: &BearingFactors, rate: &[f64], out: &mut [f64]) {
        let (l, n, carry) = (self.layout, self.layout.n, &factors.carry);
        let (sign, row) = l.force_row();
        for (k, o) in out[..n].iter_mut().enumerate() {
            *o += carry.by_rate[k] * rate[k];
        }
        for a in 0..2 {
            out[n + row + a] += sign * (0..2).map(|b| carry.damping[a][b] * rate[n + b]).sum::<f64>();
            if l.mass {
                out[n + a] += rate[n + a];
                out[n + row + a] += self.setup.journal_mass_kg * rate[n + 2 + a];
            }
        }
    }

    fn memory_times(&self, factors: &BearingFactors, dz: &[f64], dm: &mut [f64]) {
        let (l, n, carry) = (self.layout, self.layout.n, &factors.carry);
        for (k, m) in dm[..n].iter_mut().enumerate() {
            *m += carry.content_by_unknown[k] * dz[k];
        }
        for a in 0..if n > 0 { l.motions } else { 0 } {
            let column = &carry.content_by_motion[a * n..(a + 1) * n];
            dm[..n].iter_mut().zip(column).for_each(|(m, c)| *m += c * dz[n + a]);
        }
        for a in 0..2 {
            dm[n + a] += dz[n + a];
            if l.mass {
                dm[n + 2 + a] += dz[n + l.motions + a];
            }
        }
    }

    fn predict(&self, before: &[f64], z: &mut [f64]) {
        let (n, mut motion) = (self.layout.n, [0.0; 4]);
        (0..self.layout.motions).for_each(|a| motion[a] = z[n + a] - before[n + a]);
        let share = self.motion_share(z, motion, KEEP_GAP);
        (0..self.layout.motions).for_each(|a| z[n + a] += share * motion[a]);
        for (z, before) in z[..n].iter_mut().zip(before) {
            *z = up_to_the_switch(*z, 2.0 * *z - before);
        }
    }

    fn rescue(&self, step: Step, z: &mut [f64]) -> bool {
        rescue(self, step, z)
    }

    fn contains(&self, z: &[f64]) -> bool {
        let mut room = Vec::new();
        let site = self.site(0.0, self.input(0.0, z, [0.0; 2]), &mut room);
        self.setup.film.contains(&site)
    }

    fn advance(&self, z: &mut [f64], dz: &[f64], share: f64) {
        for (k, (z, d)) in z.iter_mut().zip(dz).enumerate() {
            let to = *z + share * d;
            *z = if k < self.layout.n { up_to_the_switch(*z, to) } else { to };
        }
    }

    fn admissible(&self, z: &[f64], dz: &[f64]) -> f64 {
        let (n, mut motion) = (self.layout.n, [0.0; 4]);
        (0..self.layout.motions).for_each(|a| motion[a] = dz[n + a]);
        self.motion_share(z, motion, KEEP_GAP)
    }
}

impl JournalBearing {
    /// Linearises the film for the rate `alpha c + past`.
    pub(super) fn linearise_film(
        &self,
        t_s: f64,
        z: &[f64],
        velocity_m_s: [f64; 2],
        (alpha, past): (f64, &[f64]),
        room: &mut BearingRoom,
    ) {
        let BearingRoom { linear, shape } = room;
        let site = self.site(t_s, self.input(t_s, z, velocity_m_s), shape);
        self.setup.film.linearise(&site, self.film_unknowns(z), alpha, past, linear);
    }

    /// Enters the linearised film into the matrix of the step.
    pub(super) fn enter(&self, t_s: f64, alpha: f64, linear: &mut FilmLinear, into: &mut BearingFactors) {
        let (l, n) = (self.layout, self.layout.n);
        let BearingFactors { system, carry } = into;
        system.columns.fill(0.0);
        system.rows.fill(0.0);
        system.columns[..l.motions * n].copy_from_slice(&linear.columns);
        let (sign, row) = l.force_row();
        for a in 0..l.motions {
            let (sign, at) = if a < 2 { (sign, row + a) } else { (1.0, a) };
            let to = &mut system.rows[at * n..(at + 1) * n];
            to.iter_mut().zip(&linear.rows[a * n..(a + 1) * n]).for_each(|(to, from)| *to = sign * from);
        }
        self.fill_corner(t_s, alpha, linear, system);
        std::mem::swap(carry, &mut linear.carry);
    }

    /// Share of a motion that leaves enough of every gap.
    pub(super) fn motion_share(&self, z: &[f64], motion: [f64; 4], keep: f64) -> f64 {
        let mut room = Vec::new();
        let site = self.site(0.0, self.input(0.0, z, [0.0; 2]), &mut room);
        self.setup.film.admissible(&site, motion, keep)
    }
}

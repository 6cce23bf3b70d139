//! The bearing differentiated, forwards and backwards: the film's derivatives with states and parameters in place of
//! its input.

use super::fields::{FILM_TEMPERATURE, LOAD_FACTOR, SPEED};
use super::model::{BearingFactors, BearingRoom};
use super::operation::Answer;
use super::{BearingOutput, JournalBearing};
use crate::dae::{At, Cotangent, Direction, SensitiveDae};
use crate::film::{
    FilmChange, FilmCotangent, FilmInput, FilmOutput, FilmPlace, FilmPoint, FilmSite, FilmTangent,
    FilmWeights, Mesh, Wanted,
};
use crate::math::Singular;

/// A bearing evaluated at one point of a trajectory.
#[derive(Default)]
pub struct BearingPoint {
    input: FilmInput,
    shape_m: Vec<f64>,
    marks: Vec<f64>,
    journal_angle_rad: f64,
    film: FilmPoint,
}

impl BearingPoint {
    fn site<'a>(&'a self, shell_left: &'a [f64]) -> FilmSite<'a> {
        let Self { input, shape_m, marks, journal_angle_rad, .. } = self;
        FilmSite { input: *input, shape_m, marks, journal_angle_rad: *journal_angle_rad, shell_left }
    }
}

impl JournalBearing {
    fn place<'a>(&self, point: &'a BearingPoint, site: &'a FilmSite<'a>, at: At<'a>) -> FilmPlace<'a> {
        FilmPlace { site, q: &at.z[..self.layout.n], rate: self.content_rate(at.rate), point: &point.film }
    }

    /// Adds the motions of a state's change to a change of the input.
    fn add_motions(&self, dz: &[f64], du: &mut FilmInput) {
        let n = self.layout.n;
        for a in 0..2 {
            du.eccentricity_m[a] += dz[n + a];
            if self.layout.motions == 4 {
                du.tilt_rad[a] += dz[n + 2 + a];
            }
        }
    }

    /// What the film sees of a direction, and what that does to its outputs.
    fn film_outputs_along(
        &self,
        point: &BearingPoint,
        at: At,
        direction: Direction,
    ) -> (FilmInput, FilmTangent) {
        let (n, site) = (self.layout.n, point.site(&self.shell_left));
        let (mut input, shape_m) = self.seen_along(point.journal_angle_rad, direction.u);
        self.add_motions(direction.z, &mut input);
        input.velocity_m_s = [direction.rate[n], direction.rate[n + 1]];
        self.faster(at, direction.u[SPEED], &mut input);
        let change = FilmChange {
            q: &direction.z[..n],
            rate: &[],
            input,
            shape_m: &shape_m,
            shell_left: self.left_along(direction.u),
        };
        let wanted = Wanted { residual: false, content: false, output: true };
        (input, self.setup.film.tangent_at(&self.place(point, &site, at), &change, wanted))
    }

    /// Adds derivatives by the input's motions to derivatives by the state.
    fn pull_motions(&self, bar: &FilmCotangent, z_bar: &mut [f64]) {
        let n = self.layout.n;
        z_bar[..n].iter_mut().zip(&bar.q).for_each(|(z, q)| *z += q);
        for a in 0..2 {
            z_bar[n + a] += bar.input.eccentricity_m[a];
            if self.layout.motions == 4 {
                z_bar[n + 2 + a] += bar.input.tilt_rad[a];
            }
        }
    }

    fn fix_film(&self, at: At, outputs: bool, into: &mut BearingPoint) {
        let mut room = Vec::new();
        let site = self.film_site(at, &mut room);
        into.input = site.input;
        into.journal_angle_rad = site.journal_angle_rad;
        into.shape_m.clear();
        into.shape_m.extend_from_slice(site.shape_m);
        into.marks.clear();
        into.marks.extend_from_slice(site.marks);
        self.setup.film.fix(&site, self.film_unknowns(at.z), outputs, &mut into.film);
    }

    /// Weights on the film's outputs for weights on the bearing's.
    fn film_weights(&self, w: &[f64]) -> FilmOutput {
        let at = |o: BearingOutput| w[o.index()];
        FilmOutput {
            loss_w: at(BearingOutput::Loss) + at(BearingOutput::HydrodynamicLoss),
            contact_loss_w: at(BearingOutput::Loss)
                + at(BearingOutput::ContactLoss)
                + at(BearingOutput::Dissipation)
                + self.setup.wear_m3_per_j * at(BearingOutput::WearRate),
            dissipation_w: at(BearingOutput::Dissipation),
            gap_min_m: at(BearingOutput::GapMin),
            pressure_peak_pa: at(BearingOutput::PressurePeak),
            contact_peak_pa: at(BearingOutput::ContactPeak),
            side_flow_m3_s: at(BearingOutput::SideFlow),
            rubbing_w_m2: at(BearingOutput::Rubbing),
            ..FilmOutput::default()
        }
    }
}

impl SensitiveDae for JournalBearing {
    type Point = BearingPoint;

    fn point(&self) -> BearingPoint {
        BearingPoint::default()
    }

    fn fix(&self, at: At, into: &mut BearingPoint) {
        self.fix_film(at, true, into);
    }

    fn fix_balance(&self, at: At, into: &mut BearingPoint) {
        self.fix_film(at, false, into);
    }

    fn factor(
        &self,
        at: At,
        alpha: f64,
        room: &mut BearingRoom,
        into: &mut BearingFactors,
    ) -> Result<(), Singular> {
        // The matrix knows the contents only through alpha; of the rates it needs the journal's velocity alone.
        self.linearise_film(at.t_s, at.z, self.film_input(at).velocity_m_s, (alpha, &[]), room);
        self.enter(at.t_s, alpha, &mut room.linear, into);
        into.system.factor(&room.linear.stencil)
    }

    fn solve_transposed(&self, factors: &BearingFactors, rhs: &mut [f64]) {
        factors.system.solve_transposed(rhs);
    }

    fn rate_cotangent(&self, factors: &BearingFactors, v: &[f64], rate: &mut [f64]) {
        let (l, n, carry) = (self.layout, self.layout.n, &factors.carry);
        let (sign, row) = l.force_row();
        for (k, r) in rate[..n].iter_mut().enumerate() {
            *r += carry.by_rate[k] * v[k];
        }
        for a in 0..2 {
            rate[n + a] += sign * (0..2).map(|b| carry.damping[b][a] * v[n + row + b]).sum::<f64>();
            if l.mass {
                rate[n + a] += v[n + a];
                rate[n + 2 + a] += self.setup.journal_mass_kg * v[n + row + a];
            }
        }
    }

    fn memory_cotangent(&self, factors: &BearingFactors, w: &[f64], z: &mut [f64]) {
        let (l, n, carry) = (self.layout, self.layout.n, &factors.carry);
        for (k, z) in z[..n].iter_mut().enumerate() {
            *z += carry.content_by_unknown[k] * w[k];
        }
        for a in 0..if n > 0 { l.motions } else { 0 } {
            let column = &carry.content_by_motion[a * n..(a + 1) * n];
            z[n + a] += column.iter().zip(w).map(|(c, w)| c * w).sum::<f64>();
        }
        for a in 0..2 {
            z[n + a] += w[n + a];
            if l.mass {
                z[n + l.motions + a] += w[n + 2 + a];
            }
        }
    }

    fn fields(&self) -> usize {
        self.field_count()
    }

    fn field_tangent(&self, dp: &[f64], du: &mut [f64]) {
        self.fields_along(dp, du);
    }

    fn field_cotangent(&self, u: &[f64], p: &mut [f64]) {
        self.fields_back(u, p);
    }

    fn push(&self, point: &BearingPoint, at: At, du: &[f64], residual: &mut [f64], memory: &mut [f64]) {
        let (l, n, site) = (self.layout, self.layout.n, point.site(&self.shell_left));
        let (mut input, shape_m) = self.seen_along(point.journal_angle_rad, du);
        let faster = self.faster(at, du[SPEED], &mut input);
        let change =
            FilmChange { q: &[], rate: &faster, input, shape_m: &shape_m, shell_left: self.left_along(du) };
        let d = self.setup.film.tangent_at(&self.place(point, &site, at), &change, Wanted::ALL);
        residual.fill(0.0);
        memory.fill(0.0);
        self.push_operation(at, du, &mut residual[n..]);
        residual[..n].copy_from_slice(&d.residual);
        memory[..n].copy_from_slice(&d.content);
        let ((sign, row), loads) = (l.force_row(), d.output.loads());
        for a in 0..2 {
            residual[n + row + a] += sign * loads[a];
            if l.motions == 4 {
                residual[n + 2 + a] += loads[2 + a];
            }
        }
    }

    fn pull(&self, point: &BearingPoint, at: At, v: &[f64], w: &[f64], u: &mut [f64]) {
        let (l, n, site) = (self.layout, self.layout.n, point.site(&self.shell_left));
        let (sign, row) = l.force_row();
        let mut output =
            FilmOutput { force_n: [sign * v[n + row], sign * v[n + row + 1]], ..Default::default() };
        if l.motions == 4 {
            output.moment_n_m = [v[n + 2], v[n + 3]];
        }
        let weights = FilmWeights { residual: &v[..n], content: &w[..n], output };
        let bar = self.setup.film.cotangent_at(&self.place(point, &site, at), &weights);
        self.seen_back(point.journal_angle_rad, &bar, u);
        if self.operation_varies() {
            let dot = |answer: &Answer| crate::math::dot(&self.border_by(at, answer), &v[n..]);
            u[LOAD_FACTOR] += dot(&self.by_load_factor(at.t_s));
            u[SPEED] += dot(&self.by_speed(at.t_s)) + self.faster_back(at, &bar);
        }
    }

    fn output_tangent(&self, point: &BearingPoint, at: At, direction: Direction, dy: &mut [f64]) {
        let (input, d) = self.film_outputs_along(point, at, direction);
        self.outputs_of(at.t_s, &d.output, dy);
        let shrink = input.width_m / self.setup.width_m + input.diameter_m / self.setup.diameter_m;
        dy[BearingOutput::FilmTemperature.index()] = direction.u[FILM_TEMPERATURE];
        dy[BearingOutput::SpecificLoad.index()] = -self.specific_load_pa(at.t_s) * shrink;
        if self.operation_varies() {
            let [by_factor, by_speed] = self.specific_load_by(at.t_s);
            dy[BearingOutput::SpecificLoad.index()] +=
                by_factor * direction.u[LOAD_FACTOR] + by_speed * direction.u[SPEED];
        }
    }

    fn locals(&self) -> usize {
        2 * self.setup.film.mesh().map_or(0, Mesh::cells)
    }

    fn add_local_tangent(
        &self,
        point: &BearingPoint,
        at: At,
        direction: Direction,
        share: f64,
        sums: &mut [f64],
    ) {
        let (site, cells) = (point.site(&self.shell_left), sums.len() / 2);
        let (input, d) = self.film_outputs_along(point, at, direction);
        let mut contact = vec![0.0; cells];
        self.setup.film.contact_pa(&site, &mut contact);
        let (u, du) = (&site.input, &input);
        let speed_m_s = u.speed_rad_s * u.diameter_m / 2.0;
        let faster = (du.speed_rad_s * u.diameter_m + u.speed_rad_s * du.diameter_m) / 2.0;
        let by = share * speed_m_s.signum();
        for (p, dp) in contact.iter_mut().zip(&d.contact_pa) {
            *p = by * (dp * speed_m_s + *p * faster);
        }
        let (shell, journal) = sums.split_at_mut(cells);
        shell.iter_mut().zip(&contact).for_each(|(sum, r)| *sum += r);
        self.shapes.grid.turn(point.journal_angle_rad, |cell, at, part| journal[at] += part * contact[cell]);
    }

    fn output_cotangent(&self, point: &BearingPoint, at: At, w: &[f64], out: Cotangent) {
        let (n, site) = (self.layout.n, point.site(&self.shell_left));
        let weights = FilmWeights { residual: &[], content: &[], output: self.film_weights(w) };
        let mut bar = self.setup.film.cotangent_at(&self.place(point, &site, at), &weights);
        let load = w[BearingOutput::SpecificLoad.index()] * self.specific_load_pa(at.t_s);
        bar.input.width_m -= load / self.setup.width_m;
        bar.input.diameter_m -= load / self.setup.diameter_m;
        self.pull_motions(&bar, out.z);
        for a in 0..2 {
            out.rate[n + a] += bar.input.velocity_m_s[a];
        }
        out.u[FILM_TEMPERATURE] += w[BearingOutput::FilmTemperature.index()];
        self.seen_back(point.journal_angle_rad, &bar, out.u);
        if self.operation_varies() {
            let [by_factor, by_speed] = self.specific_load_by(at.t_s);
            let on_load = w[BearingOutput::SpecificLoad.index()];
            out.u[LOAD_FACTOR] += on_load * by_factor;
            out.u[SPEED] += on_load * by_speed + self.faster_back(at, &bar);
        }
    }
}

//! The bearing differentiated, forwards and backwards: the film's derivatives with states and parameters in place of
//! its input.

use super::{BearingOutput, BearingParameter, JournalBearing, Tilt};
use crate::dae::{At, Cotangent, Direction, SensitiveDae};
use crate::film::{
    FilmChange, FilmCotangent, FilmInput, FilmOutput, FilmPlace, FilmPoint, FilmSite, FilmWeights, Wanted,
};
use crate::math::Singular;

/// A bearing evaluated at one point of a trajectory.
#[derive(Default)]
pub struct BearingPoint {
    input: FilmInput,
    shape_m: Vec<f64>,
    journal_angle_rad: f64,
    film: FilmPoint,
}

impl BearingPoint {
    fn site(&self) -> FilmSite<'_> {
        FilmSite { input: self.input, shape_m: &self.shape_m, journal_angle_rad: self.journal_angle_rad }
    }
}

/// Change of everything the film sees.
struct Moved {
    input: FilmInput,
    shape_m: Vec<f64>,
}

impl JournalBearing {
    /// Change of the film's input and shape for a change of the parameters.
    fn moved(&self, point: &BearingPoint, dp: &[f64]) -> Moved {
        let mut du = FilmInput::default();
        for (kind, d) in self.setup.parameters.iter().zip(dp) {
            match *kind {
                BearingParameter::Width => du.width_m += d,
                BearingParameter::Diameter => du.diameter_m += d,
                BearingParameter::DiametralClearance => du.clearance_m += d / 2.0,
                BearingParameter::InletTemperature if self.heat.is_some() => {}
                BearingParameter::InletTemperature | BearingParameter::FilmTemperature => {
                    du.viscosity_pa_s += self.viscosity_slope * d;
                }
                BearingParameter::JournalRoughness => du.journal_roughness_m += d,
                BearingParameter::ShellRoughness => du.shell_roughness_m += d,
                BearingParameter::SupplyPressure => du.supply_pressure_pa += d,
                BearingParameter::Tilt(axis) => {
                    if self.setup.tilt != Tilt::Free {
                        du.tilt_rad[axis] += d;
                    }
                }
                BearingParameter::Shape(..) => {}
            }
        }
        Moved { input: du, shape_m: self.shapes.change(point.journal_angle_rad, dp) }
    }

    /// Adds derivatives by what the film sees to derivatives by the parameters.
    fn pull_parameters(&self, point: &BearingPoint, bar: &FilmCotangent, p_bar: &mut [f64]) {
        let u = &bar.input;
        for (kind, bar) in self.setup.parameters.iter().zip(p_bar.iter_mut()) {
            *bar += match *kind {
                BearingParameter::Width => u.width_m,
                BearingParameter::Diameter => u.diameter_m,
                BearingParameter::DiametralClearance => u.clearance_m / 2.0,
                BearingParameter::InletTemperature if self.heat.is_some() => 0.0,
                BearingParameter::InletTemperature | BearingParameter::FilmTemperature => {
                    self.viscosity_slope * u.viscosity_pa_s
                }
                BearingParameter::JournalRoughness => u.journal_roughness_m,
                BearingParameter::ShellRoughness => u.shell_roughness_m,
                BearingParameter::SupplyPressure => u.supply_pressure_pa,
                BearingParameter::Tilt(axis) if self.setup.tilt != Tilt::Free => u.tilt_rad[axis],
                BearingParameter::Tilt(_) | BearingParameter::Shape(..) => 0.0,
            };
        }
        self.shapes.pull_back(point.journal_angle_rad, &bar.gap_m, p_bar);
    }

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

    /// Weights on the film's outputs for weights on the bearing's.
    fn film_weights(w: &[f64]) -> FilmOutput {
        let at = |o: BearingOutput| w[o.index()];
        FilmOutput {
            loss_w: at(BearingOutput::Loss),
            contact_loss_w: at(BearingOutput::Loss)
                + at(BearingOutput::ContactLoss)
                + at(BearingOutput::Dissipation),
            dissipation_w: at(BearingOutput::Dissipation),
            gap_min_m: at(BearingOutput::GapMin),
            pressure_peak_pa: at(BearingOutput::PressurePeak),
            contact_peak_pa: at(BearingOutput::ContactPeak),
            side_flow_m3_s: at(BearingOutput::SideFlow),
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
        let mut room = Vec::new();
        let site = self.film_site(at, &mut room);
        into.input = site.input;
        into.journal_angle_rad = site.journal_angle_rad;
        into.shape_m.clear();
        into.shape_m.extend_from_slice(site.shape_m);
        self.setup.film.fix(&site, self.film_unknowns(at.z), &mut into.film);
    }

    fn factor(&self, at: At, alpha: f64, into: &mut Self::Factors) -> Result<(), Singular> {
        // The matrix knows the contents only through alpha; of the rates it needs the journal's velocity alone.
        self.assemble(at.t_s, at.z, self.film_input(at).velocity_m_s, (alpha, &[]), into)
    }

    fn solve_transposed(&self, factors: &mut Self::Factors, rhs: &mut [f64]) {
        factors.system.solve_transposed(rhs);
    }

    fn times(&self, point: &BearingPoint, at: At, rate: &[f64], dp: &[f64], out: &mut [f64]) {
        let (l, n, site) = (self.layout, self.layout.n, point.site());
        let Moved { mut input, shape_m } = self.moved(point, dp);
        input.velocity_m_s = [rate[n], rate[n + 1]];
        let change = FilmChange { q: &[], rate: &rate[..n], input, shape_m: &shape_m };
        let wanted = Wanted { residual: true, content: false, output: true };
        let d = self.setup.film.tangent_at(&self.place(point, &site, at), &change, wanted);
        out[..n].iter_mut().zip(&d.residual).for_each(|(o, r)| *o += r);
        let ((sign, row), loads) = (l.force_row(), d.output.loads());
        for a in 0..2 {
            out[n + row + a] += sign * loads[a];
            if l.motions == 4 {
                out[n + 2 + a] += loads[2 + a];
            }
            if l.mass {
                out[n + a] += rate[n + a];
                out[n + row + a] += self.setup.journal_mass_kg * rate[n + 2 + a];
            }
        }
    }

    fn transposed_times(&self, point: &BearingPoint, at: At, v: &[f64], rate: &mut [f64], p: &mut [f64]) {
        let (l, n, site) = (self.layout, self.layout.n, point.site());
        let (sign, row) = l.force_row();
        let mut output =
            FilmOutput { force_n: [sign * v[n + row], sign * v[n + row + 1]], ..Default::default() };
        if l.motions == 4 {
            output.moment_n_m = [v[n + 2], v[n + 3]];
        }
        let weights = FilmWeights { residual: &v[..n], content: &[], output };
        let bar = self.setup.film.cotangent_at(&self.place(point, &site, at), &weights);
        rate[..n].iter_mut().zip(&bar.rate).for_each(|(r, b)| *r += b);
        for a in 0..2 {
            rate[n + a] += bar.input.velocity_m_s[a];
            if l.mass {
                rate[n + a] += v[n + a];
                rate[n + 2 + a] += self.setup.journal_mass_kg * v[n + row + a];
            }
        }
        self.pull_parameters(point, &bar, p);
    }

    fn memory_tangent(&self, point: &BearingPoint, at: At, dz: &[f64], dp: &[f64], dm: &mut [f64]) {
        let (l, n, site) = (self.layout, self.layout.n, point.site());
        if n > 0 {
            let Moved { mut input, shape_m } = self.moved(point, dp);
            self.add_motions(dz, &mut input);
            let change = FilmChange { q: &dz[..n], rate: &[], input, shape_m: &shape_m };
            let wanted = Wanted { residual: false, content: true, output: false };
            let d = self.setup.film.tangent_at(&self.place(point, &site, at), &change, wanted);
            dm[..n].copy_from_slice(&d.content);
        }
        for a in 0..2 {
            dm[n + a] = dz[n + a];
            if l.mass {
                dm[n + 2 + a] = dz[n + l.motions + a];
            }
        }
    }

    fn memory_cotangent(
        &self,
        point: &BearingPoint,
        at: At,
        w: &[f64],
        z_bar: &mut [f64],
        p_bar: &mut [f64],
    ) {
        let (l, n, site) = (self.layout, self.layout.n, point.site());
        if n > 0 {
            let weights = FilmWeights { residual: &[], content: &w[..n], output: FilmOutput::default() };
            let bar = self.setup.film.cotangent_at(&self.place(point, &site, at), &weights);
            self.pull_motions(&bar, z_bar);
            self.pull_parameters(point, &bar, p_bar);
        }
        for a in 0..2 {
            z_bar[n + a] += w[n + a];
            if l.mass {
                z_bar[n + l.motions + a] += w[n + 2 + a];
            }
        }
    }

    fn output_tangent(&self, point: &BearingPoint, at: At, direction: Direction, dy: &mut [f64]) {
        let (n, site) = (self.layout.n, point.site());
        let Moved { mut input, shape_m } = self.moved(point, direction.p);
        self.add_motions(direction.z, &mut input);
        input.velocity_m_s = [direction.rate[n], direction.rate[n + 1]];
        let change = FilmChange { q: &direction.z[..n], rate: &[], input, shape_m: &shape_m };
        let wanted = Wanted { residual: false, content: false, output: true };
        let d = self.setup.film.tangent_at(&self.place(point, &site, at), &change, wanted);
        self.outputs_of(at.t_s, &d.output, dy);
        let shrink = input.width_m / self.setup.width_m + input.diameter_m / self.setup.diameter_m;
        dy[BearingOutput::SpecificLoad.index()] = -self.specific_load_pa(at.t_s) * shrink;
    }

    fn output_cotangent(&self, point: &BearingPoint, at: At, w: &[f64], out: Cotangent) {
        let (n, site) = (self.layout.n, point.site());
        let weights = FilmWeights { residual: &[], content: &[], output: Self::film_weights(w) };
        let mut bar = self.setup.film.cotangent_at(&self.place(point, &site, at), &weights);
        let load = w[BearingOutput::SpecificLoad.index()] * self.specific_load_pa(at.t_s);
        bar.input.width_m -= load / self.setup.width_m;
        bar.input.diameter_m -= load / self.setup.diameter_m;
        self.pull_motions(&bar, out.z);
        for a in 0..2 {
            out.rate[n + a] += bar.input.velocity_m_s[a];
        }
        self.pull_parameters(point, &bar, out.p);
    }
}

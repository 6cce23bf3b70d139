//! Forward derivatives of the Reynolds film: changes of balances, contents and outputs along a direction.

use super::cavitation::Cavitation;
use super::cells::Cell;
use super::faces::{Face, Partial, Sides};
use super::fields::Scalars;
use super::gap::Modes;
use super::jet::SLOTS;
use super::reynolds::Reynolds;
use super::{Axial, FilmChange, FilmOutput, FilmPlace, FilmTangent, Gap, Wanted};

/// Changes of the cells along the direction.
struct Moved {
    gap: Vec<f64>,
    drop: Vec<f64>,
    fill: Vec<f64>,
    around: Vec<f64>,
    across: Vec<f64>,
    transport: Vec<f64>,
    content: Vec<f64>,
    shear: Vec<f64>,
    stress: Vec<f64>,
    contact: Vec<f64>,
}

struct Tangent<'a> {
    film: &'a Reynolds,
    place: &'a FilmPlace<'a>,
    q: &'a [f64],
    cells: &'a [Cell<SLOTS>],
    change: &'a FilmChange<'a>,
    s: Scalars,
    ds: Scalars,
    moved: Moved,
}

pub(super) fn tangent(
    film: &Reynolds,
    place: &FilmPlace,
    change: &FilmChange,
    wanted: Wanted,
) -> FilmTangent {
    let (u, du) = (&place.site.input, &change.input);
    let (s, ds) = (Scalars::of(&film.mesh, u), Scalars::tangent(&film.mesh, u, du));
    let moved = Moved::of(film, place, change, &ds, wanted);
    let work = Tangent { film, place, q: place.q, cells: &place.point.cells, change, s, ds, moved };
    FilmTangent {
        residual: if wanted.residual { work.residual(place.rate) } else { Vec::new() },
        content: if wanted.content { work.content() } else { Vec::new() },
        output: if wanted.output { work.output() } else { FilmOutput::default() },
        contact_pa: work.moved.contact,
    }
}

impl Moved {
    fn of(film: &Reynolds, place: &FilmPlace, change: &FilmChange, ds: &Scalars, wanted: Wanted) -> Self {
        let (q, site, cells) = (place.q, place.site, &place.point.cells);
        let n = q.len();
        let mut gap = vec![0.0; n];
        Gap::tangent(&film.mesh, &site.input, &change.input, change.shape_m, &mut gap);
        let dq = |k: usize| change.q.get(k).copied().unwrap_or(0.0);
        let drop: Vec<f64> = (0..n).map(|k| film.cavitation.split(q[k]).p_slope * dq(k)).collect();
        let fill = (0..n).map(|k| film.cavitation.split(q[k]).fill_slope * dq(k)).collect();
        let shell = |k: usize| {
            let left = site.shell_left.get(k).copied().unwrap_or(1.0);
            let changes = change.shell_left.get(k).copied().unwrap_or(0.0);
            ds.shell * left + site.input.shell_roughness_m * changes
        };
        let slots = |k: usize| [gap[k], drop[k], ds.eta, ds.journal, shell(k), ds.speed];
        let of = |needed: bool, jet: fn(&Cell<SLOTS>) -> &super::jet::Jet<SLOTS>| -> Vec<f64> {
            if !needed {
                return Vec::new();
            }
            cells.iter().enumerate().map(|(k, c)| jet(c).along(&slots(k))).collect()
        };
        let flows = wanted.residual || wanted.output;
        Self {
            around: of(flows, |c| &c.around),
            across: of(flows, |c| &c.across),
            transport: of(flows, |c| &c.transport),
            content: of(wanted.content, |c| &c.content),
            shear: of(wanted.output, |c| &c.shear),
            stress: of(wanted.output, |c| &c.stress),
            contact: of(wanted.output, |c| &c.contact),
            gap,
            drop,
            fill,
        }
    }
}

impl Tangent<'_> {
    fn dq(&self, k: usize) -> f64 {
        self.change.q.get(k).copied().unwrap_or(0.0)
    }

    /// Change of a face quantity whose thickness is one of the cells'.
    fn along(&self, face: &Face, partial: &Partial, thickness: &[f64]) -> f64 {
        let (m, r) = (&self.moved, if face.around { &self.moved.around } else { &self.moved.across });
        let pair = |v: &[f64]| [v[face.a], face.b.map_or(0.0, |b| v[b])];
        let drop = m.drop[face.a] - face.b.map_or(0.0, |b| m.drop[b]);
        let fill = if self.s.speed >= 0.0 { m.fill[face.a] } else { face.b.map_or(0.0, |b| m.fill[b]) };
        partial.along(drop, pair(r), pair(thickness), fill, &self.ds)
    }

    fn sides(&self, face: &Face) -> Sides<'_, SLOTS> {
        self.film.sides(face, self.cells, self.q, self.s.speed)
    }

    fn residual(&self, rate: &[f64]) -> Vec<f64> {
        let (s, d, film) = (&self.s, &self.ds, self.film);
        let (area, d_area) = (s.dx * s.dz, d.dx * s.dz + s.dx * d.dz);
        let d_rate = |k: usize| self.change.rate.get(k).copied().unwrap_or(0.0);
        let mut out: Vec<f64> = rate.iter().enumerate().map(|(k, c)| d_rate(k) * area + c * d_area).collect();
        film.for_faces(|face| {
            let flow = self.sides(&face).flow(face.around, s);
            let change = self.along(&face, &flow, &self.moved.transport);
            out[face.a] += change;
            if let Some(b) = face.b {
                out[b] -= change;
            }
        });
        self.close_rows(&mut out);
        out
    }

    fn close_rows(&self, out: &mut [f64]) {
        let (s, d, film) = (&self.s, &self.ds, self.film);
        let cover = &self.place.point.cover;
        let (tie, d_tie) = (Reynolds::tie(s), Reynolds::tie_change(s, d));
        for (k, out) in out.iter_mut().enumerate() {
            let m = cover.share[k];
            if m > 0.0 {
                let supply = cover.fixed[k].unwrap_or(s.supply - film.cavitation_pressure_pa);
                let d_supply = if cover.fixed[k].is_some() { 0.0 } else { d.supply };
                let p = film.cavitation.split(self.q[k]).p;
                *out = (1.0 - m) * *out + m * (d_tie * (p - supply) + tie * (self.moved.drop[k] - d_supply));
            }
            if film.cavitation == Cavitation::SwiftStieber && self.q[k] < 0.0 {
                *out += d_tie * self.q[k] + tie * self.dq(k);
            }
        }
    }

    fn content(&self) -> Vec<f64> {
        let of = |k: usize| {
            let fill = self.film.cavitation.split(self.q[k]).fill;
            self.moved.fill[k] * self.cells[k].content.v + fill * self.moved.content[k]
        };
        (0..self.q.len()).map(of).collect()
    }

    fn output(&self) -> FilmOutput {
        let (s, d, film, u) = (&self.s, &self.ds, self.film, &self.place.site.input);
        let (area, d_area) = (s.dx * s.dz, d.dx * s.dz + s.dx * d.dz);
        let du = &self.change.input;
        let (friction, sign) = (film.boundary_friction(), s.speed.signum());
        let (mut y, mut loads) = (FilmOutput::default(), [0.0; 4]);
        let stretch = du.width_m / u.width_m;
        for (k, cell) in self.cells.iter().enumerate() {
            let m = Modes::at(&film.mesh, u, k / film.mesh.n_z).of(film.mesh.zetas[k % film.mesh.n_z]);
            let (load, slope) = film.cavitation.load(self.q[k]);
            let (p, dp) = (load + cell.contact.v, slope * self.dq(k) + self.moved.contact[k]);
            for a in 0..4 {
                let lever = if a < 2 { 0.0 } else { p * area * stretch };
                loads[a] += (dp * area + p * d_area + lever) * m[a];
            }
            let (sheared, by_fill) = film.sheared(film.cavitation.split(self.q[k]).fill);
            let power = cell.shear.v * s.speed;
            y.loss_w += sheared
                * (self.moved.shear[k] * s.speed * s.speed * area
                    + power * (2.0 * d.speed * area + s.speed * d_area))
                + by_fill * self.moved.fill[k] * power * s.speed * area;
            let pressing = cell.contact.v * (d.speed * area + s.speed * d_area);
            y.contact_loss_w += friction * sign * (self.moved.contact[k] * s.speed * area + pressing);
            if let Some(mark) = self.place.site.marks.get(k) {
                y.rubbing_w_m2 += mark * sign * (self.moved.contact[k] * s.speed + cell.contact.v * d.speed);
            }
        }
        y.dissipation_w = y.loss_w;
        film.for_faces(|face| {
            let sides = self.sides(&face);
            y.dissipation_w += self.along(&face, &sides.dissipation(face.around, s), &self.moved.transport);
            if face.around {
                y.loss_w += self.along(&face, &sides.shear_power(s), &self.moved.stress);
            } else if face.b.is_none() {
                y.side_flow_m3_s += self.along(&face, &sides.flow(false, s), &self.moved.transport);
            }
        });
        y.force_n = [loads[0], loads[1]];
        y.moment_n_m = if film.mesh.axial == Axial::Half { [0.0; 2] } else { [loads[2], loads[3]] };
        self.extrema(y.integrals_times(film.mesh.copies()))
    }

    fn extrema(&self, mut y: FilmOutput) -> FilmOutput {
        let (film, u, du) = (self.film, &self.place.site.input, &self.change.input);
        if film.is_plain(self.place.site) {
            let slope = Gap::minimum_slope(u);
            y.gap_min_m = du.clearance_m + slope[0] * du.eccentricity_m[0] + slope[1] * du.eccentricity_m[1];
        } else {
            let (low, lift) = (film.lowest(&self.place.point.gap), film.lift_m());
            y.gap_min_m = self
                .place
                .point
                .gap
                .iter()
                .zip(&self.moved.gap)
                .map(|(h, dh)| low.derivative(h + lift) * dh)
                .sum();
        }
        let peak = film.peak(self.q);
        let load = |k: usize| film.cavitation.load(self.q[k]);
        y.pressure_peak_pa =
            (0..self.q.len()).map(|k| peak.derivative(load(k).0) * load(k).1 * self.dq(k)).sum();
        let contact = film.contact_peak(self.cells);
        let share = |(c, d): (&Cell<SLOTS>, &f64)| contact.derivative(c.contact.v) * d;
        y.contact_peak_pa = self.cells.iter().zip(&self.moved.contact).map(share).sum();
        y
    }
}

//! Backward derivatives of the Reynolds film: what weights on balances, contents and outputs mean for everything they
//! depend on. The transpose of [`super::tangent`], term by term.

use super::cavitation::Cavitation;
use super::cells::Cell;
use super::faces::{Face, Partial, Sides};
use super::fields::Scalars;
use super::gap::Modes;
use super::jet::SLOTS;
use super::reynolds::Reynolds;
use super::{Axial, FilmCotangent, FilmOutput, FilmPlace, FilmWeights, Gap};

/// Derivatives by the quantities of one cell.
#[derive(Debug, Clone, Copy, Default)]
struct CellBar {
    p: f64,
    fill: f64,
    around: f64,
    across: f64,
    transport: f64,
    content: f64,
    shear: f64,
    stress: f64,
    contact: f64,
    gap: f64,
}

/// Which thickness a face quantity rests on.
#[derive(Clone, Copy)]
enum Thickness {
    Transport,
    Stress,
}

struct Cotangent<'a> {
    film: &'a Reynolds,
    place: &'a FilmPlace<'a>,
    q: &'a [f64],
    cells: &'a [Cell<SLOTS>],
    s: Scalars,
    bars: Vec<CellBar>,
    scalars: Scalars,
    out: FilmCotangent,
}

pub(super) fn cotangent(film: &Reynolds, place: &FilmPlace, weights: &FilmWeights) -> FilmCotangent {
    let (q, n) = (place.q, place.q.len());
    let rate = if weights.residual.is_empty() { Vec::new() } else { vec![0.0; n] };
    let mut work = Cotangent {
        film,
        place,
        q,
        cells: &place.point.cells,
        s: Scalars::of(&film.mesh, &place.site.input),
        bars: vec![CellBar::default(); n],
        scalars: Scalars::default(),
        out: FilmCotangent {
            q: vec![0.0; n],
            rate,
            gap_m: vec![0.0; n],
            shell_left: vec![0.0; place.site.shell_left.len()],
            ..Default::default()
        },
    };
    if !weights.residual.is_empty() {
        work.residual(place.rate, weights.residual);
    }
    if !weights.content.is_empty() {
        work.content(weights.content);
    }
    if weights.output != FilmOutput::default() {
        work.output(&weights.output);
    }
    work.finish()
}

impl Cotangent<'_> {
    fn sides(&self, face: &Face) -> Sides<'_, SLOTS> {
        self.film.sides(face, self.cells, self.q, self.s.speed)
    }

    /// Adds a weighted face quantity.
    fn pull(&mut self, face: &Face, partial: &Partial, weight: f64, thickness: Thickness) {
        let mut cell = |k: usize, side: usize, sign: f64| {
            let bar = &mut self.bars[k];
            bar.p += weight * sign * partial.by_drop;
            let r = if face.around { &mut bar.around } else { &mut bar.across };
            *r += weight * partial.by_resistance[side];
            let t = match thickness {
                Thickness::Transport => &mut bar.transport,
                Thickness::Stress => &mut bar.stress,
            };
            *t += weight * partial.by_thickness[side];
        };
        cell(face.a, 0, 1.0);
        if let Some(b) = face.b {
            cell(b, 1, -1.0);
        }
        let upstream = if self.s.speed >= 0.0 { Some(face.a) } else { face.b };
        if let Some(k) = upstream {
            self.bars[k].fill += weight * partial.by_fill;
        }
        self.scalars.speed += weight * partial.by_speed;
        self.scalars.dx += weight * partial.by_dx;
        self.scalars.dz += weight * partial.by_dz;
    }

    fn residual(&mut self, rate: &[f64], lambda: &[f64]) {
        let (s, film) = (self.s, self.film);
        let cover = &self.place.point.cover;
        let tie = Reynolds::tie(&s);
        let mut tie_bar = 0.0;
        let mut weight = lambda.to_vec();
        for (k, w) in weight.iter_mut().enumerate() {
            let m = cover.share[k];
            if film.cavitation == Cavitation::SwiftStieber && self.q[k] < 0.0 {
                self.out.q[k] += *w * tie;
                tie_bar += *w * self.q[k];
            }
            if m > 0.0 {
                let supply = cover.fixed[k].unwrap_or(s.supply - film.cavitation_pressure_pa);
                tie_bar += *w * m * (film.cavitation.split(self.q[k]).p - supply);
                self.bars[k].p += *w * m * tie;
                if cover.fixed[k].is_none() {
                    self.scalars.supply -= *w * m * tie;
                }
                *w *= 1.0 - m;
            }
        }
        Reynolds::pull_tie(&s, tie_bar, &mut self.scalars);
        for (k, (w, c)) in weight.iter().zip(rate).enumerate() {
            self.out.rate[k] += w * s.dx * s.dz;
            self.scalars.dx += w * c * s.dz;
            self.scalars.dz += w * c * s.dx;
        }
        self.flows(&weight);
    }

    /// Weighted flows through all faces: [`Sides::flow`] as [`Self::pull`] sees it, with what all faces share taken out of the sums.
    fn flows(&mut self, weight: &[f64]) {
        let (s, film, q, cells, bars) = (self.s, self.film, self.q, self.cells, &mut self.bars);
        let (downstream, side) = (s.speed >= 0.0, film.side());
        let (mut pressed, mut dragged) = ([0.0; 2], 0.0);
        film.for_faces(|face| {
            let w = weight[face.a] - face.b.map_or(0.0, |b| weight[b]);
            if w == 0.0 {
                return;
            }
            let a = film.cavitation.split(q[face.a]);
            let b = face.b.map(|b| film.cavitation.split(q[b]));
            let drop = a.p - b.map_or(side, |b| b.p);
            if let (true, Some(k)) = (face.around, face.b) {
                let ([ra, rb], [ta, tb]) = (
                    [cells[face.a].around.v, cells[k].around.v],
                    [cells[face.a].transport.v, cells[k].transport.v],
                );
                let per_sum = 1.0 / (ra + rb);
                let conductance = 2.0 * per_sum * s.dz / s.dx * w;
                let mean = (ta * ra + tb * rb) * per_sum;
                let fill = if downstream { a.fill } else { b.map_or(1.0, |b| b.fill) };
                let drag = s.speed / 2.0 * s.dz * w;
                let (flow, carried) = (conductance * drop, drag * fill);
                let [bar_a, bar_b] =
                    bars.get_disjoint_mut([face.a, k]).expect("a face lies between two cells");
                bar_a.p += conductance;
                bar_b.p -= conductance;
                bar_a.around += (carried * (ta - mean) - flow) * per_sum;
                bar_b.around += (carried * (tb - mean) - flow) * per_sum;
                bar_a.transport += carried * ra * per_sum;
                bar_b.transport += carried * rb * per_sum;
                (if downstream { bar_a } else { bar_b }).fill += drag * mean;
                pressed[0] += flow;
                dragged += w * fill * mean;
            } else {
                let per_sum = 1.0 / (cells[face.a].across.v + face.b.map_or(0.0, |b| cells[b].across.v));
                let conductance = 2.0 * per_sum * s.dx / s.dz * w;
                let flow = conductance * drop;
                for (k, sign) in [(Some(face.a), 1.0), (face.b, -1.0)] {
                    let Some(k) = k else { continue };
                    bars[k].p += sign * conductance;
                    bars[k].across -= flow * per_sum;
                }
                pressed[1] += flow;
            }
        });
        let [around, across] = pressed;
        self.scalars.speed += s.dz / 2.0 * dragged;
        self.scalars.dx += (across - around) / s.dx;
        self.scalars.dz += (around - across) / s.dz + s.speed / 2.0 * dragged;
    }

    fn content(&mut self, weights: &[f64]) {
        for (k, w) in weights.iter().enumerate() {
            let fill = self.film.cavitation.split(self.q[k]).fill;
            self.bars[k].fill += w * self.cells[k].content.v;
            self.bars[k].content += w * fill;
        }
    }

    fn output(&mut self, y: &FilmOutput) {
        let film = self.film;
        let mut w = y.integrals_times(film.mesh.copies());
        if film.mesh.axial == Axial::Half {
            w.moment_n_m = [0.0; 2];
        }
        self.cell_integrals(&w);
        let s = self.s;
        if w.loss_w != 0.0 || w.dissipation_w != 0.0 {
            film.for_faces(|face| {
                let (dissipation, shear) = {
                    let sides = self.sides(&face);
                    (sides.dissipation(face.around, &s), face.around.then(|| sides.shear_power(&s)))
                };
                self.pull(&face, &dissipation, w.dissipation_w, Thickness::Transport);
                if let Some(shear) = shear {
                    self.pull(&face, &shear, w.loss_w, Thickness::Stress);
                }
            });
        }
        if w.side_flow_m3_s != 0.0 {
            film.for_faces(|face| {
                if face.b.is_none() {
                    let flow = self.sides(&face).flow(false, &s);
                    self.pull(&face, &flow, w.side_flow_m3_s, Thickness::Transport);
                }
            });
        }
        self.extrema(y);
    }

    fn cell_integrals(&mut self, w: &FilmOutput) {
        let (s, film, u) = (self.s, self.film, self.place.site.input);
        let (area, loads) = (s.dx * s.dz, w.loads());
        let (friction, sign) = (film.boundary_friction(), s.speed.signum());
        let shear_weight = w.loss_w + w.dissipation_w;
        let mut area_bar = 0.0;
        for k in 0..self.q.len() {
            let m = Modes::at(&film.mesh, &u, k / film.mesh.n_z).of(film.mesh.zetas[k % film.mesh.n_z]);
            let cell = &self.cells[k];
            let (load, slope) = film.cavitation.load(self.q[k]);
            let pushed: f64 = (0..4).map(|a| loads[a] * m[a]).sum();
            let turned = loads[2] * m[2] + loads[3] * m[3];
            let bar = &mut self.bars[k];
            self.out.q[k] += pushed * area * slope;
            bar.contact += pushed * area;
            area_bar += pushed * (load + cell.contact.v);
            self.out.input.width_m += turned * (load + cell.contact.v) * area / u.width_m;
            let (sheared, by_fill) = film.sheared(film.cavitation.split(self.q[k]).fill);
            let power = cell.shear.v * s.speed * s.speed;
            bar.shear += shear_weight * sheared * s.speed * s.speed * area;
            bar.fill += shear_weight * by_fill * power * area;
            self.scalars.speed += shear_weight * sheared * 2.0 * cell.shear.v * s.speed * area;
            area_bar += shear_weight * sheared * power;
            let rubbing = w.contact_loss_w * friction * sign;
            bar.contact += rubbing * s.speed * area;
            self.scalars.speed += rubbing * cell.contact.v * area;
            area_bar += rubbing * cell.contact.v * s.speed;
            if let Some(mark) = self.place.site.marks.get(k) {
                let marked = w.rubbing_w_m2 * mark * sign;
                bar.contact += marked * s.speed;
                self.scalars.speed += marked * cell.contact.v;
            }
        }
        self.scalars.dx += area_bar * s.dz;
        self.scalars.dz += area_bar * s.dx;
    }

    fn extrema(&mut self, w: &FilmOutput) {
        let film = self.film;
        if w.gap_min_m != 0.0 && film.is_plain(self.place.site) {
            let slope = Gap::minimum_slope(&self.place.site.input);
            self.out.input.clearance_m += w.gap_min_m;
            self.out.input.eccentricity_m[0] += w.gap_min_m * slope[0];
            self.out.input.eccentricity_m[1] += w.gap_min_m * slope[1];
        } else if w.gap_min_m != 0.0 {
            let (low, lift) = (film.lowest(&self.place.point.gap), film.lift_m());
            for (bar, h) in self.bars.iter_mut().zip(&self.place.point.gap) {
                bar.gap += w.gap_min_m * low.derivative(h + lift);
            }
        }
        if w.pressure_peak_pa != 0.0 {
            let peak = film.peak(self.q);
            for (bar, q) in self.out.q.iter_mut().zip(self.q) {
                let (p, slope) = film.cavitation.load(*q);
                *bar += w.pressure_peak_pa * peak.derivative(p) * slope;
            }
        }
        if w.contact_peak_pa != 0.0 {
            let peak = film.contact_peak(self.cells);
            for (bar, cell) in self.bars.iter_mut().zip(self.cells) {
                bar.contact += w.contact_peak_pa * peak.derivative(cell.contact.v);
            }
        }
    }

    /// Carries the derivatives by cell quantities on to gap, unknowns and scalars.
    fn finish(mut self) -> FilmCotangent {
        for (k, (bar, cell)) in self.bars.iter().zip(self.cells).enumerate() {
            let mut slots = [0.0; SLOTS];
            cell.around.pull(bar.around, &mut slots);
            cell.across.pull(bar.across, &mut slots);
            cell.transport.pull(bar.transport, &mut slots);
            cell.content.pull(bar.content, &mut slots);
            cell.shear.pull(bar.shear, &mut slots);
            cell.stress.pull(bar.stress, &mut slots);
            cell.contact.pull(bar.contact, &mut slots);
            let [gap, p, eta, journal, shell, speed] = slots;
            let split = self.film.cavitation.split(self.q[k]);
            self.out.gap_m[k] += gap + bar.gap;
            self.out.q[k] += (p + bar.p) * split.p_slope + bar.fill * split.fill_slope;
            self.scalars.eta += eta;
            self.scalars.journal += journal;
            let left = self.place.site.shell_left.get(k).copied().unwrap_or(1.0);
            self.scalars.shell += left * shell;
            if let Some(bar) = self.out.shell_left.get_mut(k) {
                *bar += self.place.site.input.shell_roughness_m * shell;
            }
            self.scalars.speed += speed;
        }
        let (mesh, u) = (&self.film.mesh, &self.place.site.input);
        Gap::pull_back(mesh, u, &self.out.gap_m, &mut self.out.input);
        self.scalars.pull_back(mesh, u, &mut self.out.input);
        self.out
    }
}

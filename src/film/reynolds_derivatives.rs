//! First derivatives of the Reynolds film, forwards (tangent) and backwards (cotangent), face by face.
//!
//! Of a face with conductance `k = h_f^3 / (12 eta) * aspect` the flow is `k drop + U/2 h_f dz`, so
//!
//! ```text
//! d flow = k drop (3 dh_f / h_f - d eta / eta + d aspect / aspect) + d(U/2 h_f dz)
//! ```
//!
//! Rows of cavitated and held cells have no derivative by the input: there the residual is a multiple of `q - q_given`.

use super::fields::Scalars;
use super::reynolds::Face;
use super::{FilmInput, FilmOutput, Gap, Mesh, Reynolds};

/// A point at which the film is differentiated.
struct Point {
    gap: Gap,
    s: Scalars,
}

impl Point {
    fn at(film: &Reynolds, u: &FilmInput) -> Self {
        Self { gap: Gap::of(&film.mesh, u), s: Scalars::of(&film.mesh, u) }
    }

    /// A change of the input as a change of gap and scalars.
    fn change(film: &Reynolds, u: &FilmInput, du: &FilmInput) -> Self {
        Self { gap: Gap::of(&film.mesh, du), s: Scalars::tangent(&film.mesh, u, du) }
    }

    fn zeros(mesh: &Mesh) -> Self {
        Self { gap: Gap::zeros(mesh), s: Scalars::default() }
    }

    fn pull_back(&self, film: &Reynolds, u: &FilmInput) -> FilmInput {
        let mut u_bar = FilmInput::default();
        self.gap.pull_back(&film.mesh, &mut u_bar);
        self.s.pull_back(&film.mesh, u, &mut u_bar);
        u_bar
    }
}

/// Change of a face's gap.
fn face_gap(face: &Face, dh: &[f64]) -> f64 {
    face.b.map_or(dh[face.a], |b| (dh[face.a] + dh[b]) / 2.0)
}

/// Sign of `d ln aspect = +-(d ln dz - d ln dx)`.
fn aspect_sign(face: &Face) -> f64 {
    if face.around { 1.0 } else { -1.0 }
}

/// `d k / k` for a change of gap and scalars.
fn conductance_change(face: &Face, h: f64, s: &Scalars, d: &Point) -> f64 {
    3.0 * face_gap(face, &d.gap.h) / h - d.s.eta / s.eta + aspect_sign(face) * (d.s.dz / s.dz - d.s.dx / s.dx)
}

/// Adds what a weight `c` on `ln k` means.
fn pull_conductance(face: &Face, h: f64, s: &Scalars, c: f64, bar: &mut Point) {
    pull_gap(face, 3.0 * c / h, bar);
    bar.s.eta -= c / s.eta;
    bar.s.dz += aspect_sign(face) * c / s.dz;
    bar.s.dx -= aspect_sign(face) * c / s.dx;
}

/// Adds a weight on the gap of a face.
fn pull_gap(face: &Face, c: f64, bar: &mut Point) {
    match face.b {
        Some(b) => {
            bar.gap.h[face.a] += c / 2.0;
            bar.gap.h[b] += c / 2.0;
        }
        None => bar.gap.h[face.a] += c,
    }
}

/// Drop of the pressure over a face.
fn drop(film: &Reynolds, face: &Face, q: &[f64]) -> f64 {
    q[face.a] - face.b.map_or(film.side(), |b| q[b])
}

pub(super) fn residual_tangent(film: &Reynolds, u: &FilmInput, q: &[f64], du: &FilmInput, out: &mut [f64]) {
    let gap = Gap::of(&film.mesh, u);
    let passive = film.is_passive(u, q, &gap);
    residual_tangents(film, u, q, &gap, &passive, std::slice::from_ref(du), out);
}

/// One column per change; what the columns share is computed once.
pub(super) fn residual_tangents(
    film: &Reynolds,
    u: &FilmInput,
    q: &[f64],
    gap: &Gap,
    passive: &[bool],
    dus: &[FilmInput],
    columns: &mut [f64],
) {
    let n = q.len();
    let s = &Scalars::of(&film.mesh, u);
    let changes: Vec<Point> = dus.iter().map(|du| Point::change(film, u, du)).collect();
    film.for_faces(|face| {
        if passive[face.a] && face.b.is_none_or(|b| passive[b]) {
            return;
        }
        let (k, h) = film.conductance(&face, &gap.h, s);
        let pressure_flow = k * drop(film, &face, q);
        for (d, out) in changes.iter().zip(columns.chunks_exact_mut(n)) {
            let mut flow = pressure_flow * conductance_change(&face, h, s, d);
            if face.around {
                flow +=
                    (d.s.speed * h * s.dz + s.speed * (face_gap(&face, &d.gap.h) * s.dz + h * d.s.dz)) / 2.0;
            }
            if !passive[face.a] {
                out[face.a] += flow;
            }
            if let Some(b) = face.b.filter(|&b| !passive[b]) {
                out[b] -= flow;
            }
        }
    });
    for (d, out) in changes.iter().zip(columns.chunks_exact_mut(n)) {
        for (k, out) in out.iter_mut().enumerate().filter(|(k, _)| !passive[*k]) {
            *out += d.gap.rate[k] * s.dx * s.dz + gap.rate[k] * (d.s.dx * s.dz + s.dx * d.s.dz);
        }
    }
}

pub(super) fn residual_cotangent(film: &Reynolds, u: &FilmInput, q: &[f64], lambda: &[f64]) -> FilmInput {
    let at = Point::at(film, u);
    let s = &at.s;
    let passive = film.is_passive(u, q, &at.gap);
    let weight = |k: usize| if passive[k] { 0.0 } else { lambda[k] };
    let mut bar = Point::zeros(&film.mesh);
    film.for_faces(|face| {
        let c = weight(face.a) - face.b.map_or(0.0, weight);
        if c == 0.0 {
            return;
        }
        let (k, h) = film.conductance(&face, &at.gap.h, s);
        pull_conductance(&face, h, s, c * k * drop(film, &face, q), &mut bar);
        if face.around {
            bar.s.speed += c * h * s.dz / 2.0;
            bar.s.dz += c * s.speed * h / 2.0;
            pull_gap(&face, c * s.speed * s.dz / 2.0, &mut bar);
        }
    });
    for (k, rate) in at.gap.rate.iter().enumerate() {
        let c = weight(k);
        bar.gap.rate[k] += c * s.dx * s.dz;
        bar.s.dx += c * rate * s.dz;
        bar.s.dz += c * rate * s.dx;
    }
    bar.pull_back(film, u)
}

pub(super) fn output_tangent(
    film: &Reynolds,
    u: &FilmInput,
    q: &[f64],
    dq: &[f64],
    du: &FilmInput,
) -> FilmOutput {
    let at = Point::at(film, u);
    let d = Point::change(film, u, du);
    let s = &at.s;
    let (area, d_area) = (s.dx * s.dz, d.s.dx * s.dz + s.dx * d.s.dz);
    let mut y = FilmOutput::default();
    for (k, h) in at.gap.h.iter().enumerate() {
        let n = film.mesh.normals[k / film.mesh.n_z];
        let df = dq[k] * area + q[k] * d_area;
        y.force_n[0] -= df * n[0];
        y.force_n[1] -= df * n[1];
        y.loss_w += s.speed / h
            * (d.s.eta * s.speed * area + 2.0 * s.eta * d.s.speed * area + s.eta * s.speed * d_area
                - s.eta * s.speed * area * d.gap.h[k] / h);
    }
    y.dissipation_w = y.loss_w;
    film.for_faces(|face| {
        let (k, h) = film.conductance(&face, &at.gap.h, s);
        let dk = k * conductance_change(&face, h, s, &d);
        let (p, dp) = (drop(film, &face, q), dq[face.a] - face.b.map_or(0.0, |b| dq[b]));
        y.dissipation_w += dk * p * p + 2.0 * k * p * dp;
        if face.around {
            let dh = face_gap(&face, &d.gap.h);
            y.loss_w -=
                (d.s.speed * p * h * s.dz + s.speed * (dp * h * s.dz + p * dh * s.dz + p * h * d.s.dz)) / 2.0;
        }
        if face.b.is_none() {
            y.side_flow_m3_s += dk * p + k * dp;
        }
    });
    y.times(film.mesh.copies());
    let slope = Gap::minimum_slope(u);
    y.gap_min_m = du.clearance_m + slope[0] * du.eccentricity_m[0] + slope[1] * du.eccentricity_m[1];
    let peak = film.peak(q);
    y.pressure_peak_pa = q.iter().zip(dq).map(|(q, dq)| peak.derivative(*q) * dq).sum();
    y
}

pub(super) fn output_cotangent(
    film: &Reynolds,
    u: &FilmInput,
    q: &[f64],
    w: &FilmOutput,
    q_bar: &mut [f64],
) -> FilmInput {
    let at = Point::at(film, u);
    let s = &at.s;
    let copies = film.mesh.copies();
    let (force, loss) = (w.force_n.map(|f| f * copies), w.loss_w * copies);
    let (dissipation, flow) = (w.dissipation_w * copies, w.side_flow_m3_s * copies);
    let area = s.dx * s.dz;
    let mut bar = Point::zeros(&film.mesh);
    let mut area_bar = 0.0;
    for (k, h) in at.gap.h.iter().enumerate() {
        let n = film.mesh.normals[k / film.mesh.n_z];
        let along = force[0] * n[0] + force[1] * n[1];
        q_bar[k] -= along * area;
        area_bar -= along * q[k];
        let shear = (loss + dissipation) * s.speed / h;
        area_bar += shear * s.eta * s.speed;
        bar.s.eta += shear * s.speed * area;
        bar.s.speed += 2.0 * shear * s.eta * area;
        bar.gap.h[k] -= shear * s.eta * s.speed * area / h;
    }
    bar.s.dx += area_bar * s.dz;
    bar.s.dz += area_bar * s.dx;
    let integrals_over_faces = loss != 0.0 || dissipation != 0.0 || flow != 0.0;
    let each_face = |face: Face| {
        let (k, h) = film.conductance(&face, &at.gap.h, s);
        let p = drop(film, &face, q);
        let mut p_bar = 2.0 * dissipation * k * p;
        let mut ln_k_bar = dissipation * k * p * p;
        if face.around {
            let c = -loss / 2.0;
            p_bar += c * s.speed * h * s.dz;
            bar.s.speed += c * p * h * s.dz;
            bar.s.dz += c * s.speed * p * h;
            pull_gap(&face, c * s.speed * p * s.dz, &mut bar);
        }
        if face.b.is_none() {
            p_bar += flow * k;
            ln_k_bar += flow * k * p;
        }
        pull_conductance(&face, h, s, ln_k_bar, &mut bar);
        q_bar[face.a] += p_bar;
        if let Some(b) = face.b {
            q_bar[b] -= p_bar;
        }
    };
    if integrals_over_faces {
        film.for_faces(each_face);
    }
    if w.pressure_peak_pa != 0.0 {
        let peak = film.peak(q);
        q_bar.iter_mut().zip(q).for_each(|(bar, q)| *bar += w.pressure_peak_pa * peak.derivative(*q));
    }
    let mut u_bar = bar.pull_back(film, u);
    let slope = Gap::minimum_slope(u);
    u_bar.clearance_m += w.gap_min_m;
    u_bar.eccentricity_m[0] += w.gap_min_m * slope[0];
    u_bar.eccentricity_m[1] += w.gap_min_m * slope[1];
    u_bar
}

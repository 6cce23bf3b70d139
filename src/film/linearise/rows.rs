//! Rows of the linearised film, gathered from contents and faces; rows of the edges, of covered cells and of the loads.

use super::FilmLinear;
use super::faces::Faces;
use crate::film::Axial;
use crate::film::cavitation::Cavitation;
use crate::film::fields::Scalars;
use crate::film::reynolds::Reynolds;
use crate::math::{Lane, dot, sweep};

/// What the gathering keeps for the columns.
#[derive(Debug, Clone, Default)]
pub(super) struct Gathered {
    /// Derivative of each row by the gap of its own cell.
    by_gap: Vec<f64>,
    /// Derivative of each content by its gap.
    content_by_gap: Vec<f64>,
    /// Share of the older contents in their rates.
    past: Vec<f64>,
    /// Pressure on the journal, and its derivative by the unknown.
    load: Vec<f64>,
    load_slope: Vec<f64>,
    own: Own,
}

/// Rows of a film without flow: residual, derivatives by the cell's own unknown and gap.
#[derive(Debug, Clone, Default)]
struct Own {
    residual: Vec<f64>,
    by_unknown: Vec<f64>,
    by_gap: Vec<f64>,
}

impl Gathered {
    fn resize(&mut self, n: usize) {
        let Self { by_gap, content_by_gap, past, load, load_slope, own } = self;
        let own = [&mut own.residual, &mut own.by_unknown, &mut own.by_gap];
        own.into_iter()
            .chain([by_gap, content_by_gap, past, load, load_slope])
            .for_each(|v| v.resize(n, 0.0));
    }
}

/// Contents and their rates.
struct Store {
    alpha: f64,
    area: f64,
}

impl Lane<6, 6> for Store {
    /// Content with derivatives by unknown and gap; outflow of its rate with the same.
    #[inline(always)]
    fn at(&self, [fill, fill_slope, c, c_h, c_q, past]: [f64; 6]) -> [f64; 6] {
        let (content, by_unknown, by_gap) = (fill * c, fill_slope * c + fill * c_q, fill * c_h);
        let weight = self.alpha * self.area;
        [
            content,
            by_unknown,
            by_gap,
            (self.alpha * content + past) * self.area,
            weight * by_unknown,
            weight * by_gap,
        ]
    }
}

/// Contents of all cells, and rows of a film without flow.
pub(super) fn store(alpha: f64, past: &[f64], s: &Scalars, into: &mut FilmLinear) {
    let FilmLinear { content, carry, room, .. } = into;
    let (cells, rows, n) = (&room.cells, &mut room.rows, content.len());
    rows.resize(n);
    if past.is_empty() {
        rows.past.fill(0.0)
    } else {
        rows.past.copy_from_slice(&past[..n])
    }
    let [c, c_h, c_q] = cells.content().arrays().map(|v| v.as_slice());
    sweep(
        &Store { alpha, area: s.dx * s.dz },
        [&cells.fill, &cells.fill_slope, c, c_h, c_q, &rows.past],
        [
            content,
            &mut carry.content_by_unknown,
            &mut rows.content_by_gap,
            &mut rows.own.residual,
            &mut rows.own.by_unknown,
            &mut rows.own.by_gap,
        ],
    );
    for (by_rate, share) in carry.by_rate.iter_mut().zip(&room.cover.share) {
        *by_rate = s.dx * s.dz * (1.0 - share);
    }
}

struct Gather;

impl Lane<19, 7> for Gather {
    /// Net outflow, its derivatives by the unknowns of the cell and its neighbours, and by its own gap; the faces are those west, east,
    /// south and north of the cell, `qa` and `qb`, `ha` and `hb` their derivatives by the unknowns and gaps of both sides.
    #[inline(always)]
    fn at(&self, input: [f64; 19]) -> [f64; 7] {
        let [r, q, h, fw, fe, fs, fn_, qaw, qbw, qae, qbe, qas, qbs, qan, qbn, hbw, hae, hbs, han] = input;
        [
            r + ((fe - fw) + (fn_ - fs)),
            q + ((qae - qbw) + (qan - qbs)),
            -qaw,
            qbe,
            -qas,
            qbn,
            h + ((hae - hbw) + (han - hbs)),
        ]
    }
}

struct Column;

impl Lane<11, 2> for Column {
    /// Derivatives of row and content by a motion, from those by the gaps of the cell and its neighbours.
    #[inline(always)]
    fn at(&self, [c, own, west, east, south, north, m, mw, me, ms, mn]: [f64; 11]) -> [f64; 2] {
        [(own * m + (east * me - west * mw)) + (north * mn - south * ms), c * m]
    }
}

/// Rows from the faces of every cell.
pub(super) fn gather(film: &Reynolds, into: &mut FilmLinear) {
    let (n, n_z) = (into.content.len(), film.mesh.n_z);
    let FilmLinear { residual, stencil, columns, carry, room, motions, .. } = into;
    let (around, across, rows) = (&room.around, &room.across, &mut room.rows);
    let (ew, ns) = (faces(around, n_z, n), faces(across, 1, n));
    let own = &rows.own;
    sweep(
        &Gather,
        [
            &own.residual,
            &own.by_unknown,
            &own.by_gap,
            ew.flow[0],
            ew.flow[1],
            ns.flow[0],
            ns.flow[1],
            ew.qa[0],
            ew.qb[0],
            ew.qa[1],
            ew.qb[1],
            ns.qa[0],
            ns.qb[0],
            ns.qa[1],
            ns.qb[1],
            ew.hb[0],
            ew.ha[1],
            ns.hb[0],
            ns.ha[1],
        ],
        [
            residual,
            &mut stencil.diagonal,
            &mut stencil.west,
            &mut stencil.east,
            &mut stencil.south,
            &mut stencil.north,
            &mut rows.by_gap,
        ],
    );
    for a in 0..*motions {
        let mode = |from: usize| &room.cells.modes[a][from..from + n];
        let column = a * n..(a + 1) * n;
        sweep(
            &Column,
            [
                &rows.content_by_gap,
                &rows.by_gap,
                ew.ha[0],
                ew.hb[1],
                ns.ha[0],
                ns.hb[1],
                mode(n_z),
                mode(0),
                mode(2 * n_z),
                mode(n_z - 1),
                mode(n_z + 1),
            ],
            [&mut columns[column.clone()], &mut carry.content_by_motion[column]],
        );
    }
}

/// The two faces of every cell in one direction: before it and behind it.
struct Pairs<'a> {
    flow: [&'a [f64]; 2],
    qa: [&'a [f64]; 2],
    qb: [&'a [f64]; 2],
    ha: [&'a [f64]; 2],
    hb: [&'a [f64]; 2],
}

fn faces(of: &Faces, apart: usize, n: usize) -> Pairs<'_> {
    fn pair(v: &[f64], apart: usize, n: usize) -> [&[f64]; 2] {
        [&v[..n], &v[apart..apart + n]]
    }
    Pairs {
        flow: pair(&of.flow, apart, n),
        qa: pair(&of.by_unknown[0], apart, n),
        qb: pair(&of.by_unknown[1], apart, n),
        ha: pair(&of.by_gap[0], apart, n),
        hb: pair(&of.by_gap[1], apart, n),
    }
}

/// Flow through the edges of the bearing, half a cell away from the cells along them.
pub(super) fn edges(film: &Reynolds, s: &Scalars, into: &mut FilmLinear) {
    let (n, n_z, side) = (into.content.len(), film.mesh.n_z, film.side());
    let cells = &into.room.cells;
    let across = cells.across();
    let mut edge = |k: usize| {
        let per_r = 1.0 / across.value[k];
        let conductance = 2.0 * s.dx / s.dz * per_r;
        let flow = conductance * (cells.pressure[k] - side);
        into.residual[k] += flow;
        into.stencil.diagonal[k] +=
            conductance * cells.pressure_slope[k] - flow * per_r * across.by_unknown[k];
        let by_gap = -flow * per_r * across.by_gap[k];
        for a in 0..into.motions {
            into.columns[a * n + k] += by_gap * cells.modes[a][n_z + k];
        }
    };
    for first in (0..n).step_by(n_z) {
        edge(first + n_z - 1);
        if film.mesh.low_edge() {
            edge(first);
        }
    }
}

/// Covered and slack cells.
pub(super) fn close(film: &Reynolds, q: &[f64], s: &Scalars, into: &mut FilmLinear) {
    let FilmLinear { residual, stencil, columns, room, motions, .. } = into;
    let (tie, n) = (Reynolds::tie(s), q.len());
    let slack = film.cavitation == Cavitation::SwiftStieber;
    for (k, &m) in room.cover.share.iter().enumerate() {
        if m > 0.0 {
            let sides = [
                &mut stencil.diagonal,
                &mut stencil.west,
                &mut stencil.east,
                &mut stencil.south,
                &mut stencil.north,
            ];
            sides.into_iter().for_each(|side| side[k] *= 1.0 - m);
            stencil.diagonal[k] += m * tie * room.cells.pressure_slope[k];
            (0..*motions).for_each(|a| columns[a * n + k] *= 1.0 - m);
        }
        if slack && q[k] < 0.0 {
            stencil.diagonal[k] += tie;
        }
    }
    film.close_rows(&room.cover, q, s, residual);
}

struct Times {
    factor: f64,
}

impl Lane<2, 1> for Times {
    #[inline(always)]
    fn at(&self, [a, b]: [f64; 2]) -> [f64; 1] {
        [self.factor * a * b]
    }
}

/// Loads on the journal with their derivatives by unknowns and motions.
pub(super) fn loads(film: &Reynolds, q: &[f64], s: &Scalars, into: &mut FilmLinear) {
    let (n, n_z, motions) = (q.len(), film.mesh.n_z, into.motions);
    let area = s.dx * s.dz * film.mesh.copies();
    debug_assert!(
        motions == 2 || film.mesh.axial == Axial::Full,
        "a tilting journal needs a mesh over the whole width"
    );
    let FilmLinear { rows, room, .. } = into;
    let (cells, work) = (&room.cells, &mut room.rows);
    for (k, q) in q.iter().enumerate() {
        (work.load[k], work.load_slope[k]) = film.cavitation.load(*q);
    }
    work.load.iter_mut().zip(&cells.contact).for_each(|(p, contact)| *p += contact);
    let mode = |a: usize| &cells.modes[a][n_z..n_z + n];
    (into.loads, into.corner) = ([0.0; 4], [[0.0; 4]; 4]);
    for a in 0..motions {
        into.loads[a] = area * dot(&work.load, mode(a));
        sweep(&Times { factor: area }, [&work.load_slope, mode(a)], [&mut rows[a * n..(a + 1) * n]]);
    }
    if cells.contact_slope.iter().any(|slope| *slope != 0.0) {
        for a in 0..motions {
            sweep(&Times { factor: area }, [&cells.contact_slope, mode(a)], [&mut work.load]);
            (0..motions).for_each(|b| into.corner[a][b] = dot(&work.load, mode(b)));
        }
    }
}

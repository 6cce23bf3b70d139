//! The shapes of a bearing on its mesh, what is worn off them, and marks on them: sampled once where they stand still, evaluated anew
//! where they turn.

use super::{BearingParameter, BearingSetup, SurfaceField};
use crate::film::SampledProfile;
use std::sync::Arc;

/// Shapes on the cells of a film.
#[derive(Clone)]
pub(super) struct Shapes {
    pub(super) points: Arc<Vec<[f64; 2]>>,
    /// Sum of all that stands still; empty if there is no shape at all.
    still: Vec<f64>,
    /// Which coefficients are parameters: (parameter, shape, coefficient).
    pub(super) varied: Vec<(usize, usize, usize)>,
    pub(super) samples: Arc<Vec<SampledProfile>>,
    pub(super) turning: Vec<bool>,
    pub(super) setup: Arc<Vec<super::BearingShape>>,
    worn: Arc<SurfaceField>,
    marks: Arc<SurfaceField>,
    pub(super) grid: Grid,
}

/// Cells around and across: the grid that surface fields stand on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Grid {
    around: usize,
    across: usize,
}

impl Grid {
    /// Calls `visit` with every cell, a cell of the journal's grid that it sees while the journal stands at an angle, and the share it
    /// sees of it.
    pub fn turn(self, angle_rad: f64, mut visit: impl FnMut(usize, usize, f64)) {
        let (n, b) = (self.around, self.across);
        if n == 0 {
            return;
        }
        let columns = -angle_rad / std::f64::consts::TAU * n as f64;
        let (whole, share) = (columns.floor(), columns - columns.floor());
        let first = (whole as i64).rem_euclid(n as i64) as usize;
        for i in 0..n {
            let (k, next) = ((first + i) % n, (first + i + 1) % n);
            for j in 0..b {
                visit(i * b + j, k * b + j, 1.0 - share);
                visit(i * b + j, next * b + j, share);
            }
        }
    }

    /// Adds to a field of the shell what a field of the journal puts there.
    fn turned_onto(self, angle_rad: f64, journal: &[f64], shell: &mut [f64]) {
        if !journal.is_empty() {
            self.turn(angle_rad, |cell, at, share| shell[cell] += share * journal[at]);
        }
    }
}

impl Shapes {
    pub fn of(setup: &BearingSetup) -> Self {
        let points = match setup.film.mesh() {
            Some(mesh) if !setup.shapes.is_empty() => mesh.points().to_vec(),
            _ => Vec::new(),
        };
        let turning: Vec<bool> =
            setup.shapes.iter().map(|s| s.on_journal && !s.profile.axisymmetric()).collect();
        let samples: Vec<SampledProfile> = setup.shapes.iter().map(|s| s.profile.sample(&points)).collect();
        let grid = setup.film.mesh().map_or_else(Grid::default, |m| Grid { around: m.n_phi, across: m.n_z });
        let worn = setup.worn_m.clone();
        let bare = points.is_empty() && worn.shell.is_empty() && worn.journal.is_empty();
        let mut still = vec![0.0; if bare { 0 } else { grid.around * grid.across }];
        still.iter_mut().zip(&worn.shell).for_each(|(h, w)| *h += w);
        for (sample, _) in samples.iter().zip(&turning).filter(|(_, turns)| !**turns) {
            still.iter_mut().zip(&sample.gap_m).for_each(|(h, s)| *h += s);
        }
        let varied = setup.parameters.iter().enumerate().filter_map(|(j, kind)| match kind {
            BearingParameter::Shape(shape, k) => Some((j, *shape, *k)),
            _ => None,
        });
        Self {
            varied: varied.collect(),
            points: Arc::new(points),
            still,
            samples: Arc::new(samples),
            turning,
            setup: Arc::new(setup.shapes.clone()),
            worn,
            marks: setup.marks.clone(),
            grid,
        }
    }

    /// What shapes and wear add to the gap while the journal stands at an angle, and the marks as the shell sees them.
    pub fn at<'a>(&'a self, angle_rad: f64, room: &'a mut Vec<f64>) -> (&'a [f64], &'a [f64]) {
        let turns = self.turning.contains(&true) || !self.worn.journal.is_empty();
        if !turns && self.marks.journal.is_empty() {
            return (&self.still, &self.marks.shell);
        }
        room.clear();
        room.extend_from_slice(&self.still);
        let mut one = vec![0.0; self.points.len()];
        for (shape, _) in self.setup.iter().zip(&self.turning).filter(|(_, turns)| **turns) {
            shape.profile.gap_m_into(&self.points, angle_rad, &mut one);
            room.iter_mut().zip(&one).for_each(|(h, s)| *h += s);
        }
        self.grid.turned_onto(angle_rad, &self.worn.journal, room);
        let gap = room.len();
        if self.marks.journal.is_empty() {
            return (room, &self.marks.shell);
        }
        room.resize(gap + self.marks.journal.len(), 0.0);
        let (shape, marks) = room.split_at_mut(gap);
        marks.iter_mut().zip(&self.marks.shell).for_each(|(m, s)| *m = *s);
        self.grid.turned_onto(angle_rad, &self.marks.journal, marks);
        (shape, marks)
    }
}

//! The shapes of a bearing on its mesh: sampled once where they stand still, evaluated anew where they turn.

use super::{BearingParameter, BearingSetup};
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
        let mut still = vec![0.0; points.len()];
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
        }
    }

    /// What the shapes add to the gap while the journal stands at an angle.
    pub fn at<'a>(&'a self, angle_rad: f64, room: &'a mut Vec<f64>) -> &'a [f64] {
        if !self.turning.contains(&true) {
            return &self.still;
        }
        room.clear();
        room.extend_from_slice(&self.still);
        let mut one = vec![0.0; self.points.len()];
        for (shape, _) in self.setup.iter().zip(&self.turning).filter(|(_, turns)| **turns) {
            shape.profile.gap_m_into(&self.points, angle_rad, &mut one);
            room.iter_mut().zip(&one).for_each(|(h, s)| *h += s);
        }
        room
    }
}

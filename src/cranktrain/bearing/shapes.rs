//! The shapes of a bearing on its mesh: sampled once where they stand still, evaluated anew where they turn.

use super::{BearingParameter, BearingSetup};
use crate::film::SampledProfile;
use std::sync::Arc;

/// Shapes on the cells of a film.
#[derive(Clone)]
pub(super) struct Shapes {
    points: Arc<Vec<[f64; 2]>>,
    /// Sum of all that stands still; empty if there is no shape at all.
    still: Vec<f64>,
    /// Which coefficients are parameters: (parameter, shape, coefficient).
    varied: Vec<(usize, usize, usize)>,
    samples: Arc<Vec<SampledProfile>>,
    turning: Vec<bool>,
    setup: Arc<Vec<super::BearingShape>>,
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

    /// Change of the gap for a change of the parameters; empty if no shape is varied.
    pub fn change(&self, angle_rad: f64, dp: &[f64]) -> Vec<f64> {
        if self.varied.iter().all(|&(j, ..)| dp.get(j).copied().unwrap_or(0.0) == 0.0) {
            return Vec::new();
        }
        let mut dh = vec![0.0; self.points.len()];
        for (shape, (sample, turns)) in self.samples.iter().zip(&self.turning).enumerate() {
            let mine = self.varied.iter().filter(|(_, s, _)| *s == shape);
            if *turns {
                let profile = &self.setup[shape].profile;
                let mut change = vec![0.0; profile.coefficient_count()];
                mine.for_each(|&(j, _, k)| change[k] = dp[j]);
                profile.push_forward(&self.points, angle_rad, &change, &mut dh, None);
            } else {
                for &(j, _, k) in mine {
                    sample.slopes[k].iter().for_each(|&(point, slope)| dh[point] += slope * dp[j]);
                }
            }
        }
        dh
    }

    /// Adds to `p_bar` what derivatives by the gap mean for the coefficients that are parameters.
    pub fn pull_back(&self, angle_rad: f64, gap_bar: &[f64], p_bar: &mut [f64]) {
        if self.varied.is_empty() || gap_bar.is_empty() {
            return;
        }
        for (shape, (sample, turns)) in self.samples.iter().zip(&self.turning).enumerate() {
            let mine = self.varied.iter().filter(|(_, s, _)| *s == shape);
            if *turns {
                let profile = &self.setup[shape].profile;
                let mut bar = vec![0.0; profile.coefficient_count()];
                profile.pull_back(&self.points, angle_rad, gap_bar, None, &mut bar);
                mine.for_each(|&(j, _, k)| p_bar[j] += bar[k]);
            } else {
                for &(j, _, k) in mine {
                    p_bar[j] += sample.slopes[k].iter().map(|&(point, s)| s * gap_bar[point]).sum::<f64>();
                }
            }
        }
    }
}

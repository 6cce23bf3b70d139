//! Numbers from a running-in, with what each part of the march is worth to them.

use super::March;
use crate::cranktrain::{JournalBearing, SurfaceField};
use crate::film::Mesh;
use crate::math::PowerMean;
use std::f64::consts::PI;

/// What can be asked of a running-in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RunningInQuantity {
    /// Energy lost to friction over the programme, J.
    EnergyLost,
    /// The same over its length, W: the friction loss that takes wear into account, `P_wear`.
    MeanLoss,
    /// Mean friction loss of the cycle of the last stage with the surfaces in the end, W.
    FinalLoss,
    /// Volume worn off both surfaces, m3.
    WearVolume,
    /// Smooth maximum (of the given sharpness) of the depth worn off the shell, m.
    MaxDepth(f64),
    /// Time constant with which the loss falls from its first to its last value, `(E - P_N T) / (P_0 - P_N)`, s.
    TimeToRunIn,
}

/// Derivatives of a quantity by what a march ends with.
#[derive(Debug, Clone, Default)]
pub struct Worth {
    /// By the energy lost.
    pub energy: f64,
    /// By the first loss.
    pub first_loss: f64,
    /// By the last loss.
    pub last_loss: f64,
    /// By the length of the programme.
    pub duration: f64,
    /// By the surfaces in the end.
    pub worn: SurfaceField,
    /// By the area of a cell.
    pub area: f64,
}

/// Area that a cell stands for, all copies of it together, m2.
pub(super) fn cell_area_m2(model: &JournalBearing) -> f64 {
    let (s, mesh) = (model.setup(), model.film().mesh());
    PI * s.diameter_m * s.width_m / mesh.map_or(1, Mesh::cells) as f64
}

impl RunningInQuantity {
    /// Its value.
    pub fn value(self, march: &March, model: &JournalBearing) -> f64 {
        let (first, last) = march.losses();
        match self {
            Self::EnergyLost => march.energy_j,
            Self::MeanLoss => march.energy_j / march.duration_s,
            Self::FinalLoss => last,
            Self::WearVolume => march.depth_sum_m() * cell_area_m2(model),
            Self::MaxDepth(sharpness) => {
                PowerMean::maximum(sharpness).of(march.worn_m.shell.iter().copied()).value()
            }
            Self::TimeToRunIn if first == last => 0.0,
            Self::TimeToRunIn => (march.energy_j - last * march.duration_s) / (first - last),
        }
    }

    /// Its derivatives by what the march ends with.
    pub fn worth(self, march: &March, model: &JournalBearing) -> Worth {
        let (first, last) = march.losses();
        let zero = || SurfaceField {
            shell: vec![0.0; march.worn_m.shell.len()],
            journal: vec![0.0; march.worn_m.journal.len()],
        };
        let t = march.duration_s;
        let mut worth = Worth { worn: zero(), ..Worth::default() };
        match self {
            Self::EnergyLost => worth.energy = 1.0,
            Self::MeanLoss => {
                worth.energy = 1.0 / t;
                worth.duration = -march.energy_j / (t * t);
            }
            Self::FinalLoss => worth.last_loss = 1.0,
            Self::WearVolume => {
                worth.worn.shell.fill(cell_area_m2(model));
                worth.worn.journal.fill(cell_area_m2(model));
                worth.area = march.depth_sum_m();
            }
            Self::MaxDepth(sharpness) => {
                let mean = PowerMean::maximum(sharpness).of(march.worn_m.shell.iter().copied());
                let slopes = march.worn_m.shell.iter().map(|w| mean.derivative(*w));
                worth.worn.shell = slopes.collect();
            }
            Self::TimeToRunIn if first == last => {}
            Self::TimeToRunIn => {
                let (fall, value) = (first - last, self.value(march, model));
                worth.energy = 1.0 / fall;
                worth.last_loss = (value - t) / fall;
                worth.first_loss = -value / fall;
                worth.duration = -last / fall;
            }
        }
        worth
    }
}

impl March {
    /// First and last mean friction loss, W.
    pub fn losses(&self) -> (f64, f64) {
        let last = self.last.loss_w();
        (self.blocks.first().map_or(last, |b| b.rates[0].loss_w()), last)
    }

    /// Sum of the depths of all cells of both surfaces, m.
    pub(super) fn depth_sum_m(&self) -> f64 {
        self.worn_m.shell.iter().chain(&self.worn_m.journal).sum()
    }
}

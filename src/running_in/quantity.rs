//! Numbers from a running-in, with what each part of the march is worth to them.

use super::field::zeros;
use super::march::{Course, March};
use super::stage::Stage;
use crate::cranktrain::{BearingOutput, BearingParameter, JournalBearing, SurfaceField};
use crate::film::Mesh;
use crate::math::PowerMean;
use crate::orbit::{Quantity, Reduction};
use std::f64::consts::PI;

/// A fall of the loss by less than this share of it is none.
const LEAST_FALL: f64 = 1e-6;

/// What can be asked of a running-in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RunningInQuantity {
    /// Energy lost to friction over the programme, J.
    EnergyLost,
    /// The same over its length, W: the friction loss that takes wear into account, `P_wear`.
    MeanLoss,
    /// A quantity of the cycle of the last stage with the surfaces in the end; see [`RunningInQuantity::final_loss`].
    Final(Quantity),
    /// Volume worn off both surfaces, m3.
    WearVolume,
    /// Smooth maximum (of the given sharpness) of the depth worn off shell and journal, m.
    MaxDepth(f64),
    /// Time constant with which the loss falls in the last stage, from its value `P_0` at the beginning of it to `P_N` in the end:
    /// `(E - P_N T) / (P_0 - P_N)` with the stage's own energy and length, s; 0 where the loss does not fall.
    TimeToRunIn,
}

/// Derivatives of a quantity by what a march ends with.
#[derive(Debug, Clone, Default)]
pub struct Worth {
    /// By the energy lost.
    pub energy: f64,
    /// By the part of it that the last stage loses.
    pub last_energy: f64,
    /// By the loss at the beginning of the last stage.
    pub first_loss: f64,
    /// By a quantity of the last cycle.
    pub last: Option<(Quantity, f64)>,
    /// By the length of the programme.
    pub duration: f64,
    /// By the length of the last stage.
    pub last_duration: f64,
    /// By the surfaces in the end.
    pub worn: SurfaceField,
    /// By the area of a cell.
    pub area: f64,
}

/// What a block of a march is worth to a quantity.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockWorth {
    /// By its energy.
    pub energy: f64,
    /// By its length, the energy aside.
    pub duration: f64,
    /// By the loss at its beginning, the energy aside.
    pub first_loss: f64,
}

impl Worth {
    /// The worth of block `k` of a march through a number of stages.
    pub(super) fn of_block(&self, march: &March, k: usize, stages: usize) -> BlockWorth {
        let stage = march.blocks[k].stage;
        let begins = k == 0 || march.blocks[k - 1].stage != stage;
        match stage + 1 == stages {
            false => BlockWorth { energy: self.energy, duration: self.duration, first_loss: 0.0 },
            true => BlockWorth {
                energy: self.energy + self.last_energy,
                duration: self.duration + self.last_duration,
                first_loss: if begins { self.first_loss } else { 0.0 },
            },
        }
    }
}

/// Volume worn off both surfaces of a bearing, m3.
pub fn worn_volume_m3(worn_m: &SurfaceField, model: &JournalBearing) -> f64 {
    depth_sum_m(worn_m) * cell_area_m2(model)
}

/// Depths of all cells of both surfaces, m.
fn depths(worn_m: &SurfaceField) -> impl Iterator<Item = f64> + Clone {
    worn_m.shell.iter().chain(&worn_m.journal).copied()
}

/// Sum of the depths of all cells of both surfaces, m.
fn depth_sum_m(worn_m: &SurfaceField) -> f64 {
    depths(worn_m).sum()
}

/// Area that a cell stands for, all copies of it together, m2.
pub(super) fn cell_area_m2(model: &JournalBearing) -> f64 {
    let (s, mesh) = (model.setup(), model.film().mesh());
    PI * s.diameter_m * s.width_m / mesh.map_or(1, Mesh::cells) as f64
}

/// Derivatives of the area of a cell by the variables of a programme with this last stage.
pub(super) fn area_slope(last: &Stage, variables: usize) -> Vec<f64> {
    let (setup, area, mut slope) = (last.model.setup(), cell_area_m2(&last.model), vec![0.0; variables]);
    for (p, v) in setup.parameters.iter().zip(&last.variables) {
        slope[*v] += match p {
            BearingParameter::Width => area / setup.width_m,
            BearingParameter::Diameter => area / setup.diameter_m,
            _ => 0.0,
        };
    }
    slope
}

/// Whether a loss falls by more than settling leaves of it.
pub fn falls(first_w: f64, last_w: f64) -> bool {
    first_w - last_w > LEAST_FALL * first_w
}

/// The mean of an output over a cycle.
pub(super) fn mean_of(output: BearingOutput) -> Quantity {
    Quantity { output: output.index(), reduction: Reduction::Mean }
}

impl RunningInQuantity {
    /// Mean friction loss in the end, W.
    pub fn final_loss() -> Self {
        Self::Final(mean_of(BearingOutput::Loss))
    }

    /// Its value.
    pub fn value(self, course: &Course, model: &JournalBearing) -> f64 {
        let (first, last) = course.losses();
        match self {
            Self::EnergyLost => course.energy_j,
            Self::MeanLoss => course.energy_j / course.duration_s,
            Self::Final(of) => course.last.orbit.value(&of),
            Self::WearVolume => worn_volume_m3(&course.worn_m, model),
            Self::MaxDepth(sharpness) => PowerMean::maximum(sharpness).of(depths(&course.worn_m)).value(),
            Self::TimeToRunIn if !falls(first, last) => 0.0,
            Self::TimeToRunIn => {
                let (energy_j, duration_s) = (course.last_energy_j, course.last_duration_s);
                (energy_j - last * duration_s) / (first - last)
            }
        }
    }

    /// Its derivatives by what the march ends with.
    pub fn worth(self, course: &Course, model: &JournalBearing) -> Worth {
        let (first, last) = course.losses();
        let t = course.duration_s;
        let mut worth = Worth { worn: zeros(&course.worn_m), ..Worth::default() };
        match self {
            Self::EnergyLost => worth.energy = 1.0,
            Self::MeanLoss => {
                worth.energy = 1.0 / t;
                worth.duration = -course.energy_j / (t * t);
            }
            Self::Final(of) => worth.last = Some((of, 1.0)),
            Self::WearVolume => {
                worth.worn.shell.fill(cell_area_m2(model));
                worth.worn.journal.fill(cell_area_m2(model));
                worth.area = depth_sum_m(&course.worn_m);
            }
            Self::MaxDepth(sharpness) => {
                let mean = PowerMean::maximum(sharpness).of(depths(&course.worn_m));
                let slopes = |field: &[f64]| field.iter().map(|w| mean.derivative(*w)).collect();
                worth.worn.shell = slopes(&course.worn_m.shell);
                worth.worn.journal = slopes(&course.worn_m.journal);
            }
            Self::TimeToRunIn if !falls(first, last) => {}
            Self::TimeToRunIn => {
                let (fall, value) = (first - last, self.value(course, model));
                let duration_s = course.last_duration_s;
                worth.last_energy = 1.0 / fall;
                worth.last = Some((mean_of(BearingOutput::Loss), (value - duration_s) / fall));
                worth.first_loss = -value / fall;
                worth.last_duration = -last / fall;
            }
        }
        worth
    }
}

impl Course {
    /// Mean friction loss at the beginning of the last stage and in its end, W.
    pub fn losses(&self) -> (f64, f64) {
        (self.first_loss_w, self.last.loss_w())
    }
}

//! How fast a bearing wears with the surfaces of the moment: one settled cycle.

use super::stage::{MarchError, MarchOptions};
use crate::cranktrain::{BearingOutput, BearingSetup, JournalBearing, SurfaceField};
use crate::dae::At;
use crate::orbit::{Orbit, OrbitOptions, settle};
use crate::run::{Cancel, Cost};
use std::sync::Arc;

/// A settled cycle and what it rubs.
#[derive(Debug, Clone)]
pub struct Rate {
    /// The cycle.
    pub orbit: Orbit,
    /// Contact pressure times sliding speed of every cell, meant over the cycle, W/m2.
    pub rubbing_w_m2: SurfaceField,
}

impl Rate {
    /// Mean of an output.
    pub fn mean(&self, output: BearingOutput) -> f64 {
        self.orbit.mean(output.index())
    }

    /// Mean friction loss, W.
    pub fn loss_w(&self) -> f64 {
        self.mean(BearingOutput::Loss)
    }

    /// Share of contact in it.
    pub fn contact_share(&self) -> f64 {
        self.mean(BearingOutput::ContactLoss) / self.loss_w()
    }

    /// Memory of the states, bytes.
    pub(super) fn state_bytes(&self) -> usize {
        self.orbit.states.iter().map(|z| z.len() * size_of::<f64>()).sum()
    }

    /// The same without the states of the cycle.
    pub(super) fn without_states(&self) -> Self {
        let orbit = self.orbit.with_states(vec![Vec::new(); self.orbit.steps()]);
        Self { orbit, rubbing_w_m2: self.rubbing_w_m2.clone() }
    }

    /// The cycle with its states: settled again, from the one looked at before, if they were not kept.
    pub(super) fn complete(
        self: &Arc<Self>,
        (model, worn_m): (&JournalBearing, &SurfaceField),
        options: &MarchOptions,
        near: &mut Option<Arc<Self>>,
        cancel: &Cancel,
        cost: &mut Cost,
    ) -> Result<Arc<Self>, MarchError> {
        let found = if self.state_bytes() > 0 {
            self.clone()
        } else {
            let start = near.as_ref().map(|r| &r.orbit);
            let again = settled_with_wear(model, worn_m, &options.orbit, start, cancel)?;
            *cost += again.orbit.cost;
            Arc::new(again)
        };
        *near = Some(found.clone());
        Ok(found)
    }
}

/// The bearing with worn surfaces, and weights on its rubbing.
pub(super) fn worn(
    model: &JournalBearing,
    worn_m: &SurfaceField,
    marks: SurfaceField,
) -> Result<JournalBearing, MarchError> {
    let (worn_m, marks) = (Arc::new(worn_m.clone()), Arc::new(marks));
    let setup = BearingSetup { worn_m, marks, ..model.setup().clone() };
    JournalBearing::new(setup).map_err(|e| MarchError::Parameters(e.to_string()))
}

/// Settles the cycle of a bearing with worn surfaces, from a similar one if there is one.
pub fn settled_with_wear(
    model: &JournalBearing,
    worn_m: &SurfaceField,
    options: &OrbitOptions,
    near: Option<&Orbit>,
    cancel: &Cancel,
) -> Result<Rate, MarchError> {
    let model = worn(model, worn_m, SurfaceField::default())?;
    let orbit = settle(&model, options, near, cancel)?;
    let mut rubbing_w_m2 = model.blank_field();
    let (mut room, share) = (Vec::new(), 1.0 / orbit.steps() as f64);
    for k in 0..orbit.steps() {
        let z = orbit.state(k);
        if z.is_empty() {
            return Err(MarchError::Memory);
        }
        model.add_rubbing(At { t_s: orbit.time_s(k), z, rate: &[] }, share, &mut room, &mut rubbing_w_m2);
    }
    Ok(Rate { orbit, rubbing_w_m2 })
}

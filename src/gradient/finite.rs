//! FW, BW, CEN: differences of settled quantities with relative perturbation `eps_p`.

use super::{EngineName, GradientEngine, GradientError, GradientTable};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitOptions, Quantity, settle};
use crate::run::{Cancel, Cost};
use rayon::prelude::*;

/// Share of the perturbation that may be left unsettled.
const REST: f64 = 1e-7;
/// Smallest periodicity that rounding lets a cycle reach.
const FINEST: f64 = 1e-13;

/// Options with which what is left of the start is small against a perturbation, not only against the cycle.
pub(crate) fn tight(options: &OrbitOptions, perturbation: f64) -> OrbitOptions {
    let tolerance = (REST * perturbation).max(FINEST).min(options.periodicity_tolerance);
    OrbitOptions { periodicity_tolerance: tolerance, ..*options }
}

/// Which points a difference uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Difference {
    /// `p + h` and `p`.
    Forward,
    /// `p` and `p - h`.
    Backward,
    /// `p + h` and `p - h`.
    Central,
}

/// Finite differences with step `h = eps_p |p|` (where `p` is zero, `eps_p` times the scale the model gives it).
#[derive(Debug, Clone, Copy)]
pub struct FiniteDifference {
    /// Points used.
    pub difference: Difference,
    /// Relative perturbation.
    pub perturbation: f64,
}

/// The model with its parameters moved (`change` has one entry per parameter; cycle unknowns may be left out), and its cycle,
/// continued from the settled one.
pub(super) fn neighbour<M: SensitiveDae>(
    model: &M,
    at: &Orbit,
    options: &OrbitOptions,
    change: impl Fn(usize) -> f64,
    cancel: &Cancel,
) -> Result<(M, Orbit), GradientError> {
    let moved: Vec<f64> = at.parameters.iter().enumerate().map(|(j, p)| p + change(j)).collect();
    let model = model.with_parameters(&moved)?;
    let orbit = settle(&model, options, Some(at), cancel)?;
    Ok((model, orbit))
}

/// What a difference needs of a settled neighbour.
struct Neighbour {
    values: Vec<f64>,
    cycles: f64,
    cost: Cost,
}

impl<M: SensitiveDae> GradientEngine<M> for FiniteDifference {
    fn name(&self) -> EngineName {
        match self.difference {
            Difference::Forward => EngineName::Fw,
            Difference::Backward => EngineName::Bw,
            Difference::Central => EngineName::Cen,
        }
    }

    fn gradient(
        &self,
        model: &M,
        at: &Orbit,
        options: &OrbitOptions,
        of: &[Quantity],
        cancel: &Cancel,
    ) -> Result<GradientTable, GradientError> {
        let varied = super::varied(model, at);
        let mut table = GradientTable {
            rows: vec![vec![0.0; varied]; of.len()],
            fields: Vec::new(),
            sweeps: 0.0,
            closure: 0.0,
            cost: Cost::default(),
        };
        let options = &tight(options, self.perturbation);
        if at.periodicity > options.periodicity_tolerance && self.difference != Difference::Central {
            // One-sided differences use the point itself: it must be settled as sharply as its neighbours.
            let sharp = Orbit { periodicity: 0.0, ..settle(model, options, Some(at), cancel)? };
            let mut table = self.gradient(model, &sharp, options, of, cancel)?;
            table.cost += sharp.cost;
            return Ok(table);
        }
        let here: Vec<f64> = of.iter().map(|q| at.value(q)).collect();
        let settled = |j: usize, by: f64| -> Result<Neighbour, GradientError> {
            let only = |k: usize| if k == j { by } else { 0.0 };
            let (_, orbit) = neighbour(model, at, options, only, cancel)?;
            let values = of.iter().map(|q| orbit.value(q)).collect();
            Ok(Neighbour { values, cycles: orbit.cycles, cost: orbit.cost })
        };
        // Each neighbour starts from the same cycle, so their order and number of threads change nothing.
        let columns: Result<Vec<[Option<Neighbour>; 2]>, GradientError> = (0..varied)
            .into_par_iter()
            .map(|j| {
                let step = self.perturbation * model.parameter_scale(j);
                let above = (self.difference != Difference::Backward).then(|| settled(j, step));
                let below = (self.difference != Difference::Forward).then(|| settled(j, -step));
                Ok([above.transpose()?, below.transpose()?])
            })
            .collect();
        for (j, [above, below]) in columns?.into_iter().enumerate() {
            let step = self.perturbation * model.parameter_scale(j);
            let width = if self.difference == Difference::Central { 2.0 * step } else { step };
            let value = |side: &Option<Neighbour>, k: usize| side.as_ref().map_or(here[k], |n| n.values[k]);
            for (k, row) in table.rows.iter_mut().enumerate() {
                row[j] = (value(&above, k) - value(&below, k)) / width;
            }
            for neighbour in [above, below].into_iter().flatten() {
                table.cost += neighbour.cost;
                table.sweeps += neighbour.cycles;
            }
        }
        Ok(table)
    }
}

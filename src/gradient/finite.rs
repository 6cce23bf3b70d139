//! FW, BW, CEN: differences of settled quantities with relative perturbation `eps_p`.

use super::{EngineName, GradientEngine, GradientError, GradientTable};
use crate::dae::SensitiveDae;
use crate::orbit::{Orbit, OrbitOptions, Quantity, settle};
use crate::run::{Cancel, Cost};

/// Share of the perturbation that may be left unsettled.
const REST: f64 = 1e-7;
/// Smallest periodicity that rounding lets a cycle reach.
const FINEST: f64 = 1e-13;

/// Options with which what is left of the start is small against a perturbation, not only against the cycle.
pub(super) fn tight(options: &OrbitOptions, perturbation: f64) -> OrbitOptions {
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
        let p = &at.parameters;
        let varied = p.len() - model.cycle().map_or(0, |c| c.unknowns());
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
        for j in 0..varied {
            let step = self.perturbation * model.parameter_scale(j);
            let mut settled = |sign: f64| -> Result<Vec<f64>, GradientError> {
                let mut shifted = p.to_vec();
                shifted[j] += sign * step;
                let orbit = settle(&model.with_parameters(&shifted)?, options, Some(at), cancel)?;
                table.cost += orbit.cost;
                table.sweeps += orbit.cycles;
                Ok(of.iter().map(|q| orbit.value(q)).collect())
            };
            let (plus, minus, width) = match self.difference {
                Difference::Forward => (settled(1.0)?, here.clone(), step),
                Difference::Backward => (here.clone(), settled(-1.0)?, step),
                Difference::Central => (settled(1.0)?, settled(-1.0)?, 2.0 * step),
            };
            for (row, (plus, minus)) in table.rows.iter_mut().zip(plus.iter().zip(&minus)) {
                row[j] = (plus - minus) / width;
            }
        }
        Ok(table)
    }
}

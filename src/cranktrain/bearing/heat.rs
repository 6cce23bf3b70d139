//! Heat balance of a bearing over the cycle: one effective film temperature.
//!
//! ```text
//! mean loss = rho c_p mean side flow (T_out - T_in) + UA (T_film - T_amb),     T_film = T_in + share (T_out - T_in)
//! ```
//!
//! An algebraic equation between cycle means that fixes the film temperature, the bearing's cycle unknown. The share says
//! where between inlet and outlet the film lies; 1/2 is the usual mean, 1 takes the outlet (conservative).

use super::{BearingOutput, BearingParameter, BearingSetup};
use crate::dae::CycleEquations;

/// Least drop of the loss by viscosity that a first guess assumes, as a power of the viscosity.
const LOSS_OVER_VISCOSITY: f64 = 0.7;
/// A change of the film temperature of order one, K.
const SCALE_K: f64 = 10.0;

/// Where the heat of a bearing goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatBalance {
    /// Density times specific heat capacity of the oil, J/(m3 K).
    pub volumetric_heat_j_m3_k: f64,
    /// Film temperature between inlet (0) and outlet (1) of the oil.
    pub film_share: f64,
    /// Heat that shell and journal conduct away per kelvin above the surroundings, W/K.
    pub conductance_w_k: f64,
    /// Temperature of the surroundings, K.
    pub ambient_k: f64,
}

/// The balance as an equation of a bearing's parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeatEquations {
    balance: HeatBalance,
    inlet_k: f64,
    inlet: Option<usize>,
    viscosity_log_slope: f64,
}

impl HeatEquations {
    pub fn of(balance: HeatBalance, setup: &BearingSetup, viscosity_log_slope: f64) -> Self {
        let inlet = setup.parameters.iter().position(|k| *k == BearingParameter::InletTemperature);
        Self { balance, inlet_k: setup.inlet_temperature_k, inlet, viscosity_log_slope }
    }

    fn temperatures(&self, p: &[f64]) -> (f64, f64) {
        (self.inlet.map_or(self.inlet_k, |j| p[j]), p[p.len() - 1])
    }
}

impl CycleEquations for HeatEquations {
    fn unknowns(&self) -> usize {
        1
    }

    fn outputs(&self) -> Vec<usize> {
        vec![BearingOutput::Loss.index(), BearingOutput::SideFlow.index()]
    }

    fn residual(&self, means: &[f64], p: &[f64]) -> Vec<f64> {
        let (b, (inlet, film)) = (&self.balance, self.temperatures(p));
        let carried = b.volumetric_heat_j_m3_k * means[1] * (film - inlet) / b.film_share;
        vec![means[0] - carried - b.conductance_w_k * (film - b.ambient_k)]
    }

    fn slopes(&self, means: &[f64], p: &[f64]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let (b, (inlet, film)) = (&self.balance, self.temperatures(p));
        let per_flow = b.volumetric_heat_j_m3_k / b.film_share;
        let mut by_p = vec![0.0; p.len()];
        if let Some(j) = self.inlet {
            by_p[j] = per_flow * means[1];
        }
        by_p[p.len() - 1] = -per_flow * means[1] - b.conductance_w_k;
        (vec![vec![1.0, -per_flow * (film - inlet)]], vec![by_p])
    }

    fn guess(&self, means: &[f64], p: &[f64]) -> Vec<Vec<f64>> {
        let (_, by_p) = self.slopes(means, p);
        let thinner = LOSS_OVER_VISCOSITY * self.viscosity_log_slope * means[0];
        vec![vec![by_p[0][p.len() - 1] + thinner]]
    }

    fn scale(&self) -> Vec<f64> {
        vec![SCALE_K]
    }
}

//! Checks of the heat balance of a bearing.

use super::Given;
use super::faults::{Faults, join};
use super::file::{HeatBalanceFile, StudyFile};
use super::machine::zero;
use super::plans::HeatPlan;

/// Whether any bearing has a heat balance.
pub(super) fn any_heat_balance(file: &StudyFile) -> bool {
    let all = file.bearings.value().into_iter().flat_map(|b| b.values()).filter_map(Given::value);
    all.into_iter().any(|b| !b.heat_balance.is_absent())
}

pub(super) fn heat_balance(
    given: &mut Given<HeatBalanceFile>,
    path: &str,
    faults: &mut Faults,
) -> Option<HeatPlan> {
    faults.get(given, path);
    let Given::Value(file) = given else { return None };
    faults.unknown::<HeatBalanceFile>(&file.unknown, path);
    let at = |key: &str| join(path, key);
    let share = faults.or(&mut file.film_share, &at("film_share"), 0.5);
    faults.range(Some(share), &at("film_share"), |v| v > 0.0 && v <= 1.0, "above 0 and at most 1");
    let conductance = faults.or(&mut file.conductance, &at("conductance"), zero("0 W/K")).si();
    faults.range(Some(conductance), &at("conductance"), |v| v >= 0.0, "at or above zero");
    let ambient_k = if conductance == 0.0 {
        faults.unused(
            &file.ambient_temperature,
            &at("ambient_temperature"),
            "nothing is conducted away (conductance is zero)",
        );
        0.0
    } else {
        faults.or(&mut file.ambient_temperature, &at("ambient_temperature"), zero("60 degC")).si()
    };
    let in_range = |v: f64| conductance == 0.0 || (223.15..=473.15).contains(&v);
    faults.range(Some(ambient_k), &at("ambient_temperature"), in_range, "between -50 degC and 200 degC");
    Some(HeatPlan { film_share: share, conductance_w_k: conductance, ambient_k })
}

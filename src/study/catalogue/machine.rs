//! Where loads come from: running gear and cylinder pressure.
//!
//! Deliberately not here: loads that a study tabulates, which need no law.

use super::entry::{Choice, Entry};

const LOAD: &str = "load";
const PRESSURE: &str = "cylinder pressure";

/// Big ends.
pub(in crate::study) static SLIDER_CRANK: Entry = Entry {
    topic: LOAD,
    name: "slider-crank with a rod of two masses",
    equation: "S = ((p - p_crankcase) A + m_osc s'')/cos psi, pin = -S u + m_rot r omega^2 (cos theta, sin \
               theta)",
    words: "rigid slider-crank at constant speed, two-mass connecting rod",
    chosen: Choice::Key("bearings.NAME.kind", "big-end"),
    remark: "no elastic bodies, no torsional vibration, no fluctuation of the speed",
    ..Entry::PLAIN
};

/// Main bearings.
pub(in crate::study) static MAIN_BEARINGS: Entry = Entry {
    topic: LOAD,
    name: "main bearings, statically determinate",
    equation: "each throw is a simply supported beam: half to each neighbour, by the lever rule for rods \
               side by side",
    chosen: Choice::Key("bearings.NAME.kind", "main"),
    remark: "in-line and V engines",
    ..Entry::PLAIN
};

/// Indicator diagram.
pub(in crate::study) static INDICATOR: Entry = Entry {
    topic: PRESSURE,
    name: "indicator diagram",
    equation: "periodic cubic spline through the points",
    sources: &["de Boor 1978"],
    chosen: Choice::Key("cylinder_pressure.source", "table"),
    ..Entry::PLAIN
};

/// Computed cycle.
pub(in crate::study) static WIEBE: Entry = Entry {
    topic: PRESSURE,
    name: "single-zone cycle with Wiebe heat release",
    equation: "dp/da = ((gamma - 1) dQ/da - gamma p dV/da)/V, Q ~ 1 - exp(-6.908 y^(m + 1)), \
               gamma = 1.338 - 6.0e-5 T + 1.0e-8 T^2",
    sources: &["Wiebe 1970", "Heywood 1988", "Brunt et al. 1998"],
    chosen: Choice::Key("cylinder_pressure.source", "wiebe"),
    remark: "net heat release; gas exchange only has to be plausible; gamma for 300 K to 3000 K",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[&SLIDER_CRANK, &MAIN_BEARINGS, &INDICATOR, &WIEBE];

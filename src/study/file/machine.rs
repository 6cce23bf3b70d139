//! The machine and its cylinder pressure as written.

use crate::study::Given;
use crate::study::table::TableFile;
use crate::units::{Angle, Heat, Length, Mass, Pressure, Temperature};

section! {
    /// Slider-crank, masses, and for main bearings the crankshaft.
    MachineFile {
        /// Cylinder bore.
        bore: Length,
        /// Crank radius.
        throw: Length,
        /// Length of the connecting rod; or give throw_over_rod.
        rod_length: Length,
        /// Crank radius over rod length; or give rod_length.
        throw_over_rod: f64,
        /// Distance of the cylinder axis from the crank's centre, positive towards the side the crank turns to after top dead centre. Default "0 mm".
        piston_pin_offset: Length,
        /// Piston, pin, rings and the oscillating share of the rod.
        oscillating_mass: Mass,
        /// Rotating share of the rod.
        rotating_mass: Mass,
        /// Absolute pressure below the piston. Default "1 bar".
        crankcase_pressure: Pressure,
        /// Angle between the banks, 0 for an in-line engine; bank A stands ahead of bank B in the sense of rotation (negative: behind). Default "0 deg". For main bearings.
        vee_angle: Angle,
        /// Angle of each throw ahead of the first. For main bearings.
        throw_angles: Vec<Given<Angle>>,
        /// All cylinders in the order they fire, like "A1" (bank and throw, counted from the free end). For main bearings.
        firing_order: Vec<String>,
        /// Unbalanced mass of one throw at the crank radius (pin and webs less counterweights). Default "0 kg". For main bearings.
        throw_mass: Mass,
        /// Distance of the two rods on one pin over the distance of the main bearings; bank A nearer to the free end. Default 0. For main bearings.
        rod_spacing_ratio: f64,
    }
}

words! {
    /// Where the cylinder pressure comes from.
    PressureSource {
        /// An indicator diagram, columns crank_angle_deg and pressure_mpa (or _bar, _pa), absolute pressure over one cycle from firing top dead centre.
        Table,
        /// A computed single-zone cycle with Wiebe heat release.
        Wiebe,
    }
}

section! {
    /// Pressure above the piston over the working cycle.
    CylinderPressureFile {
        /// "table" or "wiebe".
        source: PressureSource,
        /// The indicator diagram, for source = "table".
        table: TableFile,
        /// Volume at bottom over volume at top dead centre. For source = "wiebe", like all below.
        compression_ratio: f64,
        /// Absolute pressure at inlet closing.
        charge_pressure: Pressure,
        /// Temperature at inlet closing.
        charge_temperature: Temperature,
        /// Net heat released per cylinder and cycle (wall losses taken off).
        heat_release: Heat,
        /// Start of combustion after firing top dead centre (negative: before).
        combustion_start: Angle,
        /// Duration of combustion, to 99.9 % burnt.
        combustion_duration: Angle,
        /// Shape exponent of the Wiebe function. Default 1.
        combustion_shape: f64,
        /// Inlet closes, after firing top dead centre (so negative). Default "-150 deg".
        inlet_closes: Angle,
        /// Exhaust opens. Default "125 deg".
        exhaust_opens: Angle,
        /// Absolute pressure in the exhaust. Default: the charge pressure.
        exhaust_pressure: Pressure,
    }
}

//! The oil as written.

use crate::study::Given;
use crate::units::{
    Density, DynamicViscosity, HeatCapacity, KinematicViscosity, PressureViscosity, ShearRate, Temperature,
    TemperatureRise, Time,
};

words! {
    /// Viscosity over temperature, through the two viscosities of the data sheet.
    ViscosityLawName {
        /// Walther (ASTM D341).
        Walther,
        /// Vogel, with the pole usual for mineral oils.
        Vogel,
    }
}

words! {
    /// Viscosity over pressure.
    PiezoviscosityName {
        /// The same at every pressure.
        None,
        /// exp(alpha p); fair below 0.1 GPa.
        Barus,
        /// Roelands, to about 1 GPa.
        Roelands,
    }
}

words! {
    /// Density over pressure.
    CompressibilityName {
        /// The same at every pressure.
        Incompressible,
        /// Dowson and Higginson, mineral oils.
        DowsonHigginson,
    }
}

words! {
    /// Viscosity over shear rate.
    ShearThinningName {
        /// The same at every rate.
        Newtonian,
        /// Cross: second_newtonian_ratio, critical_shear_rate, shear_exponent.
        Cross,
        /// Carreau: second_newtonian_ratio, relaxation_time, shear_exponent.
        Carreau,
    }
}

section! {
    /// A measured point of the viscosity.
    ViscosityPointFile {
        /// Temperature of the point.
        temperature: Temperature,
        /// Dynamic viscosity there.
        dynamic_viscosity: DynamicViscosity,
    }
}

section! {
    /// Lubricating oil. One source of the viscosity: a grade, a data sheet, three points, or a constant.
    OilFile {
        /// Name of a known grade ("SAE 30", "SAE 40", "ISO VG 32", "ISO VG 46", "ISO VG 68", "ISO VG 100") or of one in [grades.NAME].
        grade: String,
        /// Kinematic viscosity at 40 degC, of the data sheet.
        kinematic_viscosity_40c: KinematicViscosity,
        /// Kinematic viscosity at 100 degC, of the data sheet.
        kinematic_viscosity_100c: KinematicViscosity,
        /// Density at 15 degC: part of the data sheet; with viscosity_points or dynamic_viscosity for a heat balance.
        density_15c: Density,
        /// "walther" (default) or "vogel". For a grade or a data sheet.
        viscosity_law: ViscosityLawName,
        /// Three points for Vogel's law.
        viscosity_points: Vec<Given<ViscosityPointFile>>,
        /// The same dynamic viscosity at every temperature.
        dynamic_viscosity: DynamicViscosity,
        /// Specific heat capacity at film temperature, for a heat balance. Default: that of the grade, else "2000 J/(kg K)".
        heat_capacity: HeatCapacity,
        /// "none" (default), "barus" or "roelands".
        piezoviscosity: PiezoviscosityName,
        /// Pressure-viscosity coefficient at film temperature. Default: that of the grade. For barus and roelands.
        pressure_viscosity_coefficient: PressureViscosity,
        /// "incompressible" (default) or "dowson-higginson".
        compressibility: CompressibilityName,
        /// "newtonian" (default), "cross" or "carreau".
        shear_thinning: ShearThinningName,
        /// Viscosity at very high over that at low shear rate. For cross and carreau.
        second_newtonian_ratio: f64,
        /// Shear rate at which half of the fall is done. For cross.
        critical_shear_rate: ShearRate,
        /// Inverse of the shear rate at which thinning sets in. For carreau.
        relaxation_time: Time,
        /// Exponent: m above 0 of cross, n in (0, 1] of carreau.
        shear_exponent: f64,
        /// Temperature at the inlet of the bearings.
        inlet_temperature: Temperature,
        /// Temperature of the film less that of the inlet; with a heat balance only where its search starts. Default "0 K".
        film_temperature_rise: TemperatureRise,
    }
}

section! {
    /// An oil by name.
    GradeFile {
        /// Kinematic viscosity at 40 degC.
        kinematic_viscosity_40c: KinematicViscosity,
        /// Kinematic viscosity at 100 degC.
        kinematic_viscosity_100c: KinematicViscosity,
        /// Density at 15 degC.
        density_15c: Density,
        /// Specific heat capacity at film temperature. Default "2000 J/(kg K)".
        heat_capacity: HeatCapacity,
        /// Pressure-viscosity coefficient at film temperature. Default: none; oil.pressure_viscosity_coefficient gives it where it is needed.
        pressure_viscosity_coefficient: PressureViscosity,
    }
}

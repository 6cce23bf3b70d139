//! A bearing with its supply and heat balance as written.

use super::{RoughnessFile, ShapeFile, SurfaceName};
use crate::study::Given;
use crate::study::table::TableFile;
use crate::units::{Angle, Conductance, Force, Length, Mass, Pressure, Temperature};

words! {
    /// Which bearing it is.
    BearingKind {
        /// Big end of a connecting rod; the frame turns with the rod, 0 deg points to the small end.
        BigEnd,
        /// Main bearing of the crankshaft; frame at rest, 0 deg points up along the symmetry plane of the banks.
        Main,
        /// Load from a table, frame at rest.
        Table,
        /// A constant load, frame at rest.
        Constant,
        /// No load: the journal stands where a characteristic over the eccentricity ratio puts it.
        Position,
    }
}

section! {
    /// One journal bearing.
    BearingFile {
        /// "big-end", "main", "table", "constant" or "position".
        kind: BearingKind,
        /// Width.
        width: Length,
        /// Diameter.
        diameter: Length,
        /// Difference of the diameters of shell and journal.
        diametral_clearance: Length,
        /// Mass that moves with the journal. Default "0 kg": inertia of the journal's small motion neglected.
        journal_mass: Mass,
        /// Number of such bearings in the machine; multiplies the loss in the objective. Default 1.
        count: u32,
        /// Position from the free end, 0 to the number of throws. For kind = "main".
        main_bearing: usize,
        /// Load of the journal on the shell over one cycle. For kind = "table": columns crank_angle_deg, force_x_n (or _kn), force_y_n.
        load: TableFile,
        /// Size of the load of the journal on the shell. For kind = "constant".
        force: Force,
        /// Direction of the load from 0 deg of the shell. Default "0 deg". For kind = "constant".
        force_angle: Angle,
        /// Crank angle after which the load repeats. Default "720 deg". For kind = "table".
        cycle: Angle,
        /// Slope of the journal's axis towards 0 deg of the shell. Default "0 deg".
        tilt_x: Angle,
        /// Slope of the journal's axis towards 90 deg of the shell. Default "0 deg".
        tilt_y: Angle,
        /// Whether the journal tilts as the moment of the film lets it, instead of as given. Default false.
        free_tilt: bool,
        /// Oil supply. Left out: no oil but what the edges draw in.
        supply: SupplyFile,
        /// Rough surfaces and their contact. Left out: smooth surfaces without contact.
        roughness: RoughnessFile,
        /// Heat balance over the cycle: makes the film temperature a result. Left out: oil.film_temperature_rise holds.
        heat_balance: HeatBalanceFile,
        /// Shapes of shell and journal, which add up. Left out: cylinders.
        shapes: Vec<Given<ShapeFile>>,
    }
}

section! {
    /// Oil supply of one bearing.
    SupplyFile {
        /// Supply pressure above the surroundings, at or above the cavitation pressure.
        pressure: Pressure,
        /// Where the oil comes in. Sizes are angles and shares: openings grow with a bearing whose diameter or width is varied.
        openings: Vec<Given<OpeningFile>>,
    }
}

words! {
    /// Form of an opening.
    OpeningKind {
        /// A groove along the axis about the mid-plane: angle, extent, length_share.
        AxialGroove,
        /// A groove around the bearing, all around or in part: width_share, centre, extent, start.
        CircumferentialGroove,
        /// A rectangular pocket: angle, extent, width_share, centre.
        Pocket,
        /// A round hole: angle, diameter, centre.
        Hole,
    }
}

section! {
    /// One opening of the oil supply.
    OpeningFile {
        /// "axial-groove", "circumferential-groove", "pocket" or "hole".
        kind: OpeningKind,
        /// "shell" (default) or "journal": the part it is cut into. On the journal it turns; angles are those in the shell's frame at firing top dead centre.
        on: SurfaceName,
        /// Its middle around. For axial-groove, pocket and hole.
        angle: Angle,
        /// Its extent around. For axial-groove and pocket; for circumferential-groove default "360 deg".
        extent: Angle,
        /// Where it starts; it extends from there in the sense of rotation. For a circumferential-groove that is not closed. Default "0 deg".
        start: Angle,
        /// Its middle across the width, -1 and 1 at the edges. For all but axial-groove. Default 0.
        centre: f64,
        /// Its extent across as a share of the width. For circumferential-groove and pocket.
        width_share: f64,
        /// Its length as a share of the width; 1 reaches both edges. For axial-groove.
        length_share: f64,
        /// Diameter of the hole in the bearing as given; it grows with a bearing whose diameter or width is varied. For hole.
        diameter: Length,
    }
}

section! {
    /// Heat balance of one bearing over the cycle: mean loss = heat carried away by the side flow + heat conducted away.
    HeatBalanceFile {
        /// Where the film's temperature lies between inlet (0) and outlet (1) of the oil. Default 0.5.
        film_share: f64,
        /// Heat that shell and journal conduct away per kelvin above the surroundings. Default "0 W/K".
        conductance: Conductance,
        /// Temperature of the surroundings. Default "60 degC". For a conductance above zero.
        ambient_temperature: Temperature,
    }
}

//! Films of every kind, small: what proofs about all films go through.

use stribeck::film::{
    Axial, Cavitation, CavityShear, Feed, FilmModel, Mesh, Oil, Opening, Reynolds, Roughness, ShortFilm,
};
use stribeck::laws::{
    Compressibility, ContactIntegral, GreenwoodTripp, Piezoviscosity, RoughSurfaces, ShearThinning,
};

/// A film and what it can be given.
pub struct Case {
    /// Name in messages.
    pub name: &'static str,
    /// The film.
    pub film: Box<dyn FilmModel>,
    /// Whether its surfaces have a shape.
    pub shaped: bool,
}

impl Case {
    /// Whether the journal may stand inclined: on a mesh over the whole width.
    pub fn tilted(&self) -> bool {
        self.film.mesh().is_some_and(|m| m.axial == Axial::Full)
    }
}

/// An oil that follows pressure and shear.
pub fn live_oil() -> Oil {
    Oil {
        piezoviscosity: Piezoviscosity::Roelands { coefficient_per_pa: 2e-8 },
        compressibility: Compressibility::DowsonHigginson,
        shear_thinning: ShearThinning::Carreau { second_newtonian_ratio: 0.3, time_s: 1e-5, exponent: 0.6 },
    }
}

/// Rough surfaces of different lay that touch.
pub fn touching() -> Roughness {
    let contact = GreenwoodTripp::from_summits(ContactIntegral::Exact, 1e11, 0.04, 1e-3).unwrap();
    Roughness {
        surfaces: RoughSurfaces::new(2.0, 0.7, 5e-6, 3e-6).unwrap(),
        contact: Some(GreenwoodTripp { summit_sigma_ratio: 0.8, summit_height_ratio: 1.2, ..contact }),
        boundary_friction: 0.08,
        depth_m: 2e-5,
    }
}

/// A groove along the axis that covers some cells in part, and a hole in the journal.
pub fn feeds() -> Vec<Feed> {
    let groove = Opening::AxialGroove { angle_rad: 2.6, extent_rad: 0.6, length_share: 0.6 };
    let hole = Opening::Hole { angle_rad: 0.4, centre_zeta: 0.2, radius_rad: 0.35, radius_zeta: 0.4 };
    vec![Feed { opening: groove, on_journal: false }, Feed { opening: hole, on_journal: true }]
}

/// A film of the given rupture model with a groove, on a mesh from edge to edge.
fn fed(cavitation: Cavitation) -> Reynolds {
    Reynolds {
        cavitation,
        cavity_shear: CavityShear::Fill,
        side_pressure_pa: 1e5,
        cavitation_pressure_pa: -8e4,
        feeds: feeds(),
        sharpness: 20.0,
        ..Reynolds::new(Mesh::new(24, 4, Axial::Full))
    }
}

/// One film of every kind.
pub fn all_films() -> Vec<Case> {
    let half = || Reynolds { sharpness: 20.0, ..Reynolds::new(Mesh::new(24, 3, Axial::Half)) };
    let full = || Reynolds { sharpness: 20.0, ..Reynolds::new(Mesh::new(24, 4, Axial::Full)) };
    let held = Reynolds {
        side_pressure_pa: 2e5,
        cavitation_pressure_pa: -5e4,
        held_columns: vec![(5, 3e5)],
        ..full()
    };
    let rough = |cavitation| Reynolds { rough: Some(touching()), ..fed(cavitation) };
    let case = |name, film, shaped| Case { name, film: Box::new(film), shaped };
    vec![
        case("full film", Reynolds { cavitation: Cavitation::None, ..half() }, false),
        case("Swift-Stieber, held column, side pressure", held, false),
        case("Swift-Stieber, fed, rough, shaped", rough(Cavitation::SwiftStieber), true),
        case("Guembel, shaped", Reynolds { cavitation: Cavitation::Guembel, ..full() }, true),
        case("mass conserving, fed", fed(Cavitation::MassConserving), false),
        case(
            "mass conserving, fed, live oil",
            Reynolds { oil: live_oil(), ..fed(Cavitation::MassConserving) },
            true,
        ),
        case(
            "mass conserving, fed, live oil, rough",
            Reynolds { oil: live_oil(), ..rough(Cavitation::MassConserving) },
            true,
        ),
        Case { name: "short", film: Box::new(ShortFilm::new(20.0)), shaped: false },
    ]
}

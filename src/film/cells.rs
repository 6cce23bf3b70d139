//! What oil and surfaces make of one cell: flow resistance, thicknesses, shear, contact, with their partial derivatives
//! by gap, pressure, viscosity, roughness and speed.
//!
//! ```text
//! resistance  R = 12 eta / (phi rho h^3)         around (phi_x) and across (phi_z)
//! transport   t = rho (h_T + sigma phi_s)        thickness that half the surface speed drags along
//! content     c = rho h_T                        thickness of oil in a full cell
//! shear       k = eta (phi_f + phi_fs) / h       wall stress of the journal per speed
//! stress      w = phi_fp h                       thickness on which the pressure gradient pulls
//! ```
//!
//! after Patir and Cheng (1978, 1979) and Wu and Zheng (1989); all factors are 1 (or 0) for smooth surfaces.

use super::fields::Scalars;
use super::jet::{GAP, JOURNAL, Jet, PRESSURE, SHELL, SPEED, VISCOSITY};
use super::reynolds::{Oil, Reynolds};
use crate::laws::{Partials, RoughFilm};

/// Local quantities of a cell.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cell<const N: usize> {
    /// Flow resistance around.
    pub around: Jet<N>,
    /// Flow resistance across.
    pub across: Jet<N>,
    /// Transport thickness of a full cell.
    pub transport: Jet<N>,
    /// Content thickness of a full cell.
    pub content: Jet<N>,
    /// Shear coefficient.
    pub shear: Jet<N>,
    /// Stress thickness.
    pub stress: Jet<N>,
    /// Contact pressure.
    pub contact: Jet<N>,
}

impl<const N: usize> Cell<N> {
    /// The cell at gap `h` and pressure `p` above the surroundings, written in place: a cell is large. Shear and stress are
    /// left as they are unless `walls` are wanted: balances, contents and loads rest on the others alone.
    #[inline(always)]
    pub fn set(&mut self, film: &Reynolds, s: &Scalars, h: f64, p: f64, walls: bool) {
        let density = density(&film.oil, p);
        match &film.rough {
            None => {
                let gap = Jet::variable(h, GAP);
                self.set_smooth(gap, density, viscosity(&film.oil, s, gap, p), walls);
            }
            Some(rough) => {
                let f = rough.surfaces.tabulated(h, [s.journal, s.shell], N > JOURNAL);
                let eta = viscosity(&film.oil, s, lift(&f.flow_gap), p);
                self.set_rough(&f, density, eta, walls);
                let contact = rough.contact.as_ref().map(|c| lift(&c.at(h, s.journal, s.shell)));
                self.contact = contact.unwrap_or_default();
            }
        }
    }

    #[inline(always)]
    fn set_smooth(&mut self, gap: Jet<N>, density: Jet<N>, eta: Jet<N>, walls: bool) {
        let thickness = density * gap;
        let resistance = eta.times(12.0) * (thickness * gap * gap).recip();
        self.around = resistance;
        self.across = resistance;
        self.transport = thickness;
        self.content = thickness;
        if walls {
            self.shear = eta * gap.recip();
            self.stress = gap;
        }
        self.contact = Jet::default();
    }

    #[inline(always)]
    fn set_rough(&mut self, f: &RoughFilm, density: Jet<N>, eta: Jet<N>, walls: bool) {
        let gap = lift(&f.flow_gap);
        let smooth = eta.times(12.0) * (density * gap * gap * gap).recip();
        let average = lift(&f.average_gap);
        self.around = smooth * lift(&f.pressure_around).recip();
        self.across = smooth * lift(&f.pressure_across).recip();
        self.transport = density * (average + lift(&f.shear_thickness));
        self.content = density * average;
        if walls {
            self.shear = eta * lift(&f.couette_journal_per_m);
            self.stress = lift(&f.pressure_stress) * gap;
        }
    }
}

/// Partials by gap and the two roughnesses as a jet.
fn lift<const N: usize>(x: &Partials) -> Jet<N> {
    let mut jet = Jet::constant(x.value);
    for (slot, by) in [(GAP, x.by[0]), (JOURNAL, x.by[1]), (SHELL, x.by[2])] {
        if slot < N {
            jet.d[slot] = by;
        }
    }
    jet
}

fn density<const N: usize>(oil: &Oil, p: f64) -> Jet<N> {
    let (ratio, slope) = oil.compressibility.at(p);
    Jet::chain(ratio, [(slope, &Jet::variable(p, PRESSURE))])
}

/// Viscosity at pressure and shear rate `|U| / h`.
fn viscosity<const N: usize>(oil: &Oil, s: &Scalars, gap: Jet<N>, p: f64) -> Jet<N> {
    let eta = Jet::variable(s.eta, VISCOSITY);
    let mut found = eta;
    if !matches!(oil.piezoviscosity, crate::laws::Piezoviscosity::None) {
        let f = oil.piezoviscosity.at(p, s.eta);
        let pressure = Jet::variable(p, PRESSURE);
        found = found * Jet::chain(f.factor, [(f.by_pressure, &pressure), (f.by_viscosity, &eta)]);
    }
    if !matches!(oil.shear_thinning, crate::laws::ShearThinning::Newtonian) {
        let rate = Jet::variable(s.speed, SPEED) * gap.recip();
        let (factor, slope) = oil.shear_thinning.at(rate.v);
        found = found * Jet::chain(factor, [(slope, &rate)]);
    }
    found
}

//! The fields through which the parameters of a bearing act, and the sensitivity map that falls out of them.
//!
//! ```text
//! u = (scalars of the film's input | film temperature | load factor | speed | gap added by the shell, per cell
//!      | gap added by the journal, per cell of a grid that turns with it | coefficients of shapes that turn
//!      | share of the shell's roughness that wear has left, per cell, if it smooths)
//! ```
//!
//! A derivative by the fifth and sixth part is the derivative by the local gap: where on the shell, and where on the
//! journal, a micrometre matters. The derivative by a profile's coefficient is its projection on the profile's base
//! function: exactly and without further work for shapes that stand still; shapes that turn have coefficients of their own
//! in `u`, because the journal's grid interpolates linearly between its columns. A grid that turns by `a` puts
//! `(1 - f) J_k + f J_{k+1}` on the column of the shell at `phi`, with `k + f = (phi - a) / dphi`.

use super::shapes::Shapes;
use super::{BearingParameter, JournalBearing, SurfaceField, Tilt};
use crate::film::{FilmCotangent, FilmInput, INPUTS, Mesh};

/// Derivative of a quantity by the local gap, per area: rows around (first index), columns across the width.
#[derive(Debug, Clone, PartialEq)]
pub struct GapSensitivity {
    /// By the gap where the shell stands, SI units of the quantity over m3.
    pub shell: Vec<Vec<f64>>,
    /// By the gap where the journal stands, in a frame that turns with it.
    pub journal: Vec<Vec<f64>>,
}

/// Where the film temperature stands in `u`.
pub(super) const FILM_TEMPERATURE: usize = INPUTS;
/// Where the load factor stands in `u`, and the speed of the crankshaft (what of it is not in the film's input).
pub(super) const LOAD_FACTOR: usize = INPUTS + 1;
pub(super) const SPEED: usize = INPUTS + 2;
/// Scalars in front of the gaps.
const SCALARS: usize = INPUTS + 3;

/// Where the parts of `u` stand.
#[derive(Debug, Clone, Copy)]
struct Parts {
    cells: usize,
    turning: usize,
    /// Cells whose roughness wear changes.
    smoothed: usize,
}

impl Parts {
    fn shell(self) -> std::ops::Range<usize> {
        SCALARS..SCALARS + self.cells
    }

    fn journal(self) -> std::ops::Range<usize> {
        SCALARS + self.cells..SCALARS + 2 * self.cells
    }

    fn turning(self) -> std::ops::Range<usize> {
        SCALARS + 2 * self.cells..SCALARS + 2 * self.cells + self.turning
    }

    fn smoothed(self) -> std::ops::Range<usize> {
        self.turning().end..self.turning().end + self.smoothed
    }
}

impl JournalBearing {
    fn parts(&self) -> Parts {
        Parts {
            cells: self.setup.film.mesh().map_or(0, Mesh::cells),
            turning: self.shapes.turning_count(),
            smoothed: self.shell_left.len(),
        }
    }

    pub(super) fn field_count(&self) -> usize {
        self.parts().smoothed().end
    }

    /// `u_p dp`.
    pub(super) fn fields_along(&self, dp: &[f64], du: &mut [f64]) {
        let (mut input, mut temperature, mut operation) = (FilmInput::default(), 0.0, [0.0; 2]);
        for (kind, d) in self.setup.parameters.iter().zip(dp) {
            match *kind {
                BearingParameter::Width => input.width_m += d,
                BearingParameter::Diameter => input.diameter_m += d,
                BearingParameter::DiametralClearance => input.clearance_m += d / 2.0,
                BearingParameter::InletTemperature if self.heat.is_some() => {}
                BearingParameter::InletTemperature | BearingParameter::FilmTemperature => {
                    input.viscosity_pa_s += self.viscosity_slope * d;
                    temperature += d;
                }
                BearingParameter::JournalRoughness => input.journal_roughness_m += d,
                BearingParameter::ShellRoughness => input.shell_roughness_m += d,
                BearingParameter::SupplyPressure => input.supply_pressure_pa += d,
                BearingParameter::Tilt(axis) if self.setup.tilt != Tilt::Free => input.tilt_rad[axis] += d,
                BearingParameter::LoadFactor => operation[0] += d,
                BearingParameter::Speed => operation[1] += d,
                BearingParameter::Tilt(_) | BearingParameter::Shape(..) => {}
            }
        }
        let parts = self.parts();
        du.fill(0.0);
        du[..INPUTS].copy_from_slice(&input.to_array());
        du[FILM_TEMPERATURE] = temperature;
        [du[LOAD_FACTOR], du[SPEED]] = operation;
        let (head, turning) = du.split_at_mut(parts.turning().start);
        self.shapes.along(dp, &mut head[parts.shell()], &mut turning[..parts.turning]);
    }

    /// `p += u_p^T u`.
    pub(super) fn fields_back(&self, u: &[f64], p: &mut [f64]) {
        let parts = self.parts();
        let by = FilmInput::from_array(std::array::from_fn(|k| u[k]));
        for (kind, bar) in self.setup.parameters.iter().zip(p.iter_mut()) {
            *bar += match *kind {
                BearingParameter::Width => by.width_m,
                BearingParameter::Diameter => by.diameter_m,
                BearingParameter::DiametralClearance => by.clearance_m / 2.0,
                BearingParameter::InletTemperature if self.heat.is_some() => 0.0,
                BearingParameter::InletTemperature | BearingParameter::FilmTemperature => {
                    self.viscosity_slope * by.viscosity_pa_s + u[FILM_TEMPERATURE]
                }
                BearingParameter::JournalRoughness => by.journal_roughness_m,
                BearingParameter::ShellRoughness => by.shell_roughness_m,
                BearingParameter::SupplyPressure => by.supply_pressure_pa,
                BearingParameter::Tilt(axis) if self.setup.tilt != Tilt::Free => by.tilt_rad[axis],
                BearingParameter::LoadFactor => u[LOAD_FACTOR],
                BearingParameter::Speed => u[SPEED],
                BearingParameter::Tilt(_) | BearingParameter::Shape(..) => 0.0,
            };
        }
        self.shapes.back(&u[parts.shell()], &u[parts.turning()], p);
    }

    /// What a change of the fields means for the film while the journal stands at an angle: scalars and shape (empty if
    /// it does not change).
    pub(super) fn seen_along(&self, angle_rad: f64, du: &[f64]) -> (FilmInput, Vec<f64>) {
        let (parts, moved) = (self.parts(), |v: &[f64]| v.iter().any(|d| *d != 0.0));
        let input = FilmInput::from_array(std::array::from_fn(|k| du[k]));
        if !moved(&du[SCALARS..parts.turning().end]) {
            return (input, Vec::new());
        }
        let mut shape = du[parts.shell()].to_vec();
        if moved(&du[parts.journal()]) {
            self.shapes.grid.turn(angle_rad, |shell, journal, share| {
                shape[shell] += share * du[SCALARS + parts.cells + journal]
            });
        }
        self.shapes.turned_along(angle_rad, &du[parts.turning()], &mut shape);
        (input, shape)
    }

    /// The change of the share of the shell's roughness that is left.
    pub(super) fn left_along<'a>(&self, du: &'a [f64]) -> &'a [f64] {
        &du[self.parts().smoothed()]
    }

    /// Adds derivatives by what the film sees to those by the fields.
    pub(super) fn seen_back(&self, angle_rad: f64, bar: &FilmCotangent, u: &mut [f64]) {
        let parts = self.parts();
        u.iter_mut().zip(bar.input.to_array()).for_each(|(u, b)| *u += b);
        if bar.gap_m.is_empty() {
            return;
        }
        u[parts.smoothed()].iter_mut().zip(&bar.shell_left).for_each(|(u, b)| *u += b);
        u[parts.shell()].iter_mut().zip(&bar.gap_m).for_each(|(u, b)| *u += b);
        let journal = &mut u[parts.journal()];
        self.shapes.grid.turn(angle_rad, |shell, at, share| journal[at] += share * bar.gap_m[shell]);
        self.shapes.turned_back(angle_rad, &bar.gap_m, &mut u[parts.turning()]);
    }

    /// Derivatives by the material worn off shell and journal ([`BearingSetup::worn_m`]), in derivatives by the fields: by the gap
    /// it adds, and by the roughness it leaves.
    ///
    /// [`BearingSetup::worn_m`]: super::BearingSetup::worn_m
    pub fn by_wear(&self, fields: &[f64]) -> SurfaceField {
        let (parts, mut shell) = (self.parts(), fields[self.parts().shell()].to_vec());
        for ((by, slope), left) in
            shell.iter_mut().zip(self.smoothing_slopes()).zip(&fields[parts.smoothed()])
        {
            *by += slope * left;
        }
        SurfaceField { shell, journal: fields[parts.journal()].to_vec() }
    }

    /// What more wear does to the roughness left in every cell, 1/m; empty if it does nothing.
    fn smoothing_slopes(&self) -> Vec<f64> {
        let of = |s: super::Smoothing| self.setup.worn_m.shell.iter().map(|w| s.at(*w).1).collect();
        self.setup.smoothing.map_or_else(Vec::new, of)
    }

    /// The change of the fields that more material worn off is.
    pub fn wear_along(&self, worn_m: &SurfaceField) -> Vec<f64> {
        let (parts, mut du) = (self.parts(), vec![0.0; self.field_count()]);
        du[parts.shell()].iter_mut().zip(&worn_m.shell).for_each(|(u, w)| *u += w);
        du[parts.journal()].iter_mut().zip(&worn_m.journal).for_each(|(u, w)| *u += w);
        for ((u, slope), w) in du[parts.smoothed()].iter_mut().zip(self.smoothing_slopes()).zip(&worn_m.shell)
        {
            *u += slope * w;
        }
        du
    }

    /// The sensitivity map in derivatives by the fields; none for a film without cells.
    pub fn gap_sensitivity(&self, fields: &[f64]) -> Option<GapSensitivity> {
        let mesh = self.setup.film.mesh()?;
        let (parts, s) = (self.parts(), &self.setup);
        let area = std::f64::consts::PI * s.diameter_m * s.width_m / (mesh.cells() as f64 * mesh.copies());
        let map = |part: &[f64]| mesh.map(part.iter().map(|v| v / (area * mesh.copies())));
        Some(GapSensitivity { shell: map(&fields[parts.shell()]), journal: map(&fields[parts.journal()]) })
    }
}

impl Shapes {
    /// Number of coefficients that are parameters of shapes that turn.
    fn turning_count(&self) -> usize {
        self.varied.iter().filter(|(_, shape, _)| self.turning[*shape]).count()
    }

    /// Change of the gap by shapes that stand still, and changes of the coefficients of those that turn.
    fn along(&self, dp: &[f64], gap: &mut [f64], turning: &mut [f64]) {
        let mut slots = turning.iter_mut();
        for &(j, shape, k) in &self.varied {
            let d = dp.get(j).copied().unwrap_or(0.0);
            if self.turning[shape] {
                *slots.next().expect("one slot per turning coefficient") = d;
            } else if d != 0.0 {
                self.samples[shape].slopes[k].iter().for_each(|&(point, slope)| gap[point] += slope * d);
            }
        }
    }

    /// The transpose of [`Self::along`].
    fn back(&self, gap: &[f64], turning: &[f64], p: &mut [f64]) {
        let mut slots = turning.iter();
        for &(j, shape, k) in &self.varied {
            p[j] += if self.turning[shape] {
                *slots.next().expect("one slot per turning coefficient")
            } else {
                self.samples[shape].slopes[k].iter().map(|&(point, s)| s * gap[point]).sum::<f64>()
            };
        }
    }

    /// Adds to the gap what changes of turning coefficients do at an angle.
    fn turned_along(&self, angle_rad: f64, turning: &[f64], gap: &mut [f64]) {
        self.each_turning(|shape, slots| {
            let profile = &self.setup[shape].profile;
            let mut change = vec![0.0; profile.coefficient_count()];
            slots.iter().for_each(|&(slot, k)| change[k] = turning[slot]);
            profile.push_forward(&self.points, angle_rad, &change, gap, None);
        });
    }

    /// The transpose of [`Self::turned_along`].
    fn turned_back(&self, angle_rad: f64, gap: &[f64], turning: &mut [f64]) {
        self.each_turning(|shape, slots| {
            let profile = &self.setup[shape].profile;
            let mut bar = vec![0.0; profile.coefficient_count()];
            profile.pull_back(&self.points, angle_rad, gap, None, &mut bar);
            slots.iter().for_each(|&(slot, k)| turning[slot] += bar[k]);
        });
    }

    /// Calls `visit` with every turning shape and its (slot, coefficient) pairs.
    fn each_turning(&self, mut visit: impl FnMut(usize, &[(usize, usize)])) {
        let turns = self.varied.iter().filter(|(_, shape, _)| self.turning[*shape]).enumerate();
        let listed: Vec<(usize, usize, usize)> =
            turns.map(|(slot, &(_, shape, k))| (shape, slot, k)).collect();
        for shape in 0..self.turning.len() {
            let slots: Vec<(usize, usize)> =
                listed.iter().filter(|(s, ..)| *s == shape).map(|&(_, slot, k)| (slot, k)).collect();
            if !slots.is_empty() {
                visit(shape, &slots);
            }
        }
    }
}

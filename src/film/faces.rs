//! Flow through the faces of the mesh and the face parts of the losses, with all partial derivatives.
//!
//! Between the centres of two cells lie half of each, in series. With their resistances `R` the flow through the face is
//!
//! ```text
//! J = G (p_a - p_b) + U/2 dz fill_up T,     G = 2 / (R_a + R_b) * length/distance,     T = (t_a R_a + t_b R_b) / (R_a + R_b)
//! ```
//!
//! The mean `T` weighted with the resistances is what continuity of flow demands when the pressure at the face is
//! eliminated: steps of the gap that lie on faces (pockets, grooves) are met exactly, smooth gaps with second order. Void
//! is carried from upstream only (`fill_up`): first order, and oil content never falls below zero. The stress thickness
//! is averaged like `T`, so that wall power equals dissipation, squeeze and boundary power to rounding.

use super::cells::Cell;
use super::fields::Scalars;
use super::jet::Jet;

/// One face between two cells, or between a cell and an edge (`b` is `None`).
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub a: usize,
    pub b: Option<usize>,
    /// Face across the circumference (oil is dragged through it) or across the width.
    pub around: bool,
}

/// What stands on the two sides of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides<'c, const N: usize> {
    pub a: &'c Cell<N>,
    pub b: Option<&'c Cell<N>>,
    /// `p_a - p_b`.
    pub drop: f64,
    /// Fill of the cell upstream.
    pub fill: f64,
}

/// A face quantity with its partial derivatives; pairs are by cell `a` and `b`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Partial {
    pub value: f64,
    pub by_drop: f64,
    pub by_resistance: [f64; 2],
    /// By transport thickness (flow) or stress thickness (shear power).
    pub by_thickness: [f64; 2],
    pub by_fill: f64,
    pub by_speed: f64,
    pub by_dx: f64,
    pub by_dz: f64,
}

impl<const N: usize> Sides<'_, N> {
    #[inline(always)]
    fn resistances(&self, around: bool) -> [f64; 2] {
        let of = |c: &Cell<N>| if around { c.around.v } else { c.across.v };
        [of(self.a), self.b.map_or(0.0, of)]
    }

    /// Pressure flow `G drop` alone.
    #[inline(always)]
    fn pressure_flow(&self, around: bool, s: &Scalars) -> Partial {
        let [ra, rb] = self.resistances(around);
        let (per_sum, aspect) = (1.0 / (ra + rb), if around { s.dz / s.dx } else { s.dx / s.dz });
        let g = 2.0 * per_sum * aspect;
        let value = g * self.drop;
        let sign = if around { 1.0 } else { -1.0 };
        Partial {
            value,
            by_drop: g,
            by_resistance: [-value * per_sum; 2],
            by_dz: sign * value / s.dz,
            by_dx: -sign * value / s.dx,
            ..Partial::default()
        }
    }

    /// Mean of a thickness, weighted with the resistances, and its derivatives by thickness and resistance.
    #[inline(always)]
    fn mean(&self, thickness: impl Fn(&Cell<N>) -> Jet<N>) -> (f64, [f64; 2], [f64; 2]) {
        let [ra, rb] = self.resistances(true);
        let (ta, tb) = (thickness(self.a).v, self.b.map_or(0.0, |b| thickness(b).v));
        let per_sum = 1.0 / (ra + rb);
        let mean = (ta * ra + tb * rb) * per_sum;
        (mean, [ra * per_sum, rb * per_sum], [(ta - mean) * per_sum, (tb - mean) * per_sum])
    }

    /// Flow from `a` to `b`.
    #[inline(always)]
    pub fn flow(&self, around: bool, s: &Scalars) -> Partial {
        let mut j = self.pressure_flow(around, s);
        if around {
            let (t, by_t, by_r) = self.mean(|c| c.transport);
            let drag = s.speed / 2.0 * s.dz * self.fill;
            j.value += drag * t;
            j.by_thickness = by_t.map(|w| drag * w);
            j.by_resistance = [0, 1].map(|k| j.by_resistance[k] + drag * by_r[k]);
            j.by_fill = s.speed / 2.0 * s.dz * t;
            j.by_speed = s.dz * self.fill * t / 2.0;
            j.by_dz += s.speed / 2.0 * self.fill * t;
        }
        j
    }

    /// Power of the pressure gradient on the journal's surface, `-U/2 W dz drop`.
    #[inline(always)]
    pub fn shear_power(&self, s: &Scalars) -> Partial {
        let (w, by_w, by_r) = self.mean(|c| c.stress);
        let c = -s.speed / 2.0 * s.dz * self.drop;
        Partial {
            value: c * w,
            by_drop: -s.speed / 2.0 * s.dz * w,
            by_resistance: by_r.map(|r| c * r),
            by_thickness: by_w.map(|t| c * t),
            by_fill: 0.0,
            by_speed: -s.dz * self.drop * w / 2.0,
            by_dx: 0.0,
            by_dz: -s.speed / 2.0 * self.drop * w,
        }
    }

    /// Power dissipated by the pressure flow, `G drop^2`.
    #[inline(always)]
    pub fn dissipation(&self, around: bool, s: &Scalars) -> Partial {
        let flow = self.pressure_flow(around, s);
        Partial {
            value: flow.value * self.drop,
            by_drop: 2.0 * flow.value,
            by_resistance: flow.by_resistance.map(|r| r * self.drop),
            by_dx: flow.by_dx * self.drop,
            by_dz: flow.by_dz * self.drop,
            ..Partial::default()
        }
    }
}

impl Partial {
    /// Change of the face quantity for changes of what it depends on.
    pub fn along(&self, drop: f64, r: [f64; 2], t: [f64; 2], fill: f64, s: &Scalars) -> f64 {
        self.by_drop * drop
            + self.by_resistance[0] * r[0]
            + self.by_resistance[1] * r[1]
            + self.by_thickness[0] * t[0]
            + self.by_thickness[1] * t[1]
            + self.by_fill * fill
            + self.by_speed * s.speed
            + self.by_dx * s.dx
            + self.by_dz * s.dz
    }
}

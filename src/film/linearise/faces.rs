//! Flow through all faces of one direction, with its derivatives by unknown and gap of the cells on both sides: the same
//! flow as that of [`crate::film::faces`], written for arrays.

use super::cells::Cells;
use crate::film::fields::Scalars;
use crate::math::{Lane, sweep};

/// Flow from cell `a` to cell `b` through every face of one direction, and its derivatives by the unknowns and the gaps of
/// `a` and `b`. Around, entry `k` is the face west of cell `k` and the last column the first one again; across, entry `k` is the face
/// between the cells `k - 1` and `k`, zero where there is none.
#[derive(Debug, Clone, Default)]
pub(super) struct Faces {
    pub flow: Vec<f64>,
    pub by_unknown: [Vec<f64>; 2],
    pub by_gap: [Vec<f64>; 2],
}

struct Around {
    /// Length over distance.
    aspect: f64,
    /// Oil dragged through a face per thickness, m2/s.
    drag: f64,
    /// Whether cell `a` is upstream: 1 or 0.
    from_a: f64,
}

struct Across {
    aspect: f64,
}

impl Lane<20, 5> for Around {
    #[inline(always)]
    fn at(&self, input: [f64; 20]) -> [f64; 5] {
        let [pa, sa, fa, ga, ra, ra_h, ra_q, ta, ta_h, ta_q, pb, sb, fb, gb, rb, rb_h, rb_q, tb, tb_h, tb_q] =
            input;
        let from_b = 1.0 - self.from_a;
        let per_sum = 1.0 / (ra + rb);
        let (conductance, mean) = (2.0 * self.aspect * per_sum, (ta * ra + tb * rb) * per_sum);
        let pressed = conductance * (pa - pb);
        let dragged = self.drag * (self.from_a * fa + from_b * fb);
        let by_ra = (dragged * (ta - mean) - pressed) * per_sum;
        let by_rb = (dragged * (tb - mean) - pressed) * per_sum;
        let (by_ta, by_tb) = (dragged * ra * per_sum, dragged * rb * per_sum);
        let by_fill = self.drag * mean;
        [
            pressed + dragged * mean,
            conductance * sa + by_ra * ra_q + by_ta * ta_q + by_fill * self.from_a * ga,
            by_rb * rb_q + by_tb * tb_q + by_fill * from_b * gb - conductance * sb,
            by_ra * ra_h + by_ta * ta_h,
            by_rb * rb_h + by_tb * tb_h,
        ]
    }
}

impl Lane<10, 5> for Across {
    #[inline(always)]
    fn at(&self, [pa, sa, ra, ra_h, ra_q, pb, sb, rb, rb_h, rb_q]: [f64; 10]) -> [f64; 5] {
        let per_sum = 1.0 / (ra + rb);
        let conductance = 2.0 * self.aspect * per_sum;
        let pressed = conductance * (pa - pb);
        let by_r = -pressed * per_sum;
        [pressed, conductance * sa + by_r * ra_q, by_r * rb_q - conductance * sb, by_r * ra_h, by_r * rb_h]
    }
}

impl Faces {
    fn resize(&mut self, n: usize) {
        self.flow.resize(n, 0.0);
        self.by_unknown.iter_mut().chain(&mut self.by_gap).for_each(|v| v.resize(n, 0.0));
    }

    fn arrays(&mut self) -> [&mut Vec<f64>; 5] {
        let Self { flow, by_unknown: [qa, qb], by_gap: [ha, hb] } = self;
        [flow, qa, qb, ha, hb]
    }

    /// All faces between columns.
    pub fn around(&mut self, c: &Cells, n_z: usize, s: &Scalars) {
        let n = c.len();
        self.resize(n + n_z);
        let lane = Around {
            aspect: s.dz / s.dx,
            drag: s.speed / 2.0 * s.dz,
            from_a: if s.speed >= 0.0 { 1.0 } else { 0.0 },
        };
        let side = |from: usize, to: usize| {
            let (r, t) = (&c.around, &c.transport);
            [&c.pressure, &c.pressure_slope, &c.fill, &c.fill_slope]
                .into_iter()
                .chain(r.arrays())
                .chain(t.arrays())
                .map(move |v| &v[from..to])
        };
        for (west, east, cells) in [(n - n_z, 0, n_z), (0, n_z, n - n_z)] {
            let mut all = side(west, west + cells).chain(side(east, east + cells));
            let input = std::array::from_fn(|_| all.next().unwrap_or_default());
            sweep(&lane, input, self.arrays().map(|v| &mut v[east..east + cells]));
        }
        self.arrays().into_iter().for_each(|v| v.copy_within(..n_z, n));
    }

    /// All faces between the cells of a column.
    pub fn across(&mut self, c: &Cells, n_z: usize, s: &Scalars) {
        let n = c.len();
        self.resize(n + 1);
        let r = c.across();
        let side = |from: usize, to: usize| {
            [&c.pressure, &c.pressure_slope].into_iter().chain(r.arrays()).map(move |v| &v[from..to])
        };
        let mut all = side(0, n - 1).chain(side(1, n));
        let input = std::array::from_fn(|_| all.next().unwrap_or_default());
        sweep(&Across { aspect: s.dx / s.dz }, input, self.arrays().map(|v| &mut v[1..n]));
        for v in self.arrays() {
            v.iter_mut().step_by(n_z).for_each(|v| *v = 0.0);
        }
    }
}

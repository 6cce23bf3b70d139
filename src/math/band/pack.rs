//! Factors without their zeros, to be kept: what elimination left empty takes no room, and a solve reads no more than it uses.

use super::{Aligned, CyclicBand};

/// The occupied parts of the factors, group by group: four rows each of `L`, the diagonal block, `U` and `Y`; then `Z`.
#[derive(Debug, Clone, Default)]
pub(super) struct Packed {
    values: Vec<f64>,
    /// Where the four parts of each group begin, and where `Z` does.
    starts: Vec<u32>,
}

impl Packed {
    /// `L`, the inverses on the diagonal, `U` and `Y` of a group, row after row.
    #[inline(always)]
    pub(super) fn group(&self, g: usize) -> [&[f64]; 4] {
        let at = |part: usize| self.starts[4 * g + part] as usize;
        [0, 1, 2, 3].map(|part| &self.values[at(part)..at(part + 1)])
    }

    /// `Z`, row after row.
    #[inline(always)]
    pub(super) fn z(&self) -> &[f64] {
        &self.values[self.starts.last().map_or(0, |at| *at as usize)..]
    }
}

impl CyclicBand {
    /// A band without room for factors of its own: for those of another, packed.
    pub fn keeper(blocks: usize, b: usize) -> Self {
        let empty = || Aligned::zeros(0);
        let (band, y, z) = (empty(), empty(), empty());
        let (groups, census) = (Vec::new(), Vec::new());
        Self { band, y, z, groups, census, ..Self::sized(blocks, b) }
    }

    /// Copies the factors into a keeper; solves with it are those with `self`, to the bit.
    pub fn pack_into(&self, keeper: &mut Self) {
        let mut packed = keeper.packed.take().unwrap_or_default();
        packed.values.clear();
        packed.starts.clear();
        for k in (0..self.padded).step_by(4) {
            let rows = self.group(k);
            for part in [rows.l, rows.inverse.each_ref().map(|r| r.as_slice()), rows.u, rows.y] {
                packed.starts.push(packed.values.len() as u32);
                part.iter().for_each(|row| packed.values.extend_from_slice(row));
            }
        }
        packed.starts.push(packed.values.len() as u32);
        if !self.cut {
            for row in self.z.chunks_exact(self.padded) {
                self.z_ranges()
                    .iter()
                    .for_each(|(from, to)| packed.values.extend_from_slice(&row[*from..*to]));
            }
        }
        keeper.packed = Some(packed);
        keeper.groups.clone_from(&self.groups);
        keeper.edge.clone_from(&self.edge);
        keeper.schur.copy_from_slice(&self.schur);
        (keeper.start, keeper.z_gap) = (self.start, self.z_gap);
        (keeper.first_coupled, keeper.cut) = (self.first_coupled, self.cut);
    }
}

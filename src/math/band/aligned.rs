//! Storage whose chunks of four numbers never straddle a cache line.

use std::ops::{Deref, DerefMut};

/// A slice of numbers that starts at a cache line.
#[derive(Debug)]
pub(super) struct Aligned {
    storage: Vec<f64>,
    at: usize,
    len: usize,
}

impl Aligned {
    pub(super) fn zeros(len: usize) -> Self {
        let storage = vec![0.0; len + 7];
        let at = storage.as_ptr().align_offset(64).min(7);
        Self { storage, at, len }
    }
}

impl Deref for Aligned {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.storage[self.at..self.at + self.len]
    }
}

impl DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.storage[self.at..self.at + self.len]
    }
}

/// The copy lies elsewhere, so its first cache line begins at another offset.
impl Clone for Aligned {
    fn clone(&self) -> Self {
        let mut copy = Self::zeros(self.len);
        copy.copy_from_slice(self);
        copy
    }
}

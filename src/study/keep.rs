//! What a search saves under a name, so that a run that was stopped goes on: only for the same study and the same program.

use super::check::Study;
use crate::run::Store;

/// A place in a store.
#[derive(Clone)]
pub(super) struct Keep<'r> {
    store: &'r dyn Store,
    name: String,
    study: String,
}

impl<'r> Keep<'r> {
    /// The place of a name.
    pub fn of(study: &Study, name: String, store: &'r dyn Store) -> Self {
        Self { store, name, study: format!("{} {}", env!("CARGO_PKG_VERSION"), study.hash) }
    }

    /// A place beside it.
    pub fn beside(&self, what: &str) -> Self {
        Self { name: format!("{}-{what}", self.name), ..self.clone() }
    }

    fn head(&self) -> String {
        format!("{} {}\n", self.study, self.name)
    }

    /// What was saved there.
    pub fn load(&self) -> Option<Vec<u8>> {
        let all = self.store.load(&self.name)?;
        all.strip_prefix(self.head().as_bytes()).map(<[u8]>::to_vec)
    }

    /// Replaces it.
    pub fn save(&self, what: &[u8]) {
        self.store.save(&self.name, &[self.head().as_bytes(), what].concat());
    }
}

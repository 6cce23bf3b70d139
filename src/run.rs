//! What a long computation shares with whoever started it: cancellation, progress and counted work.
//!
//! Nothing here measures time; costs are counts, so that they can be tested and compared between machines.

mod pace;

pub use pace::Pace;

use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// A flag that asks a computation to stop at its next safe place.
#[derive(Debug, Clone, Default)]
pub struct Cancel(Arc<AtomicBool>);

/// The computation was asked to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Cancel {
    /// Asks every computation that holds this flag to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Fails if a stop was asked for.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }
}

/// Sets the number of threads that all computations of this process share; to be called before the first of them. Every
/// sum is taken in one order, so results are the same bits for any number of threads.
pub fn use_threads(count: std::num::NonZeroUsize) {
    // Fails only if the threads are there already, which keeps the number of cores: harmless.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(count.get()).build_global();
}

/// News of a running computation.
#[derive(Debug, Clone, Serialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event {
    /// A new stage of the run began.
    Stage {
        /// What is done now, in words.
        name: String,
    },
    /// Of many computations some are done.
    Part {
        /// Done so far.
        done: usize,
        /// All.
        total: usize,
    },
    /// One design was simulated.
    Simulated {
        /// Designs simulated so far.
        simulations: u64,
        /// Objective in watts, if the simulation succeeded.
        objective_w: Option<f64>,
    },
    /// How safe the design is that is accepted next.
    Film {
        /// Smallest film thickness of all bearings and operating points, um.
        min_thickness_um: f64,
    },
    /// The optimiser accepted a design.
    Iteration(IterationEvent),
}

/// One accepted design of an optimisation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IterationEvent {
    /// Counter, 0 for the start.
    pub iteration: u64,
    /// Objective in watts.
    pub objective_w: f64,
    /// Largest scaled constraint violation.
    pub violation: f64,
    /// Scaled Karush-Kuhn-Tucker residual.
    pub kkt: f64,
    /// Step length in the unit box.
    pub step: f64,
    /// Designs simulated so far.
    pub simulations: u64,
}

/// Receives the events of a run; called from the thread that runs it.
pub trait Progress: Sync {
    /// Takes one piece of news.
    fn tell(&self, event: &Event);
}

/// Takes no notice.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn tell(&self, _: &Event) {}
}

/// What every long computation is given.
#[derive(Clone, Copy)]
pub struct RunContext<'a> {
    /// Ask here whether to go on.
    pub cancel: &'a Cancel,
    /// Tell the news here.
    pub progress: &'a dyn Progress,
}

/// Keeps what a long computation knows, so that another process can go on where one was stopped. What it is given is opaque to it.
pub trait Store: Sync {
    /// What was saved last under a name, if anything.
    fn load(&self, name: &str) -> Option<Vec<u8>>;
    /// Replaces what is saved under a name; a failure only costs the chance to resume.
    fn save(&self, name: &str, what: &[u8]);
    /// Like [`Store::load`], for what stays when the computation is done, so that another one need not compute it again.
    fn recall(&self, name: &str) -> Option<Vec<u8>> {
        self.load(name)
    }
    /// Like [`Store::save`], for what stays.
    fn keep(&self, name: &str, what: &[u8]) {
        self.save(name, what);
    }
}

/// Part of a store: every name gets a word before it, so that computations of one kind do not meet.
pub struct Within<'r> {
    /// The store.
    pub store: &'r dyn Store,
    /// The word.
    pub prefix: String,
}

impl Store for Within<'_> {
    fn load(&self, name: &str) -> Option<Vec<u8>> {
        self.store.load(&format!("{}{name}", self.prefix))
    }
    fn save(&self, name: &str, what: &[u8]) {
        self.store.save(&format!("{}{name}", self.prefix), what);
    }
    fn recall(&self, name: &str) -> Option<Vec<u8>> {
        self.store.recall(&format!("{}{name}", self.prefix))
    }
    fn keep(&self, name: &str, what: &[u8]) {
        self.store.keep(&format!("{}{name}", self.prefix), what);
    }
}

/// Forgets.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoStore;

impl Store for NoStore {
    fn load(&self, _: &str) -> Option<Vec<u8>> {
        None
    }
    fn save(&self, _: &str, _: &[u8]) {}
}

/// Files `<name>.checkpoint` in a folder, and `kept/<name>` for what stays. A file is written beside its place and moved there, so
/// it is whole at any time.
#[derive(Debug, Clone)]
pub struct FolderStore(pub std::path::PathBuf);

impl FolderStore {
    const ENDING: &str = "checkpoint";
    const KEPT: &str = "kept";

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.join(format!("{name}.{}", Self::ENDING))
    }

    fn kept(&self, name: &str) -> std::path::PathBuf {
        self.0.join(Self::KEPT).join(name)
    }

    /// Forgets what stays, too.
    pub fn forget(&self) {
        self.clear();
        self.forget_kept();
    }

    /// Forgets what stays unless it was kept under the same word: that of the program, whose next build may compute other numbers.
    pub fn kept_by(&self, word: &str) {
        let by = self.kept("kept-by");
        if std::fs::read(&by).is_ok_and(|found| found == word.as_bytes()) {
            return;
        }
        if self.0.join(Self::KEPT).exists() {
            self.forget_kept();
        }
        self.keep("kept-by", word.as_bytes());
    }

    fn forget_kept(&self) {
        match std::fs::remove_dir_all(self.0.join(Self::KEPT)) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                eprintln!("warning: {}: {e}", self.0.join(Self::KEPT).display());
            }
            _ => {}
        }
    }

    fn write(path: &std::path::Path, beside: &std::path::Path, what: &[u8], lost: &str) {
        let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let done =
            folder.and_then(|()| std::fs::write(beside, what)).and_then(|()| std::fs::rename(beside, path));
        if let Err(e) = done {
            eprintln!("warning: {lost}: {}: {e}", path.display());
        }
    }

    /// Removes all checkpoints: the computation is done, or is to start afresh.
    pub fn clear(&self) {
        let Ok(entries) = std::fs::read_dir(&self.0) else { return };
        for path in entries.flatten().map(|e| e.path()) {
            let old = path.extension().is_some_and(|e| e == Self::ENDING || e == "unfinished");
            if old && let Err(e) = std::fs::remove_file(&path) {
                eprintln!("warning: {}: {e}", path.display());
            }
        }
    }
}

impl Store for FolderStore {
    fn load(&self, name: &str) -> Option<Vec<u8>> {
        std::fs::read(self.path(name)).ok()
    }

    fn save(&self, name: &str, what: &[u8]) {
        let beside = self.0.join(format!("{name}.unfinished"));
        Self::write(&self.path(name), &beside, what, "this run cannot be resumed");
    }

    fn recall(&self, name: &str) -> Option<Vec<u8>> {
        std::fs::read(self.kept(name)).ok()
    }

    fn keep(&self, name: &str, what: &[u8]) {
        let beside = self.0.join(format!("{name}.unfinished"));
        Self::write(&self.kept(name), &beside, what, "this will be computed again");
    }
}

/// Work done, counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Cost {
    /// Settled working cycles computed.
    pub simulations: u64,
    /// Time steps taken, settling included.
    pub steps: u64,
    /// Newton iterations of all steps.
    pub newton_iterations: u64,
    /// Matrix factorisations.
    pub factorisations: u64,
    /// Solves with a factorised matrix, one per right-hand side.
    pub solves: u64,
}

impl Add for Cost {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            simulations: self.simulations + o.simulations,
            steps: self.steps + o.steps,
            newton_iterations: self.newton_iterations + o.newton_iterations,
            factorisations: self.factorisations + o.factorisations,
            solves: self.solves + o.solves,
        }
    }
}

impl AddAssign for Cost {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl std::iter::Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::default(), Add::add)
    }
}

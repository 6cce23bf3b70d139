//! What was computed before: a stamp beside the files of a report, with everything its numbers depend on.
//!
//! The key holds the study as it is run, what was asked of it, and the program: its version and its own file, so that another build
//! computes anew. The files must be the ones that were written.

use crate::report::{IndexEntry, ReportFile};
use crate::study::{Study, Task, sha256};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A study that is done: what is told of it, and its exit code.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Done {
    pub code: u8,
    pub told: String,
    pub entry: IndexEntry,
}

#[derive(Serialize, Deserialize)]
struct Content {
    key: String,
    done: Done,
    /// SHA-256 of every file by its name.
    files: BTreeMap<String, String>,
}

/// The stamp of a folder.
pub(super) struct Stamp {
    path: PathBuf,
    folder: PathBuf,
    key: String,
}

impl Stamp {
    /// For a study and what is asked of it.
    pub fn new(folder: &Path, study: &Study, task: Task) -> Self {
        let text = format!("{} {task:?} {} {} {}", program(), study.coarse, study.hash, study.to_json());
        Self { path: folder.join("run.stamp"), folder: folder.to_owned(), key: sha256(&text) }
    }

    /// What was computed, if it is all there and nothing it depends on has changed.
    pub fn done(&self) -> Option<Done> {
        let content: Content = serde_json::from_slice(&std::fs::read(&self.path).ok()?).ok()?;
        let whole = |(name, hash): (&String, &String)| {
            std::fs::read_to_string(self.folder.join(name)).is_ok_and(|text| sha256(&text) == *hash)
        };
        (content.key == self.key && content.files.iter().all(whole)).then_some(content.done)
    }

    /// Removes files of an earlier report that a new one has not.
    pub fn sweep(&self, files: &[ReportFile]) {
        let old =
            std::fs::read(&self.path).ok().and_then(|text| serde_json::from_slice::<Content>(&text).ok());
        for name in old.iter().flat_map(|c| c.files.keys()).filter(|n| files.iter().all(|f| f.name != **n)) {
            // Only a name: the stamp says what this program wrote, and no more is removed.
            if Path::new(name).file_name().is_some_and(|plain| plain == name.as_str()) {
                let _ = std::fs::remove_file(self.folder.join(name));
            }
        }
    }

    /// Notes that the study is done; a failure only costs the time to compute it again.
    pub fn set(&self, done: &Done, files: &[ReportFile]) {
        let files = files.iter().map(|f| (f.name.clone(), sha256(&f.text))).collect();
        let content = Content { key: self.key.clone(), done: done.clone(), files };
        let written = serde_json::to_vec(&content).map_err(std::io::Error::other);
        if let Err(e) = written.and_then(|text| std::fs::write(&self.path, text)) {
            eprintln!("warning: this will be computed again: {}: {e}", self.path.display());
        }
    }
}

/// This program: version, and size and time of its file.
pub(super) fn program() -> String {
    let file = std::env::current_exe().and_then(std::fs::metadata);
    let build = file.and_then(|m| Ok((m.len(), m.modified()?)));
    let build = build.map_or_else(|_| String::new(), |(size, time)| format!("{size} {time:?}"));
    format!("{} {build}", env!("CARGO_PKG_VERSION"))
}

//! One line of the table of laws and methods.
//!
//! Deliberately not here: the lines themselves, and which of them a study uses.

/// A law or method: what it says, who says so, how a study chooses it.
#[derive(Debug, Clone, Copy)]
pub(in crate::study) struct Entry {
    /// What it is about.
    pub topic: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its formula in plain text; empty for what has none.
    pub equation: &'static str,
    /// What a report says of it; empty where it says nothing.
    pub words: &'static str,
    /// Keys of [`super::sources::REFERENCES`].
    pub sources: &'static [&'static str],
    /// How a study asks for it.
    pub chosen: Choice,
    /// Whether it holds if the study says nothing.
    pub default: bool,
    /// Where it is valid, what to mind.
    pub remark: &'static str,
}

impl Entry {
    /// What most entries have in common.
    pub const PLAIN: Self = Self {
        topic: "",
        name: "",
        equation: "",
        words: "",
        sources: &[],
        chosen: Choice::Always,
        default: false,
        remark: "",
    };
}

/// How a study asks for a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::study) enum Choice {
    /// Not at all: it holds in every study.
    Always,
    /// By a word: key and value.
    Key(&'static str, &'static str),
    /// By giving a key or a section.
    Given(&'static str),
}

impl Choice {
    /// As one writes it in a study.
    pub fn text(self) -> String {
        match self {
            Self::Always => "always".to_owned(),
            Self::Key(key, value) => format!("{key} = \"{value}\""),
            Self::Given(what) => what.to_owned(),
        }
    }
}

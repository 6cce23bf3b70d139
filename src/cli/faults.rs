//! Mistakes of a study shown at their place in the file.

use crate::study::StudyErrors;
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource,
    SourceCode,
};
use std::fmt;
use std::path::Path;

/// Width at which messages are wrapped.
const WIDTH: usize = 110;

#[derive(Debug)]
struct Parent {
    title: String,
    source: NamedSource<String>,
    children: Vec<MietteDiagnostic>,
}

impl fmt::Display for Parent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.title)
    }
}

impl std::error::Error for Parent {}

impl Diagnostic for Parent {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        Some(Box::new(self.children.iter().map(|c| c as &dyn Diagnostic)))
    }
}

/// All mistakes as text, each with the lines around it.
pub(super) fn render(path: &Path, errors: &StudyErrors, colour: bool) -> String {
    let child = |fault: &crate::study::Fault| {
        let words = match fault.path.as_str() {
            "" => fault.message.clone(),
            path => format!("{path}: {}", fault.message),
        };
        let diagnostic = MietteDiagnostic::new(words);
        match &fault.span {
            Some(span) if span.end <= errors.text.len() => {
                diagnostic.with_label(LabeledSpan::underline(span.clone()))
            }
            _ => diagnostic,
        }
    };
    let parent = Parent {
        title: format!("{}: {errors}", path.display()),
        source: NamedSource::new(path.display().to_string(), errors.text.clone()),
        children: errors.faults.iter().map(child).collect(),
    };
    let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let mut out = String::new();
    let handler =
        GraphicalReportHandler::new_themed(theme).with_width(WIDTH).with_links(false).with_context_lines(0);
    match handler.render_report(&mut out, &parent) {
        Ok(()) => out,
        Err(_) => format!("{}\n", parent.title),
    }
}

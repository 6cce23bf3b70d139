//! A study that starts from the design of an earlier report.

use super::check::Study;
use crate::report::Report;

impl Study {
    /// The study with the values of an earlier design as starts, moved into its boxes; returns how many parameters were found. The
    /// reports may be of other studies: what counts are the names.
    ///
    /// # Errors
    /// If the report has no parameter of this study, or one in another unit.
    pub fn started_from(mut self, report: &Report) -> Result<(Self, usize), String> {
        let found = self.start_at(report)?;
        // Figures are those of the study's own starts.
        self.expected.clear();
        let choices = self.choices.iter_mut().flat_map(|c| c.variants.iter_mut().map(|(_, study)| study));
        let runs = self.experiments.iter_mut().flat_map(|e| e.runs.iter_mut().map(|run| &mut run.study));
        for variant in choices.chain(runs) {
            variant.start_at(report)?;
        }
        Ok((self, found))
    }

    fn start_at(&mut self, report: &Report) -> Result<usize, String> {
        let mut found = 0;
        let design = &report.design;
        self.started_from = Some(report.study_hash.clone());
        for p in &mut self.parameters {
            let Some(value) = design.iter().find(|d| d.name == p.name) else { continue };
            if value.unit != p.variable.unit {
                let (theirs, ours) = (&value.unit, p.variable.unit);
                return Err(format!("{} is measured in {theirs} there and in {ours} here", p.name));
            }
            p.start = (value.value * p.variable.scale.0 + p.variable.scale.1).clamp(p.lower, p.upper);
            found += 1;
        }
        if found == 0 {
            let names: Vec<&str> = self.parameters.iter().map(|p| p.name.as_str()).collect();
            return Err(format!("its design has none of the parameters of this study: {}", names.join(", ")));
        }
        // Other starts are another search: what was saved of the first must not be taken for its own.
        let starts: String = self.parameters.iter().map(|p| format!("{:x} ", p.start.to_bits())).collect();
        self.hash = super::hash::sha256(&format!("{} {starts}", self.hash));
        Ok(found)
    }
}

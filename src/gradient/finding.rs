//! What differences, TRA, ADJ and the Taylor test say together about the gradient of one quantity.
//!
//! | finding | sign |
//! |---|---|
//! | wrong | TRA and ADJ differ; or FW and BW agree with each other, from one perturbation to the next, but not with ADJ |
//! | exact | TRA = ADJ, CEN comes down to ADJ, the Taylor remainders fall with order two both ways |
//! | kink | TRA = ADJ, but FW and BW keep apart over a decade of perturbations, CEN keeps away, or the Taylor slopes differ |
//! | noisy | TRA = ADJ, and none of these: what is left of settling and rounding hides the rest |
//!
//! Deliberately not here: how the numbers are computed (see [`super::check_gradient`]).

use super::sweep::miss;
use super::taylor::{Walk, falls};
use serde::{Deserialize, Serialize};

/// Difference of TRA and ADJ up to which they are the same.
pub const ENGINES_AGREE: f64 = 1e-7;
/// Error of CEN up to which it confirms a gradient.
pub const CEN_AGREES: f64 = 1e-5;
/// Share of an error within which two differences count as agreeing.
const ALIKE: f64 = 0.2;
/// Ratio within which an error stays what it is.
const STAYS: f64 = 3.0;
/// Ratio of perturbations over which an error has to stay.
const DECADE: f64 = 9.9;
/// Times an error that stays has to stand above what rounding makes at that perturbation.
const ABOVE_NOISE: f64 = 10.0;
/// One-sided slopes nearer to that of ADJ than this, while CEN confirms it at a smaller perturbation, cross a kink on their way.
const SMALL_KINK: f64 = 1e-4;
/// Room for scatter in that comparison.
const HALF: f64 = 0.5;

/// What a check says about a gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// Confirmed from all sides.
    Exact,
    /// The quantity has a kink here: the gradient is that of one side.
    Kink,
    /// Rounding and settling hide what the differences would say.
    Noisy,
    /// The gradient is not that of the quantity.
    Wrong,
}

/// A finding with its reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// What was found.
    pub finding: Finding,
    /// The reason, one sentence.
    pub words: String,
    /// Parameter that shows it most.
    pub parameter: Option<usize>,
}

/// One quantity at one perturbation, in elasticities relative to the largest of the row.
pub(super) struct Seen {
    pub perturbation: f64,
    /// Forward, backward difference and their mean less ADJ, per parameter.
    pub off: [Vec<f64>; 3],
}

impl Seen {
    fn worst(values: impl Iterator<Item = f64>) -> (f64, usize) {
        values.enumerate().fold((0.0, 0), |w, (j, v)| if v.abs() > w.0 { (v.abs(), j) } else { w })
    }

    /// Largest error of CEN and its parameter.
    fn central(&self) -> (f64, usize) {
        Self::worst(self.off[2].iter().copied())
    }

    fn gap(&self, j: usize) -> f64 {
        self.off[0][j] - self.off[1][j]
    }
}

/// Everything known about the gradient of one quantity.
pub(super) struct Evidence<'a> {
    pub tra: &'a [f64],
    pub adj: &'a [f64],
    pub scales: &'a [f64],
    /// What elasticities are relative to.
    pub size: f64,
    /// From the largest perturbation to the smallest.
    pub seen: Vec<Seen>,
    /// Ahead and behind.
    pub walks: &'a [Walk; 2],
    pub names: &'a [String],
}

impl Evidence<'_> {
    fn name(&self, j: usize) -> String {
        self.names.get(j).cloned().unwrap_or_else(|| format!("parameter {}", j + 1))
    }

    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        let (mismatch, j) = miss(self.tra, self.adj, self.scales, self.size);
        if mismatch.is_nan() || mismatch > ENGINES_AGREE {
            let words = format!("wrong: TRA and ADJ differ by {mismatch:.0e}, most by {}", self.name(j));
            return verdict(Finding::Wrong, words, Some(j));
        }
        let agree = format!("TRA = ADJ to {mismatch:.0e}");
        let found = self.exact(&agree).or_else(|| self.wrong()).or_else(|| self.apart(&agree));
        let found = found.or_else(|| self.away(&agree)).or_else(|| self.slopes(&agree));
        found.unwrap_or_else(|| self.noisy(&agree))
    }

    /// The perturbation at which CEN comes closest.
    fn best(&self) -> Option<(f64, f64, usize)> {
        let each = self.seen.iter().map(|s| (s.perturbation, s.central()));
        let best = each.min_by(|a, b| a.1.0.total_cmp(&b.1.0));
        best.map(|(eps, (error, j))| (error, eps, j))
    }

    fn exact(&self, agree: &str) -> Option<Verdict> {
        let close = |w: &Walk| w.table.last().is_none_or(|r| r.remainder <= CEN_AGREES * r.change);
        let fall = self.walks.iter().all(|w| falls(&w.table));
        if !self.walks.iter().all(|w| falls(&w.table) || close(w)) {
            return None;
        }
        let central = match self.best() {
            Some((error, eps, _)) if error <= CEN_AGREES => {
                format!("CEN meets them to {error:.0e} at {eps:.0e}, ")
            }
            Some(_) => return None,
            None => String::new(),
        };
        let taylor = match fall {
            true => "Taylor remainders fall both ways".to_owned(),
            false => format!(
                "Taylor remainders end below {CEN_AGREES:.0e} of the change, on steps that cross kinks"
            ),
        };
        let words = format!("exact: {agree}, {central}{taylor}");
        Some(verdict(Finding::Exact, words, None))
    }

    /// Differences that agree with each other, at two perturbations in turn, but not with ADJ.
    fn wrong(&self) -> Option<Verdict> {
        let alike = |s: &Seen| {
            let (error, j) = s.central();
            error > CEN_AGREES && s.gap(j).abs() <= ALIKE * error
        };
        let same = |pair: &&[Seen]| {
            let (error, j) = pair[0].central();
            alike(&pair[0])
                && alike(&pair[1])
                && (pair[1].off[2][j] - pair[0].off[2][j]).abs() <= ALIKE * error
        };
        // Truncation may look alike at large perturbations; an error that a smaller one mends is none.
        let (error, eps, j) = self.best().filter(|b| b.0 > CEN_AGREES)?;
        if let Some(pair) = self.seen.windows(2).rfind(same).filter(|p| p[1].central().0 <= STAYS * error) {
            let (error, j) = pair[1].central();
            let words = format!(
                "wrong: FW, BW and CEN agree with each other, but miss TRA and ADJ by {error:.0e}, most by {}",
                self.name(j)
            );
            return Some(verdict(Finding::Wrong, words, Some(j)));
        }
        self.both_slopes_off().then(|| {
            let words = format!(
                "wrong: both ways along the test direction the same slope is found, but not that of TRA and ADJ; \
                 CEN misses them by {error:.0e} at {eps:.0e}, most by {}",
                self.name(j)
            );
            verdict(Finding::Wrong, words, Some(j))
        })
    }

    /// Slopes found ahead and behind, and the one expected.
    fn found_slopes(&self) -> (f64, f64, f64) {
        let [ahead, behind] = self.walks;
        (ahead.found, -behind.found, ahead.expected)
    }

    /// Whether both ways the same slope is found, and not the expected one, by a change that does not fade.
    fn both_slopes_off(&self) -> bool {
        let (ahead, behind, expected) = self.found_slopes();
        let off = 0.5 * (ahead + behind) - expected;
        let first = |w: &Walk| w.table.iter().filter_map(|r| r.order).all(|o| (0.8..1.2).contains(&o));
        self.walks.iter().all(first) && off != 0.0 && (ahead - behind).abs() <= ALIKE * off.abs()
    }

    /// Longest run of perturbations over which a value stays, above rounding, as its first and last index.
    fn stays(&self, value: impl Fn(&Seen) -> f64) -> Option<(usize, usize)> {
        let last = self.seen.last()?;
        // What rounding makes of the smallest perturbation shrinks towards the larger ones in proportion.
        let telling = |s: &Seen| {
            let ratio = s.perturbation / last.perturbation;
            value(s).abs() > CEN_AGREES.max(HALF * ABOVE_NOISE.min(ratio) * value(last).abs() / ratio)
        };
        let mut longest: Option<(usize, usize)> = None;
        for from in 0..self.seen.len() {
            let first = value(&self.seen[from]);
            let kept = |s: &&Seen| {
                let ratio = value(s) / first;
                telling(s) && (1.0 / STAYS..=STAYS).contains(&ratio)
            };
            let count = self.seen[from..].iter().take_while(kept).count();
            let to = (from + count).saturating_sub(1);
            let span = |(a, b): (usize, usize)| self.seen[a].perturbation / self.seen[b].perturbation;
            if count > 1 && span((from, to)) > longest.map_or(DECADE, span) {
                longest = Some((from, to));
            }
        }
        longest
    }

    /// Forward and backward differences that keep apart.
    fn apart(&self, agree: &str) -> Option<Verdict> {
        let run = |j: usize| self.stays(|s| s.gap(j)).map(|run| (j, run, self.seen[run.1].gap(j)));
        let most = (0..self.scales.len()).filter_map(run).max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
        let (j, (from, to), gap) = most?;
        let side = match self.seen[to].off[0][j].abs() < self.seen[to].off[1][j].abs() {
            true => "forward",
            false => "backward",
        };
        let words = format!(
            "kink: {agree}, but FW and BW stay {:.0e} apart from {:.0e} to {:.0e}, most by {}; ADJ is closer to the {side} side",
            gap.abs(),
            self.seen[from].perturbation,
            self.seen[to].perturbation,
            self.name(j)
        );
        Some(verdict(Finding::Kink, words, Some(j)))
    }

    /// A central difference that keeps away.
    fn away(&self, agree: &str) -> Option<Verdict> {
        let run = |j: usize| self.stays(|s| s.off[2][j]).map(|run| (j, run, self.seen[run.1].off[2][j]));
        let most = (0..self.scales.len()).filter_map(run).max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
        let (j, (from, to), off) = most?;
        let words = format!(
            "kink: {agree}, but CEN stays {:.0e} away from {:.0e} to {:.0e}, most by {}",
            off.abs(),
            self.seen[from].perturbation,
            self.seen[to].perturbation,
            self.name(j)
        );
        Some(verdict(Finding::Kink, words, Some(j)))
    }

    /// Slopes ahead and behind along the direction of the Taylor test that differ.
    fn slopes(&self, agree: &str) -> Option<Verdict> {
        let (ahead, behind, expected) = self.found_slopes();
        let one_side = self.walks.iter().filter(|w| falls(&w.table)).count() == 1;
        let best = self.best();
        let confirmed = best.is_none_or(|b| b.0 <= CEN_AGREES);
        let off = [ahead, behind].map(|slope| slope / expected - 1.0);
        let found = format!(
            "along the test direction the slope ahead is off that of ADJ by {:+.0e} and the one behind by {:+.0e}",
            off[0], off[1]
        );
        if let (true, Some((error, eps, _))) = (off.iter().all(|o| o.abs() <= SMALL_KINK), best) {
            let words = format!(
                "exact: {agree}, CEN meets them to {error:.0e} at {eps:.0e}; the steps of the Taylor test cross small kinks: {found}"
            );
            return confirmed.then(|| verdict(Finding::Exact, words, None));
        }
        (one_side || confirmed).then(|| verdict(Finding::Kink, format!("kink: {agree}, but {found}"), None))
    }

    fn noisy(&self, agree: &str) -> Verdict {
        let (error, eps, j) = self.best().unwrap_or_default();
        let words = format!(
            "noisy: {agree}, but rounding and settling hide the differences: CEN comes no closer than {error:.0e}, at \
             {eps:.0e}, most by {}",
            self.name(j)
        );
        verdict(Finding::Noisy, words, Some(j))
    }
}

fn verdict(finding: Finding, words: String, parameter: Option<usize>) -> Verdict {
    Verdict { finding, words, parameter }
}

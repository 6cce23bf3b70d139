//! What is said first: which of two designs loses less, which is safer, and what to mind.

use super::{DesignPair, LeafComparison, LimitSide, LimitState, SideBySide};
use crate::optimise::Outcome;
use crate::report::{Report, short, word};

/// Relative difference below which two numbers are called the same: what the tolerance of a search leaves open.
const SAME: f64 = 1e-5;
/// Broken limits that are named one by one.
const NAMED: usize = 2;

/// The answer about two designs.
pub fn of_designs(a: &Report, b: &Report, pair: &DesignPair) -> Vec<String> {
    let parts = [Some(loss(a, b)), film(a, b), limits(pair)];
    let first = parts.into_iter().flatten().collect::<Vec<_>>().join("; ");
    let ends = [("A", a), ("B", b)].into_iter().filter_map(|(name, r)| {
        let known =
            matches!(r.outcome.status, Outcome::Converged | Outcome::AlmostConverged | Outcome::Simulated);
        (!known).then(|| {
            format!("The search of {name} ended as \"{}\": it found no optimum.", words(r.outcome.status))
        })
    });
    std::iter::once(format!("{first}.")).chain(ends).collect()
}

/// An outcome as one reads it.
pub fn words(status: Outcome) -> String {
    word(status).replace('-', " ")
}

fn same(a: f64, b: f64) -> bool {
    (b - a).abs() <= SAME * a.abs().max(b.abs())
}

/// How much less or more, with its share of A.
fn change(a: f64, b: f64, unit: &str) -> String {
    let share = if a == 0.0 { String::new() } else { format!(" ({} %)", short(100.0 * ((b - a) / a).abs())) };
    format!("{} {unit}{share} {}", short((b - a).abs()), if b > a { "more" } else { "less" })
}

fn loss(a: &Report, b: &Report) -> String {
    let minimised = |r: &Report| r.running_in.as_ref().and_then(|i| i.minimised.clone());
    if let (Some(x), Some(y)) = (minimised(a), minimised(b))
        && (&x.quantity, &x.unit) == (&y.quantity, &y.unit)
    {
        let (what, unit) = (&x.quantity, &x.unit);
        return match same(x.optimum, y.optimum) {
            true => format!("A and B have the same {what}, {} {unit}", short(x.optimum)),
            false => format!("B has {} than A ({what})", change(x.optimum, y.optimum, unit)),
        };
    }
    match [a, b].map(|r| r.objective.optimum.map(|l| l.total_w)) {
        [Some(x), Some(y)] if same(x, y) => format!("A and B lose the same, {} W", short(x)),
        [Some(x), Some(y)] => format!("B loses {} than A", change(x, y, "W")),
        [Some(x), None] => format!("A loses {} W, the loss of B is not known", short(x)),
        [None, Some(y)] => format!("B loses {} W, the loss of A is not known", short(y)),
        [None, None] => "the losses are not known".to_owned(),
    }
}

fn film(a: &Report, b: &Report) -> Option<String> {
    let smallest = |r: &Report| r.orbit.iter().map(|o| o.min_film_thickness_um.value).reduce(f64::min);
    let (x, y) = (smallest(a)?, smallest(b)?);
    Some(match same(x, y) {
        true => format!("their smallest films are the same, {} um", short(x)),
        false => {
            let way = if y > x { "thicker" } else { "thinner" };
            format!("the smallest film of B is {} um {way}", short((y - x).abs()))
        }
    })
}

/// Which limits are kept; none if there are none.
fn limits(pair: &DesignPair) -> Option<String> {
    let of = |side: fn(&super::LimitPair) -> Option<LimitSide>| -> Vec<(String, LimitState)> {
        let all = pair.limits.iter();
        all.filter_map(|l| Some((place(&l.quantity, &l.bearing, &l.operating_point), side(l)?.state)))
            .collect()
    };
    let (a, b) = (kept(&of(|l| l.a)), kept(&of(|l| l.b)));
    match (a, b) {
        (None, None) => None,
        (Some(a), Some(b)) if a == KEPT && b == KEPT => Some("both keep all limits".to_owned()),
        (a, b) => {
            let told = |k: Option<String>| k.unwrap_or_else(|| "has no limits".to_owned());
            Some(format!("B {}, A {}", told(b), told(a)))
        }
    }
}

const KEPT: &str = "keeps all limits";

fn kept(limits: &[(String, LimitState)]) -> Option<String> {
    let broken: Vec<&str> =
        limits.iter().filter(|l| l.1 == LimitState::Violated).map(|l| l.0.as_str()).collect();
    let unknown = limits.iter().any(|l| l.1 == LimitState::NotKnown);
    match (limits.len(), broken.len()) {
        (0, _) => None,
        (_, 0) if unknown => Some("has limits whose values are not known".to_owned()),
        (_, 0) => Some(KEPT.to_owned()),
        (_, 1..=NAMED) => Some(format!("breaks {}", broken.join(" and "))),
        (all, n) => Some(format!("breaks {n} of {all} limits")),
    }
}

/// A quantity and where it is, as one reads them.
pub fn place(quantity: &str, bearing: &str, point: &str) -> String {
    let at: Vec<&str> = [bearing, point].into_iter().filter(|w| !w.is_empty()).collect();
    if at.is_empty() { quantity.to_owned() } else { format!("{quantity} ({})", at.join(", ")) }
}

/// What to mind about two designs.
pub fn notes(a: &Report, b: &Report) -> Vec<String> {
    let mut notes = Vec::new();
    let (x, y) = (&a.objective, &b.objective);
    if x.quantity != y.quantity {
        notes.push(format!(
            "Their objectives are not the same quantity: A minimises the {}; B the {}.",
            x.quantity, y.quantity
        ));
    }
    let service = |r: &Report| -> Vec<(String, String, u32, f64)> {
        let points = r.objective.operating_points.iter();
        points.map(|p| (p.operating_point.clone(), p.bearing.clone(), p.count, p.weight)).collect()
    };
    if service(a) != service(b) {
        notes.push(
            "Bearings, operating points or their weights differ, and the losses are sums over them.".into(),
        );
    }
    for (name, r) in [("A", a), ("B", b)] {
        for bearing in r.running_in.iter().flat_map(|i| &i.bearings) {
            if let Some(reason) = &bearing.failure {
                notes.push(format!("{} of {name} could not be run in: {reason}.", bearing.bearing));
            }
        }
    }
    notes
}

/// The answer about two reports that are compared leaf by leaf.
pub fn of_leaves(content: &LeafComparison) -> Vec<String> {
    let mut told = vec![format!("{}.", content.counted())];
    let largest = content.rows.iter().find_map(|r| Some((r, r.relative?)));
    if let Some((row, relative)) = largest {
        told.push(format!(
            "The largest relative difference of numbers is {} %, at {}.",
            short(100.0 * relative.abs()),
            row.path
        ));
    }
    told
}

/// Why two reports of designs are compared leaf by leaf.
pub fn unread(name: &str, why: &serde_json::Error) -> String {
    format!(
        "{name} is no report of a design as this version writes it ({why}); both are compared leaf by leaf. \
         Run its study again to compare the designs by what they are about."
    )
}

/// What to mind about where two reports are from.
pub fn origins(found: &SideBySide) -> Vec<String> {
    let mut notes = Vec::new();
    let (a, b) = (&found.a, &found.b);
    for (name, _) in [("A", a), ("B", b)].into_iter().filter(|(_, head)| head.coarse) {
        notes.push(format!("{name} was made with its study's coarse setting: its numbers decide nothing."));
    }
    if let (Some(x), Some(y)) = (&a.version, &b.version)
        && x != y
    {
        notes.push(format!("A was written by version {x}, B by version {y}."));
    }
    if found.inputs.differing == 0 && a.study_hash != b.study_hash {
        notes.push("The studies read the same but have other hashes: a table beside them differs.".into());
    }
    notes
}

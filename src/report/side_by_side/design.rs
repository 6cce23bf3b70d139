//! Two designs: losses, parameters, limits, cycles, running-in and work, paired by name.

use super::answer::words;
use super::{CasePair, DesignPair, LimitPair, LimitSide, LimitState, NumberPair, Pairs, TextPair, paired};
use crate::report::{BearingRunningIn, Loss, MinimisedReport, OrbitReport, Report};

/// A number of something: its name, its unit, and how it is found.
type Measure<T> = (&'static str, &'static str, fn(&T) -> Option<f64>);

const OBJECTIVE: [Measure<Report>; 7] = [
    ("friction loss at the start", "W", |r| r.objective.start.map(|l| l.total_w)),
    ("contact part of it", "W", |r| r.objective.start.map(|l| l.contact_w)),
    ("friction loss of the design", "W", |r| r.objective.optimum.map(|l| l.total_w)),
    ("hydrodynamic part of it", "W", |r| r.objective.optimum.map(|l| l.hydrodynamic_w)),
    ("contact part of it", "W", |r| r.objective.optimum.map(|l| l.contact_w)),
    ("with squeeze power", "W", |r| r.objective.optimum.map(|l| l.dissipation_w)),
    ("saving", "%", |r| r.objective.saving_percent),
];

const CYCLE: [Measure<OrbitReport>; 6] = [
    ("smallest film", "um", |o| Some(o.min_film_thickness_um.value)),
    ("largest film pressure", "MPa", |o| Some(o.max_film_pressure_mpa.value)),
    ("largest contact pressure", "MPa", |o| Some(o.max_contact_pressure_mpa.value)),
    ("film temperature", "degC", |o| Some(o.film_temperature_c)),
    ("mean side flow", "l/min", |o| Some(o.mean_side_flow_l_min)),
    ("largest specific load", "MPa", |o| Some(o.max_specific_load_mpa.value)),
];

const RUNNING_IN: [Measure<BearingRunningIn>; 9] = [
    ("loss at the beginning of the last stage", "W", |b| Some(b.first_loss_w)),
    ("loss in its end", "W", |b| Some(b.final_loss_w)),
    ("mean loss of the programme", "W", |b| Some(b.mean_loss_w)),
    ("contact share in the end", "%", |b| Some(100.0 * b.final_contact_share)),
    ("energy lost", "kJ", |b| Some(b.energy_lost_kj)),
    ("worn off", "mm3", |b| Some(b.wear_volume_mm3)),
    ("deepest wear", "um", |b| Some(b.max_wear_depth_um)),
    ("time to run in", "h", |b| b.time_to_run_in_h),
    ("duration", "h", |b| Some(b.duration_h)),
];

const WORK: [Measure<Report>; 6] = [
    ("simulations", "1", |r| Some(r.cost.total.simulations as f64)),
    ("gradient calls", "1", |r| Some(r.cost.gradient_calls as f64)),
    ("time steps", "1", |r| Some(r.cost.total.steps as f64)),
    ("Newton iterations", "1", |r| Some(r.cost.total.newton_iterations as f64)),
    ("factorisations", "1", |r| Some(r.cost.total.factorisations as f64)),
    ("solves", "1", |r| Some(r.cost.total.solves as f64)),
];

/// Two designs side by side.
pub fn designs(a: &Report, b: &Report) -> DesignPair {
    DesignPair {
        outcome: outcome(a, b),
        objective: minimised(a, b).into_iter().chain(measured(&OBJECTIVE, Some(a), Some(b))).collect(),
        parameters: parameters(a, b),
        limits: limits(a, b),
        cycles: cycles(a, b),
        running_in: running_in(a, b),
        work: measured(&WORK, Some(a), Some(b)),
    }
}

/// Size in its unit below which a number is the rounding of nothing: contact where surfaces do not touch.
const TRACE: f64 = 1e-6;

fn measured<T>(measures: &[Measure<T>], a: Option<&T>, b: Option<&T>) -> Vec<NumberPair> {
    let seen = |v: f64| if v.abs() < TRACE { 0.0 } else { v };
    let one = |(name, unit, of): &Measure<T>| {
        NumberPair::new(*name, unit, a.and_then(of).map(seen), b.and_then(of).map(seen))
    };
    measures.iter().map(one).collect()
}

fn outcome(a: &Report, b: &Report) -> Vec<TextPair> {
    let both = |name: &str, of: fn(&Report) -> String| TextPair {
        name: name.to_owned(),
        a: Some(of(a)),
        b: Some(of(b)),
    };
    let taken = |r: &Report| r.choices.as_ref().map(|c| c.taken.clone()).unwrap_or_default();
    let (taken_a, taken_b) = (taken(a), taken(b));
    let chosen = paired(&taken_a, &taken_b, |c| c.name.as_str()).into_iter().filter_map(|(x, y)| {
        Some(TextPair {
            name: x.or(y)?.name.clone(),
            a: x.map(|c| c.taken.clone()),
            b: y.map(|c| c.taken.clone()),
        })
    });
    [both("outcome", |r| words(r.outcome.status)), both("minimised", |r| r.objective.quantity.clone())]
        .into_iter()
        .chain(chosen)
        .collect()
}

/// What designs for running-in minimise, at start and design.
fn minimised(a: &Report, b: &Report) -> Vec<NumberPair> {
    let of = |r: &Report| -> Vec<MinimisedReport> {
        r.running_in.iter().filter_map(|i| i.minimised.clone()).collect()
    };
    let (a, b) = (of(a), of(b));
    let pairs = paired(&a, &b, |m| (m.quantity.as_str(), m.unit.as_str()));
    let rows = pairs.into_iter().filter_map(|(x, y)| {
        let either = x.or(y)?;
        let number = |of: fn(&MinimisedReport) -> f64, at: &str| {
            NumberPair::new(format!("{}, {at}", either.quantity), &either.unit, x.map(of), y.map(of))
        };
        Some([number(|m| m.start, "start"), number(|m| m.optimum, "design")])
    });
    rows.flatten().collect()
}

fn parameters(a: &Report, b: &Report) -> Vec<NumberPair> {
    let pairs = paired(&a.design, &b.design, |d| (d.name.as_str(), d.unit.as_str()));
    let row = pairs.into_iter().filter_map(|(x, y)| {
        let either = x.or(y)?;
        Some(NumberPair::new(&either.name, &either.unit, x.map(|d| d.value), y.map(|d| d.value)))
    });
    row.collect()
}

/// A limit of one report.
struct Limit<'r> {
    quantity: &'r str,
    bearing: &'r str,
    operating_point: &'r str,
    sense: &'r str,
    unit: &'r str,
    side: LimitSide,
}

impl LimitSide {
    fn new(value: Option<f64>, limit: f64, (met, active): (bool, bool), price: Option<f64>) -> Self {
        let state = match (met, active) {
            _ if value.is_none() => LimitState::NotKnown,
            (false, _) => LimitState::Violated,
            (true, true) => LimitState::Active,
            (true, false) => LimitState::Inactive,
        };
        Self { value, limit, state, price_w_per_unit: price.filter(|_| active) }
    }
}

fn all_limits(r: &Report) -> Vec<Limit<'_>> {
    let cycle = r.constraints.iter().map(|c| Limit {
        quantity: &c.quantity,
        bearing: &c.bearing,
        operating_point: &c.operating_point,
        sense: &c.sense,
        unit: &c.unit,
        side: LimitSide::new(c.value, c.limit, (c.met, c.active), c.price_w_per_unit),
    });
    let sums = r.linear_constraints.iter().map(|l| Limit {
        quantity: &l.sum,
        bearing: "",
        operating_point: "",
        sense: &l.sense,
        unit: &l.unit,
        side: LimitSide::new(Some(l.value), l.limit, (l.met, l.active), l.price_w_per_unit),
    });
    let wear = r.running_in.iter().flat_map(|i| &i.limits).map(|l| Limit {
        quantity: &l.quantity,
        bearing: &l.bearing,
        operating_point: "running-in",
        sense: &l.sense,
        unit: &l.unit,
        side: LimitSide::new(Some(l.value), l.limit, (l.met, l.active), Some(l.price_w_per_unit)),
    });
    cycle.chain(sums).chain(wear).collect()
}

fn limits(a: &Report, b: &Report) -> Vec<LimitPair> {
    let (a, b) = (all_limits(a), all_limits(b));
    let key = |l: &Limit<'_>| [l.quantity, l.bearing, l.operating_point, l.sense, l.unit].map(str::to_owned);
    let pairs: Pairs<'_, Limit<'_>> = paired(&a, &b, key);
    let row = pairs.into_iter().filter_map(|(x, y)| {
        let either = x.or(y)?;
        let value = |l: Option<&Limit<'_>>| l.and_then(|l| l.side.value);
        Some(LimitPair {
            quantity: either.quantity.to_owned(),
            bearing: either.bearing.to_owned(),
            operating_point: either.operating_point.to_owned(),
            sense: either.sense.to_owned(),
            unit: either.unit.to_owned(),
            a: x.map(|l| l.side),
            b: y.map(|l| l.side),
            difference: value(x).zip(value(y)).map(|(x, y)| y - x),
        })
    });
    row.collect()
}

/// Loss of one bearing at one operating point.
fn case_loss(r: &Report, bearing: &str, point: &str) -> Option<Loss> {
    let mut cases = r.objective.operating_points.iter();
    cases.find(|c| (c.bearing.as_str(), c.operating_point.as_str()) == (bearing, point))?.optimum
}

fn cycles(a: &Report, b: &Report) -> Vec<CasePair> {
    let pairs = paired(&a.orbit, &b.orbit, |o| (o.bearing.as_str(), o.operating_point.as_str()));
    let case = pairs.into_iter().filter_map(|(x, y)| {
        let either = x.or(y)?;
        let loss = |r: &Report| case_loss(r, &either.bearing, &either.operating_point).map(|l| l.total_w);
        let mut numbers = vec![NumberPair::new("mean friction loss", "W", loss(a), loss(b))];
        numbers.extend(measured(&CYCLE, x, y));
        let operating_point = Some(either.operating_point.clone());
        Some(CasePair { bearing: either.bearing.clone(), operating_point, numbers })
    });
    case.collect()
}

fn running_in(a: &Report, b: &Report) -> Vec<CasePair> {
    let of = |r: &Report| r.running_in.as_ref().map(|i| i.bearings.clone()).unwrap_or_default();
    let (a, b) = (of(a), of(b));
    let pairs = paired(&a, &b, |b| b.bearing.as_str());
    let case = pairs.into_iter().filter_map(|(x, y)| {
        let bearing = x.or(y)?.bearing.clone();
        let [x, y] = [x, y].map(|b| b.filter(|b| b.failure.is_none()));
        Some(CasePair { bearing, operating_point: None, numbers: measured(&RUNNING_IN, x, y) })
    });
    case.collect()
}

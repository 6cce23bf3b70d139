//! Short tables of what a search was asked beside its limits: sums, worst case, margins, choices.

use super::tables::{maybe, table, word};
use crate::report::{CycleState, Report, short};

/// Everything of these that a report has.
pub(super) fn design_tables(report: &Report) -> String {
    let mut text = String::new();
    let all = [sums(report), worst_case(report), margins(report), choices(report), running_in(report)];
    for rows in all.into_iter().flatten() {
        text += &format!("{rows}\n\n");
    }
    text
}

fn sums(report: &Report) -> Option<String> {
    let mut rows = table(&["sum", "value", "limit", "unit", "state", "price [W/unit]"]);
    for l in &report.linear_constraints {
        let state = match (l.met, l.active) {
            (false, _) => "violated",
            (true, true) => "active",
            (true, false) => "",
        };
        let price = l.price_w_per_unit.filter(|_| l.active).map(short).unwrap_or_default();
        let limit = format!("{} {}", l.sense, short(l.limit));
        rows.add_row([l.sum.clone(), short(l.value), limit, l.unit.clone(), state.to_owned(), price]);
    }
    (!report.linear_constraints.is_empty()).then(|| rows.to_string())
}

fn worst_case(report: &Report) -> Option<String> {
    let mut rows =
        table(&["worst case", "start [W x weight]", "design [W x weight]", "share of the decision"]);
    for p in &report.objective.worst_case {
        let share = format!("{} %", short((1e3 * p.share).round() / 10.0));
        rows.add_row([p.operating_point.clone(), maybe(p.start_w), short(p.optimum_w), share]);
    }
    (!report.objective.worst_case.is_empty()).then(|| rows.to_string())
}

fn margins(report: &Report) -> Option<String> {
    let r = report.robust.as_ref()?;
    let mut rows = table(&["scatters", "at the design", "standard deviation", "drawn", "beyond the limit"]);
    let share = |percent: Option<f64>| percent.map_or_else(String::new, |p| format!("{} %", short(p)));
    rows.add_row([
        "loss [W]".to_owned(),
        short(r.nominal_w),
        short(r.deviation_w),
        maybe(r.sampled_deviation_w),
        share(r.above_percent),
    ]);
    for l in &r.limits {
        let value = report.constraints.iter().find(|c| {
            (&c.quantity, &c.bearing, &c.operating_point) == (&l.quantity, &l.bearing, &l.operating_point)
        });
        rows.add_row([
            format!("{} [{}], {}, {}", l.quantity, l.unit, l.bearing, l.operating_point),
            maybe(value.and_then(|c| c.value)),
            short(l.deviation),
            maybe(l.sampled_deviation.map(|s| if s < 1e-9 * l.deviation.max(1.0) { 0.0 } else { s })),
            share(l.broken_percent),
        ]);
    }
    let mut words = format!(
        "margins of {} standard deviation(s): {} W with its margin is what was minimised",
        short(r.sigmas),
        short(r.robust_w)
    );
    if let Some(verdict) = &r.verdict {
        words += &format!("\n{} bearings drawn", r.samples - r.failed);
        if r.failed > 0 {
            words += &format!(", {} more could not be simulated and count among those beyond", r.failed);
        }
        words += &format!(": {verdict}");
    }
    Some(format!("{rows}\n{words}"))
}

fn choices(report: &Report) -> Option<String> {
    let c = report.choices.as_ref()?;
    let names: Vec<&str> = c.taken.iter().map(|t| t.name.as_str()).collect();
    let loss = if report.robust.is_some() { "loss with margin [W]" } else { "loss [W]" };
    let mut rows = table(&[&names.join(", "), "outcome", loss, "violation", "simulations"]);
    for r in &c.runs {
        rows.add_row([
            r.options.join(", "),
            word(r.status),
            maybe(r.loss_w),
            r.violation.map_or_else(String::new, |v| format!("{v:.1e}")),
            r.simulations.to_string(),
        ]);
    }
    let taken: Vec<String> = c.taken.iter().map(|t| format!("{}: {}", t.name, t.taken)).collect();
    Some(format!("{rows}\ntaken: {}", taken.join("; ")))
}

fn running_in(report: &Report) -> Option<String> {
    let r = report.running_in.as_ref()?;
    let mut rows = table(&[
        "running-in",
        "energy lost [kJ]",
        "worn off [mm3]",
        "deepest [um]",
        "point",
        "loss new, run in [W]",
        "contact part [W]",
        "film [um]",
    ]);
    let mut failures = String::new();
    for b in &r.bearings {
        if let Some(reason) = &b.failure {
            failures += &format!("\n{} could not be run in: {reason}", b.bearing);
        }
        let mut own = [b.energy_lost_kj, b.wear_volume_mm3, b.max_wear_depth_um].map(short);
        let mut name = b.bearing.clone();
        for p in &b.operating_points {
            let pair = |of: fn(&CycleState) -> f64| {
                format!("{}, {}", short(of(&p.new)), maybe(p.run_in.as_ref().map(of)))
            };
            let [energy, volume, depth] = std::mem::take(&mut own);
            rows.add_row([
                std::mem::take(&mut name),
                energy,
                volume,
                depth,
                p.operating_point.clone(),
                pair(|s| s.loss_w),
                pair(|s| s.contact_loss_w),
                pair(|s| s.min_film_thickness_um),
            ]);
        }
    }
    let mut words = String::new();
    if let Some(m) = &r.minimised {
        let (start, optimum) = (short(m.start), short(m.optimum));
        let saving = m
            .saving_percent
            .map_or_else(|| ", which breaks its limits".to_owned(), |p| format!(", {} % saved", short(p)));
        let (what, unit) = (&m.quantity, &m.unit);
        let measure = match m.start_violation {
            Some(v) if v > 1e-6 => format!(" (which breaks its limits by {} %)", short(100.0 * v)),
            _ => String::new(),
        };
        words += &format!(
            "\n{what}: {start} {unit} at the start{measure}, {optimum} {unit} at the design{saving}"
        );
    }
    if let Some(a) = &r.approximation {
        let design =
            a.design_error_percent.map_or_else(String::new, |e| format!(", {} % at the design", short(e)));
        words += &format!(
            "\nbegun with {} of {} blocks (P_alpha): {} designs, {} cycles; it errs by {} % at the start{design}",
            a.groups,
            a.blocks,
            a.iterations,
            a.simulations,
            short(a.start_error_percent)
        );
    }
    for l in &r.limits {
        let state = match (l.met, l.active) {
            (false, _) => ", violated".to_owned(),
            (true, true) if l.price_w_per_unit > 0.0 => {
                format!(", active, price {} W per {}", short(l.price_w_per_unit), l.unit)
            }
            (true, true) => ", active".to_owned(),
            (true, false) => String::new(),
        };
        let (value, limit) = (short(l.value), short(l.limit));
        words +=
            &format!("\n{} of {}: {value}, {} {limit} {}{state}", l.quantity, l.bearing, l.sense, l.unit);
    }
    Some(format!("{rows}{words}{failures}"))
}

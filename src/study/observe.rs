//! Looks at simulated cycles: curves, extrema, losses.

use super::build::{CaseLabel, Plan};
use super::check::Study;
use super::vocabulary::QuantityName;
use crate::cranktrain::{BearingOutput, JournalBearing};
use crate::film::{Axial, FilmModel, FilmSite, Gap};
use crate::laws::ZERO_CELSIUS_K;
use crate::optimise::Evaluated;
use crate::orbit::Orbit;
use crate::report::{Curves, Extremum, Loss, OrbitReport, PressureReport};

/// Cylinder pressure at the first operating point, in numbers and as a curve (degrees, MPa).
pub(super) fn cylinder(study: &Study) -> (Option<PressureReport>, Vec<(f64, f64)>) {
    let (Some(cylinder), Some(point)) = (&study.cylinder, study.points.first()) else {
        return (None, Vec::new());
    };
    let diagram = cylinder.pressure.scaled(point.load_factor);
    let (peak, at) = diagram.peak();
    let report = PressureReport {
        imep_mpa: diagram.imep_pa(&cylinder.crank) * 1e-6,
        peak_mpa: Extremum { value: peak * 1e-6, crank_angle_deg: at.to_degrees() },
    };
    let curve = (0..=720).map(f64::from).map(|a| (a, diagram.at(a.to_radians()) * 1e-6)).collect();
    (Some(report), curve)
}

/// Loss of one case.
pub(super) fn loss(orbit: &Orbit) -> Loss {
    let mean = |output: BearingOutput| {
        orbit.outputs.iter().map(|y| y[output.index()]).sum::<f64>() / orbit.steps() as f64
    };
    let (total_w, contact_w) = (mean(BearingOutput::Loss), mean(BearingOutput::ContactLoss));
    Loss {
        total_w,
        hydrodynamic_w: total_w - contact_w,
        contact_w,
        dissipation_w: mean(BearingOutput::Dissipation),
    }
}

/// Weighted losses of all bearings at one operating point, or at all.
pub(super) fn total_loss(study: &Study, cases: &[CaseLabel], at: &Evaluated, only: Option<usize>) -> Loss {
    let mut sum = Loss { total_w: 0.0, hydrodynamic_w: 0.0, contact_w: 0.0, dissipation_w: 0.0 };
    for (label, orbit) in cases.iter().zip(&at.orbits).filter(|(l, _)| only.is_none_or(|p| p == l.point)) {
        let one = loss(orbit);
        let share = study.points[label.point].weight * f64::from(study.bearings[label.bearing].count);
        sum.total_w += share * one.total_w;
        sum.hydrodynamic_w += share * one.hydrodynamic_w;
        sum.contact_w += share * one.contact_w;
        sum.dissipation_w += share * one.dissipation_w;
    }
    sum
}

/// The bearing of a case at a design, with the film temperature that was found.
pub(super) fn found(plan: &Plan, case: usize, x: &[f64], orbit: &Orbit) -> Option<JournalBearing> {
    plan.problem.model(case, x).ok().and_then(|model| orbit.model(&model).ok())
}

/// Curves of one case at the design `x`, with those of the start beside them.
pub(super) fn curves(
    study: &Study,
    plan: &Plan,
    case: usize,
    x: &[f64],
    at: &Evaluated,
    start: Option<&Evaluated>,
) -> Option<Curves> {
    let label = plan.cases[case];
    let model = found(plan, case, x, &at.orbits[case])?;
    let now = Trace::of(&model, &at.orbits[case]);
    let before = start.and_then(|s| {
        let model = found(plan, case, &plan.start, &s.orbits[case])?;
        Some(Trace::of(&model, &s.orbits[case]))
    });
    let before = before.unwrap_or_default();
    Some(Curves {
        bearing: study.bearings[label.bearing].name.clone(),
        operating_point: study.points[label.point].name.clone(),
        crank_angle_deg: now.angle_deg,
        eccentricity: now.eccentricity,
        start_eccentricity: before.eccentricity,
        film_min_um: now.film_min_um,
        start_film_min_um: before.film_min_um,
        gap_max_um: now.gap_max_um,
        pressure_max_mpa: now.pressure_mpa,
        start_pressure_max_mpa: before.pressure_mpa,
        contact_max_mpa: now.contact_mpa,
        loss_w: now.loss_w,
        contact_loss_w: now.contact_loss_w,
        start_loss_w: before.loss_w,
        dissipation_w: now.dissipation_w,
        side_flow_l_min: now.side_flow_l_min,
        load_kn: now.load_kn,
        pressure_map_mpa: now.map_mpa,
        fill_map: now.fill_map,
        shape_um: shape_um(&model),
        sensitivity: None,
        width_mm: model.setup().width_m * 1e3,
        diameter_mm: model.setup().diameter_m * 1e3,
    })
}

/// What the shapes add to the gap at the start of the cycle; empty without shapes or cells.
fn shape_um(model: &JournalBearing) -> Vec<Vec<f64>> {
    let (_, shape_m) = model.still_input([0.0; 2], model.setup().speed_rad_s);
    match model.film().mesh() {
        Some(mesh) if shape_m.iter().any(|v| *v != 0.0) => mesh.map(shape_m.iter().map(|v| v * 1e6)),
        _ => Vec::new(),
    }
}

#[derive(Default)]
struct Trace {
    angle_deg: Vec<f64>,
    eccentricity: Vec<[f64; 2]>,
    film_min_um: Vec<f64>,
    gap_max_um: Vec<f64>,
    pressure_mpa: Vec<f64>,
    contact_mpa: Vec<f64>,
    loss_w: Vec<f64>,
    contact_loss_w: Vec<f64>,
    dissipation_w: Vec<f64>,
    side_flow_l_min: Vec<f64>,
    load_kn: Vec<[f64; 2]>,
    map_mpa: Vec<Vec<f64>>,
    fill_map: Vec<Vec<f64>>,
}

impl Trace {
    fn of(model: &JournalBearing, orbit: &Orbit) -> Self {
        let mut trace = Self::default();
        let mut highest = f64::NEG_INFINITY;
        let film = model.film();
        orbit.for_each(model, |n, at| {
            let mut room = Vec::new();
            let site = model.film_site(at, &mut room);
            let (u, q, y) = (site.input, model.film_unknowns(at.z), &orbit.outputs[n]);
            let pressure = film.pressure_max_pa(&site, q);
            trace.angle_deg.push((at.t_s * model.setup().speed_rad_s).to_degrees());
            trace.eccentricity.push(u.eccentricity_m.map(|e| e / u.clearance_m));
            let [low, high] = gap_range_m(film, &site);
            trace.film_min_um.push(low * 1e6);
            trace.gap_max_um.push(high * 1e6);
            trace.pressure_mpa.push(pressure * 1e-6);
            trace.contact_mpa.push(film.contact_max_pa(&site, q) * 1e-6);
            trace.loss_w.push(y[BearingOutput::Loss.index()]);
            trace.contact_loss_w.push(y[BearingOutput::ContactLoss.index()]);
            trace.dissipation_w.push(y[BearingOutput::Dissipation.index()]);
            trace.side_flow_l_min.push(y[BearingOutput::SideFlow.index()] / QuantityName::SideFlow.unit().1);
            trace.load_kn.push(model.drive(at.t_s).load_n.map(|f| f * 1e-3));
            if pressure > highest {
                highest = pressure;
                let map = film.pressure_map_pa(&site, q);
                trace.map_mpa =
                    map.into_iter().map(|row| row.into_iter().map(|p| p * 1e-6).collect()).collect();
                if film.conserves_mass() {
                    trace.fill_map = film.fill_map(&site, q);
                }
            }
        });
        trace
    }
}

/// Smallest and largest gap: in closed form for the aligned cylindrical bearing, else the exact ones over the cells.
fn gap_range_m(film: &dyn FilmModel, site: &FilmSite) -> [f64; 2] {
    match film.mesh() {
        Some(mesh) if !site.shape_m.is_empty() || mesh.axial == Axial::Full => {
            let mut gap = vec![0.0; mesh.cells()];
            Gap::fill(mesh, site, &mut gap);
            gap.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(*h), high.max(*h)])
        }
        _ => [Gap::minimum_m(&site.input), Gap::maximum_m(&site.input)],
    }
}

/// Extrema of one case from its curves.
pub(super) fn orbit_report(model: &JournalBearing, orbit: &Orbit, c: &Curves) -> OrbitReport {
    let extreme = |series: &[f64], sign: f64| {
        let best = series.iter().enumerate().max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)));
        let (n, value) = best.map_or((0, f64::NAN), |(n, v)| (n, *v));
        Extremum { value, crank_angle_deg: c.crank_angle_deg[n] }
    };
    let load: Vec<f64> =
        orbit.outputs.iter().map(|y| y[BearingOutput::SpecificLoad.index()] * 1e-6).collect();
    OrbitReport {
        bearing: c.bearing.clone(),
        operating_point: c.operating_point.clone(),
        min_film_thickness_um: extreme(&c.film_min_um, -1.0),
        max_gap_um: extreme(&c.gap_max_um, 1.0),
        max_film_pressure_mpa: extreme(&c.pressure_max_mpa, 1.0),
        max_specific_load_mpa: extreme(&load, 1.0),
        max_friction_loss_w: extreme(&c.loss_w, 1.0),
        mean_side_flow_l_min: c.side_flow_l_min.iter().sum::<f64>() / c.side_flow_l_min.len() as f64,
        max_contact_pressure_mpa: extreme(&c.contact_max_mpa, 1.0),
        mean_contact_loss_w: orbit.mean(BearingOutput::ContactLoss.index()),
        film_temperature_c: model.film_temperature_k() - ZERO_CELSIUS_K,
        viscosity_mpa_s: model.viscosity_pa_s() * 1e3,
        steps: orbit.steps(),
        cycles: orbit.cycles,
        periodicity: orbit.periodicity,
        corrections: orbit.corrections,
        recording: orbit.recording,
        bytes_per_step: orbit.recording.bytes_per_step(model),
    }
}

/// Cells over all steps at which the film has a kink.
pub(super) fn weakly_active(model: &JournalBearing, orbit: &Orbit) -> usize {
    let mut count = 0;
    orbit.for_each(model, |_, at| count += model.film().weakly_active(model.film_unknowns(at.z)));
    count
}

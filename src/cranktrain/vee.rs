//! V engines: which cylinder fires when, and what the main bearings carry.
//!
//! The crankcase frame has its `x` axis on the symmetry plane between the banks (in-line: on the cylinder axis). Bank A
//! stands at `+v/2`, bank B at `-v/2`, in the sense of rotation. Throw `k` is turned by `throw_angle[k]` ahead of throw 1. A
//! cylinder of bank `b` on throw `k` is at top dead centre when `theta + throw_angle[k] = bank[b]` (mod 2 pi); the firing
//! order tells in which of the two turns of a cycle it fires. Crank angles count from firing of the first cylinder named.
//!
//! Each main journal carries half of its two neighbouring throws, more exactly the share given by the lever rule for rods
//! side by side on one pin: statically determinate, every throw a simply supported beam.

use super::rod::turned;
use super::{Cylinder, WORKING_CYCLE_RAD};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use thiserror::Error;

/// How far firing angles computed from the crankshaft may miss a multiple of a turn.
const ANGLE_TOLERANCE_RAD: f64 = 1e-6;

/// Row of cylinders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bank {
    /// At `+v/2`; the only bank of an in-line engine.
    A,
    /// At `-v/2`.
    B,
}

/// A cylinder by bank and throw, like "A3".
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct CylinderName {
    /// Row.
    pub bank: Bank,
    /// Throw, counted from 1 at the free end.
    pub throw: usize,
}

impl std::fmt::Display for CylinderName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}{}", self.bank, self.throw)
    }
}

impl std::str::FromStr for CylinderName {
    type Err = FiringError;
    fn from_str(text: &str) -> Result<Self, FiringError> {
        let unknown = || FiringError::Name(text.to_owned());
        let (bank, number) = text.split_at_checked(1).ok_or_else(unknown)?;
        let bank = match bank {
            "A" | "a" => Bank::A,
            "B" | "b" => Bank::B,
            _ => return Err(unknown()),
        };
        let throw = number.parse().ok().filter(|&n| n > 0).ok_or_else(unknown)?;
        Ok(Self { bank, throw })
    }
}

/// Why a firing order does not fit a crankshaft.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FiringError {
    /// Not a bank and a number.
    #[error("'{0}' names no cylinder; write the bank and the throw, like \"A1\" or \"B8\"")]
    Name(String),
    /// A throw that does not exist.
    #[error("{0} stands on a throw the crankshaft does not have ({1} throw angles are given)")]
    NoThrow(CylinderName, usize),
    /// The same cylinder twice.
    #[error("{0} fires twice")]
    Twice(CylinderName),
    /// The order needs more than two turns.
    #[error(
        "the order does not fit the throw angles within 720 degrees: after {before} the next dead centre of {cylinder} comes \
         {wait_deg:.0} degrees later"
    )]
    TooLong {
        /// Cylinder with which two turns are exceeded.
        cylinder: CylinderName,
        /// The one before it.
        before: CylinderName,
        /// Crank angle between them.
        wait_deg: f64,
    },
    /// Cylinders that are not in the order.
    #[error("every cylinder must fire once; missing: {0}")]
    Missing(String),
}

/// One throw with the cylinders that work on it.
#[derive(Debug, Clone)]
pub struct Throw {
    /// Angle ahead of throw 1, rad.
    pub angle_rad: f64,
    /// Bank and firing angle of each cylinder on this throw, rad in one working cycle.
    pub cylinders: Vec<(Bank, f64)>,
}

/// Crankshaft, banks and firing angles of a V or in-line engine with equal cylinders.
#[derive(Debug, Clone)]
pub struct VeeEngine {
    /// The cylinder all others are like.
    pub cylinder: Cylinder,
    /// Angle between the banks, rad; 0 for an in-line engine.
    pub vee_rad: f64,
    /// The throws from the free end.
    pub throws: Vec<Throw>,
    /// Unbalanced mass of one throw (pin and webs less counterweights) at the crank radius, kg.
    pub throw_mass_kg: f64,
    /// Distance of the two rods on one pin over the distance of neighbouring main bearings; the rod of bank A sits nearer to
    /// the free end.
    pub rod_spacing_ratio: f64,
}

impl VeeEngine {
    /// Works out the firing angles from throw angles and firing order; throws keep the order given.
    pub fn new(
        cylinder: Cylinder,
        vee_rad: f64,
        throw_angles_rad: &[f64],
        firing_order: &[CylinderName],
    ) -> Result<Self, FiringError> {
        let mut throws: Vec<Throw> =
            throw_angles_rad.iter().map(|&angle_rad| Throw { angle_rad, cylinders: Vec::new() }).collect();
        let mut seen = BTreeSet::new();
        let mut last = 0.0;
        let mut origin = None;
        let mut before = None;
        for &name in firing_order {
            let throw = throw_angles_rad.get(name.throw - 1);
            let throw_rad = *throw.ok_or(FiringError::NoThrow(name, throw_angles_rad.len()))?;
            if !seen.insert(name) {
                return Err(FiringError::Twice(name));
            }
            let top = bank_rad(name.bank, vee_rad) - throw_rad;
            let zero = *origin.get_or_insert(top);
            let within_turn = (top - zero - last + ANGLE_TOLERANCE_RAD).rem_euclid(TAU) - ANGLE_TOLERANCE_RAD;
            // Two pistons at top together fire a turn apart.
            let together = before.is_some() && within_turn < ANGLE_TOLERANCE_RAD;
            let within_turn = if together { TAU } else { within_turn };
            last += within_turn;
            if last >= WORKING_CYCLE_RAD - ANGLE_TOLERANCE_RAD {
                let wait_deg = within_turn.to_degrees();
                return Err(FiringError::TooLong {
                    cylinder: name,
                    before: before.unwrap_or(name),
                    wait_deg,
                });
            }
            before = Some(name);
            throws[name.throw - 1].cylinders.push((name.bank, last));
        }
        missing(&seen, throw_angles_rad.len())?;
        // Crank angles count from firing of the first cylinder: turn the throws so that it stands at its dead centre.
        let shift = origin.unwrap_or(0.0);
        throws.iter_mut().for_each(|t| t.angle_rad += shift);
        Ok(Self { cylinder, vee_rad, throws, throw_mass_kg: 0.0, rod_spacing_ratio: 0.0 })
    }

    /// Force of each rod of a throw on its pin, in the crankcase frame, N, with its bank.
    pub fn pin_forces(&self, throw: usize, crank_angle_rad: f64, speed_rad_s: f64) -> Vec<(Bank, [f64; 2])> {
        self.throws[throw]
            .cylinders
            .iter()
            .map(|&(bank, fires)| {
                let local = self.cylinder.forces(crank_angle_rad - fires, speed_rad_s);
                (bank, turned(local.pin_n, bank_rad(bank, self.vee_rad)))
            })
            .collect()
    }

    /// Centrifugal force of a throw's own unbalance, in the crankcase frame, N.
    pub fn unbalance_n(&self, throw: usize, crank_angle_rad: f64, speed_rad_s: f64) -> [f64; 2] {
        let force = self.throw_mass_kg * self.cylinder.crank.throw_m * speed_rad_s * speed_rad_s;
        let pin_rad = self.throws[throw].angle_rad + self.cylinder.crank.top_dead_centre_rad();
        turned([force, 0.0], crank_angle_rad + pin_rad)
    }

    /// Loads which a throw puts on the main bearing before and behind it, N. The rod of bank A sits nearer to the one before.
    pub fn throw_shares(&self, throw: usize, crank_angle_rad: f64, speed_rad_s: f64) -> [[f64; 2]; 2] {
        let own = self.unbalance_n(throw, crank_angle_rad, speed_rad_s);
        let mut shares = [own.map(|f| f / 2.0); 2];
        for (bank, force) in self.pin_forces(throw, crank_angle_rad, speed_rad_s) {
            let lean = match bank {
                Bank::A => -self.rod_spacing_ratio / 2.0,
                Bank::B => self.rod_spacing_ratio / 2.0,
            };
            for a in 0..2 {
                shares[0][a] += (0.5 - lean) * force[a];
                shares[1][a] += (0.5 + lean) * force[a];
            }
        }
        shares
    }

    /// Load of the crankshaft on a main bearing, counted from 0 at the free end to the number of throws.
    pub fn main_load_n(&self, main: usize, crank_angle_rad: f64, speed_rad_s: f64) -> [f64; 2] {
        let mut load = [0.0; 2];
        let mut add = |share: [f64; 2]| (0..2).for_each(|a| load[a] += share[a]);
        if main > 0 {
            add(self.throw_shares(main - 1, crank_angle_rad, speed_rad_s)[1]);
        }
        if main < self.throws.len() {
            add(self.throw_shares(main, crank_angle_rad, speed_rad_s)[0]);
        }
        load
    }
}

/// Every throw carries the same banks, and all their cylinders fire.
fn missing(seen: &BTreeSet<CylinderName>, throws: usize) -> Result<(), FiringError> {
    let banks: BTreeSet<Bank> = seen.iter().map(|n| n.bank).chain([Bank::A]).collect();
    let all = (1..=throws).flat_map(|throw| banks.iter().map(move |&bank| CylinderName { bank, throw }));
    let absent: Vec<String> = all.filter(|n| !seen.contains(n)).map(|n| n.to_string()).collect();
    if absent.is_empty() { Ok(()) } else { Err(FiringError::Missing(absent.join(", "))) }
}

/// Direction of a bank in the crankcase frame.
fn bank_rad(bank: Bank, vee_rad: f64) -> f64 {
    match bank {
        Bank::A => vee_rad / 2.0,
        Bank::B => -vee_rad / 2.0,
    }
}

/// One main bearing of an engine.
#[derive(Debug, Clone)]
pub struct MainLoad {
    /// The engine.
    pub engine: VeeEngine,
    /// Position from the free end, 0 to the number of throws.
    pub main: usize,
}

#[cfg(test)]
mod tests {
    use super::super::rod::tests::cylinder;
    use super::*;

    /// Cross-plane V8.
    fn engine() -> VeeEngine {
        let angles = [0.0, 90.0, 270.0, 180.0].map(f64::to_radians);
        let order = ["A1", "A3", "A4", "B1", "B3", "B4", "B2", "A2"].map(|n| n.parse().unwrap());
        let engine = VeeEngine::new(cylinder(), 90f64.to_radians(), &angles, &order).unwrap();
        VeeEngine { throw_mass_kg: 12.0, rod_spacing_ratio: 0.2, ..engine }
    }

    #[test]
    fn every_cylinder_fires_once_at_its_dead_centre_within_one_cycle() {
        let engine = engine();
        let mut fires: Vec<f64> =
            engine.throws.iter().flat_map(|t| t.cylinders.iter().map(|c| c.1)).collect();
        for throw in &engine.throws {
            for &(bank, angle) in &throw.cylinders {
                let miss =
                    (angle + throw.angle_rad - bank_rad(bank, engine.vee_rad) + 1.0).rem_euclid(TAU) - 1.0;
                assert!(miss.abs() < 1e-12);
            }
        }
        fires.sort_by(f64::total_cmp);
        assert_eq!(fires.len(), 8);
        for (k, angle) in fires.iter().enumerate() {
            assert!((angle - k as f64 * TAU / 4.0).abs() < 1e-12, "an even 90 degrees apart");
        }
    }

    #[test]
    fn forces_add_up_in_every_throw_and_over_the_engine() {
        let engine = engine();
        for k in 0..48 {
            let a = k as f64 * WORKING_CYCLE_RAD / 48.0;
            let mut total = [0.0; 2];
            for t in 0..engine.throws.len() {
                let mut sum = engine.unbalance_n(t, a, 157.0);
                for (_, f) in engine.pin_forces(t, a, 157.0) {
                    (0..2).for_each(|c| sum[c] += f[c]);
                }
                let shares = engine.throw_shares(t, a, 157.0);
                (0..2).for_each(|c| assert!((shares[0][c] + shares[1][c] - sum[c]).abs() < 1e-8));
                (0..2).for_each(|c| total[c] += sum[c]);
            }
            let mains = (0..=4).map(|m| engine.main_load_n(m, a, 157.0));
            let carried = mains.fold([0.0; 2], |s, f| [s[0] + f[0], s[1] + f[1]]);
            (0..2).for_each(|c| assert!((carried[c] - total[c]).abs() < 1e-7));
        }
    }

    #[test]
    fn a_throw_s_unbalance_points_along_its_pin() {
        let engine = engine();
        for throw in 0..4 {
            let own = engine.unbalance_n(throw, 0.7, 100.0);
            for &(bank, fires) in &engine.throws[throw].cylinders {
                let crank = engine.cylinder.crank.at(0.7 - fires).crank_rad + bank_rad(bank, engine.vee_rad);
                let across = own[1] * crank.cos() - own[0] * crank.sin();
                assert!(across.abs() < 1e-9 * own[0].hypot(own[1]));
                assert!(own[0] * crank.cos() + own[1] * crank.sin() > 0.0);
            }
        }
    }

    #[test]
    fn pistons_that_are_at_top_together_fire_a_turn_apart() {
        let order = ["A1", "A2"].map(|n| n.parse().unwrap());
        let twin = VeeEngine::new(cylinder(), 0.0, &[0.0, 0.0], &order).unwrap();
        assert!((twin.throws[1].cylinders[0].1 - TAU).abs() < 1e-12);
    }

    #[test]
    fn wrong_firing_orders_are_named() {
        let order = |names: &[&str]| names.iter().map(|n| n.parse().unwrap()).collect::<Vec<CylinderName>>();
        let build =
            |names: &[&str]| VeeEngine::new(cylinder(), 1.0, &[0.0, 3.0], &order(names)).err().unwrap();
        assert!(matches!(build(&["A1", "A3"]), FiringError::NoThrow(..)));
        assert!(matches!(build(&["A1", "A1"]), FiringError::Twice(_)));
        assert!(matches!(build(&["A1", "B1", "A2", "B2"]), FiringError::TooLong { .. }));
        assert!(matches!(build(&["A1", "A2", "B2"]), FiringError::Missing(_)));
        assert!(matches!(build(&[]), FiringError::Missing(_)));
        assert!("C1".parse::<CylinderName>().is_err() && "A0".parse::<CylinderName>().is_err());
        assert!("".parse::<CylinderName>().is_err() && "é1".parse::<CylinderName>().is_err());
    }
}

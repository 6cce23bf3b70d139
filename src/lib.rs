//! placeholder
pub mod cli;
pub mod cranktrain;
pub mod dae;
pub mod film;
pub mod gradient;
pub mod laws;
pub mod math;
pub mod optimise;
pub mod orbit;
pub mod report;
pub mod run;
pub mod study;
pub mod units;

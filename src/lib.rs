//! **stribeck** answers one question for engine and bearing designers: *which bearing geometry loses the least power to
//! friction, and is still safe?*
//!
//! It simulates dynamically loaded journal bearings of large-bore engines, computes the mean friction loss over a settled
//! working cycle and its exact gradient with respect to design parameters, and drives a constrained optimiser with it.
//!
//! # The house
//!
//! A module uses only what stands below it; modules of one floor do not know each other. `tests/architecture.rs` proves it.
//!
//! | floor | module | what lives there |
//! |---|---|---|
//! | roof | `main.rs` | hands the exit code to the system |
//! | 10 | [`cli`] | how people come in: `run`, `check`, `schema`, `gradient`, `compare`, `describe`, `serve`, `worker`, `key` |
//! | 9 | [`service`] | how programs come in: HTTP, the queue of jobs, workers, UM-Bridge, the page |
//! | 8 | [`study`] | what was asked: study file, checks, the run; the single door for people and programs |
//! | 7 | [`report`] | the answer as data, tables, figures, page |
//! | 6 | [`optimise`], [`running_in`] | which design next: SQP as an argmin solver over Clarabel, an augmented Lagrangian, COBYLA; wear through a programme of operating points, with its gradient |
//! | 5 | [`gradient`] | derivatives of cycle quantities by five engines: FW, BW, CEN, TRA, ADJ |
//! | 4 | [`orbit`] | the settled periodic cycle of a [`dae`] and quantities of it |
//! | 3 | [`cranktrain`] | cylinder pressure, slider-crank, loads; one bearing as a periodic system |
//! | 2 | [`film`] | the lubricated gap: Reynolds' equation with cavity, rough surfaces, supply and shapes; short bearing |
//! | 1 | [`laws`], [`dae`] | pointwise physics: oils, rough surfaces, contact; the ladder of abilities of a periodic implicit system with memory and cycle unknowns, and how a model of your own climbs it |
//! | ground | [`math`], [`units`], [`run`] | algebra; quantities as text; cancel, progress, counted work |
//!
//! # The way of the data
//!
//! ```text
//! study.toml --units, checks--> Study --> DesignProblem (one JournalBearing per bearing and operating point)
//!     (or, for a study that tabulates: equilibrium after equilibrium --> Characteristic;
//!      for one with experiments: the study with every combination of levels --> Experiments;
//!      for one that compares: start design --> five gradient engines and their proof --> Comparison)
//!     --> SQP: design --> settled orbit --> values;  accepted design --> gradient engine --> slopes --> QP --> step
//!     --> Report (JSON, HTML, CSV)
//! ```
//!
//! SI units and radians inside; a public name carries its unit. Everything but the service is synchronous and deterministic.
//!
//! # From code
//!
//! ```no_run
//! use stribeck::run::{Cancel, RunContext, Silent};
//! use stribeck::study::{Format, Study, run};
//!
//! let text = std::fs::read_to_string("studies/operational-170x215.toml").unwrap();
//! let study = Study::read(&text, Format::Toml, Some("studies".as_ref())).unwrap();
//! let cancel = Cancel::default();
//! let findings = run(&study, RunContext { cancel: &cancel, progress: &Silent });
//! println!("{:?}: {:?}", findings.report.outcome.status, findings.report.design);
//! ```

#![warn(missing_docs)]

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
pub mod running_in;
pub mod service;
pub mod study;
pub mod units;

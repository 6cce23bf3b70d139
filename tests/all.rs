//! One test program for all integration tests, so that the crate is linked once. Run it in release: `cargo test --release`.

mod allocations;
mod architecture;
mod asked_designs;
mod bad_studies;
mod cli;
mod common;
mod comparison;
mod curvature;
mod describe;
mod every_parameter;
mod film_derivatives;
mod gradient_check;
mod gradients;
mod hock_schittkowski;
mod literature;
mod main_job;
mod orbits;
mod own_model;
mod own_problem;
mod recording;
mod reports;
mod resume;
mod runner;
mod running_in;
mod running_in_gradients;
mod sensitivity;
mod service;
mod side_by_side;
mod studies;
mod study_physics;

#[global_allocator]
static ALLOCATOR: allocations::Counting = allocations::Counting;

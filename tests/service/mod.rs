//! The service: through its router, over sockets, as processes that are killed.

mod bridge;
mod clients;
mod common;
mod direct;
mod documents;
mod fuzz;
mod jobs;
mod kill;
mod queue;
mod refusals;

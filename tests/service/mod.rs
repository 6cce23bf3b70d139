//! The service: through its router, over sockets, as processes that are killed.

mod bridge;
mod common;
mod direct;
mod jobs;
mod kill;
mod queue;
mod refusals;

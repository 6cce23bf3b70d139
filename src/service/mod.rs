//! The service: jobs in, designs out. A program posts a box of bearing-geometry parameters and gets back the designs.
//!
//! ```text
//! request --guard (key, rate)--> checked study --> store: queued --claim (lease)--> worker --> study::answer --> files --> done
//!                                                    ^  hand back, sweep  |             \-- events, progress, checkpoints
//! ```
//!
//! One process is enough ([`serve`] with workers inside and a database in a file); with a database on a server any number of machines
//! add workers ([`work`]). The row of a job is the truth: see [`store`] for how nothing is lost and nothing ends twice.
//!
//! This is the only room that is asynchronous and knows a network. Deliberately not here: what is computed (that is
//! [`crate::study`]), users and roles (a key owns its jobs), TLS (a proxy's).

pub mod api;
mod job;
mod limits;
mod listen;
pub mod store;
mod worker;

pub use api::{App, openapi, router};
pub use job::{Job, JobKind, JobProgress, JobState};
pub use limits::Limits;
pub use worker::{WorkerOptions, work};

use metrics_exporter_prometheus::{PrometheusBuilder, PrometheusHandle};
use std::net::SocketAddr;
use std::sync::{Arc, OnceLock};
use store::{Store, StoreError};
use thiserror::Error;
use tokio::sync::{Notify, Semaphore, watch};

/// Requests that may compute at the same time.
const DIRECT: usize = 2;

/// Why the service does not run.
#[derive(Debug, Error)]
pub enum ServiceError {
    /// The database cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The address cannot be listened at.
    #[error("cannot listen at {0}: {1}")]
    Listen(SocketAddr, std::io::Error),
    /// Beyond this machine everybody could ask.
    #[error(
        "refusing to listen at {0} without keys: everybody in the network could submit jobs. Make a key with \
         'stribeck key create NAME' and leave out --no-keys, or listen at 127.0.0.1"
    )]
    Open(SocketAddr),
    /// The runtime failed.
    #[error("{0}")]
    System(#[from] std::io::Error),
}

/// How the service runs.
#[derive(Debug, Clone)]
pub struct ServeOptions {
    /// Where to listen.
    pub address: SocketAddr,
    /// Database.
    pub database: String,
    /// Whether keys are needed; none: beyond this machine only.
    pub keys: Option<bool>,
    /// Workers of this process; no slots for none.
    pub workers: WorkerOptions,
    /// What may be asked for.
    pub limits: Limits,
}

/// The recorder of numbers, of which a process has one.
pub fn recorder() -> PrometheusHandle {
    static RECORDER: OnceLock<PrometheusHandle> = OnceLock::new();
    let install = || {
        let recorder = PrometheusBuilder::new().build_recorder();
        let handle = recorder.handle();
        // Another recorder of this process keeps its place; ours stays empty then.
        let _ = metrics::set_global_recorder(recorder);
        handle
    };
    RECORDER.get_or_init(install).clone()
}

/// The parts of a service over an open database.
pub fn app(store: Store, limits: Limits, keys: bool) -> App {
    App {
        store,
        wake: Arc::new(Notify::new()),
        limits: Arc::new(limits),
        keys,
        direct: Arc::new(Semaphore::new(DIRECT)),
        metrics: recorder(),
    }
}

/// Serves until the process is asked to stop; `ready` hears the address.
pub async fn serve(options: ServeOptions, ready: impl FnOnce(SocketAddr)) -> Result<(), ServiceError> {
    let store = Store::open(&options.database).await?;
    let local = options.address.ip().is_loopback();
    let keys = options.keys.unwrap_or(!local);
    let guarded = keys && store.has_keys().await?;
    if !local && !guarded {
        return Err(ServiceError::Open(options.address));
    }
    let app = app(store.clone(), options.limits, keys);
    let listener = tokio::net::TcpListener::bind(options.address).await;
    let listener = listener.map_err(|e| ServiceError::Listen(options.address, e))?;
    let address = listener.local_addr()?;
    let (stop, stopped) = watch::channel(false);
    let workers = (options.workers.slots > 0)
        .then(|| tokio::spawn(work(store.clone(), options.workers, app.wake.clone(), stopped.clone())));
    tracing::info!(%address, keys, slots = options.workers.slots, "serving");
    ready(address);
    let server = tokio::spawn(listen::listen(listener, router(app), stopped));
    asked_to_stop().await;
    tracing::info!("stopping: jobs are handed back");
    let _ = stop.send(true);
    if let Some(workers) = workers {
        let _ = workers.await;
    }
    let _ = server.await;
    store.close().await;
    Ok(())
}

/// Works on the jobs of a database until the process is asked to stop.
pub async fn serve_jobs(database: &str, options: WorkerOptions) -> Result<(), ServiceError> {
    recorder();
    let store = Store::open(database).await?;
    let (stop, stopped) = watch::channel(false);
    tracing::info!(slots = options.slots, "working");
    let workers = tokio::spawn(work(store.clone(), options, Arc::new(Notify::new()), stopped));
    asked_to_stop().await;
    tracing::info!("stopping: jobs are handed back");
    let _ = stop.send(true);
    let _ = workers.await;
    store.close().await;
    Ok(())
}

/// Waits for Ctrl-C or, from a service manager, for SIGTERM.
async fn asked_to_stop() {
    let interrupted = async {
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    #[cfg(unix)]
    let terminated = async {
        match tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()) {
            Ok(mut signal) => {
                signal.recv().await;
            }
            Err(_) => std::future::pending().await,
        }
    };
    #[cfg(not(unix))]
    let terminated = std::future::pending::<()>();
    tokio::select! {
        () = interrupted => {}
        () = terminated => {}
    }
}

//! Workers: as many jobs at a time as there are slots, each with a lease that is prolonged while it runs.
//!
//! A process that is asked to stop hands its jobs back: their searches go on elsewhere from the last design that was accepted.

mod one;
mod progress;

use super::store::{Fence, Store, new_id};
use one::{Handles, Stop, run};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::sync::{Notify, Semaphore, watch};
use tokio::task::JoinSet;

/// How workers work.
#[derive(Debug, Clone, Copy)]
pub struct WorkerOptions {
    /// Jobs at a time.
    pub slots: usize,
    /// How long a job stays with a worker of which nothing is heard.
    pub lease: Duration,
    /// How long a job may take.
    pub wall_time: Duration,
    /// How long to wait before looking for jobs of other processes again.
    pub poll: Duration,
    /// How long a stopping process waits for its computations to come to a safe place.
    pub grace: Duration,
}

impl Default for WorkerOptions {
    fn default() -> Self {
        Self {
            slots: 2,
            lease: Duration::from_secs(15),
            wall_time: Duration::from_secs(3600),
            poll: Duration::from_millis(500),
            grace: Duration::from_secs(20),
        }
    }
}

/// Jobs that run here, by id and attempt.
type Running = Arc<Mutex<HashMap<(String, i64), Handles>>>;

fn open(running: &Running) -> MutexGuard<'_, HashMap<(String, i64), Handles>> {
    running.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Works until `stop` says so; `wake` tells of new jobs of this process.
pub async fn work(store: Store, options: WorkerOptions, wake: Arc<Notify>, mut stop: watch::Receiver<bool>) {
    // A name of its own at every start: leases of an earlier life run out by themselves.
    let name = new_id();
    let running = Running::default();
    let heart = tokio::spawn(beat(store.clone(), name.clone(), options, running.clone()));
    let slots = Arc::new(Semaphore::new(options.slots.max(1)));
    let mut jobs = JoinSet::new();
    while !*stop.borrow() {
        while jobs.try_join_next().is_some() {}
        let slot = tokio::select! {
            slot = slots.clone().acquire_owned() => slot,
            _ = stop.changed() => break,
        };
        let Ok(slot) = slot else { break };
        match store.claim(&name, options.lease).await {
            Ok(Some(claim)) => {
                let (handles, key) = (Handles::default(), (claim.fence.id.clone(), claim.fence.attempt));
                open(&running).insert(key.clone(), handles.clone());
                let (store, running, wall_time) = (store.clone(), running.clone(), options.wall_time);
                jobs.spawn(async move {
                    run(store, claim, handles, wall_time).await;
                    open(&running).remove(&key);
                    drop(slot);
                });
            }
            nothing => {
                drop(slot);
                if let Err(e) = nothing {
                    tracing::warn!("no job could be asked for: {e}");
                }
                tokio::select! {
                    () = wake.notified() => {}
                    () = tokio::time::sleep(options.poll) => {}
                    _ = stop.changed() => {}
                }
            }
        }
    }
    hand_over(&store, &name, options.grace, &running, jobs).await;
    heart.abort();
}

/// Stops all jobs that run here and puts them back into the queue.
async fn hand_over(store: &Store, name: &str, grace: Duration, running: &Running, mut jobs: JoinSet<()>) {
    open(running).values().for_each(|handles| handles.stop(Stop::HandBack));
    let all = async { while jobs.join_next().await.is_some() {} };
    if tokio::time::timeout(grace, all).await.is_ok() {
        return;
    }
    let left: Vec<(String, i64)> = open(running).keys().cloned().collect();
    for (id, attempt) in left {
        let fence = Fence { id, worker: name.to_owned(), attempt };
        match store.hand_back(&fence).await {
            Ok(_) => tracing::info!(job = fence.id, "handed back, its computation is left behind"),
            Err(e) => tracing::error!(job = fence.id, "not handed back, its lease has to run out: {e}"),
        }
    }
}

/// Prolongs leases, hears of jobs that are to end or are others', and looks after jobs whose worker is gone.
async fn beat(store: Store, name: String, options: WorkerOptions, running: Running) {
    let every = (options.lease / 10).min(Duration::from_secs(1)).max(Duration::from_millis(50));
    let mut ticks = tokio::time::interval(every);
    ticks.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        ticks.tick().await;
        match store.sweep().await {
            Ok((0, 0)) => {}
            Ok((again, lost)) => tracing::warn!(again, lost, "jobs whose worker is gone"),
            Err(e) => tracing::warn!("lost jobs could not be looked for: {e}"),
        }
        // Jobs that were claimed after this moment are not in the answer.
        let known: Vec<((String, i64), Handles)> =
            open(&running).iter().map(|(k, h)| (k.clone(), h.clone())).collect();
        if known.is_empty() {
            continue;
        }
        match store.beat(&name, options.lease).await {
            Ok(mine) => {
                for ((id, attempt), handles) in known {
                    match mine.iter().find(|(i, a, _)| *i == id && *a == attempt) {
                        Some((.., false)) => {}
                        Some((.., true)) => handles.stop(Stop::Asked),
                        None => handles.stop(Stop::Lost),
                    }
                }
            }
            Err(e) => tracing::warn!("leases could not be prolonged: {e}"),
        }
    }
}

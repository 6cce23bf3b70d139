//! News of a computation on its way to the store: told by the computing thread, written by another.

use crate::run::{Event, Pace, Progress};
use crate::service::job::JobProgress;
use crate::service::store::{Fence, NewEvent, Store};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender};

/// Writes of the progress of one job come no faster.
const PACE: Duration = Duration::from_millis(300);
/// Events of one job that are kept; a computation that tells more tells it to nobody.
const MOST_EVENTS: usize = 5000;

/// One piece of news: how far the job is, and the event that said so.
pub(super) struct News {
    progress: JobProgress,
    event: Option<NewEvent>,
}

/// The end that the computation tells.
pub(super) struct Teller {
    to: UnboundedSender<News>,
    state: Mutex<Told>,
}

struct Told {
    progress: JobProgress,
    events: usize,
    pace: Pace,
}

impl Teller {
    /// For a search to a tolerance.
    pub fn new(to: UnboundedSender<News>, tolerance: f64) -> Self {
        let told = Told { progress: JobProgress::default(), events: 0, pace: Pace::new(tolerance) };
        Self { to, state: Mutex::new(told) }
    }
}

impl Told {
    fn take(&mut self, event: &Event) -> Option<&'static str> {
        self.pace.watch(event);
        let p = &mut self.progress;
        p.seconds_left = self.pace.left_s();
        match event {
            Event::Stage { name } => {
                p.stage = Some(name.clone());
                Some("stage")
            }
            Event::Part { done, total } => {
                p.stage = Some(format!("{done} of {total} runs are done"));
                Some("stage")
            }
            Event::Simulated { simulations, .. } => {
                p.simulations = *simulations;
                None
            }
            Event::Film { min_thickness_um } => {
                p.min_film_thickness_um = Some(*min_thickness_um);
                None
            }
            Event::Iteration(i) => {
                p.iteration = Some(i.iteration);
                p.objective_w = Some(i.objective_w);
                p.violation = Some(i.violation);
                p.kkt = i.kkt.is_finite().then_some(i.kkt);
                p.simulations = p.simulations.max(i.simulations);
                Some("iteration")
            }
        }
    }
}

impl Progress for Teller {
    fn tell(&self, event: &Event) {
        let mut told = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let kind = told.take(event).filter(|_| told.events < MOST_EVENTS);
        let event = kind.map(|kind| {
            told.events += 1;
            NewEvent { kind, data: serde_json::to_string(&told.progress).unwrap_or_default() }
        });
        // Nobody listens any more only when the job is over.
        let _ = self.to.send(News { progress: told.progress.clone(), event });
    }
}

/// The end that writes, until the computation has told all.
pub(super) async fn write(store: Store, fence: Fence, mut from: UnboundedReceiver<News>) {
    while let Some(first) = from.recv().await {
        let (mut news, until) = (vec![first], tokio::time::Instant::now() + PACE);
        // What comes within the pace is written together; the end of a job waits for nothing.
        while let Ok(Some(next)) = tokio::time::timeout_at(until, from.recv()).await {
            news.push(next);
        }
        let events: Vec<NewEvent> = news.iter_mut().filter_map(|n| n.event.take()).collect();
        if !events.is_empty()
            && let Err(e) = store.note(&fence, &events).await
        {
            tracing::warn!(job = fence.id, "its events were not kept: {e}");
        }
        if let Some(last) = news.last()
            && let Err(e) = store.tell(&fence, &last.progress).await
        {
            tracing::warn!(job = fence.id, "its progress was not kept: {e}");
        }
    }
}

//! News of a job as server-sent events: everything so far, then everything new, then the end.

use super::App;
use super::extract::Place;
use super::guard::Owner;
use super::jobs::find;
use super::problem::{AnyProblem, Missing, Problem};
use super::view::JobView;
use axum::Extension;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::sse::{Event, KeepAlive, Sse};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::time::Duration;
use tokio_stream::Stream;
use utoipa::{IntoParams, ToSchema};

/// How often the store is looked at for news of one stream.
const PACE: Duration = Duration::from_millis(300);

/// Where a stream goes on.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
#[expect(dead_code, reason = "describes a parameter; none is made of it")]
pub struct LastEvent {
    /// Number of the last event that was received.
    #[param(rename = "Last-Event-ID", required = false, minimum = 0)]
    last_event_id: i64,
}

/// One event of the stream.
#[derive(Debug, Serialize, Deserialize, ToSchema)]
pub struct SentEvent {
    /// Number; progress in between and the end have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// "stage", "iteration", "progress", "end" or "problem".
    pub event: String,
    /// JSON: a `JobProgress`; with "end" a `JobView`, with "problem" a `Problem`.
    pub data: String,
}

/// A stream on its way.
struct Following {
    app: App,
    owner: Owner,
    id: String,
    last: i64,
    /// What is sent next.
    waiting: VecDeque<Event>,
    /// Progress that was told last.
    told: Option<String>,
    over: bool,
}

/// News of a job: `stage` and `iteration` with the progress at that moment, `progress` in between, and `end` with the job when it is
/// over, after which the stream ends. A client that lost the connection sends `Last-Event-ID` and misses nothing.
#[utoipa::path(
    get, path = "/v1/jobs/{id}/events", tag = "jobs",
    params(
        ("id" = String, Path, description = "Job"),
        LastEvent
    ),
    responses(
        (status = 200, description = "Events", content_type = "text/event-stream", body = SentEvent), Missing, AnyProblem
    )
)]
pub async fn events(
    State(app): State<App>,
    Extension(owner): Extension<Owner>,
    Place(id): Place<String>,
    headers: HeaderMap,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>>>, Problem> {
    find(&app, &owner, &id).await?;
    let number = |text: &str| text.parse::<i64>().ok().filter(|n| *n >= 0);
    let last = match headers.get("last-event-id").map(|v| v.to_str().ok().and_then(number)) {
        None => 0,
        Some(Some(last)) => last,
        Some(None) => {
            return Err(Problem::unreadable("The header Last-Event-ID must be a number, 0 or more."));
        }
    };
    let following = Following { app, owner, id, last, waiting: VecDeque::new(), told: None, over: false };
    let stream = futures(following);
    Ok(Sse::new(stream).keep_alive(KeepAlive::new().interval(Duration::from_secs(15))))
}

fn futures(following: Following) -> impl Stream<Item = Result<Event, Infallible>> {
    let (to, from) = tokio::sync::mpsc::channel(16);
    tokio::spawn(async move {
        let mut following = following;
        while let Some(event) = following.next().await {
            // Nobody listens any more.
            if to.send(Ok(event)).await.is_err() {
                break;
            }
        }
    });
    tokio_stream::wrappers::ReceiverStream::new(from)
}

impl Following {
    async fn next(&mut self) -> Option<Event> {
        loop {
            if let Some(event) = self.waiting.pop_front() {
                return Some(event);
            }
            if self.over {
                return None;
            }
            if let Err(problem) = self.look().await {
                let data = serde_json::to_string(&problem).unwrap_or_default();
                self.over = true;
                return Some(Event::default().event("problem").data(data));
            }
            if self.waiting.is_empty() {
                tokio::time::sleep(PACE).await;
            }
        }
    }

    /// Looks for news. The job is read before its events, so none of them is missed when it is over.
    async fn look(&mut self) -> Result<(), Problem> {
        let job = find(&self.app, &self.owner, &self.id).await?;
        let rows = self.app.store.events(&self.id, self.last).await?;
        let more = rows.len() >= 1000;
        for row in rows {
            self.last = row.number;
            let event = Event::default().id(row.number.to_string()).event(row.kind).data(row.data);
            self.waiting.push_back(event);
        }
        if job.state.is_over() && !more {
            self.over = true;
            let data = serde_json::to_string(&JobView::from(job)).unwrap_or_default();
            self.waiting.push_back(Event::default().event("end").data(data));
            return Ok(());
        }
        let progress = job.progress.map(|p| serde_json::to_string(&p).unwrap_or_default());
        if let Some(text) = progress.filter(|text| self.told.as_ref() != Some(text)) {
            if self.waiting.is_empty() {
                self.waiting.push_back(Event::default().event("progress").data(text.clone()));
            }
            self.told = Some(text);
        }
        Ok(())
    }
}

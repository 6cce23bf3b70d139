//! Connections: as many as there may be, each closed when nothing is heard of it.

use axum::Router;
use axum::extract::ConnectInfo;
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use hyper_util::server::conn::auto::Builder;
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::{Semaphore, watch};
use tower::ServiceExt;

/// Connections at the same time; more wait.
const CONNECTIONS: usize = 2000;
/// How long a connection may take to send the head of a request.
const HEAD: Duration = Duration::from_secs(20);
/// How long open requests may go on when the service stops.
const FAREWELL: Duration = Duration::from_secs(5);
/// How long to wait where the system has no connection to give.
const BREATH: Duration = Duration::from_millis(100);

/// Serves connections until `stop` says so, and those that are open for a moment longer.
pub(super) async fn listen(listener: TcpListener, router: Router, mut stop: watch::Receiver<bool>) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut builder = Builder::new(TokioExecutor::new());
    builder.http1().timer(TokioTimer::new()).header_read_timeout(HEAD);
    builder.http2().timer(TokioTimer::new()).keep_alive_interval(HEAD);
    let open = GracefulShutdown::new();
    loop {
        let next = async {
            let place = places.clone().acquire_owned().await;
            (place, listener.accept().await)
        };
        let (place, accepted) = tokio::select! {
            next = next => next,
            _ = stop.wait_for(|stop| *stop) => break,
        };
        let (stream, remote): (_, SocketAddr) = match accepted {
            Ok(found) => found,
            Err(e) => {
                tracing::warn!("a connection was not taken: {e}");
                tokio::time::sleep(BREATH).await;
                continue;
            }
        };
        let service =
            router.clone().map_request(move |mut request: hyper::Request<hyper::body::Incoming>| {
                request.extensions_mut().insert(ConnectInfo(remote));
                request.map(axum::body::Body::new)
            });
        let builder = builder.clone();
        let connection =
            builder.serve_connection_with_upgrades(TokioIo::new(stream), TowerToHyperService::new(service));
        let connection = open.watch(connection.into_owned());
        tokio::spawn(async move {
            if let Err(e) = connection.await {
                tracing::debug!("a connection ended: {e}");
            }
            drop(place);
        });
    }
    // Streams of events would stay open as long as their jobs.
    let _ = tokio::time::timeout(FAREWELL, open.shutdown()).await;
}

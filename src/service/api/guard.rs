//! Who asks: a key in the request, unless keys are off; and how often.
//!
//! A key comes as `Authorization: Bearer KEY`, or as the password of `Authorization: Basic`, which clients that know only an address
//! can write into it (`http://key:KEY@HOST/`).

use super::App;
use super::problem::Problem;
use crate::service::store::Store;
use axum::extract::{ConnectInfo, Request, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use governor::clock::{Clock, DefaultClock};
use governor::{Quota, RateLimiter};
use std::net::SocketAddr;
use std::num::NonZeroU32;
use std::sync::Arc;

/// Base 64 (RFC 4648), padded or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Whose jobs a request sees.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Owner {
    /// Id of the key; "local" where none is needed.
    pub id: String,
    /// Address of the caller, if known.
    pub remote: Option<String>,
}

type Limiter = RateLimiter<String, governor::state::keyed::DefaultKeyedStateStore<String>, DefaultClock>;

/// The guard.
#[derive(Clone)]
pub struct Guard {
    store: Store,
    keys: bool,
    limiter: Option<Arc<Limiter>>,
}

impl Guard {
    /// For a service.
    pub fn new(app: &App) -> Self {
        let per_second = app.limits.requests_per_s.and_then(NonZeroU32::new);
        let limiter = per_second.map(|n| Arc::new(RateLimiter::keyed(Quota::per_second(n))));
        Self { store: app.store.clone(), keys: app.keys, limiter }
    }

    async fn owner(&self, headers: &HeaderMap, remote: Option<String>) -> Result<Owner, Problem> {
        if !self.keys {
            if !names_this_machine(headers) {
                let problem = Problem::new(StatusCode::FORBIDDEN, "wrong-host", "Not under this name");
                return Err(problem.detail(
                    "Without keys this service answers only to localhost and to addresses of this machine; ask for keys \
                     with --keys to use another name.",
                ));
            }
            return Ok(Owner { id: "local".to_owned(), remote });
        }
        let problem = |title: &'static str| {
            Problem::new(StatusCode::UNAUTHORIZED, "no-valid-key", title)
                .detail("Send a key as Authorization: Bearer KEY; 'stribeck key create NAME' makes one.")
        };
        let Some(secret) = secret(headers) else { return Err(problem("A key is needed")) };
        match self.store.key_of(&secret).await? {
            Some(id) => Ok(Owner { id, remote }),
            None => Err(problem("The key is not valid")),
        }
    }

    fn in_rate(&self, who: &str) -> Result<(), Problem> {
        let Some(limiter) = &self.limiter else { return Ok(()) };
        let Err(early) = limiter.check_key(&who.to_owned()) else { return Ok(()) };
        let wait = early.wait_time_from(DefaultClock::default().now());
        let seconds = u32::try_from(wait.as_secs() + 1).unwrap_or(u32::MAX);
        let problem = Problem::new(StatusCode::TOO_MANY_REQUESTS, "too-many-requests", "Too many requests");
        Err(problem.detail("Ask less often; a batch submits many jobs at once.").retry_after(seconds))
    }
}

/// Lets a request through with its owner.
pub async fn guard(State(guard): State<Guard>, mut request: Request, next: Next) -> Response {
    let address = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|c| c.0.ip().to_string());
    let who = address.clone().unwrap_or_default();
    // Guesses at keys are counted by address, everything else by key.
    let owner = match guard.owner(request.headers(), address).await {
        Ok(owner) => owner,
        Err(problem) => return guard.in_rate(&who).err().unwrap_or(problem).into_response(),
    };
    if let Err(problem) = guard.in_rate(&owner.id) {
        return problem.into_response();
    }
    request.extensions_mut().insert(owner);
    next.run(request).await
}

/// Whether a request without a key was meant for this machine: a page of somebody else's whose name was made to lead here was not.
fn names_this_machine(headers: &HeaderMap) -> bool {
    let Some(host) = headers.get(header::HOST) else { return true };
    let host = host.to_str().unwrap_or("");
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or(""),
        None => host.rsplit_once(':').map_or(host, |(name, _)| name),
    };
    name.eq_ignore_ascii_case("localhost") || name.parse::<std::net::IpAddr>().is_ok()
}

fn secret(headers: &HeaderMap) -> Option<String> {
    let value = headers.get(header::AUTHORIZATION)?.to_str().ok()?;
    let (scheme, rest) = value.split_once(' ')?;
    match scheme.to_ascii_lowercase().as_str() {
        "bearer" => Some(rest.trim().to_owned()),
        "basic" => {
            let text = String::from_utf8(BASE64.decode(rest.trim()).ok()?).ok()?;
            Some(text.split_once(':')?.1.to_owned())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{names_this_machine, secret};
    use axum::http::{HeaderMap, HeaderValue, header};

    #[test]
    fn without_keys_only_names_of_this_machine_are_answered() {
        let of = |text: &'static str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::HOST, HeaderValue::from_static(text));
            names_this_machine(&headers)
        };
        assert!(names_this_machine(&HeaderMap::new()));
        for host in ["localhost", "LOCALHOST:8080", "127.0.0.1:8080", "[::1]:8080", "10.0.0.7"] {
            assert!(of(host), "{host}");
        }
        for host in ["evil.example", "localhost.evil.example:8080", "127.0.0.1.evil.example", ""] {
            assert!(!of(host), "{host}");
        }
    }

    #[test]
    fn keys_are_read_from_both_forms() {
        let of = |text: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::AUTHORIZATION, HeaderValue::from_str(text).unwrap());
            secret(&headers)
        };
        assert_eq!(of("Bearer abc").as_deref(), Some("abc"));
        assert_eq!(of("Basic a2V5OmFiYw==").as_deref(), Some("abc"));
        assert_eq!(of("Basic a2V5OmFiYw").as_deref(), Some("abc"));
        assert_eq!(of("Basic ????"), None);
        assert_eq!(of("Digest x"), None);
    }
}

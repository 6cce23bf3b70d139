//! What the service remembers: jobs with their events, files and checkpoints, keys, and who did what. One SQL for a file (SQLite) and a
//! server (PostgreSQL).
//!
//! The row of a job is its place in the queue. A worker *claims* it with a lease; everything it writes later names the worker and the
//! attempt, so a worker that lost its lease changes nothing any more and a job that ran twice ends once. Leases are prolonged while
//! the work goes on; what nobody prolonged is *swept* back into the queue, or ends as lost after its last attempt.
//!
//! Why no job queue crate: with the best of them (apalis 1.0) a job is two rows in two tables, a crash in mid-job is retried without
//! limit, a running job can neither be cancelled nor handed back, and a panic leaves it running for ever; each of these would have to
//! be mended in tables of one's own, which is what stands here.
//!
//! SQLite writes through one connection, so nothing ever waits for a lock; readers have their own.

mod events;
mod files;
mod jobs;
mod keys;
mod queue;

pub use events::{EventRow, NewEvent};
pub use jobs::{JobFilter, NewJob, Submitted};
pub use keys::{ApiKey, KeyRow};
pub use queue::{Claim, Ending, Fence};

use crate::service::job::Job;
use sqlx::any::{AnyConnectOptions, AnyPoolOptions};
use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::{AnyPool, Executor, SqlSafeStr};
use std::str::FromStr;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use thiserror::Error;

/// Connections that read a file at the same time.
const READERS: u32 = 4;
/// Connections to a server.
const CONNECTIONS: u32 = 16;
/// How soon it answers if it is well.
const PROMPT: Duration = Duration::from_secs(2);
/// How long a request waits for a connection.
const PATIENCE: Duration = Duration::from_secs(15);

/// The database did not do what it was asked.
#[derive(Debug, Error)]
pub enum StoreError {
    /// It could not be reached, or refused a statement.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// Its tables could not be made or are of another version.
    #[error("database tables: {0}")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// The address is not one of a database.
    #[error("\"{0}\" is no database: give postgres://USER:PASSWORD@HOST/NAME, or sqlite:FILE")]
    Address(String),
    /// It takes too long.
    #[error("database: no answer in time")]
    Slow,
    /// Its file was removed or replaced.
    #[error("database: the file {0} was removed or replaced; start again")]
    Gone(String),
}

/// Milliseconds since 1970.
pub fn now_ms() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_millis()).unwrap_or(i64::MAX)
}

/// A new id that sorts behind those made before.
pub fn new_id() -> String {
    uuid::Uuid::now_v7().to_string()
}

/// The database.
#[derive(Debug, Clone)]
pub struct Store {
    read: AnyPool,
    write: AnyPool,
    server: bool,
    /// The file, and which one it was when it was opened.
    file: Option<(std::path::PathBuf, u64)>,
}

/// Which file stands at a path; the same number means the same file.
fn identity(path: &std::path::Path) -> Option<u64> {
    let found = std::fs::metadata(path).ok()?;
    #[cfg(unix)]
    return Some(std::os::unix::fs::MetadataExt::ino(&found));
    #[cfg(not(unix))]
    Some(u64::from(found.is_file()))
}

/// Makes the file of a database that is not there yet, for its owner only: hashes of keys stand in it.
fn prepare(path: &std::path::Path) {
    let mut options = std::fs::OpenOptions::new();
    options.create(true).append(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    // What is wrong with it, the database tells.
    let _ = options.open(path);
}

impl Store {
    /// Opens a database by its address and brings its tables up to date.
    pub async fn open(address: &str) -> Result<Self, StoreError> {
        sqlx::any::install_default_drivers();
        let server = address.starts_with("postgres://") || address.starts_with("postgresql://");
        let path = address.strip_prefix("sqlite:").map(|path| path.trim_start_matches("//").to_owned());
        let address = match &path {
            Some(path) if path.is_empty() || path.contains([':', '?']) => {
                return Err(StoreError::Address(address.to_owned()));
            }
            Some(path) => {
                prepare(path.as_ref());
                format!("sqlite:{path}?mode=rwc")
            }
            None if server => address.to_owned(),
            None => return Err(StoreError::Address(address.to_owned())),
        };
        let options = AnyConnectOptions::from_str(&address)?;
        let pool = |most: u32| {
            AnyPoolOptions::new().max_connections(most).acquire_timeout(PATIENCE).after_connect(
                move |connection, _| {
                    Box::pin(async move {
                        if !server {
                            let calm = "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; \
                                        PRAGMA busy_timeout = 15000; PRAGMA foreign_keys = ON;";
                            connection.execute(calm).await?;
                        }
                        Ok(())
                    })
                },
            )
        };
        let write = pool(if server { CONNECTIONS } else { 1 });
        let write = if server { write } else { write.before_acquire(|c, _| Box::pin(is_clean(c))) };
        let write = write.connect_with(options.clone()).await?;
        migrations().run(&write).await?;
        let read = if server { write.clone() } else { pool(READERS).connect_with(options).await? };
        let file = path.map(std::path::PathBuf::from);
        let file = file.and_then(|path| identity(&path).map(|id| (path, id)));
        Ok(Self { read, write, server, file })
    }

    /// Whether it answers, soon and from the place it was opened at.
    pub async fn ping(&self) -> Result<(), StoreError> {
        let asked = sqlx::query("SELECT 1").execute(&self.read);
        let Ok(answer) = tokio::time::timeout(PROMPT, asked).await else { return Err(StoreError::Slow) };
        answer?;
        match &self.file {
            Some((path, id)) if identity(path) != Some(*id) => {
                Err(StoreError::Gone(path.display().to_string()))
            }
            _ => Ok(()),
        }
    }

    /// Lets go of all connections.
    pub async fn close(&self) {
        self.read.close().await;
        self.write.close().await;
    }
}

/// Whether no transaction is left over on a connection. A full disk can leave one: what is written in it would be acknowledged, and lost.
async fn is_clean(connection: &mut sqlx::AnyConnection) -> Result<bool, sqlx::Error> {
    Ok(connection.execute("BEGIN").await.is_ok() && connection.execute("ROLLBACK").await.is_ok())
}

fn migrations() -> Migrator {
    let simple = MigrationType::Simple;
    let first = Migration::new(1, "jobs".into(), simple, include_str!("schema.sql").into_sql_str(), false);
    let mut all = Migrator::with_migrations(vec![first]);
    all.dangerous_set_table_name("stribeck_migrations");
    all
}

/// A word of a row.
fn word<T: serde::de::DeserializeOwned>(text: String) -> Result<T, sqlx::Error> {
    serde_json::from_value(serde_json::Value::String(text)).map_err(|e| sqlx::Error::Decode(e.into()))
}

/// A row as a job.
fn job(row: &sqlx::any::AnyRow) -> Result<Job, sqlx::Error> {
    use sqlx::Row;
    let progress: Option<String> = row.try_get("progress")?;
    Ok(Job {
        id: row.try_get("id")?,
        owner: row.try_get("owner")?,
        kind: word(row.try_get("kind")?)?,
        state: word(row.try_get("state")?)?,
        title: row.try_get("title")?,
        study_hash: row.try_get("study_hash")?,
        created_ms: row.try_get("created_ms")?,
        started_ms: row.try_get("started_ms")?,
        finished_ms: row.try_get("finished_ms")?,
        attempts: row.try_get("attempts")?,
        cancel_requested: row.try_get::<i64, _>("cancel_requested")? != 0,
        progress: progress.and_then(|text| serde_json::from_str(&text).ok()),
        outcome: row.try_get("outcome")?,
        problem_code: row.try_get("problem_code")?,
        problem_detail: row.try_get("problem_detail")?,
    })
}

#[cfg(test)]
mod tests {
    use super::{NewJob, Store, Submitted};
    use crate::service::job::JobKind;
    use sqlx::Executor;

    #[test]
    fn a_transaction_that_was_left_open_swallows_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let address = format!("sqlite:{}", folder.path().join("jobs.db").display());
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let store = Store::open(&address).await.unwrap();
            store.write.acquire().await.unwrap().execute("BEGIN IMMEDIATE").await.unwrap();
            let job = NewJob {
                kind: JobKind::Check,
                title: "t".to_owned(),
                study: "{}".to_owned(),
                study_hash: "h".to_owned(),
                idempotency_key: None,
                request_hash: "r".to_owned(),
            };
            let Submitted::New(job) = store.submit("o", &[job]).await.unwrap().remove(0) else {
                panic!("new")
            };
            let other = Store::open(&address).await.unwrap();
            assert!(other.job("o", &job.id).await.unwrap().is_some(), "acknowledged is kept");
            other.ping().await.unwrap();
            std::fs::remove_file(folder.path().join("jobs.db")).unwrap();
            assert!(store.ping().await.unwrap_err().to_string().contains("removed"));
        });
    }

    #[test]
    fn what_is_no_database_is_told() {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        for address in ["mysql://x", "sqlite::memory:", "sqlite:", "jobs.db", "sqlite:a.db?mode=ro"] {
            let refused = runtime.block_on(Store::open(address)).unwrap_err().to_string();
            assert!(refused.contains("is no database"), "{address}: {refused}");
        }
    }
}

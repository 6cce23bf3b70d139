//! The queue: nothing is lost, nothing ends twice, whoever dies. On SQLite, and on PostgreSQL where `STRIBECK_TEST_POSTGRES` says where.

use super::common::tiny;
use std::time::Duration;
use stribeck::report::ReportFile;
use stribeck::service::store::{Ending, NewJob, Store, Submitted};
use stribeck::service::{Job, JobKind, JobProgress, JobState};

/// A server whose database is emptied by nobody: every test has a schema of its own.
pub fn postgres(schema: &str) -> Option<String> {
    let server = std::env::var("STRIBECK_TEST_POSTGRES").ok()?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        use sqlx::Executor;
        sqlx::any::install_default_drivers();
        let pool = sqlx::AnyPool::connect(&server).await.unwrap();
        let name = sqlx::AssertSqlSafe(format!("DROP SCHEMA IF EXISTS {schema} CASCADE"));
        pool.execute(name).await.unwrap();
        pool.execute(sqlx::AssertSqlSafe(format!("CREATE SCHEMA {schema}"))).await.unwrap();
    });
    let join = if server.contains('?') { '&' } else { '?' };
    Some(format!("{server}{join}options=-csearch_path%3D{schema}"))
}

/// Runs something on every database there is.
fn on_all<F: Future<Output = ()>>(schema: &str, test: impl Fn(Store) -> F) {
    let folder = tempfile::tempdir().unwrap();
    let file = format!("sqlite:{}", folder.path().join("jobs.db").display());
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
    for address in [Some(file), postgres(schema)].into_iter().flatten() {
        runtime.block_on(async {
            let store = Store::open(&address).await.unwrap();
            test(store.clone()).await;
            store.close().await;
        });
    }
}

fn new_job() -> NewJob {
    NewJob {
        kind: JobKind::Check,
        title: "t".to_owned(),
        study: tiny(),
        study_hash: "h".to_owned(),
        idempotency_key: None,
        request_hash: "r".to_owned(),
    }
}

async fn submitted(store: &Store) -> Job {
    match store.submit("o", &[new_job()]).await.unwrap().remove(0) {
        Submitted::New(job) => job,
        other => panic!("{other:?}"),
    }
}

fn success() -> Ending {
    let file = ReportFile { name: "report.json".to_owned(), text: "{\"µ\": 1}".to_owned() };
    Ending {
        state: JobState::Succeeded,
        outcome: Some("converged".to_owned()),
        problem: None,
        files: vec![file],
    }
}

const LONG: Duration = Duration::from_secs(60);
const OVER: Duration = Duration::ZERO;

async fn state(store: &Store, id: &str) -> (JobState, i64) {
    let job = store.job("o", id).await.unwrap().unwrap();
    (job.state, job.attempts)
}

#[test]
fn a_worker_that_lost_its_job_changes_nothing_any_more() {
    on_all("stribeck_fence", |store| async move {
        let id = submitted(&store).await.id;
        let first = store.claim("a", OVER).await.unwrap().unwrap();
        assert!(store.claim("b", LONG).await.unwrap().is_none(), "it is taken");
        tokio::time::sleep(Duration::from_millis(5)).await;
        assert_eq!(store.sweep().await.unwrap(), (1, 0));
        let second = store.claim("b", LONG).await.unwrap().unwrap();
        assert_eq!((first.fence.attempt, second.fence.attempt), (1, 2));
        // The first one comes late with everything it has.
        assert!(!store.finish(&first.fence, &success()).await.unwrap());
        assert!(!store.save_checkpoint(&first.fence, "search", b"old").await.unwrap());
        assert!(!store.tell(&first.fence, &JobProgress::default()).await.unwrap());
        assert!(!store.note(&first.fence, &[]).await.unwrap());
        assert!(!store.hand_back(&first.fence).await.unwrap());
        assert!(store.beat("a", LONG).await.unwrap().is_empty());
        assert_eq!(store.beat("b", LONG).await.unwrap(), [(id.clone(), 2, false)]);
        assert_eq!(state(&store, &id).await, (JobState::Running, 2));
        assert!(store.save_checkpoint(&second.fence, "search", b"\x00\xff new").await.unwrap());
        assert_eq!(store.checkpoint(&id, "search").await.unwrap().unwrap(), b"\x00\xff new");
        assert!(store.finish(&second.fence, &success()).await.unwrap());
        assert!(!store.finish(&second.fence, &success()).await.unwrap(), "it ends once");
        assert_eq!(store.file(&id, "report.json").await.unwrap().unwrap(), "{\"µ\": 1}");
        assert_eq!(store.checkpoint(&id, "search").await.unwrap(), None);
        assert_eq!(state(&store, &id).await, (JobState::Succeeded, 2));
    });
}

#[test]
fn a_job_that_takes_its_workers_down_is_given_up() {
    on_all("stribeck_lost", |store| async move {
        let id = submitted(&store).await.id;
        for attempt in 1..=3 {
            let claim = store.claim("a", OVER).await.unwrap().unwrap();
            assert_eq!(claim.fence.attempt, attempt);
            tokio::time::sleep(Duration::from_millis(5)).await;
            let wanted = if attempt < 3 { (1, 0) } else { (0, 1) };
            assert_eq!(store.sweep().await.unwrap(), wanted);
        }
        let job = store.job("o", &id).await.unwrap().unwrap();
        assert_eq!((job.state, job.problem_code.as_deref()), (JobState::Failed, Some("worker-lost")));
        assert!(store.claim("a", LONG).await.unwrap().is_none());
    });
}

#[test]
fn a_job_that_is_handed_back_was_never_begun() {
    on_all("stribeck_back", |store| async move {
        let id = submitted(&store).await.id;
        for _ in 0..10 {
            let claim = store.claim("a", LONG).await.unwrap().unwrap();
            assert!(store.hand_back(&claim.fence).await.unwrap());
            assert_eq!(state(&store, &id).await, (JobState::Queued, 0));
        }
        // Cancelled while its worker is gone: the sweep ends it.
        store.claim("a", OVER).await.unwrap().unwrap();
        store.cancel("o", &id).await.unwrap();
        tokio::time::sleep(Duration::from_millis(5)).await;
        store.sweep().await.unwrap();
        assert_eq!(state(&store, &id).await, (JobState::Cancelled, 1));
    });
}

#[test]
fn many_workers_take_every_job_once_and_in_order() {
    on_all("stribeck_many", |store| async move {
        let jobs = vec![new_job(); 200];
        let all = store.submit("o", &jobs).await.unwrap();
        let mut tasks = tokio::task::JoinSet::new();
        for w in 0..8 {
            let store = store.clone();
            tasks.spawn(async move {
                let mut mine = Vec::new();
                while let Some(claim) = store.claim(&format!("w{w}"), LONG).await.unwrap() {
                    assert!(store.finish(&claim.fence, &success()).await.unwrap());
                    mine.push(claim.fence.id);
                }
                mine
            });
        }
        let mut done = Vec::new();
        while let Some(mine) = tasks.join_next().await {
            let mine = mine.unwrap();
            assert!(mine.is_sorted(), "oldest first");
            done.extend(mine);
        }
        done.sort();
        done.dedup();
        assert_eq!(done.len(), all.len());
        let counts = store.counts().await.unwrap();
        assert_eq!(counts, [("succeeded".to_owned(), 200)]);
    });
}

//! The queue: claim, prolong, finish, hand back, sweep.
//!
//! A claim is fenced: what a worker writes names itself and the attempt, and has no effect once the job went to somebody else.

use super::{Store, StoreError, now_ms};
use crate::report::ReportFile;
use crate::service::job::{JobKind, JobProgress, JobState};
use sqlx::any::AnyArguments;
use sqlx::query::Query;
use sqlx::{Any, AnyConnection, Row};
use std::time::Duration;

/// How a job went to a worker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fence {
    /// Job.
    pub id: String,
    /// Worker.
    pub worker: String,
    /// Attempt, counted from 1.
    pub attempt: i64,
}

/// A job to be done now.
#[derive(Debug, Clone)]
pub struct Claim {
    /// By whom.
    pub fence: Fence,
    /// What to do.
    pub kind: JobKind,
    /// With which study, as JSON.
    pub study: String,
}

/// How a job ends.
#[derive(Debug, Clone)]
pub struct Ending {
    /// Its last state.
    pub state: JobState,
    /// How its study ended.
    pub outcome: Option<String>,
    /// Why it failed: a word and a sentence.
    pub problem: Option<(&'static str, String)>,
    /// Files of its result.
    pub files: Vec<ReportFile>,
}

/// Takes the oldest job that waits; what stands behind says what happens to a row that somebody else is about to take.
macro_rules! next {
    ($lock:literal) => {
        concat!(
            "UPDATE stribeck_jobs SET state = 'running', worker = $1, attempts = attempts + 1, started_ms = $2, \
             lease_until_ms = $3, progress = NULL WHERE id = (SELECT id FROM stribeck_jobs WHERE state = 'queued' \
             ORDER BY id LIMIT 1",
            $lock,
            ") RETURNING id, kind, study, attempts"
        )
    };
}

/// A change of a job that is still the worker's; the first three values are the fence.
macro_rules! fenced {
    ($set:literal) => {
        concat!(
            "UPDATE stribeck_jobs SET ",
            $set,
            " WHERE id = $1 AND worker = $2 AND attempts = $3 AND state = 'running'"
        )
    };
}

/// Such a change with its fence.
fn behind(sql: &'static str, fence: &Fence) -> Query<'static, Any, AnyArguments> {
    sqlx::query(sql).bind(fence.id.clone()).bind(fence.worker.clone()).bind(fence.attempt)
}

fn ends_ms(lease: Duration) -> i64 {
    now_ms() + i64::try_from(lease.as_millis()).unwrap_or(i64::MAX / 2)
}

impl Store {
    /// Takes the job that waits longest.
    pub async fn claim(&self, worker: &str, lease: Duration) -> Result<Option<Claim>, StoreError> {
        // Several servers may ask at once; a file has one writer.
        let sql = if self.server { next!(" FOR UPDATE SKIP LOCKED") } else { next!("") };
        let row = sqlx::query(sql)
            .bind(worker)
            .bind(now_ms())
            .bind(ends_ms(lease))
            .fetch_optional(&self.write)
            .await?;
        let Some(row) = row else { return Ok(None) };
        let kind = super::word(row.try_get("kind")?)?;
        let fence =
            Fence { id: row.try_get("id")?, worker: worker.to_owned(), attempt: row.try_get("attempts")? };
        Ok(Some(Claim { fence, kind, study: row.try_get("study")? }))
    }

    /// Prolongs all leases of a worker; returns its jobs, and which of them are asked to end.
    pub async fn beat(&self, worker: &str, lease: Duration) -> Result<Vec<(String, i64, bool)>, StoreError> {
        let sql = "UPDATE stribeck_jobs SET lease_until_ms = $1 WHERE worker = $2 AND state = 'running' \
                   RETURNING id, attempts, cancel_requested";
        let rows = sqlx::query(sql).bind(ends_ms(lease)).bind(worker).fetch_all(&self.write).await?;
        let of = |r: &sqlx::any::AnyRow| Ok((r.try_get(0)?, r.try_get(1)?, r.try_get::<i64, _>(2)? != 0));
        Ok(rows.iter().map(of).collect::<Result<_, sqlx::Error>>()?)
    }

    /// Ends a job with its files; whether it was still the worker's.
    pub async fn finish(&self, fence: &Fence, ending: &Ending) -> Result<bool, StoreError> {
        let mut tx = self.write.begin().await?;
        let sql = fenced!(
            "state = $4, outcome = $5, problem_code = $6, problem_detail = $7, finished_ms = $8, worker = NULL, \
             lease_until_ms = NULL"
        );
        let (code, detail) = ending.problem.as_ref().map(|(c, d)| (*c, d.clone())).unzip();
        let ended = behind(sql, fence)
            .bind(ending.state.as_str())
            .bind(ending.outcome.clone())
            .bind(code)
            .bind(detail)
            .bind(now_ms())
            .execute(&mut *tx)
            .await?;
        if ended.rows_affected() == 0 {
            return Ok(false);
        }
        sqlx::query("DELETE FROM stribeck_checkpoints WHERE job_id = $1")
            .bind(&fence.id)
            .execute(&mut *tx)
            .await?;
        sqlx::query("DELETE FROM stribeck_files WHERE job_id = $1").bind(&fence.id).execute(&mut *tx).await?;
        for file in &ending.files {
            let sql = "INSERT INTO stribeck_files (job_id, name, content) VALUES ($1, $2, $3)";
            sqlx::query(sql).bind(&fence.id).bind(&file.name).bind(&file.text).execute(&mut *tx).await?;
        }
        tx.commit().await?;
        Ok(true)
    }

    /// Puts a job that was begun back into the queue, as if it had not been begun.
    pub async fn hand_back(&self, fence: &Fence) -> Result<bool, StoreError> {
        let sql = fenced!("state = 'queued', attempts = attempts - 1, worker = NULL, lease_until_ms = NULL");
        Ok(behind(sql, fence).execute(&self.write).await?.rows_affected() > 0)
    }

    /// What a running job tells of itself; whether it was still the worker's.
    pub async fn tell(&self, fence: &Fence, progress: &JobProgress) -> Result<bool, StoreError> {
        let text = serde_json::to_string(progress).unwrap_or_default();
        let done = behind(fenced!("progress = $4"), fence).bind(text).execute(&self.write).await?;
        Ok(done.rows_affected() > 0)
    }

    /// Takes jobs whose worker is gone: back into the queue, or given up; returns how many of each.
    pub async fn sweep(&self) -> Result<(u64, u64), StoreError> {
        let mut tx = self.write.begin().await?;
        let now = now_ms();
        let again = "UPDATE stribeck_jobs SET state = CASE WHEN cancel_requested = 1 THEN 'cancelled' ELSE 'queued' END, \
                     finished_ms = CASE WHEN cancel_requested = 1 THEN $1 ELSE finished_ms END, \
                     worker = NULL, lease_until_ms = NULL \
                     WHERE state = 'running' AND lease_until_ms < $2 AND attempts < max_attempts";
        let again = sqlx::query(again).bind(now).bind(now).execute(&mut *tx).await?.rows_affected();
        let lost = "UPDATE stribeck_jobs SET state = 'failed', finished_ms = $1, worker = NULL, lease_until_ms = NULL, \
                    problem_code = 'worker-lost', problem_detail = \
                    'Its worker stopped in the middle of it, at every attempt. Make the study smaller, or its mesh coarser.' \
                    WHERE state = 'running' AND lease_until_ms < $2";
        let lost = sqlx::query(lost).bind(now).bind(now).execute(&mut *tx).await?.rows_affected();
        tx.commit().await?;
        Ok((again, lost))
    }

    /// Whether a job is still a worker's, in a transaction that writes for it.
    pub(super) async fn holds(tx: &mut AnyConnection, fence: &Fence) -> Result<bool, StoreError> {
        Ok(behind(fenced!("attempts = attempts"), fence).execute(tx).await?.rows_affected() > 0)
    }
}

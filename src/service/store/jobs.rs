//! Jobs: submitted, looked at, listed, cancelled, deleted.

use super::{Store, StoreError, job, new_id, now_ms};
use crate::service::job::{Job, JobKind, JobState};
use sqlx::{AnyConnection, Row};

/// A job to submit.
#[derive(Debug, Clone)]
pub struct NewJob {
    /// What to do.
    pub kind: JobKind,
    /// Title of the study.
    pub title: String,
    /// The study with all its defaults, as JSON.
    pub study: String,
    /// Its hash.
    pub study_hash: String,
    /// Word by which a repeated request is recognised.
    pub idempotency_key: Option<String>,
    /// Hash of what was asked, to tell a repeated request from another one with the same word.
    pub request_hash: String,
}

/// What became of a submission.
#[derive(Debug, Clone, PartialEq)]
pub enum Submitted {
    /// A new job.
    New(Job),
    /// The job of an earlier request with the same word.
    Known(Job),
    /// The word was used for another request.
    Reused,
}

/// Which jobs are wanted.
#[derive(Debug, Clone, Default)]
pub struct JobFilter {
    /// In this state.
    pub state: Option<JobState>,
    /// Of this kind.
    pub kind: Option<JobKind>,
    /// With this in their title.
    pub title: Option<String>,
    /// Older than this one.
    pub before: Option<String>,
    /// At most so many.
    pub limit: i64,
}

/// What a job is read from.
macro_rules! columns {
    () => {
        "id, owner, kind, state, title, study_hash, created_ms, started_ms, finished_ms, attempts, cancel_requested, \
         progress, outcome, problem_code, problem_detail"
    };
}

/// A query for jobs.
macro_rules! select {
    ($rest:literal) => {
        concat!("SELECT ", columns!(), " FROM stribeck_jobs ", $rest)
    };
}

/// Attempts after which a job that takes its worker down is given up.
const MOST_ATTEMPTS: i64 = 3;

impl Store {
    /// Adds jobs, all or none.
    pub async fn submit(&self, owner: &str, jobs: &[NewJob]) -> Result<Vec<Submitted>, StoreError> {
        let mut tx = self.write.begin().await?;
        let mut all = Vec::with_capacity(jobs.len());
        for new in jobs {
            all.push(submit_one(&mut tx, owner, new).await?);
        }
        if all.contains(&Submitted::Reused) {
            tx.rollback().await?;
            return Ok(all);
        }
        tx.commit().await?;
        Ok(all)
    }

    /// A job of an owner.
    pub async fn job(&self, owner: &str, id: &str) -> Result<Option<Job>, StoreError> {
        let found = sqlx::query(select!("WHERE id = $1 AND owner = $2"))
            .bind(id)
            .bind(owner)
            .fetch_optional(&self.read)
            .await?;
        Ok(found.as_ref().map(job).transpose()?)
    }

    /// Jobs of an owner, newest first.
    pub async fn jobs(&self, owner: &str, filter: &JobFilter) -> Result<Vec<Job>, StoreError> {
        let state = filter.state.map_or("", JobState::as_str);
        let kind = filter.kind.map_or("", JobKind::as_str);
        let title = filter.title.as_deref().unwrap_or_default().to_lowercase();
        let before = filter.before.as_deref().unwrap_or("~");
        let sql = select!(
            "WHERE owner = $1 AND id < $2 AND ($3 = '' OR state = $3) AND ($4 = '' OR kind = $4) \
             AND ($5 = '' OR lower(title) LIKE $6 ESCAPE '!') ORDER BY id DESC LIMIT $7"
        );
        let like = format!("%{}%", title.replace('!', "!!").replace('%', "!%").replace('_', "!_"));
        let rows = sqlx::query(sql)
            .bind(owner)
            .bind(before)
            .bind(state)
            .bind(kind)
            .bind(&title)
            .bind(like)
            .bind(filter.limit)
            .fetch_all(&self.read)
            .await?;
        Ok(rows.iter().map(job).collect::<Result<_, _>>()?)
    }

    /// The study of a job, as JSON.
    pub async fn study(&self, owner: &str, id: &str) -> Result<Option<String>, StoreError> {
        let sql = "SELECT study FROM stribeck_jobs WHERE id = $1 AND owner = $2";
        let row = sqlx::query(sql).bind(id).bind(owner).fetch_optional(&self.read).await?;
        Ok(row.map(|r| r.try_get(0)).transpose()?)
    }

    /// Asks a job to end: a waiting one does at once, a running one when its worker hears of it.
    pub async fn cancel(&self, owner: &str, id: &str) -> Result<Option<Job>, StoreError> {
        let sql = "UPDATE stribeck_jobs SET cancel_requested = 1, \
                   state = CASE WHEN state = 'queued' THEN 'cancelled' ELSE state END, \
                   finished_ms = CASE WHEN state = 'queued' THEN $1 ELSE finished_ms END \
                   WHERE id = $2 AND owner = $3 AND state IN ('queued', 'running')";
        sqlx::query(sql).bind(now_ms()).bind(id).bind(owner).execute(&self.write).await?;
        self.job(owner, id).await
    }

    /// Removes a job that is over and all that belongs to it; whether there was one.
    pub async fn delete(&self, owner: &str, id: &str) -> Result<bool, StoreError> {
        let mut tx = self.write.begin().await?;
        let sql =
            "DELETE FROM stribeck_jobs WHERE id = $1 AND owner = $2 AND state NOT IN ('queued', 'running')";
        let gone = sqlx::query(sql).bind(id).bind(owner).execute(&mut *tx).await?.rows_affected() > 0;
        if gone {
            for sql in [
                "DELETE FROM stribeck_events WHERE job_id = $1",
                "DELETE FROM stribeck_files WHERE job_id = $1",
                "DELETE FROM stribeck_checkpoints WHERE job_id = $1",
            ] {
                sqlx::query(sql).bind(id).execute(&mut *tx).await?;
            }
        }
        tx.commit().await?;
        Ok(gone)
    }

    /// Jobs of an owner that wait or run.
    pub async fn open_jobs(&self, owner: &str) -> Result<i64, StoreError> {
        let sql = "SELECT COUNT(*) FROM stribeck_jobs WHERE owner = $1 AND state IN ('queued', 'running')";
        Ok(sqlx::query(sql).bind(owner).fetch_one(&self.read).await?.try_get(0)?)
    }

    /// How many jobs are in each state.
    pub async fn counts(&self) -> Result<Vec<(String, i64)>, StoreError> {
        let sql = "SELECT state, COUNT(*) FROM stribeck_jobs GROUP BY state";
        let rows = sqlx::query(sql).fetch_all(&self.read).await?;
        Ok(rows.iter().map(|r| Ok((r.try_get(0)?, r.try_get(1)?))).collect::<Result<_, sqlx::Error>>()?)
    }
}

async fn submit_one(tx: &mut AnyConnection, owner: &str, new: &NewJob) -> Result<Submitted, StoreError> {
    let (id, now) = (new_id(), now_ms());
    let sql = concat!(
        "INSERT INTO stribeck_jobs (id, owner, kind, state, title, study, study_hash, idempotency_key, request_hash, \
         created_ms, attempts, max_attempts, cancel_requested) \
         VALUES ($1, $2, $3, 'queued', $4, $5, $6, $7, $8, $9, 0, $10, 0) ON CONFLICT DO NOTHING RETURNING ",
        columns!()
    );
    let added = sqlx::query(sql)
        .bind(id)
        .bind(owner)
        .bind(new.kind.as_str())
        .bind(&new.title)
        .bind(&new.study)
        .bind(&new.study_hash)
        .bind(new.idempotency_key.as_deref())
        .bind(&new.request_hash)
        .bind(now)
        .bind(MOST_ATTEMPTS)
        .fetch_optional(&mut *tx)
        .await?;
    if let Some(row) = added {
        return Ok(Submitted::New(job(&row)?));
    }
    let sql = concat!(
        "SELECT request_hash, ",
        columns!(),
        " FROM stribeck_jobs WHERE owner = $1 AND idempotency_key = $2"
    );
    let key = new.idempotency_key.as_deref();
    let row = sqlx::query(sql).bind(owner).bind(key).fetch_one(&mut *tx).await?;
    match row.try_get::<String, _>("request_hash")? == new.request_hash {
        true => Ok(Submitted::Known(job(&row)?)),
        false => Ok(Submitted::Reused),
    }
}

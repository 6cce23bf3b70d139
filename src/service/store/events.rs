//! What happened to a job, in order.

use super::{Fence, Store, StoreError, now_ms};
use sqlx::Row;

/// Something that happened.
#[derive(Debug, Clone, PartialEq)]
pub struct NewEvent {
    /// "stage", "iteration" or "state".
    pub kind: &'static str,
    /// JSON.
    pub data: String,
}

/// The same with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct EventRow {
    /// Counted from 1.
    pub number: i64,
    /// When, ms since 1970.
    pub at_ms: i64,
    /// Kind.
    pub kind: String,
    /// JSON.
    pub data: String,
}

impl Store {
    /// Notes events of a running job; whether it was still the worker's.
    pub async fn note(&self, fence: &Fence, events: &[NewEvent]) -> Result<bool, StoreError> {
        let mut tx = self.write.begin().await?;
        if !Self::holds(&mut tx, fence).await? {
            return Ok(false);
        }
        let sql = "SELECT COALESCE(MAX(number), 0) FROM stribeck_events WHERE job_id = $1";
        let last: i64 = sqlx::query(sql).bind(&fence.id).fetch_one(&mut *tx).await?.try_get(0)?;
        for (event, number) in events.iter().zip(last + 1..) {
            let sql =
                "INSERT INTO stribeck_events (job_id, number, at_ms, kind, data) VALUES ($1, $2, $3, $4, $5)";
            sqlx::query(sql)
                .bind(&fence.id)
                .bind(number)
                .bind(now_ms())
                .bind(event.kind)
                .bind(&event.data)
                .execute(&mut *tx)
                .await?;
        }
        tx.commit().await?;
        Ok(true)
    }

    /// Events of a job behind a number.
    pub async fn events(&self, id: &str, after: i64) -> Result<Vec<EventRow>, StoreError> {
        let sql = "SELECT number, at_ms, kind, data FROM stribeck_events WHERE job_id = $1 AND number > $2 \
                   ORDER BY number LIMIT 1000";
        let rows = sqlx::query(sql).bind(id).bind(after).fetch_all(&self.read).await?;
        let of = |r: &sqlx::any::AnyRow| {
            Ok(EventRow {
                number: r.try_get(0)?,
                at_ms: r.try_get(1)?,
                kind: r.try_get(2)?,
                data: r.try_get(3)?,
            })
        };
        Ok(rows.iter().map(of).collect::<Result<_, sqlx::Error>>()?)
    }
}

//! Files of results, and checkpoints of searches on their way.

use super::{Fence, Store, StoreError};
use sqlx::Row;

impl Store {
    /// Names and sizes (characters) of the files of a job.
    pub async fn file_names(&self, id: &str) -> Result<Vec<(String, i64)>, StoreError> {
        let sql = "SELECT name, CAST(LENGTH(content) AS BIGINT) FROM stribeck_files WHERE job_id = $1 ORDER BY name";
        let rows = sqlx::query(sql).bind(id).fetch_all(&self.read).await?;
        Ok(rows.iter().map(|r| Ok((r.try_get(0)?, r.try_get(1)?))).collect::<Result<_, sqlx::Error>>()?)
    }

    /// A file of a job.
    pub async fn file(&self, id: &str, name: &str) -> Result<Option<String>, StoreError> {
        let sql = "SELECT content FROM stribeck_files WHERE job_id = $1 AND name = $2";
        let row = sqlx::query(sql).bind(id).bind(name).fetch_optional(&self.read).await?;
        Ok(row.map(|r| r.try_get(0)).transpose()?)
    }

    /// What a search saved under a name.
    pub async fn checkpoint(&self, id: &str, name: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let sql = "SELECT content FROM stribeck_checkpoints WHERE job_id = $1 AND name = $2";
        let row = sqlx::query(sql).bind(id).bind(name).fetch_optional(&self.read).await?;
        Ok(row.map(|r| r.try_get(0)).transpose()?)
    }

    /// Replaces it; whether the job was still the worker's.
    pub async fn save_checkpoint(&self, fence: &Fence, name: &str, what: &[u8]) -> Result<bool, StoreError> {
        let mut tx = self.write.begin().await?;
        if !Self::holds(&mut tx, fence).await? {
            return Ok(false);
        }
        let sql = "INSERT INTO stribeck_checkpoints (job_id, name, content) VALUES ($1, $2, $3) \
                   ON CONFLICT (job_id, name) DO UPDATE SET content = excluded.content";
        sqlx::query(sql).bind(&fence.id).bind(name).bind(what.to_vec()).execute(&mut *tx).await?;
        tx.commit().await?;
        Ok(true)
    }
}

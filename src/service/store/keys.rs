//! Keys of those who may ask, of which only hashes are kept, and the log of what they did.

use super::{Store, StoreError, new_id, now_ms};
use crate::study::{hex, sha256};
use sqlx::Row;
use subtle::ConstantTimeEq;

/// A new key, told once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ApiKey {
    /// What is shown in lists and owns jobs.
    pub id: String,
    /// What a request carries: `stribeck_ID_SECRET`.
    pub secret: String,
}

/// A key as it is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyRow {
    /// Id.
    pub id: String,
    /// Whose it is.
    pub name: String,
    /// When it was made, ms since 1970.
    pub created_ms: i64,
    /// When it was taken back.
    pub revoked_ms: Option<i64>,
}

impl Store {
    /// Makes a key.
    pub async fn new_key(&self, name: &str) -> Result<ApiKey, StoreError> {
        let id = uuid::Uuid::now_v7().simple().to_string();
        let random: [u8; 32] = rand::random();
        let secret = format!("stribeck_{id}_{}", hex(&random));
        let sql = "INSERT INTO stribeck_keys (id, name, hash, created_ms) VALUES ($1, $2, $3, $4)";
        sqlx::query(sql)
            .bind(&id)
            .bind(name)
            .bind(sha256(&secret))
            .bind(now_ms())
            .execute(&self.write)
            .await?;
        self.audit("operator", &format!("create key {id}"), None, None).await?;
        Ok(ApiKey { id, secret })
    }

    /// All keys, oldest first.
    pub async fn keys(&self) -> Result<Vec<KeyRow>, StoreError> {
        let sql = "SELECT id, name, created_ms, revoked_ms FROM stribeck_keys ORDER BY id";
        let rows = sqlx::query(sql).fetch_all(&self.read).await?;
        let of = |r: &sqlx::any::AnyRow| {
            Ok(KeyRow {
                id: r.try_get(0)?,
                name: r.try_get(1)?,
                created_ms: r.try_get(2)?,
                revoked_ms: r.try_get(3)?,
            })
        };
        Ok(rows.iter().map(of).collect::<Result<_, sqlx::Error>>()?)
    }

    /// Takes a key back; whether there was one.
    pub async fn revoke_key(&self, id: &str) -> Result<bool, StoreError> {
        let sql = "UPDATE stribeck_keys SET revoked_ms = $1 WHERE id = $2 AND revoked_ms IS NULL";
        let done = sqlx::query(sql).bind(now_ms()).bind(id).execute(&self.write).await?.rows_affected() > 0;
        if done {
            self.audit("operator", &format!("revoke key {id}"), None, None).await?;
        }
        Ok(done)
    }

    /// Whether any key is valid.
    pub async fn has_keys(&self) -> Result<bool, StoreError> {
        Ok(self.keys().await?.iter().any(|k| k.revoked_ms.is_none()))
    }

    /// The id of a key, if it is valid. Hashes are compared in a time that does not depend on where they differ.
    pub async fn key_of(&self, secret: &str) -> Result<Option<String>, StoreError> {
        let Some((id, _)) = secret.strip_prefix("stribeck_").and_then(|rest| rest.split_once('_')) else {
            return Ok(None);
        };
        let sql = "SELECT hash FROM stribeck_keys WHERE id = $1 AND revoked_ms IS NULL";
        let row = sqlx::query(sql).bind(id).fetch_optional(&self.read).await?;
        let Some(row) = row else { return Ok(None) };
        let kept: String = row.try_get(0)?;
        let same = bool::from(kept.as_bytes().ct_eq(sha256(secret).as_bytes()));
        Ok(same.then(|| id.to_owned()))
    }

    /// Notes who did what.
    pub async fn audit(
        &self,
        owner: &str,
        action: &str,
        job_id: Option<&str>,
        remote: Option<&str>,
    ) -> Result<(), StoreError> {
        let sql = "INSERT INTO stribeck_audit (id, at_ms, owner, action, job_id, remote) VALUES ($1, $2, $3, $4, $5, $6)";
        sqlx::query(sql)
            .bind(new_id())
            .bind(now_ms())
            .bind(owner)
            .bind(action)
            .bind(job_id)
            .bind(remote)
            .execute(&self.write)
            .await?;
        Ok(())
    }

    /// The last entries of the log, newest first: when, who, what, which job.
    pub async fn audited(
        &self,
        limit: i64,
    ) -> Result<Vec<(i64, String, String, Option<String>)>, StoreError> {
        let sql = "SELECT at_ms, owner, action, job_id FROM stribeck_audit ORDER BY id DESC LIMIT $1";
        let rows = sqlx::query(sql).bind(limit).fetch_all(&self.read).await?;
        let of = |r: &sqlx::any::AnyRow| Ok((r.try_get(0)?, r.try_get(1)?, r.try_get(2)?, r.try_get(3)?));
        Ok(rows.iter().map(of).collect::<Result<_, sqlx::Error>>()?)
    }
}

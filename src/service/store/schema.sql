-- One schema for SQLite and PostgreSQL. Times are milliseconds since 1970; ids are UUIDs of version 7, which sort by age.

CREATE TABLE stribeck_jobs (
    id TEXT PRIMARY KEY,
    owner TEXT NOT NULL,
    kind TEXT NOT NULL,
    state TEXT NOT NULL,
    title TEXT NOT NULL,
    study TEXT NOT NULL,
    study_hash TEXT NOT NULL,
    idempotency_key TEXT,
    request_hash TEXT NOT NULL,
    created_ms BIGINT NOT NULL,
    started_ms BIGINT,
    finished_ms BIGINT,
    attempts BIGINT NOT NULL,
    max_attempts BIGINT NOT NULL,
    worker TEXT,
    lease_until_ms BIGINT,
    cancel_requested BIGINT NOT NULL,
    progress TEXT,
    outcome TEXT,
    problem_code TEXT,
    problem_detail TEXT
);
CREATE UNIQUE INDEX stribeck_jobs_idempotency ON stribeck_jobs (owner, idempotency_key);
CREATE INDEX stribeck_jobs_state ON stribeck_jobs (state, id);
CREATE INDEX stribeck_jobs_owner ON stribeck_jobs (owner, id);
CREATE INDEX stribeck_jobs_owner_state ON stribeck_jobs (owner, state);

CREATE TABLE stribeck_events (
    job_id TEXT NOT NULL,
    number BIGINT NOT NULL,
    at_ms BIGINT NOT NULL,
    kind TEXT NOT NULL,
    data TEXT NOT NULL,
    PRIMARY KEY (job_id, number)
);

CREATE TABLE stribeck_files (
    job_id TEXT NOT NULL,
    name TEXT NOT NULL,
    content TEXT NOT NULL,
    PRIMARY KEY (job_id, name)
);

CREATE TABLE stribeck_checkpoints (
    job_id TEXT NOT NULL,
    name TEXT NOT NULL,
    content BYTEA NOT NULL,
    PRIMARY KEY (job_id, name)
);

CREATE TABLE stribeck_keys (
    id TEXT PRIMARY KEY,
    name TEXT NOT NULL,
    hash TEXT NOT NULL,
    created_ms BIGINT NOT NULL,
    revoked_ms BIGINT
);

CREATE TABLE stribeck_audit (
    id TEXT PRIMARY KEY,
    at_ms BIGINT NOT NULL,
    owner TEXT NOT NULL,
    action TEXT NOT NULL,
    job_id TEXT,
    remote TEXT
);
CREATE INDEX stribeck_audit_time ON stribeck_audit (at_ms);

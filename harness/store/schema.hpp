#pragma once

namespace loopbench {

/// Raised when a table or column changes its meaning; stored as SQLite's user_version.
inline constexpr int kSchemaVersion = 3;

/// Creates the tables of a store. Readable with any SQLite tool.
inline constexpr const char* kSchema = R"sql(
  CREATE TABLE run (key TEXT PRIMARY KEY, value TEXT NOT NULL);
  CREATE TABLE cell (
    id INTEGER PRIMARY KEY,            -- position in the sweep
    sequence TEXT NOT NULL,            -- label of the dataset entry
    repeat INTEGER NOT NULL,           -- instance of a seeded dataset, from 0
    method TEXT NOT NULL,              -- label of the method entry
    dataset_options TEXT NOT NULL,     -- those that differ from the defaults
    method_options TEXT NOT NULL,
    closures TEXT NOT NULL,            -- where the loop closures were taken from
    oracle_closures INTEGER NOT NULL,  -- 1: they were measured in the reference
    oracle_method INTEGER NOT NULL,    -- 1: the method was shown the reference
    runs INTEGER NOT NULL,             -- timed runs of the method's verb
    seconds_median REAL NOT NULL,
    seconds_min REAL NOT NULL,
    seconds_max REAL NOT NULL,
    status TEXT NOT NULL,              -- ok | declined | failed | incomplete
    why TEXT NOT NULL);
  CREATE TABLE score (
    cell INTEGER NOT NULL REFERENCES cell(id),
    protocol TEXT NOT NULL,            -- name (changes), for example: evo (align=se3)
    protocol_version TEXT NOT NULL,    -- of the original tool that was followed
    times TEXT NOT NULL,               -- keyframes | dense
    metric TEXT NOT NULL,
    relation TEXT NOT NULL,
    axis TEXT NOT NULL,
    unit TEXT NOT NULL,                -- of every statistic but count and sse (its square)
    count INTEGER NOT NULL,
    rmse REAL NOT NULL, mean REAL NOT NULL, median REAL NOT NULL, std REAL NOT NULL,
    min REAL NOT NULL, max REAL NOT NULL, sse REAL NOT NULL,
    pairs INTEGER NOT NULL,            -- pose pairs judged
    possible INTEGER NOT NULL,         -- pose pairs that could have been judged
    span REAL NOT NULL,                -- judged time over the reference's duration, 0..1
    status TEXT NOT NULL,
    why TEXT NOT NULL);
  CREATE TABLE phase (cell INTEGER NOT NULL REFERENCES cell(id), name TEXT, seconds REAL);
  CREATE TABLE count (cell INTEGER NOT NULL REFERENCES cell(id), name TEXT, value REAL);
  CREATE TABLE note (cell INTEGER NOT NULL REFERENCES cell(id), text TEXT);
  CREATE INDEX score_cell ON score(cell);
)sql";

}  // namespace loopbench

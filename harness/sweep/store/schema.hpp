/// Tables of a store.
#pragma once

#include <string>

#include "metrics/numerics/statistics.hpp"

namespace loopbench::harness {

/// Incremented when the meaning of a table or column changes; stored as SQLite's user_version.
inline constexpr int kSchemaVersion = 17;

/// The columns of statistics but count: "rmse,", with texts before and after each name, in one
/// line, or percentiles after `gap`.
inline std::string statistic_columns(const std::string& before,
                                     const std::string& after,
                                     const std::string& gap = " ") {
  std::string out;
  double last_share = 0.0;
  for (const auto& [name, member, share] : metrics::kStatisticFields) {
    if (!out.empty()) out += share > 0.0 && last_share == 0.0 ? gap : " ";
    last_share = share;
    out += before + name + after;
  }
  return out;
}

/// Creates the tables of a store, readable with any SQLite tool.
inline const std::string kSchema = R"sql(
  CREATE TABLE run (                   -- config and settings of the last run
    key TEXT PRIMARY KEY,
    value TEXT NOT NULL,
    row_hash INTEGER NOT NULL);        -- of the other columns, as in the next tables
  CREATE TABLE provenance (            -- build and machine of the cells
    provenance_key TEXT NOT NULL,      -- hash of all key-value pairs of one run
    key TEXT NOT NULL,
    value TEXT NOT NULL,               -- can be a list, one item per line
    row_hash INTEGER NOT NULL,
    PRIMARY KEY (provenance_key, key)) WITHOUT ROWID;
  CREATE TABLE input (                 -- input files of each sequence
    sequence_key TEXT NOT NULL,
    number INTEGER NOT NULL,           -- order of reading
    option TEXT NOT NULL,              -- dataset option with its name; '': found by the dataset
    path TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    hash TEXT NOT NULL,                -- of the content (XXH3, 128 bits), or `missing`
    row_hash INTEGER NOT NULL,
    PRIMARY KEY (sequence_key, number)) WITHOUT ROWID;
  CREATE TABLE sequence (              -- metadata and sizes of each sequence
    sequence_key TEXT PRIMARY KEY,     -- hash of configuration_hash, content of inputs, build
    configuration_hash TEXT NOT NULL,  -- of the dataset's name, all options, group
    options TEXT NOT NULL,             -- dataset: all options including defaults
    keyframes INTEGER NOT NULL,
    odometry INTEGER NOT NULL,         -- edges
    closures INTEGER NOT NULL,
    frames INTEGER NOT NULL,           -- tracked between keyframes
    reference INTEGER NOT NULL,        -- number of reference poses
    content TEXT NOT NULL,             -- hash of problem and reference; '': unknown
    group_name TEXT NOT NULL           -- runs of one group are not independent; '': none
    ) WITHOUT ROWID;
  CREATE TABLE cell (
    id INTEGER PRIMARY KEY,            -- column `cell` of the other tables
    position INTEGER,                  -- in the sweep; NULL: not in the current config
    key TEXT NOT NULL,                 -- hash of input bytes, options, protocols, method and build
    build TEXT NOT NULL,               -- of the program that computed it
    sequence_key TEXT NOT NULL,        -- key of table sequence
    provenance_key TEXT NOT NULL,      -- key of table provenance
    sequence TEXT NOT NULL,            -- label of the dataset entry
    repeat INTEGER NOT NULL,           -- instance of a seeded dataset, from 0
    method TEXT NOT NULL,              -- label of the method entry
    dataset_options TEXT NOT NULL,     -- options that differ from the defaults
    method_options TEXT NOT NULL,
    closures TEXT NOT NULL,            -- source of the loop closures
    oracle_closures INTEGER NOT NULL,  -- 1: measured in or selected by the reference
    oracle INTEGER NOT NULL,           -- 1: the method uses or was trained on the reference
    worker TEXT NOT NULL,              -- isolated | in process, with ", serial", ", pinned"
    runs INTEGER NOT NULL,             -- timed runs of the method
    seconds_median REAL NOT NULL,      -- wall time of one run
    seconds_min REAL NOT NULL,
    seconds_max REAL NOT NULL,
    cpu_seconds_median REAL,           -- CPU time of the process; NULL: unknown
    cpu_seconds_min REAL,
    cpu_variation REAL,                -- standard deviation by mean of the runs; NULL: one run
    waiting REAL,                      -- share of their wall time without a processor, 0..1
    peak_memory INTEGER,               -- largest resident size of the process [bytes]
    added_memory INTEGER,              -- increase of the resident size [bytes]
    status TEXT NOT NULL,              -- ok | declined | incomplete; failed | crashed | timeout |
                                       -- out_of_memory
    signal TEXT NOT NULL,              -- for example SIGSEGV; empty: not ended by a signal
    why TEXT NOT NULL,
    failed_scores INTEGER NOT NULL,    -- number of failed scores
    scores INTEGER NOT NULL,           -- number of its rows in score_value
    trace_hash INTEGER NOT NULL,       -- of its rows in trace, snapshot and pose_value
    hash INTEGER NOT NULL);            -- of this row, its sequence, and its rows in score_value,
                                       -- phase, count, note and section
  CREATE TABLE score_definition (      -- what a score is; cells share definitions
    id INTEGER PRIMARY KEY,            -- hash of the other columns: equal in all stores
    protocol TEXT NOT NULL,            -- name (changes), for example: evo (align=se3)
    protocol_version TEXT NOT NULL,    -- version of the original tool
    times TEXT NOT NULL,               -- keyframes | dense
    metric TEXT NOT NULL,              -- catalogue name
    label TEXT NOT NULL,               -- label in the config; default: the name
    relation TEXT NOT NULL,            -- empty if the metric failed or was declined
    axis TEXT NOT NULL,
    unit TEXT NOT NULL,                -- of all statistics but count; sse: squared
    better TEXT NOT NULL,              -- lower | higher | target | neither
    target REAL NOT NULL);             -- best value if better is target
  CREATE TABLE score_value (           -- one row per score; the view `score` adds its definition
    cell INTEGER NOT NULL REFERENCES cell(id),
    number INTEGER NOT NULL,           -- of the score in its cell, from 0
    definition INTEGER NOT NULL REFERENCES score_definition(id),
    count INTEGER,                     -- these eight are NULL if the status is not ok or incomplete
    )sql" + statistic_columns("", " REAL,", "\n    ") +
                                   R"sql(
    pairs INTEGER NOT NULL,            -- evaluated pose pairs
    possible INTEGER NOT NULL,         -- possible pose pairs
    span REAL NOT NULL,                -- evaluated share of the reference's time, 0..1
    status TEXT NOT NULL,              -- ok | declined | incomplete | failed | out_of_memory
    why TEXT NOT NULL,
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE VIEW score AS
    SELECT v.cell, d.protocol, d.protocol_version, d.times, d.metric, d.label, d.relation, d.axis,
      d.unit, d.better, d.target, v.count, )sql" +
                                   statistic_columns("v.", ",", "\n      ") +
                                   R"sql( v.pairs, v.possible, v.span, v.status, v.why, v.number
    FROM score_value v JOIN score_definition d ON d.id = v.definition;
  CREATE TABLE phase (                 -- reported by the method, as are the next three
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    name TEXT NOT NULL, seconds REAL NOT NULL,
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE count (
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    name TEXT NOT NULL, value REAL NOT NULL,
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE note (
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    text TEXT NOT NULL,
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE section (               -- sections of the path
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    kind TEXT NOT NULL,                -- segment, window, ...
    begin_stamp REAL NOT NULL,         -- [s]
    end_stamp REAL NOT NULL,           -- [s]
    what TEXT NOT NULL,                -- choice of the method; can be empty
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE trace (                 -- blobs: float32, little endian, see harness/sweep/model/trace.hpp
    cell INTEGER PRIMARY KEY REFERENCES cell(id),
    times TEXT NOT NULL,               -- keyframes | dense
    samples BLOB NOT NULL);            -- TraceSample, 12 floats each, under the first protocol
  CREATE TABLE pose_value (            -- of a metric, for each sample of the trace
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    name TEXT NOT NULL, unit TEXT NOT NULL,
    value BLOB NOT NULL,               -- float32
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE sequence_trace (
    sequence_key TEXT PRIMARY KEY,
    origin_stamp REAL NOT NULL,        -- stamps are relative to it [s]
    origin_x REAL NOT NULL,            -- in the reference's world frame [m]; positions are
                                       -- relative to it
    origin_y REAL NOT NULL,
    origin_z REAL NOT NULL,
    reference BLOB NOT NULL,           -- TracePose, 8 floats each
    keyframes BLOB NOT NULL,           -- TracePose, in the tracker's world frame
    closures BLOB NOT NULL,            -- TraceClosure, 8 floats each
    ledger TEXT NOT NULL,              -- what the closures state about each other: a sentence, then
                                       -- the lines of `loops --csv`
    row_hash INTEGER NOT NULL);
  CREATE INDEX cell_position ON cell(position);
)sql";

// Hashes do not cover the ids of cells, so that another store can number its cells differently.

/// A table with rows of cells, with the column `cell` first.
struct CellTable {
  const char* name;
  bool is_trace = false;  ///< covered by `trace_hash`, otherwise by `hash`
};
inline constexpr const char* kScoreTable = "score_value";
inline constexpr CellTable kCellTables[] = {{kScoreTable},
                                            {"phase"},
                                            {"count"},
                                            {"note"},
                                            {"section"},
                                            {"trace", true},
                                            {"pose_value", true}};

/// Columns of the table cell between `id` and `hash`.
inline constexpr const char* kCellColumns =
    "position, key, build, cell.sequence_key, provenance_key, cell.sequence, repeat, method, "
    "dataset_options, method_options, cell.closures, oracle_closures, oracle, worker, runs, "
    "seconds_median, seconds_min, seconds_max, cpu_seconds_median, cpu_seconds_min, cpu_variation, "
    "waiting, peak_memory, added_memory, "
    "status, signal, why, failed_scores, scores, trace_hash";

/// A cell's row and that of its sequence, which `hash` covers.
inline constexpr const char* kCellsWithSequences = "cell LEFT JOIN sequence USING (sequence_key)";
inline constexpr const char* kSequenceColumns =
    "sequence.sequence_key, configuration_hash, options, keyframes, odometry, sequence.closures, "
    "frames, reference, content, group_name";

/// A table with rows that cells share, with its key as first column and `row_hash` as last.
struct SharedTable {
  const char* name;
  const char* key;
};
inline constexpr SharedTable kRunTable{"run", "key"};
inline constexpr SharedTable kProvenanceTable{"provenance", "provenance_key"};
inline constexpr SharedTable kInputTable{"input", "sequence_key"};
inline constexpr SharedTable kSequenceTraceTable{"sequence_trace", "sequence_key"};

}  // namespace loopbench::harness

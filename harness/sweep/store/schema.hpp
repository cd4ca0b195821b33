/// Tables of a store.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "harness/sweep/model/cell_fields.hpp"
#include "metrics/numerics/statistics.hpp"

namespace loopbench::harness {

/// Incremented when the meaning of a table or column changes; stored as SQLite's user_version.
inline constexpr int kSchemaVersion = 20;

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

/// The type of a column in SQL.
inline std::string sql_type(bool) { return "INTEGER NOT NULL"; }
inline std::string sql_type(std::int64_t) { return "INTEGER NOT NULL"; }
inline std::string sql_type(double) { return "REAL NOT NULL"; }
inline std::string sql_type(Status) { return "TEXT NOT NULL"; }
inline std::string sql_type(const SharedText&) { return "TEXT NOT NULL"; }
inline std::string sql_type(std::optional<double>) { return "REAL"; }
inline std::string sql_type(std::optional<std::int64_t>) { return "INTEGER"; }

/// The columns of fields(CellRow&), each with its type and meaning.
inline std::string cell_column_definitions() {
  std::string out;
  CellRow none;
  fields(none, [&](const CellField& column, const auto& value) {
    std::string line = std::string(column.name) + " " + sql_type(value) + ",";
    if (column.meaning[0] != '\0') {
      constexpr std::size_t kMeaning = 35;  // column of the comments
      line.resize(std::max(kMeaning, line.size() + 1), ' ');
      line += std::string("-- ") + column.meaning;
    }
    out += line + "\n    ";
  });
  return out;
}

/// Their names, separated by commas.
inline std::string cell_column_names() {
  std::string out;
  CellRow none;
  fields(none, [&](const CellField& column, const auto&) {
    out += (out.empty() ? "cell." : ", cell.") + std::string(column.name);
  });
  return out;
}

/// Creates the tables of a store, readable with any SQLite tool.
inline const std::string kSchema =
    R"sql(
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
    group_name TEXT NOT NULL,          -- runs of one group are not independent; '': none
    group_kind TEXT NOT NULL,          -- none | source | named | files
    recording TEXT NOT NULL            -- equal for runs of one recording; '': unknown
    ) WITHOUT ROWID;
  CREATE TABLE cell (
    id INTEGER PRIMARY KEY,            -- column `cell` of the other tables
    position INTEGER,                  -- in the sweep; NULL: not in the current config
    key TEXT NOT NULL,                 -- hash of input bytes, options, protocols, method and build
    build TEXT NOT NULL,               -- of the program that computed it
    sequence_key TEXT NOT NULL,        -- key of table sequence
    provenance_key TEXT NOT NULL,      -- key of table provenance
    notes_key TEXT NOT NULL,           -- key of table sequence_note; '': no notes
    notes INTEGER NOT NULL,            -- number of its rows there
    )sql" +
    cell_column_definitions() +
    R"sql(failed_scores INTEGER NOT NULL,    -- number of failed scores
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
    )sql" +
    statistic_columns("", " REAL,", "\n    ") +
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
  CREATE TABLE note (                  -- of the cell, and of its method
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    text TEXT NOT NULL,                -- the next columns as a sentence
    kind TEXT NOT NULL,                -- low_coverage, time_offset, ...: harness/sweep/model/note.hpp
    severity TEXT NOT NULL,            -- info | caution | decisive (can change a conclusion)
    subject TEXT NOT NULL,             -- file, closure or edge; '': the run, or the cell
    numbers TEXT NOT NULL,             -- JSON: [{"name": "bias", "value": 5.1, "unit": "%"}, ...]
    remedy_option TEXT NOT NULL,       -- an option that removes the cause, or words; '': none
    remedy_value TEXT NOT NULL,
    detail TEXT NOT NULL,              -- words of a dataset or method; evidence of a finding
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE sequence_note (         -- of the input of cells under their protocols
    notes_key TEXT NOT NULL,           -- hash of the notes, which cells share
    number INTEGER NOT NULL,
    text TEXT NOT NULL, kind TEXT NOT NULL, severity TEXT NOT NULL, subject TEXT NOT NULL,
    numbers TEXT NOT NULL, remedy_option TEXT NOT NULL, remedy_value TEXT NOT NULL,
    detail TEXT NOT NULL,
    row_hash INTEGER NOT NULL,
    PRIMARY KEY (notes_key, number)) WITHOUT ROWID;
  CREATE TABLE section (               -- sections of the path
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    kind TEXT NOT NULL,                -- segment, window, ...
    begin_stamp REAL NOT NULL,         -- [s]
    end_stamp REAL NOT NULL,           -- [s]
    what TEXT NOT NULL,                -- choice of the method; can be empty
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE trace (                 -- blobs: packed columns, see harness/sweep/model/trace.hpp
    cell INTEGER PRIMARY KEY REFERENCES cell(id),
    times TEXT NOT NULL,               -- keyframes | dense
    samples BLOB NOT NULL);            -- TraceSample, 9 columns, 4096 steps; first protocol
  CREATE TABLE pose_value (            -- of a metric, for each sample of the trace
    cell INTEGER NOT NULL REFERENCES cell(id), number INTEGER NOT NULL,
    name TEXT NOT NULL, unit TEXT NOT NULL,
    value BLOB NOT NULL,               -- a packed column, 4096 steps
    PRIMARY KEY (cell, number)) WITHOUT ROWID;
  CREATE TABLE sequence_trace (
    sequence_key TEXT PRIMARY KEY,
    origin_stamp REAL NOT NULL,        -- stamps are relative to it [s]
    origin_x REAL NOT NULL,            -- in the reference's world frame [m]; positions are
                                       -- relative to it
    origin_y REAL NOT NULL,
    origin_z REAL NOT NULL,
    reference BLOB NOT NULL,           -- TracePose, 5 columns, 65534 steps
    keyframes BLOB NOT NULL,           -- TracePose, likewise, in the tracker's world frame
    closures BLOB NOT NULL,            -- TraceClosure, 8 float32 each
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
inline const std::string kCellColumns =
    "position, key, build, cell.sequence_key, provenance_key, notes_key, notes, " +
    cell_column_names() + ", failed_scores, scores, trace_hash";

/// A cell's row and that of its sequence, which `hash` covers.
inline constexpr const char* kCellsWithSequences = "cell LEFT JOIN sequence USING (sequence_key)";
inline constexpr const char* kSequenceColumns =
    "sequence.sequence_key, configuration_hash, options, keyframes, odometry, sequence.closures, "
    "frames, reference, content, group_name, group_kind, recording";

/// A table with rows that cells share, with its key as first column and `row_hash` as last.
struct SharedTable {
  const char* name;
  const char* key;
};
inline constexpr SharedTable kRunTable{"run", "key"};
inline constexpr SharedTable kProvenanceTable{"provenance", "provenance_key"};
inline constexpr SharedTable kInputTable{"input", "sequence_key"};
inline constexpr SharedTable kSequenceNoteTable{"sequence_note", "notes_key"};
inline constexpr SharedTable kSequenceTraceTable{"sequence_trace", "sequence_key"};

}  // namespace loopbench::harness

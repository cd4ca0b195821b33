#pragma once

namespace loopbench::harness {

/// Incremented when a table or column changes its meaning; stored as SQLite's user_version.
inline constexpr int kSchemaVersion = 6;

/// Creates the tables of a store, readable with any SQLite tool.
inline constexpr const char* kSchema = R"sql(
  CREATE TABLE run (key TEXT PRIMARY KEY, value TEXT NOT NULL);  -- what was asked for last
  CREATE TABLE provenance (            -- by what cells were made
    made TEXT NOT NULL,                -- hash of all pairs of key and value that go together
    key TEXT NOT NULL,
    value TEXT NOT NULL,               -- may be a list, one item a line
    PRIMARY KEY (made, key)) WITHOUT ROWID;
  CREATE TABLE input (                 -- every file that a sequence was read from
    sequence_key TEXT NOT NULL,
    number INTEGER NOT NULL,           -- order of reading
    option TEXT NOT NULL,              -- dataset option that names it; '': found by the dataset
    path TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    hash TEXT NOT NULL,                -- of the content (MurmurHash3 x64 128), or `missing`
    PRIMARY KEY (sequence_key, number)) WITHOUT ROWID;
  CREATE TABLE sequence (              -- what it is, and how much of it a method is given
    sequence_key TEXT PRIMARY KEY,     -- hash of asked, of the content of its inputs and the build
    asked TEXT NOT NULL,               -- hash of a dataset's name and of all its options, and group
    options TEXT NOT NULL,             -- dataset: all of its options, defaults included
    keyframes INTEGER NOT NULL,
    odometry INTEGER NOT NULL,         -- edges
    closures INTEGER NOT NULL,
    frames INTEGER NOT NULL,           -- tracked between keyframes
    reference INTEGER NOT NULL,        -- poses the judge has
    content TEXT NOT NULL,             -- hash of problem and reference as loaded; '': not known
    group_name TEXT NOT NULL,          -- runs of one group are not independent; '': its own
    input_digest TEXT NOT NULL DEFAULT '',   -- of its rows in input
    trace_digest TEXT NOT NULL DEFAULT '',   -- of its row in sequence_trace
    digest TEXT NOT NULL DEFAULT ''          -- of this row
    ) WITHOUT ROWID;
  CREATE TABLE cell (
    id INTEGER PRIMARY KEY,            -- what other tables call cell
    position INTEGER,                  -- in the sweep; NULL: the config asks for it no more
    key TEXT NOT NULL,                 -- hash of input bytes, options, protocols, method and build
    build TEXT NOT NULL,               -- of the program that made it
    sequence_key TEXT NOT NULL,        -- its sequence in the tables of sequences
    made TEXT NOT NULL,                -- its rows in provenance
    sequence TEXT NOT NULL,            -- label of the dataset entry
    repeat INTEGER NOT NULL,           -- instance of a seeded dataset, from 0
    method TEXT NOT NULL,              -- label of the method entry
    dataset_options TEXT NOT NULL,     -- those that differ from the defaults
    method_options TEXT NOT NULL,
    closures TEXT NOT NULL,            -- where the loop closures were taken from
    oracle_closures INTEGER NOT NULL,  -- 1: measured in the reference, or selected by it
    oracle INTEGER NOT NULL,           -- 1: the method was shown the reference or trained on it
    worker TEXT NOT NULL,              -- isolated | in process, then serial, pinned where it was
    runs INTEGER NOT NULL,             -- timed runs of the method's verb
    seconds_median REAL NOT NULL,      -- wall time of one
    seconds_min REAL NOT NULL,
    seconds_max REAL NOT NULL,
    cpu_seconds_median REAL,           -- CPU time of the process meanwhile; NULL: not known
    peak_memory INTEGER,               -- largest resident size of the process meanwhile [bytes]
    added_memory INTEGER,              -- of it, beyond what the process had before [bytes]
    allocations INTEGER,               -- calls for memory in one run; NULL: not counted
    status TEXT NOT NULL,              -- ok | declined | incomplete; failed | crashed | timeout |
                                       -- out_of_memory
    signal TEXT NOT NULL,              -- SIGSEGV and the like, when one ended it
    why TEXT NOT NULL,
    failed_scores INTEGER NOT NULL,    -- rows of score that failed in any way
    score_digest TEXT NOT NULL DEFAULT '',   -- of its rows in score, and so on; '': it has none
    phase_digest TEXT NOT NULL DEFAULT '',
    count_digest TEXT NOT NULL DEFAULT '',
    note_digest TEXT NOT NULL DEFAULT '',
    section_digest TEXT NOT NULL DEFAULT '',
    trace_digest TEXT NOT NULL DEFAULT '',
    digest TEXT NOT NULL DEFAULT '');        -- of this row
  CREATE TABLE score (
    cell INTEGER NOT NULL REFERENCES cell(id),
    protocol TEXT NOT NULL,            -- name (changes), for example: evo (align=se3)
    protocol_version TEXT NOT NULL,    -- of the original tool that was followed
    times TEXT NOT NULL,               -- keyframes | dense
    metric TEXT NOT NULL,              -- catalogue name
    label TEXT NOT NULL,               -- in the config; the name unless it says otherwise
    relation TEXT NOT NULL,
    axis TEXT NOT NULL,
    unit TEXT NOT NULL,                -- of every statistic but count and sse (its square)
    better TEXT NOT NULL,              -- lower | higher | target | neither
    target REAL NOT NULL,              -- best value where better is target
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
  CREATE TABLE section (               -- stretch of the way that the method treated as one
    cell INTEGER NOT NULL REFERENCES cell(id),
    kind TEXT NOT NULL,                -- segment, window, ...
    begin_stamp REAL NOT NULL,         -- [s]
    end_stamp REAL NOT NULL,           -- [s]
    what TEXT NOT NULL);               -- chosen there, may be empty
  CREATE TABLE trace (                 -- blobs: float32, little endian, see harness/model/trace.hpp
    cell INTEGER PRIMARY KEY REFERENCES cell(id),
    times TEXT NOT NULL,               -- keyframes | dense
    samples BLOB NOT NULL);            -- TraceSample, 12 floats each, under the first protocol
  CREATE TABLE sequence_trace (
    sequence_key TEXT PRIMARY KEY,
    origin_stamp REAL NOT NULL,        -- stamps count from here [s]
    origin_x REAL NOT NULL,            -- positions in the reference's world count from here [m]
    origin_y REAL NOT NULL,
    origin_z REAL NOT NULL,
    reference BLOB NOT NULL,           -- TracePose, 8 floats each
    keyframes BLOB NOT NULL,           -- TracePose, in the tracker's own world
    closures BLOB NOT NULL);           -- TraceClosure, 8 floats each
  CREATE TABLE digest (                -- of whole tables, see harness/store/digest.hpp
    name TEXT PRIMARY KEY,             -- run, provenance; cell, sequence: sum of their digests
    value TEXT NOT NULL);
  CREATE INDEX cell_position ON cell(position);
  CREATE INDEX score_cell ON score(cell);
  CREATE INDEX phase_cell ON phase(cell);
  CREATE INDEX count_cell ON count(cell);
  CREATE INDEX note_cell ON note(cell);
  CREATE INDEX section_cell ON section(cell);
)sql";

}  // namespace loopbench::harness

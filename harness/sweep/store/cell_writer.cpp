#include "harness/sweep/store/cell_writer.hpp"

#include <algorithm>
#include <iterator>

#include "harness/sweep/model/cell_fields.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/store/note_rows.hpp"
#include "harness/sweep/store/stored_cells.hpp"
#include "harness/sweep/store/traces.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

std::string option_text(const std::vector<Choice>& stages) {
  std::string out;
  for (const Choice& stage : stages) {
    if (stage.options.empty()) continue;
    out += (out.empty() ? "" : "; ") + stage.name + ": " + to_text(stage.options);
  }
  return out;
}

std::string text_of(const Worker& worker) {
  return std::string(worker.isolated ? "isolated" : "in process") +
         (worker.serial ? ", serial" : "") + (worker.pinned ? ", pinned" : "");
}

void set_times(CellRow& row, const CellResult& result) {
  row.runs = std::ssize(result.seconds);
  if (!result.seconds.empty()) {
    row.seconds = metrics::median(result.seconds);
    row.seconds_min = std::ranges::min(result.seconds);
    row.seconds_max = std::ranges::max(result.seconds);
  }
  if (!result.cpu_seconds.empty()) {
    row.cpu_seconds = metrics::median(result.cpu_seconds);
    row.cpu_seconds_min = std::ranges::min(result.cpu_seconds);
  }
  row.cpu_variation = variation(result.cpu_seconds);
}

void bind_field(Statement& row, Status value) { row.bind(to_text(value)); }
void bind_field(Statement& row, const SharedText& value) { row.bind(value.text()); }
template <class Value>
void bind_field(Statement& row, const Value& value) {
  row.bind(value);
}

/// Inserts all columns of the table.
Statement insert_into(Database& database,
                      const std::string& table,
                      const std::string& verb = "INSERT") {
  std::string values = "?";
  for (const char c : database.columns_of(table)) values += c == ',' ? ",?" : "";
  return database.prepare(verb + " INTO " + table + " VALUES (" + values + ")");
}

}  // namespace

CellWriter::CellWriter(Database& database, std::string provenance_key)
    : database_(database),
      provenance_key_(std::move(provenance_key)),
      replaced_(database.prepare("SELECT id FROM cell WHERE position = ?")),
      cell_(insert_into(database, "cell")),
      definition_(insert_into(database, "score_definition", "INSERT OR REPLACE")),
      score_(insert_into(database, kScoreTable)),
      phase_(insert_into(database, "phase")),
      count_(insert_into(database, "count")),
      note_(insert_into(database, "note")),
      section_(insert_into(database, "section")),
      trace_(insert_into(database, "trace")),
      pose_value_(insert_into(database, "pose_value")) {}

void CellWriter::write(const CellResult& result, CellKeys& keys) {
  try {
    Transaction transaction(database_);
    write_rows(result, keys);
    transaction.commit();
  } catch (...) {
    definitions_.clear();  // rolled back
    sequences_.clear();
    notes_.clear();
    throw;
  }
}

void CellWriter::write_rows(const CellResult& result, CellKeys& keys) {
  replaced_.bind(result.cell.index);
  std::vector<std::int64_t> before;
  while (replaced_.step()) before.push_back(replaced_.integer());
  replaced_.reset();
  for (const std::int64_t id : before) remove_cell(database_, id);
  if (before.empty()) {
    set_run_value(database_, "cells", std::to_string(written_cells(database_) + 1));
  }

  if (result.metadata) write_metadata(result.cell, keys, *result.metadata);
  const std::int64_t id = write_cell(result, keys);
  write_scores(id, result, keys.sweep());
  write_report(id, result);
  write_trace(id, result.trace);
  set_hashes(database_, id);
}

void CellWriter::write_trace(std::int64_t id, const CellTrace& trace) {
  if (trace.samples.empty()) return;
  const std::string samples = packed_items(trace.samples, kDrawnSteps);
  trace_.bind(id, to_text(trace.times), Blob{samples}).run();
  std::int64_t number = 0;
  for (const TraceValues& each : trace.values) {
    const std::string values = packed_items(each.values, kDrawnSteps);
    pose_value_.bind(id, number++, each.name, each.unit, Blob{values}).run();
  }
}

void CellWriter::write_report(std::int64_t id, const CellResult& result) {
  const methods::Report& report = result.report;
  std::int64_t number = 0;
  for (const auto& [name, seconds] : report.phases) phase_.bind(id, number++, name, seconds).run();
  number = 0;
  for (const auto& [name, value] : report.counts) count_.bind(id, number++, name, value).run();
  number = 0;
  for (const std::string& words : report.notes) {
    write_note(id, number++, {.kind = NoteKind::method, .detail = words});
  }
  for (const Note& note : result.notes) write_note(id, number++, note);
  number = 0;
  for (const methods::Section& s : report.sections) {
    section_.bind(id, number++, s.kind, s.begin, s.end, s.what).run();
  }
}

std::string CellWriter::write_notes(const std::vector<Note>& notes) {
  if (notes.empty()) return "";
  Fields all;
  for (const Note& each : notes) {
    bind_note(each, text(each), [&](const auto&... values) { (all.add(values), ...); });
  }
  const std::string key = all.hashed();
  if (!notes_.insert(key).second) return key;
  Statement row = insert_into(database_, "sequence_note", "INSERT OR REPLACE");
  std::int64_t number = 0;
  for (const Note& each : notes) {
    bind_note(each, text(each), [&](const auto&... values) {
      row.bind_hashed(key, number++, values...).run();
    });
  }
  return key;
}

void CellWriter::write_note(std::int64_t id, std::int64_t number, const Note& note) {
  bind_note(
      note, text(note), [&](const auto&... values) { note_.bind(id, number, values...).run(); });
}

std::int64_t CellWriter::write_cell(const CellResult& result, CellKeys& keys) {
  const Cell& cell = result.cell;
  const DatasetChoice& dataset = keys.sweep().datasets[cell.dataset];
  const MethodChoice& method = keys.sweep().methods[cell.method];
  const SequenceMetadata none;
  const SequenceMetadata& metadata = result.metadata ? *result.metadata : none;
  CellRow row;
  static_cast<MeasuredFacts&>(row) = result;
  row.sequence = dataset.label;
  row.repeat = cell.repeat;
  row.method = method.label;
  row.parts = method.parts;
  row.dataset_options = option_text({dataset.dataset});
  row.method_options = option_text(method.stages);
  row.closures = metadata.closures;
  row.oracle_closures = metadata.oracle_closures;
  row.oracle = result.oracle_method;
  row.worker = text_of(result.worker);
  row.serial = result.worker.serial;
  row.stated_times = result.worker.stated;
  set_times(row, result);
  row.status = result.status;
  row.signal = result.signal;
  row.why = result.why;
  cell_.bind(nullptr, cell.index, keys.key(cell, metadata.inputs), keys.build());
  cell_.bind(keys.sequence_key(cell, metadata.inputs), provenance_key_);
  cell_.bind(write_notes(metadata.notes), metadata.notes.size());
  fields(row, [&](const CellField&, const auto& value) { bind_field(cell_, value); });
  cell_.bind(std::ranges::count_if(result.scores, is_failure, &ScoreResult::status));
  cell_.bind(result.scores.size(), 0, 0).run();  // see set_hashes()
  return database_.last_row();
}

std::int64_t CellWriter::definition_of(const ScoreKind& kind) {
  RowHash row;
  for (const KindField& each : kKindFields) row.add(std::string_view(kind.*each.text));
  row.add(std::string_view(to_text(kind.better)));
  row.add(kind.target);
  const std::int64_t id = definition_id(row.after(0));
  if (!definitions_.insert(id).second) return id;
  definition_.bind(id);
  for (const KindField& each : kKindFields) definition_.bind(kind.*each.text);
  definition_.bind(to_text(kind.better), kind.target).run();
  return id;
}

void CellWriter::write_scores(std::int64_t id, const CellResult& result, const Sweep& sweep) {
  std::int64_t number = 0;
  for (const ScoreResult& score : result.scores) {
    score_.bind(id, number++, definition_of(kind_of(score, sweep)));
    const metrics::Statistics& s = score.score.statistics;
    if (has_numbers(score.status)) {
      score_.bind(s.count);
      for (const auto& field : metrics::kStatisticFields) score_.bind(s.*field.member);
    } else {
      for (std::size_t i = 0; i <= std::size(metrics::kStatisticFields); ++i) score_.bind(nullptr);
    }
    const metrics::Coverage& coverage = score.coverage;
    score_.bind(coverage.pairs, coverage.possible, coverage.span);
    score_.bind(to_text(score.status), score.why).run();
  }
}

void CellWriter::write_metadata(const Cell& cell,
                                CellKeys& keys,
                                const SequenceMetadata& metadata) {
  const std::string sequence_key = keys.sequence_key(cell, metadata.inputs);
  if (!sequences_.insert(sequence_key).second) return;
  database_.prepare("DELETE FROM input WHERE sequence_key = ?").bind(sequence_key).run();
  Statement input = insert_into(database_, "input");
  std::int64_t number = 0;
  for (const InputFile& file : metadata.inputs) {
    input.bind_hashed(sequence_key, number++, file.option, file.path, file.bytes, file.hash).run();
  }
  const SequenceSize& size = metadata.size;
  insert_into(database_, "sequence", "INSERT OR REPLACE")
      .bind(sequence_key, keys.configuration_hash(cell), keys.dataset_text(cell))
      .bind(size.keyframes, size.odometry, size.closures, size.frames, size.reference)
      .bind(metadata.content, metadata.group, to_text(metadata.group_kind), metadata.recording)
      .run();
  const SequenceTrace& trace = metadata.trace;
  if (trace.keyframes.empty()) return;
  const TraceOrigin& origin = trace.origin;
  const std::string reference = packed_items(trace.reference, kFineSteps);
  const std::string keyframes = packed_items(trace.keyframes, kFineSteps);
  insert_into(database_, "sequence_trace", "INSERT OR REPLACE")
      .bind_hashed(sequence_key,
                   origin.stamp,
                   origin.x,
                   origin.y,
                   origin.z,
                   Blob{reference},
                   Blob{keyframes},
                   Blob{bytes_of(trace.closures)},
                   trace.ledger)
      .run();
}

}  // namespace loopbench::harness

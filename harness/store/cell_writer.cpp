#include "harness/store/cell_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/store/traces.hpp"
#include "harness/text/hash.hpp"
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

}  // namespace

void remove_cell(Database& database, std::int64_t id) {
  for (const char* table : {"score_value", "phase", "count", "note", "section", "trace"}) {
    database.prepare(std::string("DELETE FROM ") + table + " WHERE cell = ?").bind(id).run();
  }
  database.prepare("DELETE FROM cell WHERE id = ?").bind(id).run();
}

CellWriter::CellWriter(Database& database, std::string provenance_key)
    : database_(database),
      provenance_key_(std::move(provenance_key)),
      replaced_(database.prepare("SELECT id FROM cell WHERE position = ?")),
      cell_(database.prepare(std::string("INSERT INTO cell (") + kCellColumns +
                             ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      find_definition_(database.prepare(
          "SELECT id FROM score_definition WHERE protocol = ? AND protocol_version = ? AND times = "
          "? AND metric = ? AND label = ? AND relation = ? AND axis = ? AND unit = ? AND better = "
          "? "
          "AND target = ?")),
      definition_(
          database.prepare("INSERT INTO score_definition VALUES (NULL,?,?,?,?,?,?,?,?,?,?)")),
      score_(database.prepare("INSERT INTO score_value VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      phase_(database.prepare("INSERT INTO phase VALUES (?,?,?,?)")),
      count_(database.prepare("INSERT INTO count VALUES (?,?,?,?)")),
      note_(database.prepare("INSERT INTO note VALUES (?,?,?)")),
      section_(database.prepare("INSERT INTO section VALUES (?,?,?,?,?,?)")),
      trace_(database.prepare("INSERT INTO trace VALUES (?,?,?,?)")),
      one_more_(database.prepare("UPDATE run SET value = value + 1 WHERE key = 'cells'")),
      checksums_(database) {}

void CellWriter::write(const CellResult& result, CellKeys& keys) {
  try {
    Transaction transaction(database_);
    write_rows(result, keys);
    transaction.commit();
  } catch (...) {
    definitions_.clear();  // rolled back
    sequences_.clear();
    checksums_.forget_definitions();
    throw;
  }
}

void CellWriter::write_rows(const CellResult& result, CellKeys& keys) {
  replaced_.bind(static_cast<std::int64_t>(result.cell.index));
  std::vector<std::int64_t> before;
  while (replaced_.step()) before.push_back(replaced_.integer());
  replaced_.reset();
  for (const std::int64_t id : before) remove_cell(database_, id);
  if (before.empty()) one_more_.run();

  if (result.metadata) write_metadata(result.cell, keys, *result.metadata);
  const std::int64_t id = write_cell(result, keys);
  write_scores(id, result, keys.sweep());
  write_report(id, result.report);
  if (!result.trace.samples.empty()) {
    const std::string times = to_text(result.trace.times);
    const std::string_view samples = bytes_of(result.trace.samples);
    trace_.bind(id).bind(times).bind(checksum_of_parts({times, samples})).bind_blob(samples).run();
  }
  checksums_.write(id);
}

void CellWriter::write_report(std::int64_t id, const methods::Report& report) {
  std::int64_t number = 0;
  for (const methods::Phase& p : report.phases) {
    phase_.bind(id).bind(number++).bind(p.name).bind(p.seconds).run();
  }
  number = 0;
  for (const methods::Count& c : report.counts) {
    count_.bind(id).bind(number++).bind(c.name).bind(c.value).run();
  }
  number = 0;
  for (const std::string& text : report.notes) note_.bind(id).bind(number++).bind(text).run();
  number = 0;
  for (const methods::Section& s : report.sections) {
    section_.bind(id).bind(number++).bind(s.kind).bind(s.begin).bind(s.end).bind(s.what).run();
  }
}

std::int64_t CellWriter::write_cell(const CellResult& result, CellKeys& keys) {
  const DatasetChoice& dataset = keys.sweep().datasets[result.cell.dataset];
  const MethodChoice& method = keys.sweep().methods[result.cell.method];
  const SequenceMetadata none;
  const SequenceMetadata& metadata = result.metadata ? *result.metadata : none;
  const auto [low, high] = std::ranges::minmax_element(result.seconds);
  const bool timed = !result.seconds.empty();
  const auto cpu = result.cpu_seconds.empty()
                       ? std::nullopt
                       : std::optional<double>(metrics::median(result.cpu_seconds));
  const auto failed_scores = std::ranges::count_if(result.scores, is_failure, &ScoreResult::status);
  cell_.bind(static_cast<std::int64_t>(result.cell.index))
      .bind(keys.key(result.cell, metadata.inputs))
      .bind(keys.build())
      .bind(keys.sequence_key(result.cell, metadata.inputs))
      .bind(provenance_key_)
      .bind(dataset.label)
      .bind(std::int64_t{result.cell.repeat})
      .bind(method.label)
      .bind(option_text({dataset.dataset}))
      .bind(option_text(method.stages))
      .bind(metadata.closures)
      .bind(std::int64_t{metadata.oracle_closures})
      .bind(std::int64_t{result.oracle_method})
      .bind(text_of(result.worker))
      .bind(static_cast<std::int64_t>(result.seconds.size()))
      .bind(result.seconds.empty() ? 0.0 : metrics::median(result.seconds))
      .bind(timed ? *low : 0.0)
      .bind(timed ? *high : 0.0)
      .bind(cpu)
      .bind(result.peak_memory)
      .bind(result.added_memory)
      .bind(to_text(result.status))
      .bind(result.signal)
      .bind(result.why)
      .bind(static_cast<std::int64_t>(failed_scores))
      .run();
  return database_.last_row();
}

std::int64_t CellWriter::definition_of(const ScoreResult& score,
                                       const metrics::NamedProtocol& protocol) {
  const std::string texts[] = {protocol.label(),
                               protocol.version,
                               to_text(score.times),
                               score.metric,
                               score.label,
                               score.score.relation,
                               score.score.axis,
                               score.score.unit,
                               to_text(score.score.better)};
  Fields key;
  for (const std::string& text : texts) key.add(text);
  const auto [known, is_new] =
      definitions_.try_emplace(key.add(fmt::format("{}", score.score.target)).hashed(), 0);
  if (!is_new) return known->second;
  for (Statement* statement : {&find_definition_, &definition_}) {
    for (const std::string& text : texts) statement->bind(text);
    statement->bind(score.score.target);
  }
  if (find_definition_.step()) {
    known->second = find_definition_.integer();
    definition_.reset();
  } else {
    definition_.run();
    known->second = database_.last_row();
  }
  find_definition_.reset();
  return known->second;
}

void CellWriter::write_scores(std::int64_t id, const CellResult& result, const Sweep& sweep) {
  std::int64_t number = 0;
  for (const ScoreResult& score : result.scores) {
    score_.bind(id).bind(number++).bind(definition_of(score, sweep.protocols[score.protocol]));
    const metrics::Statistics& s = score.score.statistics;
    if (has_numbers(score.status)) {
      score_.bind(static_cast<std::int64_t>(s.count));
      for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max, s.sse}) {
        score_.bind(value);
      }
    } else {
      for (int i = 0; i < 8; ++i) score_.bind_null();
    }
    score_.bind(static_cast<std::int64_t>(score.coverage.pairs))
        .bind(static_cast<std::int64_t>(score.coverage.possible))
        .bind(score.coverage.span)
        .bind(to_text(score.status))
        .bind(score.why)
        .run();
  }
}

void CellWriter::write_metadata(const Cell& cell,
                                CellKeys& keys,
                                const SequenceMetadata& metadata) {
  const std::string sequence_key = keys.sequence_key(cell, metadata.inputs);
  if (!sequences_.insert(sequence_key).second) return;
  database_.prepare("DELETE FROM input WHERE sequence_key = ?").bind(sequence_key).run();
  Statement input = database_.prepare("INSERT INTO input VALUES (?,?,?,?,?,?)");
  std::int64_t number = 0;
  for (const InputFile& file : metadata.inputs) {
    input.bind(sequence_key)
        .bind(number++)
        .bind(file.option)
        .bind(file.path)
        .bind(static_cast<std::int64_t>(file.bytes))
        .bind(file.hash)
        .run();
  }
  const SequenceSize& size = metadata.size;
  database_
      .prepare(
          "INSERT OR REPLACE INTO sequence (sequence_key, configuration_hash, options, keyframes, "
          "odometry, closures, frames, reference, content, group_name) VALUES "
          "(?,?,?,?,?,?,?,?,?,?)")
      .bind(sequence_key)
      .bind(keys.configuration_hash(cell))
      .bind(keys.dataset_text(cell))
      .bind(size.keyframes)
      .bind(size.odometry)
      .bind(size.closures)
      .bind(size.frames)
      .bind(size.reference)
      .bind(metadata.content)
      .bind(metadata.group)
      .run();
  const SequenceTrace& trace = metadata.trace;
  if (!trace.keyframes.empty()) {
    const std::string_view blobs[] = {
        bytes_of(trace.reference), bytes_of(trace.keyframes), bytes_of(trace.closures)};
    database_.prepare("INSERT OR REPLACE INTO sequence_trace VALUES (?,?,?,?,?,?,?,?,?)")
        .bind(sequence_key)
        .bind(trace.origin.stamp)
        .bind(trace.origin.x)
        .bind(trace.origin.y)
        .bind(trace.origin.z)
        .bind_blob(blobs[0])
        .bind_blob(blobs[1])
        .bind_blob(blobs[2])
        .bind(checksum_of_parts({blobs[0], blobs[1], blobs[2]}))
        .run();
  }
}

}  // namespace loopbench::harness

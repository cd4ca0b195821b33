#include "harness/store/cell_writer.hpp"

#include <algorithm>

#include "harness/store/traces.hpp"
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
      remove_(database.prepare("SELECT id, digest FROM cell WHERE position = ?")),
      cell_(database.prepare(
          "INSERT INTO cell (position, key, build, sequence_key, provenance_key, sequence, repeat, "
          "method, dataset_options, method_options, closures, oracle_closures, oracle, worker, "
          "runs, seconds_median, "
          "seconds_min, seconds_max, cpu_seconds_median, peak_memory, added_memory, allocations, "
          "status, signal, why, failed_scores) VALUES "
          "(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      scores_(database),
      phase_(database.prepare("INSERT INTO phase VALUES (?,?,?)")),
      count_(database.prepare("INSERT INTO count VALUES (?,?,?)")),
      note_(database.prepare("INSERT INTO note VALUES (?,?)")),
      section_(database.prepare("INSERT INTO section VALUES (?,?,?,?,?)")),
      trace_(database.prepare("INSERT INTO trace VALUES (?,?,?)")),
      digests_(database) {}

void CellWriter::write(const CellResult& result, CellKeys& keys) {
  Transaction transaction(database_);
  try {
    write_rows(result, keys);
    transaction.commit();
  } catch (...) {
    scores_.forget();
    digests_.forget();
    throw;
  }
}

void CellWriter::write_rows(const CellResult& result, CellKeys& keys) {
  remove_.bind(static_cast<std::int64_t>(result.cell.index));
  std::vector<std::pair<std::int64_t, std::string>> before;
  while (remove_.step()) {
    const std::int64_t id = remove_.integer();
    before.emplace_back(id, remove_.text());
  }
  remove_.reset();
  for (const auto& [id, digest] : before) {
    remove_cell(database_, id);
    digests_.remove("cell", digest);
  }

  if (result.metadata) write_metadata(result.cell, keys, *result.metadata);
  const std::int64_t id = write_cell(result, keys);
  scores_.write(id, result, keys.sweep());
  for (const methods::Phase& p : result.report.phases)
    phase_.bind(id).bind(p.name).bind(p.seconds).run();
  for (const methods::Count& c : result.report.counts)
    count_.bind(id).bind(c.name).bind(c.value).run();
  for (const std::string& text : result.report.notes) note_.bind(id).bind(text).run();
  for (const methods::Section& s : result.report.sections) {
    section_.bind(id).bind(s.kind).bind(s.begin).bind(s.end).bind(s.what).run();
  }
  if (!result.trace.samples.empty()) {
    trace_.bind(id)
        .bind(to_text(result.trace.times))
        .bind_blob(bytes_of(result.trace.samples))
        .run();
  }
  digests_.add_cell(id);
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
      .bind(result.allocations)
      .bind(to_text(result.status))
      .bind(result.signal)
      .bind(result.why)
      .bind(static_cast<std::int64_t>(failed_scores))
      .run();
  return database_.last_row();
}

void CellWriter::write_metadata(const Cell& cell,
                                CellKeys& keys,
                                const SequenceMetadata& metadata) {
  const std::string sequence_key = keys.sequence_key(cell, metadata.inputs);
  if (metadata_.contains(sequence_key)) return;
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
  Statement stored = database_.prepare("SELECT digest FROM sequence WHERE sequence_key = ?");
  if (stored.bind(sequence_key).step()) digests_.remove("sequence", stored.text());
  stored.reset();
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
    database_.prepare("INSERT OR REPLACE INTO sequence_trace VALUES (?,?,?,?,?,?,?,?)")
        .bind(sequence_key)
        .bind(trace.origin.stamp)
        .bind(trace.origin.x)
        .bind(trace.origin.y)
        .bind(trace.origin.z)
        .bind_blob(bytes_of(trace.reference))
        .bind_blob(bytes_of(trace.keyframes))
        .bind_blob(bytes_of(trace.closures))
        .run();
  }
  digests_.add_sequence(sequence_key);
  metadata_.insert(sequence_key);
}

}  // namespace loopbench::harness

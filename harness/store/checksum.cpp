#include "harness/store/checksum.hpp"

#include <bit>

#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kSequenceColumns =
    "sequence_key, configuration_hash, options, keyframes, odometry, closures, frames, reference, "
    "content, group_name";
constexpr const char* kDefinitionColumns =
    "id, protocol, protocol_version, times, metric, label, relation, axis, unit, better, target";
constexpr const char* kOfCell = "WHERE cell = ? ORDER BY number";
constexpr int kScoreContent = 2;  ///< first column of kScoreColumns after cell and definition

std::string query(const std::string& columns, const std::string& table, const std::string& rest) {
  return "SELECT " + columns + " FROM " + table + " " + rest;
}

void append_number(Checksum number, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

const char* const kCellColumns =
    "position, key, build, sequence_key, provenance_key, sequence, repeat, method, "
    "dataset_options, method_options, closures, oracle_closures, oracle, worker, runs, "
    "seconds_median, seconds_min, seconds_max, cpu_seconds_median, peak_memory, added_memory, "
    "status, signal, why, failed_scores";

std::string report_query(const std::string& table, const std::string& rest) {
  return query(table == "trace" ? "cell, checksum" : "*", table, rest);
}

Checksum checksum_of(std::string_view bytes) { return hash_of(bytes).low; }

std::int64_t checksum_of_parts(std::initializer_list<std::string_view> parts) {
  std::string bytes;
  for (const std::string_view part : parts) append_number(checksum_of(part), bytes);
  return std::bit_cast<std::int64_t>(checksum_of(bytes));
}

Checksum checksum_of_cell(Statement& row, Checksum sequence) {
  std::string bytes;
  row.append_columns(3, row.columns(), bytes);
  append_number(sequence, bytes);
  return checksum_of(bytes);
}

std::unordered_map<std::string, Checksum> sequence_checksums(Database& database,
                                                             const std::string& schema) {
  std::unordered_map<std::string, Checksum> out;
  Statement row = database.prepare(query(kSequenceColumns, schema + ".sequence", ""));
  while (row.step()) {
    const Checksum own = checksum_of(row.bytes_of_columns(0, row.columns()));
    out.emplace(row.text(), own);
  }
  return out;
}

std::unordered_map<std::int64_t, Checksum> definition_checksums(Database& database) {
  std::unordered_map<std::int64_t, Checksum> out;
  Statement row = database.prepare(query(kDefinitionColumns, "score_definition", ""));
  while (row.step()) {
    const Checksum own = checksum_of(row.bytes_of_columns(1, row.columns()));
    out.emplace(row.integer(), own);
  }
  return out;
}

void add_score(Statement& row,
               std::int64_t definition,
               const std::unordered_map<std::int64_t, Checksum>& definitions,
               std::string& bytes) {
  const auto found = definitions.find(definition);
  append_number(found == definitions.end() ? 0 : found->second, bytes);
  row.append_columns(kScoreContent, row.columns(), bytes);
}

Checksum checksum_of_report(const char* table, std::string_view bytes) {
  return bytes.empty() ? 0 : checksum_of(table + std::string(bytes));
}

ChecksumWriter::ChecksumWriter(Database& database)
    : row_(database.prepare(query(
          std::string("id, checksum, report_checksum, ") + kCellColumns, "cell", "WHERE id = ?"))),
      sequence_(database.prepare(
          query(kSequenceColumns,
                "sequence",
                "WHERE sequence_key = (SELECT sequence_key FROM cell WHERE id = ?)"))),
      scores_(
          database.prepare(query(kScoreColumns, "score_value", "WHERE cell = ? ORDER BY number"))),
      definition_(database.prepare(query(kDefinitionColumns, "score_definition", "WHERE id = ?"))),
      reports_{database.prepare(report_query(kReportTables[0], kOfCell)),
               database.prepare(report_query(kReportTables[1], kOfCell)),
               database.prepare(report_query(kReportTables[2], kOfCell)),
               database.prepare(report_query(kReportTables[3], kOfCell)),
               database.prepare(report_query(kReportTables[4], "WHERE cell = ?"))},
      set_(database.prepare("UPDATE cell SET checksum = ?, report_checksum = ? WHERE id = ?")),
      stored_(database.prepare("SELECT checksum FROM cell WHERE id = ?")),
      set_row_(database.prepare("UPDATE cell SET checksum = ? WHERE id = ?")) {}

Checksum ChecksumWriter::row_of(std::int64_t cell) {
  Checksum sequence = 0;
  if (sequence_.bind(cell).step()) {
    sequence = checksum_of(sequence_.bytes_of_columns(0, sequence_.columns()));
  }
  sequence_.reset();
  const Checksum out = row_.bind(cell).step() ? checksum_of_cell(row_, sequence) : 0;
  row_.reset();
  return out;
}

Checksum ChecksumWriter::scores_of(std::int64_t cell) {
  std::string bytes;
  scores_.bind(cell);
  while (scores_.step()) {
    scores_.integer();  // cell
    const std::int64_t definition = scores_.integer();
    if (!definitions_.contains(definition) && definition_.bind(definition).step()) {
      definitions_[definition] =
          checksum_of(definition_.bytes_of_columns(1, definition_.columns()));
    }
    definition_.reset();
    add_score(scores_, definition, definitions_, bytes);
  }
  scores_.reset();
  return checksum_of(bytes);
}

Checksum ChecksumWriter::reports_of(std::int64_t cell) {
  Checksum out = 0;
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    std::string bytes;
    reports_[i].bind(cell);
    while (reports_[i].step()) reports_[i].append_columns(1, reports_[i].columns(), bytes);
    reports_[i].reset();
    out += checksum_of_report(kReportTables[i], bytes);
  }
  return out;
}

void ChecksumWriter::write(std::int64_t cell) {
  set_.bind(std::bit_cast<std::int64_t>(row_of(cell) + scores_of(cell)))
      .bind(std::bit_cast<std::int64_t>(reports_of(cell)))
      .bind(cell)
      .run();
}

void ChecksumWriter::update_row(std::int64_t cell, Checksum before) {
  if (!stored_.bind(cell).step()) return;
  const Checksum sum = std::bit_cast<Checksum>(stored_.integer()) - before + row_of(cell);
  stored_.reset();
  set_row_.bind(std::bit_cast<std::int64_t>(sum)).bind(cell).run();
}

}  // namespace loopbench::harness

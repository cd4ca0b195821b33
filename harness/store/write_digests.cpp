#include "harness/store/write_digests.hpp"

#include <stdexcept>

namespace loopbench::harness {
namespace {

void set_written(Database& database, const std::string& table, const std::string& value) {
  database.prepare("INSERT OR REPLACE INTO digest VALUES (?,?)").bind(table).bind(value).run();
}

}  // namespace

DigestWriter::DigestWriter(Database& database)
    : database_(database),
      definitions_(database),
      scores_(database.prepare(std::string("SELECT ") + kScoreColumns +
                               " FROM score_value WHERE cell = ? ORDER BY number")),
      set_details_(database.prepare("UPDATE cell SET score_digest = ?, phase_digest = ?, "
                                    "count_digest = ?, note_digest = ?, section_digest = ?, "
                                    "trace_digest = ? WHERE id = ?")),
      cell_(database.prepare("SELECT * FROM cell WHERE id = ?")),
      set_cell_(database.prepare("UPDATE cell SET digest = ? WHERE id = ?")),
      inputs_(database.prepare("SELECT * FROM input WHERE sequence_key = ? ORDER BY number")),
      sequence_trace_(database.prepare("SELECT * FROM sequence_trace WHERE sequence_key = ?")),
      set_sequence_details_(database.prepare(
          "UPDATE sequence SET input_digest = ?, trace_digest = ? WHERE sequence_key = ?")),
      sequence_(database.prepare("SELECT * FROM sequence WHERE sequence_key = ?")),
      set_sequence_(database.prepare("UPDATE sequence SET digest = ? WHERE sequence_key = ?")),
      sum_(database.prepare("SELECT value FROM digest WHERE name = ?")),
      set_sum_(database.prepare("INSERT OR REPLACE INTO digest VALUES (?,?)")) {
  for (const char* table : {"phase", "count", "note", "section", "trace"}) {
    details_.push_back(
        database.prepare(std::string("SELECT * FROM ") + table + " WHERE cell = ? ORDER BY rowid"));
  }
}

template <class Key>
std::string DigestWriter::digest_of(Statement& rows, const Key& key) {
  RowsDigest digest;
  rows.bind(key);
  while (rows.step()) {
    digest.add(rows, 1, rows.columns());
  }
  rows.reset();
  return digest.text();
}

std::string DigestWriter::digest_of_scores(std::int64_t cell) {
  ScoresDigest digest;
  scores_.bind(cell);
  while (scores_.step()) {
    scores_.integer();  // cell
    scores_.integer();  // number
    const std::int64_t id = scores_.integer();
    const ScoreDefinition* definition = definitions_.find(id);
    if (definition == nullptr) {
      definitions_ = ScoreDefinitions(database_);
      definition = definitions_.find(id);
    }
    digest.add(scores_, definition);
  }
  scores_.reset();
  return digest.text();
}

template <class Key>
std::string DigestWriter::update(Statement& row, Statement& set, const Key& key) {
  row.bind(key);
  if (!row.step()) throw std::runtime_error("no row to take a digest of");
  const std::string digest = digest_of_columns(row, 0, row.columns() - 1);
  row.reset();
  set.bind(digest).bind(key).run();
  return digest;
}

void DigestWriter::add_cell(std::int64_t id) {
  set_details_.bind(digest_of_scores(id));
  for (Statement& rows : details_) set_details_.bind(digest_of(rows, id));
  set_details_.bind(id).run();
  change_sum("cell", update(cell_, set_cell_, id), &SumOfDigests::add);
}

void DigestWriter::update_cell(std::int64_t id) { update(cell_, set_cell_, id); }

void DigestWriter::add_sequence(const std::string& sequence_key) {
  set_sequence_details_.bind(digest_of(inputs_, sequence_key))
      .bind(digest_of(sequence_trace_, sequence_key))
      .bind(sequence_key)
      .run();
  change_sum("sequence", update(sequence_, set_sequence_, sequence_key), &SumOfDigests::add);
}

void DigestWriter::remove(const std::string& table, const std::string& digest) {
  change_sum(table, digest, &SumOfDigests::remove);
}

void DigestWriter::change_sum(const std::string& table,
                              const std::string& digest,
                              void (SumOfDigests::*change)(std::string_view)) {
  SumOfDigests sum;
  if (sum_.bind(table).step()) sum.add(sum_.text());
  sum_.reset();
  (sum.*change)(digest);
  set_sum_.bind(table).bind(sum.text()).run();
}

std::string sum_of_digests(Database& database, const std::string& table) {
  Statement rows = database.prepare("SELECT digest FROM " + table + " NOT INDEXED");
  SumOfDigests sum;
  while (rows.step()) sum.add(rows.text());
  return sum.text();
}

std::string digest_of_texts(Database& database, const std::string& table) {
  Statement rows = database.prepare("SELECT * FROM " + table + " NOT INDEXED ORDER BY 1, 2");
  RowsDigest digest;
  while (rows.step()) digest.add(rows, 0, rows.columns());
  return digest.text();
}

std::string written_digest(Database& database, const std::string& table) {
  Statement row = database.prepare("SELECT value FROM digest WHERE name = ?");
  return row.bind(table).step() ? row.text() : "";
}

void update_sum(Database& database, const std::string& table) {
  set_written(database, table, sum_of_digests(database, table));
}

void update_texts(Database& database, const std::string& table) {
  set_written(database, table, digest_of_texts(database, table));
}

}  // namespace loopbench::harness

#include "harness/sweep/store/store.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/sweep/run/build.hpp"
#include "harness/sweep/store/cell_writer.hpp"
#include "harness/sweep/store/match_cells.hpp"
#include "harness/sweep/store/stored_cells.hpp"
#include "harness/sweep/store/stored_options.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// previous-1.sqlite, or the next number that is free.
std::filesystem::path next_previous(const std::filesystem::path& folder) {
  for (int number = 1;; ++number) {
    const std::filesystem::path file = folder / fmt::format("previous-{}.sqlite", number);
    if (!std::filesystem::exists(file)) return file;
  }
}

void set_aside(const std::filesystem::path& file) {
  try {
    const std::filesystem::path previous = next_previous(file.parent_path());
    if (std::filesystem::exists(file)) {
      try {
        include_log(file);  // so that one rename keeps all of its cells
      } catch (const InputError&) {
        // Damaged, or read by others: the log is moved, too.
      }
      std::filesystem::rename(file, previous);
    }
    // A log that is left belongs to the moved file and would corrupt the new one.
    for (const char* tail : {"-wal", "-shm", "-journal"}) {
      const std::filesystem::path log = file.string() + tail;
      if (std::filesystem::exists(log)) std::filesystem::rename(log, previous.string() + tail);
    }
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(file.string() + ": cannot be written: " + error.code().message());
  }
}

constexpr std::chrono::seconds kSyncInterval{10};

/// See store.hpp for synchronous = NORMAL. The log is copied into the file every 16 MB, some
/// hundred cells with traces, and at every sync, because each copy waits for the disk.
void make_ready(Database& database) {
  database.execute(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA wal_autocheckpoint = 4096;");
}

/// SQLite follows symbolic links, also dangling ones: it would write a file elsewhere.
void reject_links(const std::filesystem::path& file) {
  for (const char* tail : {"", "-wal", "-shm", "-journal"}) {
    const std::filesystem::path part = file.string() + tail;
    std::error_code none;
    const std::filesystem::file_status status = std::filesystem::symlink_status(part, none);
    if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) continue;
    const bool is_link = std::filesystem::is_symlink(status);
    throw InputError(part.string() +
                     (is_link ? ": is a symbolic link" : ": is not a regular file") +
                     ", expected a store of results; remove it, or use another --out");
  }
}

/// The table run, except for the number of cells.
std::map<std::string, std::string> run_values(const CellKeys& keys) {
  const Sweep& sweep = keys.sweep();
  std::string rules, alignments;  // one protocol per line: in full; LABEL [VERSION], tab, alignment
  for (const metrics::NamedProtocol& protocol : sweep.protocols) {
    const std::string name = protocol.label() + " [" + protocol.version + "]";
    rules += name + ": " + to_text(echo(protocol.rules)) + "\n";
    alignments += name + "\t" + to_text(protocol.rules.align) + "\n";
  }
  return {{"loopbench", kVersion},
          {"sweep", sweep.name},
          {"config", sweep.text},
          {"protocol", rules},
          {"alignment", alignments},
          {"metrics", keys.metric_definitions()},
          {"methods", keys.method_definitions()},
          {"options", options_json(keys)},
          {"baseline", sweep.baseline}};
}

/// Key of the rows of one run's provenance.
std::string key_of_provenance(const std::map<std::string, std::string>& provenance) {
  Fields out;
  for (const auto& [key, value] : provenance) out.add(key).add(value);
  return out.hashed();
}

void write_provenance(Database& database, const std::map<std::string, std::string>& provenance) {
  const std::string provenance_key = key_of_provenance(provenance);
  database.prepare("DELETE FROM provenance WHERE provenance_key = ?").bind(provenance_key).run();
  Statement insert = database.prepare("INSERT INTO provenance VALUES (?, ?, ?, ?)");
  for (const auto& [key, value] : provenance) insert.bind_hashed(provenance_key, key, value).run();
}

/// Removes damaged cells, so that they count as not run, and returns their labels.
std::vector<std::string> remove_damaged(Database& database, std::vector<StoredCell>& cells) {
  check_traces(database, cells);
  std::vector<std::string> out;
  for (const StoredCell& cell : cells) {
    if (cell.intact) continue;
    out.push_back(label_of(cell));
    remove_cell(database, cell.id);
  }
  std::erase_if(cells, [](const StoredCell& cell) { return !cell.intact; });
  remove_damaged_rows(database, kProvenanceTable);
  remove_damaged_rows(database, kInputTable);
  remove_damaged_rows(database, kSequenceNoteTable);
  if (!out.empty()) {  // a row whose key has changed would hide others from a search by key
    database.execute(
        "DELETE FROM sequence WHERE sequence_key NOT IN (SELECT sequence_key FROM cell)");
  }
  remove_orphans(database);
  return out;
}

}  // namespace

Store::Store(std::filesystem::path file,
             CellKeys& keys,
             std::map<std::string, std::string> provenance,
             bool fresh)
    : file_(std::move(file)), keys_(keys), provenance_(std::move(provenance)), fresh_(fresh) {
  reject_links(file_);
  if (!is_memory_store(file_)) lock_ = std::make_unique<FolderLock>(folder_of(file_));
  if (fresh_ || !std::filesystem::exists(file_)) return;
  database_ = std::make_unique<Database>(file_, Database::Mode::read);
  empty_ = has_no_tables(*database_);
  if (empty_) {
    database_.reset();
    return;
  }
  check_schema(*database_, file_);
  make_ready(*database_);
}

Store::~Store() {
  try {
    close();
  } catch (const std::exception&) {
    // Reported by an earlier call of close(), or the sweep ends with another error.
  }
}

void Store::close() {
  writer_.reset();
  if (!database_) return;
  const std::unique_ptr<Database> closed = std::move(database_);
  closed->execute("PRAGMA wal_checkpoint(PASSIVE)");  // fails if the disk does
  try {
    closed->execute("PRAGMA journal_mode = DELETE");  // leaves a single file
  } catch (const std::exception&) {
    // Another process reads it: the -wal file remains until the next process opens it.
  }
}

void Store::create() {
  if (!is_memory_store(file_) && !empty_) set_aside(file_);
  database_ = std::make_unique<Database>(file_, Database::Mode::create);
  make_ready(*database_);
  Transaction transaction(*database_);
  create_tables(*database_);
  set_run_value(*database_, "cells", "0");
  update_description();
  transaction.commit();
}

bool Store::update_description() {
  std::map<std::string, std::string> values = run_values(keys_);
  if (planned_ > 0) values.emplace("planned", std::to_string(planned_));
  if (!shard_.empty()) values.emplace("shard", shard_);
  bool is_current = true;
  for (const auto& [key, value] : values) {
    Statement row = database_->prepare("SELECT value FROM run WHERE key = ?");
    if (row.bind(key).step() && row.text() == value) continue;
    row.reset();
    set_run_value(*database_, key, value);
    is_current = false;
  }
  return is_current;
}

Resumed Store::resume(const std::vector<Cell>& all, const std::vector<Cell>& planned, Retry retry) {
  planned_ = all.size();
  if (!database_) {
    Resumed nothing;
    nothing.missing = planned;
    return nothing;
  }
  Transaction transaction(*database_);
  repair_structure(*database_, false);
  remove_damaged_rows(*database_, kRunTable);
  if (damaged_rows(*database_, kProvenanceTable).contains(key_of_provenance(provenance_))) {
    write_provenance(*database_, provenance_);  // so that its cells need not be recomputed
  }
  std::vector<StoredCell> stored = read_stored_cells(*database_);
  const std::vector<std::string> damaged = remove_damaged(*database_, stored);
  if (!damaged.empty()) repair_structure(*database_, true);
  Resumed out = match_cells(*database_, stored, keys_, all, planned, retry);
  out.damaged = damaged;
  const bool is_described = update_description();
  out.unchanged = out.unchanged && damaged.empty() && is_described;
  transaction.commit();
  return out;
}

void Store::write(const CellResult& result) {
  if (!database_) create();
  if (!writer_) {
    Transaction transaction(*database_);
    write_provenance(*database_, provenance_);
    transaction.commit();
    writer_ = std::make_unique<CellWriter>(*database_, key_of_provenance(provenance_));
  }
  writer_->write(result, keys_);
  if (std::chrono::steady_clock::now() - synced_ >= kSyncInterval) sync();
}

void Store::sync() {
  if (database_) database_->execute("PRAGMA wal_checkpoint(PASSIVE)");
  synced_ = std::chrono::steady_clock::now();
}

}  // namespace loopbench::harness

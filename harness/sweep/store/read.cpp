#include "harness/sweep/store/read.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/store/note_rows.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/schema.hpp"
#include "harness/sweep/store/stored_cells.hpp"
#include "harness/sweep/store/stored_options.hpp"

namespace loopbench::harness {
namespace {

/// Appends the lines of `more` that are not in `text`.
void add_lines(std::string& text, const std::string& more) {
  std::istringstream lines(more);
  for (std::string line; std::getline(lines, line);) {
    if (("\n" + text + "\n").find("\n" + line + "\n") != std::string::npos) continue;
    if (!text.empty() && !text.ends_with('\n')) text += "\n";
    text += line;
  }
}

/// The texts of two columns, in order; the first one's can repeat.
std::vector<std::pair<std::string, std::string>> text_pairs(Database& database,
                                                            const std::string& query) {
  Statement row = database.prepare(query);
  std::vector<std::pair<std::string, std::string>> out;
  while (row.step()) {
    std::string& key = out.emplace_back().first;
    row.read(key, out.back().second);
  }
  return out;
}

/// Selects sequence_key and the label of the sequences of all runs.
constexpr const char* kRunSequences =
    "(SELECT sequence_key, sequence || iif(repeat > 0, ' (repeat ' || repeat || ')', '') AS label, "
    "min(position) AS first FROM cell WHERE position IS NOT NULL GROUP BY sequence, repeat, "
    "sequence_key)";

}  // namespace

std::vector<Record> read_records(const std::filesystem::path& file) {
  std::vector<Record> out;
  RecordReader(file).for_each_chunk([&](std::vector<Record>& records) {
    std::ranges::move(records, std::back_inserter(out));
    return true;
  });
  return out;
}

std::vector<CellRow> read_cells(const std::filesystem::path& file) {
  Database database = open_store(file);
  std::vector<StoredCell> cells = read_intact_cells(database);
  add_options(database, cells);
  std::unordered_map<std::int64_t, CellRow*> by_id;
  for (StoredCell& cell : cells) by_id.emplace(cell.id, &cell);
  const auto add = [&](const std::string& table, const auto& read) {
    Statement row = database.prepare("SELECT * FROM " + table + " ORDER BY cell, number");
    while (row.step()) {
      const auto found = by_id.find(row.integer());
      row.integer();  // number
      if (found != by_id.end()) read(*found->second, row);
    }
  };
  add("phase", [](CellRow& cell, Statement& row) {
    auto& [name, seconds] = cell.phases.emplace_back();
    row.read(name, seconds);
  });
  add("count", [](CellRow& cell, Statement& row) {
    auto& [name, value] = cell.counts.emplace_back();
    row.read(name, value);
  });
  add("note", [&](CellRow& cell, Statement& row) {
    row.text();  // made of the next columns
    cell.notes.push_back(read_note(database, row));
  });
  return {std::move_iterator(cells.begin()), std::move_iterator(cells.end())};
}

StoredNotes read_notes(const std::filesystem::path& file) {
  Database database = open_store(file);
  StoredNotes out;
  const auto add = [&](const std::string& query) {
    Statement row = database.prepare(query);
    while (row.step()) {
      RunNote& one = out.notes.emplace_back();
      row.read(one.sequence, one.repeat, one.method);
      one.note = read_note(database, row);
    }
  };
  Statement config = database.prepare("SELECT value FROM run WHERE key = 'config'");
  const bool is_of_file = config.step() && is_of_files(config.text());
  const std::string columns = std::string(kNoteColumns);
  add("SELECT sequence, repeat, name, " + columns +
      " FROM (SELECT DISTINCT notes_key, sequence, repeat, " + (is_of_file ? "method" : "''") +
      " AS name, min(position) AS first FROM cell WHERE position IS NOT NULL GROUP BY 1, 2, 3, 4) "
      "JOIN sequence_note USING (notes_key) ORDER BY first, number");
  add("SELECT sequence, repeat, method, " + columns +
      " FROM note JOIN cell ON cell.id = note.cell WHERE position IS NOT NULL AND severity <> "
      "'info' ORDER BY position, number");
  if (out.notes.empty()) return out;
  const std::string of_runs =
      "FROM (SELECT DISTINCT sequence, repeat FROM cell WHERE position IS NOT NULL)";
  out.runs = static_cast<std::size_t>(database.integer("SELECT count(*) " + of_runs));
  out.sequences =
      static_cast<std::size_t>(database.integer("SELECT count(DISTINCT sequence) " + of_runs));
  Statement row = database.prepare(
      "SELECT method, count(*) FROM cell WHERE position IS NOT NULL GROUP BY method");
  while (row.step()) {
    std::string method;
    std::size_t count = 0;
    row.read(method, count);
    out.runs_of_method.emplace(method, count);
  }
  return out;
}

std::map<std::string, std::string> read_run(const std::filesystem::path& file) {
  Database database = open_store(file);
  const auto all = text_pairs(database, "SELECT key, value FROM run");
  return {all.begin(), all.end()};
}

std::vector<std::pair<std::string, std::string>> alignments(
    const std::map<std::string, std::string>& run) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto value = run.find("alignment");
  std::istringstream lines(value == run.end() ? "" : value->second);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = std::min(line.rfind('\t'), line.size());
    out.emplace_back(line.substr(0, tab), line.substr(std::min(tab + 1, line.size())));
  }
  return out;
}

std::map<std::string, std::string> read_provenance(const std::filesystem::path& file) {
  Database database = open_store(file);
  std::map<std::string, std::string> out;
  const auto all = text_pairs(
      database,
      "SELECT p.key, p.value FROM provenance p JOIN (SELECT provenance_key, min(position) AS first "
      "FROM cell WHERE position IS NOT NULL GROUP BY provenance_key) USING (provenance_key) ORDER "
      "BY first");
  for (const auto& [key, value] : all) {
    const auto [entry, is_new] = out.emplace(key, value);
    if (!is_new) add_lines(entry->second, value);
  }
  return out;
}

std::map<std::string, std::vector<InputFile>> read_inputs(const std::filesystem::path& file) {
  Database database = open_store(file);
  Statement rows =
      database.prepare(std::string("SELECT label, option, path, bytes, hash FROM ") +
                       kRunSequences + " JOIN input USING (sequence_key) ORDER BY first, number");
  std::map<std::string, std::vector<InputFile>> out;
  while (rows.step()) {
    InputFile& input = out[rows.text()].emplace_back();
    rows.read(input.option, input.path, input.bytes, input.hash);
  }
  return out;
}

std::map<std::string, std::string> read_dataset_options(const std::filesystem::path& file) {
  Database database = open_store(file);
  // Of several sequences with one label, the last.
  const auto all = text_pairs(database,
                              std::string("SELECT label, options FROM ") + kRunSequences +
                                  " JOIN sequence USING (sequence_key) ORDER BY first DESC");
  return {all.begin(), all.end()};
}

}  // namespace loopbench::harness

#include "harness/store/read.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <tuple>
#include <utility>

#include "harness/store/cell_rows.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/open.hpp"
#include "harness/store/record_reader.hpp"
#include "harness/store/sequence_rows.hpp"

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

/// What the cells of the config use, by the position of the first of them. The cells are not
/// checked: whoever reads their numbers does that.
struct UsedByCells {
  std::map<std::int64_t, SharedText> made;  ///< key of table provenance
  std::map<std::int64_t, std::pair<std::string, SharedText>> sequences;  ///< label and key
};

UsedByCells used_by_cells(Database& database) {
  using Run = std::tuple<SharedText, std::int64_t, SharedText>;  // sequence, repeat, key
  std::map<SharedText, std::int64_t> first_of_made;
  std::map<Run, std::int64_t> first_of_run;
  const auto add = [](auto& firsts, const auto& key, std::int64_t position) {
    std::int64_t& first = firsts.try_emplace(key, position).first->second;
    first = std::min(first, position);
  };
  SharedText made;
  Run run;
  std::int64_t last = -1;
  Statement row = database.prepare(
      "SELECT position, made, sequence, repeat, sequence_key FROM cell NOT INDEXED WHERE position "
      "IS NOT NULL");
  while (row.step()) {
    const std::int64_t position = row.integer();
    const std::string_view own_made = row.view();
    const std::string_view sequence = row.view();
    const std::int64_t repeat = row.integer();
    const std::string_view key = row.view();
    const bool is_like_last = position > last && made == own_made && std::get<0>(run) == sequence &&
                              std::get<1>(run) == repeat && std::get<2>(run) == key;
    last = position;
    if (is_like_last) continue;
    made = own_made;
    run = {sequence, repeat, key};
    add(first_of_made, made, position);
    add(first_of_run, run, position);
  }
  UsedByCells out;
  for (const auto& [used, position] : first_of_made) out.made.emplace(position, used);
  for (const auto& [used, position] : first_of_run) {
    const auto& [sequence, repeat, key] = used;
    const std::string number = repeat > 0 ? " (repeat " + std::to_string(repeat) + ")" : "";
    out.sequences.emplace(position, std::pair(sequence + number, key));
  }
  return out;
}

/// Calls `add(sequence label, row)` once for every sequence of the config's cells, in sweep order.
template <class Add>
void for_sequences(const std::filesystem::path& file, Add add) {
  Database database = open_store(file);
  const UsedByCells used = used_by_cells(database);
  const SequenceRows sequences = read_sequence_rows(database);
  require_intact(sequences, store_file(file));
  for (const auto& [position, sequence] : used.sequences) {
    const auto found = sequences.by_key.find(sequence.second);
    if (found != sequences.by_key.end()) add(sequence.first, found->second);
  }
}

/// Removes the records of unused cells and sorts the others, without a second copy in memory.
void put_in_order(const std::vector<CellRow>& cells, std::vector<CellRecord>& records) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].placed) continue;
    if (kept != i) records[kept] = std::move(records[i]);
    ++kept;
  }
  records.resize(kept);
  if (std::ranges::is_sorted(records, {}, &CellRecord::position)) return;
  std::ranges::stable_sort(records, {}, &CellRecord::position);
}

std::vector<CellRecord> cell_records(const std::filesystem::path& file, WithRecords with) {
  Database database = open_store(file);
  CellRows rows = read_cell_rows(database, with);
  const auto record = [&](std::size_t cell) -> CellRecord& { return rows.records[cell]; };
  read_details(database, "phase", rows, [&](std::size_t cell, Statement& row) {
    std::string name = row.text();
    record(cell).phases.push_back({std::move(name), row.real()});
  });
  read_details(database, "count", rows, [&](std::size_t cell, Statement& row) {
    std::string name = row.text();
    record(cell).counts.push_back({std::move(name), row.real()});
  });
  if (with == WithRecords::yes) {
    read_details(database, "note", rows, [&](std::size_t cell, Statement& row) {
      record(cell).notes.push_back(row.text());
    });
  }
  require_intact(rows, store_file(file));
  const SequenceRows sequences = read_sequence_rows(database);
  require_intact(sequences, store_file(file));
  for (std::size_t cell = 0; cell < rows.cells.size(); ++cell) {
    const auto found = sequences.by_key.find(rows.cells[cell].sequence_key);
    if (found == sequences.by_key.end()) continue;
    record(cell).keyframes = found->second.keyframes;
    record(cell).closure_count = found->second.closures;
  }
  put_in_order(rows.cells, rows.records);
  return std::move(rows.records);
}

}  // namespace

std::vector<Record> read_records(const std::filesystem::path& file) {
  std::vector<Record> out;
  RecordReader(file).for_each_chunk([&](std::vector<Record>& records) {
    std::ranges::move(records, std::back_inserter(out));
    return true;
  });
  return out;
}

std::vector<CellRecord> read_cells(const std::filesystem::path& file) {
  return cell_records(file, WithRecords::yes);
}

std::vector<CellRecord> read_costs(const std::filesystem::path& file) {
  return cell_records(file, WithRecords::costs);
}

std::map<std::string, std::string> read_run(const std::filesystem::path& file) {
  Database database = open_store(file);
  require_intact_texts(database, "run", store_file(file));
  Statement rows = database.prepare("SELECT key, value FROM run NOT INDEXED");
  std::map<std::string, std::string> out;
  while (rows.step()) {
    std::string key = rows.text();
    out.emplace(std::move(key), rows.text());
  }
  return out;
}

std::map<std::string, std::string> read_provenance(const std::filesystem::path& file) {
  Database database = open_store(file);
  require_intact_texts(database, "provenance", store_file(file));
  const UsedByCells used = used_by_cells(database);
  Statement rows = database.prepare("SELECT key, value FROM provenance WHERE made = ?");
  std::map<std::string, std::string> out;
  for (const auto& [position, made] : used.made) {
    rows.bind(made.text());
    while (rows.step()) {
      const std::string key = rows.text();
      const std::string value = rows.text();
      if (const auto [entry, is_new] = out.emplace(key, value); !is_new) {
        add_lines(entry->second, value);
      }
    }
    rows.reset();
  }
  return out;
}

std::map<std::string, std::vector<InputFile>> read_inputs(const std::filesystem::path& file) {
  std::map<std::string, std::vector<InputFile>> out;
  for_sequences(file, [&](const std::string& label, const SequenceRow& row) {
    if (!row.inputs.empty()) std::ranges::copy(row.inputs, std::back_inserter(out[label]));
  });
  return out;
}

std::map<std::string, std::string> read_dataset_options(const std::filesystem::path& file) {
  std::map<std::string, std::string> out;
  for_sequences(
      file, [&](const std::string& label, const SequenceRow& row) { out[label] = row.options; });
  return out;
}

}  // namespace loopbench::harness

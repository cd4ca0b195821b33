#include "harness/store/resume.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/store/open.hpp"
#include "harness/store/sequence_rows.hpp"

namespace loopbench::harness {
namespace {

using Inputs = std::vector<InputFile>;

bool same_content(const Inputs& a, const Inputs& b) {
  return std::ranges::equal(a, b, {}, &InputFile::hash, &InputFile::hash);
}

/// The current inputs of a cell's sequence. A store can hold several versions of a sequence, each
/// with its own list of files: returns the version that matches the files now, or otherwise any.
Inputs inputs_now(const std::vector<const SequenceRow*>& known, CellKeys& keys, const Cell& cell) {
  Inputs now;
  for (const SequenceRow* sequence : known) {
    now = keys.current_inputs(cell, sequence->inputs);
    if (same_content(now, sequence->inputs)) break;
  }
  return now;
}

/// The key of every cell with the current inputs.
std::vector<std::string> keys_now(const SequenceRows& sequences,
                                  CellKeys& keys,
                                  const std::vector<Cell>& all) {
  std::map<std::string, std::vector<const SequenceRow*>> known;
  for (const auto& [key, row] : sequences) known[row.configuration_hash].push_back(&row);
  std::map<std::string, Inputs> inputs;
  std::vector<std::string> out;
  out.reserve(all.size());
  for (const Cell& cell : all) {
    const std::string& configuration_hash = keys.configuration_hash(cell);
    const auto [entry, is_new] = inputs.try_emplace(configuration_hash);
    if (is_new) entry->second = inputs_now(known[configuration_hash], keys, cell);
    out.push_back(keys.key(cell, entry->second));
  }
  return out;
}

bool same_labels(const StoredCell& row, const Cell& cell, const Sweep& sweep) {
  return row.sequence == sweep.datasets[cell.dataset].label && row.repeat == cell.repeat &&
         row.method == sweep.methods[cell.method].label;
}

bool has_failed(const StoredCell& row) { return is_failure(row.status) || row.failed_scores > 0; }

constexpr auto kNoRow = static_cast<std::size_t>(-1);

/// The stored cell of each cell, or null: one with its key, by preference with its labels and at
/// its position.
std::vector<const StoredCell*> claim(const std::vector<StoredCell>& stored,
                                     const SequenceRows& sequences,
                                     CellKeys& keys,
                                     const std::vector<Cell>& all) {
  const std::vector<std::string> wanted = keys_now(sequences, keys, all);
  std::vector<const StoredCell*> placed(all.size(), nullptr);
  for (const StoredCell& row : stored) {
    const auto position = static_cast<std::size_t>(row.position);
    if (row.placed && position < placed.size()) placed[position] = &row;
  }
  std::vector<const StoredCell*> out(all.size(), nullptr);
  std::vector<bool> is_claimed(stored.size(), false);
  const auto number = [&](const StoredCell* row) {
    return static_cast<std::size_t>(row - stored.data());
  };
  // Mostly nothing has changed, and the row is where it was.
  for (std::size_t i = 0; i < all.size(); ++i) {
    const StoredCell* row = all[i].index < placed.size() ? placed[all[i].index] : nullptr;
    if (row == nullptr || row->key != wanted[i] || !same_labels(*row, all[i], keys.sweep()))
      continue;
    out[i] = row;
    is_claimed[number(row)] = true;
  }
  std::multimap<std::string_view, const StoredCell*> others;
  for (const StoredCell& row : stored) {
    if (!is_claimed[number(&row)]) others.emplace(row.key, &row);
  }
  for (const bool exact : {true, false}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (out[i] != nullptr) continue;
      auto [found, end] = others.equal_range(wanted[i]);
      for (; found != end; ++found) {
        if (exact && !same_labels(*found->second, all[i], keys.sweep())) continue;
        out[i] = found->second;
        others.erase(found);
        break;
      }
    }
  }
  return out;
}

}  // namespace

Resumed match(Database& database,
              const std::vector<StoredCell>& stored,
              CellKeys& keys,
              const std::vector<Cell>& all,
              const std::vector<Cell>& planned,
              Retry retry) {
  const Sweep& sweep = keys.sweep();
  const std::vector<const StoredCell*> claimed =
      claim(stored, read_sequence_rows(database), keys, all);
  ChecksumWriter checksums(database);

  Resumed out;
  out.unchanged = true;
  Statement set_aside = database.prepare("UPDATE cell SET position = NULL WHERE id = ?");
  std::vector<const StoredCell*> in_use = claimed;
  std::ranges::sort(in_use);
  for (const StoredCell& row : stored) {
    if (!row.placed || std::ranges::binary_search(in_use, &row)) continue;
    set_aside.bind(row.id).run();
    checksums.update_row(row.id, row.own);
    out.unchanged = false;
  }
  Statement entry = database.prepare(
      "UPDATE cell SET position = ?, sequence = ?, repeat = ?, method = ? WHERE id = ?");
  std::vector<const StoredCell*> by_position;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (claimed[i] == nullptr) {
      out.unchanged = false;
      continue;
    }
    const StoredCell& row = *claimed[i];
    if (all[i].index >= by_position.size()) by_position.resize(all[i].index + 1, nullptr);
    by_position[all[i].index] = &row;
    const auto position = static_cast<std::int64_t>(all[i].index);
    if (row.placed && row.position == position && same_labels(row, all[i], sweep)) continue;
    out.unchanged = false;
    entry.bind(position)
        .bind(sweep.datasets[all[i].dataset].label)
        .bind(std::int64_t{all[i].repeat})
        .bind(sweep.methods[all[i].method].label)
        .bind(row.id)
        .run();
    checksums.update_row(row.id, row.own);
  }
  for (const Cell& cell : planned) {
    const StoredCell* row = cell.index < by_position.size() ? by_position[cell.index] : nullptr;
    const bool again =
        row != nullptr && (retry == Retry::all || (retry == Retry::failed && has_failed(*row)));
    if (row == nullptr || again) {
      out.missing.push_back(cell);
      continue;
    }
    ++out.there;
    if (has_failed(*row)) ++out.failed;
    if (row->status == Status::incomplete) ++out.incomplete;
  }
  return out;
}

std::vector<Cell> missing_cells(const std::filesystem::path& store,
                                CellKeys& keys,
                                const std::vector<Cell>& all,
                                const std::vector<Cell>& planned) {
  Database database = open_store(store);
  std::vector<StoredCell> stored = checked_cells(database, false);
  std::erase_if(stored, [](const StoredCell& cell) { return !cell.intact; });
  const std::vector<const StoredCell*> claimed =
      claim(stored, read_sequence_rows(database), keys, all);
  std::set<std::size_t> missing;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (claimed[i] == nullptr) missing.insert(all[i].index);
  }
  std::vector<Cell> out;
  for (const Cell& cell : planned) {
    if (missing.contains(cell.index)) out.push_back(cell);
  }
  return out;
}

}  // namespace loopbench::harness

#include "harness/store/resume.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/store/open.hpp"
#include "harness/store/write_digests.hpp"

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

/// CellRow::key of every cell with the current inputs.
std::vector<Hash> keys_now(const SequenceRows& sequences,
                           CellKeys& keys,
                           const std::vector<Cell>& all) {
  std::map<std::string, std::vector<const SequenceRow*>> known;
  for (const auto& [key, row] : sequences.by_key) known[row.configuration_hash].push_back(&row);
  std::map<std::string, Inputs> inputs;
  std::vector<Hash> out;
  out.reserve(all.size());
  for (const Cell& cell : all) {
    const std::string& configuration_hash = keys.configuration_hash(cell);
    const auto [entry, is_new] = inputs.try_emplace(configuration_hash);
    if (is_new) entry->second = inputs_now(known[configuration_hash], keys, cell);
    out.push_back(hash_of(keys.key(cell, entry->second)));
  }
  return out;
}

bool same_labels(const CellRow& row, const Cell& cell, const Sweep& sweep) {
  return row.sequence == sweep.datasets[cell.dataset].label && row.repeat == cell.repeat &&
         row.method == sweep.methods[cell.method].label;
}

bool has_failed(const CellRow& row) { return is_failure(row.status) || row.failed_scores > 0; }

constexpr auto kNoRow = static_cast<std::size_t>(-1);

/// For each position of a sweep of `count` cells, the number of a placed intact row, or kNoRow.
std::vector<std::size_t> rows_by_position(const std::vector<CellRow>& rows, std::size_t count) {
  std::vector<std::size_t> out(count, kNoRow);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto position = static_cast<std::size_t>(rows[i].position);
    if (rows[i].intact && rows[i].placed && position < count) out[position] = i;
  }
  return out;
}

/// The intact row of each cell, or null. If two cells have the same key, the labels decide.
std::vector<const CellRow*> claim(const CheckedStore& stored,
                                  CellKeys& keys,
                                  const std::vector<Cell>& all) {
  struct KeyedRow {
    Hash key;
    std::size_t number = 0;
  };
  const auto parts = [](const Hash& key) { return std::pair(key.low, key.high); };
  const auto key_of = [&](const KeyedRow& one) { return parts(one.key); };
  const std::vector<CellRow>& rows = stored.cells.cells;
  const std::vector<Hash> wanted = keys_now(stored.sequences, keys, all);
  std::vector<bool> is_claimed(rows.size(), false);
  std::vector<const CellRow*> out(all.size(), nullptr);
  const auto can_claim = [&](std::size_t i, std::size_t number, bool exact) {
    if (is_claimed[number] || rows[number].key != wanted[i]) return false;
    return !exact || same_labels(rows[number], all[i], keys.sweep());
  };
  const auto claim_row = [&](std::size_t i, std::size_t number) {
    is_claimed[number] = true;
    out[i] = &rows[number];
  };
  // Mostly nothing has changed, and the row is where it was.
  const std::vector<std::size_t> placed = rows_by_position(rows, all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t number = all[i].index < placed.size() ? placed[all[i].index] : kNoRow;
    if (number != kNoRow && can_claim(i, number, true)) claim_row(i, number);
  }
  std::vector<KeyedRow> others;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].intact && !is_claimed[i]) others.push_back({rows[i].key, i});
  }
  std::ranges::stable_sort(others, {}, key_of);
  for (const bool exact : {true, false}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (out[i] != nullptr) continue;
      auto found = std::ranges::lower_bound(others, parts(wanted[i]), {}, key_of);
      for (; found != others.end() && found->key == wanted[i]; ++found) {
        if (!can_claim(i, found->number, exact)) continue;
        claim_row(i, found->number);
        break;
      }
    }
  }
  return out;
}

}  // namespace

Resumed match(Database& database,
              const CheckedStore& stored_rows,
              CellKeys& keys,
              const std::vector<Cell>& all,
              const std::vector<Cell>& planned,
              Retry retry) {
  const Sweep& sweep = keys.sweep();
  const std::vector<const CellRow*> claimed = claim(stored_rows, keys, all);
  DigestWriter digests(database);

  Resumed out;
  out.damaged = stored_rows.removed;
  out.lost = stored_rows.lost;
  out.unchanged = true;
  Statement set_aside = database.prepare("UPDATE cell SET position = NULL WHERE id = ?");
  std::vector<const CellRow*> in_use = claimed;
  std::ranges::sort(in_use);
  for (const CellRow& row : stored_rows.cells.cells) {
    if (!row.placed || std::ranges::binary_search(in_use, &row)) continue;
    set_aside.bind(row.id).run();
    digests.update_cell(row.id);
    out.unchanged = false;
  }
  Statement entry = database.prepare(
      "UPDATE cell SET position = ?, sequence = ?, repeat = ?, method = ? WHERE id = ?");
  std::vector<const CellRow*> by_position;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (claimed[i] == nullptr) {
      out.unchanged = false;
      continue;
    }
    const CellRow& row = *claimed[i];
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
    digests.update_cell(row.id);
  }
  if (!out.unchanged) update_sum(database, "cell");
  for (const Cell& cell : planned) {
    const CellRow* row = cell.index < by_position.size() ? by_position[cell.index] : nullptr;
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
  const CheckedStore there = check_rows(database, false);
  const std::vector<const CellRow*> claimed = claim(there, keys, all);
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

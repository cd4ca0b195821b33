#include "harness/store/resume.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

/// A cell in the store.
struct Row {
  std::int64_t id = 0;
  std::int64_t position = -1;  ///< -1: none
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;
  Status status = Status::ok;
  bool failed = false;  ///< the method, or one of its metrics
  bool claimed = false;
};

using Rows = std::unordered_map<std::string, std::vector<Row>>;  // by key

Rows rows_of(const CellRows& cells) {
  Rows out;
  for (const CellRow& cell : cells.cells) {
    const CellRecord& c = cell.record;
    const Status status = from_text<Status>(c.status).value_or(Status::failed);
    out[c.key].push_back({cell.id,
                          cell.placed ? c.position : -1,
                          c.sequence,
                          c.repeat,
                          c.method,
                          status,
                          is_failure(status) || cell.failed_scores > 0});
  }
  return out;
}

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
  for (const auto& [key, row] : sequences.by_key) known[row.asked].push_back(&row);
  std::map<std::string, Inputs> inputs;
  std::vector<std::string> out;
  out.reserve(all.size());
  for (const Cell& cell : all) {
    const std::string& asked = keys.asked(cell);
    const auto [entry, is_new] = inputs.try_emplace(asked);
    if (is_new) entry->second = inputs_now(known[asked], keys, cell);
    out.push_back(keys.key(cell, entry->second));
  }
  return out;
}

bool same_labels(const Row& row, const Cell& cell, const Sweep& sweep) {
  return row.sequence == sweep.datasets[cell.dataset].label && row.repeat == cell.repeat &&
         row.method == sweep.methods[cell.method].label;
}

/// The row of each cell, or null. If two cells have the same key, the labels decide.
std::vector<Row*> claim(Rows& rows,
                        const std::vector<std::string>& keys,
                        const std::vector<Cell>& all,
                        const Sweep& sweep) {
  std::vector<Row*> out(all.size(), nullptr);
  for (const bool exact : {true, false}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto found = rows.find(keys[i]);
      if (out[i] != nullptr || found == rows.end()) continue;
      for (Row& row : found->second) {
        if (row.claimed || (exact && !same_labels(row, all[i], sweep))) continue;
        row.claimed = true;
        out[i] = &row;
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
  Rows rows = rows_of(stored_rows.cells);
  const std::vector<Row*> claimed =
      claim(rows, keys_now(stored_rows.sequences, keys, all), all, sweep);
  DigestWriter digests(database);

  Resumed out;
  out.damaged = stored_rows.removed;
  out.lost = stored_rows.lost;
  out.unchanged = true;
  Statement set_aside = database.prepare("UPDATE cell SET position = NULL WHERE id = ?");
  for (const auto& [key, same_key] : rows) {
    for (const Row& row : same_key) {
      if (row.claimed || row.position < 0) continue;
      set_aside.bind(row.id).run();
      digests.update_cell(row.id);
      out.unchanged = false;
    }
  }
  Statement entry = database.prepare(
      "UPDATE cell SET position = ?, sequence = ?, repeat = ?, method = ? WHERE id = ?");
  std::unordered_map<std::size_t, const Row*> by_position;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (claimed[i] == nullptr) {
      out.unchanged = false;
      continue;
    }
    const Row& row = *claimed[i];
    by_position.emplace(all[i].index, &row);
    const auto position = static_cast<std::int64_t>(all[i].index);
    if (row.position == position && same_labels(row, all[i], sweep)) continue;
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
    const auto found = by_position.find(cell.index);
    const Row* row = found == by_position.end() ? nullptr : found->second;
    const bool again =
        row != nullptr && (retry == Retry::all || (retry == Retry::failed && row->failed));
    if (row == nullptr || again) {
      out.missing.push_back(cell);
      continue;
    }
    ++out.there;
    if (row->failed) ++out.failed;
    if (row->status == Status::incomplete) ++out.incomplete;
  }
  return out;
}

}  // namespace loopbench::harness

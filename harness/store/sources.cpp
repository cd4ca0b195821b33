#include "harness/store/sources.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "harness/store/open.hpp"

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

}  // namespace

StoreSources::StoreSources(const std::filesystem::path& file)
    : database_(open_store(file)), rows_(read_sequence_rows(database_)) {}

std::map<std::string, std::string> StoreSources::provenance() {
  Statement rows = database_.prepare(
      "SELECT p.key, p.value FROM provenance p JOIN (SELECT provenance_key, min(position) AS first "
      "FROM cell WHERE position IS NOT NULL GROUP BY provenance_key) USING (provenance_key) ORDER "
      "BY first");
  std::map<std::string, std::string> out;
  while (rows.step()) {
    const std::string key = rows.text();
    const std::string value = rows.text();
    if (const auto [entry, is_new] = out.emplace(key, value); !is_new) {
      add_lines(entry->second, value);
    }
  }
  return out;
}

template <class Visit>
void StoreSources::for_each_sequence(Visit visit) {
  Statement row = database_.prepare(
      "SELECT sequence, repeat, sequence_key, min(position) AS first FROM cell WHERE position IS "
      "NOT NULL GROUP BY sequence, repeat, sequence_key ORDER BY first");
  while (row.step()) {
    const std::string label = row.text();
    const std::int64_t repeat = row.integer();
    const auto found = rows_.find(row.text());
    if (found == rows_.end()) continue;
    visit(label + (repeat > 0 ? " (repeat " + std::to_string(repeat) + ")" : ""), found->second);
  }
}

std::map<std::string, std::vector<InputFile>> StoreSources::inputs() {
  std::map<std::string, std::vector<InputFile>> out;
  for_each_sequence([&](const std::string& label, const SequenceRow& sequence) {
    if (sequence.inputs.empty()) return;
    std::ranges::copy(sequence.inputs, std::back_inserter(out[label]));
  });
  return out;
}

std::map<std::string, std::string> StoreSources::dataset_options() {
  std::map<std::string, std::string> out;
  for_each_sequence([&](const std::string& label, const SequenceRow& sequence) {
    out[label] = sequence.options;
  });
  return out;
}

}  // namespace loopbench::harness

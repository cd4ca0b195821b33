#include "harness/store/sources.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <tuple>

#include "harness/store/damage.hpp"
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
    : file_(store_file(file)), database_(open_store(file)) {
  using Run = std::tuple<SharedText, std::int64_t, SharedText>;  // sequence, repeat, key
  std::map<SharedText, std::int64_t> first_of_provenance;
  std::map<Run, std::int64_t> first_of_run;
  const auto add = [](auto& firsts, const auto& key, std::int64_t position) {
    std::int64_t& first = firsts.try_emplace(key, position).first->second;
    first = std::min(first, position);
  };
  SharedText provenance_key;
  Run run;
  std::int64_t last = -1;
  Statement row = database_.prepare(
      "SELECT position, provenance_key, sequence, repeat, sequence_key FROM cell NOT INDEXED WHERE "
      "position "
      "IS NOT NULL");
  while (row.step()) {
    const std::int64_t position = row.integer();
    const std::string_view own_provenance_key = row.view();
    const std::string_view sequence = row.view();
    const std::int64_t repeat = row.integer();
    const std::string_view key = row.view();
    const bool is_like_last = position > last && provenance_key == own_provenance_key &&
                              std::get<0>(run) == sequence && std::get<1>(run) == repeat &&
                              std::get<2>(run) == key;
    last = position;
    if (is_like_last) continue;
    provenance_key = own_provenance_key;
    run = {sequence, repeat, key};
    add(first_of_provenance, provenance_key, position);
    add(first_of_run, run, position);
  }
  for (const auto& [used, position] : first_of_provenance) made_.emplace(position, used);
  for (const auto& [used, position] : first_of_run) {
    const auto& [label, number, own_key] = used;
    const std::string suffix = number > 0 ? " (repeat " + std::to_string(number) + ")" : "";
    sequences_.emplace(position, std::pair(label + suffix, own_key));
  }
}

std::map<std::string, std::string> StoreSources::provenance() {
  require_intact_texts(database_, "provenance", file_);
  Statement rows = database_.prepare("SELECT key, value FROM provenance WHERE provenance_key = ?");
  std::map<std::string, std::string> out;
  for (const auto& [position, provenance_key] : made_) {
    rows.bind(provenance_key.text());
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

const SequenceRows& StoreSources::rows() {
  if (!rows_) {
    rows_ = read_sequence_rows(database_);
    require_intact(*rows_, file_);
  }
  return *rows_;
}

std::map<std::string, std::vector<InputFile>> StoreSources::inputs() {
  std::map<std::string, std::vector<InputFile>> out;
  for (const auto& [position, sequence] : sequences_) {
    const auto& [label, key] = sequence;
    const auto found = rows().by_key.find(key);
    if (found == rows().by_key.end() || found->second.inputs.empty()) continue;
    std::ranges::copy(found->second.inputs, std::back_inserter(out[label]));
  }
  return out;
}

std::map<std::string, std::string> StoreSources::dataset_options() {
  std::map<std::string, std::string> out;
  for (const auto& [position, sequence] : sequences_) {
    const auto& [label, key] = sequence;
    const auto found = rows().by_key.find(key);
    if (found != rows().by_key.end()) out[label] = found->second.options;
  }
  return out;
}

}  // namespace loopbench::harness

#include "harness/tables/notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace loopbench::harness {
namespace {

std::string listed(const std::vector<std::string>& list) {
  return fmt::format("{}", fmt::join(list, ", "));
}

/// A list of different texts for each key, keys in order of first appearance.
template <class Key>
class Lists {
 public:
  void add(const Key& key, const std::string& text) {
    const auto [entry, is_new] = place_.emplace(key, lists.size());
    if (is_new) lists.emplace_back(key, std::vector<std::string>());
    std::vector<std::string>& list = lists[entry->second].second;
    if (!text.empty() && std::ranges::count(list, text) == 0) list.push_back(text);
  }

  std::vector<std::pair<Key, std::vector<std::string>>> lists;

 private:
  std::map<Key, std::size_t> place_;
};

}  // namespace

std::vector<std::string> grouped(const std::vector<Missing>& missing) {
  using Reason = std::tuple<std::string, std::string, std::string>;  // first of row, then of whats
  Lists<Reason> items;
  for (const Missing& m : missing) items.add({m.row, m.status, m.why}, m.what);
  Lists<Reason> rows;
  for (const auto& [reason, list] : items.lists) {
    const auto& [row, status, why] = reason;
    rows.add({listed(list), status, why}, row);
  }
  std::vector<std::string> out;
  for (const auto& [reason, list] : rows.lists) {
    const auto& [what, status, why] = reason;
    const std::string of = list.empty() ? "" : listed(list) + ": ";
    out.push_back(of + what + (what.empty() ? "" : " ") + status + ": " + why);
  }
  return out;
}

std::string oracle_closures_note(const std::set<std::string>& sequences, std::size_t most) {
  if (sequences.empty()) return "";
  std::vector<std::string> names(sequences.begin(), sequences.end());
  std::string more;
  if (names.size() > most) {
    more = " and " + std::to_string(names.size() - most) + " more";
    names.resize(most);
  }
  return "closures are oracle, measured in the reference or selected by it: " + listed(names) +
         more;
}

}  // namespace loopbench::harness

/// Notes with the reasons for missing values in a table, grouped.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace loopbench::harness {

/// One missing value, or all values of a row if `what` is empty.
struct Missing {
  std::string row;
  std::string what;    ///< "ate rotation"
  std::string status;  ///< "declined", "undefined"
  std::string why;
};

inline std::string listed(const std::vector<std::string>& list) {
  return fmt::format("{}", fmt::join(list, ", "));
}

/// A list of different texts for each key, keys in order of first appearance.
template <class Key>
class ListsByKey {
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

/// One line for each reason, in order of appearance: "ROWS: WHATS STATUS: WHY". Groups values of
/// one row with the same reason, then rows with the same groups. More than three reasons of the
/// same values are one line, so that a method that fails everywhere is not one line for each
/// sequence. O(n log n).
inline std::vector<std::string> grouped(const std::vector<Missing>& missing) {
  using Reason = std::tuple<std::string, std::string, std::string>;  // first of row, then of whats
  ListsByKey<Reason> items;
  for (const Missing& m : missing) items.add({m.row, m.status, m.why}, m.what);
  std::map<Reason, std::size_t> reasons;  // by row, whats and status
  for (const auto& [reason, list] : items.lists) {
    ++reasons[{std::get<0>(reason), listed(list), std::get<1>(reason)}];
  }
  ListsByKey<Reason> rows;
  for (const auto& [reason, list] : items.lists) {
    const auto& [row, status, why] = reason;
    std::size_t& count = reasons[{row, listed(list), status}];
    if (count == 0) continue;  // all are in the line of the first
    const std::string several = count > 3 ? std::to_string(count) + " reasons, the first: " : "";
    rows.add({listed(list), status, several + why}, row);
    if (count > 3) count = 0;
  }
  std::vector<std::string> out;
  for (const auto& [reason, list] : rows.lists) {
    const auto& [what, status, why] = reason;
    const std::string of = list.empty() ? "" : listed(list) + ": ";
    out.push_back(of + what + (what.empty() ? "" : " ") + status + ": " + why);
  }
  return out;
}

/// Note that the closures of these sequences are oracle, with at most `most` names; empty without
/// sequences.
inline std::string oracle_closures_note(const std::set<std::string>& sequences, std::size_t most) {
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

/// Identity of the runs in a store of evaluated files (`eval --store`), where every file is a
/// sequence of its own and the estimates are results, not inputs of methods.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "harness/text/hash.hpp"

namespace loopbench::harness {

/// First line of the config text of such a store.
inline constexpr std::string_view kRecordedTitle =
    "# estimates evaluated by loopbench eval --store";

inline bool is_recorded(std::string_view config) { return config.starts_with(kRecordedTitle); }

/// Record::group of a run. The reference is identified by its poses, because the same recording
/// under several names is not several independent sequences.
inline std::string recorded_group(const std::string& run, const std::string& reference_hash) {
  return "run " + run + " on reference:" + reference_hash;
}

/// Record::content of a run from the content (estimate and reference) of each of its methods: two
/// runs are one observation only if the outputs of all methods are equal. A method that is added
/// later, or only to some runs, changes it. Empty if a method's content is unknown.
inline std::string recorded_content(const std::map<std::string, std::string>& content_by_method) {
  Fields fields;
  for (const auto& [method, content] : content_by_method) {
    if (content.empty()) return "";
    fields.add(method).add(content);
  }
  return fields.hashed();
}

}  // namespace loopbench::harness

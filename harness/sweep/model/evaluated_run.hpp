/// Identity of the runs in a store of evaluated files (`eval --store`), where every file is a
/// sequence of its own and the estimates are results, not inputs of methods.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "harness/sweep/model/run_group.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {

/// First line of the config text of such a store.
inline constexpr std::string_view kEvaluatedTitle =
    "# estimates evaluated by loopbench eval --store";

/// Start of its line with the options of reading that all files share.
inline constexpr std::string_view kEvaluatedOptions = "# options: ";

inline bool is_of_files(std::string_view config) { return config.starts_with(kEvaluatedTitle); }

/// The options in the config text: "format=auto, period=0.1, ..."; empty if it has none.
inline std::string evaluated_options(std::string_view config) {
  const std::size_t line = config.find(kEvaluatedOptions);
  if (line == std::string_view::npos) return "";
  const std::size_t begin = line + kEvaluatedOptions.size();
  return std::string(config.substr(begin, config.find('\n', begin) - begin));
}

/// Why two such stores cannot be merged: all files of one are read with the same options. Empty if
/// they can be, or if one is the store of a sweep.
inline std::string why_other_options(std::string_view earlier, std::string_view added) {
  if (!is_of_files(earlier) || !is_of_files(added)) return "";
  const std::string options = evaluated_options(added);
  const std::string others = evaluated_options(earlier);
  if (options == others) return "";
  return "its files were read with " + options + ", those of the earlier stores with " + others;
}

/// Sets the group of a run, of metadata or of a cell. The recording is identified by the poses of
/// the reference, because the same recording under several names is not several independent
/// sequences.
template <class Facts>
void set_evaluated_group(Facts& facts, const std::string& run, const std::string& recording) {
  facts.group = "run " + run + " on recording " + recording;
  facts.group_kind = GroupKind::files;
  facts.recording = recording;
}

/// CellRow::content of a run from the content (estimate and reference) of each of its methods: two
/// runs are one observation only if the outputs of all methods are equal. A method that is added
/// later, or only to some runs, changes it. Empty if a method's content is unknown.
inline std::string evaluated_content(const std::map<std::string, std::string>& content_by_method) {
  Fields fields;
  for (const auto& [method, content] : content_by_method) {
    if (content.empty()) return "";
    fields.add(method).add(content);
  }
  return fields.hashed();
}

}  // namespace loopbench::harness

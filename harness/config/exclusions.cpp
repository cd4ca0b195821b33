#include "harness/config/exclusions.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/text/pattern.hpp"

namespace loopbench::harness {
namespace {

template <class Choice>
void require_match(const YamlNode& entry,
                   const std::string& key,
                   const std::string& text,
                   const std::vector<Choice>& choices,
                   const std::string& file) {
  const YamlNode* const node = entry.find(key);
  if (node == nullptr) return;
  const Pattern pattern(text);
  const auto is_matched = [&](const Choice& choice) { return pattern.is_all_of(choice.label); };
  if (std::ranges::any_of(choices, is_matched)) return;
  throw input_error(file,
                    node->line,
                    "exclude: the label of no " + key + " matches '" + text +
                        "' (a regular expression for the complete label)");
}

}  // namespace

void require_matches(const YamlNode& exclude, const Sweep& sweep, const std::string& file) {
  for (std::size_t i = 0; i < sweep.exclude.size(); ++i) {
    const YamlNode& entry = exclude.list[i];
    require_match(entry, "dataset", sweep.exclude[i].dataset, sweep.datasets, file);
    require_match(entry, "method", sweep.exclude[i].method, sweep.methods, file);
  }
}

}  // namespace loopbench::harness

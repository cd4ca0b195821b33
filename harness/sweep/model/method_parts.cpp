#include "harness/sweep/model/method_parts.hpp"

#include <set>
#include <string>

#include "methods/method.hpp"

namespace loopbench::harness {

bool is_own(const MethodParts& parts) {
  static const std::set<std::string> kOurs = [] {
    std::set<std::string> names{""};
    for (const methods::MethodEntry& entry : methods::methods()) names.insert(entry.name);
    return names;
  }();
  const auto is_ours = [](const SharedText& stage) { return kOurs.contains(stage.text()); };
  return !parts.program.empty() || !is_ours(parts.replay) || !is_ours(parts.corrector) ||
         !is_ours(parts.smoother);
}

}  // namespace loopbench::harness

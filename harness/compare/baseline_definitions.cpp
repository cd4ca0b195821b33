#include "harness/compare/baseline_definitions.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

/// The parts of `text` ("name: a=1, b=2; file bytes hash") that are not in `other`.
std::string only_in(const std::string& text, const std::string& other) {
  const auto parts = [](const std::string& whole) {
    std::vector<std::string> out{""};
    for (const char c : whole) {
      if (c == ',' || c == ';') {
        out.emplace_back();
      } else if (c != ' ' || !out.back().empty()) {
        out.back() += c;
      }
    }
    return out;
  };
  const std::vector<std::string> others = parts(other);
  std::string out;
  for (const std::string& part : parts(text)) {
    if (std::ranges::count(others, part) > 0) continue;
    out += (out.empty() ? "" : ", ") + part;
  }
  return out.empty() ? text : out;
}

using Definitions = std::map<std::string, std::string>;

void require_same(const Definitions& baseline,
                  const Definitions& now,
                  const std::string& what,
                  bool may_be_missing) {
  for (const auto& [label, text] : baseline) {
    const auto found = now.find(label);
    if (found == now.end()) {
      if (may_be_missing) continue;
      throw InputError("the baseline has the " + what + " '" + label + "', but the results do not");
    }
    if (found->second == text) continue;
    throw InputError("the baseline defines the " + what + " '" + label + "' differently: it has '" +
                     only_in(text, found->second) + "', these results have '" +
                     only_in(found->second, text) + "'");
  }
}

bool are_comparable(const Snapshot& baseline, const Snapshot& now) {
  return !baseline.machine.empty() && baseline.machine == now.machine;
}

}  // namespace

void require_same_definitions(const Snapshot& baseline, const Snapshot& now) {
  require_same(baseline.sequences, now.sequences, "sequence", true);
  require_same(baseline.protocols, now.protocols, "protocol", false);
  require_same(baseline.metrics, now.metrics, "metric", true);
  require_same(baseline.methods, now.methods, "method", true);
  if (!are_comparable(baseline, now)) return;
  for (const auto& [label, content] : baseline.contents) {
    const auto found = now.contents.find(label);
    if (found == now.contents.end() || found->second == content) continue;
    throw InputError("the baseline has different data for the sequence '" + label +
                     "' with the same options and files: its poses, edges or reference differ "
                     "(hash " +
                     content + ", these results " + found->second + ")");
  }
}

std::string note_on_contents(const Snapshot& baseline, const Snapshot& now) {
  if (are_comparable(baseline, now) || baseline.contents.empty()) return "";
  return "contents of sequences are not compared: the baseline is from another machine (" +
         baseline.machine + ")";
}

}  // namespace loopbench::harness

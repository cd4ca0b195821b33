#include "harness/tables/common_runs.hpp"

#include <algorithm>

namespace loopbench::harness {
namespace {

std::string runs_text(const std::set<std::size_t>& runs) {
  std::string out;
  for (const std::size_t count : runs) {
    out += (out.empty() ? "" : " or ") + (count == 0 ? "none (-)" : std::to_string(count));
  }
  return out;
}

}  // namespace

std::vector<RunSet> common_runs(const std::vector<EntryRuns>& entries) {
  std::vector<RunSet> out(entries.size());
  std::vector<bool> is_done(entries.size());
  for (std::size_t first = 0; first < entries.size(); ++first) {
    if (is_done[first] || entries[first].finished.empty()) continue;
    std::vector<std::size_t> compared{first};
    is_done[first] = true;
    RunSet common = entries[first].finished;
    for (std::size_t i = 0; i < compared.size(); ++i) {
      for (std::size_t other = 0; other < entries.size(); ++other) {
        if (is_done[other] || entries[other].finished.empty()) continue;
        if (!entries[compared[i]].tried.intersects(entries[other].tried)) continue;
        compared.push_back(other);
        is_done[other] = true;
        common.keep(entries[other].finished);
      }
    }
    for (const std::size_t i : compared) out[i] = common;
  }
  return out;
}

std::string CommonRunsNote::text() const {
  if (runs_.empty()) return "";
  const std::set<std::size_t>& first = runs_.begin()->second;
  const bool is_one = std::ranges::all_of(
      runs_, [&](const auto& entry) { return first.size() == 1 && entry.second == first; });
  if (is_one && *first.begin() == 0) return "no means (-): no run was finished by every method";
  if (is_one) {
    return "means over the " + std::to_string(*first.begin()) +
           (*first.begin() == 1 ? " run" : " runs") + " that every method finished";
  }
  std::string out;
  for (const auto& [name, runs] : runs_) {
    out += (out.empty() ? "" : ", ") + name + ": " + runs_text(runs);
  }
  return "means over the runs that every method finished (" + out + ")";
}

}  // namespace loopbench::harness

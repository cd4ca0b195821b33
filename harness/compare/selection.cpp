#include "harness/compare/selection.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "harness/model/name_order.hpp"
#include "harness/model/recorded_run.hpp"

namespace loopbench::harness {
namespace {

/// Methods with a value on any run; missing values are recorded in `gaps`.
std::vector<std::size_t> ranked_methods(const Observations& all, Comparison& out) {
  std::vector<std::size_t> ranked;
  for (std::size_t m = 0; m < all.methods.size(); ++m) {
    std::vector<std::string> reasons;
    for (const Observed& one : all.values[m]) {
      if (!one.value) reasons.push_back(one.status);
    }
    const bool is_ranked = reasons.size() < all.runs.size();
    if (is_ranked) ranked.push_back(m);
    if (reasons.empty()) continue;
    out.gaps.push_back({all.methods[m], reasons.size(), counted(reasons), is_ranked});
  }
  return ranked;
}

/// What runs of one recording share; empty where no recording is known.
std::string recording_key(const ObservedRun& run) {
  const std::string_view recording = recording_of(run.group);
  const bool is_measured = run.group.starts_with("reference:");
  return recording.empty() && is_measured ? run.group : std::string(recording);
}

/// Group number of each run: runs that share a key of either kind are in one group.
std::vector<std::size_t> joined(const std::vector<std::vector<std::string>>& keys) {
  std::vector<std::size_t> group(keys.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  std::map<std::string, std::size_t> first;
  for (std::size_t run = 0; run < keys.size(); ++run) {
    for (const std::string& key : keys[run]) {
      const std::size_t other = group[first.emplace(key, run).first->second];
      const std::size_t own = group[run];
      if (own != other) std::ranges::replace(group, own, other);
    }
  }
  NameOrder order;
  for (std::size_t& g : group) g = order.index(std::to_string(g));
  return group;
}

/// Files of one recording under several names are one sequence.
std::string sequence_key(const ObservedRun& run) {
  const std::string_view recording = recording_of(run.group);
  return recording.empty() ? run.sequence : std::string(recording);
}

std::vector<std::size_t> groups(const Observations& all,
                                const std::vector<std::size_t>& runs,
                                Over over) {
  std::vector<std::vector<std::string>> keys;
  for (const std::size_t run : runs) {
    const ObservedRun& r = all.runs[run];
    std::vector<std::string>& own = keys.emplace_back();
    own.push_back("group " + r.group);
    if (over == Over::sequences) own.push_back("sequence " + sequence_key(r));
  }
  return joined(keys);
}

std::size_t count(const std::vector<std::size_t>& group) {
  return group.empty() ? 0 : 1 + *std::ranges::max_element(group);
}

}  // namespace

std::string counted(const std::vector<std::string>& reasons) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& why : reasons) ++counts[why];
  std::string out;
  for (const auto& [why, count] : counts) {
    out += (out.empty() ? "" : ", ") + why + " " + std::to_string(count);
  }
  return out;
}

KeptRuns select_runs(const Observations& all, Comparison& out) {
  KeptRuns kept{ranked_methods(all, out), {}, {}, {}};
  NameOrder sequences;
  std::set<std::string> possible_sequences;
  std::map<std::string, std::string> first_labels;  // of the sequences by recording
  std::set<std::string> same_recordings;
  out.is_paired = out.options.paired || std::ranges::any_of(all.runs, [](const ObservedRun& run) {
                    return recording_of(run.group).empty();
                  });
  const auto fewest = std::min<std::ptrdiff_t>(out.is_paired ? 2 : 1, std::ssize(kept.methods));
  std::set<std::string> measured;
  for (std::size_t run = 0; run < all.runs.size(); ++run) {
    const auto at = [&](std::size_t m) -> const Observed& { return all.values[m][run]; };
    possible_sequences.insert(sequence_key(all.runs[run]));
    const auto known = std::ranges::count_if(
        kept.methods, [&](std::size_t m) { return at(m).value || at(m).is_loss; });
    const bool has_value =
        std::ranges::any_of(kept.methods, [&](std::size_t m) { return at(m).value.has_value(); });
    if (known < fewest || !has_value) continue;
    kept.runs.push_back(run);
    const std::size_t sequence = sequences.index(sequence_key(all.runs[run]));
    const std::string& label = all.runs[run].sequence;
    if (sequence == kept.sequences.size()) kept.sequences.push_back(label);
    if (const std::string key = recording_key(all.runs[run]); !key.empty()) {
      const std::string& first = first_labels.emplace(key, label).first->second;
      if (label != first) same_recordings.insert(label + " of " + first);
    }
    kept.values.sequence.push_back(sequence);
    if (all.runs[run].has_oracle_closures) measured.insert(all.runs[run].sequence);
  }
  for (const std::size_t m : kept.methods) {
    std::vector<std::optional<double>>& row = kept.values.values.emplace_back();
    for (const std::size_t run : kept.runs) {
      const Observed& one = all.values[m][run];
      row.push_back(one.is_loss ? std::optional(kFailed) : one.value);
    }
  }
  kept.values.group = groups(all, kept.runs, out.options.over);
  kept.values.better = all.kind.better;
  kept.values.target = all.kind.target;
  kept.values.is_paired = out.is_paired;
  out.groups = count(kept.values.group);
  out.runs = kept.runs.size();
  out.possible = all.runs.size();
  out.sequences = kept.sequences.size();
  out.possible_sequences = possible_sequences.size();
  out.same_recordings.assign(same_recordings.begin(), same_recordings.end());
  out.oracle_closures.assign(measured.begin(), measured.end());
  return kept;
}

}  // namespace loopbench::harness

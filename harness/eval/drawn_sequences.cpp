#include "harness/eval/drawn_sequences.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

/// The shortest ends of the paths that all differ: "a/run.txt" and "b/run.txt".
std::vector<std::string> differing_ends(const std::vector<FilePair>& files) {
  std::vector<std::filesystem::path> rest;
  std::vector<std::string> out;
  for (const FilePair& pair : files) {
    rest.emplace_back(pair.estimate);
    out.push_back(rest.back().filename().string());
  }
  while (std::set<std::string>(out.begin(), out.end()).size() < out.size()) {
    bool is_longer = false;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::filesystem::path parent = rest[i].parent_path();
      if (parent.empty() || parent == rest[i] || parent.filename().empty()) continue;
      rest[i] = parent;
      out[i] = parent.filename().string() + "/" + out[i];
      is_longer = true;
    }
    if (!is_longer) return out;  // the same file twice
  }
  return out;
}

/// Numbers names in order of appearance.
struct Order {
  std::vector<std::string> names;
  std::size_t number(const std::string& name) {
    const auto known = std::ranges::find(names, name);
    const auto out = static_cast<std::size_t>(known - names.begin());
    if (known == names.end()) names.push_back(name);
    return out;
  }
};

}  // namespace

std::vector<RecordedRun> labelled_runs(const std::vector<FilePair>& files,
                                       const std::string& sequence) {
  try {
    return recorded_runs(files, sequence);
  } catch (const InputError&) {
    std::vector<RecordedRun> out;
    const std::vector<std::string> names = differing_ends(files);
    for (std::size_t i = 0; i < files.size(); ++i) {
      out.push_back({std::filesystem::path(files[i].reference).stem().string(),
                     names[i],
                     "0",
                     files[i].reference,
                     files[i].estimate});
    }
    return out;
  }
}

std::vector<DrawnRuns> drawn_sequences(const std::vector<EvaluationResult>& all,
                                           const std::vector<RecordedRun>& runs) {
  std::vector<DrawnRuns> out;
  Order methods, references;
  std::map<std::pair<std::string, std::string>, std::size_t> count;  // by reference and method
  for (const RecordedRun& run : runs) {
    methods.number(run.method);
    references.number(run.reference);
    ++count[{run.reference, run.method}];
  }
  const std::size_t protocols = runs.empty() ? 1 : all.size() / runs.size();
  std::map<std::pair<std::string, std::string>, std::size_t> before;
  std::map<std::string, std::size_t> place;  // in `out`, of a reference
  for (std::size_t i = 0; i < all.size(); i += protocols) {
    const RecordedRun& run = runs[i / protocols];
    const std::size_t repeat = before[{run.reference, run.method}]++;
    if (!all[i].why_failed.empty()) continue;
    if (place.emplace(run.reference, out.size()).second) {
      out.push_back({references.names.size() > 1 ? run.sequence : "", {}});
    }
    DrawnEvaluation& drawn = out[place[run.reference]].drawn.emplace_back(all[i].drawn);
    const bool has_repeats = count[{run.reference, run.method}] > 1;
    drawn.name = run.method + (has_repeats ? " " + run.run : "");
    drawn.style = curve_style(methods.names.size() > 1 ? methods.number(run.method) : repeat);
    if (methods.names.size() > 1 && has_repeats) drawn.style.dash = dash_of(repeat);
  }
  return out;
}

}  // namespace loopbench::harness

#include "harness/commands/eval/evaluated_runs.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/error.hpp"
#include "harness/commands/files/named_trajectory.hpp"

namespace loopbench::harness {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool is_run_number(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, is_digit);
}

/// The same file from any current folder, under one name; `-` is standard input.
std::string absolute_name(const std::string& name) {
  const std::string file = file_of(name);
  if (file.empty() || file == "-") return name;
  const std::filesystem::path given = std::filesystem::absolute(file);
  const std::filesystem::path normal = given.lexically_normal();
  std::error_code none;  // FOLDER/.. is another folder if FOLDER is a symbolic link
  const bool is_same =
      !std::filesystem::exists(given, none) || std::filesystem::equivalent(given, normal, none);
  const std::string out = (is_same ? normal : given).string();
  return names_bag(name) ? to_text(BagName{out, bag_name(name).topic}) : out;
}

/// `name`: as returned by absolute_name().
std::filesystem::path parent_folder(const std::string& name) {
  return std::filesystem::path(file_of(name)).parent_path();
}

bool is_generic(const std::string& stem) {
  constexpr std::array kNames{"groundtruth",
                              "ground_truth",
                              "gt",
                              "truth",
                              "reference",
                              "ref",
                              "data",
                              "stamped_groundtruth",
                              "gt_tum",
                              "gt_poses",
                              "poses"};
  return std::ranges::count(kNames, stem) > 0;
}

std::string sequence_of(const std::string& reference) {
  const std::string stem = plain_stem(reference);
  if (!is_generic(stem)) return stem;
  if (names_bag(reference)) return std::filesystem::path(file_of(reference)).stem().string();
  const std::string folder = parent_folder(reference).filename().string();
  return folder.empty() ? stem : folder;
}

/// Splits "name_run3", "name_3" or "name-3"; false if the name has no number at its end.
bool split_run(const std::string& stem, EvaluatedRun& out) {
  std::size_t digits = stem.size();
  while (digits > 0 && is_digit(stem[digits - 1])) --digits;
  std::size_t end = digits;
  if (end >= 3 && stem.compare(end - 3, 3, "run") == 0) end -= 3;
  const bool has_separator = end > 1 && (stem[end - 1] == '_' || stem[end - 1] == '-');
  if (digits == stem.size() || !has_separator) return false;
  out.method = stem.substr(0, end - 1);
  out.run = stem.substr(digits);
  return true;
}

/// Whether `folder` is METHOD/SEQUENCE. Under a reference such as SEQUENCE/groundtruth.txt, only
/// for numbered files, because SEQUENCE can also contain one file for each method.
bool is_sequence_folder(const std::filesystem::path& folder, const EvaluatedRun& run) {
  if (folder.filename() == plain_stem(run.reference)) return true;
  return folder.filename() == run.sequence && folder != parent_folder(run.reference) &&
         is_run_number(plain_stem(run.estimate));
}

/// With absolute names of the files.
EvaluatedRun labelled(const std::string& reference,
                      const std::string& estimate,
                      const std::string& sequence) {
  EvaluatedRun out{sequence, "", "0", reference, estimate};
  const std::string stem = plain_stem(estimate);
  const std::filesystem::path folder = parent_folder(estimate);
  if (is_sequence_folder(folder, out)) {  // METHOD/SEQUENCE/RUN.txt
    out.method = folder.parent_path().filename().string();
    out.run = stem;
  } else if (is_run_number(stem)) {
    out.method = folder.filename().string();
    out.run = stem;
  } else if (!split_run(stem, out)) {
    out.method = stem;
  }
  return out;
}

/// The method of a run whose labels another file has, too.
std::string method_with_folder(const EvaluatedRun& run) {
  std::filesystem::path folder = parent_folder(run.estimate);
  const bool is_numbered = is_run_number(plain_stem(run.estimate));
  if (is_numbered || folder.filename() == run.sequence) folder = folder.parent_path();
  const std::string name = folder.filename().string();
  return is_numbered ? name : name + "/" + run.method;
}

using Labels = std::pair<std::string, std::string>;  // method and run

Labels labels_of(const EvaluatedRun& run) { return {run.method, run.run}; }

}  // namespace

std::vector<EvaluatedRun> evaluated_runs(const std::string& reference,
                                         const std::vector<std::string>& estimates,
                                         const std::string& sequence) {
  const std::string name = absolute_name(reference);
  const std::string label = sequence.empty() ? sequence_of(name) : sequence;
  std::vector<EvaluatedRun> out;
  for (const std::string& estimate : estimates) {
    out.push_back(labelled(name, absolute_name(estimate), label));
  }
  std::set<Labels> labels;
  std::set<std::string> ambiguous;  // methods
  for (const EvaluatedRun& run : out) {
    if (!labels.insert(labels_of(run)).second) ambiguous.insert(run.method);
  }
  for (EvaluatedRun& run : out) {
    if (ambiguous.contains(run.method)) run.method = method_with_folder(run);
  }
  std::map<Labels, const EvaluatedRun*> taken;
  for (const EvaluatedRun& run : out) {
    const auto [other, is_new] = taken.emplace(labels_of(run), &run);
    if (is_new) continue;
    if (run.estimate == other->second->estimate) {
      throw InputError(run.estimate + ": is listed twice");
    }
    throw InputError(run.estimate + ": has the same sequence '" + run.sequence + "', method '" +
                     run.method + "' and run " + run.run + " as " + other->second->estimate +
                     ", expected METHOD/SEQUENCE/RUN.txt or NAME_RUN.txt");
  }
  return out;
}

std::vector<EvaluatedRun> labelled_runs(const std::string& reference,
                                        const std::vector<std::string>& estimates,
                                        const std::string& sequence) {
  try {
    return evaluated_runs(reference, estimates, sequence);
  } catch (const InputError&) {
    const std::string stem = std::filesystem::path(reference).stem().string();
    std::vector<EvaluatedRun> out;
    for (const std::string& estimate : estimates) {
      out.push_back({stem, estimate, "0", reference, estimate});
    }
    return out;
  }
}

}  // namespace loopbench::harness

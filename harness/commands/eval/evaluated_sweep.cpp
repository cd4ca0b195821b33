#include "harness/commands/eval/evaluated_sweep.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "harness/commands/eval/evaluated_file.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "methods/function_method.hpp"

namespace loopbench::harness {
namespace {

/// As options of the dataset and in the text of the sweep.
constexpr std::pair<const char*, std::string EvaluatedRun::*> kFields[] = {
    {"sequence", &EvaluatedRun::sequence},
    {"method", &EvaluatedRun::method},
    {"run", &EvaluatedRun::run},
    {"reference", &EvaluatedRun::reference},
    {"estimate", &EvaluatedRun::estimate},
    {"group", &EvaluatedRun::group}};

Params options_of(const EvaluatedRun& run, Params shared) {
  for (const auto& [name, member] : kFields) shared[name] = run.*member;
  shared["common"] = run.common;
  return shared;
}

/// Files are read by the evaluation; the catalogue describes them for the store.
Catalogue evaluated_catalogue(const std::vector<std::filesystem::path>& plugins) {
  // Describing all methods and datasets takes longer than the evaluation of a thousand poses.
  static const std::vector<metrics::MetricEntry> kBuiltIn = catalogue({}).metrics;
  Catalogue out = plugins.empty() ? Catalogue{{}, {}, kBuiltIn} : catalogue(plugins);
  out.datasets = {{"files", "a reference and an estimate", {}, {}, {}}};
  out.methods = {methods::method("recorded",
                                 "poses of the estimate's file",
                                 [](const Problem& problem) { return problem.keyframes; })};
  return out;
}

/// The runs as text, with the options that all files share.
std::string manifest(const std::vector<EvaluatedRun>& runs, const Params& options) {
  std::string out = std::string(kEvaluatedTitle) + "\n";
  out += std::string(kEvaluatedOptions) + to_text(options) + "\n";
  for (const EvaluatedRun& run : runs) {
    nlohmann::ordered_json line;
    for (const auto& [name, member] : kFields) {
      if (!(run.*member).empty()) line[name] = run.*member;
    }
    out += "- " + line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }
  return out;
}

std::vector<Cell> cells_of_files(const std::vector<EvaluatedRun>& runs, const Sweep& sweep) {
  const auto less = [](const std::string& a, const std::string& b) {
    return strverscmp(a.c_str(), b.c_str()) < 0;
  };
  using Names = std::set<std::string, decltype(less)>;
  std::map<std::string, Names> names;
  NameOrder sequences;
  for (const EvaluatedRun& run : runs) {
    sequences.index(run.sequence);
    names[run.sequence].insert(run.run);
  }
  std::vector<Cell> out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Names& all = names[runs[i].sequence];
    const auto method = std::ranges::find(sweep.methods, runs[i].method, &MethodChoice::label);
    out.push_back({0,
                   i,
                   static_cast<std::size_t>(method - sweep.methods.begin()),
                   static_cast<int>(std::distance(all.begin(), all.find(runs[i].run)))});
  }
  const auto place = [&](const Cell& cell) {
    return std::tuple(sequences.index(runs[cell.dataset].sequence), cell.repeat, cell.method);
  };
  std::ranges::sort(out, {}, place);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].index = i;
  return out;
}

bool uses_digits(const EvaluatedSweep& files) {
  if (has_offset(files.body)) return false;
  return std::ranges::any_of(files.sweep.protocols, [](const metrics::NamedProtocol& p) {
    return p.rules.form == metrics::ErrorForm::kitti ||
           p.rules.association == metrics::Association::evo;
  });
}

}  // namespace

EvaluatedSweep evaluated_sweep(std::vector<EvaluatedRun> runs, const EvalArguments& a) {
  EvaluatedSweep out{
      a, std::move(runs), reference_body(a), evaluated_catalogue(a.plugins), {}, false, {}};
  const Params shared = reading_options(a);
  Sweep& sweep = out.sweep;
  sweep.name = "eval";
  sweep.text = manifest(out.runs, shared);
  sweep.protocols = protocols(a);
  sweep.metrics = metric_choices(a, out.catalogue, sweep.protocols);
  sweep.times = {metrics::Times::keyframes};
  sweep.min_coverage = a.min_coverage.value_or(a.store.empty() ? 0.0 : kDefaultMinCoverage);
  sweep.table.split = {"sequence"};
  for (const EvaluatedRun& run : out.runs) {
    sweep.datasets.push_back({run.sequence, {"files", options_of(run, shared)}});
    if (std::ranges::count(sweep.methods, run.method, &MethodChoice::label) == 0) {
      sweep.methods.push_back({run.method, {{"recorded", {}}}});
    }
  }
  if (!sweep.methods.empty()) sweep.baseline = sweep.methods.front().label;
  out.has_digits = uses_digits(out);
  out.cells = cells_of_files(out.runs, sweep);
  return out;
}

std::vector<EvaluatedRun> runs_of_manifest(const std::string& text) {
  std::vector<EvaluatedRun> out;
  std::istringstream lines(text);
  std::string line;
  if (!std::getline(lines, line) || line != kEvaluatedTitle) return out;
  std::set<std::tuple<std::string, std::string, std::string>> known;
  while (std::getline(lines, line)) {
    if (!line.starts_with("- ")) continue;
    const nlohmann::json json = nlohmann::json::parse(line.substr(2), nullptr, false);
    if (!json.is_object()) continue;
    EvaluatedRun run;
    for (const auto& [name, member] : kFields) run.*member = json.value(name, "");
    if (known.emplace(run.sequence, run.method, run.run).second) out.push_back(std::move(run));
  }
  return out;
}

}  // namespace loopbench::harness

#include "harness/eval/recorded_sweep.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/formats/text_formats.hpp"
#include "harness/model/recorded_run.hpp"
#include "methods/function_method.hpp"

namespace loopbench::harness {
namespace {

struct RecordedOptions {
  std::string sequence, method, run, reference, estimate, group, common;
  Format format = Format::automatic;
  Format reference_format = Format::automatic;
  Repeats repeats = Repeats::refuse;
  std::string times = {}, reference_body = {};
  double period = ReadOptions{}.period;
};

template <class Visit>
void fields(RecordedOptions& o, Visit visit) {
  visit("sequence", o.sequence, "label of the sequence");
  visit("method", o.method, "label of the system");
  visit("run", o.run, "name of the run");
  visit("reference", o.reference, "reference trajectory");
  visit("estimate", o.estimate, "estimated trajectory");
  visit("group", o.group, "name of the recording");
  visit("common", o.common, "times to evaluate [s]");
  visit("format", o.format, "format of the estimate");
  visit("reference_format", o.reference_format, "format of the reference");
  visit("repeats", o.repeats, "handling of equal stamps");
  visit("times", o.times, "times file of KITTI poses");
  visit("reference_body", o.reference_body, "extrinsic offset of the reference's body");
  visit("period", o.period, "time between poses without stamps [s]", GreaterThan{0.0});
}

RecordedFile read_recorded(const RecordedOptions& o,
                           const std::string& file,
                           Format format,
                           bool with_matrices) {
  ReadOptions options;
  options.format = format == Format::automatic ? detect_format(file) : format;
  options.period = o.period;
  options.repeats = o.repeats;
  const bool is_kitti = options.format == Format::kitti;
  if (is_kitti && !o.times.empty()) options.times = o.times;
  RecordedFile out;
  options.findings = &out.findings;
  out.poses = read_trajectory(file, options);
  if (out.poses.empty()) throw input_error(file, 0, "has no poses, expected at least one");
  if (options.format == Format::g2o || (is_kitti && !options.times)) {
    out.unstamped = file + ": is " + to_text(options.format);
  }
  if (is_kitti && with_matrices) out.matrices = read_kitti_matrices(file);
  return out;
}

RecordedFile read_reference(const RecordedOptions& o, bool with_matrices) {
  EvalArguments offset;
  if (!o.reference_body.empty()) offset.reference_body = o.reference_body;
  RecordedFile out = read_recorded(o, o.reference, o.reference_format, with_matrices);
  out.poses = to_estimate_body(std::move(out.poses), reference_body(offset));
  return out;
}

Sequence load_recorded(const RecordedOptions& o, const DataRoot&) {
  Sequence out;
  out.name = o.sequence;
  out.reference = read_reference(o, false).poses;
  out.problem.keyframes = read_recorded(o, o.estimate, o.format, false).poses;
  out.provenance.inputs = {{file_of(o.reference)}, {file_of(o.estimate)}};
  out.provenance.reference = file_of(o.reference);
  return out;
}

}  // namespace

Params recorded_file_options(const RecordedRun& run, const EvalArguments& a) {
  RecordedOptions o{
      run.sequence, run.method, run.run, run.reference, run.estimate, run.group, run.common};
  FieldType<Format>::assign("format", o.format, a.format);
  o.reference_format = o.format;
  if (!a.reference_format.empty()) {
    FieldType<Format>::assign("ref-format", o.reference_format, a.reference_format);
  }
  FieldType<Repeats>::assign("repeats", o.repeats, a.repeats);
  o.times = a.times;
  o.reference_body = a.reference_body.value_or("");
  if (a.period) o.period = *a.period;
  return echo(o);
}

namespace {

/// The options that all files share, as text.
std::string common_options(const EvalArguments& a) {
  Params out = recorded_file_options({}, a);
  for (const char* own :
       {"sequence", "method", "run", "reference", "estimate", "group", "common"}) {
    out.erase(own);
  }
  return to_text(out);
}

/// Whether any file has this format, by the arguments or its content.
bool has_poses_of(Format wanted, const EvalArguments& a, const std::vector<RecordedRun>& runs) {
  const auto is_wanted = [wanted](const std::string& file, const std::string& word) {
    Format format = Format::automatic;
    FieldType<Format>::assign("format", format, word);
    if (format != Format::automatic || !std::filesystem::is_regular_file(file)) {
      return format == wanted;
    }
    return detect_format(file) == wanted;
  };
  const std::string& reference = a.reference_format.empty() ? a.format : a.reference_format;
  return std::ranges::any_of(runs, [&](const RecordedRun& run) {
    return is_wanted(run.reference, reference) || is_wanted(run.estimate, a.format);
  });
}

}  // namespace

RecordedFile recorded_reference(const Params& options, bool with_matrices) {
  return read_reference(with(RecordedOptions{}, options), with_matrices);
}

RecordedFile recorded_estimate(const Params& options, bool with_matrices) {
  const RecordedOptions o = with(RecordedOptions{}, options);
  return read_recorded(o, o.estimate, o.format, with_matrices);
}

bool uses_digits(const Sweep& sweep, const EvalArguments& a) {
  if (has_offset(reference_body(a))) return false;
  return std::ranges::any_of(sweep.protocols, [](const metrics::NamedProtocol& p) {
    return p.rules.form == metrics::ErrorForm::kitti ||
           p.rules.association == metrics::Association::evo;
  });
}

void check_stamp_options(const EvalArguments& a, const std::vector<RecordedRun>& runs) {
  const bool has_kitti = (!a.times.empty() || a.period) && has_poses_of(Format::kitti, a, runs);
  if (!a.times.empty() && !has_kitti) {
    throw InputError(a.times + ": is a times file, but no file has KITTI poses");
  }
  const bool has_unstamped = has_kitti && a.times.empty();
  if (a.period && !has_unstamped && !has_poses_of(Format::g2o, a, runs)) {
    throw InputError("--period " + to_text(*a.period) +
                     ": all files have stamps, expected KITTI poses without --times, or g2o");
  }
}

Catalogue recorded_catalogue(const std::vector<std::filesystem::path>& plugins) {
  Catalogue out = catalogue(plugins);
  out.datasets = {dataset<RecordedOptions>("files", "a reference and an estimate", load_recorded)};
  out.methods = {methods::method("recorded",
                                 "poses of the estimate's file",
                                 [](const Problem& problem) { return problem.keyframes; })};
  return out;
}

Sweep recorded_sweep(const std::vector<RecordedRun>& runs,
                     const EvalArguments& a,
                     const Catalogue& catalogue) {
  Sweep out;
  out.name = "eval";
  out.text = manifest(runs, common_options(a));
  out.protocols = protocols(a);
  out.metrics = metric_choices(a, catalogue, out.protocols);
  out.times = {metrics::Times::keyframes};
  out.min_coverage = a.min_coverage.value_or(a.store.empty() ? 0.0 : kDefaultMinCoverage);
  out.table.split = {"sequence"};
  for (const RecordedRun& run : runs) {
    out.datasets.push_back({run.sequence, {"files", recorded_file_options(run, a)}});
    const bool is_known = std::ranges::any_of(
        out.methods, [&](const MethodChoice& m) { return m.label == run.method; });
    if (!is_known) out.methods.push_back({run.method, {{"recorded", {}}}});
  }
  if (!out.methods.empty()) out.baseline = out.methods.front().label;
  return out;
}

std::vector<Cell> recorded_cells(const std::vector<RecordedRun>& runs, const Sweep& sweep) {
  const auto less = [](const std::string& a, const std::string& b) { return natural_less(a, b); };
  using Names = std::set<std::string, decltype(less)>;
  std::map<std::string, Names> names;
  std::vector<std::string> sequences;
  for (const RecordedRun& run : runs) {
    if (names[run.sequence].empty()) sequences.push_back(run.sequence);
    names[run.sequence].insert(run.run);
  }
  std::vector<Cell> out;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Names& all = names[runs[i].sequence];
    const auto method = std::ranges::find(sweep.methods, runs[i].method, &MethodChoice::label);
    out.push_back({0,
                   i,
                   static_cast<std::size_t>(method - sweep.methods.begin()),
                   static_cast<int>(std::distance(all.begin(), all.find(runs[i].run)))});
  }
  const auto place = [&](const Cell& cell) {
    const auto sequence = std::ranges::find(sequences, runs[cell.dataset].sequence);
    return std::tuple(sequence - sequences.begin(), cell.repeat, cell.method);
  };
  std::ranges::sort(out, {}, place);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].index = i;
  return out;
}

std::string manifest(const std::vector<RecordedRun>& runs, const std::string& options) {
  std::string out = std::string(kRecordedTitle) + "\n";
  if (!options.empty()) out += std::string(kRecordedOptions) + options + "\n";
  for (const RecordedRun& run : runs) {
    nlohmann::ordered_json line{{"sequence", run.sequence},
                                {"method", run.method},
                                {"run", run.run},
                                {"reference", run.reference},
                                {"estimate", run.estimate}};
    if (!run.group.empty()) line["group"] = run.group;
    out += "- " + line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }
  return out;
}

std::vector<RecordedRun> runs_of_manifest(const std::string& text) {
  std::vector<RecordedRun> out;
  std::istringstream lines(text);
  std::string line;
  if (!std::getline(lines, line) || line != kRecordedTitle) return out;
  std::set<std::tuple<std::string, std::string, std::string>> known;
  while (std::getline(lines, line)) {
    if (!line.starts_with("- ")) continue;
    const nlohmann::json json = nlohmann::json::parse(line.substr(2), nullptr, false);
    if (!json.is_object()) continue;
    const auto text_of = [&](const char* key) { return json.value(key, ""); };
    RecordedRun run{text_of("sequence"),
                    text_of("method"),
                    text_of("run"),
                    text_of("reference"),
                    text_of("estimate"),
                    text_of("group")};
    if (known.emplace(run.sequence, run.method, run.run).second) out.push_back(std::move(run));
  }
  return out;
}

}  // namespace loopbench::harness

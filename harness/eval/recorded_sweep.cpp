#include "harness/eval/recorded_sweep.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "datasets/bags/bag_name.hpp"
#include "datasets/core/polyline.hpp"
#include "harness/eval/recorded_store.hpp"
#include "harness/model/recorded_run.hpp"
#include "methods/correctors/raw.hpp"

namespace loopbench::harness {
namespace {

struct RecordedOptions {
  std::string sequence, method, run, reference, estimate;
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
  visit("format", o.format, "format of the estimate");
  visit("reference_format", o.reference_format, "format of the reference");
  visit("repeats", o.repeats, "handling of equal stamps");
  visit("times", o.times, "times file of KITTI poses");
  visit("reference_body", o.reference_body, "extrinsic offset of the reference's body");
  visit("period", o.period, "time between poses without stamps [s]", GreaterThan{0.0});
}

RecordedFile read_recorded(const RecordedOptions& o, const std::string& file, Format format) {
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
  return out;
}

RecordedFile read_reference(const RecordedOptions& o) {
  EvalArguments offset;
  if (!o.reference_body.empty()) offset.reference_body = o.reference_body;
  RecordedFile out = read_recorded(o, o.reference, o.reference_format);
  out.poses = to_estimate_body(std::move(out.poses), reference_body(offset));
  return out;
}

Sequence sequence_of(const RecordedOptions& o, Trajectory reference, Trajectory estimate) {
  Sequence out;
  out.name = o.sequence;
  out.reference = std::move(reference);
  out.problem.keyframes = std::move(estimate);
  out.provenance.inputs = {{file_of(o.reference)}, {file_of(o.estimate)}};
  out.provenance.reference = file_of(o.reference);
  return out;
}

Sequence load_recorded(const RecordedOptions& o, const DataRoot&) {
  return sequence_of(o, read_reference(o).poses, read_recorded(o, o.estimate, o.format).poses);
}

Params options_of(const RecordedRun& run, const EvalArguments& a) {
  RecordedOptions o{run.sequence, run.method, run.run, run.reference, run.estimate};
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

/// The options that all files share, as text.
std::string common_options(const EvalArguments& a) {
  Params out = options_of({}, a);
  for (const char* own : {"sequence", "method", "run", "reference", "estimate"}) out.erase(own);
  return to_text(out);
}

std::vector<MetricChoice> metrics_of(const EvalArguments& a,
                                     const std::vector<metrics::NamedProtocol>& protocols) {
  std::vector<MetricChoice> out;
  for (const metrics::NamedProtocol& protocol : protocols) {
    for (const MetricRequest& request : metric_requests(a, protocol.rules)) {
      const std::string name = label(EvaluatedMetric{request.metric, request.options, {}, {}, {}});
      const bool is_known =
          std::ranges::any_of(out, [&](const MetricChoice& m) { return m.label == name; });
      if (!is_known) out.push_back({name, {request.metric, request.options}});
    }
  }
  return out;
}

}  // namespace

RecordedFile recorded_reference(const Params& options) {
  return read_reference(with(RecordedOptions{}, options));
}

RecordedFile recorded_estimate(const Params& options) {
  const RecordedOptions o = with(RecordedOptions{}, options);
  return read_recorded(o, o.estimate, o.format);
}

Sequence recorded_sequence(const Params& options, Trajectory reference, Trajectory estimate) {
  return sequence_of(with(RecordedOptions{}, options), std::move(reference), std::move(estimate));
}

Catalogue recorded_catalogue() {
  return {{dataset<RecordedOptions>("files", "a reference and an estimate", load_recorded)},
          {methods::method<methods::Raw>("recorded", "poses of the estimate's file")},
          metrics::metrics()};
}

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

Sweep recorded_sweep(const std::vector<RecordedRun>& runs, const EvalArguments& a) {
  Sweep out;
  out.name = "eval";
  out.text = manifest(runs, common_options(a));
  out.protocols = protocols(a);
  out.metrics = metrics_of(a, out.protocols);
  out.times = {metrics::Times::keyframes};
  out.min_coverage = a.min_coverage.value_or(kUsualMinCoverage);
  out.table.split = {"sequence"};
  for (const RecordedRun& run : runs) {
    out.datasets.push_back({run.sequence, {"files", options_of(run, a)}});
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
    const nlohmann::ordered_json line{{"sequence", run.sequence},
                                      {"method", run.method},
                                      {"run", run.run},
                                      {"reference", run.reference},
                                      {"estimate", run.estimate}};
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
                    text_of("estimate")};
    if (known.emplace(run.sequence, run.method, run.run).second) out.push_back(std::move(run));
  }
  return out;
}

}  // namespace loopbench::harness

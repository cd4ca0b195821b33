#include "datasets/trajectory_inputs.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/core/disabled_options.hpp"
#include "datasets/formats/json_graph.hpp"

namespace loopbench {
namespace {

/// Rejects options that need the rotations of a reference without any.
void require_no_rotations(const TrajectoryOptions& o) {
  const std::string why = o.reference + " has positions without rotation";
  require_option(o.closures != ClosureSource::reference,
                 "closures.source",
                 "reference needs rotations, but " + why);
  require_option(!has_offset(o.reference_body),
                 "reference_body",
                 "needs rotations, but " + why + "; `eval --ref-body` moves the estimates instead");
}

/// A stated offset or period is accepted instead of stamps.
void require_common_time(const FileClock& estimate,
                         const FileClock& other,
                         const TrajectoryOptions& o) {
  const bool is_mixed = (estimate.clock == Clock::stamps) != (other.clock == Clock::stamps);
  if (o.offset != 0.0 || (is_mixed && o.period != TrajectoryOptions{}.period)) return;
  const std::string why = why_no_common_time(estimate, other);
  if (!why.empty()) throw InputError(why);
}

bool same_bits(const Trajectory& a, const Trajectory& b) {
  return std::ranges::equal(a, b, [](const StampedPose& x, const StampedPose& y) {
    return x.stamp == y.stamp && x.world_from_body.translation == y.world_from_body.translation &&
           x.world_from_body.rotation.coeffs() == y.world_from_body.rotation.coeffs();
  });
}

/// Reads one file after the other, the estimate first.
class InputReader {
 public:
  InputReader(const TrajectoryOptions& options, const DataRoot& root, Provenance& provenance)
      : o_(options), root_(root), provenance_(provenance) {
    if (!o_.times.empty()) times_ = open(o_.times, "times");
  }

  /// Finds a file and adds it to the inputs.
  std::filesystem::path open(const std::string& path, const std::string& option) {
    return provenance_.inputs.emplace_back(InputPath{root_.find(file_of(path)), option}).path;
  }

  /// The same with the topic of a bag.
  std::filesystem::path open_topic(const std::string& path, const std::string& option) {
    const std::filesystem::path file = open(path, option);
    if (!names_bag(path)) return file;
    return to_text(BagName{file.string(), bag_name(path).topic});
  }

  /// The poses of a file; none if `path` is empty. Those of the `estimate` (null: of this file)
  /// decide the unit of stamps if several fit.
  Trajectory read(const std::string& path,
                  const std::string& option,
                  Format format,
                  const Trajectory* estimate) {
    if (path.empty()) return {};
    const std::filesystem::path file = open_topic(path, option);
    ReadFindings findings;
    ReadOptions options = options_of(file, format);
    options.positions = option == "reference";
    options.findings = &findings;
    Trajectory out = read_trajectory(file, options);
    const double offset = option == "reference" ? -o_.offset : 0.0;
    if (estimate) options.stamp_unit = better_unit(out, findings, *estimate, offset);
    if (estimate && options.stamp_unit != StampUnit::automatic) {
      findings = {};
      out = read_trajectory(file, options);
    }
    require_clear_unit(path, findings);
    const FileClock clock{path, findings.clock, out.size() + findings.invalid};
    if (!estimate) estimate_clock_ = clock;
    require_common_time(estimate_clock_, clock, o_);
    add_notes(path, findings);
    return out;
  }

 private:
  ReadOptions options_of(const std::filesystem::path& file, Format format) const {
    return {.format = format,
            .times = times_ && gets_times(file) ? times_ : std::nullopt,
            .period = o_.period,
            .repeats = o_.repeats,
            .sort = o_.sort,
            .drop_invalid = o_.drop_invalid,
            .stamp_unit = o_.stamp_unit};
  }

  static bool lacks_stamps(const std::filesystem::path& file) {
    return !names_bag(file.string()) && takes_times(file, detect_format(file));
  }

  /// Whether the times are those of this file: it has no stamps, or it has numbers of frames and no
  /// other file needs them.
  bool gets_times(const std::filesystem::path& file) const {
    if (names_bag(file.string())) return false;
    if (lacks_stamps(file)) return true;
    const auto needs_them = [&](const std::string& other) {
      return !other.empty() && !names_bag(other) && lacks_stamps(root_.find(other));
    };
    return can_take_times(file, detect_format(file)) &&
           std::ranges::none_of(std::array{o_.estimate, o_.frames, o_.reference}, needs_them);
  }

  void add_notes(const std::string& path, const ReadFindings& findings) {
    std::vector<std::string>& notes = provenance_.notes;
    for (const std::string& note : reading_notes(findings)) notes.push_back(path + ": " + note);
    if (findings.origin) notes.push_back(path + ": " + to_text(*findings.origin));
    if (!findings.damage.empty()) notes.push_back(path + ": " + findings.damage);
  }

  const TrajectoryOptions& o_;
  const DataRoot& root_;
  Provenance& provenance_;
  std::optional<std::filesystem::path> times_;
  FileClock estimate_clock_;
};

}  // namespace

TrajectoryInputs read_inputs(const TrajectoryOptions& o,
                             const DataRoot& root,
                             Provenance& provenance) {
  InputReader reader(o, root, provenance);
  TrajectoryInputs in;
  in.estimate = reader.read(o.estimate, "estimate", o.format, nullptr);
  in.frames = reader.read(o.frames, "frames", o.format, &in.estimate);
  in.reference = reader.read(o.reference, "reference", o.reference_format, &in.estimate);
  for (StampedPose& pose : in.reference) pose.stamp -= o.offset;
  if (!o.reference.empty()) provenance.reference = provenance.inputs.back().path;
  if (lacks_rotations(in.reference)) require_no_rotations(o);
  if (o.closures == ClosureSource::estimate) {
    in.other_run = reader.read(o.closures_file, "closures.file", o.format, &in.estimate);
    in.run_is_reference = !in.reference.empty() && same_bits(in.other_run, in.reference);
  }
  in.reference = to_estimate_body(std::move(in.reference), o.reference_body);
  if (o.closures == ClosureSource::file) {
    const std::filesystem::path file = reader.open(o.closures_file, "closures.file");
    if (file.extension() == ".g2o" || is_json_graph(file)) {
      in.graph_closures = read_graph_closures(file, in.estimate);
    } else {
      in.closures = read_closure_file(file, o.closures_noise);
    }
  }
  if (!o.anchors_file.empty()) {
    const std::filesystem::path file = reader.open_topic(o.anchors_file, "anchors.file");
    in.anchors = read_anchor_file(file, o.anchors_sigma);
  }
  return in;
}

}  // namespace loopbench

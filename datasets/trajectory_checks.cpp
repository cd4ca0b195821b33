#include <string>

#include "datasets/core/disabled_options.hpp"
#include "datasets/trajectory_dataset.hpp"

namespace loopbench {
namespace {

void check_disabled(const TrajectoryOptions& o, const Params& given) {
  const auto reject_with_source = [&, source = to_text(o.closures)](
                                      std::initializer_list<const char*> options,
                                      const std::string& expected) {
    reject_disabled(given, options, "closures.source", source, expected);
  };
  const bool measured =
      o.closures == ClosureSource::reference || o.closures == ClosureSource::estimate;
  if (!measured) {
    reject_with_source({"closures.rule",
                        "closures.radius",
                        "closures.angle",
                        "closures.min_gap",
                        "closures.max",
                        "closures.max_interval"},
                       "reference or estimate");
  }
  const bool is_view = o.closures_rule == ClosureRule::view;
  if (!is_view) {
    reject_disabled(given,
                    {"closures.view.horizontal",
                     "closures.view.vertical",
                     "closures.view.nearest",
                     "closures.view.farthest",
                     "closures.view.share",
                     "closures.view.forward"},
                    "closures.rule",
                    "distance",
                    "view");
  }
  if (is_view) {
    reject_disabled(
        given, {"closures.radius", "closures.angle"}, "closures.rule", "view", "distance");
  }
  if (o.closures == ClosureSource::none) {
    reject_with_source({"closures.sigma_t", "closures.sigma_r", "closures.max_diff"},
                       "file, reference or estimate");
  }
  if (o.closures == ClosureSource::none || o.closures == ClosureSource::reference) {
    reject_with_source({"closures.file"}, "file or estimate");
  }
  if (o.closures == ClosureSource::none && o.false_closures.share > 0.0) {
    reject_with_source({"false_closures.share"}, "file, reference or estimate");
  }
  if (o.anchors_file.empty()) reject_disabled_by_missing(given, "anchors.", "anchors.file");
  if (o.reference.empty()) reject_disabled_by_missing(given, "reference_", "reference");
  if (o.keyframes.rule == KeyframeRule::all) {
    reject_disabled(
        given, {"keyframes.value"}, "keyframes.rule", "all", "every, seconds, metres or count");
  }
}

}  // namespace

void check_combination(const TrajectoryOptions& o, const Params& given) {
  require_option(!o.estimate.empty(), "estimate", "is empty, expected a trajectory file");
  const bool needs_file =
      o.closures == ClosureSource::file || o.closures == ClosureSource::estimate;
  require_option(!needs_file || !o.closures_file.empty(),
                 "closures.file",
                 "is empty, expected a file for closures.source = " + to_text(o.closures));
  require_option(o.closures != ClosureSource::reference || !o.reference.empty(),
                 "reference",
                 "is empty, expected a file for closures.source = reference");
  require_option(o.closures_scale == ClosureScale::same || o.closures == ClosureSource::estimate,
                 "closures.scale",
                 "local has no effect without another run, expected closures.source = estimate");
  require_option(o.closures_view.nearest < o.closures_view.farthest,
                 "closures.view.nearest",
                 "is not below closures.view.farthest");
  pose_of(o.reference_body);  // throws if it is not a valid pose
  check_disabled(o, given);
}

}  // namespace loopbench

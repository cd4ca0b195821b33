#include "metrics/correction/gain_along.hpp"

#include <cmath>
#include <stdexcept>

#include "datasets/core/polyline.hpp"
#include "metrics/pairing/pair_search.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {
namespace {

/// Magnitudes of the errors of all pairs.
struct Errors {
  std::vector<double> metres;
  std::array<std::vector<double>, 3> axes;  ///< x, y, z [m]
  std::vector<double> radians;
};

Errors errors(const Evaluation& evaluation) {
  Errors out;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const Pose& truth = evaluation.reference[i].world_from_body;
    const Pose& pose = evaluation.estimate[i].world_from_body;
    const Vector3 e = pose.translation - truth.translation;
    out.metres.push_back(e.norm());
    for (int a = 0; a < 3; ++a) out.axes[static_cast<std::size_t>(a)].push_back(std::abs(e[a]));
    out.radians.push_back(angle_between(pose.rotation, truth.rotation));
  }
  return out;
}

double quoted(const Statistics& s, Statistic which) {
  if (which == Statistic::mean) return s.mean;
  return which == Statistic::median ? s.median : s.rmse;
}

Score gain(const std::string& relation,
           const std::string& axis,
           const Protocol& protocol,
           std::vector<double> before,
           std::vector<double> after) {
  const auto undefined = [&](const char* why) {
    return directed({relation, axis, "%", {}, why}, Better::higher);
  };
  if (before.empty()) return undefined("no pose in this part");
  const std::size_t count = after.size();
  const double b = quoted(statistics(std::move(before), protocol.ddof), protocol.statistic);
  const double a = quoted(statistics(std::move(after), protocol.ddof), protocol.statistic);
  if (b == 0.0) return undefined("the error before correction is zero");
  Score out = directed(single(relation, axis, "%", 100.0 * (1.0 - a / b)), Better::higher);
  out.statistics.count = count;
  return out;
}

/// The `errors` of poses in third 0, 1 or 2 of the path.
std::vector<double> third(const std::vector<double>& errors,
                          const std::vector<double>& distance,
                          int which) {
  std::vector<double> out;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double share = distance.back() > 0.0 ? distance[i] / distance.back() : 0.0;
    const int part = share < 1.0 / 3.0 ? 0 : share < 2.0 / 3.0 ? 1 : 2;
    if (part == which) out.push_back(errors[i]);
  }
  return out;
}

Evaluation evaluate_raw(const Context& context) {
  const Problem& problem = needed(context.problem, "gain_along", "keyframes before correction");
  const Trajectory& reference = needed(context.reference, "gain_along", "the complete reference");
  return evaluate(reference,
                  Polyline(problem.keyframes),
                  stamps(problem.keyframes),
                  context.times,
                  context.protocol,
                  tracked_stamps(problem));
}

}  // namespace

std::vector<Score> gain_along(const Evaluation& evaluation, const GainAlongOptions&) {
  const Evaluation raw = evaluate_raw(evaluation.context);
  if (raw.reference.size() != evaluation.reference.size()) {
    throw std::runtime_error("gain_along: " + std::to_string(raw.reference.size()) +
                             " pairs before, " + std::to_string(evaluation.reference.size()) +
                             " after: the poses differ");
  }
  const Errors before = errors(raw);
  const Errors after = errors(evaluation);
  const std::vector<double> distance = accumulated_distances(evaluation.reference);

  const Protocol& rules = evaluation.protocol;
  std::vector<Score> out{gain("translation", "3d", rules, before.metres, after.metres)};
  const std::array names{"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a)
    out.push_back(gain("translation", names[a], rules, before.axes[a], after.axes[a]));
  const std::string why = why_no_attitude(evaluation);
  out.push_back(why.empty() ? gain("angle", "3d", rules, before.radians, after.radians)
                            : directed({"angle", "3d", "%", {}, why}, Better::higher));
  const std::array thirds{"first_third", "middle_third", "last_third"};
  for (int k = 0; k < 3; ++k) {
    out.push_back(gain(thirds[static_cast<std::size_t>(k)],
                       "3d",
                       rules,
                       third(before.metres, distance, k),
                       third(after.metres, distance, k)));
  }
  double improved = 0.0;
  double worsened = 0.0;
  for (std::size_t i = 0; i < after.metres.size(); ++i) {
    improved += after.metres[i] < before.metres[i];
    worsened += after.metres[i] > before.metres[i];
  }
  const double percent = 100.0 / static_cast<double>(after.metres.size());
  out.push_back(directed(single("improved", "", "%", percent * improved), Better::higher));
  out.push_back(single("worsened", "", "%", percent * worsened));
  return out;
}

}  // namespace loopbench::metrics

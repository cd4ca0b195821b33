/// Each score has the documented direction.
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "evaluated_cell.hpp"
#include "metrics/metric.hpp"
#include "replayed_polyline.hpp"
#include "support.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::direction_test {
namespace {

std::set<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

// Every metric is in one of these lists: lower is better, no direction, or has a test of its own.
const std::set<std::string> kErrors = words(
    "ate axis_error ape rpe drift end_error snippet_ate segments along_cross jumps causal_ate "
    "causal_rpe closure_jumps update_time closures_kept_false closures_dropped_true");
const std::set<std::string> kDescriptions =
    words("closure_residual interpolation_floor coverage extrinsic_offset diagnostics");
const std::set<std::string> kOthers = words(
    "path_length jerk graph_cost optimality loop_detection accuracy control_points nees "
    "closure_prediction");

/// A circle in steps of 5 cm, back to its start; `stray` bends it upwards.
Trajectory circle(double stray) {
  Trajectory out;
  for (int i = 0; i <= 400; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 200.0;
    const double t = 0.05 * i;
    const double up = 0.3 * std::sin(7.0 * angle) + stray * std::sin(0.4 * t * t);
    out.push_back({t,
                   {exp_so3(Vector3(0.2 * std::sin(3.0 * angle), 0.1 * std::sin(angle), angle)),
                    Vector3(10.0 * std::cos(angle), 10.0 * std::sin(angle), up)}});
  }
  return out;
}

/// Every tenth pose.
Trajectory thinned(const Trajectory& poses) {
  Trajectory out;
  for (std::size_t i = 0; i < poses.size(); i += 10) out.push_back(poses[i]);
  return out;
}

/// The directions of all scores of a metric on an ordinary cell, by "relation axis".
std::map<std::string, std::pair<Better, double>> directions(const std::string& metric) {
  const Problem problem = test::drifting(
      thinned(circle(0.0)), twist({0.01, 0.0, 0.02}, {0.0, 0.001, 0.01}), {{0, 20}, {5, 25}});
  const Replay replay{thinned(circle(0.3)),
                      {test::closure_at(10, 0.0, 0.1),
                       test::closure_at(20, 0.0, 0.1),
                       test::closure_at(30, 0.0, 0.1)}};
  const std::vector<LoopCandidate> candidates{{0, 20, 1.0, true}, {5, 25, 0.5, true}};
  EvaluatedCell cell(circle(0.0),
                     problem,
                     std::make_unique<test::ReplayedPolyline>(thinned(circle(0.3)), replay),
                     Times::dense,
                     {.align = Align::none});
  cell.evaluation.context.loop_candidates = &candidates;
  const std::vector<std::size_t> false_closures{1}, rejected{0};
  cell.evaluation.context.false_closures = &false_closures;
  cell.evaluation.context.rejected_closures = &rejected;
  const std::vector<Matrix6> covariances(cell.at_keyframes.size(), Matrix6::Identity());
  cell.evaluation.context.estimate_covariances = &covariances;
  std::map<std::string, std::pair<Better, double>> out;
  for (const MetricEntry& entry : metrics::metrics()) {
    if (entry.name != metric) continue;
    const Params options = metric == "segments" ? Params{{"lengths", std::string("5")}} : Params{};
    for (const Score& score : entry.score(cell.evaluation, options)) {
      out[score.relation + " " + score.axis] = {score.better, score.target};
    }
  }
  return out;
}

/// Whether all scores of the metric have that direction, and there is at least one.
void expect_all(const std::string& metric, Better better) {
  const auto found = directions(metric);
  EXPECT_FALSE(found.empty()) << metric;
  for (const auto& [score, direction] : found) {
    EXPECT_EQ(direction.first, better) << metric << " " << score;
  }
}

TEST(Direction, ErrorsAreBetterLower) {
  for (const std::string& metric : kErrors) expect_all(metric, Better::lower);
}

TEST(Direction, DescriptionsHaveNone) {
  for (const std::string& metric : kDescriptions) expect_all(metric, Better::neither);
}

TEST(Direction, OfARatioIsOne) {
  for (const char* metric : {"path_length", "jerk"}) {
    for (const auto& [score, direction] : directions(metric)) {
      const bool is_ratio = score.starts_with("ratio");
      EXPECT_EQ(direction.first, is_ratio ? Better::target : Better::neither) << score;
      EXPECT_EQ(direction.second, is_ratio ? 1.0 : 0.0) << score;
    }
  }
}

TEST(Direction, OfTheGraphsCostIsLowerButItsPartsAreTradedForEachOther) {
  const auto found = directions("graph_cost");
  EXPECT_EQ(found.at("chi2 all").first, Better::lower);
  EXPECT_EQ(found.at("chi2 odometry").first, Better::neither);
  EXPECT_EQ(found.at("chi2 closures").first, Better::neither);
}

TEST(Direction, OfPrecisionAndRecallIsHigherAndOfCountsNone) {
  const std::set<std::string> counts{"revisits ", "closures ", "false_poses "};
  const auto found = directions("loop_detection");
  EXPECT_EQ(found.size(), 17u);
  for (const auto& [score, direction] : found) {
    EXPECT_EQ(direction.first, counts.contains(score) ? Better::neither : Better::higher) << score;
  }
}

TEST(Direction, OfACoverageIsItsProbabilityAndOfNeesItsDegreesOfFreedom) {
  for (const auto& [score, direction] : directions("nees")) {
    const bool is_bound = score.find("_low") != score.npos || score.find("_high") != score.npos;
    const bool has_target = !is_bound && !score.starts_with("nees ") && score != "independent ";
    EXPECT_EQ(direction.first, has_target ? Better::target : Better::neither) << score;
    if (!has_target) continue;
    const bool is_ratio = score.starts_with("nees_ratio");
    EXPECT_EQ(direction.second, is_ratio ? 1.0 : std::stod(score.substr(9, 2))) << score;
  }
}

TEST(Direction, OfEveryMetricIsTestedHere) {
  for (const MetricEntry& entry : metrics::metrics()) {
    EXPECT_EQ(kErrors.contains(entry.name) + kDescriptions.contains(entry.name) +
                  kOthers.contains(entry.name),
              1)
        << entry.name << ": add it to one of the lists at the top of this file";
  }
}

}  // namespace
}  // namespace loopbench::test::direction_test

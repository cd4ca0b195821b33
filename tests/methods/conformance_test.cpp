// Properties required of every method in the catalogue. Methods added to methods.cpp are tested
// automatically.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "datasets/core/polyline.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/method.hpp"
#include "methods/online/online.hpp"
#include "methods/pipeline.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::test::conformance_test {
namespace {

/// Composes a corrector with a polyline, or a smoother without a corrector; replays keyframes
/// without correction; returns a joint method unchanged.
std::unique_ptr<const Estimator> build(const MethodEntry& entry, const Params& params = {}) {
  Stage stage = entry.make(params);
  if (auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage)) {
    return compose(std::move(*corrector), nullptr);
  }
  if (auto* smoother = std::get_if<std::unique_ptr<const Smoother>>(&stage)) {
    return compose(nullptr, std::move(*smoother));
  }
  if (auto* replayer = std::get_if<std::unique_ptr<const Replayer>>(&stage)) {
    return (*replayer)->replayed(compose(nullptr, nullptr));
  }
  return std::get<std::unique_ptr<const Estimator>>(std::move(stage));
}

bool same_bits(const Trajectory& a, const Trajectory& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

/// Extent of the keyframes [m], at least 1; the scale of the tolerance 1e-9.
double size_of(const Problem& problem) {
  double out = 1.0;
  for (const StampedPose& pose : problem.keyframes) {
    const Vector3 span =
        pose.world_from_body.translation - problem.keyframes.front().world_from_body.translation;
    out = std::max(out, span.norm());
  }
  return out;
}

const Pose kElsewhere{exp_so3({0.4, -1.1, 2.0}), {30.0, -20.0, 10.0}};

class Conformance : public ::testing::TestWithParam<MethodEntry> {
 protected:
  Trajectory sampled(const Problem& problem) const { return sampled(*method_, problem); }

  static Trajectory sampled(const Estimator& method, const Problem& problem) {
    Report report;
    return method.estimate(problem, report)->sample(query_times(problem.keyframes));
  }

  /// Sampled in another world frame and moved back.
  Trajectory sampled_elsewhere(const Problem& problem) const {
    Trajectory out = sampled(moved_by(kElsewhere, problem));
    for (StampedPose& pose : out) {
      pose.world_from_body = kElsewhere.inverse() * pose.world_from_body;
    }
    return out;
  }

  void expect_valid_curve(const Problem& problem) const {
    Report report;
    const auto curve = method_->estimate(problem, report);
    ASSERT_NE(curve, nullptr);
    EXPECT_EQ(curve->start(), problem.keyframes.front().stamp);
    EXPECT_EQ(curve->end(), problem.keyframes.back().stamp);
    for (const StampedPose& pose : curve->sample(query_times(problem.keyframes))) {
      ASSERT_TRUE(is_finite(pose.world_from_body)) << "at " << pose.stamp << " s";
      ASSERT_NEAR(pose.world_from_body.rotation.norm(), 1.0, 1e-12) << "at " << pose.stamp << " s";
    }
  }

  std::unique_ptr<const Estimator> method_ = build(GetParam());
};

TEST_P(Conformance, AcceptsOrdinaryProblems) {
  if (GetParam().name == "tracked_frames") GTEST_SKIP() << "some ordinary problems have no frames";
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(method_->why_declined(problem), "");
  }
}

TEST_P(Conformance, KeepsTheTimeSpanAndGivesFiniteUnitPoses) {
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    expect_valid_curve(problem);
  }
}

TEST_P(Conformance, CorrectorKeepsEveryStamp) {
  const Stage stage = GetParam().make({});
  const auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage);
  if (corrector == nullptr) return;
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    Report report;
    EXPECT_EQ(stamps((*corrector)->correct(problem, report)), stamps(problem.keyframes));
  }
}

TEST_P(Conformance, RejectedClosuresAreAscendingIndices) {
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    Report report;
    if (!reason_to_decline(*method_, problem).empty()) continue;
    method_->estimate(problem, report);
    if (!report.rejected) continue;
    EXPECT_TRUE(std::ranges::is_sorted(*report.rejected, std::ranges::less_equal{}));
    if (!report.rejected->empty()) EXPECT_LT(report.rejected->back(), problem.closures.size());
  }
}

TEST_P(Conformance, RejectsTimesOutsideTheSpan) {
  const Problem problem = hand_held();
  Report report;
  const auto curve = method_->estimate(problem, report);
  EXPECT_THROW(curve->at(curve->start() - 1e-6), std::out_of_range);
  EXPECT_THROW(curve->at(curve->end() + 1e-6), std::out_of_range);
  EXPECT_THROW(curve->at(std::nan("")), std::out_of_range);
}

TEST_P(Conformance, IsDeterministic) {
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(same_bits(sampled(problem), sampled(*build(GetParam()), problem)));
  }
}

TEST_P(Conformance, IsBitIdenticalOnEveryThread) {
  const Problem problem = hand_held();
  Trajectory one, other;
  std::thread first([&] { one = sampled(problem); });
  std::thread second([&] { other = sampled(problem); });
  first.join();
  second.join();
  EXPECT_TRUE(same_bits(one, other));
  EXPECT_TRUE(same_bits(one, sampled(problem)));
}

TEST_P(Conformance, SamplesDoNotDependOnOrderOrOnOtherTimes) {
  const Problem problem = hand_held();
  Report report;
  const auto curve = method_->estimate(problem, report);
  std::vector<double> times = query_times(problem.keyframes);
  const Trajectory sorted = curve->sample(times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_TRUE(same_bits({sorted[i]}, {{times[i], curve->at(times[i])}})) << times[i];
  }
  std::ranges::reverse(times);
  Trajectory backwards = curve->sample(times);
  std::ranges::reverse(backwards);
  EXPECT_TRUE(same_bits(sorted, backwards));
}

/// Relative accuracy of a method's poses. Reweighted losses converge linearly: stopped at a
/// relative change of 1e-14 of the cost, they are about its root away from the minimum.
double accuracy(const MethodEntry& entry) {
  const bool is_reweighted = std::ranges::any_of(entry.options, [](const OptionInfo& option) {
    return option.name == "loss" && to_text(option.value) != "none";
  });
  return is_reweighted ? 10.0 * 1e-7 : 1e-9;
}

TEST_P(Conformance, IsIndependentOfTheWorldFrame) {
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    const double size = size_of(problem) + kElsewhere.translation.norm();
    const double limit = accuracy(GetParam());
    expect_close(sampled(problem), sampled_elsewhere(problem), limit * size, limit);
  }
}

TEST_P(Conformance, KeepsPlanarProblemsInThePlane) {
  for (const StampedPose& pose : sampled(planar())) {
    EXPECT_NEAR(pose.world_from_body.translation.z(), 0.0, 1e-9);
    EXPECT_NEAR(pose.world_from_body.rotation.x(), 0.0, 1e-9);
    EXPECT_NEAR(pose.world_from_body.rotation.y(), 0.0, 1e-9);
  }
}

TEST_P(Conformance, KeepsPerfectProblemsUnchanged) {
  // A smoother may deform a perfect curve, but not a straight line.
  const Problem problem = GetParam().kind == Kind::corrector ? perfect() : straight();
  const Trajectory expected = Polyline(problem.keyframes).sample(query_times(problem.keyframes));
  expect_close(sampled(problem), expected, 1e-9 * size_of(problem), 1e-9);
}

TEST_P(Conformance, DeclinesOrSolvesAwkwardProblems) {
  for (const auto& [name, problem] : awkward_problems()) {
    SCOPED_TRACE(name);
    ASSERT_NO_THROW(check(problem, name));
    if (method_->why_declined(problem).empty()) expect_valid_curve(problem);
  }
}

TEST_P(Conformance, UsesAnchorsOrDeclinesThem) {
  const Vector3 error(0.2, -0.1, 0.0);
  for (const auto& [name, base] : ordinary_problems()) {
    SCOPED_TRACE(name);
    const Problem problem = with_anchors(base, error);
    ASSERT_NO_THROW(check(problem, name));
    const std::string why = reason_to_decline(*method_, problem);
    const bool is_smoother = GetParam().kind == Kind::smoother || GetParam().name == "raw";
    EXPECT_EQ(method_->accepts_anchors(), is_smoother || why.empty());
    if (!why.empty() || is_smoother) continue;
    expect_valid_curve(problem);
    Report report;
    const Trajectory keyframes =
        method_->estimate(problem, report)->sample(stamps(problem.keyframes));
    EXPECT_LT(anchor_chi2(problem.anchors, keyframes),
              0.5 * anchor_chi2(problem.anchors, problem.keyframes));
    expect_close(sampled(problem), sampled_elsewhere(problem), 1e-8 * size_of(problem), 1e-8);
  }
}

TEST_P(Conformance, EndsAReplayWithTheResultOfTheCompleteProblem) {
  if (GetParam().kind == Kind::replay) return;
  const auto replayed = Online({}).replayed(build(GetParam()));
  for (const auto& [name, problem] : ordinary_problems()) {
    SCOPED_TRACE(name);
    if (!method_->why_declined(problem).empty()) continue;
    EXPECT_TRUE(same_bits(sampled(*replayed, problem), sampled(problem)));
  }
}

TEST_P(Conformance, RejectsUnknownOptions) {
  EXPECT_THROW(GetParam().make({{"no_such_option", true}}), OptionError);
}

TEST_P(Conformance, AcceptsItsOwnDefaults) {
  Params defaults;
  for (const OptionInfo& option : GetParam().options) defaults.emplace(option.name, option.value);
  const Problem problem = hand_held();
  EXPECT_TRUE(same_bits(sampled(problem), sampled(*build(GetParam(), defaults), problem)));
}

INSTANTIATE_TEST_SUITE_P(Catalogue,
                         Conformance,
                         ::testing::ValuesIn(methods::methods()),
                         [](const auto& entry) { return entry.param.name; });

TEST(Catalogue, NamesAreUnique) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods::methods()) names.push_back(entry.name);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

using testing::HasSubstr;

TEST(FindMethod, CorrectsWithTheMethodOfTheName) {
  const Problem problem = test::circle();
  const Trajectory expected = test::corrected<methods::Dual>(problem);
  const Trajectory found = methods::correct(problem, "dual");
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(test::largest_distance(found, expected), 0.0);
}

TEST(FindMethod, RejectsWhatCannotCorrect) {
  Problem problem = test::circle();
  const auto why = [&](const std::string& name) {
    return refusal_of([&] { methods::correct(problem, name); });
  };
  EXPECT_THAT(why("duel"), HasSubstr("no method is named 'duel', expected one of raw, uniform"));
  EXPECT_EQ(why("polyline"), "polyline: is a smoother, expected a corrector");
  problem.odometry.clear();
  EXPECT_THAT(why("dual"), HasSubstr("dual: is not applicable: "));
}

}  // namespace
}  // namespace loopbench::test::conformance_test

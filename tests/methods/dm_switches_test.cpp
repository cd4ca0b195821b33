/// Tests every option of the manifold smoother, one at a time.
#include <gtest/gtest.h>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::dm_switches_test {
namespace {

using Text = std::string;

struct Switch {
  Text name;
  Params params;
};
void PrintTo(const Switch& one, std::ostream* out) { *out << one.name; }

std::vector<Switch> switches() {
  std::vector<Switch> out;
  const auto add = [&](Params params) {
    Text name;
    for (const auto& [key, value] : params)
      name += (name.empty() ? "" : "_") + key + "_" + to_text(value);
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    out.push_back({name, std::move(params)});
  };
  const auto five = std::int64_t{5}, six = std::int64_t{6};
  for (const char* v : {"consecutive", "sliding_blend", "one_per_segment"})
    add({{"scheme", Text(v)}});
  add({{"scheme", Text("sliding_blend")}, {"planar", five}});
  add({{"frame", Text("chord")}});
  add({{"abscissa", Text("polyline")}});
  for (const char* v : {"overlap_blend", "quintic_bridge", "c0", "none"}) {
    add({{"joint", Text(v)}, {"planar", five}});
    add({{"joint", Text(v)}, {"planar", std::int64_t{0}}, {"spatial", std::int64_t{7}}});
  }
  add({{"low_speed_c0_below", 0.3}, {"planar", five}});
  for (const char* v : {"line", "poly2", "poly3"}) add({{"families", Text(v)}, {"planar", five}});
  for (const char* v : {"sin1 poly3", "rat02 poly3", "hyperbola poly3", "implicit poly3"}) {
    add({{"families", Text(v)}, {"planar", six}});
  }
  add({{"selection", Text("loocv")}, {"families", Text("line poly2 poly3 sin1")}, {"planar", six}});
  add({{"speed_rule", Text("adjacent")}});
  for (const char* v : {"menger", "dtheta_dt"}) add({{"kappa", Text(v)}});
  add({{"kappa_plane", Text("xy")}});
  add({{"short_policy", Text("polyline")}});
  for (const char* v : {"discrete", "frechet"}) {
    add({{"psi", Text("boundary_tangent")}, {"psi_mean", Text(v)}});
  }
  for (const std::int64_t k : {2, 3, 5, 6}) add({{"spline_order", k}});
  add({{"guard", false}});
  add({{"planar", std::int64_t{3}}, {"spatial", std::int64_t{8}}, {"height_guard", false}});
  return out;
}

class EverySwitch : public testing::TestWithParam<Switch> {
 protected:
  std::unique_ptr<const Curve> smoothed(const Problem& problem) {
    report_ = {};
    return Dm(with(Dm::Options{}, GetParam().params)).smooth(problem, report_);
  }
  double counted(const Text& name) const { return test::count(report_, name); }
  Text given(const Text& name) const {
    const auto found = GetParam().params.find(name);
    return found == GetParam().params.end() ? "" : to_text(found->second);
  }
  Report report_;
};
INSTANTIATE_TEST_SUITE_P(Dm, EverySwitch, testing::ValuesIn(switches()), [](const auto& one) {
  return one.param.name;
});

TEST_P(EverySwitch, IsIndependentOfTheWorldFrame) {
  const Problem problem = keyframes_only(wandering(60, 3));
  const Pose there_from_here{exp_so3({1.1, -2.0, 0.4}), {30.0, -50.0, 8.0}};
  const auto original = smoothed(problem);
  const auto moved = smoothed(test::moved_by(there_from_here, problem));
  for (const double t : times_over(problem.keyframes, 313)) {
    const Pose expected = there_from_here * original->at(t);
    EXPECT_NEAR((moved->at(t).translation - expected.translation).norm(), 0.0, 1e-6) << t;
  }
}

TEST_P(EverySwitch, KeepsUniformMotion) {
  std::vector<Vector3> points;
  for (int i = 0; i < 20; ++i) points.push_back(Vector3(5, 1, 2) + i * Vector3(0.3, -0.2, 0.1));
  const auto curve = smoothed(keyframes_only(through(points)));
  for (double t = 0.0; t <= 19.0; t += 0.13) {
    EXPECT_NEAR((curve->at(t).translation - Vector3(5, 1, 2) - t * Vector3(0.3, -0.2, 0.1)).norm(),
                0.0,
                1e-8);
  }
}

TEST_P(EverySwitch, MotionIsTheDerivativeOfTheSamples) {
  expect_motion_is_the_derivative(*smoothed(keyframes_only(wandering(40, 6))));
}

TEST_P(EverySwitch, JumpsAtNodesMatchTheJointType) {
  smoothed(keyframes_only(wandering(60, 5)));
  const Text joint = given("joint");
  const bool straight = given("abscissa") == "polyline" || given("spline_order") == "2";
  if (joint != "none") {
    EXPECT_NEAR(counted("jump_position"), 0.0, 1e-9);
  }
  if (straight || joint == "none" || joint == "c0" || !given("low_speed_c0_below").empty()) {
    EXPECT_GT(counted("jump_velocity"), 1e-3);
    return;
  }
  EXPECT_NEAR(counted("jump_velocity"), 0.0, 1e-7);
  EXPECT_NEAR(counted("jump_slope"), 0.0, 1e-6);
  if (!given("psi").empty()) {
    EXPECT_GT(counted("jump_acceleration"), 1e-2);  // C1 only at clamped ends
    return;
  }
  EXPECT_NEAR(counted("jump_acceleration"), 0.0, 1e-6);
  EXPECT_LT(counted("jump_curvature"), 1e-4);
}

TEST(DmSwitches, QuinticBridgesAreC2AtTheirEnds) {
  const Problem problem = keyframes_only(wandering(40, 7));
  Dm::Options options{.planar = 5};
  options.joint.kind = manifold::JointKind::quintic_bridge;
  Report report;
  const auto curve = Dm(options).smooth(problem, report);
  const auto& pieces = dynamic_cast<const manifold::ManifoldCurve&>(*curve);
  const auto& t = pieces.knots();
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const double half = 0.5 * std::min(t[i] - t[i - 1], t[i + 1] - t[i]);
    for (const auto& [edge, at] : {std::pair{i - 1, t[i] - half}, std::pair{i, t[i] + half}}) {
      const auto before = pieces.motion(edge, at - 1e-9);
      const auto after = pieces.motion(edge, at + 1e-9);
      EXPECT_NEAR((after.first - before.first).norm(), 0.0, 1e-6);
      EXPECT_LT((after.second - before.second).norm(), 1e-4);
    }
  }
}

TEST(DmSwitches, RejectsContradictoryOptions) {
  const auto build = [](Params params) { return Dm(with(Dm::Options{}, std::move(params))); };
  EXPECT_THROW(build({{"families", Text("poly7")}}), OptionError);
  EXPECT_THROW(build({{"psi", Text("boundary_tangent")}, {"abscissa", Text("polyline")}}),
               OptionError);
  EXPECT_THROW(build({{"abscissa", Text("ground_truth")}}), OptionError);
}

}  // namespace
}  // namespace loopbench::test::dm_switches_test

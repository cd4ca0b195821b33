/// Acceptance figures of the design on the two TUM references of the article.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "datasets/core/polyline.hpp"
#include "datasets/formats/formats.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "tests/support/corrected.hpp"

namespace loopbench::test::dm_real_data_test {
namespace {

struct Setting {
  const char* folder;
  double begin, end;  ///< overlap of images and reference [s]
  std::size_t keyframes;
  double speed_band, turn_max;  ///< as printed in the article
};
constexpr Setting kRoom{"fr1_room", 1305031910.765238, 1305031955.536891, 180, 0.33, 0.75};
constexpr Setting kOffice{"fr3_office", 1341847980.79, 1341848067.809, 204, 0.25, 0.42};

class DmOnTum : public testing::Test {
 protected:
  void SetUp() override {
    const char* root = std::getenv("LOOPBENCH_DATA");
    if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set: no real trajectories";
    tum_ = std::filesystem::path(root) / "tum_rgbd";
    if (!std::filesystem::exists(tum_)) GTEST_SKIP() << "no tum_rgbd in LOOPBENCH_DATA";
  }

  // Samples the reference at uniform keyframes and every 1/30 s.
  void load_setting(const Setting& run) {
    const Polyline reference(read_trajectory(tum_ / run.folder / "groundtruth.txt"));
    std::vector<double> times;
    for (std::size_t i = 0; i < run.keyframes; ++i) {
      const double u = static_cast<double>(i) / static_cast<double>(run.keyframes - 1);
      times.push_back(std::min(std::lerp(run.begin, run.end, u), run.end));
    }
    problem_.keyframes = reference.sample(times);
    dense_.clear();
    for (double t = run.begin; t < run.end; t += 1.0 / 30.0) dense_.push_back(t);
    truth_ = reference.sample(dense_);
    options_.segment = {run.speed_band, run.turn_max};
  }

  double error(const Curve& curve) const {  // RMSE in 3D [mm]
    return 1e3 * test::rmse(curve.sample(dense_), truth_);
  }

  double error(int planar, int spatial) {
    options_.planar = planar;
    options_.spatial = spatial;
    report_ = {};
    return error(*Dm(options_).smooth(problem_, report_));
  }

  double counted(const std::string& name) const { return test::count(report_, name); }

  std::filesystem::path tum_;
  Problem problem_;
  std::vector<double> dense_;
  Trajectory truth_;
  Dm::Options options_;
  Report report_;
};

TEST_F(DmOnTum, SegmentCountsAndErrorsOfPolylineAndSplineMatchTheDesign) {
  for (const auto& [run, length, segments, polyline, spline, tolerance] :
       {std::tuple{kRoom, 15.836, 27u, 3.8, 1.3, 0.05}, {kOffice, 21.955, 46u, 4.9, 2.6, 0.06}}) {
    load_setting(run);
    EXPECT_NEAR(path_length(problem_.keyframes), length, 5e-4);
    const manifold::Nodes nodes(problem_.keyframes);
    EXPECT_EQ(manifold::segments(nodes, options_.segment).size(), segments);
    EXPECT_NEAR(error(Polyline(problem_.keyframes)), polyline, 0.05);
    EXPECT_NEAR(error(0, 0), spline, tolerance);
  }
}

// The design's prototype had neither guard nor blending: 2.4 / 4.0 mm for N = 3, 11 / 28 mm for N =
// 4, 4.6 / 5.2 mm for N = 5. The upper bounds are the values measured here plus a small margin.
TEST_F(DmOnTum, PlanarVariantsBeatThePolylineAndThePrototype) {
  load_setting(kRoom);
  EXPECT_LT(error(3, 0), 1.85);
  EXPECT_EQ(counted("fallbacks"), 3.0);
  EXPECT_LT(error(4, 0), 2.2);
  EXPECT_LT(error(5, 0), 2.4);
  load_setting(kOffice);
  EXPECT_LT(error(3, 0), 3.15);
  EXPECT_EQ(counted("fallbacks"), 2.0);
  EXPECT_LT(error(4, 0), 2.85);
  EXPECT_LT(error(5, 0), 3.75);
}

// A quadric along a curve is ill-posed: errors lie between spline and polyline, for M = 8 above the
// polyline.
TEST_F(DmOnTum, SpatialVariantsStayBounded) {
  load_setting(kRoom);
  EXPECT_LT(error(0, 6), 3.4);
  EXPECT_LT(error(0, 7), 4.1);
  EXPECT_LT(error(0, 8), 5.3);
  load_setting(kOffice);
  EXPECT_LT(error(0, 6), 3.8);
  EXPECT_LT(error(0, 7), 3.8);
  EXPECT_LT(error(0, 8), 4.3);
}

// Literal interpretation of the article: y = f(x) in world axes, no guard, sharp joints,
// consecutive windows over the whole sequence. The design's prototype had 209 / 109 mm for the
// cubic on 4 nodes, 24 / 29 for the parabola on 4 and 22 / 38 on 5. Its 113 / 59 for the parabola
// on 3 nodes were not reproduced: a few windows across x, and the nodes in them, determine that
// number.
TEST_F(DmOnTum, LiteralVariantsFailAsInTheDesign) {
  const auto literal = [&](int N, const char* family) {
    options_.frame = manifold::Axes::world;
    options_.guard = false;
    options_.joint.kind = manifold::JointKind::none;
    options_.segment = {100.0, 10.0};
    options_.families = family;
    return error(N, 0);
  };
  load_setting(kRoom);
  EXPECT_NEAR(literal(3, "poly2"), 195.5, 0.5);
  EXPECT_NEAR(literal(4, "poly3"), 214.9, 0.5);
  EXPECT_NEAR(literal(4, "poly2"), 22.6, 0.1);
  EXPECT_NEAR(literal(5, "poly2"), 21.5, 0.1);
  load_setting(kOffice);
  EXPECT_NEAR(literal(3, "poly2"), 65.2, 0.2);
  EXPECT_NEAR(literal(4, "poly3"), 108.5, 0.2);
  EXPECT_NEAR(literal(4, "poly2"), 30.7, 0.1);
  EXPECT_NEAR(literal(5, "poly2"), 38.4, 0.1);
}

TEST_F(DmOnTum, SegmentCountsOfOtherKappasMatchTheDesign) {
  const auto counted_by = [&](manifold::Kappa kappa) {
    options_.segment.kappa = kappa;
    error(4, 0);
    return counted("segments");
  };
  // 171 / 195, 136 / 137 in the design; one more or less due to rounding.
  load_setting(kRoom);
  EXPECT_NEAR(counted_by(manifold::Kappa::menger), 171.0, 1.0);
  EXPECT_NEAR(counted_by(manifold::Kappa::dtheta_dt), 136.0, 1.0);
  load_setting(kOffice);
  EXPECT_NEAR(counted_by(manifold::Kappa::menger), 195.0, 1.0);
  EXPECT_NEAR(counted_by(manifold::Kappa::dtheta_dt), 137.0, 1.0);
}

}  // namespace
}  // namespace loopbench::test::dm_real_data_test

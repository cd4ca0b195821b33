#include "metrics/alignment/alignment.hpp"

#include <gtest/gtest.h>

#include "support.hpp"
#include "tests/datasets/random_poses.hpp"

namespace loopbench::test::alignment_test {
namespace {

double worst(const Trajectory& a, const Trajectory& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Pose& p = a[i].world_from_body;
    const Pose& q = b[i].world_from_body;
    out = std::max(
        {out, (p.translation - q.translation).norm(), angle_between(p.rotation, q.rotation)});
  }
  return out;
}

TEST(Alignment, FindsTheMotionAndTheScale) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 50; ++round) {
    const Trajectory reference = random_walk(random, 700);
    const Pose elsewhere = random_pose(random, 100.0, 3.0);
    const double scale = std::uniform_real_distribution<double>(0.2, 5.0)(random);

    const Trajectory rigid = moved_by(elsewhere, 1.0, reference);
    const Alignment se3 = align(reference, rigid, Align::se3);
    EXPECT_EQ(se3.scale, 1.0);
    EXPECT_EQ(se3.rank, 3);
    EXPECT_NEAR(worst(reference, moved(se3, rigid)), 0.0, 1e-11);
    const Alignment all = align(reference, rigid, Align::se3, 5000);  // more than there are
    EXPECT_NEAR(worst(reference, moved(all, rigid)), 0.0, 1e-11);

    const Trajectory similar = moved_by(elsewhere, scale, reference);
    const Alignment sim3 = align(reference, similar, Align::sim3);
    EXPECT_NEAR(sim3.scale * scale, 1.0, 1e-12);
    EXPECT_NEAR(worst(reference, moved(sim3, similar)), 0.0, 1e-11);
  }
}

TEST(Alignment, HoldsFarFromTheOrigin) {
  std::mt19937_64 random(2);
  const Trajectory reference = random_walk(random, 1000);
  const Pose far{exp_so3({0.3, -0.2, 0.9}), {5e6, -4e6, 1e3}};  // UTM
  const Trajectory estimate = moved_by(far, 1.0, reference);
  // Rounding of 5e6 m is 1e-9 m; the alignment must not lose more.
  const Alignment found = align(reference, estimate, Align::se3);
  EXPECT_NEAR(worst(reference, moved(found, estimate)), 0.0, 1e-7);
}

TEST(Alignment, IsTheLeastSquaresOne) {
  std::mt19937_64 random(3);
  const Trajectory reference = random_walk(random, 300);
  const Trajectory estimate = test::noisy(random, reference, 0.3, 0.1);
  const auto cost = [&](const Alignment& alignment) {
    const Trajectory there = moved(alignment, estimate);
    double sum = 0.0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      sum += (there[i].world_from_body.translation - reference[i].world_from_body.translation)
                 .squaredNorm();
    }
    return sum;
  };
  for (const Align type : {Align::se3, Align::sim3}) {
    const Alignment best = align(reference, estimate, type);
    for (int round = 0; round < 200; ++round) {
      Alignment other = best;
      other.reference_from_estimate =
          random_pose(random, 1e-3, 1e-3) * best.reference_from_estimate;
      if (type == Align::sim3) other.scale *= 1.0 + 1e-3 * (round % 3 - 1);
      EXPECT_GE(cost(other), cost(best));
    }
  }
}

TEST(Alignment, OfAPlaneIsUnique) {
  std::vector<Vector3> points;
  std::vector<Vector3> lifted;
  for (int i = 0; i < 20; ++i) {
    points.emplace_back(i, (i * 7) % 5, 0.0);
    lifted.emplace_back(0.0, i, (i * 7) % 5);
  }
  const Alignment found = align(through(points), through(lifted), Align::se3);
  EXPECT_EQ(found.rank, 2);
  const Trajectory there = moved(found, through(lifted));
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR((there[i].world_from_body.translation - points[i]).norm(), 0.0, 1e-13);
  }
  EXPECT_GT(found.reference_from_estimate.rotation.toRotationMatrix().determinant(), 0.0);
}

TEST(Alignment, RefusesAStraightLine) {
  std::vector<Vector3> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(100.0 + 0.1 * i, 7.0 + 0.3 * i, -0.7 * i);
  const Trajectory line = through(points);
  std::mt19937_64 random(4);
  const Trajectory turned = moved_by(random_pose(random, 10.0, 2.0), 1.0, line);
  const auto text = why<std::runtime_error>([&] { align(line, turned, Align::se3); });
  EXPECT_EQ(text,
            "alignment se3: 50 pairs lie on one straight line, so the rotation is not unique; "
            "use align = origin or none");
  EXPECT_NO_THROW(align(line, turned, Align::origin));
}

TEST(Alignment, RefusesAPoint) {
  std::mt19937_64 random(5);
  const Trajectory walk = random_walk(random, 50);
  Trajectory still = walk;
  for (auto& [stamp, pose] : still) pose.translation = {123.456, -0.1, 7.7};
  for (const Align type : {Align::se3, Align::sim3}) {
    const auto refused = [&](const Trajectory& a, const Trajectory& b) {
      const auto text = why<std::runtime_error>([&] { align(a, b, type); });
      EXPECT_NE(text.find("50 pairs coincide in one point"), std::string::npos) << text;
    };
    refused(still, still);
    refused(walk, still);
    refused(still, walk);
    // Rounding of the coordinates is not a pattern either.
    Trajectory shaking = still;
    for (std::size_t i = 0; i < 50; ++i) {
      shaking[i].world_from_body.translation += 1.4e-14 * test::random_vector(random, 1.0);
    }
    refused(walk, shaking);
  }
}

TEST(Alignment, RefusesTooFewPairs) {
  const Trajectory two = through({{0, 0, 0}, {1, 2, 3}});
  const Trajectory one = through({{1, 2, 3}});
  EXPECT_THROW(align(two, two, Align::se3), std::runtime_error);
  EXPECT_THROW(align(one, one, Align::sim3), std::runtime_error);
  EXPECT_THROW(align(one, two, Align::none), std::invalid_argument);
  EXPECT_THROW(align({}, {}, Align::none), std::invalid_argument);
  const Trajectory three = through({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(align(three, three, Align::se3).rank, 2);
}

TEST(Alignment, RefusesAMirrorImageWithoutAPreferredAxis) {
  const Trajectory cross =
      through({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  Trajectory mirrored = cross;
  for (auto& [stamp, pose] : mirrored) pose.translation.z() *= -1.0;
  const auto text = why<std::runtime_error>([&] { align(cross, mirrored, Align::se3); });
  EXPECT_NE(text.find("are mirror images of the reference"), std::string::npos) << text;
}

TEST(Alignment, PosyawTurnsAboutZOnly) {
  std::mt19937_64 random(8);
  const Trajectory reference = random_walk(random, 50);
  const Pose turned{exp_so3(Vector3(0.0, 0.0, 2.5)), Vector3(1.0, -2.0, 3.0)};
  const Trajectory estimate = moved_by(turned, 1.0, reference);
  for (const Align type : {Align::posyaw, Align::posyaw_origin}) {
    const Alignment found = align(reference, estimate, type);
    EXPECT_NEAR(worst(reference, moved(found, estimate)), 0.0, 1e-12);
  }
  // A rotation about x is preserved, and the z axis stays vertical.
  const Trajectory tilted =
      moved_by({exp_so3(Vector3(0.3, 0.0, 0.0)), Vector3::Zero()}, 1.0, reference);
  const Alignment found = align(reference, tilted, Align::posyaw);
  EXPECT_NEAR((found.reference_from_estimate.rotation * Vector3::UnitZ()).z(), 1.0, 1e-15);
}

TEST(Alignment, PosyawRefusesWhatMovesAlongZOnly) {
  const Trajectory lift = through({{0, 0, 0}, {0, 0, 1}, {0, 0, 3}});
  const auto text = why<std::runtime_error>([&] { align(lift, lift, Align::posyaw); });
  EXPECT_NE(text.find("have no common motion normal to z"), std::string::npos) << text;
}

}  // namespace
}  // namespace loopbench::test::alignment_test

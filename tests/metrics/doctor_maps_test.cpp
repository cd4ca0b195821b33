/// Findings of `doctor` about maps, rows and units, and about antennas.
#include <cmath>
#include <random>

#include "metrics/doctor/map_checks.hpp"
#include "metrics/doctor/order_checks.hpp"
#include "tests/metrics/doctor_pairs.hpp"

namespace loopbench::test::doctor_maps_test {
namespace {

/// As after tracking was lost for `lost` rows: poses from `row` on start at the identity.
Trajectory with_restart(std::size_t row, std::size_t lost) {
  const Trajectory all = sampled(20);
  Trajectory out(all.begin(), all.begin() + static_cast<long>(row));
  const Pose origin = all[row + lost].world_from_body.inverse();
  for (std::size_t i = row + lost; i < all.size(); ++i) {
    out.push_back({all[i].stamp, normalized(origin * all[i].world_from_body)});
  }
  return out;
}

TEST(DoctorOfMaps, ARestartAtTheIdentityIsNamedWithItsRow) {
  for (const std::size_t row : {120u, 300u, 600u}) {
    for (const std::size_t lost : {0u, 10u}) {
      const Trajectory estimate = with_restart(row, lost);
      const InputFinding found = only_finding(truth(), estimate, Fault::new_map);
      EXPECT_THAT(found.evidence, HasSubstr("origin"));
      EXPECT_THAT(found.evidence, HasSubstr(" row " + std::to_string(row) + " "));
      EXPECT_EQ(map_parts(truth(), estimate, 0.0),
                (std::vector<RowRange>{{0, row}, {row, estimate.size()}}));
    }
  }
}

TEST(DoctorOfMaps, AJumpOfTheFrameIsNamedWithItsRow) {
  Trajectory estimate = sampled(20);
  const Pose jump{exp_so3({0.0, 0.1, 0.6}), {0.5, -0.2, 0.1}};
  for (std::size_t i = 400; i < estimate.size(); ++i) {
    estimate[i].world_from_body = normalized(jump * estimate[i].world_from_body);
  }
  const InputFinding found = only_finding(truth(), estimate, Fault::new_map);
  EXPECT_THAT(found.evidence, HasSubstr("another frame at row 400 "));
}

TEST(DoctorOfMaps, RowsOfAShortMapBelongToNoPart) {
  const std::size_t n = sampled(20).size();
  const Pose other{exp_so3({0.0, 0.1, 0.6}), {5.0, -2.0, 1.0}};
  const auto moved = [&](Trajectory poses, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      poses[i].world_from_body = normalized(other * poses[i].world_from_body);
    }
    return poses;
  };
  const Trajectory jump = moved(sampled(20), 400, n);
  const Trajectory third = moved(jump, 400, 406);
  EXPECT_THAT(only_finding(truth(), third, Fault::new_map).evidence,
              HasSubstr("another frame at row 400 "));
  EXPECT_EQ(map_parts(truth(), third, 0.0), (std::vector<RowRange>{{0, 400}, {406, n}}));
  EXPECT_EQ(map_parts(truth(), moved(jump, 0, 6), 0.0),
            (std::vector<RowRange>{{6, 400}, {400, n}}));
  EXPECT_EQ(map_parts(truth(), moved(jump, n - 6, n), 0.0),
            (std::vector<RowRange>{{0, 400}, {400, n - 6}}));
}

TEST(DoctorOfMaps, AFrozenPoseIsNamedWithItsRow) {
  Trajectory estimate = sampled(20);
  for (std::size_t i = 301; i < 421; ++i) {
    estimate[i].world_from_body = estimate[300].world_from_body;
  }
  const InputFinding found = only_finding(truth(), estimate, Fault::frozen);
  EXPECT_THAT(found.evidence, HasSubstr("row 300 "));
  EXPECT_NEAR(found.value, 6.0, 1e-6);
  const auto parts = map_parts(truth(), estimate, 0.0);
  EXPECT_EQ(parts, (std::vector<RowRange>{{0, 301}, {421, estimate.size()}}));
}

TEST(DoctorOfMaps, AChangeOfScaleIsNamedWithItsRow) {
  Trajectory estimate = sampled(20);
  const Vector3 at = estimate[350].world_from_body.translation;
  for (std::size_t i = 350; i < estimate.size(); ++i) {
    Vector3& p = estimate[i].world_from_body.translation;
    p = at + 0.6 * (p - at);
  }
  const InputFinding found = only_finding(truth(), estimate, Fault::scale_change);
  EXPECT_NEAR(found.value, 0.6, 0.03);
}

TEST(DoctorOfMaps, OneMapIsOnePart) {
  EXPECT_EQ(map_parts(truth(), sampled(20), 0.0), (std::vector<RowRange>{{0, sampled(20).size()}}));
}

Trajectory rows_of(const Trajectory& poses) {
  Trajectory out = poses;
  for (std::size_t i = 0; i < out.size(); ++i) out[i].stamp = 0.1 * static_cast<double>(i);
  return out;
}

Trajectory truth_at(const Trajectory& estimate) {
  Trajectory out;
  for (const StampedPose& pose : estimate) out.push_back({pose.stamp, at(pose.stamp)});
  return out;
}

TEST(DoctorOfRows, SortedAsText) {
  const Trajectory estimate = rows_of(sampled(20)), reference = rows_of(truth_at(sampled(20)));
  Trajectory shuffled = estimate;
  const std::vector<std::size_t> numbers = numbers_sorted_as_text(estimate.size());
  EXPECT_EQ(numbers[2], 10u);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    shuffled[i].world_from_body = estimate[numbers[i]].world_from_body;
  }
  only(diagnosis(reference, shuffled, "gt.txt", "run.txt", false).findings, Fault::row_order);
  only(diagnosis(shuffled, estimate, "gt.txt", "run.txt", false).findings, Fault::row_order);
}

TEST(DoctorOfRows, MotionsFromRowToRow) {
  Trajectory motions = sampled(20);
  for (std::size_t i = motions.size() - 1; i > 0; --i) {
    motions[i].world_from_body =
        normalized(motions[i - 1].world_from_body.inverse() * motions[i].world_from_body);
  }
  const InputFinding found = only_finding(truth(), motions, Fault::relative_poses);
  EXPECT_EQ(found.fix, "traj transform --chain EST");
}

/// Latitude, longitude and height as x, y, z.
Trajectory in_degrees(Trajectory poses, double heights, bool has_rotations) {
  for (auto& [t, pose] : poses) {
    const Vector3 p = pose.translation;
    pose.translation = {48.1 + p.y() / 111195.0, 11.5 + p.x() / 74260.0, 500.0 + heights * p.z()};
    if (!has_rotations) pose.rotation = no_rotation();
  }
  return poses;
}

TEST(DoctorOfRows, LatitudeAndLongitudeAsXAndY) {
  const InputFinding found =
      only_finding(in_degrees(truth(), 1.0, false), sampled(20), Fault::degrees);
  EXPECT_EQ(found.fix,
            "write a first line 'timestamp,latitude,longitude,height' above rows with commas of "
            "the first four columns of REF");
}

TEST(DoctorOfRows, LatitudeAndLongitudeAtAConstantHeightAreNoScale) {
  const Trajectory flat = each(truth(), [](const Pose& p) -> Pose {
    return {exp_so3({0, 0, log_so3(p.rotation).z()}), {p.translation.x(), p.translation.y(), 0.0}};
  });
  Trajectory estimate;
  for (std::size_t i = 100; i + 100 < flat.size(); i += 5) estimate.push_back(flat[i]);
  only_finding(flat, in_degrees(estimate, 0.0, false), Fault::degrees);
  const InputFinding found = only_finding(flat, in_degrees(estimate, 0.0, true), Fault::degrees);
  EXPECT_EQ(found.fix,
            "write a first line 'timestamp,latitude,longitude,height,qx,qy,qz,qw' above rows with "
            "commas of EST");
}

TEST(DoctorOfRows, AnAxisOfAnotherUnit) {
  const Trajectory estimate = each(sampled(20), [](const Pose& p) -> Pose {
    return {p.rotation, {0.67 * p.translation.x(), p.translation.y(), p.translation.z()}};
  });
  for (const InputFinding& found : diagnosis(truth(), estimate, "gt.txt", "run.txt").findings) {
    EXPECT_EQ(found.fault, Fault::sheared) << text(found);
  }
}

TEST(DoctorOfRows, FewPosesOfAReferenceAccuseNobody) {
  const Trajectory two{truth().front(), truth().back()};
  const Diagnosis found = diagnosis(two, sampled(20), "gt.txt", "run.txt");
  EXPECT_THAT(found.findings, IsEmpty());
  EXPECT_THAT(found.unchecked, testing::Contains(HasSubstr("of the reference")));
}

TEST(DoctorOfRows, UnequalNumbersOfRowsAccuseNobody) {
  Trajectory estimate;
  for (std::size_t i = 0; i < sampled(20).size(); i += 1 + i % 3) {
    estimate.push_back(sampled(20)[i]);
  }
  for (const InputFinding& found :
       diagnosis(rows_of(truth_at(sampled(20))), rows_of(estimate), "a.txt", "b.txt", false)
           .findings) {
    EXPECT_NE(found.fault, Fault::wrong_recording) << text(found);
  }
}

TEST(DoctorOfPositions, TheLeverArmOfAnAntenna) {
  const Vector3 arm(0.5, -0.2, 0.4);
  Trajectory reference = truth();
  for (auto& [t, pose] : reference) pose = {no_rotation(), pose * arm};
  const InputFinding found = only_finding(reference, truth_at(sampled(20)), Fault::other_body);
  EXPECT_THAT(found.fix, testing::StartsWith("--ref-body=0.5"));
  EXPECT_THAT(found.evidence, HasSubstr("95 %"));
  EXPECT_NEAR(found.value, arm.norm(), 0.02);
}

/// A flat road, almost straight: neither axes nor orders of quaternions can be seen.
TEST(DoctorOfPositions, AFlatStraightDriveIsNotAccused) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Trajectory reference, estimate;
    double yaw = 0.0, drift = 0.0, x = 0.0, y = 0.0, ex = 0.0, ey = 0.0;
    for (int i = 0; i < 600; ++i) {
      const double t = 0.1 * i, speed = 8.0 + 2.0 * std::sin(0.2 * t);
      yaw = 0.99 * yaw + 0.004 * normal(random);
      drift += 0.0005 * normal(random);
      reference.push_back({t, {exp_so3({0, 0, yaw}), {x, y, 0}}});
      estimate.push_back({t, {exp_so3({0, 0, yaw + drift}), {ex, ey, 0}}});
      x += 0.1 * speed * std::cos(yaw);
      y += 0.1 * speed * std::sin(yaw);
      ex += 0.1 * 1.005 * speed * std::cos(yaw + drift);
      ey += 0.1 * 1.005 * speed * std::sin(yaw + drift);
    }
    EXPECT_THAT(faults(reference, estimate), IsEmpty()) << seed;
  }
}

}  // namespace
}  // namespace loopbench::test::doctor_maps_test

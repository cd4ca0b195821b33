// `eval` with references that are not full: positions, control points, an antenna, WGS 84.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/core/se3.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "harness/eval/trajectory_selection.hpp"
#include "harness/eval/transformation.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_positions_test {
namespace {

using namespace test;
using testing::HasSubstr;

const Pose kAntenna{Rotation::Identity(), {0.1, -0.2, 0.3}};

class EvalPositions : public testing::Test {
 protected:
  /// The golden reference with `point` in the body frame as position, and without rotation.
  std::string positions_of(const Pose& point, std::size_t every = 1) const {
    const Trajectory all = read_trajectory(golden("gt.txt"));
    Trajectory out;
    for (std::size_t i = 0; i < all.size(); i += every) {
      const Pose moved = all[i].world_from_body * point;
      out.push_back({all[i].stamp, {no_rotation(), moved.translation}});
    }
    const auto file = folder.path() / "positions.txt";
    write_trajectory(file, {.poses = out}, Format::tum);
    return file.string();
  }
  TemporaryFolder folder;
};

double ate_of(const Json& results) { return find(results, "ate", "translation")["rmse"]; }

TEST_F(EvalPositions, PositionsGiveTheAteOfTheFullReference) {
  const double full = ate_of(eval_json(drift()));
  const std::string positions = positions_of(Pose{});
  const Json results = eval_json({positions, golden("est_drift.txt")});
  EXPECT_NEAR(ate_of(results), full, 1e-12);
  EXPECT_THAT(
      eval({positions, golden("est_drift.txt")}),
      HasSubstr("undefined: the reference has positions\n  without rotation, so rotation is not"));
  EXPECT_THAT(eval(drift({"--ref-positions"})),
              HasSubstr("undefined: the reference has positions\n"));
  EXPECT_THAT(refusal<InputError>({positions, golden("est_drift.txt"), "--align_origin"}),
              HasSubstr("its first pose does not define a rotation"));
}

TEST_F(EvalPositions, TheEstimateIsMovedToTheAntenna) {
  const std::string body = "--ref-body=0.1,-0.2,0.3";
  const std::string antenna = positions_of(kAntenna);
  // The reference itself as estimate: nothing remains.
  EXPECT_NEAR(ate_of(eval_json({antenna, golden("gt.txt"), body})), 0.0, 1e-9);
  EXPECT_GT(ate_of(eval_json({antenna, golden("gt.txt")})), 0.05);
  EXPECT_THAT(refusal<InputError>({antenna, antenna, body}),
              HasSubstr("--ref-body needs rotations, and neither file has any"));
}

TEST_F(EvalPositions, TrajRejectsWhatNeedsRotations) {
  const Trajectory positions{{0, {no_rotation(), {0, 0, 0}}}, {1, {no_rotation(), {1, 0, 0}}}};
  EXPECT_THROW(by_motion(positions, 0.5, 5.0), InputError);
  EXPECT_EQ(by_motion(positions, 0.5, 360.0).size(), 2u);
  EXPECT_THROW(transformed(positions, Similarity{}, TransformSide::right), InputError);
  EXPECT_TRUE(lacks_rotations(transformed(positions, Similarity{}, TransformSide::left)));
}

TEST_F(EvalPositions, ControlPointsAreScoredAtTheirStamps) {
  const std::string points = positions_of(Pose{}, 40);
  const Json results =
      eval_json({points, golden("gt.txt"), "--protocol=hilti", "--set=align=none"});
  EXPECT_EQ(results["possible"], results["pairs"]);
  for (const Json& row : results["metrics"]) {
    if (row["metric"] == "control_points" && row["relation"] == "score") {
      EXPECT_EQ(row["mean"], 100.0);
    }
  }
}

TEST_F(EvalPositions, OneFrameShowsTheErrorWithoutAlignment) {
  Trajectory shifted = read_trajectory(golden("gt.txt"));
  for (StampedPose& pose : shifted) pose.world_from_body.translation.x() += 0.05;
  write_tum(folder.path() / "shifted.txt", shifted);
  const std::string shown = eval({golden("gt.txt"), (folder.path() / "shifted.txt").string()});
  EXPECT_THAT(shown, HasSubstr("in one frame: ATE 0.05 m without alignment"));
}

TEST_F(EvalPositions, LatitudesStateTheirDatumAndShareTheOrigin) {
  std::string table = "t,latitude,longitude,height\n";
  std::string other = table;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i;
    const std::string row = std::to_string(t) + "," + std::to_string(47.0 + 1e-5 * std::sin(t)) +
                            "," + std::to_string(8.0 + 1e-5 * t);
    table += row + ",400\n";
    other += row + ",401\n";
  }
  const std::vector<std::string> files{folder.file("a.csv", table).string(),
                                       folder.file("b.csv", other).string()};
  try {
    const std::string shown = eval(files);
    EXPECT_THAT(shown, HasSubstr("WGS 84, local coordinates east, north, up at latitude 47,"));
    EXPECT_THAT(shown, HasSubstr("both files are in one frame: ATE 1 m without alignment"));
  } catch (const MissingPart&) {
    GTEST_SKIP() << "built without GeographicLib";
  }
}

}  // namespace
}  // namespace loopbench::eval_positions_test

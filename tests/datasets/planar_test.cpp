#include "datasets/derive/planar.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/derive/problem_graph.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::planar_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const Vector3 kZ = Vector3::UnitZ();

/// A drive along a figure of eight in the plane z = 0, 121 poses at 1 Hz.
Trajectory drive() {
  Trajectory out;
  for (int i = 0; i <= 120; ++i) {
    const double u = 2.0 * M_PI * i / 60.0;
    const double heading = std::atan2(10.0 * std::cos(2.0 * u), 10.0 * std::cos(u));
    out.push_back({static_cast<double>(i),
                   {exp_so3(heading * kZ), {10.0 * std::sin(u), 5.0 * std::sin(2.0 * u), 0.0}}});
  }
  return out;
}

/// The same drive in another world, of another body.
Trajectory seen(const Pose& new_world_from_world, const Rotation& body_from_new) {
  Trajectory out = drive();
  for (auto& [stamp, pose] : out) {
    pose = normalized(new_world_from_world * pose * Pose{body_from_new, Vector3::Zero()});
  }
  return out;
}

const Pose kTilted{exp_so3({0.4, -1.1, 2.0}), {30.0, -20.0, 10.0}};
/// x right, y down, z forward, in a body with x forward, y left, z up.
const Rotation kCamera(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5));

Trajectory rounded(Trajectory poses) {
  for (auto& [stamp, pose] : poses) {
    for (double& x : pose.translation) x = std::round(1e6 * x) / 1e6;
    for (double& x : pose.rotation.coeffs()) x = std::round(1e6 * x) / 1e6;
    pose = normalized(pose);
  }
  return poses;
}

void expect_plane(const Trajectory& poses, const Vector3& in_body, const Vector3& in_world) {
  const auto found = motion_plane(poses);
  ASSERT_TRUE(found);
  EXPECT_NEAR((found->in_body - in_body).norm(), 0.0, 1e-5);
  EXPECT_NEAR((found->in_world - in_world).norm(), 0.0, 1e-5);
}

TEST(MotionPlane, IsFoundInAnyWorldAndBodyWithSixDigits) {
  expect_plane(drive(), kZ, kZ);
  expect_plane(rounded(drive()), kZ, kZ);
  expect_plane(rounded(seen(kTilted, Rotation::Identity())), kZ, kTilted.rotation * kZ);
  expect_plane(rounded(seen({}, kCamera)), Vector3::UnitY(), -kZ);
  expect_plane(
      seen({kCamera.conjugate(), {1e5, 5e6, 0.0}}, kCamera), Vector3::UnitY(), Vector3::UnitY());
  const Rotation askew = exp_so3({0.3, 0.2, 0.1});
  expect_plane(seen({}, askew), askew.conjugate() * kZ, kZ);
}

TEST(MotionPlane, OfAStraightLineIsThatOfTheBodysZ) {
  Trajectory line = on_a_line({0.0, 1.0, 2.0, 3.0}, 1.0);
  expect_plane(line, kZ, kZ);
  for (auto& [stamp, pose] : line) std::swap(pose.translation.x(), pose.translation.z());
  expect_plane(line, Vector3::UnitY(), Vector3::UnitY());
}

TEST(MotionPlane, OfPositionsIsFoundWithoutRotations) {
  Trajectory positions = drive();
  for (auto& [stamp, pose] : positions) pose.rotation = no_rotation();
  expect_plane(positions, kZ, kZ);
  positions[50].world_from_body.translation.z() = 0.01;
  EXPECT_FALSE(motion_plane(positions));
}

TEST(NearestPlane, OfPositionsOnAStraightRunIsThatOfTheWorldsZ) {
  Trajectory run = on_a_line({0.0, 10.0, 20.0, 30.0}, 1.0);
  for (auto& [stamp, pose] : run) pose.rotation = no_rotation();
  run[2].world_from_body.translation.z() = 0.5;
  EXPECT_EQ(nearest_plane(run).in_world, kZ);
  run[3].world_from_body.translation.z() = 20.0;  // a world with y up or down
  EXPECT_EQ(nearest_plane(run).in_world, Vector3::UnitY());
}

TEST(MotionPlane, DoesNotExistWithNoiseOrAtRest) {
  EXPECT_FALSE(motion_plane({}));
  EXPECT_FALSE(motion_plane(Trajectory(100)));
  Trajectory high = drive(), rolled = drive();
  high[60].world_from_body.translation.z() = 1e-4;
  rolled[60].world_from_body.rotation = rolled[60].world_from_body.rotation * exp_so3({1e-4, 0, 0});
  EXPECT_FALSE(motion_plane(high));
  EXPECT_FALSE(motion_plane(rolled));
  EXPECT_FALSE(motion_plane(random_walk(50, 1, 1.0, 0.3)));
}

std::string rows(const Trajectory& poses) {
  std::string out;
  for (const auto& [stamp, pose] : poses) {
    const auto& [q, t] = pose;
    out += fmt::format(
        "{} {} {} {} {} {} {} {}\n", stamp, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return out;
}

/// Two loops, the second of them `height` off the plane, and false in the plane.
std::string loops(double height) {
  return fmt::format("0 60 0 0 0 0 0 0 1\n20 80 1 2 {} 0 0 0.6 0.8\n", height);
}

struct Files {
  TemporaryFolder folder;
  Params options{{"estimate", "est.txt"},
                 {"reference", "gt.txt"},
                 {"closures.source", "file"},
                 {"closures.file", "loops.txt"}};

  explicit Files(const Trajectory& estimate, const Trajectory& reference, double height = 0.0) {
    folder.file("est.txt", rows(estimate));
    folder.file("gt.txt", rows(reference));
    folder.file("loops.txt", loops(height));
  }
  Sequence load() const { return load_dataset("trajectory", options, {{folder.path()}}); }
};

TEST(PlanarDataset, IsPlanarIfAllFilesAre) {
  const Sequence loaded = Files(drive(), seen(kTilted, Rotation::Identity())).load();
  EXPECT_TRUE(loaded.problem.planar);
  ASSERT_EQ(loaded.provenance.notes.size(), 1u);
  EXPECT_EQ(loaded.provenance.notes[0],
            "planar: the estimate, the reference and closures are in one plane, with normal z of "
            "the body, so poses are corrected in x, y and yaw (planar: no corrects all six)");
}

TEST(PlanarDataset, StaysSpatialIfOneFileIs) {
  Trajectory rough = drive();
  rough[7].world_from_body.translation.z() = 0.02;
  const auto note = [](const Files& files) {
    const Sequence loaded = files.load();
    EXPECT_FALSE(loaded.problem.planar);
    return loaded.provenance.notes.empty() ? "" : loaded.provenance.notes.front();
  };
  EXPECT_EQ(note(Files(drive(), rough)),
            "spatial: the estimate and closures are in one plane, but the reference not (planar: "
            "yes moves them to it)");
  EXPECT_THAT(note(Files(rough, drive())),
              HasSubstr("the reference is in one plane, but the estimate"));
  EXPECT_THAT(note(Files(drive(), drive(), 0.1)), HasSubstr("but closures not"));
  EXPECT_THAT(note(Files(drive(), seen({}, kCamera))), HasSubstr("but the reference not"));
  EXPECT_THAT(note(Files(rough, rough)), IsEmpty());
}

TEST(PlanarDataset, IsWhatTheOptionSays) {
  Files no(drive(), drive());
  no.options["planar"] = "no";
  EXPECT_FALSE(no.load().problem.planar);
  Trajectory rough = drive();
  rough[7].world_from_body.translation.z() = 0.02;
  Files yes(rough, rough, 0.1);
  yes.options["planar"] = "yes";
  const Sequence loaded = yes.load();
  EXPECT_TRUE(loaded.problem.planar);
  EXPECT_TRUE(motion_plane(loaded.problem.keyframes));
  EXPECT_TRUE(motion_plane(loaded.reference));
  EXPECT_NEAR(loaded.problem.closures[1].from_from_to.translation.z(), 0.0, 1e-12);
  EXPECT_EQ(loaded.provenance.notes.front(),
            "planar, as set: poses and closures were moved to the plane with normal z of the body, "
            "by up to 0.1 m and 0 deg");
}

TEST(PlanarDataset, MovesPositionsToAPlaneOfTheirOwnWorld) {
  Trajectory camera = seen({kCamera.conjugate(), {}}, kCamera), positions = drive();
  camera[7].world_from_body.translation.y() += 0.02;
  for (auto& [stamp, pose] : positions) pose.rotation = no_rotation();
  positions[9].world_from_body.translation.z() = 0.02;
  const PlanarParts parts{{{"the estimate", &camera}, {"the reference", &positions}}, {}};
  EXPECT_TRUE(choose_planar(Planar::yes, parts).planar);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vector3 moved = positions[i].world_from_body.translation;
    EXPECT_NEAR((moved - drive()[i].world_from_body.translation).norm(), 0.0, 1e-12) << i;
  }
}

TEST(PlanarDataset, TurnsTheBodyIfItsNormalIsNotZ) {
  const Trajectory camera = seen({kCamera.conjugate(), {1.0, 2.0, 3.0}}, kCamera);
  Files files(camera, camera);
  files.options.erase("closures.file");
  files.options["closures.source"] = "reference";
  const Sequence loaded = files.load();
  EXPECT_TRUE(loaded.problem.planar);
  EXPECT_THAT(loaded.provenance.notes.front(), HasSubstr("with normal y of the body"));
  const Rotation back = loaded.provenance.file_body_from_body.rotation.conjugate();
  for (std::size_t i = 0; i < camera.size(); ++i) {
    const Pose& pose = loaded.problem.keyframes[i].world_from_body;
    EXPECT_POSE_NEAR(
        normalized(pose * Pose{back, Vector3::Zero()}), camera[i].world_from_body, 1e-12, 1e-12);
    EXPECT_POSE_NEAR(pose, loaded.reference[i].world_from_body, 1e-12, 1e-12);
  }
  ASSERT_FALSE(loaded.problem.closures.empty());
  for (const Edge& edge : loaded.problem.closures) {
    EXPECT_TRUE(is_in_plane(edge.from_from_to, {kZ, kZ}, Vector3::Zero()));
  }
}

TEST(PlanarDataset, DrawsTheSameNoiseInTheAxesOfThePlane) {
  Files files(drive(), drive());
  files.options.erase("closures.file");
  files.options["closures.source"] = "reference";
  const std::vector<Edge> flat = files.load().problem.closures;
  files.options["planar"] = "no";
  const std::vector<Edge> spatial = files.load().problem.closures;
  ASSERT_EQ(flat.size(), spatial.size());
  const Edge& a = flat.front();
  const Edge& b = spatial.front();
  EXPECT_EQ(a.from_from_to.translation.z(), 0.0);
  EXPECT_NE(b.from_from_to.translation.z(), 0.0);
  EXPECT_NEAR(
      (a.from_from_to.translation - b.from_from_to.translation).head<2>().norm(), 0.0, 1e-3);
}

TEST(PlanarDataset, ReadsSe3LinesOfAPlanarGraph) {
  const TemporaryFolder folder;
  PoseGraph graph;
  for (const StampedPose& pose : drive()) {
    graph.ids.push_back(static_cast<std::int64_t>(graph.ids.size()));
    graph.vertices.push_back(pose.world_from_body);
  }
  for (std::size_t i = 0; i + 1 < graph.vertices.size(); ++i) {
    graph.edges.push_back({i, i + 1, graph.vertices[i].inverse() * graph.vertices[i + 1]});
  }
  graph.edges.push_back({0, 60, {}});
  write_g2o(folder.path() / "flat.g2o", graph);
  const Params options{{"path", "flat.g2o"}};
  const auto load = [&] { return load_dataset("pose_graph", options, {{folder.path()}}); };
  const Sequence loaded = load();
  EXPECT_TRUE(loaded.problem.planar);
  EXPECT_TRUE(problem_graph(loaded.problem, loaded.problem.keyframes).planar);
  graph.edges.back().from_from_to.translation.z() = 1.0;
  write_g2o(folder.path() / "flat.g2o", graph);
  EXPECT_FALSE(load().problem.planar);
}

TEST(PlanarDataset, RejectsAPlaneForSimilarities) {
  const TemporaryFolder folder;
  const PoseGraph graph{
      .ids = {0, 1}, .vertices = {{}, {}}, .edges = {{0, 1, {}}}, .similarity = true};
  write_g2o(folder.path() / "scaled.g2o", graph);
  const Params options{{"path", "scaled.g2o"}, {"planar", "yes"}};
  EXPECT_THROW(load_dataset("pose_graph", options, {{folder.path()}}), OptionError);
}

}  // namespace
}  // namespace loopbench::planar_test

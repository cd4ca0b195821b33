#include "tests/fuzz/targets.hpp"

#include <stdexcept>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/kitti.hpp"
#include "datasets/formats/times.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace loopbench {
namespace {

using Path = std::filesystem::path;

/// check() throws InputError, as readers do for an invalid file; on a reader's result it is a
/// finding.
template <class T, class... More>
void expect_checked(const T& value, More... more) {
  try {
    check(value, "result", more...);
  } catch (const InputError& error) {
    throw std::logic_error(std::string("violated postcondition: ") + error.what());
  }
}

/// Empty if the file is rejected with an InputError, as expected.
template <class Read>
auto read_or_refuse(Read read) -> decltype(read()) {
  try {
    return read();
  } catch (const InputError&) {
    return {};
  }
}

void fuzz_trajectory(const Path& file, Format format) {
  ReadOptions options;
  options.format = format;
  expect_checked(read_or_refuse([&] { return read_trajectory(file, options); }));
  options.positions = true;
  expect_checked(read_or_refuse([&] { return read_trajectory(file, options); }),
                 Rotations::optional);
}

/// Checks the edges as part of a problem of two poses.
void expect_sound(Edge edge) {
  edge.from = 0;
  edge.to = 1;
  Problem problem;
  problem.keyframes = {{0.0, {}}, {1.0, {}}};
  problem.closures = {edge};
  expect_checked(problem);
}

}  // namespace

void fuzz_tum(const Path& file) { fuzz_trajectory(file, Format::tum); }
void fuzz_kitti(const Path& file) {
  fuzz_trajectory(file, Format::kitti);
  for (const PoseMatrix& pose : read_or_refuse([&] { return read_kitti_matrices(file); })) {
    check_holds(pose.matrix().allFinite(), "matrices are finite");
  }
}
void fuzz_euroc(const Path& file) { fuzz_trajectory(file, Format::euroc); }
void fuzz_any(const Path& file) { fuzz_trajectory(file, Format::automatic); }

void fuzz_g2o(const Path& file) {
  const PoseGraph graph = read_or_refuse([&] { return read_g2o(file); });
  check_holds(graph.lines.size() == graph.edges.size(), "a line for each edge");
  check_holds(graph.vertices.empty() || graph.vertices.size() == graph.ids.size(),
              "a pose for each id");
  for (std::size_t i = 1; i < graph.ids.size(); ++i) {
    check_holds(graph.ids[i - 1] < graph.ids[i], "ids ascend");
  }
  for (const Pose& pose : graph.vertices) expect_checked(Trajectory{{0.0, pose}});
  for (const Edge& edge : graph.edges) {
    check_holds(edge.from < edge.to && edge.to < graph.ids.size(), "edges lead forward");
    expect_sound(edge);
  }
}

void fuzz_times(const Path& file) {
  const std::vector<double> times = read_or_refuse([&] { return read_times(file, {}); });
  for (std::size_t i = 0; i < times.size(); ++i) {
    check_holds(std::isfinite(times[i]), "times are finite");
    check_holds(i == 0 || times[i - 1] < times[i], "times increase");
  }
}

void fuzz_bag(const Path& file) {
  const auto read = [](const BagName& name) {
    const TrajectoryFile trajectory =
        read_or_refuse([&] { return read_trajectory_file(to_text(name)); });
    expect_checked(trajectory.poses);
    check_holds(trajectory.nanoseconds.size() == trajectory.poses.size(), "exact stamps");
  };
  for (const BagTopic& topic : read_or_refuse([&] { return bag_topics(file.string()); }).topics) {
    read({file.string(), topic.name});
  }
  read({file.string(), "tf:a.b"});
}

void fuzz_csv(const Path& file) { fuzz_trajectory(file, Format::csv); }
void fuzz_matrices(const Path& file) {
  for (const Format format : {Format::json, Format::npy, Format::log})
    fuzz_trajectory(file, format);
}

void fuzz_closures(const Path& file) {
  for (const StampedClosure& closure :
       read_or_refuse([&] { return read_closure_file(file, ClosureNoise{}); })) {
    check_holds(std::isfinite(closure.stamp_from) && std::isfinite(closure.stamp_to),
                "finite stamps");
    expect_checked(Trajectory{{0.0, closure.from_from_to}});
    check_holds(closure.noise.sigma_t > 0.0 && closure.noise.sigma_r > 0.0, "positive sigmas");
  }
}

}  // namespace loopbench

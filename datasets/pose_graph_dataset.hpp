/// The dataset `pose_graph`: a g2o file's chain as odometry, its other edges as closures.
#pragma once

#include "datasets/dataset.hpp"
#include "datasets/derive/false_closures.hpp"
#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

enum class GraphClosures { none, edges };
inline auto choices(GraphClosures) {
  return std::array{std::pair{"none", GraphClosures::none},
                    std::pair{"edges", GraphClosures::edges}};
}

/// `kitti_camera`: the truth's body is KITTI's camera (x right, y down, z forward) and the graph's
/// is a vehicle (x forward, y left, z up); the truth is turned to the latter.
/// Where it then still follows another point, `reference_body` says which.
enum class TruthAxes { same, kitti_camera };
inline auto choices(TruthAxes) {
  return std::array{std::pair{"same", TruthAxes::same},
                    std::pair{"kitti_camera", TruthAxes::kitti_camera}};
}

inline auto choices(TurnInformation) {
  return std::array{std::pair{"half_angles", TurnInformation::half_angles},
                    std::pair{"angles", TurnInformation::angles}};
}

struct PoseGraphOptions {
  std::string name;
  std::string path;
  std::string truth;
  TruthAxes truth_axes = TruthAxes::same;
  ReferenceBody reference_body;
  TurnInformation turns = TurnInformation::half_angles;
  double period = 0.1;
  std::int64_t keyframes_every = 1;
  GraphClosures closures = GraphClosures::edges;
  std::int64_t closures_max = 0;
  bool skip_placeholders = false;
  std::string true_list;
  FalseClosures false_closures;
  std::string stream;  ///< shared noise; empty: noise of its own
  std::string sensor;
  std::string licence;
};

template <class Visit>
void fields(PoseGraphOptions& o, Visit visit) {
  visit("name", o.name, "of the sequence; empty: folder and stem of the path");
  visit("path", o.path, "g2o file");
  visit("truth", o.truth, "g2o with the same ids, or poses, as many; empty: none");
  visit("truth_axes", o.truth_axes, "body axes of the truth");
  reference_body_fields(o.reference_body, visit);
  visit("information",
        o.turns,
        "what that of :QUAT edges is about: half_angles as g2o, angles as GTSAM and SE-Sync");
  visit("period", o.period, "stamp = id * period [s]", Above{0.0});
  visit("keyframes.every", o.keyframes_every, "k-th pose, and every loop's ends", Between{1});
  visit("closures.source", o.closures, "edges: all that are not i, i + 1");
  visit("closures.max", o.closures_max, "at most so many, well spread; 0: all", Between{0});
  // Off: what the file states is what a method gets, unless the config says otherwise.
  visit("closures.skip_placeholders",
        o.skip_placeholders,
        "drop closures measured as exactly the identity (robust_slam's unmeasured ones)");
  visit("closures.true_list", o.true_list, "file with `id id` a line: keep only these; empty: all");
  false_closure_fields(o.false_closures, visit);
  noise_stream_field(o.stream, visit);
  visit("sensor", o.sensor, "free text for the results");
  visit("licence", o.licence, "of the data, free text for the results");
}

/// No option is `given` that another one disables. Throws OptionError that names both.
void check_combination(const PoseGraphOptions& options, const Params& given);

/// Consecutive poses need an edge each where poses are left out between keyframes or the file has
/// no vertices; otherwise the graph may have gaps. Keyframes are every k-th pose, the last one and
/// both ends of every closure taken; odometry between them is composed from the file's edges. The
/// poses between become frames. `true_list` is the found file, or empty. `false_closures`, if any,
/// receives how many were added. Throws InputError. O(poses + edges).
Problem derive_problem(const PoseGraph& graph,
                       const PoseGraphOptions& options,
                       const std::filesystem::path& file,
                       const std::filesystem::path& true_list = {},
                       std::size_t* false_closures = nullptr);

/// Throws OptionError, InputError.
Sequence load_pose_graph(const PoseGraphOptions& options, const DataRoot& root);

}  // namespace loopbench

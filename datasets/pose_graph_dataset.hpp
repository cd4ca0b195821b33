/// The dataset `pose_graph`: a g2o file with edges i, i + 1 as odometry and the others as closures.
#pragma once

#include "datasets/dataset.hpp"
#include "datasets/derive/false_closures.hpp"
#include "datasets/derive/planar.hpp"
#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

enum class GraphClosures { none, edges };
inline auto choices(GraphClosures) {
  return std::array{std::pair{"none", GraphClosures::none},
                    std::pair{"edges", GraphClosures::edges}};
}

/// Body axes of the ground truth. `kitti_camera`: KITTI's camera axes (x right, y down, z forward),
/// which are rotated to the vehicle axes of the graph (x forward, y left, z up). A remaining offset
/// between the two bodies is given by `reference_body`.
enum class TruthAxes { same, kitti_camera };
inline auto choices(TruthAxes) {
  return std::array{std::pair{"same", TruthAxes::same},
                    std::pair{"kitti_camera", TruthAxes::kitti_camera}};
}

inline auto choices(RotationInformation) {
  return std::array{std::pair{"half_angles", RotationInformation::half_angles},
                    std::pair{"angles", RotationInformation::angles}};
}

inline auto choices(IndefiniteInformation) {
  return std::array{std::pair{"reject", IndefiniteInformation::reject},
                    std::pair{"repair", IndefiniteInformation::repair},
                    std::pair{"project", IndefiniteInformation::project}};
}

struct PoseGraphOptions {
  std::string name;
  std::string path;
  std::string truth;
  TruthAxes truth_axes = TruthAxes::same;
  ReferenceBody reference_body;
  InformationRules rules;
  double period = 0.1;
  std::int64_t keyframes_every = 1;
  std::string breaks;
  GraphClosures closures = GraphClosures::edges;
  std::int64_t closures_max = 0;
  bool skip_placeholders = false;
  std::string true_list;
  FalseClosures false_closures;
  Planar planar = Planar::automatic;
  std::string stream;  ///< name of a shared noise stream; empty: own stream
  std::string sensor;
  std::string licence;
};

template <class Visit>
void information_fields(InformationRules& rules, Visit visit) {
  visit("information",
        rules.rotation,
        "convention of the rotation information of :QUAT edges: half_angles (quaternion vector, "
        "g2o) or angles (GTSAM, SE-Sync)");
  visit("indefinite",
        rules.indefinite,
        "edges whose information is not positive definite: reject, repair (planar terms stored at "
        "z, roll and z, pitch), project (eigenvalues)");
}

template <class Visit>
void fields(PoseGraphOptions& o, Visit visit) {
  visit("name", o.name, "name of the sequence; empty: folder and file name of path");
  visit("path", o.path, "g2o file with the pose graph");
  visit("truth",
        o.truth,
        "ground truth file: g2o with the same vertex ids, or one pose per vertex; empty: none");
  visit("truth_axes", o.truth_axes, "body axes of the ground truth");
  reference_body_fields(o.reference_body, visit);
  information_fields(o.rules, visit);
  visit("period",
        o.period,
        "time between consecutive vertex ids: stamp = id * period [s]",
        GreaterThan{0.0});
  visit("keyframes.every",
        o.keyframes_every,
        "keyframe interval [poses]; endpoints of loop closures are always keyframes",
        Between{1});
  visit(
      "breaks",
      o.breaks,
      "ids of vertices at which the estimate starts again, separated by blanks: the odometry that "
      "arrives there is of unknown motion; empty: none");
  visit("closures.source",
        o.closures,
        "source of loop closures; edges: all edges except the odometry i, i + 1");
  visit("closures.max",
        o.closures_max,
        "maximum number of closures, subsampled evenly over the sequence; 0: all",
        Between{0});
  // Off by default: methods receive all edges of the file.
  visit("closures.skip_placeholders",
        o.skip_placeholders,
        "drop closures with exactly the identity as measurement (placeholders of robust_slam)");
  visit("closures.true_list",
        o.true_list,
        "file with the true closures, `id id` per line: all others are dropped; empty: keep all");
  false_closure_fields(o.false_closures, visit);
  planar_field(o.planar, visit);
  noise_stream_field(o.stream, visit);
  visit("sensor", o.sensor, "sensor, free text copied to the results");
  visit("licence", o.licence, "licence of the data, free text copied to the results");
}

/// Throws OptionError if a `given` option has no effect because of another option, naming both.
void check_combination(const PoseGraphOptions& options, const Params& given);

/// Derives a problem from a pose graph. Keyframes are every k-th pose, the last pose and both ends
/// of every closure kept; odometry between them is composed from the edges of the file. Other poses
/// become frames. If poses are omitted between keyframes or the file has no vertices, every pair of
/// consecutive poses needs an edge; otherwise the odometry may have gaps. `true_list` is the
/// resolved path of the list, or empty. The indices of added false closures are written to
/// `false_closures` unless it is null. Throws InputError. O(poses + edges).
Problem derive_problem(const PoseGraph& graph,
                       const PoseGraphOptions& options,
                       const std::filesystem::path& file,
                       const std::filesystem::path& true_list = {},
                       std::vector<std::size_t>* false_closures = nullptr);

/// Throws OptionError, InputError.
Sequence load_pose_graph(const PoseGraphOptions& options, const DataRoot& root);

}  // namespace loopbench

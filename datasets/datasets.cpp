#include "datasets/dataset.hpp"
#include "datasets/files/closest_name.hpp"
#include "datasets/pose_graph_dataset.hpp"
#include "datasets/simulated/simulated.hpp"
#include "datasets/trajectory_dataset.hpp"

namespace loopbench {

std::vector<DatasetEntry> datasets() {
  return {
      simulated_entry(),
      dataset<TrajectoryOptions>(
          "trajectory",
          "keyframes, odometry and loop closures from an estimated trajectory file",
          load_trajectory),
      dataset<PoseGraphOptions>(
          "pose_graph", "g2o pose graph: odometry chain and loop closures", load_pose_graph),
  };
}

std::filesystem::path DataRoot::find(const std::string& path) const {
  std::filesystem::path file(path);
  if (path.empty()) throw InputError("found an empty file name, expected the path of a file");
  if (file.is_absolute()) {
    if (std::filesystem::exists(file)) return file;
    throw DataMissing(path + ": no such file" + similar_file(file));
  }
  std::string tried, similar;
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::exists(folder / file)) return folder / file;
    tried += (tried.empty() ? "" : ", ") + folder.string();
    if (similar.empty()) similar = similar_file(folder / file);
  }
  throw DataMissing(path + ": no such file (looked in " + (tried.empty() ? "." : tried) +
                    "; set the data folder with --data DIR or $LOOPBENCH_DATA)" + similar);
}

}  // namespace loopbench

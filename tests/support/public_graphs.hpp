/// Public pose graphs of the data folder: pose_graphs/NAME.g2o.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "datasets/pose_graph_dataset.hpp"

namespace loopbench::test {

inline constexpr std::array kPublicGraphs = {"intel",
                                             "INTEL_1228_with_vertices",
                                             "MIT",
                                             "M3500_with_vertices",
                                             "city10000",
                                             "smallGrid3D",
                                             "parking-garage",
                                             "sphere2500",
                                             "torus3D",
                                             "cubicle"};

/// One of them in the data folder `root`; indefinite information is repaired.
inline Problem public_graph(const std::string& name,
                            const std::filesystem::path& root,
                            RotationInformation rotation = RotationInformation::half_angles) {
  PoseGraphOptions options;
  options.path = "pose_graphs/" + name + ".g2o";
  options.rules.rotation = rotation;
  options.rules.indefinite = IndefiniteInformation::repair;
  return load_pose_graph(options, {{root}}).problem;
}

}  // namespace loopbench::test

/// Public pose graphs of the data folder: pose_graphs/NAME.g2o.
#pragma once

#include <array>

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

}  // namespace loopbench::test

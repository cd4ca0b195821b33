/// Pose graphs, measured and simulated, and faults planted in them, for doctor_rates.
#pragma once

#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

using NamedProblem = std::pair<std::string, Problem>;

struct PlantedEdges {
  std::string name;
  std::string expected;  ///< finding
  /// Returns whether the problem has the fault afterwards.
  std::function<bool(Problem&, std::mt19937&)> plant;
};

/// Closure conventions are planted in graphs with at least three closures.
std::vector<PlantedEdges> edge_faults();

/// Whether the change of the closures exceeds the stated noise of their loops (one standard
/// deviation in the median; six for a false closure), over odometry or over another closure.
/// Smaller faults fit the files as well as the right closures.
bool exceeds_noise(const Problem& right, const Problem& planted);

/// The graphs of the data whose odometry is a chain and that have closures.
std::vector<NamedProblem> measured_graphs(const std::filesystem::path& data);

/// A right graph: planar, spatial or Sim(3), with one, two, ten or forty loops, to the first pose
/// or between others, with noise as stated or steady drift.
NamedProblem simulated_graph(std::mt19937& random);

}  // namespace loopbench

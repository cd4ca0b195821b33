/// Faults planted in the edges of real pose graphs, for planted_faults.
#pragma once

#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

struct PlantedEdges {
  std::string name;
  std::string expected;  ///< name of the finding
  std::function<void(Problem&, std::mt19937&)> plant;
  /// Why the fault has no effect that edges could show in this graph; empty if it has.
  std::function<std::string(const Problem&)> no_fault;
};

std::vector<PlantedEdges> edge_faults();

/// The real pose graphs below `data` that are a complete chain with closures, with their names.
std::vector<std::pair<std::string, Problem>> graphs(const std::filesystem::path& data);

}  // namespace loopbench

/// A pose graph told apart into the odometry chain and what closes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/derive/keyframes.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// Edges name poses by index, as in PoseGraph.
struct GraphParts {
  std::vector<Edge> odometry;  ///< each joins a pose and the next, ascending; some may be missing
  std::vector<Edge> closures;  ///< the others, in file order; a second edge i, i + 1 too
};

/// Throws InputError `file:line` when an edge's information is not positive definite or it joins a
/// pose to itself. O(edges).
GraphParts parts_of(const PoseGraph& graph, const std::filesystem::path& file);

/// Throws InputError naming the ids when the chain has a gap, and `why` that matters.
void refuse_gap(const GraphParts& parts,
                const PoseGraph& graph,
                const std::filesystem::path& file,
                const std::string& why);

/// stamp = id * period [s].
std::vector<double> stamps_of(const PoseGraph& graph, double period);

/// The vertices, or else the chained odometry: see chain().
Trajectory initial_poses(const PoseGraph& graph, double period);

/// Drops edges measured as exactly nothing moved: robust_slam writes these for loops that its
/// detector proposed and nobody measured.
void drop_placeholders(std::vector<Edge>& closures);

/// Keeps those listed in `list`, a line `id id` each in either order. Throws InputError
/// `list:line` for anything else, and for a pair the graph does not have.
void keep_listed(std::vector<Edge>& closures,
                 const std::vector<std::int64_t>& ids,
                 const std::filesystem::path& list);

/// At most `max` well-spread closures; 0 keeps all. Time stands for place: see spread().
void keep_spread(std::vector<Edge>& closures, const Trajectory& poses, std::size_t max);

}  // namespace loopbench

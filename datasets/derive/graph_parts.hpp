/// Separation of a pose graph into odometry and loop closures, and composition of odometry edges.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/keyframes.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// Edges refer to poses by index, as in PoseGraph.
struct GraphParts {
  std::vector<Edge> odometry;  ///< edges i, i + 1, ascending; some may be missing
  std::vector<Edge>
      closures;  ///< all other edges, in file order, including repeated edges i, i + 1
};

/// Separates the edges. Throws InputError `file:line: what` if the information of an edge is not
/// positive definite or if an edge connects a pose to itself. O(edges).
GraphParts split_graph(const PoseGraph& graph, const std::filesystem::path& file);

/// Throws InputError with the ids if an edge between consecutive poses is missing. `why` states the
/// condition under which it is required.
void require_complete_odometry(const GraphParts& parts,
                               const PoseGraph& graph,
                               const std::filesystem::path& file,
                               const std::string& why);

/// The vertices of the graph, or the composed odometry (see chain()) if it has none.
Trajectory initial_poses(const PoseGraph& graph, double period);

/// Drops edges with exactly the identity as measurement. robust_slam writes these for loops that
/// were detected but not measured.
void drop_placeholders(std::vector<Edge>& closures);

/// Keeps the closures listed in the file `list`, one per line as `id id` in either order. Throws
/// InputError `list:line: what` for an invalid line and for a pair without a closure in the graph.
void keep_listed(std::vector<Edge>& closures,
                 const std::vector<std::int64_t>& ids,
                 const std::filesystem::path& list);

/// Subsamples at most `max` closures, evenly over time; 0 keeps all.
void subsample_closures(std::vector<Edge>& closures, const Trajectory& poses, std::size_t max);

/// Composes the edges of a chain between the poses `kept` (ascending) and renumbers them by
/// position in `kept`. chain[i] connects i and i + 1. Edges between consecutive kept poses are
/// copied unchanged. The covariance of an edge a: i -> j is transported to the end of the next edge
/// b: j -> k by the adjoint:
///   S_ik = Ad(b^-1) S_ij Ad(b^-1)^T + S_jk,
/// to first order in the noise. Scales are multiplied; the translation of b and S_jk are converted
/// from the scale of j to that of i. Throws std::invalid_argument if an information matrix is not
/// positive definite. O(chain).
std::vector<Edge> bridge(const std::vector<Edge>& chain, const std::vector<std::size_t>& kept);

}  // namespace loopbench

/// Interface of methods that extend their solution while data arrive.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Data that arrived since the last update. Indices of edges count all keyframes from the first
/// one.
struct Increment {
  Trajectory keyframes;                       ///< world_from_body as estimated by the tracker
  std::vector<Edge> odometry;                 ///< sorted by `from`
  std::vector<Edge> closures;                 ///< between known keyframes, in the order of arrival
  std::vector<Edge> withdrawn;                ///< equal to closures of this or an earlier increment
  Trajectory frames;                          ///< as Problem::frames
  std::vector<std::size_t> shared_landmarks;  ///< as Problem::shared_landmarks
};

/// A complete problem as one increment.
inline Increment complete(const Problem& problem) {
  return {problem.keyframes,
          problem.odometry,
          problem.closures,
          {},
          problem.frames,
          problem.shared_landmarks};
}

/// Whether two edges are the same measurement of the same keyframes.
inline bool is_same_measurement(const Edge& a, const Edge& b) {
  return a.from == b.from && a.to == b.to &&
         a.from_from_to.translation == b.from_from_to.translation &&
         a.from_from_to.rotation.coeffs() == b.from_from_to.rotation.coeffs();
}

/// Solution of a problem that grows. Not thread-safe, bit-identical for the same increments.
class Incremental {
 public:
  virtual ~Incremental() = default;

  /// Returns world_from_body of all keyframes so far, in their order and with their stamps. Throws
  /// std::runtime_error on failure; the object is unusable then.
  virtual Trajectory update(const Increment& added, Report& report) = 0;
};

}  // namespace loopbench::methods

#include "datasets/simulated/revisits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

namespace loopbench {
namespace {

/// The latest few poses in one cube of space.
class Cell {
 public:
  void add(std::size_t pose) { poses_[count_++ % poses_.size()] = pose; }

  template <class Visit>
  void each(Visit visit) const {
    for (std::size_t k = 0; k < std::min(count_, poses_.size()); ++k) visit(poses_[k]);
  }

 private:
  std::array<std::size_t, 8> poses_{};
  std::size_t count_ = 0;
};

/// Cubes with edges of one radius. Far cubes may share a key: then there is more to compare, no
/// more to find.
class Grid {
 public:
  explicit Grid(double size) : size_(size) {}

  void add(const Vector3& point, std::size_t pose) { cells_[key(point, 0, 0, 0)].add(pose); }

  template <class Visit>
  void each_near(const Vector3& point, Visit visit) const {
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto found = cells_.find(key(point, i, j, k));
          if (found != cells_.end()) found->second.each(visit);
        }
      }
    }
  }

 private:
  std::uint64_t key(const Vector3& point, int i, int j, int k) const {
    const auto part = [&](double x, int step) {
      const double cell = std::floor(x / size_) + step;
      // 21 bits a coordinate, wrapped; fmod keeps a tiny radius from overflowing the integer.
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::fmod(cell, 2097152.0))) &
             0x1fffffU;
    };
    return part(point.x(), i) << 42 | part(point.y(), j) << 21 | part(point.z(), k);
  }

  double size_;
  std::unordered_map<std::uint64_t, Cell> cells_;
};

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> revisits(const Trajectory& truth,
                                                          const SamePlace& same) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  Grid grid(same.radius);
  std::size_t old = 0;  // poses before it are in the grid
  for (std::size_t to = 0; to < truth.size(); ++to) {
    const auto& [stamp, here] = truth[to];
    for (; truth[old].stamp <= stamp - same.min_gap; ++old) {
      grid.add(truth[old].world_from_body.translation, old);
    }
    std::optional<std::size_t> nearest;
    double least = std::numeric_limits<double>::infinity();
    grid.each_near(here.translation, [&](std::size_t from) {
      const Pose& there = truth[from].world_from_body;
      const double distance = (there.translation - here.translation).norm();
      const bool better = distance < least || (distance == least && from > *nearest);
      if (better && same.holds(there, here)) {
        nearest = from;
        least = distance;
      }
    });
    if (nearest) out.emplace_back(*nearest, to);
  }
  return out;
}

}  // namespace loopbench

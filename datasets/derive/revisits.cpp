#include "datasets/derive/revisits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace loopbench {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) {  // large odd multiplier: separates neighbouring cells
      hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

constexpr std::size_t kFewRecent = 64;  // enough for several slow passes

/// The latest poses in one grid cell. Their number is bounded so that the search stays linear for a
/// body at rest.
class RecentPoses {
 public:
  void add(std::size_t index, std::size_t capacity) {
    if (indices_.size() < capacity) {
      indices_.push_back(index);
    } else {
      indices_[next_++ % capacity] = index;
    }
  }
  const std::vector<std::size_t>& indices() const { return indices_; }

 private:
  std::vector<std::size_t> indices_;
  std::size_t next_ = 0;
};

class Grid {
 public:
  /// `capacity`: of a cell.
  Grid(double size, std::size_t capacity) : size_(size), capacity_(capacity) {}

  void add(const Vector3& point, std::size_t index) {
    cells_[cell_of(point)].add(index, capacity_);
  }

  /// Calls visit(index) for every point in the 27 cells around `point`.
  template <class Visit>
  void near(const Vector3& point, Visit visit) const {
    const Cell centre = cell_of(point);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find({centre[0] + x, centre[1] + y, centre[2] + z});
          if (found == cells_.end()) continue;
          for (const std::size_t index : found->second.indices()) visit(index);
        }
      }
    }
  }

 private:
  Cell cell_of(const Vector3& point) const {
    const auto axis_index = [&](double x) {
      // The bound keeps the conversion defined for extreme coordinates.
      return static_cast<std::int64_t>(std::clamp(std::floor(x / size_), -1e18, 1e18));
    };
    return {axis_index(point.x()), axis_index(point.y()), axis_index(point.z())};
  }

  double size_;
  std::size_t capacity_;
  std::unordered_map<Cell, RecentPoses, CellHash> cells_;
};

}  // namespace

std::vector<Revisit> find_revisits(const Trajectory& poses, const RevisitRule& rule) {
  std::vector<Revisit> out;
  const double radius = rule.view ? rule.view->farthest : rule.radius;
  Grid grid(radius, rule.view ? poses.size() : kFewRecent);
  std::optional<SharedView> view;
  if (rule.view) view.emplace(*rule.view);
  const auto is_alike = [&](const Pose& earlier, const Pose& current) {
    if (view) return view->is_seen_again(current.inverse() * earlier);
    return angle_between(earlier.rotation, current.rotation) <= rule.angle;
  };
  std::size_t next_old = 0;  // earlier poses are older than min_gap and in the grid
  for (std::size_t to = 0; to < poses.size(); ++to) {
    const Pose& current = poses[to].world_from_body;
    for (; next_old < to && poses[to].stamp - poses[next_old].stamp >= rule.min_gap; ++next_old) {
      grid.add(poses[next_old].world_from_body.translation, next_old);
    }
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t from = to;
    grid.near(current.translation, [&](std::size_t i) {
      const Pose& earlier = poses[i].world_from_body;
      const double distance = (earlier.translation - current.translation).norm();
      if (distance > radius || distance > nearest || (distance == nearest && i > from)) return;
      if (!is_alike(earlier, current)) return;
      nearest = distance;
      from = i;
    });
    if (from != to) out.push_back({from, to});
  }
  return out;
}

std::vector<std::size_t> subsample(const std::vector<Revisit>& revisits,
                                   const std::vector<double>& stamps,
                                   std::size_t count) {
  std::vector<std::size_t> chosen(std::min(revisits.size(), count));
  if (chosen.size() == revisits.size()) {
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  const auto distance = [&](const Revisit& a, const Revisit& b) {
    return std::hypot(stamps[a.from] - stamps[b.from], stamps[a.to] - stamps[b.to]);
  };
  // Distance to the nearest chosen revisit; initially the duration of the loop.
  std::vector<double> merit;
  for (const Revisit& r : revisits) merit.push_back(stamps[r.to] - stamps[r.from]);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto best =
        static_cast<std::size_t>(std::max_element(merit.begin(), merit.end()) - merit.begin());
    chosen[k] = best;
    for (std::size_t i = 0; i < revisits.size(); ++i) {
      const double to_best = distance(revisits[i], revisits[best]);
      merit[i] = k == 0 ? to_best : std::min(merit[i], to_best);
    }
    for (std::size_t i = 0; i <= k; ++i) merit[chosen[i]] = -1.0;  // never chosen twice
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace loopbench

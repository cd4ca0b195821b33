#include "metrics/doctor/closure_paths.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace loopbench::metrics {
namespace {

constexpr double kClosureLength = 2.0;  // [m]
constexpr double kLeastStep = 1e-3;     // [m]; so that a path over many keyframes is longer

double step_length(const Edge& step) { return step.from_from_to.translation.norm() + kLeastStep; }

/// Shortest paths in a graph, one pair of keyframes after the other.
class PathSearch {
 public:
  PathSearch(const Problem& problem, const std::vector<const Edge*>& without)
      : problem_(problem),
        without_(without),
        first_(problem.keyframes.size() + 1, 0),
        lengths_(problem.keyframes.size(), kUnknown),
        last_edges_(problem.keyframes.size(), nullptr) {
    for (const Edge& edge : problem.closures) {
      ++first_[edge.from + 1];
      ++first_[edge.to + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    closures_.resize(2 * problem.closures.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const Edge& edge : problem.closures) {
      closures_[next[edge.from]++] = &edge;
      closures_[next[edge.to]++] = &edge;
    }
  }

  std::size_t visited() const { return visited_; }

  /// Path from the closure's first to its last keyframe that does not use the closure.
  PathGap gap(const Edge& closure) {
    for (const std::size_t i : reached_) lengths_[i] = kUnknown;
    reached_.clear();
    queue_ = {};
    reach(closure.from, 0.0, nullptr);
    while (!queue_.empty()) {
      const auto [length, at] = queue_.top();
      queue_.pop();
      if (length > lengths_[at]) continue;
      if (at == closure.to) break;
      ++visited_;
      if (at > 0) follow(problem_.odometry[at - 1], at, length, true);
      if (at < problem_.odometry.size()) follow(problem_.odometry[at], at, length, true);
      for (std::size_t i = first_[at]; i < first_[at + 1]; ++i) {
        const bool is_used =
            closures_[i] != &closure && std::ranges::find(without_, closures_[i]) == without_.end();
        if (is_used) follow(*closures_[i], at, length, false);
      }
    }
    const Pose difference = closure.from_from_to.inverse() * composed(closure);
    return {&closure, difference.translation.norm(), lengths_[closure.to]};
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  void reach(std::size_t keyframe, double length, const Edge* over) {
    if (!(length < lengths_[keyframe])) return;
    if (lengths_[keyframe] == kUnknown) reached_.push_back(keyframe);
    lengths_[keyframe] = length;
    last_edges_[keyframe] = over;
    queue_.push({length, keyframe});
  }

  void follow(const Edge& edge, std::size_t at, double length, bool is_step) {
    reach(edge.from == at ? edge.to : edge.from,
          length + (is_step ? step_length(edge) : kClosureLength),
          &edge);
  }

  Pose composed(const Edge& closure) const {
    Pose out;  // from the path's keyframe to its end
    for (std::size_t at = closure.to; at != closure.from;) {
      const Edge& edge = *last_edges_[at];
      const bool is_forward = edge.to == at;
      out = normalized((is_forward ? edge.from_from_to : edge.from_from_to.inverse()) * out);
      at = is_forward ? edge.from : edge.to;
    }
    return out;
  }

  const Problem& problem_;
  const std::vector<const Edge*>& without_;
  std::vector<std::size_t> first_;       ///< of each keyframe in `closures_`
  std::vector<const Edge*> closures_;    ///< by keyframe
  std::vector<double> lengths_;          ///< of the path to each keyframe [m]
  std::vector<const Edge*> last_edges_;  ///< of the path to each keyframe
  std::vector<std::size_t> reached_;     ///< keyframes with a length
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::size_t visited_ = 0;
};

/// An even sample of the closures, then all others, those that contradict the odometry most first.
std::vector<const Edge*> in_order_of_use(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr std::size_t kSample = 30;
  std::vector<const Edge*> out, others;
  const std::size_t step = closures.size() / kSample + 1;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    (i % step == 0 ? out : others).push_back(&closures[i]);
  }
  std::vector<std::pair<double, const Edge*>> sorted;
  for (const Edge* const edge : others) {
    sorted.emplace_back(-drift_of(*edge, chain), edge);
  }
  std::ranges::stable_sort(sorted, {}, &std::pair<double, const Edge*>::first);
  for (const auto& entry : sorted) out.push_back(entry.second);
  return out;
}

}  // namespace

std::vector<PathGap> path_gaps(const Problem& problem,
                               const Chain& chain,
                               const std::vector<const Edge*>& without) {
  constexpr std::size_t kMostVisited = 50'000;
  std::vector<PathGap> out;
  PathSearch search(problem, without);
  for (const Edge* const edge : in_order_of_use(problem.closures, chain)) {
    if (search.visited() > kMostVisited) break;
    if (std::ranges::find(without, edge) != without.end()) continue;
    out.push_back(search.gap(*edge));
  }
  return out;
}

}  // namespace loopbench::metrics

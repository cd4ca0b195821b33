#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <tuple>

#include "metrics/association.hpp"

namespace loopbench {
namespace {

/// A stamp of either list. 32-bit indices keep it at 16 bytes; 4e9 poses would be 256 GB.
struct Node {
  double time;
  std::uint32_t index;
  bool is_reference;
};

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::vector<Node> merge(const std::vector<double>& reference, const std::vector<double>& estimate) {
  std::vector<Node> out;
  out.reserve(reference.size() + estimate.size());
  std::size_t r = 0;
  std::size_t e = 0;
  while (r < reference.size() || e < estimate.size()) {
    const bool take_reference =
        e == estimate.size() || (r < reference.size() && reference[r] <= estimate[e]);
    std::size_t& index = take_reference ? r : e;
    const double time = take_reference ? reference[r] : estimate[e];
    out.push_back({time, static_cast<std::uint32_t>(index++), take_reference});
  }
  return out;
}

IndexPair pair_of(const Node& a, const Node& b) {
  return a.is_reference ? IndexPair{a.index, b.index} : IndexPair{b.index, a.index};
}

/// Pairs nearer to each other than to anything else are in the greedy answer whatever else is;
/// this takes most of them in one scan and leaves the rest in `nodes`.
template <class IsWithin>
void take_mutually_nearest(std::vector<Node>& nodes,
                           IsWithin is_within,
                           std::vector<IndexPair>& out) {
  const std::size_t n = nodes.size();
  const double infinity = std::numeric_limits<double>::infinity();
  std::size_t kept = 0;
  double before = infinity;
  for (std::size_t k = 0; k < n; ++k) {
    const double gap = k + 1 < n ? nodes[k + 1].time - nodes[k].time : infinity;
    const double after = k + 2 < n ? nodes[k + 2].time - nodes[k + 1].time : infinity;
    const bool is_pair = k + 1 < n && nodes[k].is_reference != nodes[k + 1].is_reference &&
                         gap < before && gap < after && is_within(gap);
    if (is_pair) {
      out.push_back(pair_of(nodes[k], nodes[k + 1]));
      ++k;
      before = after;
    } else {
      nodes[kept++] = nodes[k];
      before = gap;
    }
  }
  nodes.resize(kept);
}

/// The greedy rule on a linked list in time: the closest remaining pair is always made of
/// neighbours, for anything between them would be closer to one of the two.
template <class IsWithin>
void take_closest_first(const std::vector<Node>& nodes,
                        IsWithin is_within,
                        std::vector<IndexPair>& out) {
  struct Candidate {
    double gap;
    IndexPair pair;
    std::uint32_t left;
    std::uint32_t right;
  };
  const auto is_later = [](const Candidate& a, const Candidate& b) {
    return std::tie(a.gap, a.pair.reference, a.pair.estimate) >
           std::tie(b.gap, b.pair.reference, b.pair.estimate);
  };
  std::priority_queue<Candidate, std::vector<Candidate>, decltype(is_later)> queue(is_later);
  const auto n = static_cast<std::uint32_t>(nodes.size());
  std::vector<std::uint32_t> previous(n);
  std::vector<std::uint32_t> next(n);
  std::vector<bool> is_taken(n, false);
  const auto offer = [&](std::uint32_t left, std::uint32_t right) {
    if (left == kNone || right == kNone) return;
    const double gap = nodes[right].time - nodes[left].time;
    if (nodes[left].is_reference == nodes[right].is_reference || !is_within(gap)) return;
    queue.push({gap, pair_of(nodes[left], nodes[right]), left, right});
  };
  for (std::uint32_t k = 0; k < n; ++k) {
    previous[k] = k == 0 ? kNone : k - 1;
    next[k] = k + 1 == n ? kNone : k + 1;
    offer(previous[k], k);
  }
  while (!queue.empty()) {
    const Candidate best = queue.top();
    queue.pop();
    if (is_taken[best.left] || is_taken[best.right]) continue;
    is_taken[best.left] = is_taken[best.right] = true;
    out.push_back(best.pair);
    const std::uint32_t before = previous[best.left];
    const std::uint32_t after = next[best.right];
    if (before != kNone) next[before] = after;
    if (after != kNone) previous[after] = before;
    offer(before, after);
  }
}

}  // namespace

std::vector<IndexPair> match_one_to_one(const std::vector<double>& reference,
                                        std::vector<double> estimate,
                                        double max_diff,
                                        Limit limit,
                                        double offset) {
  for (double& stamp : estimate) stamp += offset;
  const auto is_within = [=](double gap) {
    return limit == Limit::strict ? gap < max_diff : gap <= max_diff;
  };
  std::vector<IndexPair> out;
  out.reserve(std::min(reference.size(), estimate.size()));
  std::vector<Node> nodes = merge(reference, estimate);
  take_mutually_nearest(nodes, is_within, out);
  take_closest_first(nodes, is_within, out);
  std::sort(out.begin(), out.end(), [](const IndexPair& a, const IndexPair& b) {
    return a.reference < b.reference;
  });
  return out;
}

}  // namespace loopbench

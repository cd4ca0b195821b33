#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <tuple>

#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {
namespace {

/// A stamp of either list. 32-bit indices keep it at 16 bytes; 4e9 poses would be 256 GB.
struct Node {
  double time;
  std::uint32_t index;
  bool is_reference;
  bool is_past_a_pair = false;  ///< a pair was removed between this node and the previous one
};

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Both lists sorted by time; the reference first if times are equal.
class Merge {
 public:
  Merge(const std::vector<double>& reference, const std::vector<double>& estimate)
      : reference_(reference), estimate_(estimate) {}

  /// Sentinel after the last node, infinitely late.
  Node next() {
    if (r_ == reference_.size() && e_ == estimate_.size()) return {kNever, kNone, true};
    if (e_ == estimate_.size() || (r_ < reference_.size() && reference_[r_] <= estimate_[e_])) {
      return {reference_[r_], static_cast<std::uint32_t>(r_++), true};
    }
    return {estimate_[e_], static_cast<std::uint32_t>(e_++), false};
  }

 private:
  const std::vector<double>& reference_;
  const std::vector<double>& estimate_;
  std::size_t r_ = 0;
  std::size_t e_ = 0;
};

IndexPair pair_of(const Node& a, const Node& b) {
  return a.is_reference ? IndexPair{a.index, b.index} : IndexPair{b.index, a.index};
}

/// Mutual nearest neighbours are always part of the greedy result. Takes most pairs in one scan and
/// returns the remaining nodes, which record where pairs were removed.
template <class IsWithin>
std::vector<Node> take_mutually_nearest(Merge merge,
                                        IsWithin is_within,
                                        std::vector<IndexPair>& out) {
  std::vector<Node> kept;
  double before = kNever;
  Node a = merge.next();
  Node b = merge.next();
  Node c = merge.next();
  while (a.time != kNever) {
    const double gap = b.time - a.time;
    const double after = c.time - b.time;
    const bool is_pair =
        a.is_reference != b.is_reference && gap < before && gap < after && is_within(gap);
    if (is_pair) {
      out.push_back(pair_of(a, b));
      before = after;
      a = c;
      a.is_past_a_pair = true;
      b = merge.next();
    } else {
      kept.push_back(a);
      before = gap;
      a = b;
      b = c;
    }
    c = merge.next();
  }
  return kept;
}

/// The greedy rule on a linked list in time: the closest remaining pair always consists of
/// neighbours, because a pose between them would be closer to one of the two. Two nodes with a
/// removed pair between them would cross that pair.
template <class IsWithin>
void take_closest_first(const std::vector<Node>& nodes,
                        IsWithin is_within,
                        Crossing crossing,
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
  const auto add_candidate = [&](std::uint32_t left, std::uint32_t right) {
    if (left == kNone || right == kNone) return;
    if (crossing == Crossing::refused && nodes[right].is_past_a_pair) return;
    const double gap = nodes[right].time - nodes[left].time;
    if (nodes[left].is_reference == nodes[right].is_reference || !is_within(gap)) return;
    queue.push({gap, pair_of(nodes[left], nodes[right]), left, right});
  };
  for (std::uint32_t k = 0; k < n; ++k) {
    previous[k] = k == 0 ? kNone : k - 1;
    next[k] = k + 1 == n ? kNone : k + 1;
    add_candidate(previous[k], k);
  }
  while (!queue.empty()) {
    const Candidate best = queue.top();
    queue.pop();
    if (is_taken[best.left] || is_taken[best.right]) continue;
    is_taken[best.left] = is_taken[best.right] = true;
    out.push_back(best.pair);
    const std::uint32_t before = previous[best.left];
    const std::uint32_t after = next[best.right];
    if (crossing == Crossing::refused) continue;
    if (before != kNone) next[before] = after;
    if (after != kNone) previous[after] = before;
    add_candidate(before, after);
  }
}

}  // namespace

std::vector<IndexPair> match_one_to_one(const std::vector<double>& reference,
                                        std::vector<double> estimate,
                                        double max_diff,
                                        Limit limit,
                                        Crossing crossing,
                                        double offset) {
  for (double& stamp : estimate) stamp += offset;
  const auto is_within = [=](double gap) {
    return limit == Limit::strict ? gap < max_diff : gap <= max_diff;
  };
  std::vector<IndexPair> out;
  out.reserve(std::min(reference.size(), estimate.size()));
  const std::vector<Node> rest = take_mutually_nearest(Merge(reference, estimate), is_within, out);
  const auto found = static_cast<std::ptrdiff_t>(out.size());  // already sorted
  take_closest_first(rest, is_within, crossing, out);
  const auto by_reference = [](const IndexPair& a, const IndexPair& b) {
    return a.reference < b.reference;
  };
  std::sort(out.begin() + found, out.end(), by_reference);
  std::inplace_merge(out.begin(), out.begin() + found, out.end(), by_reference);
  return out;
}

}  // namespace loopbench::metrics

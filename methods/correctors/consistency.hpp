/// Pairwise consistency check of loop closures before any correction, by maximum cliques.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Default of the largest number of closures of which all pairs are compared.
inline constexpr std::int64_t kMaxComparedClosures = 1500;

/// Residual and covariance of the loop through two closures a -> b and c -> d,
///     E = L_ab^-1 O_ac L_cd O_db   (O: odometry, in either direction).
/// The closures are consistent when Log(E)' S^-1 Log(E) is below its 99 % quantile. The covariance
/// S is propagated to first order; odometry that is traversed twice enters once, with its sign.
/// O(1) per pair with prefix sums over the chain.
struct PairError {
  Twist error;
  Matrix6 covariance;
};
PairError pair_error(const Problem& problem, const Edge& first, const Edge& second);

struct ConsistentClosures {
  std::vector<std::size_t> kept;  ///< ascending
  bool is_largest = false;        ///< the set is proved to be the largest
};

/// Note of robust methods that use a single closure.
inline constexpr const char* kOneClosure = "one closure cannot be checked by others";

/// Returns the largest set of pairwise consistent closures (PCM). A closure that is consistent with
/// no other is dropped, unless it is the only one. Requires complete odometry: see why_no_chain().
/// O(n + K^2) plus a clique search. Source: Mangelson, Dominic, Eustice, Vasudevan, Pairwise
/// consistent measurement set maximization, ICRA 2018.
ConsistentClosures consistent_closures(const Problem& problem);

/// Undirected graph stored as an adjacency matrix of bits.
class BitGraph {
 public:
  explicit BitGraph(std::size_t size)
      : size_(size), words_((size + 63) / 64), bits_(size * words_, 0) {}

  std::size_t size() const { return size_; }
  std::size_t words() const { return words_; }
  const std::uint64_t* row(std::size_t a) const { return bits_.data() + a * words_; }
  bool joined(std::size_t a, std::size_t b) const { return (row(a)[b / 64] >> (b % 64)) & 1U; }
  void join(std::size_t a, std::size_t b) {
    bits_[a * words_ + b / 64] |= std::uint64_t{1} << (b % 64);
    bits_[b * words_ + a / 64] |= std::uint64_t{1} << (a % 64);
  }

 private:
  std::size_t size_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

struct Clique {
  std::vector<std::size_t> members;  ///< ascending
  bool is_largest = false;           ///< proved maximum; otherwise the largest clique found
};

/// Returns the largest set of mutually adjacent vertices. First builds greedy cliques from every
/// vertex, O(size^2 size / 64). Then runs branch and bound with greedy colouring (Tomita and Seki
/// 2003; San Segundo et al. 2011) for at most `max_steps` steps; exponential in the worst case.
/// Deterministic: the same graph gives the same clique.
Clique max_clique(const BitGraph& graph, std::size_t max_steps);

}  // namespace loopbench::methods

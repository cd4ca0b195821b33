/// Maximum clique: the largest set of mutually adjacent vertices of a graph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace loopbench::methods {

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

/// First builds greedy cliques from every vertex, O(size^2 size / 64). Then runs branch and bound
/// with greedy colouring (Tomita and Seki 2003; San Segundo et al. 2011) for at most `max_steps`
/// steps; exponential in the worst case. Deterministic: the same graph gives the same clique.
Clique max_clique(const BitGraph& graph, std::size_t max_steps);

}  // namespace loopbench::methods

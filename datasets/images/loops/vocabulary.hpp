/// Vocabulary tree, which quantises descriptors to visual words.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/images/features/features.hpp"

namespace loopbench::rgbd {

/// Vocabulary tree (Nister and Stewenius 2006) trained by k-medians. The centre of binary
/// descriptors is the majority of each bit (Galvez-Lopez and Tardos 2012), of other descriptors the
/// mean of each byte.
class Vocabulary {
 public:
  /// Trains a tree with `levels` levels of `branches` branches, fewer for small groups of
  /// descriptors. Deterministic for equal input and seed. O(descriptors * branches * levels).
  Vocabulary(const Features& descriptors,
             std::size_t branches,
             std::size_t levels,
             std::uint64_t seed);

  std::size_t words() const { return words_; }

  /// Returns the word of descriptor row i. O(branches * levels).
  std::size_t word(const Features& features, std::size_t i) const;

 private:
  struct Node {
    std::size_t first_child = 0;
    std::size_t children = 0;  ///< 0: leaf, which is a word
    std::size_t word = 0;
  };

  void grow(std::size_t node,
            const Features& all,
            const std::vector<std::size_t>& members,
            std::size_t levels);

  std::size_t branches_;
  std::uint64_t seed_;
  std::vector<Node> nodes_;
  Features centres_;  ///< row k: centre of nodes_[k]
  std::size_t words_ = 0;
};

}  // namespace loopbench::rgbd

/// Retrieval of similar older keyframes by bag-of-words vectors.
#pragma once

#include <utility>
#include <vector>

#include "datasets/images/loops/vocabulary.hpp"
#include "datasets/images/tracking/tracker.hpp"

namespace loopbench::rgbd {

struct RetrievedKeyframe {
  std::size_t keyframe = 0;
  double similarity =
      0.0;  ///< relative to the similarity of the query and its predecessor, >= 0 [-]
};

/// Returns the consistent candidates of each keyframe at least `min_gap` [s] older, most similar
/// first. O(keyframes^2).
std::vector<std::vector<RetrievedKeyframe>> retrieve(const std::vector<Keyframe>& keyframes,
                                                     double min_gap);

/// Weighted words of one image, sorted by word, weights sum to 1.
using Bag = std::vector<std::pair<std::size_t, double>>;

/// Computes bag-of-words vectors with tf-idf weights over all given images. O(features).
std::vector<Bag> bags(const std::vector<std::vector<std::size_t>>& words, std::size_t vocabulary);

/// Similarity 1 - |a - b|_1 / 2, in 0..1 (Galvez-Lopez and Tardos 2012, eq. 2). O(|a| + |b|).
double similarity(const Bag& a, const Bag& b);

}  // namespace loopbench::rgbd

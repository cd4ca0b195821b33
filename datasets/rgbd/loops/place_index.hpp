/// Bag-of-words vectors of images and their similarity.
#pragma once

#include <utility>
#include <vector>

#include "datasets/rgbd/loops/vocabulary.hpp"

namespace loopbench::rgbd {

/// Weighted words of one image, sorted by word, weights sum to 1.
using Bag = std::vector<std::pair<std::size_t, double>>;

/// Computes bag-of-words vectors with tf-idf weights over all given images. O(features).
std::vector<Bag> bags(const std::vector<std::vector<std::size_t>>& words, std::size_t vocabulary);

/// Similarity 1 - |a - b|_1 / 2, in 0..1 (Galvez-Lopez and Tardos 2012, eq. 2). O(|a| + |b|).
double similarity(const Bag& a, const Bag& b);

}  // namespace loopbench::rgbd

#include "datasets/rgbd/loops/retrieval.hpp"

#include <algorithm>

#include "datasets/rgbd/loops/place_index.hpp"
#include "datasets/rgbd/loops/vocabulary.hpp"

namespace loopbench::rgbd {
namespace {

constexpr std::size_t kSamePlace = 3;  // maximum distance of keyframes at the same place

/// Subsamples the descriptors of all keyframes evenly.
Features training_set(const std::vector<Keyframe>& keyframes, std::size_t max_count) {
  Features out;
  std::size_t all = 0;
  for (const Keyframe& keyframe : keyframes) all += keyframe.features.size();
  const std::size_t every = std::max<std::size_t>(1, all / max_count);
  std::size_t index = 0;
  for (const Keyframe& keyframe : keyframes) {
    const Features& f = keyframe.features;
    out.bytes = f.bytes;
    out.binary = f.binary;
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (index++ % every != 0) continue;
      out.points.push_back(f.points[i]);
      out.descriptors.insert(out.descriptors.end(), f.descriptor(i), f.descriptor(i) + f.bytes);
    }
  }
  return out;
}

std::vector<Bag> bags_of(const std::vector<Keyframe>& keyframes, const LoopOptions& o) {
  const Features training = training_set(keyframes, static_cast<std::size_t>(o.training));
  const Vocabulary vocabulary(training,
                              static_cast<std::size_t>(o.branches),
                              static_cast<std::size_t>(o.levels),
                              static_cast<std::uint64_t>(o.seed));
  std::vector<std::vector<std::size_t>> words(keyframes.size());
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const Features& f = keyframes[k].features;
    for (std::size_t i = 0; i < f.size(); ++i) words[k].push_back(vocabulary.word(f, i));
  }
  return bags(words, vocabulary.words());
}

bool same_place(const RetrievedKeyframe& a, const RetrievedKeyframe& b) {
  const auto [low, high] = std::minmax(a.keyframe, b.keyframe);
  return high - low <= kSamePlace;
}

/// Whether the previous `consistency` keyframes retrieved this candidate or a neighbour of it.
bool consistent(const RetrievedKeyframe& candidate,
                const std::vector<std::vector<RetrievedKeyframe>>& found,
                std::size_t query,
                std::size_t consistency) {
  if (query < consistency) return false;
  for (std::size_t back = 1; back <= consistency; ++back) {
    const std::vector<RetrievedKeyframe>& earlier = found[query - back];
    if (std::ranges::none_of(
            earlier, [&](const RetrievedKeyframe& a) { return same_place(a, candidate); })) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::vector<RetrievedKeyframe>> retrieve(const std::vector<Keyframe>& keyframes,
                                                     const LoopOptions& o) {
  std::vector<std::vector<RetrievedKeyframe>> found(keyframes.size());
  if (keyframes.size() < 3) return found;
  const std::vector<Bag> all = bags_of(keyframes, o);
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const double reference = similarity(all[k], all[k - 1]);
    if (!(reference > 0.0)) continue;
    for (std::size_t j = 0; j < k; ++j) {
      if (keyframes[k].stamp - keyframes[j].stamp < o.min_gap) break;
      const double share = similarity(all[k], all[j]) / reference;
      if (share >= o.similarity_min) found[k].push_back({j, share});
    }
    std::ranges::stable_sort(found[k], std::greater{}, &RetrievedKeyframe::similarity);
    // More candidates than are verified are kept for the consistency check of later keyframes.
    const auto keep = static_cast<std::size_t>(4 * o.candidates);
    if (found[k].size() > keep) found[k].resize(keep);
  }
  std::vector<std::vector<RetrievedKeyframe>> out(keyframes.size());
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    for (const RetrievedKeyframe& candidate : found[k]) {
      if (out[k].size() == static_cast<std::size_t>(o.candidates)) break;
      if (consistent(candidate, found, k, static_cast<std::size_t>(o.consistency))) {
        out[k].push_back(candidate);
      }
    }
  }
  return out;
}

}  // namespace loopbench::rgbd

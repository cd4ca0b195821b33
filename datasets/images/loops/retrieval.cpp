#include "datasets/images/loops/retrieval.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/images/loops/vocabulary.hpp"

namespace loopbench::rgbd {
namespace {

constexpr std::size_t kSamePlace = 3;  // maximum distance of keyframes at the same place

constexpr std::size_t kTraining = 20000;  // descriptors that train the vocabulary
constexpr std::size_t kBranches = 10;     // of the vocabulary tree
constexpr std::size_t kLevels = 4;        // of the vocabulary tree
constexpr std::uint64_t kVocabularySeed = 1;
constexpr double kMinSimilarity = 0.15;  // relative to that of consecutive keyframes
constexpr std::size_t kCandidates = 3;   // verified per keyframe
// More candidates than are verified are kept for the consistency check of the next keyframe.
constexpr std::size_t kRetrieved = 4 * kCandidates;

/// Subsamples the descriptors of all keyframes evenly.
Features training_set(const std::vector<Keyframe>& keyframes) {
  Features out;
  std::size_t all = 0;
  for (const Keyframe& keyframe : keyframes) all += keyframe.features.size();
  const std::size_t every = std::max<std::size_t>(1, all / kTraining);
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

std::vector<Bag> bags_of(const std::vector<Keyframe>& keyframes) {
  const Vocabulary vocabulary(training_set(keyframes), kBranches, kLevels, kVocabularySeed);
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

/// Whether the previous keyframe retrieved this candidate or a neighbour of it.
bool consistent(const RetrievedKeyframe& candidate,
                const std::vector<std::vector<RetrievedKeyframe>>& found,
                std::size_t query) {
  return query > 0 && std::ranges::any_of(found[query - 1], [&](const RetrievedKeyframe& earlier) {
           return same_place(earlier, candidate);
         });
}

}  // namespace

std::vector<std::vector<RetrievedKeyframe>> retrieve(const std::vector<Keyframe>& keyframes,
                                                     double min_gap) {
  std::vector<std::vector<RetrievedKeyframe>> found(keyframes.size());
  if (keyframes.size() < 3) return found;
  const std::vector<Bag> all = bags_of(keyframes);
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const double reference = similarity(all[k], all[k - 1]);
    if (!(reference > 0.0)) continue;
    for (std::size_t j = 0; j < k; ++j) {
      if (keyframes[k].stamp - keyframes[j].stamp < min_gap) break;
      const double share = similarity(all[k], all[j]) / reference;
      if (share >= kMinSimilarity) found[k].push_back({j, share});
    }
    std::ranges::stable_sort(found[k], std::greater{}, &RetrievedKeyframe::similarity);
    if (found[k].size() > kRetrieved) found[k].resize(kRetrieved);
  }
  std::vector<std::vector<RetrievedKeyframe>> out(keyframes.size());
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    for (const RetrievedKeyframe& candidate : found[k]) {
      if (out[k].size() == kCandidates) break;
      if (consistent(candidate, found, k)) out[k].push_back(candidate);
    }
  }
  return out;
}

std::vector<Bag> bags(const std::vector<std::vector<std::size_t>>& words, std::size_t vocabulary) {
  std::vector<std::map<std::size_t, double>> counts(words.size());
  std::vector<std::size_t> images(vocabulary, 0);
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (const std::size_t word : words[i]) counts[i][word] += 1.0;
    for (const auto& entry : counts[i]) ++images[entry.first];
  }
  std::vector<Bag> out(words.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    double sum = 0.0;
    for (const auto& [word, count] : counts[i]) {
      const double weight =
          count * std::log(static_cast<double>(words.size()) / static_cast<double>(images[word]));
      if (weight > 0.0) out[i].emplace_back(word, weight);
      sum += weight;
    }
    for (auto& entry : out[i]) entry.second /= sum;
  }
  return out;
}

double similarity(const Bag& a, const Bag& b) {
  double out = 0.0;
  auto p = a.begin();
  auto q = b.begin();
  while (p != a.end() && q != b.end()) {
    if (p->first < q->first) {
      ++p;
    } else if (q->first < p->first) {
      ++q;
    } else {
      out += std::min(p->second, q->second);  // both sum to 1: half the L1 distance is 1 - this
      ++p, ++q;
    }
  }
  return out;
}

}  // namespace loopbench::rgbd

#include "datasets/rgbd/loops/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace loopbench::rgbd {

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

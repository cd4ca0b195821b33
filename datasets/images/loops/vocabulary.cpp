#include "datasets/images/loops/vocabulary.hpp"

#include <algorithm>

#include "datasets/core/hash.hpp"

namespace loopbench::rgbd {
namespace {

constexpr int kKMeansRounds = 6;

Features empty_like(const Features& features) {
  Features out;
  out.bytes = features.bytes;
  out.binary = features.binary;
  return out;
}

void append(Features& out, const std::uint8_t* row) {
  out.points.emplace_back();
  out.descriptors.insert(out.descriptors.end(), row, row + out.bytes);
}

std::size_t nearest(const Features& centres,
                    std::size_t first,
                    std::size_t count,
                    const Features& all,
                    std::size_t i) {
  std::size_t best = first;
  float best_distance = 2.0f;
  for (std::size_t k = first; k < first + count; ++k) {
    const float distance = descriptor_distance(centres, k, all, i);
    if (distance < best_distance) best_distance = distance, best = k;
  }
  return best - first;
}

/// Updates a centre to the majority of bits or the mean of bytes; unchanged without members.
void recentre(Features& centres,
              std::size_t k,
              const Features& all,
              const std::vector<std::size_t>& members) {
  if (members.empty()) return;
  const auto bytes = static_cast<std::size_t>(all.bytes);
  const std::size_t bits = all.binary ? 8 : 1;
  std::vector<std::size_t> sums(bytes * bits, 0);
  for (const std::size_t i : members) {
    const std::uint8_t* row = all.descriptor(i);
    for (std::size_t at = 0; at < sums.size(); ++at) {
      sums[at] += all.binary ? (row[at / 8] >> (at % 8)) & 1u : row[at];
    }
  }
  std::uint8_t* centre = centres.descriptors.data() + k * bytes;
  std::fill_n(centre, bytes, std::uint8_t{0});
  for (std::size_t at = 0; at < sums.size(); ++at) {
    if (!all.binary) centre[at] = static_cast<std::uint8_t>(sums[at] / members.size());
    if (all.binary && 2 * sums[at] > members.size()) {
      centre[at / 8] = static_cast<std::uint8_t>(centre[at / 8] | (1u << (at % 8)));
    }
  }
}

/// Initial centres by k-means++ (Arthur and Vassilvitskii 2007): each is drawn with a probability
/// proportional to its squared distance to the previous ones.
Features initial_centres(const Features& all,
                         const std::vector<std::size_t>& members,
                         std::size_t count,
                         std::uint64_t seed) {
  Features out = empty_like(all);
  append(out, all.descriptor(members[hash_combine(seed) % members.size()]));
  std::vector<double> squares(members.size(), 4.0);
  while (out.size() < count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const auto distance =
          static_cast<double>(descriptor_distance(out, out.size() - 1, all, members[i]));
      squares[i] = std::min(squares[i], distance * distance);
      sum += squares[i];
    }
    double remaining =
        static_cast<double>(uniform(hash_combine(seed, std::uint64_t{out.size()}))) * sum;
    std::size_t pick = 0;
    while (pick + 1 < members.size() && remaining >= squares[pick]) remaining -= squares[pick++];
    append(out, all.descriptor(members[pick]));
  }
  return out;
}

}  // namespace

Vocabulary::Vocabulary(const Features& descriptors,
                       std::size_t branches,
                       std::size_t levels,
                       std::uint64_t seed)
    : branches_(branches), seed_(seed), nodes_(1), centres_(empty_like(descriptors)) {
  const std::vector<std::uint8_t> unused(static_cast<std::size_t>(descriptors.bytes), 0);
  append(centres_, unused.data());  // placeholder for the root, which has no centre
  std::vector<std::size_t> members(descriptors.size());
  for (std::size_t i = 0; i < members.size(); ++i) members[i] = i;
  grow(0, descriptors, members, levels);
}

void Vocabulary::grow(std::size_t node,
                      const Features& all,
                      const std::vector<std::size_t>& members,
                      std::size_t levels) {
  if (levels == 0 || members.size() <= branches_) {
    nodes_[node].word = words_++;
    return;
  }
  Features centres =
      initial_centres(all, members, branches_, hash_combine(seed_, std::uint64_t{node}));
  std::vector<std::vector<std::size_t>> groups;
  for (int round = 0; round < kKMeansRounds; ++round) {
    groups.assign(branches_, {});
    for (const std::size_t i : members) groups[nearest(centres, 0, branches_, all, i)].push_back(i);
    for (std::size_t k = 0; k < branches_; ++k) recentre(centres, k, all, groups[k]);
  }
  const std::size_t first = nodes_.size();
  std::vector<std::vector<std::size_t>> kept;
  for (std::size_t k = 0; k < branches_; ++k) {
    if (groups[k].empty() || groups[k].size() == members.size()) continue;
    nodes_.emplace_back();
    append(centres_, centres.descriptor(k));
    kept.push_back(std::move(groups[k]));
  }
  if (kept.empty()) {  // all descriptors are equal
    nodes_[node].word = words_++;
    return;
  }
  nodes_[node].first_child = first;
  nodes_[node].children = kept.size();
  for (std::size_t k = 0; k < kept.size(); ++k) grow(first + k, all, kept[k], levels - 1);
}

std::size_t Vocabulary::word(const Features& features, std::size_t i) const {
  std::size_t node = 0;
  while (nodes_[node].children > 0) {
    const Node& parent = nodes_[node];
    node = parent.first_child + nearest(centres_, parent.first_child, parent.children, features, i);
  }
  return nodes_[node].word;
}

}  // namespace loopbench::rgbd

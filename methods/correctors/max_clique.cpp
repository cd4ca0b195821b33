#include "methods/correctors/max_clique.hpp"

#include <algorithm>
#include <bit>

namespace loopbench::methods {
namespace {

using Bits = std::vector<std::uint64_t>;

bool is_empty(const Bits& bits) {
  return std::ranges::all_of(bits, [](std::uint64_t word) { return word == 0; });
}

std::size_t first_of(const Bits& bits) {
  std::size_t word = 0;
  while (bits[word] == 0) ++word;
  return 64 * word + static_cast<std::size_t>(std::countr_zero(bits[word]));
}

void clear_bit(Bits& bits, std::size_t at) { bits[at / 64] &= ~(std::uint64_t{1} << (at % 64)); }

Bits common(const Bits& bits, const std::uint64_t* row) {
  Bits out(bits.size());
  for (std::size_t w = 0; w < bits.size(); ++w) out[w] = bits[w] & row[w];
  return out;
}

std::size_t count(const Bits& bits) {
  std::size_t out = 0;
  for (const std::uint64_t word : bits) out += static_cast<std::size_t>(std::popcount(word));
  return out;
}

Bits all_of(std::size_t size, std::size_t words) {
  Bits out(words, 0);
  for (std::size_t i = 0; i < size; ++i) out[i / 64] |= std::uint64_t{1} << (i % 64);
  return out;
}

class Search {
 public:
  Search(const BitGraph& graph, std::size_t max_steps) : graph_(graph), steps_left_(max_steps) {}

  Clique run() {
    for (std::size_t seed = 0; seed < graph_.size(); ++seed) grow(seed);
    expand(all_of(graph_.size(), graph_.words()));
    std::ranges::sort(best_);
    return {std::move(best_), steps_left_ > 0};
  }

 private:
  /// Grows a clique by the candidate with the most common neighbours; ties go to the lowest index.
  void grow(std::size_t seed) {
    std::vector<std::size_t> members{seed};
    Bits left(graph_.row(seed), graph_.row(seed) + graph_.words());
    while (!is_empty(left)) {
      std::size_t next = 0;
      std::size_t most = 0;
      for (Bits rest = left; !is_empty(rest);) {
        const std::size_t v = first_of(rest);
        clear_bit(rest, v);
        const std::size_t degree = 1 + count(common(left, graph_.row(v)));
        if (degree > most) most = degree, next = v;
      }
      members.push_back(next);
      left = common(left, graph_.row(next));
      if (members.size() + count(left) <= best_.size()) return;
    }
    if (members.size() > best_.size()) best_ = std::move(members);
  }

  void expand(Bits left) {
    // Vertices of one colour are not adjacent, so a clique has at most one vertex per colour.
    std::vector<std::size_t> order;
    std::vector<std::size_t> colour;
    std::size_t colours = 0;
    for (Bits uncoloured = left; !is_empty(uncoloured);) {
      ++colours;
      for (Bits independent = uncoloured; !is_empty(independent);) {
        const std::size_t v = first_of(independent);
        clear_bit(independent, v);
        clear_bit(uncoloured, v);
        for (std::size_t w = 0; w < independent.size(); ++w) independent[w] &= ~graph_.row(v)[w];
        order.push_back(v);
        colour.push_back(colours);
      }
    }
    for (std::size_t k = order.size(); k-- > 0;) {
      if (steps_left_ == 0 || current_.size() + colour[k] <= best_.size()) return;
      --steps_left_;
      current_.push_back(order[k]);
      Bits next = common(left, graph_.row(order[k]));
      if (!is_empty(next)) {
        expand(std::move(next));
      } else if (current_.size() > best_.size()) {
        best_ = current_;
      }
      current_.pop_back();
      clear_bit(left, order[k]);
    }
  }

  const BitGraph& graph_;
  std::size_t steps_left_;
  std::vector<std::size_t> current_;
  std::vector<std::size_t> best_;
};

}  // namespace

Clique max_clique(const BitGraph& graph, std::size_t max_steps) {
  return Search(graph, max_steps).run();
}

}  // namespace loopbench::methods

#include "methods/correctors/consistency.hpp"

#include <algorithm>
#include <bit>

#include "datasets/core/factorisations.hpp"
#include "methods/correctors/chi_squared.hpp"

namespace loopbench::methods {
namespace {

/// The chain integrated from odometry alone, starting at the identity, with prefix sums of its
/// covariance.
class CheckedChain {
 public:
  explicit CheckedChain(const Problem& problem) {
    poses_.emplace_back();
    noise_.emplace_back(Matrix6::Zero());
    for (const Edge& edge : problem.odometry) {
      poses_.push_back(normalized(poses_.back() * edge.from_from_to));
      const Matrix6 B = adjoint(poses_.back());
      const Matrix6 S = inverse_of(edge.information);
      noise_.push_back(noise_.back() + B * S * B.transpose());
    }
  }

  PairError loop(const Edge& k, const Edge& l) const {
    const Pose d_from_b = poses_[l.to].inverse() * poses_[k.to];
    const Pose c_from_b = l.from_from_to * d_from_b;
    const Pose a_from_c = poses_[k.from].inverse() * poses_[l.from];
    const Pose b_from_b = normalized(k.from_from_to.inverse() * (a_from_c * c_from_b));
    PairError out;
    out.error = log_se3(b_from_b);

    // Transforms noise from the chain's first frame to frame b, along either part of the odometry.
    const Matrix6 G = adjoint(c_from_b.inverse() * poses_[l.from].inverse());
    const Matrix6 H = adjoint(poses_[k.to].inverse());
    const double forward_ac = k.from <= l.from ? 1.0 : -1.0;
    const double forward_db = l.to <= k.to ? 1.0 : -1.0;
    const auto [ac_begin, ac_end] = std::minmax(k.from, l.from);
    const auto [db_begin, db_end] = std::minmax(l.to, k.to);
    const std::size_t begin = std::max(ac_begin, db_begin);
    const std::size_t end = std::max(begin, std::min(ac_end, db_end));
    const Matrix6 shared = noise_[end] - noise_[begin];
    const Matrix6 M = forward_ac * G + forward_db * H;
    const Matrix6 only_ac = noise_[ac_end] - noise_[ac_begin] - shared;
    const Matrix6 only_db = noise_[db_end] - noise_[db_begin] - shared;
    const Matrix6 D = adjoint(d_from_b.inverse());
    out.covariance = inverse_of(k.information) + D * inverse_of(l.information) * D.transpose() +
                     G * only_ac * G.transpose() + H * only_db * H.transpose() +
                     M * shared * M.transpose();
    return out;
  }

 private:
  std::vector<Pose> poses_;
  std::vector<Matrix6> noise_;
};

double squared(const PairError& pair) {
  return pair.error.dot(pair.covariance.ldlt().solve(pair.error));
}

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

PairError pair_error(const Problem& problem, const Edge& first, const Edge& second) {
  return CheckedChain(problem).loop(first, second);
}

ConsistentClosures consistent_closures(const Problem& problem) {
  constexpr std::size_t kMaxSteps = 100000;  // of the exact clique search
  const std::vector<Edge>& closures = problem.closures;
  if (closures.size() < 2) return {std::vector<std::size_t>(closures.size(), 0), true};
  const CheckedChain chain(problem);
  const double threshold = inlier_chi2(problem.planar ? 3 : 6);
  BitGraph agree(closures.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      if (squared(chain.loop(closures[k], closures[l])) < threshold) agree.join(k, l);
    }
  }
  Clique clique = max_clique(agree, kMaxSteps);
  if (clique.members.size() < 2) clique.members.clear();
  return {std::move(clique.members), clique.is_largest};
}

Clique max_clique(const BitGraph& graph, std::size_t max_steps) {
  return Search(graph, max_steps).run();
}

}  // namespace loopbench::methods

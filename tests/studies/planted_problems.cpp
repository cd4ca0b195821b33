#include "tests/studies/planted_problems.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "datasets/derive/odometry.hpp"
#include "datasets/noise/random.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kTrue = 16;  // closures of problems with many

class Planter {
 public:
  Planter(const TrueChain& chain, std::int64_t seed)
      : chain_(chain),
        random_({seed, noise_identity(chain.name, chain.problem.keyframes)}, Purpose::closures),
        information_(
            isotropic_information(chain.sigma_t * chain.sigma_t, chain.sigma_r * chain.sigma_r)) {}

  /// `factor` on the deviations of the translation.
  Twist noise(double factor = 1.0) {
    Twist out = random_.normal_twist(factor * chain_.sigma_t, chain_.sigma_r);
    if (chain_.problem.planar) out.segment<3>(2).setZero();
    return out;
  }

  void add(Edge edge, const Twist& error, bool is_false) {
    edge.from_from_to = normalized(edge.from_from_to * exp_se3(error));
    edge.information = information_;
    out_.push_back({edge, is_false});
  }

  std::vector<Edge> chosen(std::size_t count) {
    std::vector<std::size_t> order(chain_.revisits.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_.index(i)]);
    order.resize(std::min(count, order.size()));
    std::vector<Edge> out;
    for (const std::size_t k : order) out.push_back(chain_.revisits[k]);
    return out;
  }

  void add_true(std::size_t count) {
    for (const Edge& edge : chosen(count)) add(edge, noise(), false);
  }

  void add_slipped(std::size_t count) {
    for (const Edge& edge : chosen(count)) {
      const bool is_slipped = out_.size() % 5 == 0;
      add(edge, noise(is_slipped ? 10.0 : 1.0), is_slipped);
    }
  }

  void add_heavy(std::size_t count) {
    for (const Edge& edge : chosen(count)) {
      const double chi2 = -2.0 * std::log(1.0 - random_.uniform());  // 2 degrees of freedom
      add(edge, noise() / std::sqrt(std::max(1e-3, chi2 / 2.0)), false);
    }
  }

  void add_correlated(std::size_t count) {
    Twist shared = Twist::Zero();
    for (const Edge& edge : chosen(count)) {
      if (out_.size() % 4 == 0) shared = noise();
      add(edge, std::sqrt(0.5) * (noise() + shared), false);
    }
  }

  /// Two keyframes at least a twentieth of the chain apart.
  std::pair<std::size_t, std::size_t> any_pair(std::size_t margin) {
    const std::size_t n = chain_.problem.keyframes.size();
    for (;;) {
      const auto [from, to] = std::minmax({random_.index(n - margin), random_.index(n - margin)});
      if (to - from >= std::max(margin + 1, n / 20)) return {from, to};
    }
  }

  void add_false(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      Edge edge = chain_.revisits[random_.index(chain_.revisits.size())];
      std::tie(edge.from, edge.to) = any_pair(0);
      add(edge, noise(), true);
    }
  }

  /// The wrong place, entered four times.
  void add_family() {
    constexpr std::size_t kMembers = 4, kEvery = 2;
    const Pose measured = chain_.revisits[random_.index(chain_.revisits.size())].from_from_to;
    const auto [from, to] = any_pair(kMembers * kEvery);
    const auto truth = [&](std::size_t k) { return chain_.truth[k].world_from_body; };
    const Pose from_other = truth(from) * measured * truth(to).inverse();
    for (std::size_t i = 0; i < kMembers; ++i) {
      const std::size_t a = from + i * kEvery, b = to + i * kEvery;
      add({a, b, truth(a).inverse() * from_other * truth(b)}, noise(), true);
    }
  }

  /// A step that at least three true closures span.
  std::size_t spanned_step() {
    constexpr int kLeast = 3;
    std::vector<std::size_t> steps;
    for (std::size_t k = 0; k + 1 < chain_.truth.size(); ++k) {
      const auto spanning = std::ranges::count_if(out_, [k](const auto& each) {
        return !each.second && each.first.from <= k && each.first.to > k;
      });
      if (spanning >= kLeast) steps.push_back(k);
    }
    return steps.empty() ? 0 : steps[random_.index(steps.size())];
  }

  /// A wrong motion of one step, with `factor` times its deviations; 0: a new start.
  void add_wrong_step(double factor) {
    wrong_step_ = spanned_step();
    const Edge& edge = chain_.problem.odometry[*wrong_step_];
    const Trajectory& keyframes = chain_.problem.keyframes;
    if (factor == 0.0) {
      wrong_motion_ =
          keyframes[edge.from].world_from_body.inverse() * keyframes.front().world_from_body;
      return;
    }
    const Matrix6 covariance = edge.information.inverse();
    Twist error = random_.normal_twist(factor * std::sqrt(covariance(0, 0)),
                                       factor * std::sqrt(covariance(5, 5)));
    if (chain_.problem.planar) error.segment<3>(2).setZero();
    wrong_motion_ = edge.from_from_to * exp_se3(error);
  }

  PlantedProblem problem(double odometry) {
    std::ranges::stable_sort(out_, [](const auto& a, const auto& b) {
      return std::tie(a.first.to, a.first.from) < std::tie(b.first.to, b.first.from);
    });
    PlantedProblem out{chain_.problem, {}};
    for (Edge& edge : out.problem.odometry) edge.information /= odometry * odometry;
    if (wrong_step_) move_end(out);
    for (const auto& [edge, is_false] : out_) {
      out.problem.closures.push_back(edge);
      out.is_false.push_back(is_false);
    }
    return out;
  }

 private:
  void move_end(PlantedProblem& out) {
    out.wrong_step = wrong_step_;
    Edge& edge = out.problem.odometry[*wrong_step_];
    Trajectory& keyframes = out.problem.keyframes;
    edge.from_from_to = normalized(wrong_motion_);
    const Pose moved = keyframes[edge.from].world_from_body * wrong_motion_ *
                       keyframes[edge.to].world_from_body.inverse();
    for (std::size_t k = edge.to; k < keyframes.size(); ++k) {
      keyframes[k].world_from_body = normalized(moved * keyframes[k].world_from_body);
    }
  }

  const TrueChain& chain_;
  Random random_;
  Matrix6 information_;
  std::vector<std::pair<Edge, bool>> out_;
  std::optional<std::size_t> wrong_step_;
  Pose wrong_motion_;
};

}  // namespace

std::string name_of(Plant plant) {
  switch (plant) {
    case Plant::none:
      return "none false";
    case Plant::false_20:
      return "20 % false";
    case Plant::false_40:
      return "40 % false";
    case Plant::family:
      return "family of four";
    case Plant::slipped:
      return "20 % slipped";
    case Plant::heavy:
      return "heavy tails";
    case Plant::correlated:
      return "correlated";
    case Plant::one:
      return "one true";
    case Plant::two:
      return "two true";
    case Plant::three:
      return "three true";
    case Plant::one_of_one_false:
      return "one of one false";
    case Plant::one_of_two_false:
      return "one of two false";
    case Plant::one_of_three_false:
      return "one of three false";
    case Plant::wrong_step:
      return "wrong step";
    case Plant::wrong_step_30:
      return "wrong step 30 times";
    case Plant::wrong_step_false:
      return "wrong step 20 % false";
    case Plant::restart:
      return "new start";
    case Plant::bias:
      return "constant bias";
    case Plant::bias_false:
      break;
  }
  return "constant bias 20 % false";
}

bool is_gaussian(Plant plant) {
  return plant == Plant::none || plant == Plant::false_20 || plant == Plant::false_40 ||
         plant == Plant::family;
}

bool is_biased(Plant plant) { return plant == Plant::bias || plant == Plant::bias_false; }

PlantedProblem planted(const TrueChain& chain, Plant plant, double odometry, std::int64_t seed) {
  Planter to(chain, 100 * seed + static_cast<std::int64_t>(plant));
  switch (plant) {
    case Plant::none:
    case Plant::bias:
      to.add_true(kTrue);
      break;
    case Plant::false_20:
    case Plant::bias_false:
      to.add_true(kTrue), to.add_false(kTrue / 4);
      break;
    case Plant::false_40:
      to.add_true(kTrue), to.add_false(kTrue * 2 / 3);
      break;
    case Plant::family:
      to.add_true(kTrue), to.add_family();
      break;
    case Plant::slipped:
      to.add_slipped(kTrue);
      break;
    case Plant::heavy:
      to.add_heavy(kTrue);
      break;
    case Plant::correlated:
      to.add_correlated(kTrue);
      break;
    case Plant::one:
      to.add_true(1);
      break;
    case Plant::two:
      to.add_true(2);
      break;
    case Plant::three:
      to.add_true(3);
      break;
    case Plant::one_of_one_false:
      to.add_false(1);
      break;
    case Plant::one_of_two_false:
      to.add_true(1), to.add_false(1);
      break;
    case Plant::one_of_three_false:
      to.add_true(2), to.add_false(1);
      break;
    case Plant::wrong_step:
      to.add_true(kTrue), to.add_wrong_step(100.0);
      break;
    case Plant::wrong_step_30:
      to.add_true(kTrue), to.add_wrong_step(30.0);
      break;
    case Plant::wrong_step_false:
      to.add_true(kTrue), to.add_false(kTrue / 4), to.add_wrong_step(100.0);
      break;
    case Plant::restart:
      to.add_true(kTrue), to.add_wrong_step(0.0);
      break;
  }
  return to.problem(odometry);
}

}  // namespace loopbench

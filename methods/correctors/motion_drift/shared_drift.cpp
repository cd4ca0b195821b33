#include "methods/correctors/motion_drift/shared_drift.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/motion_drift/chain_gaps.hpp"
#include "methods/correctors/scale_drift.hpp"

namespace loopbench::methods {
namespace {

using Square4 = Eigen::Matrix4d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double log_diagonal(const Eigen::LLT<Square4>& factor) {
  return factor.matrixLLT().diagonal().array().log().sum();
}

/// I + diag(s) X diag(s).
Eigen::LLT<Square4> factor_of(const DriftRates& s, const Square4& X) {
  return Eigen::LLT<Square4>(Square4::Identity() + Square4(s.asDiagonal() * X * s.asDiagonal()));
}

struct PooledRates {
  double misfit = 0.0;  ///< -log likelihood
  DriftRates mean;
  DriftRates variance;
};

/// Integrates over the rates of each chain, then over their mean. Deviations may be 0.
PooledRates pooled(const std::vector<MeasuredRates>& chains,
                   const DriftRates& deviation_of_mean,
                   const DriftRates& deviation) {
  PooledRates out;
  Square4 information = Square4::Zero();
  DriftRates vector = DriftRates::Zero();
  for (const MeasuredRates& chain : chains) {
    const Eigen::LLT<Square4> factor = factor_of(deviation, chain.information);
    const Square4 scaled = chain.information * deviation.asDiagonal();
    const DriftRates own = deviation.cwiseProduct(chain.vector);
    out.misfit += chain.misfit + log_diagonal(factor) - 0.5 * own.dot(factor.solve(own));
    information += chain.information - scaled * factor.solve(Square4(scaled.transpose()));
    vector += chain.vector - scaled * factor.solve(own);
  }
  const Eigen::LLT<Square4> factor = factor_of(deviation_of_mean, information);
  const DriftRates own = deviation_of_mean.cwiseProduct(vector);
  out.misfit += log_diagonal(factor) - 0.5 * own.dot(factor.solve(own));
  out.mean = deviation_of_mean.cwiseProduct(factor.solve(own));
  const Square4 covariance =
      deviation_of_mean.asDiagonal() * factor.solve(Square4(deviation_of_mean.asDiagonal()));
  out.variance = covariance.diagonal();
  return out;
}

/// Half octaves: of the variance factors, of the deviations of the mean and of those between
/// chains. A rate without entry has no deviations.
struct Lattice {
  std::array<int, 2> factors{0, 0};
  std::array<std::optional<std::array<int, 2>>, 4> rates;
};

/// Maximum likelihood on a lattice, by coordinate descent.
class RateSearch {
 public:
  /// `unit` [1/m] is the largest deviation of rates per metre.
  RateSearch(const std::vector<ChainGaps>& gaps, double unit) : gaps_(gaps), unit_(unit) {}

  SharedDrift run() {
    constexpr double kGain = 4.0;
    double least = descend(best_);
    for (bool added = true; added;) {
      added = false;
      const Lattice start = best_;
      least -= kGain;
      for (std::size_t k = 0; k < 4; ++k) {
        if (start.rates[k]) continue;
        Lattice trial = start;
        trial.rates[k] = {kStart, kStart};
        if (const double value = descend(trial); value < least) {
          least = value;
          best_ = trial;
          added = true;
        }
      }
    }
    misfit(best_);  // measures under its factors
    const auto [mean, between] = deviations(best_);
    const PooledRates rates = pooled(measured_, mean, between);
    return {rates.mean, between.cwiseAbs2() + rates.variance, rates.variance, factors_of(best_)};
  }

 private:
  static constexpr int kStart = -16, kLeast = -40;
  static constexpr int kMostFactor = 26;  // half octaves of variance: 10^4

  static VarianceFactors factors_of(const Lattice& at) {
    return {std::exp2(0.5 * at.factors[0]), std::exp2(0.5 * at.factors[1])};
  }

  std::array<DriftRates, 2> deviations(const Lattice& at) const {
    std::array<DriftRates, 2> out{DriftRates::Zero(), DriftRates::Zero()};
    for (std::size_t k = 0; k < 4; ++k) {
      if (!at.rates[k]) continue;
      for (const std::size_t of : {0u, 1u}) {
        out[of][static_cast<Eigen::Index>(k)] =
            (k < 3 ? unit_ : 1.0) * std::exp2(0.5 * (*at.rates[k])[of]);
      }
    }
    return out;
  }

  bool is_inside(const Lattice& at) const {
    for (const int factor : at.factors) {
      if (std::abs(factor) > kMostFactor) return false;
    }
    for (const auto& rate : at.rates) {
      if (!rate) continue;
      for (const int each : *rate) {
        if (each < kLeast || each > 0) return false;
      }
    }
    return true;
  }

  double misfit(const Lattice& at) {
    if (!is_inside(at)) return kInfinity;
    if (measured_.empty() || at.factors != measured_at_) {
      measured_.clear();
      measured_at_ = at.factors;
      for (const ChainGaps& gaps : gaps_) {
        const auto chain = gaps.measured(factors_of(at));
        if (!chain) {
          measured_.clear();
          return kInfinity;
        }
        measured_.push_back(*chain);
      }
    }
    double prior = 0.0;
    for (const int factor : at.factors) prior += std::pow(0.5 * factor / kFactorOctaves, 2);
    for (const auto& rate : at.rates) {
      if (rate) prior += std::pow(((*rate)[1] - (*rate)[0]) / kRatioOctaves, 2);
    }
    const auto [mean, between] = deviations(at);
    return pooled(measured_, mean, between).misfit + 0.5 * prior;
  }

  /// Moves to the minimum with steps of 4 octaves and then halved steps; returns it.
  double descend(Lattice& at) {
    double least = misfit(at);
    for (int step = 8; step >= 1; step /= 2) {
      for (bool improved = true; improved;) {
        improved = false;
        const auto attempt = [&](const Lattice& trial) {
          const double value = misfit(trial);
          if (!(value < least - 1e-9)) return;
          least = value;
          at = trial;
          improved = true;
        };
        for (const int by : {step, -step}) {
          for (std::size_t k = 0; k < 4; ++k) {
            if (!at.rates[k]) continue;
            for (const std::array<int, 2> move : {std::array{by, 0}, {0, by}, {by, by}}) {
              Lattice trial = at;
              (*trial.rates[k])[0] += move[0];
              (*trial.rates[k])[1] += move[1];
              attempt(trial);
            }
          }
          for (const std::size_t k : {0u, 1u}) {
            Lattice trial = at;
            trial.factors[k] += by;
            attempt(trial);
          }
        }
      }
    }
    return misfit(at);  // and what is measured under its factors
  }

  static constexpr double kFactorOctaves = 6.64385619;  // prior of factors: 10 in deviation
  static constexpr double kRatioOctaves = 3.3;          // prior of T / M: a factor of 10

  const std::vector<ChainGaps>& gaps_;
  double unit_;
  Lattice best_;
  std::array<int, 2> measured_at_{};
  std::vector<MeasuredRates> measured_;
};

/// One over the mean length of the loops: a drift of one radian in a loop [1/m].
double unit_of(const std::vector<Problem>& chains) {
  double length = 0.0;
  double loops = 0.0;
  for (const Problem& chain : chains) {
    std::vector<double> along{0.0};
    for (const Edge& edge : chain.odometry) {
      along.push_back(along.back() + edge.from_from_to.translation.norm());
    }
    for (const Edge& loop : chain.closures) {
      length += along[loop.to] - along[loop.from];
      loops += 1.0;
    }
  }
  return loops / length;
}

/// At most 30 closures, evenly spaced: the time of an iteration grows with their cube.
Problem with_few_closures(Problem chain) {
  constexpr std::size_t kMost = 30;
  const std::size_t count = std::min(chain.closures.size(), kMost);
  std::vector<Edge> kept;
  for (std::size_t i = 0; i < count; ++i) {
    kept.push_back(chain.closures[i * chain.closures.size() / count]);
  }
  chain.closures = std::move(kept);
  return chain;
}

}  // namespace

SharedDrift shared_drift(const std::vector<Problem>& chains) {
  SharedDrift out;
  for (int round = 0; round < 2; ++round) {
    std::vector<ChainGaps> gaps;
    for (const Problem& chain : chains) gaps.emplace_back(chain, out.mean);
    out = RateSearch(gaps, unit_of(chains)).run();
  }
  return out;
}

DriftRates repeated_drift(const Problem& problem, Report& report) {
  constexpr std::size_t kChains = 3, kClosures = 16;
  constexpr double kErrors = 3.0;
  std::vector<Problem> chains;
  std::size_t closures = 0;
  if (problem.related && !has_scale_drift(problem)) {
    for (const Problem& chain : *problem.related) {
      if (chain.closures.empty() || !why_no_chain(chain).empty() || has_scale_drift(chain))
        continue;
      chains.push_back(with_few_closures(chain));
      closures += chains.back().closures.size();
    }
  }
  DriftRates out = DriftRates::Zero();
  if (chains.size() < kChains || closures < kClosures) {
    report.notes.push_back("nothing is learnt from " + std::to_string(chains.size()) +
                           " related chains with " + std::to_string(closures) +
                           " closures: 3 chains with 16 closures are needed");
    return out;
  }
  const SharedDrift shared = shared_drift(chains);
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double square = shared.mean[k] * shared.mean[k];
    const bool repeats =
        square > shared.variance[k] && square > kErrors * kErrors * shared.variance_of_mean[k];
    if (repeats) out[k] = shared.mean[k];
  }
  if (out.isZero(0.0) || problem.closures.empty()) return out;
  const ChainGaps own(problem, DriftRates::Zero());
  const auto misfit = [&](const DriftRates& mean) {
    return own.misfit(shared.factors, mean, shared.variance);
  };
  return misfit(out) <= misfit(DriftRates::Zero()) ? out : DriftRates::Zero().eval();
}

}  // namespace loopbench::methods

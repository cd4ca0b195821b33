#include "harness/gate/sign_flips.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostExact = 14;  // runs; 16384 sign flips

/// Signed ranks of one comparison. Midranks are multiples of 0.5, so their sums are exact.
struct SignedRanks {
  std::vector<std::pair<std::size_t, double>> by_run;  // without zeros
  double deviation = 0.0;                              // std of their sum under random signs
};

SignedRanks signed_ranks(const RunDifferences& differences) {
  std::vector<double> magnitudes;
  for (const auto& [run, difference] : differences) magnitudes.push_back(std::abs(difference));
  const std::vector<double> ranks = midranks(magnitudes);
  SignedRanks out;
  double variance = 0.0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const auto& [run, difference] = differences[i];
    if (difference == 0.0) continue;
    out.by_run.emplace_back(run, difference > 0.0 ? ranks[i] : -ranks[i]);
    variance += ranks[i] * ranks[i];
  }
  out.deviation = std::sqrt(variance);
  return out;
}

/// `flipped[run]`: whether the differences of the run change sign.
double standardised(const SignedRanks& ranks, const std::vector<bool>& flipped) {
  double sum = 0.0;
  for (const auto& [run, rank] : ranks.by_run) sum += flipped[run] ? -rank : rank;
  return sum / ranks.deviation;
}

/// The largest standardised sum of every flip; the first flip is the identity.
std::vector<double> largest_of_flips(const std::vector<SignedRanks>& tested,
                                     std::size_t runs,
                                     double level) {
  const bool exact = runs <= kMostExact;
  const std::size_t draws = static_cast<std::size_t>(std::min(1e6, std::max(1e4, 100.0 / level)));
  const std::size_t flips = exact ? std::size_t{1} << runs : draws;
  std::mt19937_64 random(1);
  std::vector<bool> flipped(runs, false);
  std::vector<double> out;
  out.reserve(flips);
  for (std::size_t flip = 0; flip < flips; ++flip) {
    std::uint64_t bits = flip;
    for (std::size_t run = 0; run < runs && flip > 0; ++run) {
      if (!exact && run % 64 == 0) bits = random();
      flipped[run] = (bits >> (run % 64) & 1U) != 0;
    }
    double largest = 0.0;
    for (const SignedRanks& ranks : tested)
      largest = std::max(largest, standardised(ranks, flipped));
    out.push_back(largest);
  }
  return out;
}

}  // namespace

std::vector<double> sign_flip_test(const std::vector<RunDifferences>& comparisons,
                                   std::size_t runs,
                                   double level) {
  std::vector<double> p(comparisons.size(), 1.0);
  std::vector<SignedRanks> tested;
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    SignedRanks ranks = signed_ranks(comparisons[i]);
    if (ranks.by_run.empty()) continue;
    tested.push_back(std::move(ranks));
    positions.push_back(i);
  }
  if (tested.empty()) return p;
  std::vector<double> largest = largest_of_flips(tested, runs, level);
  std::ranges::sort(largest);
  const std::vector<bool> unflipped(runs, false);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    const double own = standardised(tested[i], unflipped);
    const auto at_least = largest.end() - std::ranges::lower_bound(largest, own);
    p[positions[i]] = static_cast<double>(at_least) / static_cast<double>(largest.size());
  }
  return p;
}

double least_sign_flip_p(std::size_t runs) { return std::pow(0.5, static_cast<double>(runs)); }

}  // namespace loopbench::harness

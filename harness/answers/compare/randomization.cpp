#include "harness/answers/compare/randomization.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/answers/compare/exchanges.hpp"
#include "metrics/numerics/average.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// Differences are clipped at so many times their typical size: 1.35 standard deviations of a
/// normal distribution. Values of samples, of which a small one can be far from the median of all,
/// at twice as much.
constexpr double kClip = 2.0;
constexpr double kClipOfSamples = 4.0;

/// So many values of its typical size are those of all strata.
constexpr double kShrunk = 3.0;

/// A stratum of so many values whose typical value differs by so many standard errors from the
/// mean over the strata is moved towards it: its difference is no scatter.
constexpr std::size_t kFewestMoved = 5;
constexpr double kMovedErrors = 4.0;

/// The distribution of more signs is approximated.
constexpr std::size_t kMostSigns = 16;

/// Appends the sizes that are not zero.
void add_sizes(const std::vector<double>& values, std::vector<double>& out) {
  for (const double value : values) {
    if (value != 0.0) out.push_back(std::abs(value));
  }
}

double median_size(const std::vector<double>& sizes) {
  return sizes.empty() ? 0.0 : metrics::median(sizes);
}

/// Clips the values at `limit`, and divides them by the share that is not clipped, which it
/// returns.
double clip_values(Stratum& stratum, double limit) {
  const auto is_within = [&](double value) { return std::abs(value) <= limit; };
  const auto within = std::ranges::count_if(stratum.first, is_within) +
                      std::ranges::count_if(stratum.second, is_within);
  const auto all = static_cast<double>(stratum.first.size() + stratum.second.size());
  const double share = std::max(0.5, static_cast<double>(within) / all);
  for (auto* values : {&stratum.first, &stratum.second}) {
    for (double& value : *values) value = std::clamp(value, -limit, limit) / share;
  }
  return share;
}

struct Scores {
  std::vector<Stratum> strata;
  std::vector<double> unclipped;  ///< share of the values of each
};

/// The strata after subtracting `shift`, centred (independent samples) and clipped.
Scores scores_of(std::vector<Stratum> strata, double shift) {
  std::vector<std::vector<double>> sizes(strata.size());
  std::vector<double> all_sizes;
  for (std::size_t s = 0; s < strata.size(); ++s) {
    Stratum& one = strata[s];
    for (double& value : one.first) value -= shift;
    if (!one.is_paired()) {
      std::vector<double> all = one.first;
      all.insert(all.end(), one.second.begin(), one.second.end());
      const double center = metrics::median(all);
      for (auto* values : {&one.first, &one.second}) {
        for (double& value : *values) value -= center;
      }
    }
    add_sizes(one.first, sizes[s]);
    add_sizes(one.second, sizes[s]);
    all_sizes.insert(all_sizes.end(), sizes[s].begin(), sizes[s].end());
  }
  const double typical = median_size(all_sizes);
  std::vector<double> unclipped;
  for (std::size_t s = 0; s < strata.size(); ++s) {
    const auto count = static_cast<double>(strata[s].first.size() + strata[s].second.size());
    const double own = median_size(sizes[s]);
    const double factor = strata[s].is_paired() ? kClip : kClipOfSamples;
    const double limit = factor * (count * own + kShrunk * typical) / (count + kShrunk);
    unclipped.push_back(clip_values(strata[s], limit));
  }
  return {std::move(strata), std::move(unclipped)};
}

double score_difference(const Stratum& scores) {
  const double first = metrics::mean(scores.first);
  return scores.is_paired() ? first : first - metrics::mean(scores.second);
}

/// The differences of means of all choices of the first sample, as a term.
Term differences_of_choices(const Stratum& scores) {
  std::vector<double> all = scores.first;
  all.insert(all.end(), scores.second.begin(), scores.second.end());
  const auto first = static_cast<double>(scores.first.size());
  const auto second = static_cast<double>(scores.second.size());
  std::vector<char> is_first(all.size(), 0);
  std::fill_n(is_first.begin(), scores.first.size(), 1);
  Term out;
  do {
    double difference = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      difference += is_first[i] != 0 ? all[i] / first : -all[i] / second;
    }
    out.push_back(difference);
  } while (std::ranges::prev_permutation(is_first).found);
  return out;
}

/// P(sum of differences >= `least`) under sign flips, not counting values of zero.
double tail_of_pairs(const std::vector<Stratum>& scores, double least) {
  std::vector<double> sizes;
  for (const Stratum& one : scores) {
    for (const double value : one.first) {
      if (value != 0.0) sizes.push_back(std::abs(value) / static_cast<double>(one.first.size()));
    }
  }
  if (sizes.size() > kMostSigns) return tail_of_signs(sizes, least);
  std::vector<Term> terms;
  for (const double size : sizes) terms.push_back({size, -size});
  return tail_of_terms(std::move(terms), least);
}

/// P(sum of differences >= `least`) under exchanges of labels; normal for many values.
double tail_of_samples(const std::vector<Stratum>& scores, double least) {
  double exchanges = 0.0, largest = 0.0, variance = 0.0;
  for (const Stratum& one : scores) {
    const double own = log2_of_choices(one.first.size(), one.second.size());
    exchanges += own;
    largest = std::max(largest, own);
    std::vector<double> all = one.first;
    all.insert(all.end(), one.second.begin(), one.second.end());
    const double center = metrics::mean(all);
    double squares = 0.0;
    for (const double value : all) squares += std::pow(value - center, 2);
    const auto count = static_cast<double>(all.size());
    if (all.size() < 2) continue;
    variance += squares * count /
                (static_cast<double>(one.first.size() * one.second.size()) * (count - 1.0));
  }
  if (exchanges > 20.0 || largest > 14.0) return normal_cdf(-least / std::sqrt(variance));
  std::vector<Term> terms;
  for (const Stratum& one : scores) terms.push_back(differences_of_choices(one));
  return tail_of_terms(std::move(terms), least);
}

/// Variance of a mean, and the square of it over the degrees of freedom plus two; clipped values
/// have none (Tukey and McLaughlin, 1963).
void add_variance(const std::vector<double>& values,
                  double unclipped,
                  double& variance,
                  double& squares) {
  const auto count = static_cast<double>(values.size());
  const bool is_one = values.size() == 1;
  const double own =
      is_one ? values[0] * values[0] : std::pow(metrics::sample_deviation(values), 2) / count;
  variance += own;
  squares += own * own / (is_one ? 3.0 : unclipped * count + 1.0);
}

/// Student's test with unequal variances; the degrees of freedom are nearly unbiased (Welch, 1947).
double student_p(const Scores& scores, double sum) {
  double variance = 0.0, squares = 0.0;
  for (std::size_t s = 0; s < scores.strata.size(); ++s) {
    const Stratum& one = scores.strata[s];
    add_variance(one.first, scores.unclipped[s], variance, squares);
    if (!one.is_paired()) add_variance(one.second, scores.unclipped[s], variance, squares);
  }
  if (variance == 0.0) return 0.0;
  const double degrees = std::max(1.0, variance * variance / squares - 2.0);
  return student_two_sided(std::abs(sum) / std::sqrt(variance), degrees);
}

/// Share of the distance of a stratum from the mean over the strata that is certain (James and
/// Stein).
double share_known(const Stratum& stratum, double distance) {
  const auto square_error = [](const std::vector<double>& values) {
    return std::pow(metrics::sample_deviation(values), 2) / static_cast<double>(values.size());
  };
  const bool is_paired = stratum.is_paired();
  const std::size_t count =
      is_paired ? stratum.first.size() : std::min(stratum.first.size(), stratum.second.size());
  if (count < kFewestMoved || distance == 0.0) return 0.0;
  const double square =
      square_error(stratum.first) + (is_paired ? 0.0 : square_error(stratum.second));
  return std::max(0.0, 1.0 - square * std::pow(kMovedErrors / distance, 2));
}

}  // namespace

double typical_of(const Stratum& stratum) {
  std::vector<double> values;
  if (stratum.is_paired()) {
    values = stratum.first;
    std::ranges::sort(values);
    return pseudo_median(values);
  }
  for (const double first : stratum.first) {
    for (const double second : stratum.second) values.push_back(first - second);
  }
  return metrics::median(values);
}

Exchanged exchanged(std::vector<Stratum> strata, double shift) {
  Scores found = scores_of(std::move(strata), shift);
  std::vector<Stratum>& scores = found.strata;
  Exchanged out;
  double size = 0.0;
  for (const Stratum& one : scores) {
    const double own = score_difference(one);
    out.sum += own;
    size += std::abs(own);
  }
  if (std::abs(out.sum) <= 1e-12 * size) return out;
  const double least = std::abs(out.sum) - 1e-9 * size;
  if (scores.front().is_paired()) {
    out.p = 2.0 * tail_of_pairs(scores, least);
  } else {
    if (out.sum < 0.0) {
      for (Stratum& one : scores) std::swap(one.first, one.second);
    }
    out.p = 2.0 * tail_of_samples(scores, least);
  }
  if (scores.size() > 1) out.p = std::max(out.p, student_p(found, out.sum));
  out.p = std::min(1.0, out.p);
  return out;
}

RandomizationTest::RandomizationTest(std::vector<Stratum> strata) : strata_(std::move(strata)) {
  if (strata_.empty()) return;
  std::vector<double> typical;
  for (const Stratum& one : strata_) typical.push_back(typical_of(one));
  typical_ = metrics::mean(typical);
  std::vector<double> moves;
  for (std::size_t s = 0; s < strata_.size(); ++s) {
    const double distance = typical_ - typical[s];
    moves.push_back(distance * share_known(strata_[s], distance));
  }
  const double all = metrics::mean(moves);
  for (std::size_t s = 0; s < strata_.size(); ++s) {
    for (double& value : strata_[s].first) value += moves[s] - all;
  }
}

double RandomizationTest::least_p() const {
  double exchanges = 0.0;
  for (const Stratum& one : strata_) {
    exchanges += one.is_paired() ? static_cast<double>(one.first.size())
                                 : log2_of_choices(one.first.size(), one.second.size());
  }
  return std::min(1.0, std::exp2(1.0 - exchanges));
}

double RandomizationTest::p(double shift) const {
  if (strata_.empty()) return 1.0;
  const Exchanged out = exchanged(strata_, shift);
  return out.sum * (typical_ - shift) > 0.0 ? out.p : 1.0;
}

double RandomizationTest::end(double level, double outward) const {
  double inside = typical_;
  if (outward * (0.0 - inside) > 0.0 && p() > level) inside = 0.0;
  double outside = 0.0;
  if (outward * (0.0 - inside) <= 0.0 || p() > level) {
    double step = std::max(1e-9, std::abs(typical_));
    do {
      outside = inside + outward * step;
      step *= 2.0;
    } while (p(outside) > level && step < 1e12);
  }
  for (int i = 0; i < 50; ++i) {
    const double width = std::abs(outside - inside);
    if (width <= 1e-5 * std::max(std::abs(outside), std::abs(outside - typical_))) break;
    const double middle = 0.5 * (inside + outside);
    (p(middle) > level ? inside : outside) = middle;
  }
  // With ties, the end is often a value itself, which is inside: rounding must not exclude it.
  return inside == 0.0 || outside == 0.0 ? inside : outside;
}

std::optional<Interval> RandomizationTest::interval(double level) const {
  if (strata_.empty() || least_p() > level) return std::nullopt;
  return Interval{typical_, end(level, -1.0), end(level, 1.0)};
}

double least_p_of(std::size_t count, std::size_t strata) {
  const double exchanges = strata == 0
                               ? static_cast<double>(count)
                               : static_cast<double>(strata) * log2_of_choices(count, count);
  return std::min(1.0, std::exp2(1.0 - exchanges));
}

}  // namespace loopbench::harness

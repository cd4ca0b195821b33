#include "metrics/errors/segments.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "metrics/errors/segment_errors.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/segment_ends.hpp"
#include "metrics/protocols/lengths.hpp"

namespace loopbench::metrics {
namespace {

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// The rates of several lengths, concatenated.
struct Together {
  SegmentErrors errors;

  void add(const SegmentErrors& more) {
    append(errors.start, more.start);
    append(errors.translation_share, more.translation_share);
    append(errors.rotation_rate, more.rotation_rate);
  }

  /// Ordered by start, the order in which the devkit sums floats.
  void sort() {
    std::vector<std::size_t> order(errors.start.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return errors.start[k]; });
    SegmentErrors sorted;
    for (const std::size_t k : order) {
      sorted.translation_share.push_back(errors.translation_share[k]);
      sorted.rotation_rate.push_back(errors.rotation_rate[k]);
    }
    errors = std::move(sorted);
  }
};

/// Adds scores of the values times `factor`.
struct Scores {
  const Protocol& protocol;
  std::vector<Score> out;

  void add(const char* relation,
           const std::string& axis,
           const char* unit,
           double factor,
           std::vector<double>&& values) {
    const bool is_float = protocol.segments.precision == Precision::float32;
    const double mean = is_float ? factor * float_mean(values) : 0.0;
    for (double& value : values) value *= factor;
    Score score{relation, axis, unit, statistics(std::move(values), protocol.ddof)};
    if (is_float) score.statistics.mean = mean;
    out.push_back(std::move(score));
  }

  /// Moves the two rates out of `errors`.
  void add_rates(const std::string& axis, SegmentErrors& errors) {
    add("translation", axis, "%", 100.0, std::move(errors.translation_share));
    add("rotation", axis, "deg/m", kDegrees, std::move(errors.rotation_rate));
  }
};

class Finder {
 public:
  explicit Finder(const Evaluation& evaluation)
      : evaluation_(evaluation), rule_(evaluation.protocol.segments) {
    if (rule_.precision == Precision::float32) {
      floats_ = float_distances(evaluation.reference);
    } else {
      distances_ = accumulated_distances(evaluation.reference);
    }
  }

  /// Computes only rates if single lengths are not reported.
  SegmentErrors errors(double length, bool only_rates) const {
    const auto step = static_cast<std::size_t>(rule_.step);
    if (rule_.precision == Precision::float32) {
      const auto wanted = static_cast<float>(length);
      return float_segment_errors(evaluation_, segments_beyond(floats_, wanted, step), wanted);
    }
    const double miss = tolerance("segments.tolerance", rule_.tolerance).of(length);
    const std::vector<FromTo> pairs = segment_pairs(distances_, length, miss, rule_.end, step);
    return segment_errors(evaluation_, distances_, pairs, length, only_rates);
  }

 private:
  const Evaluation& evaluation_;
  const SegmentErrorRule& rule_;
  std::vector<double> distances_;
  std::vector<float> floats_;
};

double metres(const Length& length, double whole) {
  return length.is_share ? std::floor(100.0 * length.of(whole)) / 100.0 : length.value;
}

}  // namespace

void check_combination(const SegmentsOptions& options) {
  if (!options.lengths.empty()) lengths("lengths", options.lengths);
}

std::vector<Score> segments(const Evaluation& evaluation, const SegmentsOptions& options) {
  const SegmentErrorRule& rule = evaluation.protocol.segments;
  const bool is_own = !options.lengths.empty();
  const std::vector<Length> wanted =
      is_own ? lengths("lengths", options.lengths) : lengths("segments.lengths", rule.lengths);
  if (const std::string why = why_no_attitude(evaluation); !why.empty()) throw Undefined(why);
  const Finder find(evaluation);
  Scores each{evaluation.protocol, {}};
  Together all;
  for (const Length& length : wanted) {
    const double target = metres(length, evaluation.reference_length);
    if (target <= 0.0) continue;
    SegmentErrors errors = find.errors(target, !options.each);
    if (errors.rotation_rate.size() < static_cast<std::size_t>(rule.fewest)) continue;
    all.add(errors);
    if (!options.each) continue;
    each.add_rates(length.text, errors);
    if (rule.precision == Precision::float32) continue;
    each.add("translation", length.text, "m", 1.0, std::move(errors.translation));
    each.add("rotation", length.text, "deg", kDegrees, std::move(errors.rotation));
    each.add("yaw", length.text, "deg", kDegrees, std::move(errors.yaw));
    each.add("gravity", length.text, "deg", kDegrees, std::move(errors.gravity));
  }
  if (all.errors.rotation_rate.empty()) {
    throw Undefined("segments: no segment of the reference (" +
                    to_text(evaluation.reference_length) + " m) has a length of " +
                    (is_own ? options.lengths : rule.lengths));
  }
  Scores out{evaluation.protocol, {}};
  if (rule.precision == Precision::float32) all.sort();
  out.add_rates("all", all.errors);
  out.out.insert(out.out.end(), each.out.begin(), each.out.end());
  return out.out;
}

}  // namespace loopbench::metrics

/// Checks of what methods and metrics return or throw, before it is evaluated or stored.
#pragma once

#include <cstddef>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/error.hpp"
#include "datasets/core/trajectory.hpp"
#include "harness/sweep/model/status.hpp"
#include "methods/report.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

/// Limits of a report, far above those of the methods in this repository.
inline constexpr std::size_t kMostItems = 1'000;               ///< phases, counts and notes each
inline constexpr std::size_t kMostSections = 100'000;          ///< sections
inline constexpr std::size_t kMostErrors = 1'000'000'000'000;  ///< of a score
inline constexpr std::size_t kLongestName = 200;    ///< of a phase, count or section [bytes]
inline constexpr std::size_t kLongestNote = 2'000;  ///< of a note or reason [bytes]

/// Throws std::runtime_error if the curve is null or does not cover the keyframes.
void check_span(const Curve* curve, const Trajectory& keyframes);

/// A method's curve, every pose of which is checked when it is sampled.
class CheckedCurve final : public Curve {
 public:
  /// `curve` must outlive this object.
  explicit CheckedCurve(const Curve& curve) : curve_(curve) {}

  using Curve::sample;
  double start() const override { return curve_.start(); }
  double end() const override { return curve_.end(); }
  const Replay* replay() const override { return curve_.replay(); }

  /// Throws std::runtime_error for the first pose that violates a rule of violated_rule() or is not
  /// written. Adds O(n).
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

  /// Throws the first error of sample() again, since a metric can have caught it.
  void require_valid_so_far() const;

 private:
  const Curve& curve_;
  mutable std::mutex mutex_;
  mutable std::string first_error_;
};

/// Throws std::runtime_error unless the covariances of a report are empty, or finite, symmetric and
/// one per keyframe.
void check_covariances(const std::vector<Matrix6>& covariances, std::size_t keyframes);

/// Throws std::runtime_error unless the rejected closures of a report are unset, or ascending
/// indices of closures.
void check_rejected(const std::optional<std::vector<std::size_t>>& rejected, std::size_t closures);

/// Throws std::runtime_error if a part of the report cannot be stored or displayed: more items or
/// longer texts than the limits, texts that are not UTF-8 or contain control characters, numbers
/// that are not finite, negative durations, sections that end before they begin. The message names
/// the first such part and the rule.
void check_report(const methods::Report& report);

/// Throws std::runtime_error if a score cannot be stored or displayed: none, more of them or longer
/// texts than the limits, texts that are not UTF-8 or contain control characters, a direction that
/// is none of Better, a target that is not finite, a count that can only be a mistake (-1), or two
/// of one name, axis and unit.
void check_scores(const std::vector<metrics::Score>& scores);

/// Text of an exception or a reason as it is stored: one line of printable(), at most kLongestNote
/// bytes and the number of omitted ones.
std::string stored_reason(std::string_view text);

/// what() of a plugin's exception can be null or empty.
inline const char* message_of(const std::exception& error) {
  const char* out = error.what();
  return out != nullptr && *out != '\0' ? out : "threw an exception without a message";
}

/// Runs `work` and sets status and why of `result` for any exception: declined for an exception
/// Declined, otherwise failed.
template <class Result, class Work>
void catch_errors(Result& result, Work work) {
  try {
    work();
  } catch (const Declined& reason) {
    result.status = Status::declined;
    result.why = stored_reason(message_of(reason));
  } catch (const std::bad_alloc&) {
    result.status = Status::out_of_memory;
    result.why = "memory allocation failed";
  } catch (const std::exception& error) {
    result.status = Status::failed;
    result.why = stored_reason(message_of(error));
  } catch (...) {
    result.status = Status::failed;
    result.why = "threw an exception that is not a std::exception";
  }
}

}  // namespace loopbench::harness
